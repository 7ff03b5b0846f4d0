#include "sphvv/verification/linearised_step.hpp"

#include "sphvv/verification/stability.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <cmath>

namespace sphvv::verification {
namespace {

// What the lattice sums cover can be had in both ways. Steps beyond the limits, so that something grows.
TEST(LinearisedStep, AgreesWithTheLatticeSums) {
    struct Row {
        const char* scheme;
        double viscosity;
        double dt;
    };
    const double dx = 1. / 16;
    for (const Row& row :
         {Row{"wcsph:background_pressure=0", 0, 3 * dx / 10},
          Row{"wcsph:background_pressure=5:kernel=cubic_spline", 0, dx / 10},
          Row{"wcsph:background_pressure=0:integrator=predictor_corrector", 0, 2 * dx / 10},
          Row{"wcsph:background_pressure=0:viscosity=monaghan_cleary", 1, 0.5 * dx * dx},
          Row{"wcsph:background_pressure=0:integrator=verlet", 1, 0.2 * dx * dx},
          Row{"isph_df", 1, 2 * dx * dx}, Row{"isph_dfs", 1, 2 * dx * dx}, Row{"isph_lee", 1, 2 * dx * dx}}) {
        const LatticeScene scene{.scheme = row.scheme, .viscosity = row.viscosity};
        const double sums = growth_factor(*lattice_state(scene), stepping_of(scene), row.dt, scene.n);
        EXPECT_GT(sums, 1.01) << row.scheme << ": a neutral step tests nothing";
        EXPECT_NEAR(linearised_growth(scene, row.dt) / sums, 1, 1e-4) << row.scheme;
    }
}

/// The largest eigenvalue of the Jacobian of all velocities, positions and what else a step hands on, by
/// disturbing every particle.
double brute_force(const LatticeScene& scene, double dt) {
    const auto stepped = [&](int field, int component, int particle, double by) {
        solver::Simulation<2> s = lattice_simulation(scene, dt);
        auto& fields = s.particles.fields();
        fields[field].components[component][particle] += by;
        advance(s);
        std::vector<double> values;
        for (const solver::Field& f : fields) {
            for (std::size_t c = 0; f.lifetime == solver::Lifetime::state && c < f.components.size(); ++c) {
                std::vector<double> sorted(s.particles.size());
                for (std::size_t k = 0; k < sorted.size(); ++k) {
                    sorted[s.particles.id[k]] = f.components[c][k];
                }
                values.insert(values.end(), sorted.begin(), sorted.end());
            }
        }
        return Eigen::VectorXd(Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<long>(values.size())));
    };
    const solver::Simulation<2> at_rest = lattice_simulation(scene, dt);
    std::vector<Eigen::VectorXd> columns;
    const double by = 1e-5;
    for (std::size_t f = 0; f < at_rest.particles.fields().size(); ++f) {
        const solver::Field& field = at_rest.particles.fields()[f];
        for (std::size_t c = 0; field.lifetime == solver::Lifetime::state && c < field.components.size();
             ++c) {
            for (int particle = 0; particle < scene.n * scene.n; ++particle) {
                const int which = static_cast<int>(f);
                const int component = static_cast<int>(c);
                columns.emplace_back(
                    (stepped(which, component, particle, by) - stepped(which, component, particle, -by)) /
                    (2 * by));
            }
        }
    }
    Eigen::MatrixXd jacobian(columns.front().size(), static_cast<long>(columns.size()));
    for (std::size_t c = 0; c < columns.size(); ++c) {
        jacobian.col(static_cast<long>(c)) = columns[c];
    }
    return Eigen::EigenSolver<Eigen::MatrixXd>(jacobian, false).eigenvalues().cwiseAbs().maxCoeff();
}

// A scheme that no closed form covers: one particle says as much as all. (The mean velocity, which brute
// force sees too, is kept: its eigenvalue is 1.)
TEST(LinearisedStep, OneParticleStandsForAll) {
    const LatticeScene scene{.scheme = "isph_di:kernel=wendland_c2", .viscosity = 1, .n = 6};
    const double dt = 1.5 * scene.dx() * scene.dx();
    const double growth = linearised_growth(scene, dt);
    EXPECT_GT(growth, 1.01);
    EXPECT_NEAR(growth, brute_force(scene, dt), 1e-4);
}

// The density-invariant step without viscosity, in units of dx and dt, for a wave of which the Poisson
// equation takes the share a of the density error out: x' = x + v - a (x + v)/2, v' = v - a (x + v). The
// product of its eigenvalues is 1 - a/2, that of the relaxed step of isph_asai (x' = x + v', v' = v - a v -
// a alpha x) is 1 - a, so that their products over M(k) say the same a, whatever dt is.
TEST(LinearisedStep, DensityInvarianceKnowsNoTimeStep) {
    for (const double dt : {0.001, 1.}) {
        const LatticeScene invariant{.scheme = "isph_di", .n = 8};
        const auto modes = linearised_step(invariant, dt);
        const auto all = linearised_step({.scheme = "isph_asai:kernel=quintic_spline:h_over_dx=1.3:gradient="
                                                    "normalised",
                                          .n = 8},
                                         dt);
        ASSERT_EQ(modes.size(), all.size());
        double largest = 0;
        for (std::size_t k = 0; k < modes.size(); ++k) {
            const double product =
                std::abs(modes[k].topLeftCorner<4, 4>().determinant()); // position, velocity
            const double a = 2 * (1 - product);
            EXPECT_NEAR(std::abs(all[k].topLeftCorner<4, 4>().determinant()), 1 - a, 5e-3) << k;
            largest = std::max(largest, a);
        }
        EXPECT_GT(largest, 0.5);
        EXPECT_LT(linearised_growth(invariant, dt), 1.0001);
    }
}

// Two half steps of viscosity: (1 - z/2)^2 in place of 1 - z, so twice the step; below the threshold of its
// density invariance nothing else is different from isph_df.
TEST(LinearisedStep, HalfStepsOfViscosityBearTwiceTheStep) {
    const LatticeScene whole{.scheme = "isph_df", .viscosity = 1};
    const LatticeScene halves{.scheme = "isph_dfdi", .viscosity = 1};
    const double dx = whole.dx();
    const double limit = linearised_limit(whole, 0.1 * dx * dx, 10 * dx * dx);
    EXPECT_NEAR(linearised_limit(halves, 0.1 * dx * dx, 10 * dx * dx) / limit, 2, 0.01);
}

// A lattice in uniform motion is the lattice at rest, unless a scheme shifts particles by the speed.
TEST(LinearisedStep, AStreamIsNoticedByShiftsAlone) {
    for (const char* scheme : {"isph_df", "isph_dfs"}) {
        const double rest = linearised_growth({.scheme = scheme}, 1);
        const double stream = linearised_growth({.scheme = scheme, .speed = 1}, 1);
        EXPECT_NEAR(rest, 1, 1e-3) << scheme;
        if (std::string_view(scheme) == "isph_df") {
            EXPECT_NEAR(stream, 1, 1e-3);
        } else {
            EXPECT_GT(stream, 2);
        }
    }
}

} // namespace
} // namespace sphvv::verification
