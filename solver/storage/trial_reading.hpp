#pragma once

#include <filesystem>

namespace sphvv::solver::storage {

/// Reads all of an HDF5 file once in a process of its own. Throws UserError if the library breaks
/// down at it or does not come to an end; whatever else is wrong is left to who reads it for good.
///
/// The library (1.10.8) trusts what its checksums confirm: a file whose maker, or whose damage, gave it sound
/// checksums around nonsense makes it read and free memory that is not its own. For files that the user
/// names; what this process has written itself needs no trial.
void read_in_trial(const std::filesystem::path& path);

} // namespace sphvv::solver::storage
