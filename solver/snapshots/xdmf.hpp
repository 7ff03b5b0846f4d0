#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace sphvv::solver {

/// One field of a snapshot, as a viewer sees it: 1 component is a scalar, 3 are a vector, 9 a tensor.
struct XdmfField {
    std::string name;
    std::size_t components;
    bool integer;
};

/// One snapshot of a sequence.
struct XdmfFrame {
    std::string file; ///< relative to the folder of the XDMF file
    double time;      ///< s
    std::size_t particles;
    std::vector<XdmfField> fields;
};

/// The frame that a snapshot makes, named as if the XDMF file were to lie beside it. Throws UserError if it
/// cannot be read.
XdmfFrame xdmf_frame(const std::filesystem::path& snapshot);

/// Writes the sequence as a temporal collection of points, for ParaView, VisIt and VTK (readers of XDMF 2 and
/// 3). Only the description is written; the numbers stay in the snapshots. Throws UserError if the file
/// cannot be written, or for a snapshot with ':' in its name, where XDMF separates file and dataset. Format:
/// https://www.xdmf.org/index.php/XDMF_Model_and_Format.
void write_xdmf(const std::filesystem::path& path, std::span<const XdmfFrame> frames);

} // namespace sphvv::solver
