#pragma once

#include "sphvv/verification/results.hpp"

#include <span>
#include <string>
#include <vector>

namespace sphvv::verification {

/// How one compared thing differs from the baseline, from harmless to not (rules of evidence §9).
enum class Change {
    bitwise_equal,
    round_off,   ///< within what another compiler or other flags change
    run_time,    ///< seconds; informational
    added,       ///< not in the baseline, which may be older than the member; informational
    work,        ///< pair evaluations, iterations, matrix entries or steps; fails from 1 % on
    error_level, ///< an error norm, up, down or gone: an improvement asks for a new baseline, too
    order,       ///< by more than both 95 % intervals, or 0.05 where that is more
    demand,      ///< an expected order, bound, tolerance or reference: a check made weaker or stronger
    verdict,     ///< PASS, FAIL, …; or a property, kernel check or published figure that holds or does not
    missing,     ///< in the baseline only
};
std::string_view to_string(Change change);

/// One difference.
struct Difference {
    Change change;
    std::string subject; ///< operator, kernel or scheme: what somebody edits
    std::string where;   ///< ladder and rung, or property
    std::string what;    ///< norm, count or word that differs
    std::string baseline;
    std::string current;
    double factor; ///< current over baseline, 1 for words
};

struct Comparison {
    std::vector<Difference> differences; ///< without the bitwise equal ones
    std::size_t compared = 0;            ///< numbers and words held against each other; not what neither has
    std::size_t bitwise = 0;             ///< of those, the bitwise equal ones; seconds and costs take no part
    double seconds_before = 0;           ///< of the rungs that both time
    double seconds_after = 0;

    bool fails() const;
};

/// Reads a result file (HDF5 or its JSON twin) or a baseline. Throws UserError in one sentence for anything
/// else.
ResultTree read_comparable(const std::filesystem::path& path);

/// Holds results against a baseline; both may be full results (of `sphvv operators` or `sphvv verify`) or
/// reduced ones (reduced_for_baseline). Rungs are found by study, n and, in time, dt, whatever their order in
/// the file.
///
/// Equal to round-off: 1e-6 for operators (-O3 native against -O1: 3e-8), whose sums have no memory; for a
/// study of schemes what the baseline's record of it says (Study::round_off), and any norm below 1e-11, which
/// is eps times the square of 200 particles a side. Values of a property that are both within its bound are
/// equal to round-off, and so are those of a kernel check that differ by no more than the baseline's
/// tolerance of it. How many steps a run takes that ends early is not compared, only that it does: the last
/// ones are chaotic.
///
/// Throws UserError if the two have no study in common, or if an entry lacks what identifies it.
Comparison compare(const ResultTree& baseline, const ResultTree& current);

/// The smallest table that shows why: one row for each subject and kind of change with the worst of them, at
/// most `most_lines` with the line of counts. Where the gate fails only the kinds that it fails on have rows.
std::string markdown(const Comparison& comparison, std::size_t most_lines = 40);

/// The same as a text for a pull request, at most 40 lines: verdict and builds above the table, run times
/// below.
std::string summary(const Comparison& comparison, const ResultTree& baseline, const ResultTree& current);

/// Results that several calls of one build have written, as one. Throws UserError if the builds differ.
ResultTree merged(std::span<const ResultTree> results);

/// What a baseline keeps of a result: identities, error norms, orders, demands, verdicts, work; no seconds,
/// no texts. Throws UserError, naming the first one, if the result has a verdict that failed or is
/// inconclusive without a waiver (a run that ended early unexpectedly is a FAIL of each of its studies), a
/// run that lost what its scheme claims to conserve, or a property, kernel check, figure or goal that is not
/// as it must be: a baseline that blesses a wrong answer is worse than none. So is one that nobody can
/// reproduce: a result of a tree with uncommitted changes is refused unless `allow_dirty`.
ResultTree reduced_for_baseline(const ResultTree& result, bool allow_dirty = false);

/// JSON with one line a rung or check, so that a reviewer can read the difference of two baselines.
std::string baseline_text(const ResultTree& baseline);

} // namespace sphvv::verification
