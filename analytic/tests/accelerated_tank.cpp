// The pressure of the closed tank, and what sound makes of it.
#include "sphvv/analytic/solutions.hpp"
#include "sphvv/analytic/tests/checks.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace sphvv::analytic {
namespace {

using namespace checks;

const Solution& tank() {
    return solutions::find("accelerated_tank");
}

TEST(AcceleratedTank, HasOgersPressure) {
    const Evaluator fields = tank().bind({});
    EXPECT_NEAR(fields({0.2, 0.5, 0}, 0.102).pressure, -1000 * 9.81 * 0.5 * 0.102, 1e-9);
    EXPECT_EQ(fields({0.2, 0, 0}, 0.102).pressure, 0) << "at mid-height";
    EXPECT_EQ(fields({0.2, 0.3, 0}, 0).pressure, 0) << "at the start";
    EXPECT_NEAR(body_force(tank(), {}, 0.102)[1], -9.81 * 0.102, 1e-15);
}

TEST(AcceleratedTank, HasNoMeanPressure) {
    Random random(3);
    for (int draw = 0; draw < 20; ++draw) {
        EXPECT_LT(mean_pressure_error(Flow(tank(), random_values(tank(), random)), random), 1e-12);
    }
}

TEST(AcceleratedTank, IsClosed) {
    const Flow flow(tank(), resolve(tank(), {}));
    ASSERT_EQ(flow.walls.size(), 4U);
    for (const Boundary& wall : flow.walls) {
        EXPECT_EQ(wall.kind, BoundaryKind::impermeable);
        EXPECT_NEAR(wall.distance({}), 0.5, 1e-15);
    }
}

/// Linear sound on a staggered grid by the leap-frog at Courant number 1, which carries waves exactly: the
/// slope of p over that of ρ γ0 y t.
double simulated_slope(double H, double c, double t) {
    constexpr double gamma = -9.81;
    constexpr int cells = 4000;
    const double dy = H / cells;
    const double dt = dy / c;
    std::vector<double> u(cells + 1, 0); // over the faces, at half steps
    std::vector<double> p(cells, 0);     // over ρ
    const long steps = std::lround(t / dt);
    for (long step = 0; step < steps; ++step) {
        for (int i = 1; i < cells; ++i) {
            u[i] += dt * (gamma * static_cast<double>(step) * dt - (p[i] - p[i - 1]) / dy);
        }
        for (int i = 0; i < cells; ++i) {
            p[i] -= dt * c * c * (u[i + 1] - u[i]) / dy;
        }
    }
    double ours = 0;
    double limit = 0;
    for (int i = 0; i < cells; ++i) {
        const double y = (i + 0.5) * dy - H / 2;
        ours += p[i] * y;
        limit += gamma * static_cast<double>(steps) * dt * y * y;
    }
    return ours / limit;
}

TEST(AcceleratedTank, HasTheSlopeThatSoundLeaves) {
    const auto slope = [](double H, double c, double t) {
        return quantity(tank(), "pressure_slope", {{"height", H}, {"sound_speed", c}})({}, t);
    };
    EXPECT_NEAR(slope(1, 80, 0.102), simulated_slope(1, 80, 0.102), 1e-4);
    EXPECT_NEAR(slope(1, 80, 0.102), 0.9813, 5e-5) << "1.9 % below the incompressible limit";
    EXPECT_NEAR(slope(2, 30, 0.05), simulated_slope(2, 30, 0.05), 1e-3);
    EXPECT_NEAR(slope(1, 80, 1. / 80), 1, 1e-12) << "after one crossing all modes pass through zero";
    EXPECT_NEAR(slope(1, 1e12, 0.102), 1, 1e-11) << "incompressible";
    EXPECT_LT(slope(1, 80, 1e-5), 1e-3) << "not felt yet by what is away from the walls";
    EXPECT_EQ(slope(1, 80, 0), 0);
}

} // namespace
} // namespace sphvv::analytic
