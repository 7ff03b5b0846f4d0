#pragma once

#include "sphvv/analytic/solution.hpp"
#include "sphvv/solver/settings.hpp"
#include "sphvv/solver/simulation.hpp"
#include "sphvv/verification/order.hpp"

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sphvv::verification {

/// How much time a study may take: quick, seconds to a few minutes; nightly, minutes; full, as long as it
/// says.
enum class Tier { quick, nightly, full };
std::string_view to_string(Tier tier);

/// A run time as people say it: "50 s", "2.5 min", "3 h".
std::string duration_text(double seconds);

/// "The number set under `key` lies in [low, high]", or, with `word`, "the word set under `key` is this one".
struct Condition {
    std::string key;
    double low;
    double high;
    std::string word{};
};

/// How a run ends that cannot reach its end time: with a diagnosis, and its particles squeezed.
struct EarlyEnd {
    double spacing;    ///< dx: the smallest distance of two particles until then is at most this
    double not_before; ///< s: earlier, nothing has squeezed them so far
};

/// What one scheme is expected to do on a case, wherever all conditions hold.
struct Expectation {
    std::string scheme;
    std::string field; ///< "velocity" or "pressure"; empty for every field
    std::vector<Condition> where;
    Expected order;                       ///< band and its source
    std::string text;                     ///< why: the theory in a line
    std::optional<EarlyEnd> ends_early{}; ///< the run must end so before its end time, on every rung
    std::string waiver{}; ///< reason for which a verdict other than PASS is tolerated; printed with it
};

/// One ladder that the project runs by itself.
struct Study {
    std::string name;
    Tier tier;
    std::vector<std::string> schemes; ///< or variants, as variant_of() reads them
    solver::Assignments settings;
    std::vector<int> ladder;
    double cost; ///< s: the budget, processor time
    /// Not empty: a ladder in time, of these steps (s) at the one n of `ladder`.
    std::vector<double> time_steps{};
    /// Not 0: the rung at which the first run of every scheme keeps its particles for a picture (2-D).
    int picture_at = 0;
    /// Relative change of an error norm that other round-off alone (another processor, other flags) can
    /// cause: what `compare` calls equal to round-off. The usual one is what is left of the pressure solve's
    /// tolerance, 1e-5, after one turnover of a vortex: particles at a stagnation point part as exp(2 pi U t
    /// / L).
    static constexpr double usual_round_off = 0.01;
    /// The schemes, or variants, whose runs forget their start, and that change of theirs.
    std::vector<std::string> chaotic{};
    double chaotic_round_off = usual_round_off;
};

/// What the rungs of a ladder differ in: the particle spacing, and all that is tied to it, or the time step
/// alone.
enum class Axis { space, time };

struct RunRecord;

/// A published statement about a case, and how our runs measure the same thing.
struct Claim {
    std::string id;
    std::string text;
    std::string published;
    std::string source;
    std::vector<Condition> where;
    struct Finding {
        std::string ours;
        bool agrees;
    };
    /// Nothing if the runs at hand do not cover the claim.
    std::function<std::optional<Finding>(std::span<const RunRecord>)> measure;
    bool binding = false; ///< a goal of the project: where it is missed, the study has failed
};

struct SceneRecord;

/// A number of a scene at the end of a run, held against a quantity of the exact solution: one more line of
/// the ladder beside the fields.
struct Measure {
    std::string name;
    std::function<double(const SceneRecord&, const solver::Simulation<2>&)> ours;
    std::string quantity{}; ///< of the solution; none: that of the same name
    analytic::Vector at{};  ///< m, where the quantity is taken
};

/// What a case does differently from the scene that follows from its solution. Every hook may be left out.
struct SceneHooks {
    /// Changes parameters of the solution that follow from other settings (a sound speed, from the scheme's).
    std::function<void(const SceneRecord&, analytic::Values&)> values{};
    /// Changes parameters to those of the solution whose domain the lattice fills, where that is not the
    /// domain of the flow: that of a column before it settles.
    std::function<void(const SceneRecord&, analytic::Values&)> lattice_values{};
    /// m/s, the largest speed that the scene expects, where the solution's own is none to go by.
    std::function<double(const SceneRecord&, const analytic::Values&)> reference_speed{};
    /// Moves, adds or takes away particles of the lattice; component by component, m.
    std::function<void(const SceneRecord&, std::array<std::vector<double>, 2>&)> arrange{};
    /// Sets what the scheme is to be assembled with, after particles, walls and start values.
    std::function<void(const SceneRecord&, solver::Simulation<2>&)> prepare{};
    /// Whether a field or measure means anything in this scene; none: all do.
    std::function<bool(const SceneRecord&, std::string_view)> compares{};
    /// Adds stages and fields after the scheme's.
    std::function<void(const SceneRecord&, solver::Simulation<2>&)> complete{};
};

/// A flow that starts from, and is held against, an exact solution of analytic/: periodic, or between the
/// walls and the free surface that the solution declares. One file in verification/cases/ defines one.
struct Case {
    std::string_view name;
    std::string_view summary;
    std::string_view equations;
    std::string_view source;
    std::string_view solution;         ///< name in analytic/solutions/
    std::string_view reference_length; ///< name of the solution's parameter that n spacings divide
    std::string_view leading_key;      ///< the key that tells groups of results apart ("re")
    double end_time;
    std::vector<Expectation> expectations;
    std::vector<Claim> claims;
    std::vector<Study> studies;
    /// What is compared: velocity, pressure (up to a constant where there is no free surface), density, and
    /// fields that are quantities of the solution.
    std::vector<std::string> fields{"velocity", "pressure"};
    std::vector<Measure> measures{};
    std::vector<solver::Key> keys{}; ///< of this case alone
    /// Not 0: nothing varies along x, and the box is so many columns of particles wide unless it is told
    /// otherwise.
    int columns = 0;
    /// Parameters of the solution that are no keys: hooks.values derives them from other settings.
    std::vector<std::string> derived{};
    /// Not negative: n counts the spacings along this side of the domain, which is near the reference length.
    int reference_side = -1;
    /// Sides of the solution's domain, none of them its boundary, at which a smooth wall closes the scene.
    std::vector<analytic::Face> closed{};
    bool starts_at_rest = false; ///< although the solution is that of a later time, or has no start
    /// Direction of the profiles that are drawn, and the component of the velocity in them; none if negative.
    int profile_direction = -1;
    SceneHooks hooks{};
    /// What the report calls variants whose settings are too many for a name: name by variant, as
    /// variant_of() reads it.
    std::map<std::string, std::string> variant_names{};
};

/// The fields and measures of a case, in the order of its tables.
std::vector<std::string> compared_names(const Case& c);

/// Whether the case's solution has a boundary of one of these kinds.
bool has_walls(const Case& c);
bool has_free_surface(const Case& c);

/// The parameters of the case's solution, its own keys, and those of every scene: end_time, arrangement,
/// jitter, minimum_spacing, and, where they apply, columns, wall_method and surface_detector.
std::vector<solver::Key> case_keys(const Case& c);

/// The expectation for a scheme and field under these settings of case and scheme, or nullptr.
const Expectation* find_expectation(const Case& c, std::string_view scheme, std::string_view field,
                                    const solver::Settings& of_case, const solver::Settings& of_scheme);

/// Whether all conditions hold.
bool applies(std::span<const Condition> conditions, const solver::Settings& of_case,
             const solver::Settings& of_scheme);

} // namespace sphvv::verification
