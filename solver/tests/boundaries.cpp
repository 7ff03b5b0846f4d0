// Walls: images of particles, their values, and schemes in scenes with walls.
//   solver_boundaries --gtest_filter='*isph_dfs*'
#include "sphvv/solver/boundaries/shapes/box.hpp"
#include "sphvv/solver/boundaries/shapes/circle.hpp"
#include "sphvv/solver/boundaries/shapes/plane.hpp"
#include "sphvv/solver/linear/pressure_poisson.hpp"
#include "sphvv/solver/operators/laplacian_morris.hpp"
#include "sphvv/solver/operators/symmetric_matrix.hpp"
#include "sphvv/solver/tests/scenes.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <numeric>
#include <set>

namespace sphvv::solver {
namespace {

using namespace scenes;
using shapes::circle;
using shapes::plane;

template <int Dim>
Vector<Dim> unit(int direction) {
    return Vector<Dim>::Unit(direction);
}

template <int Dim>
Vector<Dim> values_at(const Field& field, std::size_t i) {
    Vector<Dim> v;
    for (int d = 0; d < Dim; ++d) {
        v[d] = field.components[d][i];
    }
    return v;
}

template <int Dim>
Particles<Dim> particles_at(const std::vector<Vector<Dim>>& points) {
    Particles<Dim> particles(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (int d = 0; d < Dim; ++d) {
            particles.position[d][i] = points[i][d];
        }
    }
    return particles;
}

/// The faces of the box normal to the given directions.
template <int Dim>
std::vector<Wall<Dim>> faces(const Box<Dim>& box, const std::vector<int>& directions, Slip slip) {
    std::vector<Wall<Dim>> walls;
    for (const int d : directions) {
        walls.push_back(plane<Dim>("low", box.low[d] * unit<Dim>(d), unit<Dim>(d), slip));
        walls.push_back(plane<Dim>("high", box.high[d] * unit<Dim>(d), -unit<Dim>(d), slip));
    }
    return walls;
}

// Where images are.

TEST(Images, AreReflectedInTheWallWithinTheSupport) {
    const std::vector<Wall<2>> walls{plane<2>("bed", {0, 0.5}, {0, 1}, Slip::no_slip)};
    auto particles = particles_at<2>({{0.1, 0.6}, {0.2, 0.81}, {0.3, 0.79}});
    Images<2> images;
    images.mirror(walls, 0.3, {}, particles);
    ASSERT_EQ(images.size(), 2U);
    ASSERT_EQ(particles.with_images(), 5U);
    EXPECT_EQ(particles.size(), 3U);
    EXPECT_NEAR((values_at<2>(particles.position, 3) - Vector<2>(0.1, 0.4)).norm(), 0, 1e-15);
    EXPECT_NEAR((values_at<2>(particles.position, 4) - Vector<2>(0.3, 0.21)).norm(), 0, 1e-15);
    EXPECT_EQ(images.particle(0), 0);
    EXPECT_EQ(images.particle(1), 2);
    particles.permute(std::vector<int>{2, 0, 1});
    EXPECT_EQ(particles.with_images(), 3U) << "images of another order";
}

TEST(Images, OfImagesFillCorners) {
    const auto walls = faces<3>(cube<3>(1, false), {0, 1, 2}, Slip::free_slip);
    auto particles = particles_at<3>({{0.1, 0.2, 0.3}});
    Images<3> images;
    images.mirror(walls, 0.4, {}, particles);
    ASSERT_EQ(images.size(), 7U);
    Field& velocity = particles.velocity;
    for (int d = 0; d < 3; ++d) {
        velocity[d][0] = d + 1;
    }
    images.fill(velocity, Parity::velocity);
    for (std::size_t k = 1; k <= 7; ++k) {
        EXPECT_EQ(images.particle(k - 1), 0);
        for (int d = 0; d < 3; ++d) {
            const bool reflected = particles.position[d][k] < 0;
            EXPECT_NEAR(particles.position[d][k], (reflected ? -0.1 : 0.1) * (d + 1), 1e-15);
            EXPECT_EQ(velocity[d][k], (reflected ? -1 : 1) * (d + 1));
        }
    }
}

TEST(Images, InACircleLieOnTheSameRay) {
    for (const auto side : {shapes::Side::inside, shapes::Side::outside}) {
        const Vector<2> centre(0.3, -0.2);
        const Wall<2> wall = circle("cylinder", centre, 1, side, Slip::no_slip, 2.5);
        const double r = side == shapes::Side::inside ? 0.9 : 1.1;
        const Vector<2> ray(std::cos(0.7), std::sin(0.7));
        auto particles = particles_at<2>({centre + r * ray, centre + (2 * r - 1) * ray});
        EXPECT_NEAR(wall.distance(centre + r * ray), 0.1, 1e-15);
        Images<2> images;
        images.mirror({&wall, 1}, 0.15, {}, particles);
        ASSERT_EQ(images.size(), 1U);
        EXPECT_NEAR((values_at<2>(particles.position, 2) - centre - (2 - r) * ray).norm(), 0, 1e-15);
        // Solid rotation with the wall: the velocity of the image makes it that of the wall at the wall.
        const Vector<2> across(-ray[1], ray[0]);
        for (int d = 0; d < 2; ++d) {
            particles.velocity[d][0] = 2.5 * r * across[d];
        }
        images.fill(particles.velocity, Parity::velocity);
        EXPECT_NEAR((values_at<2>(particles.velocity, 2) - 2.5 * (2 - r) * across).norm(), 0, 1e-14);
    }
}

// Corners of dummy walls (Lee 2008 §1.3): every place behind the walls has one particle.

constexpr double corner_dx = 0.1;

/// The fluid in a closed box of 10 spacings, or around a square of 10 in a periodic box of 30, with a row of
/// wall particles on the wall, and the lattice of which they are all part from `first` on.
struct CornerScene {
    Box<2> box;
    std::vector<Wall<2>> walls;
    std::vector<WallParticle<2>> wall_particles;
    std::vector<Vector<2>> points; // fluid first
};

CornerScene corner_scene(bool convex) {
    CornerScene scene;
    const int cells = convex ? 30 : 10;
    scene.box = cube<2>(cells * corner_dx, convex);
    Box<2> body;
    body.low = {10 * corner_dx, 10 * corner_dx};
    body.high = {20 * corner_dx, 20 * corner_dx};
    scene.walls = convex ? std::vector<Wall<2>>{shapes::box<2>("square", body, Slip::no_slip)}
                         : faces<2>(scene.box, {0, 1}, Slip::no_slip);
    for (int j = 0; j < cells + (convex ? 0 : 1); ++j) {
        for (int i = 0; i < cells + (convex ? 0 : 1); ++i) {
            const Vector<2> x(i * corner_dx, j * corner_dx);
            double nearest = infinity;
            int wall = 0;
            for (int k = 0; k < static_cast<int>(scene.walls.size()); ++k) {
                const double d = scene.walls[k].distance(x);
                wall = d < nearest - 1e-9 ? k : wall;
                nearest = std::min(nearest, d);
            }
            if (nearest > 1e-9) {
                scene.points.push_back(x);
            } else if (nearest > -1e-9) {
                scene.wall_particles.push_back({wall, x});
            }
        }
    }
    for (const WallParticle<2>& particle : scene.wall_particles) {
        scene.points.push_back(particle.position);
    }
    return scene;
}

void place(const CornerScene& scene, Particles<2>& particles) {
    for (std::size_t i = 0; i < scene.points.size(); ++i) {
        for (int d = 0; d < 2; ++d) {
            particles.position[d][i] = scene.points[i][d];
        }
    }
}

class Corners : public testing::TestWithParam<bool> {
protected:
    static constexpr double radius = 3.9 * corner_dx;
    CornerScene scene = corner_scene(GetParam());
    Particles<2> particles{scene.points.size(), scene.wall_particles.size()};
    Images<2> images;

