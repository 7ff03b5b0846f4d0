// Body forces of 1000 g. By dimensional analysis a column at rest knows its g only through the scales: with
// g 4^k times as large, velocities are 2^k, pressures 4^k times as large, and times 2^-k, to the last bit.
#include "sphvv/solver/boundaries/shapes/plane.hpp"
#include "sphvv/verification/cases.hpp"
#include "sphvv/verification/extreme_scenes.hpp"
#include "sphvv/verification/run.hpp"

#include <algorithm>
#include <cmath>

namespace sphvv::verification::extreme_scenes {
namespace {

constexpr double earth = 9.81;   // m/s2
constexpr double times_g = 1024; // 1.0e4 m/s2
constexpr double faster = 32;    // sqrt(times_g)

/// The largest difference of two runs' velocities, over `speed`, and pressures, over `pressure`, after the
/// scales have been taken off the second.
double difference(const std::vector<std::vector<double>>& slow, const std::vector<std::vector<double>>& fast,
                  double speed, double pressure) {
    double largest = 0;
    for (std::size_t c = 0; c < slow.size(); ++c) {
        const bool is_pressure = c + 1 == slow.size();
        for (std::size_t i = 0; i < slow[c].size(); ++i) {
            const double scaled = fast[c][i] / (is_pressure ? times_g : faster);
            const double off = std::abs(scaled - slow[c][i]) / (is_pressure ? pressure : speed);
            largest = off > largest || std::isnan(off) ? off : largest;
        }
    }
    return largest;
}

std::vector<std::vector<double>> fields_of(const EndState& end) {
    std::vector<std::vector<double>> fields = end.velocity;
    fields.push_back(end.pressure);
    return fields;
}

/// The case `hydrostatic`.
ExtremeOutcome under_surface(const std::string& scheme) {
    constexpr double duration = 0.02; // s, at 1 g
    const auto run = [&](double g, double end_time, EndState& end) {
        return run_scene_once(
            resolve_scene(cases::find("hydrostatic"), variant_of(scheme),
                          {{"gravity", solver::shortest(g)}, {"end_time", solver::shortest(end_time)}}, 20),
            end);
    };
    EndState slow;
    EndState fast;
    const RunRecord first = run(earth, duration, slow);
    const RunRecord second = run(times_g * earth, duration / faster, fast);
    ExtremeOutcome outcome{second.survived, second.diagnosis, 0, second.steps};
    if (!first.survived) {
        return {false, first.diagnosis, 0, first.steps};
    }
    constexpr double depth = 0.4; // m, of the case
    outcome.error =
        difference(fields_of(slow), fields_of(fast), std::sqrt(earth * depth), 1000 * earth * depth);
    if (first.steps != second.steps) {
        outcome.survived = false;
        outcome.diagnosis =
            "took " + std::to_string(second.steps) + " steps in place of " + std::to_string(first.steps);
    }
    return outcome;
}

/// Between bed and lid, 16 by 10 particles, periodic along them.
PointScene column(double scale) {
    constexpr double dx = 0.03125;
    constexpr double height = 10 * dx;
    PointScene scene{.places = block(16, 10, dx, {0, 0}),
                     .velocities = std::vector<Point>(160, Point{0, 0}),
                     .box = {{0, 0}, {16 * dx, height}, {true, false}},
                     .free_surface = false,
                     .dx = dx,
                     .density = 1024,
                     .viscosity = 0,
                     .speed = scale,
                     .time_step = 0x1p-10 / scale,
                     .body_force = {0, -earth * scale * scale},
                     .settings = exact_settings()};
    using Vector = solver::Vector<2>;
    scene.walls = {
        solver::shapes::plane<2>("bed", Vector(0, 0), Vector(0, 1), solver::Slip::free_slip),
        solver::shapes::plane<2>("lid", Vector(0, height), Vector(0, -1), solver::Slip::free_slip)};
    for (const auto& [x, y] : scene.places) {
        scene.pressures.push_back(scene.density * earth * scale * scale * (height - y));
    }
    return scene;
}

ExtremeOutcome between_lids(const std::string& scheme) {
    constexpr int steps = 20;
    Simulation slow = simulate(scheme, column(1));
    Simulation fast = simulate(scheme, column(faster));
    const auto fields = [](const Simulation& s) {
        std::vector<std::vector<double>> result(3);
        for (const auto& [u, v] : velocities_of(s)) {
            result[0].push_back(u);
            result[1].push_back(v);
        }
        result[2] = pressures_of(s);
        return result;
    };
    ExtremeOutcome first = advance_and_measure(slow, steps, [](const Simulation&) { return 0.; });
    if (!first.survived) {
        return first;
    }
    return advance_and_measure(fast, steps, [&](const Simulation& end) {
        return difference(fields(slow), fields(end), slow.reference_speed, slow.density);
    });
}

std::vector<ExtremeRow> rows() {
    std::vector<ExtremeRow> all;
    const std::string why = "the same numbers to a power of two: c0 and dt go with sqrt(g), and no absolute "
                            "number is in the equations";
    add_for_all(all, [&](const std::string& scheme) {
        ExtremeRow row{.name = "1024 g under a free surface",
                       .scheme = scheme,
                       .must = "is as at 1 g but for the scales; error: u and p, relative",
                       .why = why,
                       .fate = Fate::bounded,
                       .bound = 0,
                       .run = under_surface};
        if (!has_free_surface(scheme)) {
            must_be_refused(row);
        }
        return row;
    });
    add_for_all(all, [&](const std::string& scheme) {
        return ExtremeRow{.name = "1024 g between bed and lid",
                          .scheme = scheme,
                          .must = "is as at 1 g but for the scales; error: u and p, relative",
                          .why = why,
                          .fate = Fate::bounded,
                          .bound = 0,
                          .run = between_lids};
    });
    return all;
}

} // namespace

const ExtremeScenes& body_force() {
    static const ExtremeScenes scenes{"body_force", "forces of 1000 g", rows};
    return scenes;
}

} // namespace sphvv::verification::extreme_scenes
