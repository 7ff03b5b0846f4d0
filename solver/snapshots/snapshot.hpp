#pragma once

#include "sphvv/solver/settings.hpp"
#include "sphvv/solver/simulation.hpp"

#include <cstdint>
#include <filesystem>

namespace sphvv::solver {

/// A snapshot is an HDF5 file with all that a run needs to go on as if it had not stopped: the same bits.
///
/// | group | holds |
/// |---|---|
/// | `/` | attributes `format` = "sphvv-snapshot", `format_version`, `dimension`, `particles`, `step`,
/// `time`, `end_time`, `time_step` (s), `maximum_acceleration` (m/s2) | | `/particles` | `id` and every state
/// field by its name: scalars N, vectors N × 3 (z = 0 in 2-D), others N × components | | `/scene` | box and
/// physical constants, SI units | | `/settings` | of the scheme, as text | | `/metadata` | text that the
/// caller gave: case, scheme, n, … | | `/work` | the counters of Work | | `/physics` | turbulence, wall
/// function and flow driver of a scene that has one, as text | | `/flow_driver` | `force` (m/s2),
/// `previous_error` (m/s), `started` | | `/stages` | `name` and `pair_evaluations` of each stage |
///
/// Nothing in it depends on the machine, the hour or the number of threads. (Seconds per stage are not kept.)
constexpr std::int64_t snapshot_version = 1;

/// Writes a snapshot; the file appears complete or not at all. Throws UserError if it cannot be written.
template <int Dim>
void write_snapshot(const Simulation<Dim>& simulation, const Assignments& metadata,
                    const std::filesystem::path& path);

/// Puts a simulation that was built for the same scene where the snapshot was taken: identity and state
/// fields, step, time, time step, maximum acceleration, work counters and pair evaluations of each stage. End
/// time, survival bounds and neighbour list are left alone.
///
/// Throws UserError, and leaves the simulation as it was, if the file is missing, foreign, of a newer
/// version, truncated or damaged, or belongs to another scene: if the dimension, the number of particles, an
/// entry of `metadata`, a setting, the box, a physical constant, the stages or the state fields differ. The
/// sentence names the first difference.
template <int Dim>
void read_snapshot(Simulation<Dim>& simulation, const Assignments& metadata,
                   const std::filesystem::path& path);

/// What a snapshot tells before anybody has built its scene.
struct SnapshotHeader {
    int dimension;
    std::int64_t particles;
    std::int64_t step;
    double time;     ///< s
    double end_time; ///< s
    Assignments settings;
    Assignments metadata;
};

/// Throws UserError if the file is missing, foreign, of a newer version, truncated or damaged.
SnapshotHeader read_snapshot_header(const std::filesystem::path& path);

} // namespace sphvv::solver
