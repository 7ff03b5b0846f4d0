// Channel with a bed at rest and a flat free surface, driven by a uniform body force from t = 0 (Issa's
// laminar case). The fluid is a layer between a wall and a plane without stress: u = (F H²/2ν) f with the
// functions f of layer_diffusion.hpp. Gravity acts across the flow and only makes the pressure.
#include "sphvv/analytic/layer_diffusion.hpp"
#include "sphvv/analytic/solutions.hpp"

#include <algorithm>

namespace sphvv::analytic::solutions {

const Solution& poiseuille_free_surface();

namespace {

struct Constants {
    double U;       ///< m/s, bulk velocity of the steady flow
    double H;       ///< m, depth
    double L;       ///< m, the period
    double rho;     ///< kg/m3
    double nu;      ///< m2/s
    double g;       ///< m/s2, downwards
    double force;   ///< m/s2
    double scale;   ///< m/s, F H^2/(2 nu), the steady velocity of the surface
    double linear;  ///< share of the linear profile in the start
    double settled; ///< share of the steady profile in the start
};

/// nu = U H/Re, and F = 3 nu U/H^2 from the steady bulk velocity (2/3) F H^2/(2 nu) = U.
Constants constants(const Values& given) {
    const Values values = resolve(poiseuille_free_surface(), given);
    const double U = values.at("speed");
    const double H = values.at("depth");
    const double nu = U * H / values.at("re");
    return {U,
            H,
            values.at("length"),
            values.at("density"),
            nu,
            values.at("gravity"),
            3 * nu * U / (H * H),
            1.5 * U,
            values.at("linear_start"),
            values.at("steady_start")};
}

/// The fields at the height zeta H over the steady velocity of the surface: by linearity the sum of the flows
/// from rest, from the linear profile without force, and of the steady one.
layer::Profile profile(const Constants& c, double zeta, double t) {
    const double tau = c.nu * t / (c.H * c.H);
    const layer::Profile forced = layer::forced(zeta, tau);
    const layer::Profile released = layer::released(zeta, tau);
    const layer::Profile steady = layer::forced_steady(zeta);
    const auto sum = [&](double layer::Profile::*of) {
        return (1 - c.settled) * forced.*of + c.settled * steady.*of + c.linear * released.*of;
    };
    return {sum(&layer::Profile::value), sum(&layer::Profile::gradient), sum(&layer::Profile::mean)};
}

Domain domain(const Values& given) {
    const Constants c = constants(given);
    return {{0, 0, 0}, {c.L, c.H, 0}, {true, false, false}};
}

/// u minus the steady u obeys a maximum principle: at the surface it starts at (linear + settled − 1) times
/// the steady velocity, elsewhere lower if that is positive, and is negative everywhere if not.
Medium medium(const Values& given) {
    const Constants c = constants(given);
    return {c.rho, c.nu, c.scale * std::max(1., c.linear + c.settled), {c.force, -c.g, 0}};
}

Evaluator bind(const Values& given) {
    return [c = constants(given)](const Vector& x, double t) {
        return State{{c.scale * profile(c, x[1] / c.H, t).value, 0, 0}, c.rho * c.g * (c.H - x[1])};
    };
}

double kinetic_energy(const Values& given, double t) {
    const Constants c = constants(given);
    return c.scale * c.scale / 2 * layer::forced_square_mean(c.settled, c.linear, c.nu * t / (c.H * c.H));
}

std::vector<Boundary> bed_and_surface(const Values& given) {
    const Domain box = domain(given);
    return {flat_boundary("bed", BoundaryKind::no_slip, box, {1, false}),
            flat_boundary("surface", BoundaryKind::free_surface, box, {1, true})};
}

Scalar wall_shear_stress(const Values& given) {
    return [c = constants(given)](const Vector&, double t) {
        return c.rho * c.nu * c.scale * profile(c, 0, t).gradient / c.H;
    };
}

Scalar bulk_velocity(const Values& given) {
    return [c = constants(given)](const Vector&, double t) { return c.scale * profile(c, 0, t).mean; };
}

Scalar velocity_gradient(const Values& given) {
    return [c = constants(given)](const Vector& x, double t) {
        return c.scale / c.H * profile(c, x[1] / c.H, t).gradient;
    };
}

Scalar driving_force(const Values& given) {
    return [c = constants(given)](const Vector&, double) { return c.force; };
}

} // namespace

const Solution& poiseuille_free_surface() {
    static const Solution solution{
        .name = "poiseuille_free_surface",
        .summary = "Laminar free-surface channel of depth H driven by a body force, from rest, from a linear "
                   "profile or steady",
        .formula = "u = (F/2ν) y(2H − y) − Σ (1 − s)(16FH²/νπ³k³) sin(kπy/2H) e^{−k²π²νt/4H²} "
                   "+ Σ a (−1)^n (4FH²/νπ²k²) sin(kπy/2H) e^{−k²π²νt/4H²}, k = 2n + 1, v = 0, p = ρg(H − y), "
                   "F = 3νU/H², ν = UH/Re; s and a are the shares of the steady profile and of the linear "
                   "one, FHy/2ν, "
                   "in the start. τ = νt/H² < 0.1: images of the half-space solution instead; either within "
                   "1e-15 of 3U/2",
        .source =
            "R. Issa, PhD thesis, UMIST, 2005, §4.2 (steady flow, linear start); transients after H. S. "
            "Carslaw & J. C. Jaeger, Conduction of Heat in Solids (2nd ed. 1959) ch. III",
        .dimension = 2,
        .parameters =
            {
                {"re", "1", "Reynolds number UH/ν", 10, 1e-3, 1e8},
                {"speed", "m/s", "U, bulk velocity of the steady flow", 0.25, 1e-6, 1e6},
                {"depth", "m", "H", 0.4, 1e-6, 1e6},
                {"length", "m", "period along the channel", 0.4, 1e-6, 1e6},
                {"density", "kg/m3", "ρ", 1000, 1e-6, 1e6},
                {"gravity", "m/s2", "g, downwards", 9.81, 0, 1e3},
                {"linear_start", "1", "a, share of the linear profile FHy/2ν in the start", 0, 0, 1},
                {"steady_start", "1", "s, share of the steady profile in the start; 1: steady at all times",
                 0, 0, 1},
            },
        .domain = domain,
        .medium = medium,
        .bind = bind,
        .kinetic_energy = kinetic_energy,
        .boundaries = bed_and_surface,
        .quantities =
            {
                {"wall_shear_stress", "Pa", "ρν du/dy at the bed at time t", wall_shear_stress},
                {"bulk_velocity", "m/s", "mean of u over the depth at time t", bulk_velocity},
                {"velocity_gradient", "1/s", "du/dy at (x, t)", velocity_gradient},
                {"driving_force", "m/s2", "F = 3νU/H²", driving_force},
            },
    };
    return solution;
}

} // namespace sphvv::analytic::solutions
