// Boxes closed on every side: the pressure has Neumann conditions all around, and no level.
#include "sphvv/solver/boundaries/shapes/plane.hpp"
#include "sphvv/verification/extreme_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sphvv::verification::extreme_scenes {
namespace {

constexpr int n = 16; ///< spacings to the unit
constexpr double dx = 1. / n;
constexpr double k = 2 * std::numbers::pi;
constexpr int steps = 20;

std::vector<solver::Wall<2>> walls_around(const solver::Box<2>& box) {
    std::vector<solver::Wall<2>> walls;
    using Vector = solver::Vector<2>;
    for (int d = 0; d < 2; ++d) {
        const Vector normal = Vector::Unit(d);
        walls.push_back(
            solver::shapes::plane<2>("low", box.low[d] * normal, normal, solver::Slip::free_slip));
        walls.push_back(
            solver::shapes::plane<2>("high", box.high[d] * normal, -normal, solver::Slip::free_slip));
    }
    return walls;
}

/// Taylor-Green vortices in [low, high]^2, U = 1, Re = 100.
PointScene vortices(double low, double high, bool closed) {
    const int columns = static_cast<int>(std::lround((high - low) / dx));
    PointScene scene{.places = block(columns, columns, dx, {low, low}),
                     .velocities = {},
                     .box = {{low, low}, {high, high}, {!closed, !closed}},
                     .free_surface = false,
                     .dx = dx,
                     .density = 1,
                     .viscosity = 0.01,
                     .time_step = 0.002,
                     .settings = exact_settings()};
    if (closed) {
        scene.walls = walls_around(scene.box);
    }
    for (const auto& [x, y] : scene.places) {
        scene.velocities.push_back({-std::cos(k * x) * std::sin(k * y), std::sin(k * x) * std::cos(k * y)});
        scene.pressures.push_back(-(std::cos(2 * k * x) + std::cos(2 * k * y)) / 4);
    }
    return scene;
}

/// The lines x, y = 1/4, 3/4 are planes of symmetry of the vortices, and of a lattice that has no particle on
/// them. m/s, between the vortex in the closed quarter and the same one in the periodic whole.
ExtremeOutcome quarter_of_whole(const std::string& scheme) {
    Simulation whole = simulate(scheme, vortices(0, 1, false));
    Simulation quarter = simulate(scheme, vortices(0.25, 0.75, true));
    ExtremeOutcome of_whole = advance_and_measure(whole, steps, [](const Simulation&) { return 0.; });
    if (!of_whole.survived) {
        return of_whole;
    }
    return advance_and_measure(quarter, steps, [&](const Simulation& end) {
        const std::vector<Point> all = velocities_of(whole);
        std::vector<Point> part;
        for (int row = n / 4; row < 3 * n / 4; ++row) {
            for (int column = n / 4; column < 3 * n / 4; ++column) {
                part.push_back(all[row * n + column]);
            }
        }
        return largest_difference(velocities_of(end), part);
    });
}

/// |mean p|/(rho U^2).
ExtremeOutcome mean_pressure(const std::string& scheme) {
    Simulation s = simulate(scheme, vortices(0.25, 0.75, true));
    return advance_and_measure(s, steps, [](const Simulation& end) {
        double total = 0;
        for (const double p : pressures_of(end)) {
            total += p;
        }
        return std::abs(total) / static_cast<double>(end.particles.size());
    });
}

/// u = (x - centre)/L in a closed box of disordered particles: fluid is asked to leave through every wall.
/// The largest kinetic energy after a step, over that of the start.
ExtremeOutcome expand(const std::string& scheme) {
    PointScene scene = vortices(0.25, 0.75, true);
    Uniform uniform(20261123);
    for (std::size_t i = 0; i < scene.places.size(); ++i) {
        for (int d = 0; d < 2; ++d) {
            scene.places[i][d] += 0.1 * dx * uniform();
            scene.velocities[i][d] = scene.places[i][d] - 0.5;
        }
    }
    scene.pressures.clear();
    scene.settings.clear();
    Simulation s = simulate(scheme, scene);
    const double start = kinetic_energy(s);
    ExtremeOutcome outcome;
    double largest = 0;
    for (int step = 0; step < steps; ++step) {
        outcome =
            advance_and_measure(s, 1, [&](const Simulation& end) { return kinetic_energy(end) / start; });
        if (!outcome.survived) {
            break;
        }
        largest = std::max(largest, outcome.error);
    }
    outcome.error = largest;
    outcome.steps = s.step;
    return outcome;
}

std::vector<ExtremeRow> rows() {
    std::vector<ExtremeRow> all;
    add_for_all(all, [](const std::string& scheme) {
        const bool compressible = variant_of(scheme).scheme->compressible;
        return ExtremeRow{.name = "a vortex between four walls",
                          .scheme = scheme,
                          .must = "is a quarter of the periodic whole; error: velocity, m/s",
                          .why = compressible ? "walls with free slip are planes of symmetry: the same sums "
                                                "in another order, 44 terms of "
                                                "c0^2/h with eps/2 each, times dt and 20 steps"
                                              : "walls with free slip are planes of symmetry: both pressures "
                                                "are within 1e-12 times the "
                                                "condition (L/dx)^2 of the exact one, whose gradient moves "
                                                "by k U^2 dt in each of 20 steps",
                          .fate = Fate::bounded,
                          .bound = compressible ? steps * 44 * machine * 0.002 * 100 / (1.3 * dx)
                                                : steps * 2 * 1e-12 * n * n * k * 0.002,
                          .run = quarter_of_whole};
    });
    add_for_all(all, [](const std::string& scheme) {
        ExtremeRow row{.name = "the level of a pressure without one",
                       .scheme = scheme,
                       .must = "its mean is 0; error: |mean p|/(rho U^2)",
                       .why = "constants are projected out of the solution",
                       .fate = Fate::bounded,
                       .bound = round_off,
                       .run = mean_pressure};
        if (scheme == "isph_dfs") {
            row.why = "constants are projected out of the solution; then shifts carry it along, by at most "
                      "|grad p| 0.1 dx <= (k/2) 0.1 dx rho U^2";
            row.bound = k / 2 * 0.1 * dx;
        }
        return row;
    });
    std::erase_if(all, [](const ExtremeRow& row) {
        return row.scheme == "wcsph" &&
               row.name == "the level of a pressure without one"; // that of its density
    });
    add_for_all(all, [](const std::string& scheme) {
        ExtremeRow row{
            .name = "a source without a solution",
            .scheme = scheme,
            .must = "fluid asked to leave a closed box stays; error: largest kinetic energy over its start",
            .why = "a projection is orthogonal and sound keeps the energy, so it does not grow, if the mean "
                   "of the source, which no pressure can make, is taken out of it",
            .fate = Fate::bounded,
            .bound = 1,
            .run = expand};
        if (scheme == "isph_di") {
            row.fate = Fate::survives;
            row.why =
                "the error in density of the disordered start becomes a velocity: nothing bounds the energy";
        }
        return row;
    });
    return all;
}

} // namespace

const ExtremeScenes& closed_domain() {
    static const ExtremeScenes scenes{"closed_domain", "boxes closed on every side", rows};
    return scenes;
}

} // namespace sphvv::verification::extreme_scenes