    void SetUp() override {
        place(scene, particles);
        images.stack(scene.walls, scene.wall_particles, corner_dx, radius, {}, particles);
    }
    Vector<2> position(std::size_t i) const { return values_at<2>(particles.position, i); }
    std::size_t at(double x, double y) const {
        for (std::size_t i = 0; i < particles.with_images(); ++i) {
            if ((position(i) - corner_dx * Vector<2>(x, y)).norm() < 1e-9) {
                return i;
            }
        }
        ADD_FAILURE() << "nothing at (" << x << ", " << y << ") dx";
        return 0;
    }
};

INSTANTIATE_TEST_SUITE_P(All, Corners, testing::Values(false, true),
                         [](const auto& test) { return test.param ? "OfASquareInTheFluid" : "OfACavity"; });

TEST_P(Corners, HaveOneParticleAtEveryPlaceWithinASupport) {
    std::set<std::pair<long, long>> taken;
    for (std::size_t i = 0; i < particles.with_images(); ++i) {
        const Vector<2> x = position(i) / corner_dx;
        const std::pair place{std::lround(x[0]), std::lround(x[1])};
        EXPECT_NEAR((x - Vector<2>(place.first, place.second)).norm(), 0, 1e-9) << "off the lattice";
        EXPECT_TRUE(taken.insert(place).second) << "two at " << x.transpose();
    }
    const long end = GetParam() ? 0 : 3;
    const long cells = std::lround(scene.box.length(0) / corner_dx);
    for (long j = -end; j < cells + end; ++j) {
        for (long i = -end; i < cells + end; ++i) {
            // Of the square, as much as layers reach.
            const double depth = GetParam() ? -scene.walls[0].distance(corner_dx * Vector<2>(i, j)) : 0;
            if (depth < radius - 1e-9) {
                EXPECT_TRUE(taken.contains({i, j})) << i << ", " << j;
            }
        }
    }
}

TEST_P(Corners, CarryWhatTheirWallParticlesHave) {
    Field& p = particles.field("p", 1, Lifetime::scratch, "test");
    Random random(3);
    for (std::size_t i = 0; i < particles.size(); ++i) {
        p[0][i] = random.uniform(-1, 1);
        particles.velocity[0][i] = random.uniform(-1, 1);
    }
    images.fill(p, Parity::even);
    images.fill(particles.velocity, Parity::velocity);
    std::vector<double> even(particles.with_images());
    std::copy_n(p[0], particles.size(), even.begin());
    images.fill(even.data(), static_cast<int>(particles.size()));
    const auto expect = [&](std::size_t image, const std::vector<std::size_t>& of) {
        for (const auto& values : {p.components[0], particles.velocity.components[0], even}) {
            double mean = 0;
            for (const std::size_t i : of) {
                mean += values[i] / static_cast<double>(of.size());
            }
            EXPECT_NEAR(values[image], mean, 1e-14);
        }
    };
    if (GetParam()) {
        for (int a = 1; a <= 3; ++a) {
            const double low = 10 + a;
            // The four beside (a, a) belong to the particles a and a + 1 of either face.
            expect(at(low, low), {at(low, 10), at(low + 1, 10), at(10, low), at(10, low + 1)});
            expect(at(low + 1, low), {at(low + 1, 10)});
            expect(at(low, low + 1), {at(10, low + 1)});
            const double high = 20 - a;
            expect(at(high, low), {at(high, 10), at(high - 1, 10), at(20, low), at(20, low + 1)});
        }
    } else {
        for (int a = 0; a <= 3; ++a) {
            for (int b = a == 0 ? 1 : 0; b <= 3; ++b) {
                expect(at(-a, -b), {at(0, 0)});
                expect(at(10 + a, -b), {at(10, 0)});
                expect(at(10 + a, 10 + b), {at(10, 10)});
            }
        }
        expect(at(4, -2), {at(4, 0)});
    }
}

// Water at rest: the pressure beyond a corner goes on as that of its neighbours does.
TEST_P(Corners, HoldTheFluidUp) {
    const Vector<2> f(0.3, -2);
    const std::vector<double> difference = images.differences(f, 1000, particles.position);
    for (std::size_t k = 0; k < images.size(); ++k) {
        const Vector<2> x = position(particles.size() + k);
        const std::size_t of = images.particle(k);
        const bool shared = GetParam() && std::abs(std::abs(x[0] - 1.5) - std::abs(x[1] - 1.5)) < 1e-9;
        if (!shared) {
            EXPECT_NEAR(difference[k], 1000 * f.dot(x - position(of)), 1e-9) << x.transpose();
        }
    }
    if (GetParam()) {
        // The mean over the four of rho f.(way from the wall particle): a - 1 and a in depth from either
        // face.
        const double expected = 1000 * corner_dx * (f[0] + f[1]) * (1 + 0) / 4;
        EXPECT_NEAR(difference[at(11, 11) - particles.size()], expected, 1e-9);
    }
}

// Next to the corners, too, the kernel's sum over a lattice is that of the bulk, and a closed box leaves
// constant pressures in the null space of the Laplacian.
TEST_P(Corners, CompleteTheSupports) {
    Simulation<2> sim(scene.box, scene.points.size(), scene.wall_particles.size());
    place(scene, sim.particles);
    sim.kernel = &kernels::find("quintic_spline");
    sim.particle_spacing = corner_dx;
    sim.smoothing_length = 1.3 * corner_dx;
    sim.walls = scene.walls;
    sim.wall_particles = scene.wall_particles;
    sim.wall_method = WallMethod::dummy;
    find_neighbours(sim, 0);
    for (int i = 0; i < sim.neighbours.size(); ++i) {
        EXPECT_EQ(sim.neighbours.row(i).count, 44) << "a disc of 3.9 dx holds 45 places of a square lattice";
    }
    EXPECT_GT(sim.neighbours.minimum_distance(), 0.99 * corner_dx);
    PressurePoisson<2> problem({.symmetric = false});
    problem.reset(sim.neighbours, sim.images);
    for (int i = 0; i < problem.size(); ++i) {
        problem.diagonal(i) = laplacian_morris_weights<2>(
            sim.neighbours.row(i), UniformVolume{corner_dx * corner_dx}, 0, problem.weights(i));
    }
    Random random(5);
    std::vector<double> x = random.values(problem.size(), -1, 1);
    std::vector<double> y(problem.size());
    problem.fix_at_zero(0); // so that no mean is taken off the product
    problem.multiply(x.data(), y.data());
    std::vector<double> all = x;
    all.resize(sim.particles.with_images());
    sim.images.fill(all.data(), problem.size());
    for (int i = 1; i < problem.size(); ++i) {
        const auto row = sim.neighbours.row(i);
        double expected = 0;
        double sum_of_row = problem.diagonal(i);
        for (int k = 0; k < row.count; ++k) {
            expected += problem.weights(i)[k] * (x[i] - all[row.index[k]]);
            sum_of_row -= problem.weights(i)[k];
        }
        EXPECT_NEAR(y[i], expected, 1e-9 * problem.diagonal(i));
        EXPECT_NEAR(sum_of_row, 0, 1e-9 * problem.diagonal(i));
    }
}

// What images carry.

class Values : public testing::Test {
protected:
    void SetUp() override {
        normal = Vector<3>(0.2, -0.5, 0.7).normalized();
        speed = Vector<3>(0.3, 0.4, -0.1);
        speed -= speed.dot(normal) * normal;
    }
    /// The value that the image of a particle with this value has.
    template <int Components>
    Vector<Components> image_of(const Vector<Components>& value, Parity parity, Slip slip) {
        const std::vector<Wall<3>> walls{plane<3>("wall", Vector<3>::Zero(), normal, slip, Vector<3>(speed))};
        auto particles = particles_at<3>({0.1 * normal});
        Images<3> images;
        images.mirror(walls, 0.2, {}, particles);
        Field& field = particles.field("value", Components, Lifetime::scratch, "test");
        for (int c = 0; c < Components; ++c) {
            field[c][0] = value[c];
        }
        images.fill(field, parity);
        return values_at<Components>(field, 1);
    }
    Vector<3> normal;
    Vector<3> speed;
};

TEST_F(Values, EvenQuantitiesAreCopied) {
    EXPECT_EQ(image_of<1>(Vector<1>(3.5), Parity::even, Slip::no_slip)[0], 3.5);
}

TEST_F(Values, TheMeanOfVelocitiesAcrossAWallIsTheWalls) {
    const Vector<3> u(1, 2, 3);
    const Vector<3> sticking = (u + image_of<3>(u, Parity::velocity, Slip::no_slip)) / 2;
    EXPECT_NEAR((sticking - speed).norm(), 0, 1e-15);
    const Vector<3> sliding = (u + image_of<3>(u, Parity::velocity, Slip::free_slip)) / 2;
    EXPECT_NEAR(sliding.dot(normal), speed.dot(normal), 1e-15) << "fluid goes through the wall";
    EXPECT_NEAR((sliding - (u - u.dot(normal) * normal)).norm(), 0, 1e-15) << "the wall drags";
}

TEST_F(Values, DisplacementsAndTensorsAreReflected) {
    const Vector<3> d(1, 2, 3);
    const Vector<3> image = image_of<3>(d, Parity::displacement, Slip::no_slip);
    EXPECT_NEAR(image.dot(normal), -d.dot(normal), 1e-15);
    EXPECT_NEAR((image + image.dot(-normal) * normal - d + d.dot(normal) * normal).norm(), 0, 1e-15);
    // T = d d^T has the image of the vector d as its own.
    Vector<6> stored;
    Vector<6> expected;
    for (int a = 0; a < 3; ++a) {
        for (int b = a; b < 3; ++b) {
            stored[symmetric_component<3>(a, b)] = d[a] * d[b];
            expected[symmetric_component<3>(a, b)] = image[a] * image[b];
        }
    }
    EXPECT_NEAR((image_of<6>(stored, Parity::tensor, Slip::no_slip) - expected).norm(), 0, 1e-14);
}

// A wall method alone: the Poisson problem of Xu 2009 §3.5 (XU-WALL), P'' = 1, P(0) = 0, P'(1) = 0, P = y^2/2
// - y, with the Morris Laplacian on rows dx apart, the last of them on the wall.

/// Largest error over that of the solution, 1/2, for so many rows and ratio eta/h.
double wall_poisson_error(WallMethod method, int rows, double eta_over_h) {
    constexpr int columns = 12;
    const double dx = 1. / (rows - 1);
    Box<2> box;
    box.high = {columns * dx, 1};
    box.periodic = {true, false};
    Simulation<2> scene(box, columns * rows, columns);
    scene.kernel = &kernels::find("quintic_spline");
    scene.particle_spacing = dx;
    scene.smoothing_length = 1.3 * dx;
    scene.walls = {plane<2>("wall", {0, 1}, {0, -1}, Slip::no_slip)};
    scene.wall_method = method;
    for (int i = 0; i < columns * rows; ++i) {
        const Vector<2> x((i % columns + 0.5) * dx, i / columns == rows - 1 ? 1. : i / columns * dx);
        for (int d = 0; d < 2; ++d) {
            scene.particles.position[d][i] = x[d];
        }
        if (i / columns == rows - 1) {
            scene.wall_particles.push_back({0, x});
        }
    }
    find_neighbours(scene, 0);
    PressurePoisson<2>::Options options;
    options.tolerance = 1e-10;
    PressurePoisson<2> problem(options);
    problem.reset(scene.neighbours, scene.images);
    const UniformVolume volume{dx * dx};
    const double eta = eta_over_h * scene.smoothing_length;
    const double* y = scene.particles.position[1];
    for (int i = 0; i < problem.size(); ++i) {
        problem.diagonal(i) =
            laplacian_morris_weights<2>(scene.neighbours.row(i), volume, eta * eta, problem.weights(i));
        problem.source(i) = -1; // the weights are those of -Laplacian
        if (y[i] < dx / 2) {
            problem.fix_at_zero(i);
        }
    }
    std::vector<double> p(problem.size());
    EXPECT_TRUE(problem.solve(p.data()).converged);
    double worst = 0;
    for (int i = 0; i < problem.size(); ++i) {
        worst = std::max(worst, std::abs(p[i] - (y[i] * y[i] / 2 - y[i])));
    }
    return worst / 0.5;
}

TEST(WallPoisson, HasTheErrorsOfTheSheet) {
    EXPECT_NEAR(wall_poisson_error(WallMethod::mirror, 41, 0), 1.7e-2, 0.05e-2);
    EXPECT_NEAR(wall_poisson_error(WallMethod::dummy, 41, 0), 4.7e-2, 0.05e-2);
    EXPECT_NEAR(wall_poisson_error(WallMethod::mirror, 41, 0.1), 2.3e-2, 0.05e-2);
    EXPECT_NEAR(wall_poisson_error(WallMethod::dummy, 41, 0.1), 5.5e-2, 0.05e-2);
}

// Schemes between walls.

class BetweenWalls : public testing::TestWithParam<const Scheme*> {
protected:
    const Scheme& scheme = *GetParam();

