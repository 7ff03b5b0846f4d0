#include "sphvv/solver/snapshots/xdmf.hpp"

#include "sphvv/solver/error.hpp"
#include "sphvv/solver/settings.hpp"
#include "sphvv/solver/snapshots/snapshot.hpp"
#include "sphvv/solver/storage/hdf5.hpp"
#include "sphvv/solver/storage/write_atomically.hpp"

namespace sphvv::solver {
namespace {

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
        case '&':
            result += "&amp;";
            break;
        case '<':
            result += "&lt;";
            break;
        case '>':
            result += "&gt;";
            break;
        case '"':
            result += "&quot;";
            break;
        default:
            result += c;
        }
    }
    return result;
}

const char* attribute_type(std::size_t components) {
    return components == 1 ? "Scalar" : components == 3 ? "Vector" : components == 9 ? "Tensor" : "Matrix";
}

/// A reference to a dataset of a snapshot.
std::string data_item(const XdmfFrame& frame, const XdmfField& field) {
    const std::string columns = field.components == 1 ? "" : " " + std::to_string(field.components);
    return "<DataItem Format=\"HDF\" NumberType=\"" + std::string(field.integer ? "Int" : "Float") +
           "\" Precision=\"8\" Dimensions=\"" + std::to_string(frame.particles) + columns + "\">" +
           escaped(frame.file) + ":/particles/" + escaped(field.name) + "</DataItem>";
}

std::string grid(const XdmfFrame& frame) {
    const std::string count = std::to_string(frame.particles);
    // The cells are vertices. Identities, which name every point once, serve as their connectivity: without
    // one the reader of XDMF 3 makes points that no viewer shows.
    std::string text = "   <Grid Name=\"particles\" GridType=\"Uniform\">\n"
                       "    <Time Value=\"" +
                       shortest(frame.time) +
                       "\"/>\n"
                       "    <Topology TopologyType=\"Polyvertex\" NodesPerElement=\"1\" NumberOfElements=\"" +
                       count + "\">" + data_item(frame, {"id", 1, true}) +
                       "</Topology>\n"
                       "    <Geometry GeometryType=\"XYZ\">" +
                       data_item(frame, {"position", 3, false}) + "</Geometry>\n";
    for (const XdmfField& field : frame.fields) {
        if (field.name != "position") {
            text += "    <Attribute Name=\"" + escaped(field.name) + "\" AttributeType=\"" +
                    attribute_type(field.components) + "\" Center=\"Node\">" + data_item(frame, field) +
                    "</Attribute>\n";
        }
    }
    return text + "   </Grid>\n";
}

} // namespace

XdmfFrame xdmf_frame(const std::filesystem::path& snapshot) {
    const SnapshotHeader header = read_snapshot_header(snapshot);
    XdmfFrame frame{
        snapshot.filename().string(), header.time, static_cast<std::size_t>(header.particles), {}};
    const storage::Group particles = storage::open_hdf5(snapshot).group("particles");
    for (const std::string& name : particles.member_names()) {
        const storage::Extent extent = particles.extent(name);
        frame.fields.push_back({name, extent.columns, extent.kind == storage::Kind::integer});
    }
    return frame;
}

void write_xdmf(const std::filesystem::path& path, std::span<const XdmfFrame> frames) {
    std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                       "<Xdmf Version=\"3.0\">\n"
                       " <Domain>\n"
                       "  <Grid Name=\"snapshots\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
    for (const XdmfFrame& frame : frames) {
        if (frame.file.find(':') != std::string::npos) {
            throw UserError(path.string() + ": XDMF cannot name the snapshot '" + frame.file +
                            "', because of the ':' in its name");
        }
        text += grid(frame);
    }
    storage::write_atomically(path, text + "  </Grid>\n </Domain>\n</Xdmf>\n");
}

} // namespace sphvv::solver
