#pragma once

#include "sphvv/verification/norms.hpp"
#include "sphvv/verification/scene.hpp"

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace sphvv::verification {

/// Error of one field at the end of a run.
struct FieldError {
    std::string field;
    Norms norms;
};

/// What a run kept and lost of what an isolated fluid keeps, from its start (for a resumed run, from where it
/// was resumed) to the time reached. Energies in J (per metre of depth in 2-D).
struct Budget {
    double momentum_drift = 0; ///< |P(t) - P(0)| / (M U), U the largest speed that the scene expects
    double kinetic_energy_start = 0;
    double kinetic_energy_end = 0;
    std::optional<double> elastic_energy_start; ///< of a compressible scheme
    std::optional<double> elastic_energy_end;
    /// (E(t) - E(0)) / E_kin(0), E kinetic and, where there is one, elastic energy: what viscosity took, and
    /// what the scheme gained or lost
    double energy_drift = 0;
    /// |1/2 sum_ij r_ij x f_ij| / E_kin(0) at the time reached: the rate at which the forces between
    /// particles change angular momentum, where the scheme tells
    std::optional<double> internal_torque;
    std::string claims{}; ///< what the scheme claims to conserve: "momentum, energy", or "nothing"
    /// What of it this run lost: momentum or torque above 1e-10. (Energy is kept without viscosity only, in
    /// the limit of a small step.)
    std::string lost{};
};

/// How far a run is from the exact solution at one time.
struct Deviation {
    double time = 0;                ///< s
    std::vector<FieldError> errors; ///< of what the case compares, in the order of compared_names()
    double maximum_speed = 0;       ///< m/s
    double maximum_speed_exact = 0; ///< m/s, at the particles
    double energy_error =
        0; ///< kinetic energy over the exact one, minus 1; NaN where the solution tells none
    double minimum_spacing = 0; ///< smallest pair distance / dx until then

    /// Norms of that name; nullptr where it is not compared.
    const Norms* find(std::string_view name) const;
};

/// What was measured of one field at the particles, along one direction, beside the exact values.
struct Profile {
    std::string field;              ///< a vector's component by its name: velocity_x
    std::vector<double> coordinate; ///< m
    std::vector<double> ours;
    std::vector<double> exact;
};

/// The particles of a plane run at one time.
struct Picture {
    double time = 0;              ///< s
    std::vector<double> x, y;     ///< m
    std::vector<double> speed;    ///< m/s
    std::vector<double> pressure; ///< Pa
    std::array<double, 4> box{};  ///< m: low x, high x, low y, high y
};

/// What one simulation left behind.
struct RunRecord {
    std::string scheme; ///< label of the variant
    int n = 0;
    std::uint64_t seed = 1;
    double h = 0;
    double dx = 0;
    std::size_t particles = 0;
    bool survived = false;
    std::string diagnosis; ///< the first condition of survival that was violated; empty if none
    double time = 0;       ///< s, reached
    std::int64_t steps = 0;
    double time_step = 0;            ///< s, median
    double prescribed_time_step = 0; ///< s, the scheme's key time_step; 0 where its limits rule
    std::vector<FieldError> errors;  ///< empty unless survived
    double maximum_speed_error = 0;  ///< max|u| / max|u_exact| - 1 over the domain, at the time reached
    double energy_error = 0;         ///< kinetic energy over the exact one, minus 1, at the time reached
    double minimum_spacing = 0;      ///< smallest pair distance / dx over the whole run
    Budget budget;
    std::vector<Deviation> history; ///< at every fortieth of the end time, and at the last step
    std::optional<Picture> picture; ///< at the last step, where the scene asks for it
    std::vector<Profile> profiles;  ///< with the picture, where the case has a direction for them

    double setup_seconds = 0;
    double seconds = 0;        ///< stepping wall time, median over the repeats
    double seconds_spread = 0; ///< largest / smallest - 1 over the repeats
    double cpu_seconds = 0;    ///< of the process, all threads, median run
    int repeats = 1;
    solver::Work work;

    struct StageCost {
        std::string name;
        double seconds;
        std::int64_t pair_evaluations;
    };
    std::vector<StageCost> stages;
    struct FieldSize {
        std::string name;
        double bytes_per_particle;
        std::string asked_by;
    };
    std::vector<FieldSize> fields;
    double bytes_per_particle = 0; ///< of the fields
    /// At the end, over the particles: of the neighbour list, and of what else the scheme keeps for every
    /// pair, as the equations of a pressure.
    double neighbour_bytes_per_particle = 0;
    double pair_bytes_per_particle = 0;
    std::vector<std::pair<std::string, std::string>> settings; ///< every resolved key of case and scheme
};

/// Called after every completed step (outside the timing) with the share of the end time that is reached.
using Progress = std::function<void(double fraction)>;

/// Steps a simulation that was built for the scene to its end time, or to its first violated condition of
/// survival, and compares it. The seconds are those of the stepping alone. An exception of `progress` passes
/// through; the simulation is then at the end of a step.
template <int Dim>
RunRecord step_to_end(solver::Simulation<Dim>& simulation, const SceneRecord& scene,
                      const Progress& progress);

/// Velocity (component by component) and pressure of the fluid particles at the end of a run, in the order of
/// their identity.
struct EndState {
    std::vector<std::vector<double>> velocity;
    std::vector<double> pressure;
};

/// Differences of one run's end from another's, particle by particle, all of one volume.
std::vector<FieldError> differences(const EndState& end, const EndState& reference);

/// Runs a scene once and gives its particles, too.
RunRecord run_scene_once(const SceneRecord& scene, EndState& end, const Progress& progress = {});

/// Runs a scene to its end time, or to its first violated condition of survival, and compares the particles
/// at their current positions with the exact solution at the current time. A run shorter than half a second
/// is repeated (three runs in all) for the median of its timing, and must give the same bits each time
/// (std::logic_error otherwise).
RunRecord run_scene(const SceneRecord& scene, const Progress& progress = {});

} // namespace sphvv::verification
