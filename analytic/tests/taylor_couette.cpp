// Closed forms, tabulated eigenvalues and limits of the flow between rotating cylinders.
#include "sphvv/analytic/solutions.hpp"
#include "sphvv/analytic/tests/checks.hpp"

#include <gtest/gtest.h>

namespace sphvv::analytic {
namespace {

using namespace checks;

const Solution& flow() {
    return solutions::find("taylor_couette");
}

double azimuthal(const Values& values, double r, double t) {
    return quantity(flow(), "azimuthal_velocity", values)({r, 0, 0}, t);
}

TEST(TaylorCouette, HasTheSteadyVelocityAndPressureInClosedForm) {
    // r1 = 1 m, r2 = 2 m, u1 = 1 m/s, outer cylinder at rest: A = −1/3, B = 4/3
    const Evaluator fields = flow().bind({{"steady_start", 1}});
    const double A = -1. / 3;
    const double B = 4. / 3;
    for (const double r : {1.0, 1.2, 1.7, 2.0}) {
        const State state = fields({0.6 * r, 0.8 * r, 0}, 3);
        EXPECT_NEAR(state.velocity[0], -0.8 * (A * r + B / r), 1e-14);
        EXPECT_NEAR(state.velocity[1], 0.6 * (A * r + B / r), 1e-14);
        const auto p = [&](double at) {
            return 1000 * (A * A * at * at / 2 + 2 * A * B * std::log(at) - B * B / (2 * at * at));
        };
        EXPECT_NEAR(state.pressure, p(r) - p(1), 1e-11);
    }
    // torque −4πρνB, with ν = 0.01
    EXPECT_NEAR(quantity(flow(), "inner_torque", {{"steady_start", 1}})({}, 1), -4 * pi * 10 * B, 1e-11);
    EXPECT_NEAR(quantity(flow(), "inner_torque", {})({}, 1e4), -4 * pi * 10 * B, 1e-11);
}

TEST(TaylorCouette, HasTheDeclaredKineticEnergy) {
    for (const double ratio : {0.2, 0.9}) {
        for (const double tau : {1e-4, 0.01, 0.2}) {
            const Values values{{"radius_ratio", ratio}, {"rotation_ratio", -0.4}, {"steady_start", 0.1}};
            const double gap = 1 / ratio - 1;
            const double t = tau * gap * gap / flow().medium(values).kinematic_viscosity;
            const Domain line{{1, 0, 0}, {1 / ratio, 0, 0}, {}};
            const Scalar u = quantity(flow(), "azimuthal_velocity", values);
            const double mean =
                volume_mean(line, 1, [&](const Vector& x) { return std::pow(u(x, t), 2) * x[0]; }) * gap /
                (1 / (ratio * ratio) - 1);
            EXPECT_NEAR(flow().kinetic_energy(values, t) / mean, 1, 1e-11) << ratio << " " << tau;
        }
    }
}

TEST(TaylorCouette, TurnsAsASolidBody) {
    const Evaluator fields = flow().bind({{"steady_start", 1}, {"rotation_ratio", 1}});
    const State state = fields({0, 1.5, 0}, 0);
    EXPECT_NEAR(state.velocity[0], -1.5, 1e-14);
    EXPECT_NEAR(state.pressure, 1000 * (1.5 * 1.5 - 1) / 2, 1e-11);
}

TEST(TaylorCouette, DecaysWithTheTabulatedEigenvalue) {
    // Abramowitz & Stegun table 9.7: the first zero of J1(x)Y1(2x) − Y1(x)J1(2x) is x = 3.19658
    const double late = azimuthal({}, 1.5, 1e6);
    const double first = late - azimuthal({}, 1.5, 100);
    const double second = late - azimuthal({}, 1.5, 110);
    EXPECT_NEAR(std::sqrt(std::log(first / second) / (0.01 * 10)), 3.19658, 6e-6);
}

TEST(TaylorCouette, ExpansionForSmallTimesMeetsTheSeries) {
    for (const double ratio : {0.1, 0.5, 0.95}) {
        const Values values{{"radius_ratio", ratio}, {"rotation_ratio", 0.7}};
        const double gap = 1 / ratio - 1;
        const double switch_over = 1e-5 * gap * gap / flow().medium(values).kinematic_viscosity;
        const double u2 = 0.7 / ratio;
        for (const double depth : {0.0, 0.001, 0.003, 0.006}) {
            const double inner = 1 + depth * gap;
            EXPECT_NEAR(azimuthal(values, inner, switch_over * (1 - 1e-13)),
                        azimuthal(values, inner, switch_over * (1 + 1e-13)), 2e-11)
                << ratio << " " << depth;
            const double outer = 1 / ratio - depth * gap;
            EXPECT_NEAR(azimuthal(values, outer, switch_over * (1 - 1e-13)) / u2,
                        azimuthal(values, outer, switch_over * (1 + 1e-13)) / u2, 2e-11)
                << ratio << " " << depth;
        }
    }
}

TEST(TaylorCouette, ProfileIsTheSumOfTheModes) {
    for (const double ratio : {0.1, 0.5, 0.95}) {
        const Values values{{"radius_ratio", ratio}, {"rotation_ratio", -0.4}};
        const double gap = 1 / ratio - 1;
        const double nu = flow().medium(values).kinematic_viscosity;
        const Evaluator fields = flow().bind(values);
        for (const double tau : {1e-6, 1e-4, 1e-3, 0.02, 0.3}) {
            const double t = tau * gap * gap / nu;
            for (const double share : {0.01, 0.3, 0.5, 0.9}) {
                const double r = 1 + share * gap;
                EXPECT_NEAR(fields({r, 0, 0}, t).velocity[1], azimuthal(values, r, t), 3e-11)
                    << ratio << " " << tau;
            }
        }
    }
}

TEST(TaylorCouette, TendsToPlaneCouetteInANarrowGap) {
    const auto difference = [](double ratio) {
        const double gap = 1 / ratio - 1;
        const Values values{{"radius_ratio", ratio}, {"re", 10}};
        const double t = 0.08 * gap * gap / flow().medium(values).kinematic_viscosity;
        // plane Couette of the same Reynolds number, the moving wall above
        return std::abs(azimuthal(values, 1 + 0.3 * gap, t) -
                        solutions::find("couette").bind({{"re", 10}})({0, 0.7, 0}, 0.8).velocity[0]);
    };
    EXPECT_LT(difference(0.95), 0.02);
    EXPECT_NEAR(difference(0.9) / difference(0.95), (1 / 0.9 - 1) / (1 / 0.95 - 1), 0.15)
        << "first order in the gap";
}

} // namespace
} // namespace sphvv::analytic
