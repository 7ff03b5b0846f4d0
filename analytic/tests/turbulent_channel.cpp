// Published digits of the logarithmic laws, and the mixing length from the wall to the surface.
#include "sphvv/analytic/solutions.hpp"
#include "sphvv/analytic/tests/checks.hpp"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <gtest/gtest.h>

namespace sphvv::analytic {
namespace {

using namespace checks;

double value(std::string_view solution, std::string_view name, double z = 0, const Values& values = {}) {
    return quantity(solutions::find(solution), name, values)({0, z, 0}, 0);
}

double velocity(std::string_view solution, double z, const Values& values = {}) {
    return solutions::find(solution).bind(values)({0, z, 0}, 0).velocity[0];
}

TEST(LogLawChannel, HasIssasValues) { // §6.2.2: u* = 0.05 m/s, H = 0.4 m, H+ = 20 000, B = 5.2
    constexpr std::array heights{0.01, 0.05, 0.1, 0.2, 0.3, 0.4};
    constexpr std::array speeds{1.018, 1.214, 1.299, 1.383, 1.433, 1.468};
    for (std::size_t i = 0; i < heights.size(); ++i) {
        EXPECT_NEAR(velocity("log_law_channel", heights[i]), speeds[i], 5.1e-4);
    }
    EXPECT_NEAR(value("log_law_channel", "bulk_velocity"), 1.3458, 5e-5);
    EXPECT_NEAR(value("log_law_channel", "molecular_viscosity"), 1e-6, 1e-20);
    EXPECT_NEAR(value("log_law_channel", "driving_force"), 6.25e-3, 1e-17);
    EXPECT_NEAR(value("log_law_channel", "eddy_viscosity", 0.2), 2.05e-3, 1e-17); // the largest
    EXPECT_NEAR(value("log_law_channel", "wall_shear_stress"), 2.5, 1e-14);
    EXPECT_NEAR(solutions::find("log_law_channel").domain({}).low[1], 1e-3, 1e-17);
    EXPECT_NEAR(std::sqrt(value("log_law_channel", "driving_force") * 0.4), 0.05, 1e-16) << "u* = √(FH)";
    // Re = UH/ν = 538 000 is that of B = 5.2 (538 320; B = 5.4: 542 320)
    EXPECT_NEAR(value("log_law_channel", "bulk_velocity") * 0.4 / 1e-6, 538000, 500);
    EXPECT_GT(value("log_law_channel", "bulk_velocity", 0, {{"b", 5.4}}) * 0.4 / 1e-6, 542000);
}

TEST(LogLawChannel, ThesisEdgeVelocityImpliesAnotherConstant) {
    EXPECT_NEAR(value("log_law_channel", "edge_velocity"), 0.7371, 5e-5);
    EXPECT_NEAR(value("log_law_channel", "edge_velocity", 0, {{"b", 5.4}}), 0.747, 5e-4);
    // B = u/u* − ln(δ+)/κ for the printed 0.747 ± 0.0005 m/s: 5.40 ± 0.01
    EXPECT_NEAR(0.747 / 0.05 - std::log(50.) / 0.41, 5.4, 0.01);
}

TEST(RoughLogLawChannel, HasIssasValues) { // §6.2.3: ξ = 0.01 m, D = 8.5
    constexpr std::array heights{0.01, 0.05, 0.1, 0.2, 0.3, 0.4};
    constexpr std::array speeds{.425, .621, .706, .790, .840, .875};
    for (std::size_t i = 0; i < heights.size(); ++i) {
        EXPECT_NEAR(velocity("log_law_channel_rough", heights[i]), speeds[i], 5.1e-4);
    }
    EXPECT_NEAR(value("log_law_channel_rough", "edge_velocity"), 0.144, 5e-4);
    EXPECT_NEAR(value("log_law_channel_rough", "bulk_velocity"), 0.753, 5e-4);
    // The printed 0.746 is the mean over the thesis's 41 rows, edge row included (its 1.35 of the smooth bed
    // too, with B = 5.4).
    const auto row_mean = [](std::string_view channel, const Values& values) {
        double sum = value(channel, "edge_velocity", 0, values);
        for (int row = 1; row <= 40; ++row) {
            sum += velocity(channel, 0.01 * row, values);
        }
        return sum / 41;
    };
    EXPECT_NEAR(row_mean("log_law_channel_rough", {}), 0.746, 5e-4);
    EXPECT_NEAR(row_mean("log_law_channel", {{"b", 5.4}}), 1.35, 5e-3);
}

TEST(LogLawChannels, HaveTheStatedIntegralsAndStress) {
    for (const char* name : {"log_law_channel", "log_law_channel_rough"}) {
        const double H = 0.4;
        const Domain line{{0, 0, 0}, {H, 0, 0}, {}};
        EXPECT_NEAR(volume_mean(line, 1, [&](const Vector& x) { return velocity(name, x[0]); }),
                    value(name, "bulk_velocity"), 1e-13);
        for (const double z : {0.002, 0.1, 0.3}) {
            EXPECT_NEAR(1000 * value(name, "eddy_viscosity", z) * value(name, "velocity_gradient", z),
                        value(name, "shear_stress", z), 1e-14);
            EXPECT_NEAR(value(name, "velocity_gradient", z), 0.05 / (0.41 * z), 1e-13);
        }
    }
}

/// u+ of the mixing length at z+ by an embedded Runge–Kutta method of order 8 (Prince & Dormand).
double integrated(double reach, double kappa, double damping, double height) {
    struct Problem {
        double reach, kappa, damping;
    } problem{reach, kappa, damping};
    gsl_odeiv2_system system{
        [](double z, const double*, double* slope, void* data) {
            const auto& p = *static_cast<const Problem*>(data);
            const double stress = 1 - z / p.reach;
            const double length = p.kappa * z * std::sqrt(stress) * (1 - std::exp(-z / p.damping));
            // (1 + L² S) S = stress, by Newton's method on S, as an independent root
            double S = stress;
            for (int i = 0; i < 60; ++i) {
                S -= (S + length * length * S * S - stress) / (1 + 2 * length * length * S);
            }
            slope[0] = S;
            return static_cast<int>(GSL_SUCCESS);
        },
        nullptr, 1, &problem};
    gsl_odeiv2_driver* driver =
        gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, 1e-6, 1e-13, 1e-13);
    double z = 0;
    double u = 0;
    EXPECT_EQ(gsl_odeiv2_driver_apply(driver, &z, height, &u), GSL_SUCCESS);
    gsl_odeiv2_driver_free(driver);
    return u;
}

TEST(MixingLengthChannel, IsTheSolutionOfItsDifferentialEquation) {
    for (const double reach : {500.0, 20000.0}) {
        const Values values{{"friction_re", reach}, {"friction_velocity", 1}, {"depth", 1}};
        for (const double share : {1e-4, 0.01, 0.3, 0.999}) {
            const double u = velocity("mixing_length_channel", share, values);
            EXPECT_NEAR(u / integrated(reach, 0.41, 26, share * reach), 1, 1e-11) << reach << " " << share;
        }
    }
}

TEST(MixingLengthChannel, BalancesTheForceAtEveryHeight) {
    for (double z = 5e-7; z < 0.4; z *= 3) { // z+ from 0.025
        const double stress = 1000 * (1e-6 + value("mixing_length_channel", "eddy_viscosity", z)) *
                              value("mixing_length_channel", "velocity_gradient", z);
        EXPECT_NEAR(stress, value("mixing_length_channel", "shear_stress", z), 1e-14);
        const double slope =
            derivatives([&](double s) { return velocity("mixing_length_channel", z + s); }, z / 32).first;
        EXPECT_NEAR(value("mixing_length_channel", "velocity_gradient", z) / slope, 1, 1e-9) << z;
        const double length = value("mixing_length_channel", "mixing_length", z);
        EXPECT_NEAR(length * length * slope / value("mixing_length_channel", "eddy_viscosity", z), 1, 1e-8);
    }
}

TEST(MixingLengthChannel, IsViscousAtTheWallAndLogarithmicAbove) {
    const auto plus = [](double z) { return velocity("mixing_length_channel", z * 2e-5) / 0.05; };
    EXPECT_NEAR(plus(0.1) / 0.1, 1, 1e-5);
    EXPECT_NEAR(plus(1), 1, 1e-3);
    const double B = value("mixing_length_channel", "log_law_constant");
    EXPECT_NEAR(B, 5.2771, 5e-5);
    for (const double z : {300.0, 1000.0, 5000.0}) {
        // Viscosity takes 1/2κ²z²(1 − z/H) off the gradient, so that 3/z is still to come and 3 ln z/H+ is
        // lost.
        EXPECT_NEAR(plus(z), std::log(z) / 0.41 + B, 3.0 / z + 5 * std::log(z) / 20000) << z;
    }
    const double bulk = 0.05 * (std::log(20000.) / 0.41 + B - 1 / 0.41);
    EXPECT_NEAR(value("mixing_length_channel", "bulk_velocity"), bulk, 1e-3 * bulk);
}

TEST(MixingLengthChannel, DampingConstantSetsTheLawsConstant) {
    const auto B = [](double damping) {
        return value("mixing_length_channel", "log_law_constant", 0, {{"damping", damping}});
    };
    double low = 20;
    double high = 30;
    while (high - low > 1e-10) {
        const double middle = (low + high) / 2;
        (B(middle) < 5.2 ? low : high) = middle;
    }
    EXPECT_NEAR(low, 25.620, 5e-4) << "A+ of B = 5.2 at kappa = 0.41";
    EXPECT_GT(B(30), B(26));
}

} // namespace
} // namespace sphvv::analytic
