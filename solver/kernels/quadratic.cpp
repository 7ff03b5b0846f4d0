#include "sphvv/solver/kernels.hpp"

#include <numbers>

namespace sphvv::solver::kernels {
namespace {

struct Profile {
    static constexpr double positive(double x) { return x > 0 ? x : 0; }

    static double f(double q) {
        const double a = positive(2 - q);
        return 0.1875 * a * a;
    }
    static double derivative(double q) { return -0.375 * positive(2 - q); }
    static double derivative_over_q(double q) {
        // Singular at the origin, where the gradient of the cone has no direction: 0 stands for its mean.
        const double outer = derivative(q) / (q > 0 ? q : 1);
        return q > 0 ? outer : 0;
    }
};

} // namespace

const Kernel& quadratic() {
    static const Kernel kernel{
        .name = "quadratic",
        .summary = "quadratic, support 2h, steepest at r = 0; W'/r is singular there and set to 0",
        .formula = "3/16 (2-q)^2_+",
        .source = "Xu 2009 App. A, printed as 3q^2/16 - 3q/4 + 3/4; 1-D constant 1/h derived from its unit "
                  "integral. "
                  "The gradient jumps at r = 0 (a cone), so that no derivative is continuous",
        .support = 2,
        .normalisation = {0, 1, 2 / std::numbers::pi, 5 / (4 * std::numbers::pi)},
        .smoothness = 0,
        .nonnegative_transform = {false, true, true, true},
        .f = Profile::f,
        .derivative = Profile::derivative,
        .slopes = kernel_slopes<Profile>,
        .values = kernel_values<Profile>,
    };
    return kernel;
}

} // namespace sphvv::solver::kernels