    bool has_key(std::string_view key) const {
        return std::ranges::any_of(scheme.keys, [&](const Key& k) { return k.name == key; });
    }
    /// Settings under which a scheme knows no difference between a particle and another.
    Assignments alike() const {
        Assignments given{{"time_step", "0.002"}};
        if (has_key("pressure_tolerance")) {
            given["pressure_tolerance"] = "1e-13";
        }
        if (has_key("shift_disorder")) {
            given["shift_disorder"] = "0";
        }
        return given;
    }
};

INSTANTIATE_TEST_SUITE_P(All, BetweenWalls, testing::ValuesIn(schemes::all().begin(), schemes::all().end()),
                         [](const auto& test) { return std::string(test.param->name); });

/// Taylor-Green vortices in the unit square.
void set_vortices(Simulation<2>& scene) {
    Field& pressure = scene.particles.field("pressure", 1, Lifetime::state, "scene");
    for (std::size_t i = 0; i < scene.particles.size(); ++i) {
        const auto [u, p] =
            flow_at(std::array{scene.particles.position[0][i], scene.particles.position[1][i]});
        scene.particles.velocity[0][i] = u[0];
        scene.particles.velocity[1][i] = u[1];
        pressure[0][i] = p;
    }
}

/// Values of a field by identity.
template <int Components>
std::vector<Vector<Components>> by_identity(const std::vector<int>& id, const Field& field) {
    std::vector<Vector<Components>> values(id.size());
    for (std::size_t k = 0; k < id.size(); ++k) {
        values[id[k]] = values_at<Components>(field, k);
    }
    return values;
}

// The lines x, y = 1/4, 3/4 are planes of symmetry of the vortices, and of a lattice that has none of its
// particles on them: a quarter of the square between walls with free slip is a quarter of the whole.
TEST_P(BetweenWalls, FreeSlipIsSymmetry) {
    constexpr int n = 16;
    constexpr int m = n / 2;
    auto whole = still_scene<2>(scheme, alike(), n);
    set_vortices(whole);
    scheme.assemble(whole);

    Box<2> box;
    box.low.fill(0.25);
    box.high.fill(0.75);
    Simulation<2> quarter(box, m * m);
    quarter.settings = whole.settings;
    quarter.kernel = whole.kernel;
    quarter.particle_spacing = whole.particle_spacing;
    quarter.smoothing_length = whole.smoothing_length;
    quarter.density = whole.density;
    quarter.kinematic_viscosity = whole.kinematic_viscosity;
    quarter.reference_speed = whole.reference_speed;
    quarter.particle_mass = whole.particle_mass;
    quarter.end_time = whole.end_time;
    quarter.walls = faces<2>(box, {0, 1}, Slip::free_slip);
    const auto points = lattice<2>(box, 1. / n);
    for (int d = 0; d < 2; ++d) {
        quarter.particles.position.components[d] = points[d];
    }
    set_vortices(quarter);
    scheme.assemble(quarter);

    for (int step = 0; step < 5; ++step) {
        advance(whole);
        advance(quarter);
    }
    const auto x_whole = by_identity<2>(whole.particles.id, whole.particles.position);
    const auto u_whole = by_identity<2>(whole.particles.id, whole.particles.velocity);
    const auto p_whole = by_identity<1>(whole.particles.id, *whole.particles.find("pressure"));
    const auto x = by_identity<2>(quarter.particles.id, quarter.particles.position);
    const auto u = by_identity<2>(quarter.particles.id, quarter.particles.velocity);
    const auto p = by_identity<1>(quarter.particles.id, *quarter.particles.find("pressure"));
    double moved = 0;
    for (int row = 0; row < m; ++row) {
        for (int column = 0; column < m; ++column) {
            const int k = row * m + column;
            const int of = (row + n / 4) * n + column + n / 4;
            EXPECT_NEAR((x[k] - x_whole[of]).norm(), 0, 1e-10) << k;
            EXPECT_NEAR((u[k] - u_whole[of]).norm(), 0, 1e-9) << k;
            EXPECT_NEAR(p[k][0], p_whole[of][0], 1e-7) << k;
            moved = std::max(moved, std::abs(x[k][0] - points[0][k]));
        }
    }
    EXPECT_GT(moved, 1e-3);
}

/// A channel of height 1 between no-slip walls, the upper one moving with `speed`, with u = U(y).
template <class Profile>
Simulation<2> channel(const Scheme& scheme, const Assignments& given, int n, double speed,
                      const Profile& profile) {
    Simulation<2> scene = still_scene<2>(scheme, given, n);
    scene.box.periodic[1] = false;
    scene.walls = {plane<2>("bed", {0, 0}, {0, 1}, Slip::no_slip),
                   plane<2>("lid", {0, 1}, {0, -1}, Slip::no_slip, {speed, 0})};
    for (std::size_t i = 0; i < scene.particles.size(); ++i) {
        scene.particles.velocity[0][i] = profile(scene.particles.position[1][i]);
    }
    scheme.assemble(scene);
    return scene;
}

// Every operator of every scheme is exact for u = y on rows that slide along each other, or sums it to zero
// by symmetry; images continue it through the walls.
TEST_P(BetweenWalls, CouetteFlowIsSteadyOnALattice) {
    auto scene = channel(scheme, alike(), 12, 1, [](double y) { return y; });
    for (int step = 0; step < 5; ++step) {
        advance(scene);
    }
    for (std::size_t i = 0; i < scene.particles.size(); ++i) {
        EXPECT_NEAR(scene.particles.velocity[0][i], scene.particles.position[1][i], 2e-3) << i;
        EXPECT_NEAR(scene.particles.velocity[1][i], 0, 2e-3) << i;
    }
}

/// The same with a row of wall particles on each wall, and fluid particles on rows dx apart between them.
template <class Profile>
Simulation<2> channel_with_rows(const Scheme& scheme, const Assignments& given, int n, double speed,
                                WallMethod method, const Profile& profile) {
    const auto still = still_scene<2>(scheme, given, n);
    const std::size_t fluid = n * (n - 1);
    Simulation<2> scene(still.box, fluid + 2 * n, 2 * n);
    scene.settings = still.settings;
    scene.kernel = still.kernel;
    scene.particle_spacing = still.particle_spacing;
    scene.smoothing_length = still.smoothing_length;
    scene.density = still.density;
    scene.kinematic_viscosity = still.kinematic_viscosity;
    scene.reference_speed = still.reference_speed;
    scene.particle_mass = still.particle_mass;
    scene.end_time = still.end_time;
    scene.box.periodic[1] = false;
    scene.walls = {plane<2>("bed", {0, 0}, {0, 1}, Slip::no_slip),
                   plane<2>("lid", {0, 1}, {0, -1}, Slip::no_slip, {speed, 0})};
    scene.wall_method = method;
    scene.particles.field("pressure", 1, Lifetime::state, "scene");
    for (int i = 0; i < n * (n + 1); ++i) {
        const bool bed = i >= n * (n - 1) && i < n * n;
        const bool lid = i >= n * n;
        const Vector<2> x((i % n + 0.5) / n, bed ? 0. : lid ? 1. : (i / n + 1.) / n);
        if (bed || lid) {
            scene.wall_particles.push_back({lid ? 1 : 0, x});
        }
        for (int d = 0; d < 2; ++d) {
            scene.particles.position[d][i] = x[d];
        }
        scene.particles.velocity[0][i] = profile(x[1]);
    }
    scheme.assemble(scene);
    return scene;
}

// A linear profile is continued through the wall by mirrored particles. Dummy particles carry the velocity of
// the wall: the profile has a kink there, which drags at the rows whose support reaches beyond the wall.
TEST_P(BetweenWalls, WallParticlesStayAndDrag) {
    for (const WallMethod method : {WallMethod::mirror, WallMethod::dummy}) {
        auto scene = channel_with_rows(scheme, alike(), 16, 1, method, [](double y) { return y; });
        for (int step = 0; step < 5; ++step) {
            advance(scene);
        }
        const double tolerance = method == WallMethod::mirror ? 2e-3 : 2e-2;
        const auto x = by_identity<2>(scene.particles.id, scene.particles.position);
        const auto u = by_identity<2>(scene.particles.id, scene.particles.velocity);
        for (std::size_t k = 0; k < x.size(); ++k) {
            EXPECT_NEAR(u[k][0], x[k][1], tolerance) << k;
            EXPECT_NEAR(u[k][1], 0, tolerance) << k;
            if (k >= scene.particles.fluid_size()) {
                EXPECT_EQ(x[k], scene.wall_particles[k - scene.particles.fluid_size()].position);
            }
        }
        EXPECT_NEAR(kinetic_energy(scene), 0.5 * 240 / 256. / 3, 0.02) << "of the fluid alone";
    }
}

// A channel whose walls carry it along their normals at a constant speed is one at rest to an observer who
// goes with them: nothing happens in it.
TEST_P(BetweenWalls, AChannelThatIsCarriedAlongStaysAsItIs) {
    std::vector<Assignments> variants{alike()};
    for (const Key& key : scheme.keys) {
        for (std::size_t k = 1; key.name == "integrator" && k < key.choices.size(); ++k) {
            variants.push_back(alike());
            variants.back()["integrator"] = key.choices[k];
        }
    }
    constexpr double speed = 2; // 0.06 dx a step
    for (const Assignments& given : variants) {
        for (const WallMethod method : {WallMethod::mirror, WallMethod::dummy}) {
            auto scene = channel_with_rows(scheme, given, 16, 0, method, [](double /*y*/) { return 0.; });
            scene.box.low[1] = -0.5;
            scene.box.high[1] = 1.5;
            for (Wall<2>& wall : scene.walls) {
                wall.velocity = [=](const Vector<2>& /*x*/, double /*t*/) { return Vector<2>(0, speed); };
                wall.displacement = [=](double t) { return Vector<2>(0, speed * t); };
            }
            std::ranges::fill(scene.particles.velocity.components[1], speed);
            for (int step = 0; step < 4; ++step) {
                advance(scene);
            }
            EXPECT_EQ(scene.time, 4 * 0.002);
            const auto x = by_identity<2>(scene.particles.id, scene.particles.position);
            for (std::size_t k = 0; k < x.size(); ++k) {
                const std::size_t row = k / 16; // of the fluid, then those on the walls
                const double start = row < 15 ? (static_cast<double>(row) + 1) / 16 : row == 15 ? 0 : 1;
                EXPECT_NEAR(x[k][1], start + speed * scene.time, 1e-10) << k;
                EXPECT_NEAR(scene.particles.velocity[0][k], 0, 1e-9) << k;
                EXPECT_NEAR(scene.particles.velocity[1][k], speed, 1e-9) << k;
            }
        }
    }
}

// Fluid at rest and a uniform body force along walls that do not hold it back: the first step gives all of
// it.
TEST_P(BetweenWalls, ABodyForceAcceleratesTheFluid) {
    auto scene = channel(scheme, alike(), 12, 0, [](double /*y*/) { return 0.; });
    for (Wall<2>& wall : scene.walls) {
        wall.slip = Slip::free_slip;
    }
    scene.body_force = {0.5, 0};
    advance(scene);
    for (std::size_t i = 0; i < scene.particles.size(); ++i) {
        EXPECT_NEAR(scene.particles.velocity[0][i], 0.5 * scene.time_step, 1e-6 * scene.time_step) << i;
    }
}

// Water at rest above a bed: one projection finds the hydrostatic pressure, zero at the uppermost row, and
// nothing moves. With the Schwaiger Laplacian, which is right at the truncated supports of a surface (Xu 2009
// §6.2).
TEST_P(BetweenWalls, StillWaterStaysStill) {
    if (!has_key("gradient") || scheme.name == "isph_di" || scheme.name == "isph_dfdi") {
        GTEST_SKIP()
            << "a density summed at a surface is no measure of compression, nor has every scheme a surface";
    }
    constexpr int n = 16;
    constexpr double g = 10;
    Assignments given = alike();
    given["laplacian"] = "schwaiger";
    given["gradient"] = "normalised";
    if (has_key("relaxation")) {
        given["relaxation"] = "0";
    }
    auto scene = still_scene<2>(scheme, given, n);
    scene.box.periodic[1] = false;
    scene.box.high[1] = 1.5;
    scene.walls = {plane<2>("bed", {0, 0}, {0, 1}, Slip::free_slip)};
    const Detector& detector = free_surface::find("covered_ball");
    scene.free_surface = FreeSurface{&detector, detector.threshold(2, 3.9)};
    scene.body_force = {0, -g};
    scheme.assemble(scene);
    for (int step = 0; step < 5; ++step) {
        advance(scene);
        int at_surface = 0;
        const double* y = scene.particles.position[1];
        const double* p = (*scene.particles.find("pressure"))[0];
        for (std::size_t i = 0; i < scene.particles.size(); ++i) {
            at_surface += scene.free_surface->at_surface[i];
            EXPECT_EQ(scene.free_surface->at_surface[i] != 0, y[i] > 1 - 0.75 / n) << y[i];
            EXPECT_NEAR(p[i], g * (1 - 0.5 / n - y[i]), 0.01 * g) << y[i];
        }
        EXPECT_EQ(at_surface, n);
        EXPECT_LT(maximum_speed(scene), 0.02 * g * scene.time);
    }
}

// A compressible column: beyond the bed the images go on with the pressure of the column and with the density
// that belongs to it. Then the lowest row of a column in its exact state is held up to O(h^2), as every other
// row is; with the density of its particle it would be off by the compression over a kernel support.
TEST(AColumn, GoesOnBeyondTheBed) {
    const Scheme& wcsph = schemes::find("wcsph");
    constexpr int n = 16;
    constexpr double g = 10;
    auto scene = still_scene<2>(
        wcsph, {{"kernel", "quintic_spline"}, {"gamma", "1"}, {"pressure_force", "taylor"}}, n);
    scene.kinematic_viscosity = 0;
    scene.box.periodic[1] = false;
    scene.box.high[1] = 1.5;
    scene.walls = {plane<2>("bed", {0, 0}, {0, 1}, Slip::free_slip)};
    const Detector& detector = free_surface::find("covered_ball");
    scene.free_surface = FreeSurface{&detector, detector.threshold(2, 3.9)};
    scene.body_force = {0, -g};
    Field& pressure = scene.particles.field("pressure", 1, Lifetime::state, "scene");
    const double c0 = 10; // c0_over_u times the speed scale of the scene
    for (std::size_t i = 0; i < scene.particles.size(); ++i) {
        pressure[0][i] = c0 * c0 * std::expm1(g * (1 - scene.particles.position[1][i]) / (c0 * c0));
    }
    wcsph.assemble(scene);
    advance(scene);
    const double* rho = (*scene.particles.find("specific_volume"))[0];
    for (std::size_t k = scene.particles.size(); k < scene.particles.with_images(); ++k) {
        const double exact = std::exp(g * (1 - scene.particles.position[1][k]) / (c0 * c0));
        EXPECT_NEAR(1 / rho[k], exact, 1e-12);
    }
    const double* y = scene.particles.position[1];
    const double* a = (*scene.particles.find("acceleration"))[1];
    for (std::size_t i = 0; i < scene.particles.size(); ++i) {
        if (y[i] < 0.7) {
            EXPECT_NEAR(a[i], 0, 2e-3 * g) << y[i];
        }
    }
}

// Whatever a sweep reads at images was put there since they were made: what else they hold may be anything.
TEST_P(BetweenWalls, NoStageReadsAnImageThatWasNotFilled) {
    const auto run = [&](bool poisoned) {
        auto scene = channel(scheme, alike(), 12, 1, [](double y) { return y * y; });
        for (int step = 0; step < 3; ++step) {
            for (auto& stage : scene.stages) {
                stage.run(scene);
                if (poisoned) {
                    for (Field& field : scene.particles.fields()) {
                        for (auto& component : field.components) {
                            const bool place = field.name == "position";
                            std::fill(component.begin() + static_cast<std::ptrdiff_t>(
                                                              place ? component.size() : field.particles),
                                      component.end(), not_a_number);
                        }
                    }
                }
            }
            scene.time += scene.time_step;
            ++scene.step;
        }
        return scene;
    };
    const auto sound = run(false);
    const auto poisoned = run(true);
    EXPECT_FALSE(sound.images.empty());
    for (const auto& field : sound.particles.fields()) {
        const Field& other = *poisoned.particles.find(field.name);
        for (std::size_t c = 0; c < field.components.size(); ++c) {
            for (std::size_t i = 0; i < field.particles; ++i) {
                ASSERT_EQ(field.components[c][i], other.components[c][i]) << field.name << ' ' << i;
            }
        }
    }
}

} // namespace
} // namespace sphvv::solver
