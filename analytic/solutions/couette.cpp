// Plane Couette flow: the upper of two walls moves in its plane from t = 0, after layer_diffusion.hpp.
#include "sphvv/analytic/layer_diffusion.hpp"
#include "sphvv/analytic/solutions.hpp"

namespace sphvv::analytic::solutions {

const Solution& couette();

namespace {

struct Constants {
    double V;       ///< m/s, of the upper wall
    double D;       ///< m, between the walls
    double L;       ///< m, the period
    double rho;     ///< kg/m3
    double nu;      ///< m2/s
    double settled; ///< share of the steady profile in the start
};

/// nu = V D/Re.
Constants constants(const Values& given) {
    const Values values = resolve(couette(), given);
    const double V = values.at("speed");
    const double D = values.at("width");
    return {
        V, D, values.at("length"), values.at("density"), V * D / values.at("re"), values.at("steady_start")};
}

layer::Profile profile(const Constants& c, double zeta, double t) {
    const layer::Profile f = layer::dragged(zeta, c.nu * t / (c.D * c.D));
    return {(1 - c.settled) * f.value + c.settled * zeta, (1 - c.settled) * f.gradient + c.settled,
            (1 - c.settled) * f.mean + c.settled / 2};
}

Domain domain(const Values& given) {
    const Constants c = constants(given);
    return {{0, 0, 0}, {c.L, c.D, 0}, {true, false, false}};
}

Medium medium(const Values& given) {
    const Constants c = constants(given);
    return {c.rho, c.nu, c.V};
}

Evaluator bind(const Values& given) {
    return [c = constants(given)](const Vector& x, double t) {
        return State{{c.V * profile(c, x[1] / c.D, t).value, 0, 0}, 0};
    };
}

double kinetic_energy(const Values& given, double t) {
    const Constants c = constants(given);
    return c.V * c.V / 2 * layer::dragged_square_mean(c.settled, c.nu * t / (c.D * c.D));
}

std::vector<Boundary> walls(const Values& given) {
    const Domain box = domain(given);
    return {flat_boundary("lower wall", BoundaryKind::no_slip, box, {1, false}),
            flat_boundary("upper wall", BoundaryKind::no_slip, box, {1, true}, {constants(given).V, 0, 0})};
}

Scalar wall_shear_stress(const Values& given) {
    return [c = constants(given)](const Vector&, double t) {
        return c.rho * c.nu * c.V * profile(c, 0, t).gradient / c.D;
    };
}

Scalar moving_wall_shear_stress(const Values& given) {
    return [c = constants(given)](const Vector&, double t) {
        return c.rho * c.nu * c.V * profile(c, 1, t).gradient / c.D;
    };
}

Scalar bulk_velocity(const Values& given) {
    return [c = constants(given)](const Vector&, double t) { return c.V * profile(c, 0, t).mean; };
}

} // namespace

const Solution& couette() {
    static const Solution solution{
        .name = "couette",
        .summary = "Plane Couette flow between walls D apart, the upper set going at t = 0, or steady",
        .formula =
            "u = V [y/D + (1 − s) Σ (−1)^n (2/nπ) sin(nπy/D) e^{−n²π²νt/D²}], n = 1, 2, …, v = p = 0, "
            "ν = VD/Re, s the share of the steady profile in the start. τ = νt/D² < 0.1: images "
            "Σ [erfc((2m + 1 − y/D)/2√τ) − erfc((2m + 1 + y/D)/2√τ)] instead; either within 1e-15 of V",
        .source =
            "H. Schlichting, Boundary-Layer Theory (7th ed. 1979) ch. V, formation of Couette flow; H. S. "
            "Carslaw & J. C. Jaeger, Conduction of Heat in Solids (2nd ed. 1959) ch. III, XII",
        .dimension = 2,
        .parameters =
            {
                {"re", "1", "Reynolds number VD/ν", 10, 1e-3, 1e8},
                {"speed", "m/s", "V, velocity of the upper wall", 1, 1e-6, 1e6},
                {"width", "m", "D, the distance between the walls", 1, 1e-6, 1e6},
                {"length", "m", "period along the walls", 1, 1e-6, 1e6},
                {"density", "kg/m3", "ρ", 1000, 1e-6, 1e6},
                {"steady_start", "1", "s, share of the steady profile in the start; 1: steady at all times",
                 0, 0, 1},
            },
        .domain = domain,
        .medium = medium,
        .bind = bind,
        .kinetic_energy = kinetic_energy,
        .boundaries = walls,
        .quantities =
            {
                {"wall_shear_stress", "Pa", "ρν du/dy at the wall at rest at time t", wall_shear_stress},
                {"moving_wall_shear_stress", "Pa", "ρν du/dy at the moving wall at time t",
                 moving_wall_shear_stress},
                {"bulk_velocity", "m/s", "mean of u over the width at time t", bulk_velocity},
            },
    };
    return solution;
}

} // namespace sphvv::analytic::solutions
