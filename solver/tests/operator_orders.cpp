// Observed orders of the operators on A = sin(2 pi x + 0.3) in the periodic unit square, quintic spline, V =
// dx^2: the rows of the project's rules of evidence (§4) that concern the operators of this library.
//   solver_operator_orders --gtest_filter='*Jitter*'
//
// With jitter p dx the sums over neighbours carry a noise of p dx^(1+d/2) h^(-2-d/2) (Morris), h^(-1-d/2)
// (G-, Schwaiger) or h^(-d/2) (renormalised G-), times the field's variation over h where that is what is
// left. At fixed h/dx the errors therefore tend to the orders -1, 0 and 1 in dx, and at fixed h all tend to 1
// + d/2 = 2 against the field that the continuous kernel would give.
#include "sphvv/solver/operators/gradient_difference.hpp"
#include "sphvv/solver/operators/laplacian_morris.hpp"
#include "sphvv/solver/operators/laplacian_schwaiger.hpp"
#include "sphvv/solver/operators/renormalisation.hpp"
#include "sphvv/solver/tests/scenes.hpp"

#include <gsl/gsl_integration.h>
#include <gsl/gsl_sf_bessel.h>
#include <gtest/gtest.h>

#include <functional>
#include <iostream>

namespace sphvv::solver {
namespace {

using namespace scenes;

constexpr double k = 2 * pi;
constexpr double phase = 0.3;
constexpr double tenth = 0.1; ///< of dx, the jitter

using Evaluate = Vector<2> (*)(const Row<2>&, int i, const double* A, const UniformVolume&);

/// An operator, the exact factor that it puts in front of cos (gradient) or sin (Laplacian), and which of the
/// two it is.
struct Operator {
    Evaluate evaluate;
    bool gradient;
};

const Operator difference_gradient{[](const Row<2>& row, int i, const double* A, const UniformVolume& V) {
                                       return gradient_difference<2>(row, i, A, V);
                                   },
                                   true};
const Operator renormalised_gradient{
    [](const Row<2>& row, int i, const double* A, const UniformVolume& V) -> Vector<2> {
        return renormalisation<2>(row, V) * gradient_difference<2>(row, i, A, V);
    },
    true};
const Operator morris{[](const Row<2>& row, int i, const double* A, const UniformVolume& V) {
                          return laplacian_morris<2>(row, i, {A, A}, V, 0.);
                      },
                      false};
const Operator schwaiger{[](const Row<2>& row, int i, const double* A, const UniformVolume& V) {
                             return laplacian_schwaiger<2>(row, i, {A, A}, V, renormalisation<2>(row, V));
                         },
                         false};

/// Factor of the exact derivative.
double exact_factor(const Operator& op) {
    return op.gradient ? k : -k * k;
}

/// Factor that the integrals over the kernel give in place of the sums: W^(k) k for the gradient, 2 times the
/// integral of F(r) [1 - J0(kr)] for the Morris Laplacian.
double smoothed_factor(const Operator& op, double h) {
    const Kernel& kernel = kernels::find("quintic_spline");
    gsl_integration_glfixed_table* table = gsl_integration_glfixed_table_alloc(32);
    double total = 0;
    for (int piece = 0; piece < 3; ++piece) {
        for (std::size_t point = 0; point < 32; ++point) {
            double r = 0;
            double weight = 0;
            gsl_integration_glfixed_point(piece * h, (piece + 1) * h, point, &r, &weight, table);
            const double J0 = gsl_sf_bessel_J0(k * r);
            const double integrand =
                op.gradient ? kernel.value(2, r, h) * J0 * k : 2 * kernel.slope(2, r, h) * (1 - J0);
            total += weight * 2 * pi * r * integrand;
        }
    }
    gsl_integration_glfixed_table_free(table);
    return total;
}

/// Relative L2 error against factor times cos or sin.
double error(const Operator& op, int n, double disorder, double h_over_dx, double factor,
             std::uint64_t seed) {
    const Sample<2> sample(n, disorder, seed, true, 1, h_over_dx);
    std::vector<double> A(sample.count());
    for (int i = 0; i < sample.count(); ++i) {
        A[i] = std::sin(k * sample.points[0][i] + phase);
    }
    const UniformVolume V{sample.dx * sample.dx};
    double squares = 0;
    double exact_squares = 0;
    for (int i = 0; i < sample.count(); ++i) {
        const Vector<2> found = op.evaluate(sample.list.row(i), i, A.data(), V);
        const double exact = factor * (op.gradient ? std::cos(k * sample.points[0][i] + phase) : A[i]);
        squares += std::pow(found[0] - exact, 2) + (op.gradient ? std::pow(found[1], 2) : 0);
        exact_squares += exact * exact;
    }
    return std::sqrt(squares / exact_squares);
}

/// Order in dx: least-squares slope of log(error), the mean over the seeds, on log(dx).
double order(const std::vector<int>& rungs, const std::function<double(int n, std::uint64_t seed)>& error_of,
             const std::vector<std::uint64_t>& seeds) {
    const auto count = static_cast<double>(rungs.size());
    double x_mean = 0;
    double y_mean = 0;
    std::vector<std::pair<double, double>> points;
    std::string table;
    for (const int n : rungs) {
        double y = 0;
        for (const std::uint64_t seed : seeds) {
            y += std::log(error_of(n, seed)) / static_cast<double>(seeds.size());
        }
        points.emplace_back(-std::log(n), y);
        x_mean -= std::log(n) / count;
        y_mean += y / count;
        table += " " + std::to_string(n) + ": " + shortest(std::exp(y));
    }
    double xy = 0;
    double xx = 0;
    for (const auto& [x, y] : points) {
        xy += (x - x_mean) * (y - y_mean);
        xx += (x - x_mean) * (x - x_mean);
    }
    std::cout << "    seeds";
    for (const std::uint64_t seed : seeds) {
        std::cout << ' ' << seed;
    }
    std::cout << "; errors" << table << "; order " << xy / xx << '\n';
    return xy / xx;
}

const std::vector<std::uint64_t> five_seeds{101, 102, 103, 104, 105};

double order_at_fixed_ratio(const Operator& op, double disorder, const std::vector<int>& rungs) {
    return order(
        rungs, [&](int n, std::uint64_t seed) { return error(op, n, disorder, 1.3, exact_factor(op), seed); },
        disorder > 0 ? five_seeds : std::vector<std::uint64_t>{0});
}

double order_at_fixed_h(const Operator& op, double disorder) {
    constexpr double h = 0.065;
    const double factor = smoothed_factor(op, h);
    return order(
        {20, 28, 40, 56, 80},
        [&](int n, std::uint64_t seed) { return error(op, n, disorder, h * n, factor, seed); }, five_seeds);
}

// On a lattice: second order down to the floor that the quadrature error sets.

TEST(OnALattice, DifferenceGradientIsOfSecondOrderAboveItsFloor) {
    EXPECT_NEAR(order_at_fixed_ratio(difference_gradient, 0, {16, 20, 28, 40, 56}), 2, 0.2);
    // Floor, 3e-4 to 1e-3.
    const double floor = error(difference_gradient, 640, 0, 1.3, exact_factor(difference_gradient), 0);
    EXPECT_GT(floor, 3e-4);
    EXPECT_LT(floor, 1e-3);
}

TEST(OnALattice, MorrisIsOfSecondOrderAboveItsFloor) {
    EXPECT_NEAR(order_at_fixed_ratio(morris, 0, {16, 20, 28, 40, 56}), 2, 0.2);
    const double floor = error(morris, 640, 0, 1.3, exact_factor(morris), 0);
    EXPECT_GT(floor, 5e-4);
    EXPECT_LT(floor, 1.4e-3);
}

TEST(OnALattice, RenormalisedGradientIsOfSecondOrder) {
    EXPECT_NEAR(order_at_fixed_ratio(renormalised_gradient, 0, {20, 40, 80, 160, 320}), 2, 0.05);
}

TEST(OnALattice, SchwaigerIsOfSecondOrder) {
    EXPECT_NEAR(order_at_fixed_ratio(schwaiger, 0, {20, 40, 80, 160, 320}), 2, 0.05);
}

// 10 % jitter, h/dx fixed: refinement does not help, or hurts.

const std::vector<int> jitter_rungs{40, 80, 160, 320};

TEST(WithJitter, DifferenceGradientDoesNotConverge) {
    EXPECT_NEAR(order_at_fixed_ratio(difference_gradient, tenth, jitter_rungs), 0, 0.2);
}

TEST(WithJitter, RenormalisedGradientFallsFromSecondTowardsFirstOrder) {
    const double fit = order_at_fixed_ratio(renormalised_gradient, tenth, jitter_rungs);
    EXPECT_GT(fit, 1);
    EXPECT_LT(fit, 2.1);
    const double last_pair = order_at_fixed_ratio(renormalised_gradient, tenth, {160, 320});
    EXPECT_GT(last_pair, 1);
    EXPECT_LT(last_pair, fit);
}

TEST(WithJitter, MorrisDivergesWithFirstOrder) {
    EXPECT_NEAR(order_at_fixed_ratio(morris, tenth, jitter_rungs), -1, 0.2);
}

TEST(WithJitter, SchwaigerDoesNotConverge) {
    EXPECT_NEAR(order_at_fixed_ratio(schwaiger, tenth, {80, 113, 160, 226, 320}), 0, 0.2);
}

// 10 % jitter, h fixed, against the smoothed field: 1 + d/2.

TEST(WithJitter, DifferenceGradientConvergesToTheSmoothedOneAtFixedSmoothingLength) {
    EXPECT_NEAR(order_at_fixed_h(difference_gradient, tenth), 2, 0.3);
}

TEST(WithJitter, MorrisConvergesToTheSmoothedLaplacianAtFixedSmoothingLength) {
    EXPECT_NEAR(order_at_fixed_h(morris, tenth), 2, 0.3);
}

} // namespace
} // namespace sphvv::solver
