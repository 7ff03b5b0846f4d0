// Turbulent free-surface channel over a fully rough bed: logarithmic law, with Issa's case as declared
// values.
#include "sphvv/analytic/log_law.hpp"
#include "sphvv/analytic/solutions.hpp"

#include <cmath>

namespace sphvv::analytic::solutions {

const Solution& log_law_channel_rough();

namespace {

/// z0 = ξ e^{−κD}; no viscosity enters.
LogLaw law(const Values& given) {
    const Values values = resolve(log_law_channel_rough(), given);
    const double H = values.at("depth");
    const double xi = values.at("roughness") * H;
    const double kappa = values.at("kappa");
    return {.friction_velocity = values.at("friction_velocity"),
            .depth = H,
            .kappa = kappa,
            .zero = xi * std::exp(-kappa * values.at("d")),
            .edge = values.at("edge") * xi,
            .length = values.at("length"),
            .density = values.at("density"),
            .gravity = values.at("gravity")};
}

using Channel = LogLawChannel<law>;

} // namespace

const Solution& log_law_channel_rough() {
    static const Solution solution{
        .name = "log_law_channel_rough",
        .summary = "Turbulent free-surface channel over a fully rough bed: logarithmic law above the edge δ",
        .formula =
            "u = u*[ln(z/ξ)/κ + D], τ = ρu*²(1 − z/H), ν_T = κu*z(1 − z/H), du/dz = u*/κz, F = u*²/H, "
            "U = u*[ln(H/ξ)/κ + D − 1/κ], p = ρg(H − z); z from the bed; for roughness ξ⁺ = ξu*/ν > 70",
        .source =
            "R. Issa, PhD thesis, UMIST, 2005, §6.1, §6.2.3; H. Schlichting, Boundary-Layer Theory (7th ed. "
            "1979) ch. XX",
        .dimension = 2,
        .parameters =
            {
                {"friction_velocity", "m/s", "u*", 0.05, 1e-6, 1e6},
                {"roughness", "1", "ξ/H, roughness height over the depth", 0.025, 1e-6, 0.1},
                {"depth", "m", "H", 0.4, 1e-6, 1e6},
                {"length", "m", "period along the channel", 0.4, 1e-6, 1e6},
                {"density", "kg/m3", "ρ", 1000, 1e-6, 1e6},
                {"gravity", "m/s2", "g, downwards", 9.81, 0, 1e3},
                {"kappa", "1", "κ, von Kármán's constant", 0.41, 0.3, 0.5},
                {"d", "1", "D, constant of the law", 8.5, 5, 12},
                {"edge", "1", "δ/ξ, the height at which the fluid begins", 0.1, 0.05, 2},
            },
        .domain = Channel::domain,
        .medium = Channel::medium,
        .bind = Channel::bind,
        .kinetic_energy = Channel::kinetic_energy,
        .equations = Equations::reynolds_averaged,
        .boundaries = Channel::boundaries,
        .quantities = Channel::quantities(),
    };
    return solution;
}

} // namespace sphvv::analytic::solutions
