// Published digits, limits and symmetries of the Taylor–Green vortices.
#include "sphvv/analytic/solutions.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sphvv::analytic {
namespace {

const Solution& taylor_green() {
    return solutions::find("taylor_green");
}

/// e^{κt} as the fields show it at Re, U = 1 m/s and D = 1 m.
double decay(double re, double t) {
    return taylor_green().bind({{"re", re}})({0.25, 0, 0}, t).velocity[1];
}

TEST(TaylorGreen, DecaysAsPublished) { // Xu 2009 §4.1, five digits
    EXPECT_NEAR(decay(10, 0.1), 0.45404, 5e-6);
    EXPECT_NEAR(decay(100, 1), 0.45404, 5e-6);
    EXPECT_NEAR(decay(1000, 1), 0.92408, 5e-6);
    EXPECT_NEAR(decay(1000, 2), 0.85392, 5e-6);
    EXPECT_NEAR(decay(100, 2), 0.20615, 5e-6);
}

TEST(TaylorGreen, HasTheStatedInitialValues) {
    const double U = 3;
    const double D = 6;
    const double rho = 700;
    const Evaluator fields = taylor_green().bind({{"speed", U}, {"length", D}, {"density", rho}});
    EXPECT_NEAR(fields({0, 0, 0}, 0).pressure, -rho * U * U / 2, 1e-10);
    EXPECT_NEAR(fields({D / 4, D / 4, 0}, 0).pressure, rho * U * U / 2, 1e-10);
    // 2πx/D = 30 and 2πy/D = 60 degrees, then 30 and 30
    const State state = fields({0.5, 1, 0}, 0);
    EXPECT_NEAR(state.velocity[0], -0.75 * U, 1e-14);
    EXPECT_NEAR(state.velocity[1], 0.25 * U, 1e-14);
    EXPECT_NEAR(state.pressure, 0, 1e-10);
    EXPECT_NEAR(fields({0.5, 0.5, 0}, 0).pressure, -rho * U * U / 4, 1e-10);
}

TEST(TaylorGreen, StandsStillAtItsSaddlesAndCentres) {
    const Evaluator fields = taylor_green().bind({});
    for (const double x : {-0.25, 0.25}) {
        for (const double y : {-0.25, 0.25}) {
            const State state = fields({x, y, 0}, 0.1);
            EXPECT_NEAR(std::hypot(state.velocity[0], state.velocity[1]), 0, 1e-15);
        }
    }
    EXPECT_EQ(std::hypot(fields({0, 0, 0}, 0.1).velocity[0], fields({0, 0, 0}, 0.1).velocity[1]), 0);
}

TEST(TaylorGreen, FillsTheSquareAboutTheOrigin) {
    const Domain domain = taylor_green().domain({{"length", 6}});
    EXPECT_EQ(domain.low, (Vector{-3, -3, 0}));
    EXPECT_EQ(domain.high, (Vector{3, 3, 0}));
    EXPECT_EQ(domain.periodic, (std::array{true, true, false}));
}

TEST(TaylorGreen, HasTheMediumOfItsReynoldsNumber) {
    const Medium medium = taylor_green().medium({{"re", 20}, {"speed", 3}, {"length", 6}, {"density", 700}});
    EXPECT_DOUBLE_EQ(medium.kinematic_viscosity, 0.9);
    EXPECT_EQ(medium.density, 700);
    EXPECT_EQ(medium.maximum_speed, 3);
}

TEST(TaylorGreen, IsSteadyWithoutViscosity) {
    const Evaluator fields = taylor_green().bind({{"re", 1e8}});
    const State start = fields({0.1, 0.2, 0}, 0);
    const State later = fields({0.1, 0.2, 0}, 1);
    EXPECT_NEAR(later.velocity[0], start.velocity[0], 1e-6);
    EXPECT_NEAR(later.velocity[1], start.velocity[1], 1e-6);
    EXPECT_NEAR(later.pressure / 1000, start.pressure / 1000, 1e-6);
}

TEST(TaylorGreen, ComesToRest) {
    const State end = taylor_green().bind({{"re", 10}})({0.1, 0.2, 0}, 1e3);
    EXPECT_EQ(std::abs(end.velocity[0]), 0);
    EXPECT_EQ(std::abs(end.velocity[1]), 0);
    EXPECT_EQ(std::abs(end.pressure), 0);
    EXPECT_EQ(taylor_green().kinetic_energy({{"re", 10}}, 1e3), 0);
}

TEST(TaylorGreen, StartsWithAQuarterOfTheSquaredSpeed) {
    EXPECT_DOUBLE_EQ(taylor_green().kinetic_energy({{"speed", 3}}, 0), 9. / 4);
}

} // namespace
} // namespace sphvv::analytic
