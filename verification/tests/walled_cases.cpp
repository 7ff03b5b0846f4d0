#include "sphvv/solver/boundaries/wall_methods.hpp"
#include "sphvv/solver/snapshots/snapshot.hpp"
#include "sphvv/solver/tests/temporary_folder.hpp"
#include "sphvv/verification/claims.hpp"
#include "sphvv/verification/run.hpp"
#include "sphvv/verification/study.hpp"
#include "sphvv/verification/wall_orders.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>

namespace sphvv::verification {
namespace {

using solver::Assignments;
using sphvv::tests::expect_mentions;
using sphvv::tests::refusal;

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
        if (method->shear_order == 0) {
            continue; // refused, below
        }
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

const char* const taylor = "wcsph:background_pressure=0:c0_over_u=37.37:continuity=renormalised:"
                           "kernel=cubic_spline:pressure_force=taylor";

// Sound of 2 % and less of the pressure, and the error of a coarse lattice.
TEST(AcceleratedTank, HasThePressureOfTheLimitButForSound) {
    for (const char* arrangement : {"lattice", "unstructured"}) {
        const RunRecord run = run_of("accelerated_tank", taylor, {{"arrangement", arrangement}}, 16);
        ASSERT_TRUE(run.survived) << run.diagnosis;
        EXPECT_LT(l2(run, "pressure"), 0.04) << arrangement;
        EXPECT_LT(l2(run, "pressure_slope"), 0.02) << arrangement;
        EXPECT_LT(run.errors[1].norms.linf_abs, 1e-3) << "the fluid moves by sound alone";
    }
}

// A Laplacian that is exact for linear fields leaves the tolerance of the solver; a force of the start of the
// step would leave dt/t = 8 %.
TEST(AcceleratedTank, IsExactWithoutSound) {
    for (const char* arrangement : {"lattice", "polar", "unstructured"}) {
        const RunRecord run =
            run_of("accelerated_tank", "isph_dfs:laplacian=schwaiger", {{"arrangement", arrangement}}, 16);
        EXPECT_LT(l2(run, "pressure"), 1e-4) << arrangement;
        EXPECT_LT(l2(run, "pressure_slope"), 1e-4) << arrangement;
    }
}

/// Largest acceleration over that of the force, in the pressure of the limit at half of the time, after a
/// step of no length to speak of.
double imbalance(const char* pressure_force) {
    const std::string variant =
        std::string("wcsph:background_pressure=0:c0_over_u=37.37:continuity=renormalised:"
                    "kernel=cubic_spline:time_step=1e-9:pressure_force=") +
        pressure_force;
    solver::Simulation<2> s = build_scene<2>(
        resolve_scene(cases::find("accelerated_tank"), variant_of(variant), {{"arrangement", "polar"}}, 16));
    s.time = 0.05;
    const double force = -9.81 * s.time;
    const double c0 = 37.37 * s.reference_speed;
    solver::Field& pressure = s.particles.field("pressure", 1, solver::Lifetime::state, "test");
    solver::Field& density = s.particles.field("density", 1, solver::Lifetime::state, "test");
    for (std::size_t i = 0; i < s.particles.size(); ++i) {
        const double p = s.density * force * s.particles.position[1][i];
        pressure[0][i] = p;
        density[0][i] = s.density * std::pow(1 + 7 * p / (s.density * c0 * c0), 1. / 7);
    }
    solver::advance(s);
    return s.maximum_acceleration / std::abs(force);
}

// Derived: a renormalised difference is exact for linear pressures on any set, of particles and images; what
// is left is the compression, p/(rho c0^2) = 4e-5.
TEST(AcceleratedTank, HasTaylorsFormInBalanceOnAnySet) {
    EXPECT_LT(imbalance("taylor"), 1e-3);
    EXPECT_GT(imbalance("sigma_1"), 1);
    EXPECT_GT(imbalance("renormalised"), 1);
}

solver::Simulation<2> tank_after(int steps) {
    solver::Simulation<2> s = build_scene<2>(resolve_scene(
        cases::find("accelerated_tank"), variant_of(taylor), {{"arrangement", "unstructured"}}, 20));
    for (int step = 0; step < steps; ++step) {
        solver::advance(s);
    }
    return s;
}

void expect_same_state(const solver::Simulation<2>& a, const solver::Simulation<2>& b) {
    EXPECT_EQ(a.body_force, b.body_force);
    for (const solver::Field& field : a.particles.fields()) {
        if (field.lifetime == solver::Lifetime::state) {
            EXPECT_EQ(field.components, b.particles.find(field.name)->components) << field.name;
        }
    }
}

TEST(AcceleratedTank, HasTheSameBitsOnTwoThreads) {
    const int allowed = omp_get_max_threads();
    omp_set_num_threads(1);
    const solver::Simulation<2> one = tank_after(10);
    omp_set_num_threads(2);
    const solver::Simulation<2> two = tank_after(10);
    omp_set_num_threads(allowed);
    expect_same_state(one, two);
    EXPECT_NEAR(one.body_force[1], -9.81 * (one.time - one.time_step), 1e-15);
}

class StoppedTank : public tests::TemporaryFolder {};

// The force follows from the time: a snapshot does not hold it.
TEST_F(StoppedTank, GoesOnWithTheSameBits) {
    const solver::Simulation<2> whole = tank_after(20);
    const solver::Assignments metadata{{"case", "accelerated_tank"}};
    write_snapshot(tank_after(10), metadata, folder / "tank.h5");
    solver::Simulation<2> second = tank_after(3);
    read_snapshot(second, metadata, folder / "tank.h5");
    for (int step = 0; step < 10; ++step) {
        solver::advance(second);
    }
    EXPECT_EQ(second.time, whole.time);
    expect_same_state(whole, second);
}

// Oger's set: asymmetric, nothing nearer to a wall than half a spacing, and all of the fluid.
TEST(AcceleratedTank, HasRingsOffTheMiddle) {
    const solver::Simulation<2> s = build_scene<2>(
        resolve_scene(cases::find("accelerated_tank"), variant_of(taylor), {{"arrangement", "polar"}}, 20));
    const double count = static_cast<double>(s.particles.fluid_size());
    EXPECT_NEAR(count, 400, 20);
    EXPECT_NEAR(count * s.particle_mass, 1000, 1e-9);
    std::array<double, 2> mean{};
    for (int d = 0; d < 2; ++d) {
        for (const double x : s.particles.position.components[d]) {
            EXPECT_LE(std::abs(x), 0.5 - 0.025 + 1e-12);
            mean[d] += x / count;
        }
        EXPECT_LT(std::abs(mean[d]), 0.01);
    }
    EXPECT_GT(std::hypot(mean[0], mean[1]), 1e-6) << "symmetric";
}

TEST(Claims, SayWhichRunsEndedEarly) {
    std::vector<RunRecord> runs(3);
    for (RunRecord& run : runs) {
        run.scheme = "wcsph";
        run.n = 40;
        run.errors = {{"pressure", Norms{0.1, 0.2, 0.3, 1, 1, 1, true}}};
    }
    runs[1].errors[0].norms.linf = 0.6;
    const auto finding = [&](double low, double high) {
        return largest_pressure_error(runs, "wcsph", 40, low, high).value();
    };
    EXPECT_FALSE(largest_pressure_error(runs, "wcsph", 20, 0, 1));
    EXPECT_EQ(finding(0, 1).ours, "largest 30 % to 60 %, L2 20 % to 20 %");
    EXPECT_TRUE(finding(0.3, 0.6).agrees);
    EXPECT_FALSE(finding(0, 0.5).agrees);
    EXPECT_FALSE(finding(0.4, 1).agrees);
    runs[2].errors.clear();
    runs[2].time = 0.05;
    runs[2].diagnosis = "lost";
    EXPECT_EQ(finding(0, 1).ours,
              "1 of 3 ended early, the first at t = 0.0500 s: lost; otherwise largest 30 % "
              "to 60 %, L2 20 % to 20 %");
    EXPECT_FALSE(finding(0, 1).agrees);
    runs.erase(runs.begin(), runs.begin() + 2);
    EXPECT_EQ(finding(0, 1).ours, "1 of 1 ended early, the first at t = 0.0500 s: lost");
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

TEST(LeanScenes, PointsThatRepelAreNoParticlesAndNoStage) {
    const Assignments brief{{"end_time", "0.01"}};
    Assignments given = brief;
    const RunRecord mirrored = run_of("hydrostatic", "wcsph", given, 10);
    given["wall_method"] = "repulsive_normal";
    const RunRecord repelled = run_of("hydrostatic", "wcsph", given, 10);
    EXPECT_EQ(stages_of(repelled), stages_of(mirrored));
    EXPECT_EQ(repelled.particles, mirrored.particles);
    EXPECT_EQ(repelled.bytes_per_particle, mirrored.bytes_per_particle);
    const auto scene = resolve_scene(cases::find("hydrostatic"), variant_of("wcsph"), brief, 10);
    EXPECT_FALSE(build_scene<2>(scene).repulsion);
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
    EXPECT_THROW(check("taylor_couette", "isph_dfs", {}, 3), UserError) << "3 dx between the cylinders";
    EXPECT_NO_THROW(check("taylor_couette", "isph_dfs", {}, 4));
    EXPECT_THROW(check("poiseuille", "isph_dfs", {}, 3), UserError);
    EXPECT_THROW(check("taylor_couette", "isph_dfs", {{"wall_method", "dummy"}}, 16), UserError);
    EXPECT_THROW(run_of("impulsive_plate", "isph_dfs:laplacian=schwaiger:surface_peclet=30", {}, 8),
                 UserError);
    expect_mentions(refusal([&] { run_of("hydrostatic", "isph_mls", {}, 10); }),
                    {"isph_mls has no free surface", "wcsph"});
}

TEST(WalledScenes, RefuseWallsThatRepelWhereTheyCannot) {
    for (const char* method : {"repulsive", "repulsive_lennard_jones", "repulsive_normal"}) {
        const auto check = [method](const char* flow, const char* variant) {
            check_scene(resolve_scene(cases::find(flow), variant_of(variant), {{"wall_method", method}}, 20));
        };
        EXPECT_NO_THROW(check("hydrostatic", "wcsph"));
        EXPECT_NO_THROW(check("impulsive_plate", "wcsph"));
        const std::string name = std::string("wall_method=") + method;
        expect_mentions(refusal([&] { check("poiseuille", "wcsph"); }),
                        {name, "carries no shear", "free slip", "mirror, mirror_row, dummy or fixed"});
        expect_mentions(refusal([&] { check("hydrostatic", "isph_dfs"); }),
                        {name, "a scheme whose density evolves (wcsph)", "mirror, mirror_row or dummy"});
    }
    const Assignments none{{"wall_method", "repulsive"}, {"points_per_dx", "0"}};
    EXPECT_THROW(resolve_scene(cases::find("hydrostatic"), variant_of("wcsph"), none, 20), UserError);
}

/// Sum of m a over the fluid of what the walls push it with, N per metre of depth.
solver::Vector<2> push_of_walls(const solver::Simulation<2>& s) {
    solver::Vector<2> total = solver::Vector<2>::Zero();
    for (std::size_t i = 0; i < s.particles.fluid_size(); ++i) {
        total += s.particle_mass *
                 s.repulsion->acceleration(s.walls, {s.particles.position[0][i], s.particles.position[1][i]},
                                           s.time);
    }
    return total;
}

solver::Simulation<2> column(const Assignments& settings, int n = 16) {
    Assignments given = settings;
    given.insert({{"kernel", "quintic_spline"}, {"damping", "150"}, {"end_time", "0.6"}});
    return build_scene<2>(resolve_scene(cases::find("hydrostatic"), variant_of("wcsph"), given, n));
}

// The forces between particles are antisymmetric: at rest the bed holds the weight, to what is left of the
// motion.
TEST(Repulsion, HoldsTheWeightOfAColumnAtRest) {
    for (const Assignments& settings :
         {Assignments{{"wall_method", "repulsive"}, {"points_per_dx", "4"}},
          Assignments{{"wall_method", "repulsive_lennard_jones"}, {"points_per_dx", "4"}},
          Assignments{{"wall_method", "repulsive_normal"}},
          Assignments{{"wall_method", "repulsive_normal"}, {"repulsion", "3"}},
          Assignments{{"wall_method", "repulsive_normal"}, {"integrator", "predictor_corrector"}},
          Assignments{{"wall_method", "repulsive_normal"}, {"integrator", "verlet"}}}) {
        auto s = column(settings);
        EXPECT_TRUE(s.wall_particles.empty());
        EXPECT_EQ(s.particles.size(), s.particles.fluid_size());
        while (s.time < s.end_time) {
            advance(s);
        }
        EXPECT_TRUE(s.images.empty());
        const double weight =
            -s.body_force[1] * s.particle_mass * static_cast<double>(s.particles.fluid_size());
        EXPECT_NEAR(push_of_walls(s)[1], weight, 1e-4 * weight) << settings.at("wall_method");
        EXPECT_NEAR(push_of_walls(s)[0], 0, 1e-4 * weight);
        EXPECT_LT(s.maximum_acceleration, 0.1 * -s.body_force[1]);
    }
}

// Of the weight of n rows, x^-5 - x^-3 = n g dx/(D/dx) = n/(n + 1/2): where the lowest row rests, in dx.
TEST(Repulsion, TheLowestRowRestsWhereTheForceIsTheWeight) {
    constexpr int n = 16;
    auto s = column({{"wall_method", "repulsive_normal"}}, n);
    while (s.time < s.end_time) {
        advance(s);
    }
    double low = 0.5;
    double high = 1;
    while (high - low > 1e-12) {
        const double x = (low + high) / 2;
        (std::pow(x, -5) - std::pow(x, -3) > n / (n + 0.5) ? low : high) = x;
    }
    const double* y = s.particles.position[1];
    const double lowest = *std::min_element(y, y + s.particles.size());
    EXPECT_NEAR(lowest / s.particle_spacing, low, 1e-4);
}

class ResumedColumn : public sphvv::tests::TemporaryFolder {};

TEST_F(ResumedColumn, GivesTheSameBitsOnOtherThreads) {
    const int threads = omp_get_max_threads();
    const std::filesystem::path path = folder / "column.h5";
    const Assignments settings{{"wall_method", "repulsive"}, {"damping", "0"}};
    const auto advance_by = [](solver::Simulation<2>& s, int steps) {
        for (int k = 0; k < steps; ++k) {
            advance(s);
        }
    };
    omp_set_num_threads(1);
    auto whole = column(settings);
    advance_by(whole, 60);
    auto first = column(settings);
    advance_by(first, 30);
    solver::write_snapshot(first, {}, path);
    omp_set_num_threads(2);
    auto second = column(settings);
    solver::read_snapshot(second, {}, path);
    advance_by(second, 30);
    omp_set_num_threads(threads);
    for (const char* name : {"position", "velocity", "density"}) {
        EXPECT_EQ(whole.particles.find(name)->components, second.particles.find(name)->components) << name;
    }
    EXPECT_GT(push_of_walls(second).norm(), 0);
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
