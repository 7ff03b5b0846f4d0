// Turbulent free-surface channel over a smooth bed: logarithmic law, with Issa's case as declared values.
#include "sphvv/analytic/log_law.hpp"
#include "sphvv/analytic/solutions.hpp"

#include <cmath>

namespace sphvv::analytic::solutions {

const Solution& log_law_channel();

namespace {

/// nu = u* H/H+; z0 = (nu/u*) e^{−κB}; the fluid begins at δ = δ+ nu/u*.
LogLaw law(const Values& given) {
    const Values values = resolve(log_law_channel(), given);
    const double H = values.at("depth");
    const double wall_unit = H / values.at("friction_re");
    const double kappa = values.at("kappa");
    return {.friction_velocity = values.at("friction_velocity"),
            .depth = H,
            .kappa = kappa,
            .zero = wall_unit * std::exp(-kappa * values.at("b")),
            .edge = values.at("edge") * wall_unit,
            .length = values.at("length"),
            .density = values.at("density"),
            .gravity = values.at("gravity")};
}

using Channel = LogLawChannel<law>;

Scalar molecular_viscosity(const Values& given) {
    const Values values = resolve(log_law_channel(), given);
    const double nu = values.at("friction_velocity") * values.at("depth") / values.at("friction_re");
    return [nu](const Vector&, double) { return nu; };
}

std::vector<Quantity> quantities() {
    std::vector<Quantity> all = Channel::quantities();
    all.push_back({"molecular_viscosity", "m2/s", "ν = u*H/H⁺, for the wall law only", molecular_viscosity});
    return all;
}

} // namespace

const Solution& log_law_channel() {
    static const Solution solution{
        .name = "log_law_channel",
        .summary = "Turbulent free-surface channel over a smooth bed: logarithmic law above the edge δ",
        .formula =
            "u = u*[ln(zu*/ν)/κ + B], τ = ρu*²(1 − z/H), ν_T = κu*z(1 − z/H), du/dz = u*/κz, F = u*²/H, "
            "U = u*[ln(Hu*/ν)/κ + B − 1/κ], p = ρg(H − z); z from the bed; valid for z⁺ > 30",
        .source =
            "R. Issa, PhD thesis, UMIST, 2005, §6.1–6.2.2; H. Schlichting, Boundary-Layer Theory (7th ed. "
            "1979) ch. XX",
        .dimension = 2,
        .parameters =
            {
                {"friction_velocity", "m/s", "u*", 0.05, 1e-6, 1e6},
                {"friction_re", "1", "H⁺ = u*H/ν", 20000, 2000, 1e8},
                {"depth", "m", "H", 0.4, 1e-6, 1e6},
                {"length", "m", "period along the channel", 0.4, 1e-6, 1e6},
                {"density", "kg/m3", "ρ", 1000, 1e-6, 1e6},
                {"gravity", "m/s2", "g, downwards", 9.81, 0, 1e3},
                {"kappa", "1", "κ, von Kármán's constant", 0.41, 0.3, 0.5},
                {"b", "1", "B, constant of the law", 5.2, 0, 10},
                {"edge", "1", "δ⁺ = δu*/ν, the height at which the fluid begins", 50, 30, 1000},
            },
        .domain = Channel::domain,
        .medium = Channel::medium,
        .bind = Channel::bind,
        .kinetic_energy = Channel::kinetic_energy,
        .equations = Equations::reynolds_averaged,
        .boundaries = Channel::boundaries,
        .quantities = quantities(),
    };
    return solution;
}

} // namespace sphvv::analytic::solutions
