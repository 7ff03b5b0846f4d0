#pragma once

// Arrangements of particles and small scenes that the tests of the solver share.

#include "sphvv/solver/arrangements.hpp"
#include "sphvv/solver/schemes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <type_traits>
#include <utility>

namespace sphvv::solver::scenes {

using std::numbers::pi;
inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;

template <int Dim>
using Points = std::array<std::vector<double>, Dim>;

/// Uniform numbers that are the same with every standard library.
class Random {
public:
    explicit Random(std::uint64_t seed) : engine(seed) {}
    double uniform(double low, double high) {
        return low + (high - low) * static_cast<double>(engine() >> 11U) * 0x1p-53;
    }
    std::vector<double> values(std::size_t count, double low, double high) {
        std::vector<double> result(count);
        std::generate(result.begin(), result.end(), [&] { return uniform(low, high); });
        return result;
    }

private:
    std::mt19937_64 engine;
};

/// The square (cube) of that side from the origin on.
template <int Dim>
Box<Dim> cube(double side, bool periodic) {
    Box<Dim> box;
    box.low.fill(0);
    box.high.fill(side);
    box.periodic.fill(periodic);
    return box;
}

template <int Dim>
std::array<const double*, Dim> pointers(const Points<Dim>& points) {
    std::array<const double*, Dim> result;
    for (int d = 0; d < Dim; ++d) {
        result[d] = points[d].data();
    }
    return result;
}

template <int Dim>
int size(const Points<Dim>& points) {
    return static_cast<int>(points[0].size());
}

template <int Dim>
void append(Points<Dim>& points, const std::array<double, Dim>& point) {
    for (int d = 0; d < Dim; ++d) {
        points[d].push_back(point[d]);
    }
}

/// Puts points back into the periodic directions of the box.
template <int Dim>
void wrap(const Box<Dim>& box, Points<Dim>& points) {
    for (int d = 0; d < Dim; ++d) {
        for (double& x : points[d]) {
            if (box.periodic[d]) {
                x -= box.length(d) * std::floor((x - box.low[d]) / box.length(d));
                x = x < box.high[d] ? x : box.low[d];
            }
        }
    }
}

/// Particles on a lattice of n to a side of a cube of that side, displaced by up to `disorder` spacings.
template <int Dim>
struct Sample {
    Sample(int n, double disorder, std::uint64_t seed, bool periodic, double side = 1, double h_over_dx = 1.3,
           const Kernel& smoothing = kernels::find("quintic_spline"))
        : box(cube<Dim>(side, periodic)), dx(side / n), h(h_over_dx * dx), kernel(&smoothing),
          points(lattice<Dim>(box, dx)) {
        jitter<Dim>(points, disorder * dx, seed);
        wrap<Dim>(box, points);
        build();
    }

    void build(double skin = 0) { list.build(box, *kernel, h, skin, pointers<Dim>(points), count()); }
    int count() const { return size<Dim>(points); }
    double volume() const { return box.volume() / count(); }

