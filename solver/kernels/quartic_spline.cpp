#include "sphvv/solver/kernels.hpp"

#include <numbers>

namespace sphvv::solver::kernels {
namespace {

struct Profile {
    static constexpr double positive(double x) { return x > 0 ? x : 0; }
    static constexpr double power3(double x) { return x * x * x; }

    static double f(double q) {
        const double a = positive(2.5 - q);
        const double b = positive(1.5 - q);
        const double c = positive(0.5 - q);
        return power3(a) * a - 5 * power3(b) * b + 10 * power3(c) * c;
    }
    static double bracket(double q) {
        return power3(positive(2.5 - q)) - 5 * power3(positive(1.5 - q)) + 10 * power3(positive(0.5 - q));
    }
    static double derivative(double q) { return -4 * bracket(q); }
    static double derivative_over_q(double q) {
        // For q < 1/2 the bracket is 15/2 q - 6 q^3: divided by q without cancellation.
        const double inner = 7.5 - 6 * q * q;
        const double outer = bracket(q) / (q < 0.5 ? 1 : q);
        return -4 * (q < 0.5 ? inner : outer);
    }
};

} // namespace

const Kernel& quartic_spline() {
    static const Kernel kernel{
        .name = "quartic_spline",
        .summary = "quartic spline, support 2.5h, three continuous derivatives",
        .formula = "(5/2-q)^4_+ - 5 (3/2-q)^4_+ + 10 (1/2-q)^4_+",
        .source =
            "Issa 2005 §3.2, with the exact constants 96/(1199 pi h^2) and 1/(20 pi h^3): the thesis prints "
            "51/2000 in 2-D (0.055 % too large) and again in 3-D (60 % too large)",
        .support = 2.5,
        .normalisation = {0, 1.0 / 24, 96 / (1199 * std::numbers::pi), 1 / (20 * std::numbers::pi)},
        .smoothness = 3,
        .nonnegative_transform = {false, false, false, false},
        .f = Profile::f,
        .derivative = Profile::derivative,
        .slopes = kernel_slopes<Profile>,
        .values = kernel_values<Profile>,
    };
    return kernel;
}

} // namespace sphvv::solver::kernels
