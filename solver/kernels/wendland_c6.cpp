#include "sphvv/solver/kernels.hpp"

#include <numbers>

namespace sphvv::solver::kernels {
namespace {

struct Profile {
    static constexpr double positive(double x) { return x > 0 ? x : 0; }
    static constexpr double power2(double x) { return x * x; }

    static double f(double q) {
        const double a = positive(1 - q / 2);
        const double x = 1 - a; // q/2, and 1 beyond the support, so that nothing overflows
        return power2(power2(power2(a))) * (1 + x * (8 + x * (25 + x * 32)));
    }
    static double derivative_over_q(double q) {
        const double a = positive(1 - q / 2);
        const double x = 1 - a;
        return -5.5 * power2(power2(a) * a) * a * (1 + x * (7 + x * 16));
    }
    static double derivative(double q) { return q * derivative_over_q(q); }
};

} // namespace

const Kernel& wendland_c6() {
    static const Kernel kernel{
        .name = "wendland_c6",
        .summary = "Wendland C6, support 2h, positive Fourier transform (no pairing)",
        .formula = "(1-q/2)^8_+ (4q^3 + 25/4 q^2 + 4q + 1)",
        .source =
            "Wendland 1995; Dehnen & Aly 2012 table 1 with H = 2h: 2-D 39/(14 pi h^2), 3-D 1365/(512 pi "
            "h^3). "
            "1-D: this same profile integrates to 16h/15, hence 15/(16h); their 55/(64h) belongs to the "
            "1-D polynomial (1-q/2)^7 (21/8 q^3 + 19/4 q^2 + 7/2 q + 1)",
        .support = 2,
        .normalisation = {0, 15.0 / 16, 39 / (14 * std::numbers::pi), 1365 / (512 * std::numbers::pi)},
        .smoothness = 6,
        .nonnegative_transform = {false, true, true, true},
        .f = Profile::f,
        .derivative = Profile::derivative,
        .slopes = kernel_slopes<Profile>,
        .values = kernel_values<Profile>,
    };
    return kernel;
}

} // namespace sphvv::solver::kernels
