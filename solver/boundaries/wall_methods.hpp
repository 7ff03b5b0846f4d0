#pragma once

#include "sphvv/solver/boundaries/wall.hpp"

#include <optional>
#include <span>
#include <string_view>

namespace sphvv::solver {

/// Declaration of what lies beyond a wall, and of how a scene with it is laid out.
struct WallMethodEntry {
    std::string_view name;
    std::string_view summary;
    std::string_view formula;
    std::string_view source;
    WallMethod method;
    bool row_on_wall;       ///< particles or points on the wall, the fluid's first row dx from it; else dx/2
    bool layers_behind;     ///< more rows of wall particles, as far as a support reaches
    bool compressible_only; ///< needs a density that evolves
    /// Order of the velocity of a shear flow at a no-slip wall: images with 2w - u leave the second
    /// derivative with a jump, a velocity that is constant beyond the wall the first. 0: the wall carries no
    /// shear, and is one with free slip only.
    int shear_order;
    std::optional<RepulsiveForm> repulsion{}; ///< by points on the wall, in place of a row of particles
};

namespace wall_methods {
/// Every method, by name.
std::span<const WallMethodEntry* const> all();
/// The method of that name. Throws UserError naming the accepted ones.
const WallMethodEntry& find(std::string_view name);
} // namespace wall_methods

} // namespace sphvv::solver
