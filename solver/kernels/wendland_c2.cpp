#include "sphvv/solver/kernels.hpp"

#include <numbers>

namespace sphvv::solver::kernels {
namespace {

struct Profile {
    static constexpr double positive(double x) { return x > 0 ? x : 0; }

    static double f(double q) {
        const double a = positive(1 - q / 2);
        return a * a * a * a * (2 * q + 1);
    }
    static double derivative_over_q(double q) {
        const double a = positive(1 - q / 2);
        return -5 * a * a * a;
    }
    static double derivative(double q) { return q * derivative_over_q(q); }
};

} // namespace

const Kernel& wendland_c2() {
    static const Kernel kernel{
        .name = "wendland_c2",
        .summary = "Wendland C2, support 2h, positive Fourier transform (no pairing)",
        .formula = "(1-q/2)^4_+ (2q+1)",
        .source = "Wendland 1995; 2-D 7/(4 pi h^2), 3-D 21/(16 pi h^3): Xu 2009 prints 7/(8 pi h^3), which "
                  "integrates to 2/3",
        .support = 2,
        .normalisation = {0, 3.0 / 4, 7 / (4 * std::numbers::pi), 21 / (16 * std::numbers::pi)},
        .smoothness = 2,
        .nonnegative_transform = {false, true, true, true},
        .f = Profile::f,
        .derivative = Profile::derivative,
        .slopes = kernel_slopes<Profile>,
        .values = kernel_values<Profile>,
    };
    return kernel;
}

} // namespace sphvv::solver::kernels
