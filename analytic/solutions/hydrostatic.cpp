// Column of a weakly compressible fluid at rest under gravity, by Tait's equation of state
// p = (ρ0 c0²/γ)[(ρ/ρ0)^γ − 1] for any γ >= 1, settled from a uniform density ρ0 of depth H_i.
//
// dp/dy = −ρg integrates to (ρ/ρ0)^{γ−1} = 1 + (γ − 1) s with s = g (H − y)/c0²; the weight of the column is
// that of its start, so that the pressure at the bed is ρ0 g H_i, which gives H. With
//   l = log1p((γ − 1) s)/(γ − 1)   (s for γ = 1):   ρ = ρ0 e^l,   p = (ρ0 c0²/γ) expm1(γ l)
// neither the limit γ → 1 (ρ = ρ0 e^s) nor c0 → ∞ (p = ρ0 g (H − y)) loses digits by cancellation.
#include "sphvv/analytic/solutions.hpp"

#include <cmath>

namespace sphvv::analytic::solutions {

const Solution& hydrostatic();

namespace {

struct Constants {
    double start_depth; ///< m, H_i
    double L;           ///< m, the period
    double rho;         ///< kg/m3, rho0
    double c0;          ///< m/s
    double excess;      ///< gamma - 1
    double g;           ///< m/s2
    double depth;       ///< m, H
};

/// log(1 + e x)/e, and x for e = 0.
double log_of_power(double e, double x) {
    return e > 0 ? std::log1p(e * x) / e : x;
}

/// H = (c0²/g) expm1((γ − 1) m)/(γ − 1) with m = log1p(γ g H_i/c0²)/γ; (c0²/g) m for γ = 1.
double settled_depth(double start_depth, double c0, double excess, double g) {
    const double m = log_of_power(1 + excess, g * start_depth / (c0 * c0));
    return c0 * c0 / g * (excess > 0 ? std::expm1(excess * m) / excess : m);
}

Constants constants(const Values& given) {
    const Values values = resolve(hydrostatic(), given);
    Constants c{values.at("depth"),
                values.at("length"),
                values.at("density"),
                values.at("sound_speed"),
                values.at("gamma") - 1,
                values.at("gravity"),
                0};
    c.depth = settled_depth(c.start_depth, c.c0, c.excess, c.g);
    return c;
}

Domain domain(const Values& given) {
    const Constants c = constants(given);
    return {{0, 0, 0}, {c.L, c.depth, 0}, {true, false, false}};
}

Medium medium(const Values& given) {
    const Constants c = constants(given);
    return {c.rho, 0, 0, {0, -c.g, 0}};
}

State state(const Constants& c, double y) {
    const double l = log_of_power(c.excess, c.g * (c.depth - y) / (c.c0 * c.c0));
    const double gamma = 1 + c.excess;
    return {{}, c.rho * c.c0 * c.c0 / gamma * std::expm1(gamma * l), c.rho * std::exp(l)};
}

Evaluator bind(const Values& given) {
    return [c = constants(given)](const Vector& x, double) { return state(c, x[1]); };
}

std::vector<Boundary> bed_and_surface(const Values& given) {
    const Domain box = domain(given);
    return {flat_boundary("bed", BoundaryKind::no_slip, box, {1, false}),
            flat_boundary("surface", BoundaryKind::free_surface, box, {1, true})};
}

Scalar depth(const Values& given) {
    return [c = constants(given)](const Vector&, double) { return c.depth; };
}

Scalar bed_pressure(const Values& given) {
    return [c = constants(given)](const Vector&, double) { return c.rho * c.g * c.start_depth; };
}

Scalar motion(const Values& given) {
    resolve(hydrostatic(), given);
    return [](const Vector&, double) { return 0.; };
}

} // namespace

const Solution& hydrostatic() {
    static const Solution solution{
        .name = "hydrostatic",
        .summary = "Weakly compressible column at rest under gravity, settled from a uniform density",
        .formula =
            "ρ = ρ0 [1 + (γ − 1) g(H − y)/c0²]^{1/(γ−1)}, p = (ρ0c0²/γ)([1 + (γ − 1) g(H − y)/c0²]^{γ/(γ−1)} "
            "− "
            "1), H = {[1 + γgH_i/c0²]^{(γ−1)/γ} − 1} c0²/(g(γ − 1)), u = 0; γ = 1: ρ = ρ0 e^{g(H−y)/c0²}, "
            "p = c0²(ρ − ρ0), H = (c0²/g) ln(1 + gH_i/c0²); p(0) = ρ0gH_i",
        .source =
            "R. Issa, PhD thesis, UMIST, 2005, §4.1; G. Oger, M. Doring, B. Alessandrini & P. Ferrant, J. "
            "Comput. Phys. 225 (2007) 1472–1492, whose exponent of p, 1/(γ − 1), is a misprint",
        .dimension = 2,
        .parameters =
            {
                {"depth", "m", "H_i, depth of the start with the density ρ0 everywhere", 0.4, 1e-6, 1e6},
                {"length", "m", "period along the bed", 0.4, 1e-6, 1e6},
                {"gravity", "m/s2", "g, downwards", 9.81, 1e-6, 1e6},
                {"density", "kg/m3", "ρ0, where p = 0", 1000, 1e-6, 1e6},
                {"sound_speed", "m/s", "c0, where p = 0", 50, 0.1, 1e12},
                {"gamma", "1", "γ, exponent of Tait's equation; 1: linear", 7, 1, 20},
            },
        .domain = domain,
        .medium = medium,
        .bind = bind,
        .equations = Equations::hydrostatic,
        .boundaries = bed_and_surface,
        .quantities =
            {
                {"settled_depth", "m", "H", depth},
                {"bed_pressure", "Pa", "ρ0gH_i, the weight of the start", bed_pressure},
                {"motion", "1", "kinetic energy over M g H: none", motion},
            },
    };
    return solution;
}

} // namespace sphvv::analytic::solutions
