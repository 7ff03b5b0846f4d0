#include "sphvv/solver/schemes.hpp"

#include <algorithm>

namespace sphvv::solver {
namespace {

/// A scene whose physics nobody reads would be another scene without saying so.
template <int Dim>
void refuse_unread(const Scheme& scheme, const Simulation<Dim>& s) {
    const auto check = [&](bool wanted, const char* stage, const char* what, const char* accepted) {
        const bool there =
            std::ranges::any_of(s.stages, [stage](const Stage<Dim>& each) { return each.name == stage; });
        if (wanted && !there) {
            throw UserError("the scheme " + std::string(scheme.name) + " has no " + what +
                            "; accepted with it: " + accepted);
        }
    };
    check(s.turbulence.has_value(), "eddy_viscosity", "turbulence", "wcsph");
    check(s.wall_friction.has_value(), "wall_function", "wall function", "wcsph");
    check(s.flow_driver.has_value(), "flow_driver", "flow driver", "wcsph");
    // A density that evolves takes p to 0 at a surface by itself.
    check(s.free_surface.has_value() && !scheme.compressible, "free_surface", "free surface",
          "wcsph, and the schemes with a projection");
}

} // namespace

void Scheme::assemble(Simulation<2>& simulation) const {
    assemble_2d(simulation);
    refuse_unread(*this, simulation);
}

void Scheme::assemble(Simulation<3>& simulation) const {
    assemble_3d(simulation);
    refuse_unread(*this, simulation);
}

std::vector<Key> common_keys(std::string_view kernel, double h_over_dx) {
    std::vector<std::string> names;
    for (const Kernel* entry : kernels::all()) {
        names.emplace_back(entry->name);
    }
    return {Key::word("kernel", std::string(kernel), names, "smoothing kernel"),
            Key::number("h_over_dx", h_over_dx, 0.8, 5, "1", "smoothing length h over particle spacing dx"),
            Key::number("time_step", 0, 0, 1e6, "s", "fixed time step; 0 takes the scheme's own limits")};
}

std::vector<Key> joined(std::vector<Key> keys, const std::vector<Key>& more) {
    keys.insert(keys.end(), more.begin(), more.end());
    return keys;
}

namespace schemes {
const Scheme& find(std::string_view name) {
    return find_by_name(all(), name, "scheme");
}
} // namespace schemes

} // namespace sphvv::solver
