// Series against closed form, published digits, budgets, the corner, and the orders that it leaves a method
// of second order.
#include "sphvv/analytic/solutions.hpp"
#include "sphvv/analytic/tests/checks.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace sphvv::analytic {
namespace {

using namespace checks;

const Solution& plate() {
    return solutions::find("impulsive_plate");
}

/// A quantity for U = d = ρ = 1.
const Values unit{{"speed", 1}, {"depth", 1}, {"length", 4}, {"density", 1}};

double number(std::string_view name, const Vector& x = {}, double t = 0, const Values& values = unit) {
    return quantity(plate(), name, values)(x, t);
}

/// Columns of a reference file: `#` lines, names, rows of two numbers.
std::vector<std::pair<double, double>> reference(const std::string& name) {
    std::ifstream file(std::string(SPHVV_TEST_DATA) + "/" + name);
    std::vector<std::pair<double, double>> rows;
    for (std::string line; std::getline(file, line);) {
        std::istringstream text(line);
        double x = 0;
        double y = 0;
        char comma = 0;
        if (text >> x >> comma >> y) {
            rows.emplace_back(x, y);
        }
    }
    return rows;
}

struct SeriesSum {
    double potential = 0;
    double u = 0;
    double v = 0;
};

SeriesSum series(double x, double y, int terms) {
    SeriesSum sum;
    for (int n = terms - 1; n >= 0; --n) {
        const double k = (n + 0.5) * pi;
        const double a = 2. / k * (n % 2 == 0 ? 1 : -1) * std::exp(-k * x);
        sum.potential -= a / k * std::cos(k * y);
        sum.u += a * std::cos(k * y);
        sum.v += a * std::sin(k * y);
    }
    return sum;
}

TEST(ImpulsivePlate, ClosedFormIsTheSumOfTheSeries) {
    const Evaluator fields = plate().bind(unit);
    for (const double x : {0.02, 0.1, 0.5, 1.0, 3.0}) {
        for (const double y : {0.0, 0.3, 0.7, 0.99, 1.0}) {
            const SeriesSum sum = series(x, y, 1000);
            const State state = fields({x, y, 0}, 0);
            EXPECT_NEAR(state.velocity[0], sum.u, 2e-14);
            EXPECT_NEAR(state.velocity[1], sum.v, 2e-14);
            EXPECT_NEAR(number("potential", {x, y, 0}), sum.potential, 2e-15);
        }
    }
    // On the plate the series of the velocity falls as 1/n only, that of the potential as 1/n².
    const double y = 0.6;
    const SeriesSum coarse = series(0, y, 1000);
    const SeriesSum fine = series(0, y, 100000);
    const State state = fields({0, y, 0}, 0);
    EXPECT_NEAR(fine.u, state.velocity[0], 1e-5);
    EXPECT_NEAR(fine.v, state.velocity[1], 1e-5);
    EXPECT_NEAR(fine.potential, number("potential", {0, y, 0}), 1e-10);
    EXPECT_GT(std::abs(coarse.u - state.velocity[0]), 1e-5);
    EXPECT_NEAR(state.velocity[0], 1, 1e-15);
}

TEST(ImpulsivePlate, HasTheReferenceCurves) {
    const auto surface = reference("initial_surface_velocity.csv");
    ASSERT_EQ(surface.size(), 305);
    const Evaluator fields = plate().bind(unit);
    for (const auto& [x, w] : surface) {
        const double v = fields({x, 1, 0}, 0).velocity[1];
        EXPECT_NEAR(v / w, 1, 1e-9) << x;
        EXPECT_NEAR(number("elevation", {x, 0, 0}, 0.3), 0.3 * v, 1e-15) << "∂η/∂t = v";
    }
    const auto impulse = reference("impulse_on_plate.csv");
    ASSERT_EQ(impulse.size(), 201);
    for (const auto& [y, p] :
         impulse) { // ten digits of sums of 20 000 terms; the rest is 1/(k² sin(π(1 − y)/2))
        const double rest = 1 / (std::pow(20000 * pi, 2) * std::sin(pi * std::max(1 - y, 1e-3) / 2));
        EXPECT_NEAR(number("impulse", {0, y, 0}), p, rest + 1e-10) << y;
    }
}

TEST(ImpulsivePlate, HasThePublishedDigits) { // XU-PADDLE, d = 0.5 m
    const Values values{{"speed", 1}, {"depth", 0.5}};
    const std::array<std::pair<double, double>, 8> elevation{{{0.0125, 2.502},
                                                              {0.025, 2.061},
                                                              {0.05, 1.621},
                                                              {0.1, 1.184},
                                                              {0.2, 0.7576},
                                                              {0.3, 0.5238},
                                                              {0.5, 0.2686},
                                                              {1.0, 0.0551}}};
    for (const auto& [x, eta] : elevation) {
        EXPECT_NEAR(number("elevation", {x, 0, 0}, 1, values), eta, x < 0.15 ? 5e-4 : 5e-5);
    }
    const std::array<std::pair<double, double>, 4> on_plate{
        {{0.1, 0.22558}, {0.25, 0.41755}, {0.5, 0.61026}, {0.75, 0.71079}}};
    for (const auto& [fraction, impulse] : on_plate) { // of the depth, from the surface
        EXPECT_NEAR(number("impulse", {0, 1 - fraction, 0}), impulse, 5.1e-6);
    }
    EXPECT_NEAR(number("foot_impulse"), 0.74245, 5e-6);
    EXPECT_NEAR(number("impulse"), number("foot_impulse"), 1e-15);
    // 14 ζ(3)/π³ = 0.542754515…: 0.54275, where the sheet rounds to 0.54276
    EXPECT_NEAR(number("plate_impulse"), 0.542754515, 1e-9);
}

TEST(ImpulsivePlate, KeepsItsBudgets) {
    const Domain line{{0, 0, 0}, {1, 0, 0}, {}};
    const auto mean = [&](const auto& function) { return volume_mean(line, 1, function); };
    EXPECT_NEAR(mean([](const Vector& x) {
                    return number("impulse", {0, x[0], 0});
                }),
                number("plate_impulse"), 1e-13);
    constexpr double far = 24; // e^{−12π} = 4e-17
    const auto along = [&](const auto& function) {
        return far * mean([&](const Vector& x) { return function(far * x[0]); });
    };
    EXPECT_NEAR(along([](double x) { return number("impulse", {x, 0, 0}); }), number("bed_impulse"), 1e-11);
    EXPECT_NEAR(along([](double x) {
                    return number("elevation", {x, 0, 0}, 0.3);
                }),
                number("displaced_volume", {}, 0.3), 1e-11);
    EXPECT_DOUBLE_EQ(number("displaced_volume", {}, 0.3, {{"speed", 2}, {"depth", 5}}), 3);
    // The fluid has the momentum that plate and bed have given, and the energy U/2 times the plate's impulse.
    Values wide = unit;
    wide["length"] = far;
    const Flow flow(plate(), wide);
    Vector momentum{};
    for (const int d : {0, 1}) {
        momentum[d] =
            far * volume_mean(flow.domain, 2, [&](const Vector& x) { return flow.fields(x, 0).velocity[d]; });
    }
    EXPECT_NEAR(momentum[0], number("plate_impulse"), 1e-11);
    EXPECT_NEAR(momentum[1], number("bed_impulse"), 1e-11);
    EXPECT_NEAR(far * plate().kinetic_energy(wide, 0), number("plate_impulse") / 2, 1e-14);
}

TEST(ImpulsivePlate, BehavesAsStatedAtTheCorner) {
    const Evaluator fields = plate().bind(unit);
    for (const double r : {1e-2, 1e-4, 1e-8}) {
        for (const double alpha : {0.0, -0.5, -1.2, -pi / 2}) {
            const double x = r * std::cos(alpha);
            const double y = r * std::sin(alpha);
            const double log = std::log(pi * r / 4);
            const Vector u = fields({std::abs(x), 1 + y, 0}, 0).velocity;
            EXPECT_NEAR(u[0], -2 / pi * alpha, r * r + 1e-7);
            EXPECT_NEAR(u[1], -2 / pi * log, r * r + 1e-7);
            const double potential = -2 / pi * r * (std::sin(alpha) * (log - 1) + alpha * std::cos(alpha));
            EXPECT_NEAR(number("potential", {std::abs(x), 1 + y, 0}), potential, r * r * r + 1e-14);
        }
    }
}

TEST(ImpulsivePlate, StaysAccurateFarFromThePlate) { // u = (4U/π) e^{−πx/2} cos(πy/2) there
    const State state = plate().bind(unit)({40, 0.5, 0}, 0);
    EXPECT_NEAR(state.velocity[0] / (4 / pi * std::exp(-20 * pi) * std::cos(pi / 4)), 1, 1e-13);
    EXPECT_NEAR(state.velocity[1] / (4 / pi * std::exp(-20 * pi) * std::sin(pi / 4)), 1, 1e-13);
}

/// Errors of potential and velocity.
struct Errors {
    std::array<double, 3> potential{}; ///< L1, L2, L∞
    std::array<double, 3> velocity{};
};

/// Of the five-point Laplacian with central differences at the plate and for the velocity, on n cells over
/// the depth and 2n along it, at the nodes inside that are at least `apart` from the corner. The discrete
/// solution is known: modes cos(k y) e^{−q x} with cosh(q dx) = 1 + 2 sin²(k dx/2) and the amplitude that the
/// plate's condition leaves.
Errors five_point_errors(int n, double apart) {
    const double dx = 1. / n;
    std::vector<double> field((2 * n + 2) * (n + 1));
    const auto at = [&](int i, int j) -> double& { return field[i * (n + 1) + j]; };
    for (int m = 0; m < n; ++m) {
        const double k = (m + 0.5) * pi;
        const double s = std::sin(k * dx / 2);
        const double q = std::acosh(1 + 2 * s * s);
        double flux = 1; // discrete cosine coefficient of 1 over 0 <= y < 1
        for (int j = 1; j < n; ++j) {
            flux += 2 * std::cos(k * j * dx);
        }
        const double amplitude = -flux / n * dx / std::sinh(q);
        for (int i = 0; i < 2 * n + 2; ++i) {
            for (int j = 0; j <= n; ++j) {
                at(i, j) += amplitude * std::exp(-q * i) * std::cos(k * j * dx);
            }
        }
    }
    const Evaluator fields = plate().bind(unit);
    const Scalar potential = quantity(plate(), "potential", unit);
    Errors errors;
    int count = 0;
    for (int i = 1; i <= 2 * n; ++i) {
        for (int j = 1; j < n; ++j) {
            const Vector x{i * dx, j * dx, 0};
            if (std::hypot(x[0], 1 - x[1]) < apart) {
                continue;
            }
            const Vector u = fields(x, 0).velocity;
            const double of_u = std::hypot((at(i + 1, j) - at(i - 1, j)) / (2 * dx) - u[0],
                                           (at(i, j + 1) - at(i, j - 1)) / (2 * dx) - u[1]);
            const double of_potential = std::abs(at(i, j) - potential(x, 0));
            const auto add = [](std::array<double, 3>& norm, double error) {
                norm = {norm[0] + error, norm[1] + error * error, std::max(norm[2], error)};
            };
            add(errors.velocity, of_u);
            add(errors.potential, of_potential);
            ++count;
        }
    }
    for (auto* norm : {&errors.velocity, &errors.potential}) {
        (*norm)[0] /= count;
        (*norm)[1] = std::sqrt((*norm)[1] / count);
    }
    return errors;
}

/// Pairwise orders between 64 and 128 cells over the depth, the finer one's corner cut at `cells` spacings or
/// a fixed distance.
Errors orders(double cells, double distance) {
    const Errors coarse = five_point_errors(64, std::max(cells / 64, distance));
    const Errors fine = five_point_errors(128, std::max(cells / 128, distance));
    Errors result;
    for (int i = 0; i < 3; ++i) {
        result.potential[i] = std::log2(coarse.potential[i] / fine.potential[i]);
        result.velocity[i] = std::log2(coarse.velocity[i] / fine.velocity[i]);
    }
    return result;
}

TEST(ImpulsivePlate, LeavesAMethodOfSecondOrderTheStatedOrders) {
    for (const double cells : {0.0, 3.0}) {
        const Errors measured = orders(cells, 0);
        SCOPED_TRACE(cells);
        const std::string text =
            testing::PrintToString(measured.potential) + " " + testing::PrintToString(measured.velocity);
        EXPECT_NEAR(measured.potential[0], 2, 0.25) << text;
        EXPECT_NEAR(measured.potential[1], 2, 0.35) << text;
        EXPECT_NEAR(measured.potential[2], 1, 0.1) << text;
        EXPECT_NEAR(measured.velocity[0], 2, 0.35) << text;
        EXPECT_NEAR(measured.velocity[1], 1, 0.1) << text;
        EXPECT_NEAR(measured.velocity[2], 0, 0.1) << text;
    }
    const Errors apart = orders(0, 0.25);
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(apart.potential[i], 2, 0.25) << i;
        EXPECT_NEAR(apart.velocity[i], 2, 0.25) << i;
    }
}

} // namespace
} // namespace sphvv::analytic