    Box<Dim> box;
    double dx;
    double h;
    const Kernel* kernel;
    Points<Dim> points;
    NeighbourList<Dim> list;
};

/// A pair of particles as the definition has it: from positions and kernel alone.
template <int Dim>
struct Neighbour {
    int j;
    std::array<double, Dim> r;     ///< r_i - r_j
    std::array<double, Dim> gradW; ///< with respect to r_i
    double distance;
    double F; ///< W'(r)/r
};

/// All neighbours of every point within the support, nearest images only: the box must be wider than two
/// supports.
template <int Dim>
std::vector<std::vector<Neighbour<Dim>>> all_neighbours(const Box<Dim>& box, const Points<Dim>& points,
                                                        const Kernel& kernel, double h) {
    const int count = size<Dim>(points);
    std::vector<std::vector<Neighbour<Dim>>> result(count);
    for (int i = 0; i < count; ++i) {
        for (int j = 0; j < count; ++j) {
            Neighbour<Dim> pair{j, {}, {}, 0, 0};
            double squared = 0;
            for (int d = 0; d < Dim; ++d) {
                pair.r[d] = points[d][i] - points[d][j];
                if (box.periodic[d]) {
                    pair.r[d] -= box.length(d) * std::round(pair.r[d] / box.length(d));
                }
                squared += pair.r[d] * pair.r[d];
            }
            pair.distance = std::sqrt(squared);
            if (i == j || pair.distance >= kernel.support * h) {
                continue;
            }
            const double slope =
                kernel.normalisation[Dim] / std::pow(h, Dim + 1) * kernel.derivative(pair.distance / h);
            pair.F = slope / pair.distance;
            for (int d = 0; d < Dim; ++d) {
                pair.gradW[d] = slope * pair.r[d] / pair.distance;
            }
            result[i].push_back(pair);
        }
    }
    return result;
}

/// What multiplies the sum over (rbar/r)^dim n in the shifting vector.
template <int Dim>
inline constexpr double shifting_factor = Dim == 2 ? 1 : 0.216;

/// Velocity and kinematic pressure (density 1, speed scale 1) of a smooth periodic flow in the unit square or
/// cube: Taylor-Green vortices (Xu 2009 §4.1) and an Arnold-Beltrami-Childress flow with p = -|u|^2/2.
inline std::pair<std::array<double, 2>, double> flow_at(const std::array<double, 2>& x) {
    const double kx = 2 * pi * x[0];
    const double ky = 2 * pi * x[1];
    return {{-std::cos(kx) * std::sin(ky), std::sin(kx) * std::cos(ky)},
            -(std::cos(2 * kx) + std::cos(2 * ky)) / 4};
}

inline std::pair<std::array<double, 3>, double> flow_at(const std::array<double, 3>& x) {
    std::array<double, 3> u;
    double squared = 0;
    for (int d = 0; d < 3; ++d) {
        u[d] = (std::sin(2 * pi * x[(d + 2) % 3]) + std::cos(2 * pi * x[(d + 1) % 3])) / std::sqrt(6.);
        squared += u[d] * u[d];
    }
    return {u, (1 - squared) / 2};
}

/// A scene in the unit square (cube) before its scheme is put together: n particles to a side, density 1,
/// speed scale 1, at rest.
template <int Dim>
Simulation<Dim> still_scene(const Scheme& scheme, const Assignments& given, int n, double disorder = 0) {
    const Box<Dim> box = cube<Dim>(1, true);
    Points<Dim> points = lattice<Dim>(box, 1. / n);
    jitter<Dim>(points, disorder / n, 20240611);
    wrap<Dim>(box, points);
    Simulation<Dim> scene(box, points[0].size());
    scene.settings = Settings(scheme.keys, given);
    scene.kernel = &kernels::find(scene.settings.word("kernel"));
    scene.particle_spacing = 1. / n;
    scene.smoothing_length = scene.settings.number("h_over_dx") / n;
    scene.density = 1;
    scene.kinematic_viscosity = 0.01;
    scene.reference_speed = 1;
    scene.particle_mass = std::pow(1. / n, Dim);
    scene.end_time = 1;
    scene.particles.field("pressure", 1, Lifetime::state, "scene");
    for (int d = 0; d < Dim; ++d) {
        scene.particles.position.components[d] = points[d];
    }
    return scene;
}

/// The same with the smooth flow of flow_at().
template <int Dim>
Simulation<Dim> flowing_scene(const Scheme& scheme, const Assignments& given, int n, double disorder = 0) {
    Simulation<Dim> scene = still_scene<Dim>(scheme, given, n, disorder);
    Field& pressure = scene.particles.field("pressure", 1, Lifetime::state, "scene");
    for (std::size_t i = 0; i < scene.particles.size(); ++i) {
        std::array<double, Dim> x;
        for (int d = 0; d < Dim; ++d) {
            x[d] = scene.particles.position[d][i];
        }
        const auto [u, p] = flow_at(x);
        for (int d = 0; d < Dim; ++d) {
            scene.particles.velocity[d][i] = u[d];
        }
        pressure[0][i] = p;
    }
    return scene;
}

/// check(dimension) for both.
template <class Check>
void in_2d_and_3d(const Check& check) {
    {
        SCOPED_TRACE("2-D");
        check(std::integral_constant<int, 2>{});
    }
    {
        SCOPED_TRACE("3-D");
        check(std::integral_constant<int, 3>{});
    }
}

/// The step that even_step() takes.
inline double even(double time, double limit) {
    return time / std::ceil(time / limit);
}

} // namespace sphvv::solver::scenes
