#pragma once

#include "sphvv/solver/settings.hpp"
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
    std::string cost; ///< run time on two cores, for the reader
    /// Not empty: a ladder in time, of these steps (s) at the one n of `ladder`.
    std::vector<double> time_steps{};
    /// Not 0: the rung at which the first run of every scheme keeps its particles for a picture (2-D).
    int picture_at = 0;
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

/// A flow in a periodic box that starts from, and is held against, an exact solution of analytic/. One file
/// in verification/cases/ defines one.
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
};

/// The parameters of the case's solution, and the keys of every periodic scene: end_time, arrangement,
/// jitter, minimum_spacing.
std::vector<solver::Key> case_keys(const Case& c);

/// The expectation for a scheme and field under these settings of case and scheme, or nullptr.
const Expectation* find_expectation(const Case& c, std::string_view scheme, std::string_view field,
                                    const solver::Settings& of_case, const solver::Settings& of_scheme);

/// Whether all conditions hold.
bool applies(std::span<const Condition> conditions, const solver::Settings& of_case,
             const solver::Settings& of_scheme);

} // namespace sphvv::verification
