// The same flow in a box 1000 times longer than high, far from the origin, and on a lattice that is turned.
#include "sphvv/solver/boundaries/shapes/plane.hpp"
#include "sphvv/verification/extreme_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sphvv::verification::extreme_scenes {
namespace {

using std::numbers::pi;

/// By how much two runs may differ whose coordinates are rounded at the distance X from the origin: a
/// position by X eps/2 in each step, the change of velocity of a step (0.2 U at the limits of stability) by
/// 44 neighbours times as much over dx, and both add up over the steps.
double rounding(double X_over_dx, int steps) {
    return steps * steps * neighbours_of_a_disc * 0.2 * X_over_dx * machine;
}

constexpr int aspect_steps = 3;
constexpr int aspect_rows = 4;

/// u_x = cos(pi y/H) between two walls with free slip, 4 rows, Re = U H/nu = 10: exp(-pi^2 nu t/H^2).
PointScene shear_wave(int columns) {
    constexpr double dx = 1. / aspect_rows;
    PointScene scene{.places = block(columns, aspect_rows, dx, {0, 0}),
                     .velocities = {},
                     .box = {{0, 0}, {columns * dx, 1}, {true, false}},
                     .free_surface = false,
                     .dx = dx,
                     .density = 1,
                     .viscosity = 0.1,
                     .time_step = 0.02,
                     .settings = exact_settings()};
    // Places 4000 dx from the origin are rounded to 4000 eps/2 of dx, so the weights of two particles on one
    // another, one of them by an image, differ by a few times that: the matrix is symmetric to 1e-12 and no
    // residual comes below.
    scene.settings.insert_or_assign("pressure_tolerance", "1e-11");
    using Vector = solver::Vector<2>;
    scene.walls = {solver::shapes::plane<2>("bed", Vector(0, 0), Vector(0, 1), solver::Slip::free_slip),
                   solver::shapes::plane<2>("lid", Vector(0, 1), Vector(0, -1), solver::Slip::free_slip)};
    for (const Point& x : scene.places) {
        scene.velocities.push_back({std::cos(pi * x[1]), 0});
    }
    return scene;
}

/// m/s (U = 1): every column of the long box against a column of one that is 8 wide.
ExtremeOutcome long_box(const std::string& scheme) {
    constexpr int columns = 1000 * aspect_rows;
    constexpr int few = 8;
    Simulation box = simulate(scheme, shear_wave(few));
    Simulation longer = simulate(scheme, shear_wave(columns));
    ExtremeOutcome first = advance_and_measure(box, aspect_steps, [](const Simulation&) { return 0.; });
    if (!first.survived) {
        return first;
    }
    return advance_and_measure(longer, aspect_steps, [&](const Simulation& end) {
        const std::vector<Point> column = velocities_of(box);
        std::vector<Point> expected;
        for (std::size_t row = 0; row < aspect_rows; ++row) {
            expected.insert(expected.end(), columns, column[row * few]);
        }
        return largest_difference(velocities_of(end), expected);
    });
}

constexpr double k = 2 * pi;

/// Taylor-Green vortices, U = 1, Re = 100, in a unit square with this corner.
PointScene vortices(const std::vector<Point>& places, double dx, double corner) {
    PointScene scene{.places = places,
                     .velocities = {},
                     .box = {{corner, corner}, {corner + 1, corner + 1}, {true, true}},
                     .free_surface = false,
                     .dx = dx,
                     .density = 1,
                     .viscosity = 0.01,
                     .time_step = 0.1 * dx,
                     .settings = exact_settings()};
    for (Point& x : scene.places) {
        scene.velocities.push_back(
            {-std::cos(k * x[0]) * std::sin(k * x[1]), std::sin(k * x[0]) * std::cos(k * x[1])});
        scene.pressures.push_back(-(std::cos(2 * k * x[0]) + std::cos(2 * k * x[1])) / 4);
        x = {x[0] + corner, x[1] + corner};
    }
    return scene;
}

constexpr double far = 1e6;
constexpr int far_n = 20;
constexpr int far_steps = 10;

/// m/s (U = 1): far from the origin against at the origin.
ExtremeOutcome offset(const std::string& scheme) {
    const std::vector<Point> places = block(far_n, far_n, 1. / far_n, {0, 0});
    Simulation near = simulate(scheme, vortices(places, 1. / far_n, 0));
    Simulation away = simulate(scheme, vortices(places, 1. / far_n, far));
    ExtremeOutcome first = advance_and_measure(near, far_steps, [](const Simulation&) { return 0.; });
    if (!first.survived) {
        return first;
    }
    return advance_and_measure(away, far_steps, [&](const Simulation& end) {
        return largest_difference(velocities_of(end), velocities_of(near));
    });
}

constexpr int turned_n = 30; // a multiple of 5

/// The square lattice turned by atan(3/4), whose period along either axis is 5 dx: places of the unit square.
std::vector<Point> turned_lattice() {
    std::vector<Point> places;
    const int reach = 5 * turned_n;
    for (int a = -reach; a <= reach; ++a) {
        for (int b = -reach; b <= reach; ++b) {
            const int x = 4 * a - 3 * b; // in dx/5
            const int y = 3 * a + 4 * b;
            if (x >= 0 && x < reach && y >= 0 && y < reach) {
                places.push_back({(x + 0.5) / reach, (y + 0.5) / reach});
            }
        }
    }
    return places;
}

/// Relative L2 error of the velocity of this start.
ExtremeOutcome turn(const std::string& scheme, const std::vector<Point>& places) {
    PointScene scene = vortices(places, 1. / turned_n, 0);
    Simulation s = simulate(scheme, scene);
    return advance_and_measure(s, 30, [](const Simulation& end) {
        const std::vector<Point> x = places_of(end);
        const std::vector<Point> u = velocities_of(end);
        const double decay = std::exp(-2 * 0.01 * k * k * end.time);
        double error = 0;
        double exact = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            const Point e{-decay * std::cos(k * x[i][0]) * std::sin(k * x[i][1]),
                          decay * std::sin(k * x[i][0]) * std::cos(k * x[i][1])};
            error += std::pow(u[i][0] - e[0], 2) + std::pow(u[i][1] - e[1], 2);
            exact += e[0] * e[0] + e[1] * e[1];
        }
        return std::sqrt(error / exact);
    });
}

