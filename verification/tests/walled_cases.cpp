#include "sphvv/solver/boundaries/wall_methods.hpp"
#include "sphvv/verification/run.hpp"
#include "sphvv/verification/study.hpp"
#include "sphvv/verification/wall_orders.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sphvv::verification {
namespace {

using solver::Assignments;

RunRecord run_of(const char* flow, const char* variant, const Assignments& given, int n) {
    return run_scene(resolve_scene(cases::find(flow), variant_of(variant), given, n));
}

double l2(const RunRecord& run, std::string_view field) {
    EXPECT_TRUE(run.survived) << run.diagnosis;
    const auto found = std::ranges::find(run.errors, field, &FieldError::field);
    return found == run.errors.end() ? std::nan("") : found->norms.l2;
}

/// log(e1/e2)/log(h1/h2)
double order(const RunRecord& coarse, const RunRecord& fine, std::string_view field) {
    return std::log(l2(coarse, field) / l2(fine, field)) / std::log(coarse.h / fine.h);
}

std::vector<std::string> stages_of(const RunRecord& run) {
    std::vector<std::string> names;
    for (const auto& stage : run.stages) {
        names.push_back(stage.name);
    }
    return names;
}

bool has(const std::vector<std::string>& names, const char* name) {
    return std::ranges::find(names, name) != names.end();
}

const Assignments poiseuille_brief{{"re", "5"}, {"end_time", "0.5"}};

// The derivation of wall_orders.hpp: 2 for images with 2w - u, 1 for a velocity that is constant beyond the
// wall.
TEST(Walls, EveryMethodHasItsOrderOnPoiseuilleFlow) {
    for (const solver::WallMethodEntry* method : solver::wall_methods::all()) {
        Assignments given = poiseuille_brief;
        given["wall_method"] = method->name;
        const char* scheme = "wcsph:kernel=quintic_spline";
        const double p = order(run_of("poiseuille", scheme, given, 10),
                               run_of("poiseuille", scheme, given, 20), "velocity");
        EXPECT_GT(p, method->shear_order - 0.35) << method->name;
        EXPECT_LT(p, method->shear_order + 0.45) << method->name;
    }
}

TEST(Walls, CurvedOnesHoldTheFlowBetweenCylinders) {
    const Assignments given{{"re", "10"}, {"end_time", "0.2"}};
    const RunRecord coarse = run_of("taylor_couette", "isph_mls", given, 8);
    const RunRecord fine = run_of("taylor_couette", "isph_mls", given, 16);
    const double p = order(coarse, fine, "velocity");
    EXPECT_GT(p, 1);
    EXPECT_LT(p, 2.6);
}

// Orders in L2 as derived at the corner (analytic/solutions/impulsive_plate.cpp).
TEST(ImpulsivePlate, HasTheOrdersOfItsCornerAndOfItsBoundaryTreatments) {
    const auto orders = [](const char* variant) {
        const Assignments given{{"length", "4"}};
        const RunRecord coarse = run_of("impulsive_plate", variant, given, 8);
        const RunRecord fine = run_of("impulsive_plate", variant, given, 16);
        return std::pair(order(coarse, fine, "impulse"), order(coarse, fine, "velocity"));
    };
    const auto [impulse, velocity] = orders("isph_df:laplacian=schwaiger:surface_pressure=true_position");
    EXPECT_NEAR(impulse, 1.9, 0.2);
    EXPECT_NEAR(velocity, 1, 0.1);
    const auto [at_particles, unused] = orders("isph_df:laplacian=schwaiger");
    EXPECT_NEAR(at_particles, 1, 0.15);
    const auto [published, layer] = orders("isph_df:laplacian=schwaiger:wall_pressure=even");
    EXPECT_NEAR(published, 1, 0.15);
    EXPECT_NEAR(layer, 0.5, 0.1);
}

TEST(ImpulsivePlate, GivesTheFluidItsImpulses) {
    const RunRecord run =
        run_of("impulsive_plate", "isph_df:laplacian=schwaiger:surface_pressure=true_position",
               {{"length", "4"}}, 16);
    EXPECT_LT(l2(run, "plate_impulse"), 0.02);
    EXPECT_LT(l2(run, "bed_impulse"), 0.005);
}

TEST(ImpulsivePlate, MovesWithItsPlate) {
    const RunRecord run =
        run_of("impulsive_plate", "isph_dfs:laplacian=schwaiger:viscosity=morris:surface_peclet=30",
               {{"end_time", "0.08"}, {"minimum_spacing", "0"}}, 20);
    // Ut/d = 0.16: as much may the solution to first order be off.
    for (const char* elevation : {"elevation_0.2", "elevation_0.3", "elevation_0.5"}) {
        EXPECT_LT(l2(run, elevation), 0.16) << elevation;
    }
}

const Assignments channel{{"re", "5"}, {"gravity", "1"}, {"end_time", "0.4"}};

TEST(FreeSurface, PressureIsHalfASpacingLowWithZeroAtTheParticles) {
    const int n = 16;
    const char* scheme = "isph_dfs:laplacian=schwaiger:viscosity=morris";
    for (const char* method : {"mirror", "mirror_row", "dummy"}) {
        Assignments given = channel;
        given["wall_method"] = method;
        const RunRecord at_particle = run_of("poiseuille_free_surface", scheme, given, n);
        EXPECT_NEAR(at_particle.errors[1].norms.l1, 1. / n, 0.01 / n)
            << method; // rho g dx/2 over the mean rho g H/2
    }
    const RunRecord true_position =
        run_of("poiseuille_free_surface", (std::string(scheme) + ":surface_pressure=true_position").c_str(),
               channel, n);
    EXPECT_LT(l2(true_position, "pressure"), 1e-3);
}

TEST(FreeSurface, SchwaigersLaplacianLaysNoConditionOnIt) {
    Assignments longer = channel;
    longer["end_time"] = "2";
    const RunRecord ls = run_of("poiseuille_free_surface", "isph_dfs:laplacian=schwaiger", longer, 14);
    const RunRecord lm =
        run_of("poiseuille_free_surface", "isph_dfs:laplacian=schwaiger:viscosity=morris", longer, 14);
    EXPECT_GT(l2(ls, "velocity"), 10 * l2(lm, "velocity"));
}

// A scene carries only what it needs.
TEST(LeanScenes, WallsBringNoSurfaceAndNoTurbulence) {
    const std::vector<std::string> stages = stages_of(run_of("poiseuille", "isph_dfs", poiseuille_brief, 8));
    EXPECT_EQ(stages, (std::vector<std::string>{"time_step", "drift", "neighbours", "viscosity",
                                                "pressure_poisson", "projection", "shifting"}));
    const RunRecord wcsph = run_of("poiseuille", "wcsph", poiseuille_brief, 8);
    EXPECT_EQ(stages_of(wcsph), (std::vector<std::string>{"time_step", "neighbours", "momentum", "continuity",
                                                          "drift", "equation_of_state"}));
}

TEST(LeanScenes, ThePlateHasASurfaceAndNoViscosityNorTurbulence) {
    const RunRecord run = run_of("impulsive_plate", "isph_dfs:laplacian=schwaiger", {}, 8);
    const std::vector<std::string> stages = stages_of(run);
    EXPECT_TRUE(has(stages, "free_surface"));
    EXPECT_TRUE(has(stages, "impulse"));
    for (const char* absent :
         {"viscosity", "velocity_gradient", "eddy_viscosity", "wall_function", "flow_driver"}) {
        EXPECT_FALSE(has(stages, absent)) << absent;
    }
    for (const auto& field : run.fields) {
        EXPECT_TRUE(field.name.find("eddy") == std::string::npos) << field.name;
    }
}

TEST(LeanScenes, AnInviscidColumnHasNoViscosity) {
    const std::vector<std::string> stages =
        stages_of(run_of("hydrostatic", "isph_df:laplacian=schwaiger", {{"end_time", "0.01"}}, 10));
    EXPECT_TRUE(has(stages, "body_force"));
    EXPECT_FALSE(has(stages, "viscosity"));
}

TEST(LeanScenes, ATurbulentChannelHasWhatItsModelReads) {
    const std::vector<std::string> stages =
        stages_of(run_of("log_law_channel", "wcsph:kernel=quartic_spline:h_over_dx=1.5:background_pressure=0",
                         {{"end_time", "0.01"}}, 12));
    for (const char* present : {"velocity_gradient", "eddy_viscosity", "flow_driver", "means"}) {
        EXPECT_TRUE(has(stages, present)) << present;
    }
}

TEST(WalledScenes, RefuseWhatTheyCannotHold) {
    const auto check = [](const char* flow, const char* variant, const Assignments& given, int n) {
        check_scene(resolve_scene(cases::find(flow), variant_of(variant), given, n));
    };
    EXPECT_THROW(check("poiseuille", "isph_dfs", {{"wall_method", "fixed"}}, 20), UserError);
    EXPECT_THROW(check("poiseuille", "isph_dfs", {{"wall_method", "brick"}}, 20), UserError);
    EXPECT_THROW(check("poiseuille", "isph_dfs", {{"columns", "4"}}, 20), UserError);
    EXPECT_THROW(check("poiseuille", "isph_dfs", {}, 3), UserError);
    EXPECT_THROW(check("taylor_couette", "isph_dfs", {{"wall_method", "dummy"}}, 16), UserError);
    EXPECT_THROW(run_of("impulsive_plate", "isph_dfs:laplacian=schwaiger:surface_peclet=30", {}, 8),
                 UserError);
}

// A driving force that is not controlled is exact to the last bit, and has no place on a front.
TEST(WalledScenes, AnErrorOfZeroEndsNoLadder) {
    const LadderRequest request{
        &cases::find("log_law_channel"),
        {variant_of("wcsph:kernel=quartic_spline:h_over_dx=1.5:background_pressure=0")},
        {{"driver", "constant"}, {"end_time", "0.005"}},
        {12},
        "command"};
    const LadderResult result = run_ladder(request);
    EXPECT_FALSE(result.studies.empty());
    for (const Front& front : result.fronts) {
        EXPECT_TRUE(front.field != "driving_force" || front.curves.empty());
    }
}

// What the registry says of a method is what studies expect.
TEST(WallOrders, FollowTheRegistry) {
    for (const Expectation& e : wall_orders::expectations(wall_orders::MorrisFloor::below)) {
        const auto method = std::ranges::find(e.where, "wall_method", &Condition::key);
        ASSERT_NE(method, e.where.end());
        const int derived = solver::wall_methods::find(method->word).shear_order;
        EXPECT_LT(*e.order.low, derived);
        EXPECT_GT(*e.order.high, derived);
    }
}

} // namespace
} // namespace sphvv::verification
