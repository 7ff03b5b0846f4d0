// A hundred thousand steps: what drifts.
#include "sphvv/verification/extreme_scenes.hpp"

#include <algorithm>
#include <cmath>

namespace sphvv::verification::extreme_scenes {
namespace {

constexpr int n = 8; // as few as two supports
constexpr double dx = 1. / n;

/// A periodic lattice of 8 by 8, moving with (1, 1/2) m/s, and on top of it each particle at random.
PointScene stream(double disorder) {
    PointScene scene{.places = block(n, n, dx, {0, 0}),
                     .velocities = {},
                     .box = {{0, 0}, {1, 1}, {true, true}},
                     .free_surface = false,
                     .dx = dx,
                     .density = 1,
                     .viscosity = 0.01,
                     .time_step = 0.002};
    Uniform uniform(20261123);
    for (int i = 0; i < n * n; ++i) {
        scene.velocities.push_back({1 + disorder * uniform(), 0.5 + disorder * uniform()});
    }
    return scene;
}

/// Largest change of a velocity, m/s.
ExtremeOutcome translate(const std::string& scheme, int steps) {
    const PointScene scene = stream(0);
    Simulation s = simulate(scheme, scene);
    return advance_and_measure(s, steps, [&](const Simulation& end) {
        return largest_difference(velocities_of(end), scene.velocities);
    });
}

/// |P(t) - P(0)|/(M U).
ExtremeOutcome drift_of_momentum(const std::string& scheme, int steps) {
    Simulation s = simulate(scheme, stream(0.1));
    const auto before = momentum(s);
    return advance_and_measure(s, steps, [&](const Simulation& end) {
        const auto after = momentum(end);
        return std::hypot(after[0] - before[0], after[1] - before[1]);
    });
}

/// Kinetic energy about the mean velocity, over its start.
ExtremeOutcome drift_of_energy(const std::string& scheme, int steps) {
    Simulation s = simulate(scheme, stream(0.1));
    const auto about_the_mean = [](const Simulation& sim) {
        const auto P = momentum(sim);
        return kinetic_energy(sim) - (P[0] * P[0] + P[1] * P[1]) / 2; // of the mass 1
    };
    const double before = about_the_mean(s);
    return advance_and_measure(s, steps, [&](const Simulation& end) { return about_the_mean(end) / before; });
}

std::vector<ExtremeRow> rows() {
    std::vector<ExtremeRow> all;
    struct Length {
        Tier tier;
        const char* text;
        int steps;
    };
    for (const Length& length :
         {Length{Tier::quick, "1e3 steps", 1000}, Length{Tier::nightly, "1e5 steps", 100000}}) {
        const int steps = length.steps;
        const auto row = [&](const char* name, const std::string& scheme, const char* must, const char* why,
                             double bound, ExtremeOutcome (*run)(const std::string&, int)) {
            return ExtremeRow{.name = std::string(length.text) + ": " + name,
                              .scheme = scheme,
                              .must = must,
                              .why = why,
                              .fate = Fate::bounded,
                              .bound = bound,
                              .run = [run, steps](const std::string& of) { return run(of, steps); },
                              .tier = length.tier};
        };
        add_for_all(all, [&](const std::string& scheme) {
            return row("uniform motion", scheme, "goes on; error: velocity, m/s",
                       "no difference of velocities; a velocity is rounded once a step", 2 * steps * machine,
                       translate);
        });
        for (const std::string& scheme : scheme_names()) {
            if (conserves_momentum(scheme)) {
                all.push_back(row("momentum", scheme, "does not drift; error: |P - P0|/(M U)",
                                  "antisymmetric forces; a velocity is rounded once a step",
                                  2 * steps * machine, drift_of_momentum));
            }
        }
        add_for_all(all, [&](const std::string& scheme) {
            return row("energy", scheme, "does not grow; error: that about the mean velocity, over its start",
                       "nothing feeds it, viscosity takes it", 1, drift_of_energy);
        });
    }
    return all;
}

} // namespace

const ExtremeScenes& long_runs() {
    static const ExtremeScenes scenes{"long_runs", "many steps", rows};
    return scenes;
}

} // namespace sphvv::verification::extreme_scenes
