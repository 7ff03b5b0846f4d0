#pragma once

#include "sphvv/verification/case.hpp"

namespace sphvv::verification::cases {

/// Every case in verification/cases/, in the order of the file names.
std::span<const Case* const> all();
/// The case of that name. Throws UserError naming the accepted ones.
const Case& find(std::string_view name);

} // namespace sphvv::verification::cases
