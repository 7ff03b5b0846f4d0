// Weightless fluid in a closed tank under the body force (0, γ0 t), from rest: what an observer sees in a
// tank that is accelerated by −γ0 t. Of an incompressible fluid nothing moves, u = 0 and p = ρ γ0 y t, y from
// mid-height, with the mean 0.
//
// A weakly compressible fluid must move to build its pressure up. For p = ρ γ0 y t + q and small u(y, t),
//   ∂u/∂t = −(1/ρ) ∂q/∂y,   ∂q/∂t = −ρ γ0 y − ρ c² ∂u/∂y,   u(±H/2) = 0,
// so that ∂²u/∂t² = c² ∂²u/∂y² + γ0: u swings about the parabola γ0 (H²/4 − y²)/(2c²) in the modes
// k_m = (2m + 1)π/H, and with it
//   q = −(ρ γ0/c) Σ_m [4 (−1)^m/(H k_m³)] sin(k_m y) sin(c k_m t).
// At the walls |q| <= ρ γ0 H²/(8c), met at ct = H/2, 3H/2, …: H/(4ct) of the pressure there. It does not
// decay, so that at a given time sound, not the discretisation, bounds how well any compressible scheme can
// agree with the incompressible limit: in a tank of 1 m with c = 80 m/s at t = 0.102 s (ct = 8.16 H) by 1.9 %
// of the pressure in L2, half a crossing on by 3.7 %. The terms left out are of the order γ0 H t/c², 1.6e-4.
// Of the slope of the pressure, the projection of p on y over that of ρ γ0 y t, is left
//   1 − (96/(H⁴ c t)) Σ_m sin(c k_m t)/k_m⁵.
#include "sphvv/analytic/solutions.hpp"

#include <cmath>
#include <numbers>

namespace sphvv::analytic::solutions {

const Solution& accelerated_tank();

namespace {

struct Constants {
    double H;     ///< m
    double W;     ///< m
    double rho;   ///< kg/m3
    double gamma; ///< m/s3, γ0
    double c0;    ///< m/s
};

Constants constants(const Values& given) {
    const Values values = resolve(accelerated_tank(), given);
    return {values.at("height"), values.at("width"), values.at("density"), values.at("force_rate"),
            values.at("sound_speed")};
}

Domain domain(const Values& given) {
    const Constants c = constants(given);
    return {{-c.W / 2, -c.H / 2, 0}, {c.W / 2, c.H / 2, 0}, {false, false, false}};
}

Medium medium(const Values& given) {
    return {constants(given).rho, 0, 0};
}

Vector force(const Values& given, double t) {
    return {0, constants(given).gamma * t, 0};
}

Evaluator bind(const Values& given) {
    return [c = constants(given)](const Vector& x, double t) {
        return State{{}, c.rho * c.gamma * x[1] * t, c.rho};
    };
}

std::vector<Boundary> four_walls(const Values& given) {
    const Domain box = domain(given);
    const auto wall = [&](std::string_view name, Face face) {
        return flat_boundary(name, BoundaryKind::impermeable, box, face);
    };
    return {wall("left wall", {0, false}), wall("right wall", {0, true}), wall("bottom", {1, false}),
            wall("top", {1, true})};
}

/// The terms fall as m⁻⁵.
double slope(const Constants& c, double t) {
    constexpr int terms = 300; // the rest is below 1e-12 of the first
    double sum = 0;
    for (int m = terms - 1; m >= 0; --m) {
        const double k = (2 * m + 1) * std::numbers::pi / c.H;
        sum += std::sin(c.c0 * k * t) / std::pow(k * c.H, 5);
    }
    const double crossings = c.c0 * t / c.H;
    return crossings > 0 ? 1 - 96 / crossings * sum : 0; // c t/H at first
}

Scalar pressure_slope(const Values& given) {
    return [c = constants(given)](const Vector&, double t) { return slope(c, t); };
}

} // namespace

const Solution& accelerated_tank() {
    static const Solution solution{
        .name = "accelerated_tank",
        .summary = "Fluid at rest in a closed tank under a body force that grows with time",
        .formula =
            "u = 0, p = ρ γ0 y t, y from mid-height, f = (0, γ0 t); of weakly compressible fluid p has the "
            "slope 1 − (96/(H⁴ c0 t)) Σ_m sin(c0 k_m t)/k_m⁵ of that, k_m = (2m + 1)π/H",
        .source = "G. Oger, M. Doring, B. Alessandrini & P. Ferrant, J. Comput. Phys. 225 (2007) 1472–1492; "
                  "the slope: derived in this file",
        .dimension = 2,
        .parameters =
            {
                {"height", "m", "H, along the force", 1, 1e-6, 1e6},
                {"width", "m", "W, across it", 1, 1e-6, 1e6},
                {"density", "kg/m3", "ρ", 1000, 1e-6, 1e6},
                {"force_rate", "m/s3", "γ0, rate at which the body force grows", -9.81, -1e6, 1e6},
                {"sound_speed", "m/s", "c0, in the slope alone", 80, 0.1, 1e12},
            },
        .domain = domain,
        .medium = medium,
        .bind = bind,
        .equations = Equations::hydrostatic,
        .boundaries = four_walls,
        .quantities = {{"pressure_slope", "1",
                        "projection on y of the pressure of the weakly compressible fluid, over that of ρ γ0 "
                        "y t",
                        pressure_slope}},
        .body_force = force,
    };
    return solution;
}

} // namespace sphvv::analytic::solutions
