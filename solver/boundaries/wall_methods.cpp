#include "sphvv/solver/boundaries/wall_methods.hpp"

#include "sphvv/solver/settings.hpp"

#include <array>

namespace sphvv::solver::wall_methods {

std::span<const WallMethodEntry* const> all() {
    static const WallMethodEntry dummy{
        .name = "dummy",
        .summary = "a row of wall particles, and layers behind it that carry its velocity and pressure",
        .formula = "u_k = w, p_k = p_wall, at r_wall - k dx n",
        .source = "Lee 2008 §1.3; Xu 2009 §3.5",
        .method = WallMethod::dummy,
        .row_on_wall = true,
        .layers_behind = false,
        .compressible_only = false,
        .shear_order = 1};
    static const WallMethodEntry fixed{
        .name = "fixed",
        .summary = "rows of wall particles on and behind the wall, each with a density of its own",
        .formula = "u = w, drho/dt and p(rho) as of the fluid",
        .source = "Issa 2005 §2.7 (fixed mirror particles)",
        .method = WallMethod::fixed,
        .row_on_wall = true,
        .layers_behind = true,
        .compressible_only = true,
        .shear_order = 1};
    static const WallMethodEntry mirror{
        .name = "mirror",
        .summary = "images of the fluid, reflected in any signed distance",
        .formula = "r' = r - 2 d n, u' = 2w - u (no slip) or u - 2n(u - w).n (free slip)",
        .source = "Morris et al. 1997; Xu 2009 §2.1.3",
        .method = WallMethod::mirror,
        .row_on_wall = false,
        .layers_behind = false,
        .compressible_only = false,
        .shear_order = 2};
    static const WallMethodEntry mirror_row{
        .name = "mirror_row",
        .summary = "images of the fluid, and a row of wall particles on the wall",
        .formula = "as mirror; on the wall u = w",
        .source = "Xu 2009 §2.1.3, §3.5; Issa 2005 §2.7 (mobile mirror particles)",
        .method = WallMethod::mirror,
        .row_on_wall = true,
        .layers_behind = false,
        .compressible_only = false,
        .shear_order = 2};
    static const std::array<const WallMethodEntry*, 4> entries{&dummy, &fixed, &mirror, &mirror_row};
    return entries;
}

const WallMethodEntry& find(std::string_view name) {
    return find_by_name(all(), name, "wall method");
}

} // namespace sphvv::solver::wall_methods
