// Each scheme against the algorithm that it cites, carried out with all pairs and dense matrices.
//   solver_cited_algorithms --gtest_filter='*Projection*'
#include "sphvv/solver/tests/reference.hpp"

#include <gtest/gtest.h>

namespace sphvv::solver {
namespace {

using namespace scenes;

struct Choice {
    const char* scheme;
    Assignments given;
};

const std::array projections{
    Choice{"isph_df", {}},
    Choice{"isph_df", {{"gradient", "plain"}, {"eta_over_h", "0.1"}}},
    Choice{"isph_df", {{"gradient", "symmetric"}}},
    Choice{"isph_df", {{"laplacian", "schwaiger"}}},
    Choice{"isph_df", {{"laplacian", "schwaiger"}, {"gradient", "plain"}}},
    Choice{"isph_df", {{"viscosity", "monaghan_cleary"}, {"eta_over_h", "0.1"}}},
    Choice{"isph_df", {{"viscosity", "monaghan_cleary"}, {"laplacian", "schwaiger"}}},
    Choice{"isph_df", {{"preconditioner", "jacobi"}}},
    Choice{"isph_dfs", {}},
    Choice{"isph_dfs", {{"shift_correction", "none"}, {"shift_coefficient", "0.1"}}},
    Choice{"isph_dfs", {{"shift_correction", "second"}, {"shift_coefficient", "0.1"}}},
    Choice{"isph_dfs", {{"shift_limit", "0.02"}}},
    Choice{"isph_di", {}},
    Choice{"isph_di", {{"gradient", "plain"}, {"eta_over_h", "0.1"}}},
    Choice{"isph_di", {{"gradient", "symmetric"}, {"viscosity", "monaghan_cleary"}}},
    Choice{"isph_di", {{"laplacian", "schwaiger"}}},
    Choice{"isph_di", {{"laplacian", "schwaiger"}, {"gradient", "plain"}}},
    Choice{"isph_dfdi", {}},
    Choice{"isph_dfdi", {{"gradient", "plain"}, {"eta_over_h", "0.1"}, {"density_iterations", "4"}}},
    Choice{"isph_dfdi",
           {{"gradient", "symmetric"}, {"viscosity", "monaghan_cleary"}, {"density_iterations", "3"}}},
    Choice{"isph_dfdi", {{"laplacian", "schwaiger"}, {"density_iterations", "2"}}},
    Choice{"isph_lee", {}},
    Choice{"isph_lee", {{"gradient", "normalised"}, {"eta_over_h", "0.1"}}},
    Choice{"isph_lee", {{"gradient", "plain"}, {"viscosity", "monaghan_cleary"}}},
    Choice{"isph_lee", {{"laplacian", "schwaiger"}}},
    Choice{"isph_asai", {}},
    Choice{"isph_asai", {{"relaxation", "0.8"}, {"gradient", "normalised"}}},
    Choice{"isph_asai", {{"laplacian", "schwaiger"}, {"viscosity", "monaghan_cleary"}}},
    Choice{"isph_df", {{"viscous_step", "implicit"}}},
    Choice{"isph_df",
           {{"viscous_step", "implicit"}, {"laplacian", "schwaiger"}, {"preconditioner", "jacobi"}}},
    Choice{"isph_dfs", {{"viscous_step", "implicit"}, {"gradient", "plain"}}},
    Choice{"isph_di", {{"viscous_step", "implicit"}, {"eta_over_h", "0.1"}}},
    Choice{"isph_dfdi", {{"viscous_step", "implicit"}, {"density_iterations", "2"}}},
    Choice{"isph_lee", {{"viscous_step", "implicit"}, {"laplacian", "schwaiger"}}},
    Choice{"isph_asai", {{"viscous_step", "implicit"}}}};

std::string described(const Choice& choice) {
    std::string text = choice.scheme;
    for (const auto& [key, value] : choice.given) {
        text += " " + key + "=" + value;
    }
    return text;
}

TEST(CitedAlgorithm, IsCarriedOutByTheProjectionSchemes) {
    for (const Choice& choice : projections) {
        SCOPED_TRACE(described(choice));
        in_2d_and_3d([&](auto dimension) {
            constexpr int Dim = dimension;
            const Scheme& scheme = schemes::find(choice.scheme);
            Assignments given = choice.given;
            given["pressure_tolerance"] = "1e-13";
            given["viscous_tolerance"] = "1e-13";
            given["kernel"] = "quintic_spline";
            given["h_over_dx"] = "1.2";
            Simulation<Dim> scene = general_scene<Dim>(scheme, given);
            Reference<Dim> reference(scene);
            scheme.assemble(scene);
            for (int step = 0; step < 2; ++step) {
                advance(scene);
                projection_step(reference, scheme, scene);
                reference.expect_equals(scene, 1e-9);
            }
        });
    }
}

// Every iteration of density invariance has a list of its own: weights and two sums over the old one (the
// gradient and its L_i), the density on the new one.
TEST(CitedAlgorithm, OfTheTwoInvariancesBooksEveryIteration) {
    in_2d_and_3d([&](auto dimension) {
        constexpr int Dim = dimension;
        const Scheme& scheme = schemes::find("isph_dfdi");
        Simulation<Dim> scene = general_scene<Dim>(
            scheme, {{"pressure_tolerance", "1e-13"}, {"h_over_dx", "1.2"}, {"density_tolerance", "0.04"}});
        Reference<Dim> reference(scene);
        scheme.assemble(scene);
        advance(scene);
        projection_step(reference, scheme, scene);
        EXPECT_GT(reference.density_iterations, 1);
        EXPECT_LT(reference.density_iterations, 20);
        ASSERT_EQ(reference.listed_pairs.size(), reference.density_iterations + 1);
        std::int64_t expected = reference.listed_pairs.front();
        for (int m = 0; m < reference.density_iterations; ++m) {
            expected += 3 * reference.listed_pairs[m] + reference.listed_pairs[m + 1];
        }
        const auto stage = std::ranges::find(scene.stages, "density_invariance", &Stage<Dim>::name);
        ASSERT_NE(stage, scene.stages.end());
        EXPECT_EQ(stage->pair_evaluations, expected);
    });
}

TEST(CitedAlgorithm, IsCarriedOutByTheWeaklyCompressibleScheme) {
    for (const std::string integrator : {"explicit", "predictor_corrector"}) {
        for (const std::string background : {"0", "0.5"}) {
            SCOPED_TRACE(integrator);
            SCOPED_TRACE("background pressure " + background);
            in_2d_and_3d([&](auto dimension) {
                constexpr int Dim = dimension;
                const Scheme& scheme = schemes::find("wcsph");
                Simulation<Dim> scene = general_scene<Dim>(scheme, {{"integrator", integrator},
                                                                    {"background_pressure", background},
                                                                    {"gamma", "5"},
                                                                    {"c0_over_u", "12"},
                                                                    {"eta_over_h", "0.1"},
                                                                    {"h_over_dx", "1.5"}});
                Reference<Dim> reference(scene);
                reference.set_tait(12 * 1.5, 5, std::stod(background) * 3 * 1.5 * 1.5);
                scheme.assemble(scene);
                reference.expect_equals(scene, 1e-14);
                for (int step = 0; step < 3; ++step) {
                    advance(scene);
                    if (integrator == "explicit") {
                        reference.explicit_step(scene.time_step, 0.1 * scene.smoothing_length);
                    } else {
                        reference.predictor_corrector_step(scene.time_step, 0.1 * scene.smoothing_length);
                    }
                    reference.expect_equals(scene, 1e-11);
                }
            });
        }
    }
}

/// Every word of a key.
const std::vector<std::string>& words(std::string_view key) {
    const std::vector<Key>& keys = schemes::find("wcsph").keys;
    return std::ranges::find(keys, key, &Key::name)->choices;
}

/// Particles pushed together in the middle of the box and apart at its sides, so that some are taken for the
/// free surface and some are not.
template <int Dim>
Simulation<Dim> uneven_scene(const Assignments& given) {
    Simulation<Dim> scene = general_scene<Dim>(schemes::find("wcsph"), given, Dim == 2 ? 16 : 12);
    for (int d = 0; d < Dim; ++d) {
        for (double& x : scene.particles.position.components[d]) {
            x += 0.05 * std::sin(2 * pi * x);
            x -= std::floor(x);
        }
    }
    return scene;
}

TEST(CitedAlgorithm, IsCarriedOutByEveryWeaklyCompressibleForm) {
    for (const std::string& continuity : words("continuity")) {
        for (const std::string& pressure_force : words("pressure_force")) {
            for (const std::string& viscosity : words("viscosity")) {
                SCOPED_TRACE(continuity + " " + pressure_force + " " + viscosity);
                in_2d_and_3d([&](auto dimension) {
                    constexpr int Dim = dimension;
                    const Scheme& scheme = schemes::find("wcsph");
                    Simulation<Dim> scene =
                        general_scene<Dim>(scheme, {{"continuity", continuity},
                                                    {"pressure_force", pressure_force},
                                                    {"viscosity", viscosity},
                                                    {"background_pressure", "0.5"},
                                                    {"gamma", "5"},
                                                    {"c0_over_u", "3"}, // uneven densities
                                                    {"eta_over_h", viscosity == "morris" ? "0" : "0.1"},
                                                    {"h_over_dx", "1.5"}});
                    Reference<Dim> reference(scene);
                    reference.take_forms(scene.settings);
                    reference.set_tait(3 * 1.5, 5, 0.5 * 3 * 1.5 * 1.5);
                    scheme.assemble(scene);
                    for (int step = 0; step < 2; ++step) {
                        advance(scene);
                        reference.explicit_step(scene.time_step,
                                                scene.settings.number("eta_over_h") * scene.smoothing_length);
                        reference.expect_equals(scene, 1e-11);
                    }
                });
            }
        }
    }
}

TEST(CitedAlgorithm, TellsTheFreeSurfaceByTheLowestEigenvalue) {
    in_2d_and_3d([&](auto dimension) {
        constexpr int Dim = dimension;
        const Scheme& scheme = schemes::find("wcsph");
        // With a skin, some listed neighbours do not interact and must not tell.
        for (const std::string integrator : {"explicit", "predictor_corrector"}) {
            Simulation<Dim> scene = uneven_scene<Dim>(
                {{"pressure_force", "hybrid_taylor"}, {"integrator", integrator}, {"c0_over_u", "3"}});
            Reference<Dim> reference(scene);
            reference.take_forms(scene.settings);
            reference.set_tait(3 * 1.5, 7, 0.5 * 3 * 1.5 * 1.5);
            scheme.assemble(scene);
            const std::vector<bool> near = reference.near_surface(reference.pairs_at(reference.x));
            EXPECT_GT(std::ranges::count(near, true), 10);
            EXPECT_GT(std::ranges::count(near, false), 10);
            for (int step = 0; step < 2; ++step) {
                advance(scene);
                if (integrator == "explicit") {
                    reference.explicit_step(scene.time_step, 0);
                } else {
                    reference.predictor_corrector_step(scene.time_step, 0);
                }
                reference.expect_equals(scene, 1e-11);
            }
        }
    });
}

// A stray particle has no L: it is all surface, and its gradients are as they are.
TEST(CitedAlgorithm, TakesAStrayParticleForTheFreeSurface) {
    const Scheme& scheme = schemes::find("wcsph");
    Simulation<2> scene = still_scene<2>(scheme, {{"pressure_force", "hybrid_taylor"}}, 9);
    scene.box.periodic.fill(false);
    scene.particles.position[0][0] = 1; // into a corner, out of reach of a row pushed inwards
    scene.particles.position[1][0] = 1;
    for (std::size_t i = 1; i < scene.particles.size(); ++i) {
        for (int d = 0; d < 2; ++d) {
            scene.particles.position[d][i] *= 0.5;
        }
    }
    scheme.assemble(scene);
    advance(scene);
    const auto stray = std::ranges::find(scene.particles.id, 0) - scene.particles.id.begin();
    EXPECT_EQ((*scene.particles.find("lowest_eigenvalue"))[0][stray], 0);
    const Field& L = *scene.particles.find("renormalisation");
    EXPECT_EQ(L[0][stray], 1);
    EXPECT_EQ(L[1][stray], 0);
    EXPECT_EQ(L[2][stray], 1);
}

TEST(CitedAlgorithm, IsCarriedOutByTheIntegratorsWithEveryKindOfForm) {
    struct Forms {
        const char* continuity;
        const char* pressure_force;
    };
    for (const Forms& forms :
         {Forms{"sigma_2", "sigma_2"}, Forms{"sigma_1", "sigma_1"},
          Forms{"renormalised", "renormalised_coherent"}, Forms{"renormalised", "taylor"}}) {
        for (const std::string integrator : {"explicit", "predictor_corrector", "verlet"}) {
            SCOPED_TRACE(integrator + " " + forms.continuity + " " + forms.pressure_force);
            in_2d_and_3d([&](auto dimension) {
                constexpr int Dim = dimension;
                const Scheme& scheme = schemes::find("wcsph");
                Simulation<Dim> scene = general_scene<Dim>(scheme, {{"integrator", integrator},
                                                                    {"restart_interval", "3"},
                                                                    {"continuity", forms.continuity},
                                                                    {"pressure_force", forms.pressure_force},
                                                                    {"c0_over_u", "12"},
                                                                    {"h_over_dx", "1.5"}});
                Reference<Dim> reference(scene);
                reference.take_forms(scene.settings);
                reference.set_tait(12 * 1.5, 7, 0.5 * 3 * 1.5 * 1.5);
                scheme.assemble(scene);
                for (int step = 1; step <= 5; ++step) {
                    advance(scene);
                    if (integrator == "explicit") {
                        reference.explicit_step(scene.time_step, 0);
                    } else if (integrator == "predictor_corrector") {
                        reference.predictor_corrector_step(scene.time_step, 0);
                    } else { // Euler steps 1 and 4
                        reference.verlet_step(scene.time_step, 0, step % 3 != 1);
                    }
                    reference.expect_equals(scene, 1e-11);
                }
            });
        }
    }
}

TEST(CitedAlgorithm, AVerletStepLeapsOverEqualStepsOnly) {
    in_2d_and_3d([&](auto dimension) {
        constexpr int Dim = dimension;
        const Scheme& scheme = schemes::find("wcsph");
        Assignments given{{"integrator", "verlet"}, {"time_step", "0.001"}, {"h_over_dx", "1.5"}};
        Simulation<Dim> scene = general_scene<Dim>(scheme, given);
        Reference<Dim> reference(scene);
        reference.set_tait(10 * 1.5, 7, 0.5 * 3 * 1.5 * 1.5);
        scheme.assemble(scene);
        for (int step = 1; step <= 6; ++step) {
            if (step == 4) {
                given["time_step"] = "0.0005";
                scene.settings = Settings(scheme.keys, given);
            }
            advance(scene);
            EXPECT_NEAR(scene.time_step, step < 4 ? 0.001 : 0.0005, 1e-15);
            reference.verlet_step(scene.time_step, 0, step != 1 && step != 4);
            reference.expect_equals(scene, 1e-11);
        }
    });
}

/// Listed pairs that are not within the support: some in a list with a skin, none in a list made without.
template <int Dim>
int pairs_in_the_skin(const NeighbourList<Dim>& list) {
    int count = 0;
    for (int i = 0; i < list.size(); ++i) {
        const auto row = list.row(i);
        for (int k = 0; k < row.count; ++k) {
            double squared = 0;
            for (int d = 0; d < Dim; ++d) {
                squared += row.separation[d][k] * row.separation[d][k];
            }
            count += squared >= list.support_radius() * list.support_radius() ? 1 : 0;
        }
    }
    return count;
}

// Where particles move so far within a step that the list cannot follow them, it is made anew. In 2-D the
// cells are hardly wider than the support, so that a particle left outside the box would miss neighbours.
TEST(CitedAlgorithm, IsCarriedOutWhereTheNeighbourListCannotFollow) {
    in_2d_and_3d([&](auto dimension) {
        constexpr int Dim = dimension;
        constexpr int n = Dim == 2 ? 18 : 8;
        for (const bool far : {false, true}) {
            const Scheme& shifting = schemes::find("isph_dfs");
            Simulation<Dim> scene = general_scene<Dim>(
                shifting,
                {{"pressure_tolerance", "1e-13"}, {"h_over_dx", "1.2"}, {"time_step", far ? "0.1" : "0.002"}},
                n);
            Random random(41);
            for (int d = 0; d < Dim; ++d) {
                for (double& u : scene.particles.velocity.components[d]) {
                    u += random.uniform(-1, 1); // far from free of divergence
                }
            }
            Reference<Dim> reference(scene);
            shifting.assemble(scene);
            advance(scene);
            EXPECT_EQ(pairs_in_the_skin(scene.neighbours) == 0, far);
            projection_step(reference, shifting, scene);
            reference.expect_equals(scene, 1e-9);

            const Scheme& weakly = schemes::find("wcsph");
            Simulation<Dim> sound = general_scene<Dim>(weakly,
                                                       {{"integrator", "predictor_corrector"},
                                                        {"background_pressure", "0"},
                                                        {"c0_over_u", "2"},
                                                        {"h_over_dx", "1.45"},
                                                        {"time_step", far ? "0.12" : "0.002"}},
                                                       n);
            Reference<Dim> pressed(sound);
            pressed.set_tait(2 * 1.5, 7, 0);
            weakly.assemble(sound);
            advance(sound);
            EXPECT_EQ(pairs_in_the_skin(sound.neighbours) == 0, far);
            pressed.predictor_corrector_step(sound.time_step, 0);
            pressed.expect_equals(sound, 1e-10);
        }
    });
}

TEST(TimeStep, FollowsTheLargestAccelerationOfTheStepBefore) {
    for (const std::string integrator : {"explicit", "predictor_corrector", "verlet"}) {
        const Scheme& scheme = schemes::find("wcsph");
        Simulation<2> scene = flowing_scene<2>(
            scheme, {{"integrator", integrator}, {"force_limit", "0.01"}, {"h_over_dx", "1.5"}}, 16, 0.1);
        scheme.assemble(scene);
        Reference<2> start(scene);
        start.rho.assign(scene.particles.find("density")->components[0].begin(),
                         scene.particles.find("density")->components[0].end());
        double largest = 0;
        for (const Vector<2>& a : start.acceleration(start.pairs_at(start.x), 0)) {
            largest = std::max(largest, a.norm());
        }
        advance(scene);
        EXPECT_NEAR(scene.maximum_acceleration, largest, 1e-9 * largest);
        const double left = scene.end_time - scene.time;
        advance(scene);
        EXPECT_NEAR(scene.time_step, even(left, 0.01 * std::sqrt(1.5 / 16 / largest)), 1e-12);
    }
}

} // namespace
} // namespace sphvv::solver
