// Particles at one place or nearly so, and a start of full disorder.
#include "sphvv/verification/extreme_scenes.hpp"

#include <cmath>

namespace sphvv::verification::extreme_scenes {
namespace {

constexpr double dx = 0.02;

/// |P(t) - P(0)| / (M U) of a block of particles on a lattice, one of them moved on top of, or next to, its
/// neighbour.
ExtremeOutcome coincide(const std::string& scheme, double distance) {
    constexpr int n = 10;
    PointScene scene{.places = block(n, n, dx, {0, 0}), .velocities = {}, .time_step = 1e-4};
    scene.places[n * n / 2 + n / 2] = scene.places[n * n / 2 + n / 2 - 1];
    scene.places[n * n / 2 + n / 2][0] += distance;
    Uniform uniform(20261123);
    for (int i = 0; i < n * n; ++i) {
        scene.velocities.push_back({0.1 * uniform(), 0.1 * uniform()});
    }
    if (!has_free_surface(scheme)) {
        scene.free_surface = false;
        scene.box = {{0, 0}, {n * dx, n * dx}, {true, true}};
    }
    Simulation s = simulate(scheme, scene);
    if (needs_polynomial(scheme)) {
        s.survival.kinetic_energy = 1.1 * kinetic_energy(s);
        s.survival.kinetic_energy_reason = "1.1 times its start, undriven";
    }
    const auto before = momentum(s);
    return advance_and_measure(s, 50, [&](const Simulation& end) {
        const auto after = momentum(end);
        return std::hypot(after[0] - before[0], after[1] - before[1]) /
               (end.particle_mass * static_cast<double>(end.particles.size()));
    });
}

ExtremeOutcome jittered(const std::string& scheme, const char* smallest) {
    return run_case("taylor_green", scheme,
                    {{"re", "100"},
                     {"end_time", "0.02"},
                     {"arrangement", "jittered"},
                     {"jitter", "0.5"},
                     {"minimum_spacing", smallest}},
                    32);
}

/// isph_di takes the density error of the start off in one step.
ExtremeRow density_becomes_velocity(ExtremeRow row) {
    if (row.scheme == "isph_di") {
        row.must = "ends: the kinetic energy grows";
        row.why =
            "particles move by their error in density, about half of it times dx, in the first step of 0.2 "
            "h/U, and keep that velocity: of the size of U";
        row.fate = Fate::ends;
        row.diagnoses = {"kinetic energy"};
    }
    return row;
}

std::vector<ExtremeRow> rows() {
    std::vector<ExtremeRow> all;
    struct Gap {
        const char* name;
        double distance; ///< dx
    };
    for (const Gap gap :
         {Gap{"two particles at one place", 0}, Gap{"two particles 1e-12 dx apart", 1e-12},
          Gap{"two particles 1e-8 dx apart", 1e-8}, Gap{"two particles 1e-3 dx apart", 1e-3}}) {
        add_for_all(all, [&](const std::string& scheme) {
            const bool keeps = conserves_momentum(scheme);
            ExtremeRow row{
                .name = gap.name,
                .scheme = scheme,
                .must = "forces stay finite; error: |P - P0|/(M U)",
                .why = keeps ? "gradW(0) = 0: no direction, no force; antisymmetric forces keep the momentum"
                             : "gradW(0) = 0: no direction, no force; momentum is not claimed",
                .fate = keeps ? Fate::bounded : Fate::survives,
                .bound = round_off,
                .run = [gap](const std::string& of) { return coincide(of, gap.distance * dx); }};
            if (needs_polynomial(scheme)) {
                row.must = "ends with a diagnosis of energy, place or the pressure solver";
                row.why = "its shifts go with (dx/r)^2 U_rms, 1e6 and more once the two have parted by dt "
                          "|u_i - u_j|: both are "
                          "thrown through the box in a step, and carry grad u along";
                row.fate = Fate::ends;
                row.diagnoses = blown_up;
            }
            return row;
        });
    }
    add_for_all(all, [](const std::string& scheme) {
        ExtremeRow row{.name = "50 % jitter",
                       .scheme = scheme,
                       .must = "ends: the smallest spacing is below dx/4",
                       .why = "at the start: offsets of particles in neighbouring cells differ by a "
                              "triangular density along "
                              "and across, so that a pair is within e dx with a chance of e^3/3 or so, 0.5 "
                              "%, and there are 2000 "
                              "pairs",
                       .fate = Fate::ends,
                       .diagnoses = {"minimum spacing"},
                       .run = [](const std::string& of) { return jittered(of, "0.25"); }};
        return density_becomes_velocity(row);
    });
    add_for_all(all, [](const std::string& scheme) {
        ExtremeRow row{.name = "50 % jitter, any spacing",
                       .scheme = scheme,
                       .must = "survives t = 0.02; error: velocity, L2",
                       .why = "forces of close pairs vanish with their distance; the sums are wrong by O(1) "
                              "in such disorder, and nothing is claimed of the error",
                       .fate = Fate::survives,
                       .run = [](const std::string& of) { return jittered(of, "0"); }};
        return density_becomes_velocity(row);
    });
    return all;
}

} // namespace

const ExtremeScenes& coincidence() {
    static const ExtremeScenes scenes{"coincidence", "particles at one place or nearly so", rows};
    return scenes;
}

} // namespace sphvv::verification::extreme_scenes
