#include "sphvv/solver/kernels.hpp"

#include <numbers>

namespace sphvv::solver::kernels {
namespace {

struct Profile {
    static constexpr double positive(double x) { return x > 0 ? x : 0; }
    static constexpr double power2(double x) { return x * x; }

    static double f(double q) {
        const double a = positive(2 - q);
        const double b = positive(1 - q);
        return (power2(a) * a - 4 * power2(b) * b) / 4;
    }
    static double bracket(double q) { return power2(positive(2 - q)) - 4 * power2(positive(1 - q)); }
    static double derivative(double q) { return -0.75 * bracket(q); }
    static double derivative_over_q(double q) {
        // For q < 1 the bracket is 4 q - 3 q^2: divided by q without cancellation.
        const double inner = 4 - 3 * q;
        const double outer = bracket(q) / (q < 1 ? 1 : q);
        return -0.75 * (q < 1 ? inner : outer);
    }
};

} // namespace

const Kernel& cubic_spline() {
    static const Kernel kernel{
        .name = "cubic_spline",
        .summary = "cubic spline, support 2h, two continuous derivatives",
        .formula = "[(2-q)^3_+ - 4 (1-q)^3_+]/4",
        .source = "Issa 2005 §3.2; Xu 2009 App. A; the same as 1 - 3q^2/2 + 3q^3/4 for q < 1",
        .support = 2,
        .normalisation = {0, 2.0 / 3, 10 / (7 * std::numbers::pi), 1 / std::numbers::pi},
        .smoothness = 2,
        .nonnegative_transform = {false, true, false, false},
        .f = Profile::f,
        .derivative = Profile::derivative,
        .slopes = kernel_slopes<Profile>,
        .values = kernel_values<Profile>,
    };
    return kernel;
}

} // namespace sphvv::solver::kernels
