#pragma once

#include <string>
#include <string_view>

namespace sphvv::solver::storage {

/// The text with U+FFFD for every byte that is not part of well-formed UTF-8, and for NUL, which HDF5 cannot
/// carry.
std::string valid_utf8(std::string_view text);

} // namespace sphvv::solver::storage
