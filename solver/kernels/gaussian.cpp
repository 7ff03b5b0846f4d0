#include "sphvv/solver/kernels.hpp"

#include <cmath>
#include <numbers>

namespace sphvv::solver::kernels {
namespace {

struct Profile {
    static double f(double q) { return q < 3 ? std::exp(-q * q) : 0; }
    /// exp(-x) for 0 <= x <= 9 to about 1e-15, without a call, so that the loop over neighbours vectorises:
    /// Taylor's series of exp(-x/16), whose first neglected term is below 1.4e-16, then four squarings.
    static double falling_exponential(double x) {
        const double y = x * 0.0625;
        double sum = 1;
        for (int k = 14; k > 0; --k) {
            sum = 1 - y * (1.0 / k) * sum;
        }
        for (int squaring = 0; squaring < 4; ++squaring) {
            sum *= sum;
        }
        return sum;
    }
    static double derivative_over_q(double q) {
        const double inside = -2 * falling_exponential(q < 3 ? q * q : 9);
        return q < 3 ? inside : 0;
    }
    static double derivative(double q) { return q * derivative_over_q(q); }
};

} // namespace

const Kernel& gaussian() {
    const double pi = std::numbers::pi;
    const double edge = std::exp(-9.0); // f at the cut
    static const Kernel kernel{
        .name = "gaussian",
        .summary = "Gaussian cut at 3h, where its value falls from 1.2e-4 W(0) to zero",
        .formula = "exp(-q^2) for q < 3, else 0",
        .source = "Issa 2005 §2.3, Xu 2009 App. A; renormalised for the cut: the integrals of f to q = 3 are "
                  "sqrt(pi) erf(3), pi (1 - e^-9), pi^(3/2) erf(3) - 6 pi e^-9",
        .support = 3,
        .normalisation = {0, 1 / (std::sqrt(pi) * std::erf(3.0)), 1 / (pi * (1 - edge)),
                          1 / (pi * std::sqrt(pi) * std::erf(3.0) - 6 * pi * edge)},
        .smoothness = -1,
        .nonnegative_transform = {false, false, false, false},
        .f = Profile::f,
        .derivative = Profile::derivative,
        .slopes = kernel_slopes<Profile>,
        .values = kernel_values<Profile>,
    };
    return kernel;
}

} // namespace sphvv::solver::kernels