/// The error of the turned lattice over that of the one aligned with the flow.
ExtremeOutcome turned_over_aligned(const std::string& scheme) {
    ExtremeOutcome turned = turn(scheme, turned_lattice());
    const ExtremeOutcome aligned = turn(scheme, block(turned_n, turned_n, 1. / turned_n, {0, 0}));
    if (!turned.survived || !aligned.survived) {
        return turned.survived ? aligned : turned;
    }
    turned.error /= aligned.error;
    return turned;
}

std::vector<ExtremeRow> rows() {
    std::vector<ExtremeRow> all;
    add_for_all(all, [](const std::string& scheme) {
        return ExtremeRow{
            .name = "a box 1000 times longer than high",
            .scheme = scheme,
            .must = "4000 columns of a shear wave are those of a box of 8; error: velocity, over U",
            .why = "nothing varies along the box; coordinates of 4000 dx are rounded to 4000 dx eps/2",
            .fate = Fate::bounded,
            .bound = rounding(1000 * aspect_rows, aspect_steps),
            .run = long_box};
    });
    add_for_all(all, [](const std::string& scheme) {
        return ExtremeRow{.name = "coordinates of 1e6 L",
                          .scheme = scheme,
                          .must = "vortices are those at the origin; error: velocity, over U",
                          .why = "coordinates are rounded to 1e6 L eps/2 in each of 10 steps",
                          .fate = Fate::bounded,
                          .bound = rounding(far * far_n, far_steps),
                          .run = offset};
    });
    add_for_all(all, [](const std::string& scheme) {
        return ExtremeRow{
            .name = "a lattice turned against the flow",
            .scheme = scheme,
            .must = "vortices are as they were on the aligned one; error: error of velocity over that there",
            .why =
                "the smoothing error is isotropic, k^2 <r^2>_W; what knows the axes is the quadrature error, "
                "which is not to be larger than it: a factor 2",
            .fate = Fate::bounded,
            .bound = 2,
            .run = turned_over_aligned};
    });
    return all;
}

} // namespace

const ExtremeScenes& box_and_lattice() {
    static const ExtremeScenes scenes{"box_and_lattice", "long boxes, far coordinates, turned lattices",
                                      rows};
    return scenes;
}

} // namespace sphvv::verification::extreme_scenes
