// Each scheme against the algorithm that it cites, carried out with all pairs and dense matrices.
//   solver_cited_algorithms --gtest_filter='*Projection*'
#include "sphvv/solver/tests/reference.hpp"

#include <gtest/gtest.h>

namespace sphvv::solver {
namespace {

using namespace scenes;

TEST(CitedAlgorithm, IsCarriedOutByTheProjectionSchemes) {
    struct Choice {
        const char* scheme;
        Assignments given;
    };
    for (const Choice& choice :
         {Choice{"isph_df", {}}, Choice{"isph_df", {{"gradient", "plain"}, {"eta_over_h", "0.1"}}},
          Choice{"isph_df", {{"laplacian", "schwaiger"}}},
          Choice{"isph_df", {{"laplacian", "schwaiger"}, {"gradient", "plain"}}},
          Choice{"isph_df", {{"preconditioner", "jacobi"}}}, Choice{"isph_dfs", {}},
          Choice{"isph_dfs", {{"shift_correction", "none"}, {"shift_coefficient", "0.1"}}},
          Choice{"isph_dfs", {{"shift_limit", "0.02"}}}}) {
        SCOPED_TRACE(choice.scheme + (choice.given.empty() ? "" : " " + choice.given.begin()->second));
        in_2d_and_3d([&](auto dimension) {
            constexpr int Dim = dimension;
            const Scheme& scheme = schemes::find(choice.scheme);
            Assignments given = choice.given;
            given["pressure_tolerance"] = "1e-13";
            given["kernel"] = "quintic_spline";
            given["h_over_dx"] = "1.2";
            Simulation<Dim> scene = general_scene<Dim>(scheme, given);
            Reference<Dim> reference(scene);
            scheme.assemble(scene);
            for (int step = 0; step < 2; ++step) {
                advance(scene);
                reference.isph_step(scene.time_step, choices(scene));
                reference.expect_equals(scene, 1e-9);
            }
        });
    }
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
            reference.isph_step(scene.time_step, choices(scene));
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
    for (const std::string integrator : {"explicit", "predictor_corrector"}) {
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
