// Published digits, momentum budgets and limits of the laminar channels.
#include "sphvv/analytic/layer_diffusion.hpp"
#include "sphvv/analytic/solutions.hpp"
#include "sphvv/analytic/tests/checks.hpp"

#include <gtest/gtest.h>

namespace sphvv::analytic {
namespace {

using namespace checks;

double number(std::string_view solution, std::string_view name, const Values& values, double t = 0) {
    return quantity(solutions::find(solution), name, values)({}, t);
}

const Values issa{{"re", 10}, {"speed", 0.25}, {"depth", 0.399676}};

TEST(FreeSurfaceChannel, HasIssasValues) { // §4.2
    const Solution& channel = solutions::find("poiseuille_free_surface");
    const Medium medium = channel.medium(issa);
    EXPECT_NEAR(medium.kinematic_viscosity, 9.992e-3, 5e-7);
    EXPECT_NEAR(medium.body_force[0], 0.04691, 5e-6);
    EXPECT_EQ(medium.body_force[1], -9.81);
    EXPECT_DOUBLE_EQ(medium.maximum_speed, 0.375);
    EXPECT_DOUBLE_EQ(number(channel.name, "driving_force", issa), medium.body_force[0]);
    const double H = 0.399676;
    EXPECT_NEAR(number(channel.name, "wall_shear_stress", issa, 1e4), 1000 * medium.body_force[0] * H, 1e-9);
    EXPECT_NEAR(number(channel.name, "bulk_velocity", issa, 1e4), 0.25, 1e-14);
    const double nu = medium.kinematic_viscosity;
    EXPECT_NEAR(medium.body_force[0], 3 * nu * 0.25 / (H * H), 1e-16);
    EXPECT_NEAR(4 * H * H / (pi * pi * nu), 6.48, 5e-3); // s, the slowest decay
}

TEST(FreeSurfaceChannel,
     ReachesTheSurfaceVelocityFromTheLinearStartAsStated) { // share of the steady velocity
    Values values = issa;
    values["linear_start"] = 1;
    const Evaluator fields = solutions::find("poiseuille_free_surface").bind(values);
    const auto share = [&](double t) { return fields({0, 0.399676, 0}, t).velocity[0] / 0.375; };
    EXPECT_NEAR(share(0), 1, 1e-15) << "FH²/2ν is the steady velocity of the surface";
    EXPECT_NEAR(share(4), 0.881, 5e-4);
    EXPECT_NEAR(share(12), 0.965, 5e-4);
    EXPECT_NEAR(share(24), 0.9945, 5e-5);
    EXPECT_NEAR(share(36), 0.9991, 5e-5);
    EXPECT_NEAR(share(48), 0.9999, 5e-5);
}

TEST(FreeSurfaceChannel, StartsFromIssasLinearProfile) {
    Values values = issa;
    values["linear_start"] = 1;
    const Solution& channel = solutions::find("poiseuille_free_surface");
    const Medium medium = channel.medium(values);
    const double H = 0.399676;
    for (const double y : {0.1 * H, 0.5 * H, 0.9 * H}) {
        EXPECT_NEAR(channel.bind(values)({0, y, 0}, 0).velocity[0],
                    medium.body_force[0] * H * y / (2 * medium.kinematic_viscosity), 1e-15);
    }
}

TEST(FreeSurfaceChannel, HasTheSeriesOfTheSheet) {
    const Solution& channel = solutions::find("poiseuille_free_surface");
    const Medium medium = channel.medium(issa);
    const double H = 0.399676;
    const double nu = medium.kinematic_viscosity;
    const double F = medium.body_force[0];
    for (const double start : {0.0, 1.0}) {
        Values values = issa;
        values["linear_start"] = start;
        for (const double t : {0.5, 3.0, 10.0}) {
            const double z = 0.3 * H;
            double u = F * z * (2 * H - z) / (2 * nu);
            for (int n = 0; n < 60; ++n) {
                const double k = 2 * n + 1;
                const double rest = -16 * F * H * H / (nu * std::pow(pi * k, 3));
                const double linear = 4 * F * H * H / (nu * pi * pi * k * k) * (n % 2 == 0 ? 1 : -1);
                u += (rest + start * linear) * std::sin(k * pi * z / (2 * H)) *
                     std::exp(-k * k * pi * pi * nu * t / (4 * H * H));
            }
            EXPECT_NEAR(channel.bind(values)({0, z, 0}, t).velocity[0], u, 1e-14) << start << " " << t;
        }
    }
}

/// dU/dt = F − τ_w/ρH (times two for two walls), U and τ_w from different sums.
TEST(Channels, KeepTheirMomentumBudget) {
    for (const double start : {0.0, 0.5, 1.0}) {
        for (const double t : {0.002, 0.03, 0.3}) { // widths²/nu with the values below
            const Values values{{"re", 1}, {"speed", 1}, {"width", 1}, {"linear_start", start}};
            const double rate =
                derivatives([&](double s) { return number("poiseuille", "bulk_velocity", values, t + s); },
                            t / 64)
                    .first;
            EXPECT_NEAR(rate, 12 - 2 * number("poiseuille", "wall_shear_stress", values, t) / 1000, 1e-10);
        }
    }
    for (const double t : {0.002, 0.03, 0.3}) {
        const Values values{{"re", 1}, {"steady_start", 0.25}};
        const double rate =
            derivatives([&](double s) { return number("couette", "bulk_velocity", values, t + s); }, t / 64)
                .first;
        EXPECT_NEAR(rate,
                    (number("couette", "moving_wall_shear_stress", values, t) -
                     number("couette", "wall_shear_stress", values, t)) /
                        1000,
                    1e-10);
    }
}

TEST(Channels, ComeToTheirSteadyProfile) {
    for (const char* name : {"poiseuille", "poiseuille_free_surface", "couette"}) {
        const Solution& channel = solutions::find(name);
        const Vector x{0.1, 0.13, 0};
        const double late = channel.bind({})(x, 1e6).velocity[0];
        EXPECT_GT(late, 0);
        EXPECT_NEAR(channel.bind({{"steady_start", 1}})(x, 0).velocity[0] / late, 1, 1e-14);
        EXPECT_NEAR(channel.bind({{"steady_start", 1}})(x, 0.01).velocity[0] / late, 1, 1e-14);
        EXPECT_LT(channel.bind({})(x, 1e-6).velocity[0], 1e-3 * late);
    }
    const Evaluator poiseuille = solutions::find("poiseuille").bind({{"speed", 2}, {"width", 4}});
    EXPECT_NEAR(poiseuille({0, 1, 0}, 1e6).velocity[0], 6 * 2 * 0.25 * 0.75, 1e-14);
    EXPECT_NEAR(poiseuille({0, 3, 0}, 1e6).velocity[0], 6 * 2 * 0.25 * 0.75, 1e-14);
    EXPECT_NEAR(poiseuille({0, 2, 0}, 1e6).velocity[0], 3, 1e-14);
}

TEST(Channels, IgnoreViscosityWhereItHasNotYetReached) {
    const Values thin{{"re", 1e8}};
    const Solution& poiseuille = solutions::find("poiseuille");
    EXPECT_NEAR(poiseuille.bind(thin)({0, 0.5, 0}, 10).velocity[0],
                10 * poiseuille.medium(thin).body_force[0], 1e-18);
    const Solution& couette = solutions::find("couette");
    EXPECT_EQ(couette.bind(thin)({0, 0.5, 0}, 10).velocity[0], 0);
}

TEST(Couette, StartsAsAHalfSpace) { // Stokes' first problem: erfc(1) = 0.15729920705028513
    const double nu = 0.1;
    for (const double t : {1e-6, 1e-4}) {
        const double y = 1 - 2 * std::sqrt(nu * t);
        EXPECT_NEAR(solutions::find("couette").bind({})({0, y, 0}, t).velocity[0], 0.15729920705028513,
                    1e-12);
    }
}

TEST(Couette, MovesTheUpperWall) {
    const Solution& couette = solutions::find("couette");
    const std::vector<Boundary> walls = couette.boundaries({{"speed", 3}, {"width", 2}});
    ASSERT_EQ(walls.size(), 2);
    EXPECT_EQ(walls[0].velocity({}, 1), (Vector{}));
    EXPECT_EQ(walls[1].velocity({}, 1), (Vector{3, 0, 0}));
    EXPECT_EQ(walls[0].distance({0, 0.5, 0}), 0.5);
    EXPECT_EQ(walls[1].distance({0, 0.5, 0}), 1.5);
    EXPECT_EQ(walls[1].face->direction, 1);
    EXPECT_TRUE(walls[1].face->high);
}

} // namespace
} // namespace sphvv::analytic
