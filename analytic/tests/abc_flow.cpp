// Closed-form values, limits and the Beltrami property of the Arnold–Beltrami–Childress flow.
#include "sphvv/analytic/solutions.hpp"
#include "sphvv/analytic/tests/checks.hpp"

#include <gtest/gtest.h>

namespace sphvv::analytic {
namespace {

using namespace checks;

const Solution& abc_flow() {
    return solutions::find("abc_flow");
}

TEST(AbcFlow, HasTheStatedInitialValues) {
    const double U = 3;
    const double rho = 700;
    const Evaluator fields =
        abc_flow().bind({{"speed", U}, {"length", 12}, {"density", rho}, {"a", 1}, {"b", 2}, {"c", 3}});
    // kx, ky, kz = 30, 60, 90 degrees
    const State state = fields({1, 2, 3}, 0);
    const double scale = U / std::sqrt(14.);
    EXPECT_NEAR(state.velocity[0], scale * 2.5, 1e-14);
    EXPECT_NEAR(state.velocity[1], scale * 1, 1e-14);
    EXPECT_NEAR(state.velocity[2], scale * 2.5 * std::sqrt(3.), 1e-14);
    EXPECT_NEAR(state.pressure, -rho * U * U * 6 / 14, 1e-10);
}

TEST(AbcFlow, HasBernoulliPressureAtAllTimes) {
    Random random(3);
    const Values values = random_values(abc_flow(), random);
    const Flow flow(abc_flow(), values);
    for (int draw = 0; draw < 20; ++draw) {
        const double t = random_time(flow, random);
        const State state = flow.fields(random_point(flow, random), t);
        const double total = state.pressure + flow.medium.density / 2 * dot(state.velocity, state.velocity);
        const double expected = flow.medium.density * abc_flow().kinetic_energy(values, t);
        EXPECT_NEAR(total / expected, 1, 1e-13);
    }
}

TEST(AbcFlow, HasTheStatedRootMeanSquareSpeedForAllAmplitudes) {
    for (const double b : {0.0, 0.5, 4.0}) {
        const Values values{{"speed", 3}, {"a", 2}, {"b", b}};
        const Domain domain = abc_flow().domain(values);
        const Evaluator fields = abc_flow().bind(values);
        const double mean = volume_mean(domain, 3, [&](const Vector& x) {
            const Vector u = fields(x, 0).velocity;
            return dot(u, u);
        });
        EXPECT_NEAR(std::sqrt(mean), 3, 1e-12);
    }
}

TEST(AbcFlow, DependsOnTheRatiosOfItsAmplitudesOnly) {
    const State once = abc_flow().bind({{"a", 1}, {"b", 2}, {"c", 3}})({0.1, 0.2, 0.3}, 0.4);
    const State twice = abc_flow().bind({{"a", 2}, {"b", 4}, {"c", 6}})({0.1, 0.2, 0.3}, 0.4);
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(once.velocity[i], twice.velocity[i], 1e-15);
    }
    EXPECT_NEAR(once.pressure, twice.pressure, 1e-12);
}

TEST(AbcFlow, IsABeltramiField) {
    Random random(4);
    for (int draw = 0; draw < 10; ++draw) {
        const Values values = random_values(abc_flow(), random);
        const Flow flow(abc_flow(), values);
        const double t = random_time(flow, random);
        const double k = 2 * pi / extent(flow.domain, 0);
        const double speed = sampled_maximum_speed(flow, t);
        for (const Vector& x : random_points(flow, random, 20)) {
            const auto gradient = space_derivatives(flow, x, t).velocity_gradient;
            const Vector u = flow.fields(x, t).velocity;
            EXPECT_NEAR((gradient[2][1] - gradient[1][2]) / (k * speed), u[0] / speed, continuity_tolerance);
            EXPECT_NEAR((gradient[0][2] - gradient[2][0]) / (k * speed), u[1] / speed, continuity_tolerance);
            EXPECT_NEAR((gradient[1][0] - gradient[0][1]) / (k * speed), u[2] / speed, continuity_tolerance);
        }
    }
}

TEST(AbcFlow, DecaysWithTheSquareOfItsWavenumber) {
    // exp(-4π²/100) at Re = 100, U = 1 m/s, D = 1 m, t = 1 s
    const Vector x{0.1, 0.2, 0.3};
    const Evaluator fields = abc_flow().bind({});
    EXPECT_NEAR(fields(x, 1).velocity[0] / fields(x, 0).velocity[0], 0.673825, 5e-7);
    EXPECT_NEAR(fields(x, 1).pressure / fields(x, 0).pressure, 0.673825 * 0.673825, 1e-6);
}

TEST(AbcFlow, HasTheClosedFormMaximumSpeed) {
    const auto maximum_speed = [](double a, double b, double c) {
        return abc_flow().medium({{"speed", 3}, {"a", a}, {"b", b}, {"c", c}}).maximum_speed;
    };
    EXPECT_NEAR(maximum_speed(1, 1, 1), 3 * std::sqrt(2.), 1e-14);
    EXPECT_NEAR(maximum_speed(1, 1, 1.4), 3 * std::sqrt(2.), 1e-14); // 1.4² < 1² + 1²
    EXPECT_NEAR(maximum_speed(3, 1, 1), 3 * (3 + std::sqrt(2.)) / std::sqrt(11.), 1e-14);
    EXPECT_NEAR(maximum_speed(1, 3, 1), 3 * (3 + std::sqrt(2.)) / std::sqrt(11.), 1e-14);
    EXPECT_NEAR(maximum_speed(1, 0, 0), 3, 1e-14);
}

TEST(AbcFlow, IsFastestOnTheDiagonalForEqualAmplitudes) {
    const State state = abc_flow().bind({{"speed", 3}, {"length", 8}})({1, 1, 1}, 0);
    EXPECT_NEAR(length(state.velocity), abc_flow().medium({{"speed", 3}}).maximum_speed, 1e-14);
}

TEST(AbcFlow, NeverExceedsItsMaximumSpeedForAnyAmplitudes) {
    Random random(5);
    for (int draw = 0; draw < 20; ++draw) {
        const Values values{
            {"a", random.uniform(0.01, 1)}, {"b", random.uniform(0, 1)}, {"c", random.uniform(0, 1)}};
        const double sampled = sampled_maximum_speed(Flow(abc_flow(), values), 0);
        EXPECT_NEAR(sampled / abc_flow().medium(values).maximum_speed, 1, 1e-9)
            << values.at("a") << " " << values.at("b") << " " << values.at("c");
    }
}

TEST(AbcFlow, FillsTheCubeAboutTheOrigin) {
    const Domain domain = abc_flow().domain({{"length", 6}});
    EXPECT_EQ(domain.low, (Vector{-3, -3, -3}));
    EXPECT_EQ(domain.high, (Vector{3, 3, 3}));
    EXPECT_EQ(domain.periodic, (std::array{true, true, true}));
}

TEST(AbcFlow, HasTheMediumOfItsReynoldsNumber) {
    const Medium medium = abc_flow().medium({{"re", 20}, {"speed", 3}, {"length", 6}, {"density", 700}});
    EXPECT_DOUBLE_EQ(medium.kinematic_viscosity, 0.9);
    EXPECT_EQ(medium.density, 700);
}

TEST(AbcFlow, IsSteadyWithoutViscosityAndComesToRestWithIt) {
    const Vector x{0.1, 0.2, 0.3};
    const Evaluator inviscid = abc_flow().bind({{"re", 1e8}});
    EXPECT_NEAR(inviscid(x, 1).velocity[0], inviscid(x, 0).velocity[0], 1e-6);
    const State end = abc_flow().bind({{"re", 10}})(x, 1e3);
    EXPECT_EQ(length(end.velocity), 0);
    EXPECT_EQ(std::abs(end.pressure), 0);
    EXPECT_EQ(abc_flow().kinetic_energy({{"re", 10}}, 1e3), 0);
}

} // namespace
} // namespace sphvv::analytic
