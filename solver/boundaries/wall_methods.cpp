#include "sphvv/solver/boundaries/wall_methods.hpp"

#include "sphvv/solver/settings.hpp"

#include <array>

namespace sphvv::solver::wall_methods {
namespace {

WallMethodEntry repulsive_entry(std::string_view name, RepulsiveForm form, std::string_view summary,
                                std::string_view formula, std::string_view source) {
    return {.name = name,
            .summary = summary,
            .formula = formula,
            .source = source,
            .method = WallMethod::repulsive,
            .row_on_wall = true,
            .layers_behind = false,
            .compressible_only = true,
            .shear_order = 0,
            .repulsion = form};
}

} // namespace

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
    static const WallMethodEntry repulsive =
        repulsive_entry("repulsive", RepulsiveForm::radial,
                        "points on a wall with free slip that push particles away along the line to them",
                        "f = D [(r0/r)^4 - (r0/r)^2] r_vec/r^2 for r < r0 = dx, D = repulsion U^2",
                        "Monaghan 1994; Issa 2005 §2.7 (f1)");
    static const WallMethodEntry repulsive_lennard_jones = repulsive_entry(
        "repulsive_lennard_jones", RepulsiveForm::lennard_jones,
        "points on a wall with free slip that push particles away by a steeper force with a tail",
        "f = (D/r0) [(r0/r)^12 - (r0/r)^6] e_r for r < 0.95 r0, [A (r0 - r)^2 + B (r0 - r)] e_r up to r0 = "
        "dx; A, B: continuous value and slope; D = repulsion U^2",
        "Issa 2005 §2.7; r_c and the end of the tail: this project");
    static const WallMethodEntry repulsive_normal = repulsive_entry(
        "repulsive_normal", RepulsiveForm::normal,
        "points on a wall with free slip that push particles away along its normal",
        "f = D [(r0/y)^4 - (r0/y)^2]/y P(t.r_vec) n, y = n.r_vec < r0 = dx, P(q) = 1 - |q|/dx "
        "for |q| < dx, D = repulsion U^2",
        "Issa 2005 §2.7 (f3)");
    static const std::array<const WallMethodEntry*, 7> entries{
        &dummy, &fixed, &mirror, &mirror_row, &repulsive, &repulsive_lennard_jones, &repulsive_normal};
    return entries;
}

const WallMethodEntry& find(std::string_view name) {
    return find_by_name(all(), name, "wall method");
}

} // namespace sphvv::solver::wall_methods
