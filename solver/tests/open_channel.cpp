// Poisson's problem of an open channel (Xu 2009 §6.2: XU-CHAN, XU-CHAN-R), Laplacian phi = y^m, phi(1) = 1,
// phi'(0) = s = -10, periodic in x: phi = (y^{m+2} - 1)/((m+1)(m+2)) + s (y - 1) + 1. Solved for phi - 1,
// which vanishes on the surface; the bed has a row of wall particles and images with phi_f - 2 s y_f.
#include "sphvv/solver/boundaries/shapes/plane.hpp"
#include "sphvv/solver/operators/laplacian_morris.hpp"
#include "sphvv/solver/operators/laplacian_schwaiger.hpp"
#include "sphvv/solver/operators/renormalisation.hpp"
#include "sphvv/solver/projection/projection.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace sphvv::solver {
namespace {

constexpr double slope = -10;

enum class Laplacian { morris, schwaiger };
enum class Surface {
    kept,        ///< the uppermost row stays at y = 1
    at_particle, ///< it is displaced, too, and phi = 1 at the particles
    on_surface   ///< it is displaced, too, and phi = 1 at y = 1
};

struct Channel {
    int rows = 51;
    int m = 0;
    Laplacian laplacian = Laplacian::schwaiger;
    double displacement = 0; ///< in x and y above y = 0.8, over dx
    Surface surface = Surface::kept;
    std::uint64_t seed = 1;
};

double exact(const Channel& c, double y) {
    return (std::pow(y, c.m + 2) - 1) / ((c.m + 1) * (c.m + 2)) + slope * (y - 1) + 1;
}

constexpr int columns = 10;

Simulation<2> particles_of(const Channel& c) {
    const double dx = 1. / (c.rows - 1);
    Box<2> box;
    box.high = {columns * dx, 2};
    box.periodic = {true, false};
    Simulation<2> scene(box, columns * c.rows, columns);
    scene.kernel = &kernels::find("quintic_spline");
    scene.particle_spacing = dx;
    scene.smoothing_length = 1.3 * dx;
    scene.density = 1;
    scene.particle_mass = dx * dx;
    scene.walls = {shapes::plane<2>("bed", {0, 0}, {0, 1}, Slip::free_slip)};
    std::mt19937_64 random(c.seed);
    const auto displaced = [&]() {
        const double uniform = static_cast<double>(random() >> 11U) * 0x1p-53;
        return c.displacement * dx * (2 * uniform - 1);
    };
    // The fluid's rows from the first above the bed to the surface, then the row on the bed.
    for (int i = 0; i < columns * c.rows; ++i) {
        const bool on_bed = i >= columns * (c.rows - 1);
        Vector<2> x((i % columns + 0.5) * dx, on_bed ? 0. : (i / columns + 1) * dx);
        const bool uppermost = i / columns == c.rows - 2;
        if (!on_bed && x[1] > 0.8 + 1e-9 && !(uppermost && c.surface == Surface::kept)) {
            x += Vector<2>(displaced(), displaced());
        }
        for (int d = 0; d < 2; ++d) {
            scene.particles.position[d][i] = x[d];
        }
        if (on_bed) {
            scene.wall_particles.push_back({0, x});
        }
    }
    find_neighbours(scene, 0);
    return scene;
}

/// Largest |phi - exact|/|exact| over the particles.
double error_of(const Channel& c) {
    Simulation<2> scene = particles_of(c);
    PressurePoisson<2>::Options options;
    options.tolerance = 1e-11;
    options.symmetric = c.laplacian == Laplacian::morris;
    PressurePoisson<2> problem(options);
    problem.reset(scene.neighbours, scene.images);
    const UniformVolume volume{scene.particle_mass};
    const double* y = scene.particles.position[1];
    const int count = problem.size();
    for (int i = 0; i < count; ++i) {
        const Row<2> row = scene.neighbours.row(i);
        problem.diagonal(i) = c.laplacian == Laplacian::morris
                                  ? laplacian_morris_weights<2>(row, volume, 0, problem.weights(i))
                                  : laplacian_schwaiger_weights<2>(
                                        row, volume, renormalisation<2>(row, volume), problem.weights(i));
        problem.source(i) = -std::pow(y[i], c.m); // the weights are those of -Laplacian
    }
    FreeSurface surface{nullptr, 0};
    surface.depth.assign(count, 0);
    surface.normal[0].assign(count, 0);
    surface.normal[1].assign(count, 1);
    scene.free_surface = surface;
    for (int i = 0; i < count; ++i) {
        if (scene.particles.id[i] / columns == c.rows - 2) {
            scene.free_surface->depth[i] = 1 - y[i];
            if (c.surface == Surface::on_surface) {
                projection::set_zero_on_surface(scene, problem, i);
            } else {
                problem.fix_at_zero(i);
            }
        }
    }
    problem.set_image_differences(scene.images.differences({0, slope}, 1, scene.particles.position));
    std::vector<double> phi(count);
    EXPECT_TRUE(problem.solve(phi.data()).converged);
    double worst = 0;
    for (int i = 0; i < count; ++i) {
        worst = std::max(worst, std::abs(phi[i] + 1 - exact(c, y[i])) / std::abs(exact(c, y[i])));
    }
    return worst;
}

double mean_over_seeds(Channel c) {
    double total = 0;
    for (c.seed = 1; c.seed <= 5; ++c.seed) {
        total += error_of(c);
    }
    return total / 5;
}

TEST(OpenChannel, HasTheErrorsOfTheSheetOnALattice) {
    const double of_the_sheet[] = {6.96e-5, 6.65e-5, 6.50e-5, 6.30e-5};
    for (int m = 0; m < 4; ++m) {
        EXPECT_NEAR(error_of({.m = m}), of_the_sheet[m], 0.02 * of_the_sheet[m]) << m;
    }
    EXPECT_GT(std::log2(error_of({.rows = 51}) / error_of({.rows = 101})), 1.8);
    EXPECT_NEAR(error_of({.laplacian = Laplacian::morris}), 5.2e-2, 0.1e-2);
    EXPECT_NEAR(error_of({.rows = 101, .laplacian = Laplacian::morris}), 2.8e-2, 0.1e-2);
}

// The sheet's figures for a displaced surface row with phi = 1 at its particles, and for one that is kept;
// the seeds are ours, so means agree to some 40 %.
TEST(OpenChannel, IsAsWrongAsItsSurfaceIsMisplaced) {
    const double tenth = mean_over_seeds({.displacement = 0.1, .surface = Surface::at_particle});
    EXPECT_GT(tenth, 1.0e-2);
    EXPECT_LT(tenth, 2.3e-2);
    const double half = mean_over_seeds({.displacement = 0.5, .surface = Surface::at_particle});
    EXPECT_GT(half, 5e-2);
    EXPECT_LT(half, 12e-2);
    EXPECT_LT(mean_over_seeds({.displacement = 0.1, .surface = Surface::kept}), 5e-4);
    EXPECT_LT(mean_over_seeds({.displacement = 0.5, .surface = Surface::kept}), 5e-4);
}

// XU-CHAN-R decided: what is left when the same displaced particles have phi = 1 on the surface is the
// operators' error, less than a hundredth of it. A linear extrapolation over dx/2 leaves phi''(dx/2)^2/2 =
// 5e-5.
TEST(OpenChannel, NeedsTheConditionOnTheSurfaceAndNotAtTheParticles) {
    for (const double displacement : {0.1, 0.5}) {
        const double at_particle =
            mean_over_seeds({.displacement = displacement, .surface = Surface::at_particle});
        const double on_surface =
            mean_over_seeds({.displacement = displacement, .surface = Surface::on_surface});
        EXPECT_LT(on_surface, at_particle / 50) << displacement;
        EXPECT_LT(on_surface, 1.5e-3) << displacement;
        RecordProperty("on_surface_" + std::to_string(displacement), std::to_string(on_surface));
        std::printf("displaced by %.1f dx: %.2e at the particles, %.2e on the surface\n", displacement,
                    at_particle, on_surface);
    }
}

} // namespace
} // namespace sphvv::solver
