#pragma once

#include <filesystem>

namespace sphvv::solver::storage {

/// Whether the objects of every global heap collection in an HDF5 file follow each other from its header to
/// its end.
///
/// Texts of variable length lie there. It is the one part of a file without a checksum, and the library
/// (1.10.8) follows the sizes that it finds there without looking: with one bit flipped it copies memory that
/// it does not own, or never ends. Reads the whole file. Format: HDF5 File Format Specification 3.0, III.E.
bool are_global_heaps_sound(const std::filesystem::path& path);

} // namespace sphvv::solver::storage
