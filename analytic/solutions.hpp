#pragma once

#include "sphvv/analytic/solution.hpp"

#include <span>
#include <string_view>

namespace sphvv::analytic::solutions {

/// Every exact solution in analytic/solutions/, in the order of the file names.
std::span<const Solution* const> all();

/// The solution of that name. Throws std::invalid_argument naming the accepted ones.
const Solution& find(std::string_view name);

} // namespace sphvv::analytic::solutions
