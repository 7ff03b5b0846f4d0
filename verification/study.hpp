#pragma once

#include "sphvv/verification/cost_front.hpp"
#include "sphvv/verification/run.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace sphvv::verification {

/// A ladder to be run: what a study record or a command line asks for.
struct LadderRequest {
    const Case* flow;
    std::vector<Variant> schemes;
    solver::Assignments settings;
    std::vector<int> ladder; ///< ascending
    std::string tier;        ///< "quick", "nightly", "full", or "command" for one given on the command line
    std::vector<double> time_steps{};   ///< s; not empty: a ladder in time at the one n of `ladder`
    int picture_at = 0;                 ///< the rung whose runs keep their particles; 0 for none
    std::string study{};                ///< name of the study, empty for a ladder given on the command line
    std::vector<std::string> chaotic{}; ///< labels of variants; see Study
    double chaotic_round_off = Study::usual_round_off; ///< of their error norms
};

/// One rung of one scheme: the seeds' runs put together.
struct Sample {
    int n;
    double h;
    double dx;
    std::size_t particles;
    double time_step;
    double steps;               ///< mean over the seeds
    std::optional<Norms> norms; ///< geometric mean over the seeds; empty unless all survived
    double l2_spread = 0;       ///< largest / smallest - 1 over the seeds
    int seeds;
    double seconds;
    double seconds_spread;
    int repeats;
    double cpu_seconds;
    double pair_evaluations;
    double solver_iterations;
    double matrix_entries;
    double particle_steps;
    bool survived;
    std::string diagnosis;
};

/// One field of one scheme on one ladder, with its verdict.
struct FieldStudy {
    std::string scheme;
    std::string field;
    Axis axis;
    std::optional<Expectation> expectation; ///< empty if the project expects nothing in particular
    std::string verdict; ///< PASS, FAIL, INCONCLUSIVE, or NONE where no verdict was demanded
    std::string reason;
    std::optional<OrderFit> fit;
    std::vector<double> order_l1; ///< pairwise; NaN at the coarsest rung
    std::vector<double> order_l2;
    std::vector<double> order_linf;
    std::vector<Sample> samples;
    bool ended_unexpectedly = false; ///< a run did not survive although nothing said that it would not
};

/// Error against one kind of cost for all schemes of a ladder.
struct Front {
    std::string field;
    std::string cost; ///< "seconds" or "work": pair evaluations and matrix entries
    std::vector<std::vector<int>> n;
    std::vector<CostCurve> curves;
    std::vector<FrontRow> rows;
};

struct ClaimFinding {
    const Claim* claim;
    Claim::Finding finding;
};

/// Everything that came of one LadderRequest.
struct LadderResult {
    LadderRequest request;
    std::string group; ///< study or case, with the settings that tell this ladder apart
    std::vector<RunRecord> runs;
    std::vector<FieldStudy> studies;
    std::vector<Front> fronts;
    std::vector<ClaimFinding> claims;
};

/// Told what runs: scheme, rung, and the share of that run that is done (1 when it has ended).
using LadderProgress = std::function<void(const std::string& group, const RunRecord& at, double fraction)>;

/// Resolves every scene of the ladder without running any. Throws UserError for whatever is wrong with it.
std::vector<SceneRecord> plan(const LadderRequest& request);

/// Runs the ladder and judges it. The runs of a ladder in time are held against the same scene with a step 32
/// times finer than their finest, particle by particle.
LadderResult run_ladder(const LadderRequest& request, const LadderProgress& progress = {});

/// The judgement alone, of runs that were made before: this is what turns samples into verdicts. In time,
/// each scheme must show the order that it declares.
std::vector<FieldStudy> judge_runs(std::span<const SceneRecord> scenes, std::span<const RunRecord> runs,
                                   Axis axis);

/// Exit status of a ladder (cli.md): 0; 1 a verdict failed, or is inconclusive, without a waiver, a goal of
/// the project was missed, or a run lost what its scheme claims to conserve; 3 a run ended early
/// unexpectedly.
int exit_status(const LadderResult& result);

} // namespace sphvv::verification
