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
        return power2(power2(a) * a) * (1 + 6 * x + 35.0 / 3 * x * x);
    }
    static double derivative_over_q(double q) {
        const double a = positive(1 - q / 2);
        const double x = 1 - a;
        return -14.0 / 3 * power2(power2(a)) * a * (1 + 5 * x);
    }
    static double derivative(double q) { return q * derivative_over_q(q); }
};

} // namespace

const Kernel& wendland_c4() {
    static const Kernel kernel{
        .name = "wendland_c4",
        .summary = "Wendland C4, support 2h, positive Fourier transform (no pairing)",
        .formula = "(1-q/2)^6_+ (35/12 q^2 + 3q + 1)",
        .source = "Wendland 1995; Dehnen & Aly 2012 table 1 with H = 2h: 2-D 9/(4 pi h^2), 3-D 495/(256 pi "
                  "h^3). 1-D: "
                  "this same profile integrates to 32h/27, hence 27/(32h); their 3/(4h) belongs to the 1-D "
                  "polynomial (1-q/2)^5 (2q^2 + 5q/2 + 1)",
        .support = 2,
        .normalisation = {0, 27.0 / 32, 9 / (4 * std::numbers::pi), 495 / (256 * std::numbers::pi)},
        .smoothness = 4,
        .nonnegative_transform = {false, true, true, true},
        .f = Profile::f,
        .derivative = Profile::derivative,
        .slopes = kernel_slopes<Profile>,
        .values = kernel_values<Profile>,
    };
    return kernel;
}

} // namespace sphvv::solver::kernels
