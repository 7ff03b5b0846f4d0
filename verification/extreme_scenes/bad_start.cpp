// Scenes that start with what is no number.
#include "sphvv/verification/extreme_scenes.hpp"

#include <limits>

namespace sphvv::verification::extreme_scenes {
namespace {

constexpr int culprit = 57;

/// Particles in a periodic box, one of them with this velocity or at this place.
ExtremeOutcome start(const std::string& scheme, double velocity, double place) {
    constexpr int n = 10;
    PointScene scene{.places = block(n, n, 1. / n, {0, 0}),
                     .velocities = std::vector<Point>(std::size_t{n} * n, Point{0.1, 0}),
                     .box = {{0, 0}, {1, 1}, {true, true}},
                     .free_surface = false,
                     .dx = 1. / n,
                     .density = 1,
                     .time_step = 0}; // the scheme's own: it reads the velocities
    scene.velocities[culprit][1] += velocity;
    scene.places[culprit][1] += place;
    Simulation s = simulate(scheme, scene);
    s.end_time = 1;
    return advance_and_measure(s, 1, [](const Simulation&) { return 0.; });
}

std::vector<ExtremeRow> rows() {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
    std::vector<ExtremeRow> all;
    struct Start {
        const char* name;
        double velocity;
        double place;
    };
    const std::string particle = ": particle " + std::to_string(culprit) + " ";
    for (const Start& given : {Start{"a velocity of NaN at the start", no_number, 0},
                               Start{"an infinite velocity at the start", infinite, 0},
                               Start{"a place of NaN at the start", 0, no_number},
                               Start{"an infinite place at the start", 0, infinite}}) {
        const bool of_velocity = given.place == 0;
        add_for_all(all, [&](const std::string& scheme) {
            return ExtremeRow{
                .name = given.name,
                .scheme = scheme,
                .must = "ends in the first step and names the particle",
                .why = "it is told before it spreads to its neighbours",
                .fate = Fate::ends,
                .diagnoses = {(of_velocity ? "velocity not finite"
                                           : "position not finite or outside the domain") +
                              particle},
                .run = [given](const std::string& of) { return start(of, given.velocity, given.place); }};
        });
    }
    return all;
}

} // namespace

const ExtremeScenes& bad_start() {
    static const ExtremeScenes scenes{"bad_start", "starts that are no numbers", rows};
    return scenes;
}

} // namespace sphvv::verification::extreme_scenes
