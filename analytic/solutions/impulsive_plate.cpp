// Vertical plate set going impulsively into water of depth d at rest, without gravity: the flow just after
// the impulse, and the elevation to first order in time (Peregrine 1972).
//
// φ with ∇²φ = 0, ∂φ/∂x = U on the plate x = 0, ∂φ/∂y = 0 on the bed y = 0, φ = 0 on the surface y = d is the
// real part of F(z) = −Σ (2U (−1)^n/(d k_n²)) e^{−k_n z}, k_n = (n + ½)π/d, z = x + iy. With q = e^{−πz/2d}
// the series are
//   F = −(8Ud/π²) Ti₂(q), the inverse tangent integral Ti₂(q) = Σ (−1)^n q^{2n+1}/(2n+1)²,
//   u − iv = dF/dz = (4U/π) arctan q = (2iU/π) ln tanh(πζ/4d), ζ = x + i(y − d),
// of which the last has its singular point, the corner of plate and surface, at ζ = 0, where digits are
// wanted. On the surface v = −(2U/π) ln tanh(πx/4d), and η = vt. The pressure impulse is ∫p dt = −ρφ.
//
// What the corner means for errors. With ζ = r e^{iα}, near r = 0
//   φ = −(2U/π) r {sin α [ln(πr/4d) − 1] + α cos α},  u − iv = (2iU/π)[ln(πr/4d) + iα],
// so that |∇^m φ| = (2U/π)(m − 2)! r^{1−m} for m >= 2. Scaled with the spacing dx every ladder sees the same
// corner (a factor ln dx only adds a linear field, which is resolved), hence an error e = U dx E(r/dx, α).
// Where r >> dx a method of second order leaves ∇²e of the size U dx² r^{−3}. The field that answers this is
// of the size r^{−1}, as is the flow that the corner itself can send out: with φ = 0 on one side of the right
// angle and ∂φ/∂n = 0 on the other these are r^{±1}, r^{±3}, …. The two being in resonance,
//   |e| ~ U dx² r^{−1} ln(r/dx) and |∇e| ~ U dx² r^{−2} ln(r/dx) for r > dx; U dx and U for r ~ dx.
// Over the area, to within powers of ln(d/dx):
//   | norm of the error            | L1 | L2 | L∞ |
//   |------------------------------|----|----|----|
//   | potential, impulse           | 2  | 2  | 1  |
//   | velocity                     | 2  | 1  | 0  |
//   | either, r > a fixed distance | 2  | 2  | 2  |
// Leaving out the cells at the corner (r < m dx, m fixed) changes factors, not orders: the L2 of the velocity
// keeps dx/m of it. The largest exact velocity itself grows as (2U/π) ln(d/r_min), so the relative L∞ of the
// velocity falls as 1/ln(d/dx) only and means nothing. A method of first order leaves |e| ~ U dx and |∇e| ~ U
// dx/r, so order 1 in L1 and L2 of both and the same L∞. tests/impulsive_plate.cpp measures the table with a
// five-point Laplacian: between 64 and 128 cells over the depth 1.97, 1.88, 1.00 (potential) and 1.75, 1.01,
// 0.00 (velocity), a logarithm short of 2 where all distances count alike; 1.96, 1.87, 1.00 and 1.72, 1.00,
// 0.00 without r < 3 dx; 1.99 everywhere without r < d/4.
//
// What first order in time can judge: the impulse and the velocity of the first step; the elevation, away
// from the plate, for Ut/d << 1, with a relative error of the order of Ut/d (0.08 to 0.32 at the published
// instants), which is also what measuring x from the first or from the present position of the plate makes.
// It cannot judge the jet: at x ~ Ut ln(d/Ut) terms of second order are as large as those of first, and η → ∞
// at the plate though its volume is right, ∫η dx = Utd.
#include "sphvv/analytic/solutions.hpp"

#include <gsl/gsl_sf_dilog.h>
#include <gsl/gsl_sf_result.h>
#include <gsl/gsl_sf_zeta.h>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace sphvv::analytic::solutions {

const Solution& impulsive_plate();

namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

struct Constants {
    double U;   ///< m/s
    double d;   ///< m
    double L;   ///< m, how far the box reaches
    double rho; ///< kg/m3
};

Constants constants(const Values& given) {
    const Values values = resolve(impulsive_plate(), given);
    return {values.at("speed"), values.at("depth"), values.at("length"), values.at("density")};
}

/// ln tanh(w) for Re w >= 0, w != 0. Where tanh w is near 1 as −2 artanh(e^{−2w}), which keeps the relative
/// accuracy.
Complex log_tanh(const Complex& w) {
    return w.real() > 0.5 ? -2. * std::atanh(std::exp(-2. * w)) : std::log(std::tanh(w));
}

/// u − iv (m/s); infinite at the corner of plate and surface.
Complex complex_velocity(const Constants& c, const Vector& x) {
    const Complex zeta(x[0], x[1] - c.d);
    return Complex(0, 2 * c.U / pi) * log_tanh(pi * zeta / (4 * c.d));
}

/// Li₂ of a number of the closed unit disc.
Complex dilogarithm(const Complex& w) {
    gsl_sf_result re;
    gsl_sf_result im;
    gsl_sf_complex_dilog_e(std::abs(w), std::arg(w), &re, &im);
    return {re.val, im.val};
}

/// F(z) = φ + iψ (m2/s), by Ti₂(q) = [Li₂(iq) − Li₂(−iq)]/2i.
Complex complex_potential(const Constants& c, const Vector& x) {
    const Complex iq = std::exp(-pi * Complex(x[0], x[1] - c.d) / (2 * c.d)); // i e^{−iπ/2} = 1
    return -8 * c.U * c.d / (pi * pi) * (dilogarithm(iq) - dilogarithm(-iq)) / Complex(0, 2);
}

