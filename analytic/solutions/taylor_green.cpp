// Two-dimensional decaying Taylor–Green vortices on a doubly periodic square.
#include "sphvv/analytic/solutions.hpp"

#include <cmath>
#include <numbers>

namespace sphvv::analytic::solutions {

const Solution& taylor_green();

namespace {

struct Constants {
    double U;     ///< m/s
    double D;     ///< m
    double rho;   ///< kg/m3
    double nu;    ///< m2/s
    double kappa; ///< 1/s, negative
};

/// The constants of Xu 2009 §4.1: nu = U D/Re, kappa = -8 pi^2 nu/D^2.
Constants constants(const Values& given) {
    using std::numbers::pi;
    const Values values = resolve(taylor_green(), given);
    const double U = values.at("speed");
    const double D = values.at("length");
    const double nu = U * D / values.at("re");
    return {U, D, values.at("density"), nu, -8 * pi * pi * nu / (D * D)};
}

Domain domain(const Values& given) {
    const double D = constants(given).D;
    return {{-D / 2, -D / 2, 0}, {D / 2, D / 2, 0}, {true, true, false}};
}

/// The speed is largest at t = 0, where cos^2 X sin^2 Y + sin^2 X cos^2 Y <= 1 with equality at X = 0, Y =
/// pi/2.
Medium medium(const Values& given) {
    const Constants c = constants(given);
    return {c.rho, c.nu, c.U};
}

Evaluator bind(const Values& given) {
    return [c = constants(given)](const Vector& x, double t) {
        const double X = 2 * std::numbers::pi * x[0] / c.D;
        const double Y = 2 * std::numbers::pi * x[1] / c.D;
        const double U = c.U * std::exp(c.kappa * t);
        return State{{-U * std::cos(X) * std::sin(Y), U * std::sin(X) * std::cos(Y), 0},
                     -c.rho * U * U / 4 * (std::cos(2 * X) + std::cos(2 * Y))};
    };
}

double kinetic_energy(const Values& given, double t) {
    const Constants c = constants(given);
    return c.U * c.U / 4 * std::exp(2 * c.kappa * t);
}

} // namespace

const Solution& taylor_green() {
    static const Solution solution{
        .name = "taylor_green",
        .summary = "Two-dimensional Taylor–Green vortices decaying in a doubly periodic square of side D",
        .formula = "u = −U e^{κt} cos(2πx/D) sin(2πy/D), v = U e^{κt} sin(2πx/D) cos(2πy/D), "
                   "P = −(ρU²/4) e^{2κt} (cos(4πx/D) + cos(4πy/D)), κ = −8π²ν/D², ν = UD/Re",
        .source = "R. Xu, PhD thesis, Univ. of Manchester, 2009, §4.1; after G. I. Taylor & A. E. Green, "
                  "Proc. R. Soc. Lond. A 158 (1937) 499–521",
        .dimension = 2,
        .parameters =
            {
                {"re", "1", "Reynolds number UD/ν", 100, 1e-3, 1e8},
                {"speed", "m/s", "U, the largest speed at t = 0", 1, 1e-6, 1e6},
                {"length", "m", "D, the period and the side of the square", 1, 1e-6, 1e6},
                {"density", "kg/m3", "ρ", 1000, 1e-6, 1e6},
            },
        .domain = domain,
        .medium = medium,
        .bind = bind,
        .kinetic_energy = kinetic_energy,
    };
    return solution;
}

} // namespace sphvv::analytic::solutions
