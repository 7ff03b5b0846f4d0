#include "sphvv/solver/kernels.hpp"

#include <numbers>

namespace sphvv::solver::kernels {
namespace {

struct Profile {
    static constexpr double positive(double x) { return x > 0 ? x : 0; }
    static constexpr double power4(double x) { return x * x * x * x; }

    static double f(double q) {
        const double a = positive(3 - q);
        const double b = positive(2 - q);
        const double c = positive(1 - q);
        return power4(a) * a - 6 * power4(b) * b + 15 * power4(c) * c;
    }
    static double bracket(double q) {
        return power4(positive(3 - q)) - 6 * power4(positive(2 - q)) + 15 * power4(positive(1 - q));
    }
    static double derivative(double q) { return -5 * bracket(q); }
    static double derivative_over_q(double q) {
        // For q < 1 the bracket is 24 q - 24 q^3 + 10 q^4: divided by q without cancellation.
        const double inner = 24 - 24 * q * q + 10 * q * q * q;
        const double outer = bracket(q) / (q < 1 ? 1 : q);
        return -5 * (q < 1 ? inner : outer);
    }
};

} // namespace

const Kernel& quintic_spline() {
    static const Kernel kernel{
        .name = "quintic_spline",
        .summary = "quintic spline, support 3h, four continuous derivatives",
        .formula = "(3-q)^5_+ - 6 (2-q)^5_+ + 15 (1-q)^5_+",
        .source = "Xu 2009 §2.1.1; 2-D constant 7/(478 pi h^2)",
        .support = 3,
        .normalisation = {0, 1.0 / 120, 7 / (478 * std::numbers::pi), 1 / (120 * std::numbers::pi)},
        .smoothness = 4,
        .nonnegative_transform = {false, true, false, false},
        .f = Profile::f,
        .derivative = Profile::derivative,
        .slopes = kernel_slopes<Profile>,
        .values = kernel_values<Profile>,
    };
    return kernel;
}

} // namespace sphvv::solver::kernels