Domain domain(const Values& given) {
    const Constants c = constants(given);
    return {{0, 0, 0}, {c.L, c.d, 0}, {false, false, false}};
}

Medium medium(const Values& given) {
    return {constants(given).rho, 0, std::numeric_limits<double>::infinity()};
}

Evaluator bind(const Values& given) {
    return [c = constants(given)](const Vector& x, double) {
        const Complex w = complex_velocity(c, x);
        return State{{w.real(), -w.imag(), 0}, std::numeric_limits<double>::quiet_NaN()};
    };
}

/// Mean over the box, by Green's formula (U²/Ld²) Σ (1 − e^{−2k_n L})/k_n³; the sum without the exponential
/// is 7ζ(3)d³/π³, and over the semi-infinite tank the energy is half the plate's impulse times U.
double kinetic_energy(const Values& given, double) {
    const Constants c = constants(given);
    double sum = 7 * gsl_sf_zeta_int(3) / std::pow(pi, 3);
    for (int n = 0;; ++n) {
        const double k = (n + 0.5) * pi;
        const double beyond = std::exp(-2 * k * c.L / c.d) / (k * k * k);
        sum -= beyond;
        if (beyond < 1e-17) {
            break;
        }
    }
    return c.U * c.U * c.d / c.L * sum;
}

std::vector<Boundary> plate_bed_and_surface(const Values& given) {
    const Domain box = domain(given);
    return {flat_boundary("plate", BoundaryKind::impermeable, box, {0, false}, {constants(given).U, 0, 0}),
            flat_boundary("bed", BoundaryKind::impermeable, box, {1, false}),
            flat_boundary("surface", BoundaryKind::free_surface, box, {1, true})};
}

Scalar potential(const Values& given) {
    return [c = constants(given)](const Vector& x, double) { return complex_potential(c, x).real(); };
}

Scalar impulse(const Values& given) {
    return
        [c = constants(given)](const Vector& x, double) { return -c.rho * complex_potential(c, x).real(); };
}

Scalar elevation(const Values& given) {
    return [c = constants(given)](const Vector& x, double t) {
        return -2 * c.U * t / pi * log_tanh(pi * x[0] / (4 * c.d)).real();
    };
}

Scalar plate_impulse(const Values& given) {
    return [c = constants(given)](const Vector&, double) {
        return 14 * gsl_sf_zeta_int(3) / std::pow(pi, 3) * c.rho * c.U * c.d * c.d;
    };
}

Scalar bed_impulse(const Values& given) {
    return [c = constants(given)](const Vector&, double) { return c.rho * c.U * c.d * c.d / 2; };
}

Scalar foot_impulse(const Values& given) {
    constexpr double catalan = 0.915965594177219015;
    return
        [c = constants(given)](const Vector&, double) { return 8 * catalan / (pi * pi) * c.rho * c.U * c.d; };
}

Scalar displaced_volume(const Values& given) {
    return [c = constants(given)](const Vector&, double t) { return c.U * t * c.d; };
}

} // namespace

const Solution& impulsive_plate() {
    static const Solution solution{
        .name = "impulsive_plate",
        .summary =
            "Vertical plate set going into still water without gravity: impulse, velocity, first elevation",
        .formula =
            "u − iv = (2iU/π) ln tanh(π(x + iy − id)/4d) = (4U/π) arctan e^{−π(x+iy)/2d}, "
            "φ = −Σ (2U(−1)^n/(d k²)) e^{−kx} cos ky, k = (n + ½)π/d, ∫p dt = −ρφ, "
            "η = −(2Ut/π) ln tanh(πx/4d), just after t = 0 and to first order in t; tank without end (the "
            "box's end at L lets through (4U/π) e^{−πL/2d}, and an end wall there would add the share "
            "2e^{−πL/d} to the impulse)",
        .source =
            "D. H. Peregrine, Flow due to a vertical plate moving in a channel (unpublished, 1972), as in R. "
            "Xu, PhD thesis, Univ. of Manchester, 2009, §6.4; corner: A. C. King & D. J. Needham, J. Fluid "
            "Mech. 268 (1994) 89–101",
        .dimension = 2,
        .parameters =
            {
                {"speed", "m/s", "U, velocity of the plate, into the water", 1, 1e-6, 1e6},
                {"depth", "m", "d", 0.5, 1e-6, 1e6},
                {"length", "m", "L, how far from the plate the box reaches", 2, 1e-6, 1e6},
                {"density", "kg/m3", "ρ", 1000, 1e-6, 1e6},
            },
        .domain = domain,
        .medium = medium,
        .bind = bind,
        .kinetic_energy = kinetic_energy,
        .equations = Equations::impulsive,
        .boundaries = plate_bed_and_surface,
        .quantities =
            {
                {"potential", "m2/s", "φ at x just after the impulse", potential},
                {"impulse", "Pa s", "∫p dt = −ρφ at x over the impulse", impulse},
                {"elevation", "m", "η at x[0] and t, above y = d, to first order in t", elevation},
                {"plate_impulse", "N s/m", "∫∫p dt dy on the plate, 14ζ(3)/π³ ρUd² = 0.5427545 ρUd²",
                 plate_impulse},
                {"bed_impulse", "N s/m", "∫∫p dt dx on the bed, ρUd²/2", bed_impulse},
                {"foot_impulse", "Pa s", "∫p dt at the foot of the plate, 8G/π² ρUd = 0.7424537 ρUd",
                 foot_impulse},
                {"displaced_volume", "m2", "∫η dx = Utd", displaced_volume},
            },
    };
    return solution;
}

} // namespace sphvv::analytic::solutions
