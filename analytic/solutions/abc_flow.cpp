// Arnold–Beltrami–Childress flow decaying in a periodic cube.
//
// The velocity is a Beltrami field, curl u = k u, so that (u·∇)u = ∇|u|²/2 − u × curl u = ∇|u|²/2 is balanced
// by the pressure alone, and ∇²u = −curl curl u = −k²u leaves ∂u/∂t = −νk²u.
#include "sphvv/analytic/solutions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace sphvv::analytic::solutions {

const Solution& abc_flow();

namespace {

struct Constants {
    double A;   ///< m/s
    double B;   ///< m/s
    double C;   ///< m/s
    double U;   ///< m/s, the volume-rms speed at t = 0
    double D;   ///< m
    double rho; ///< kg/m3
    double nu;  ///< m2/s
    double k;   ///< 1/m
};

/// nu = U D/Re, k = 2 pi/D, and (A, B, C) = (a, b, c) U/sqrt(a^2 + b^2 + c^2): the mean of |u|^2 at t = 0 is
/// A^2 + B^2 + C^2, because each squared sine or cosine has the mean 1/2 and their products with each other
/// have none.
Constants constants(const Values& given) {
    const Values values = resolve(abc_flow(), given);
    const double a = values.at("a");
    const double b = values.at("b");
    const double c = values.at("c");
    const double U = values.at("speed");
    const double D = values.at("length");
    const double scale = U / std::hypot(a, b, c);
    return {a * scale,
            b * scale,
            c * scale,
            U,
            D,
            values.at("density"),
            U * D / values.at("re"),
            2 * std::numbers::pi / D};
}

Domain domain(const Values& given) {
    const double D = constants(given).D;
    return {{-D / 2, -D / 2, -D / 2}, {D / 2, D / 2, D / 2}, {true, true, true}};
}

/// The largest speed at t = 0, exact for all amplitudes. With L the largest amplitude and R^2 the sum of the
/// squares of the other two: sqrt(2) U where L <= R (so for equal amplitudes), else L + R.
///
/// L <= R: (p + q)^2 <= 2 p^2 + 2 q^2 in each component gives |u|^2 <= 2 (A^2 + B^2 + C^2) = 2 U^2, with
/// equality where A sin Z = C cos Y, B sin X = A cos Z, C sin Y = B cos X: solved by sin^2 X = (A^2 + B^2 -
/// C^2)/(2 B^2) and so on. L > R, say L = A: |u|^2/2 = U^2/2 + A (C sin Z cos Y + B sin X cos Z) + B C sin Y
/// cos X
/// <= U^2/2 + A m + (R^2 - m^2)/2 with m^2 = C^2 cos^2 Y + B^2 sin^2 X <= R^2, which grows with m up to
/// (A + R)^2/2 at m = R.
double maximum_speed(const Constants& constants) {
    std::array amplitudes{constants.A, constants.B, constants.C};
    std::ranges::sort(amplitudes);
    const double L = amplitudes[2];
    const double R = std::hypot(amplitudes[0], amplitudes[1]);
    return L <= R ? std::numbers::sqrt2 * constants.U : L + R;
}

Medium medium(const Values& given) {
    const Constants c = constants(given);
    return {c.rho, c.nu, maximum_speed(c)};
}

Evaluator bind(const Values& given) {
    return [c = constants(given)](const Vector& x, double t) {
        const double sinX = std::sin(c.k * x[0]), cosX = std::cos(c.k * x[0]);
        const double sinY = std::sin(c.k * x[1]), cosY = std::cos(c.k * x[1]);
        const double sinZ = std::sin(c.k * x[2]), cosZ = std::cos(c.k * x[2]);
        const double decay = std::exp(-c.nu * c.k * c.k * t);
        const Vector u{(c.A * sinZ + c.C * cosY) * decay, (c.B * sinX + c.A * cosZ) * decay,
                       (c.C * sinY + c.B * cosX) * decay};
        // (|u|^2 - its mean)/2 without the cancellation of the two
        const double excess =
            (c.A * c.C * sinZ * cosY + c.B * c.A * sinX * cosZ + c.C * c.B * sinY * cosX) * decay * decay;
        return State{u, -c.rho * excess};
    };
}

double kinetic_energy(const Values& given, double t) {
    const Constants c = constants(given);
    return c.U * c.U / 2 * std::exp(-2 * c.nu * c.k * c.k * t);
}

} // namespace

const Solution& abc_flow() {
    static const Solution solution{
        .name = "abc_flow",
        .summary = "Three-dimensional Arnold–Beltrami–Childress flow decaying in a periodic cube of side D",
        .formula = "u = (A sin kz + C cos ky, B sin kx + A cos kz, C sin ky + B cos kx) e^{−νk²t}, "
                   "p = −ρ(|u|² − ⟨|u|²⟩)/2, k = 2π/D, ν = UD/Re, (A, B, C) = (a, b, c) U/√(a² + b² + c²)",
        .source =
            "T. Dombre, U. Frisch, J. M. Greene, M. Hénon, A. Mehr & A. M. Soward, J. Fluid Mech. 167 (1986) "
            "353–391; the viscous decay of Beltrami flows after V. Trkal, Časopis pro pěstování mathematiky "
            "a "
            "fysiky 48 (1919) 302–311",
        .dimension = 3,
        .parameters =
            {
                {"re", "1", "Reynolds number UD/ν", 100, 1e-3, 1e8},
                {"speed", "m/s", "U, the volume-rms speed at t = 0", 1, 1e-6, 1e6},
                {"length", "m", "D, the period and the side of the cube", 1, 1e-6, 1e6},
                {"density", "kg/m3", "ρ", 1000, 1e-6, 1e6},
                {"a", "1",
                 "relative amplitude of the waves in z; positive, so that the flow never vanishes (a cyclic "
                 "permutation of the axes permutes a, b and c)",
                 1, 1e-3, 1e3},
                {"b", "1", "relative amplitude of the waves in x", 1, 0, 1e3},
                {"c", "1", "relative amplitude of the waves in y", 1, 0, 1e3},
            },
        .domain = domain,
        .medium = medium,
        .bind = bind,
        .kinetic_energy = kinetic_energy,
    };
    return solution;
}

} // namespace sphvv::analytic::solutions
