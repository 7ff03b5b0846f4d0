// Plane channel between two walls at rest, driven by a uniform body force from t = 0.
//
// Either half of the channel is a layer between a wall and a plane without stress, so that the fields are
// those of layer_diffusion.hpp with the thickness D/2 and the force F: u = (F (D/2)²/2ν) f, du/dt = F + ν
// d²u/dy².
#include "sphvv/analytic/layer_diffusion.hpp"
#include "sphvv/analytic/solutions.hpp"

#include <algorithm>
#include <cmath>

namespace sphvv::analytic::solutions {

const Solution& poiseuille();

namespace {

struct Constants {
    double U;       ///< m/s, bulk velocity of the steady flow
    double D;       ///< m, between the walls
    double L;       ///< m, the period
    double rho;     ///< kg/m3
    double nu;      ///< m2/s
    double force;   ///< m/s2
    double scale;   ///< m/s, F (D/2)^2/(2 nu), the steady velocity in the middle
    double linear;  ///< share of the linear profile in the start
    double settled; ///< share of the steady profile in the start
};

/// nu = U D/Re, and F = 12 nu U/D^2 from the steady bulk velocity (2/3) F (D/2)^2/(2 nu) = U.
Constants constants(const Values& given) {
    const Values values = resolve(poiseuille(), given);
    const double U = values.at("speed");
    const double D = values.at("width");
    const double nu = U * D / values.at("re");
    return {U,
            D,
            values.at("length"),
            values.at("density"),
            nu,
            12 * nu * U / (D * D),
            1.5 * U,
            values.at("linear_start"),
            values.at("steady_start")};
}

/// The fields at the distance zeta D/2 from the nearer wall over the steady velocity in the middle: by
/// linearity the sum of the flows from rest, from the linear profile without force, and of the steady one.
layer::Profile profile(const Constants& c, double zeta, double t) {
    const double tau = 4 * c.nu * t / (c.D * c.D);
    const layer::Profile forced = layer::forced(zeta, tau);
    const layer::Profile released = layer::released(zeta, tau);
    const layer::Profile steady = layer::forced_steady(zeta);
    const auto sum = [&](double layer::Profile::*of) {
        return (1 - c.settled) * forced.*of + c.settled * steady.*of + c.linear * released.*of;
    };
    return {sum(&layer::Profile::value), sum(&layer::Profile::gradient), sum(&layer::Profile::mean)};
}

double zeta(const Constants& c, const Vector& x) {
    return 2 * std::min(x[1], c.D - x[1]) / c.D;
}

Domain domain(const Values& given) {
    const Constants c = constants(given);
    return {{0, 0, 0}, {c.L, c.D, 0}, {true, false, false}};
}

/// u minus the steady u obeys a maximum principle: in the middle it starts at (linear + settled − 1) times
/// the steady velocity, elsewhere lower if that is positive, and is negative everywhere if not.
Medium medium(const Values& given) {
    const Constants c = constants(given);
    return {c.rho, c.nu, c.scale * std::max(1., c.linear + c.settled), {c.force, 0, 0}};
}

Evaluator bind(const Values& given) {
    return [c = constants(given)](const Vector& x, double t) {
        return State{{c.scale * profile(c, zeta(c, x), t).value, 0, 0}, 0};
    };
}

double kinetic_energy(const Values& given, double t) {
    const Constants c = constants(given);
    const double tau = 4 * c.nu * t / (c.D * c.D);
    return c.scale * c.scale / 2 * layer::forced_square_mean(c.settled, c.linear, tau);
}

std::vector<Boundary> walls(const Values& given) {
    const Domain box = domain(given);
    return {flat_boundary("lower wall", BoundaryKind::no_slip, box, {1, false}),
            flat_boundary("upper wall", BoundaryKind::no_slip, box, {1, true})};
}

Scalar wall_shear_stress(const Values& given) {
    return [c = constants(given)](const Vector&, double t) {
        return c.rho * c.nu * c.scale * profile(c, 0, t).gradient * 2 / c.D;
    };
}

Scalar bulk_velocity(const Values& given) {
    return [c = constants(given)](const Vector&, double t) { return c.scale * profile(c, 0, t).mean; };
}

Scalar velocity_gradient(const Values& given) {
    return [c = constants(given)](const Vector& x, double t) {
        return std::copysign(c.scale * 2 / c.D, c.D / 2 - x[1]) * profile(c, zeta(c, x), t).gradient;
    };
}

Scalar driving_force(const Values& given) {
    return [c = constants(given)](const Vector&, double) { return c.force; };
}

} // namespace

const Solution& poiseuille() {
    static const Solution solution{
        .name = "poiseuille",
        .summary =
            "Plane channel of width D driven by a body force, from rest, from a linear profile or steady",
        .formula =
            "u = (F/2ν) y(D − y) − Σ (1 − s)(4FD²/νπ³k³) sin(kπy/D) e^{−k²π²νt/D²} "
            "+ Σ a (−1)^n (FD²/νπ²k²) sin(kπy/D) e^{−k²π²νt/D²}, k = 2n + 1, v = p = 0, F = 12νU/D², ν = "
            "UD/Re; "
            "s and a are the shares of the steady profile and of the linear one, (3U/D) min(y, D − y), in "
            "the "
            "start. τ = 4νt/D² < 0.1: images of the half-space solution instead; either within 1e-15 of 3U/2",
        .source = "H. Schlichting, Boundary-Layer Theory (7th ed. 1979) ch. V; H. S. Carslaw & J. C. Jaeger, "
                  "Conduction of Heat in Solids (2nd ed. 1959) ch. III (a slab that is heated evenly)",
        .dimension = 2,
        .parameters =
            {
                {"re", "1", "Reynolds number UD/ν", 10, 1e-3, 1e8},
                {"speed", "m/s", "U, bulk velocity of the steady flow", 1, 1e-6, 1e6},
                {"width", "m", "D, the distance between the walls", 1, 1e-6, 1e6},
                {"length", "m", "period along the channel", 1, 1e-6, 1e6},
                {"density", "kg/m3", "ρ", 1000, 1e-6, 1e6},
                {"linear_start", "1", "a, share of the profile that is linear on either side in the start", 0,
                 0, 1},
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
                {"wall_shear_stress", "Pa", "ρν |du/dy| at either wall at time t", wall_shear_stress},
                {"bulk_velocity", "m/s", "mean of u over the width at time t", bulk_velocity},
                {"velocity_gradient", "1/s", "du/dy at (x, t)", velocity_gradient},
                {"driving_force", "m/s2", "F = 12νU/D²", driving_force},
            },
    };
    return solution;
}

} // namespace sphvv::analytic::solutions
