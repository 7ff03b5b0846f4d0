"""What a viewer would see of an XDMF file, as lines of words: the reader, then for every time step

    frame TIME POINTS CELLS, bounds XMIN XMAX YMIN YMAX ZMIN ZMAX, and for each field: field NAME COMPONENTS MIN MAX.

    /usr/bin/python3 read_xdmf.py snapshots.xdmf

Reads with each of VTK's readers (XDMF 2, XDMF 3) that is built in. Debian's python3-vtk9 has neither; then the XML is
followed by hand to the datasets, and their sizes are held against what it says. ParaView's Python has both.
"""

import os
import sys
import xml.etree.ElementTree


def vtk_readers():
    found = []
    for module, name in (("vtkIOXdmf2", "vtkXdmfReader"), ("vtkIOXdmf3", "vtkXdmf3Reader")):
        try:
            found.append(getattr(__import__("vtkmodules." + module, fromlist=[name]), name))
        except ImportError:
            pass
    return found


def report(time, points, cells, fields):
    print("frame", repr(time), len(points), cells)
    print("bounds", *(repr(float(bound)) for axis in points.T for bound in (axis.min(), axis.max())))
    for name, values in sorted(fields.items()):
        print("field", name, 1 if values.ndim == 1 else values.shape[1], repr(float(values.min())), repr(float(values.max())))


def read_with_vtk(reader_class, path):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

    print("reader", reader_class.__name__)
    reader = reader_class()
    reader.SetFileName(path)
    reader.UpdateInformation()
    for time in reader.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS()) or (0.0,):
        reader.UpdateTimeStep(time)
        grid = reader.GetOutputDataObject(0)
        while grid.IsA("vtkMultiBlockDataSet"):
            grid = grid.GetBlock(0)
        data = grid.GetPointData()
        fields = {data.GetArrayName(k): vtk_to_numpy(data.GetArray(k)) for k in range(data.GetNumberOfArrays())}
        report(time, vtk_to_numpy(grid.GetPoints().GetData()), grid.GetNumberOfCells(), fields)


def follow(item, folder):
    """The dataset that a DataItem names, if it is what the DataItem says."""
    import h5py

    name, dataset = item.text.split(":")
    with h5py.File(os.path.join(folder, name), "r") as stream:
        values = stream[dataset][()]
    kind = {"Float": "f", "Int": "i"}[item.get("NumberType")]
    shape = tuple(int(extent) for extent in item.get("Dimensions").split())
    assert item.get("Format") == "HDF" and values.shape == shape and values.dtype.kind == kind, item.text
    assert values.dtype.itemsize == int(item.get("Precision")), item.text
    return values


def read_by_hand(path):
    print("reader by_hand")
    folder = os.path.dirname(path)
    for grid in xml.etree.ElementTree.parse(path).iterfind("Domain/Grid[@CollectionType='Temporal']/Grid"):
        points = follow(grid.find("Geometry[@GeometryType='XYZ']/DataItem"), folder)
        topology = grid.find("Topology[@TopologyType='Polyvertex'][@NodesPerElement='1']")
        vertices = follow(topology.find("DataItem"), folder)
        assert len(vertices) == int(topology.get("NumberOfElements"))
        assert set(vertices) == set(range(len(points))), "not every point is a vertex"
        fields = {field.get("Name"): follow(field.find("DataItem"), folder) for field in grid.iterfind("Attribute")}
        types = {1: "Scalar", 3: "Vector", 9: "Tensor"}
        for field in grid.iterfind("Attribute"):
            values = fields[field.get("Name")]
            expected = types.get(1 if values.ndim == 1 else values.shape[1], "Matrix")
            assert field.get("Center") == "Node" and field.get("AttributeType") == expected, field.get("Name")
        report(float(grid.find("Time").get("Value")), points, len(vertices), fields)


if __name__ == "__main__":
    readers = vtk_readers()
    for reader_class in readers:
        read_with_vtk(reader_class, sys.argv[1])
    if not readers:
        read_by_hand(sys.argv[1])
