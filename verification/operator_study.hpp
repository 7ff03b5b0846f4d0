#pragma once

#include "sphvv/solver/operators.hpp"
#include "sphvv/verification/cost_front.hpp"
#include "sphvv/verification/norms.hpp"
#include "sphvv/verification/order.hpp"
#include "sphvv/verification/particle_sets.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace sphvv::verification {

/// The ways to refine (rules of evidence §4). Orders are in dx along all of them.
enum class Path {
    fixed_ratio, ///< h/dx fixed
    fixed_h,     ///< h fixed; against the operator's own limit, so that the smoothing error takes no part
    joint,       ///< h ~ sqrt(dx)
};
std::string_view to_string(Path path);

/// One ladder of one arrangement along one path; all operators are evaluated on the same particles.
struct OperatorLadder {
    int dimension;
    Arrangement arrangement;
    Path path;
    std::vector<int> n; ///< ascending; spacings along the side of the box
    double coarsest_h_over_dx;
    int seeds;
};

struct OperatorSample {
    int n;
    double h;
    double dx;
    std::size_t particles;      ///< at which the operator was judged, mean over the seeds
    std::optional<Norms> norms; ///< over the determined ones; geometric mean over the seeds
    double l2_spread = 0;       ///< largest / smallest - 1 over the seeds
    int seeds;
    double undetermined;     ///< particles whose neighbours do not determine the operator, sum over the seeds
    double pair_evaluations; ///< of one application, mean over the seeds
};

/// One operator on one ladder, with its verdict.
struct OperatorStudy {
    const solver::Operator* op;
    OperatorLadder ladder;
    std::string kernel;
    std::optional<Expected> expected;
    std::string verdict; ///< PASS, FAIL, INCONCLUSIVE, or NONE where theory gives no order
    std::string reason;
    std::optional<OrderFit> fit;
    std::vector<double> order_l1, order_l2, order_linf; ///< pairwise, NaN at the coarsest rung
    std::vector<OperatorSample> samples;
};

/// One declared property of one operator on one arrangement.
struct PropertyCheck {
    std::string op;
    int dimension;
    std::string property;
    std::string arrangement;
    double value; ///< what was measured
    double bound; ///< and what it may not exceed (or, for `at_least`, must reach)
    bool at_least;
    bool passes;
};

/// The order that an operator's declaration gives for a ladder: with s = 1/2, m the noise power, d the
/// dimension,
///
///   h/dx fixed:  the smoothing order on lattices; 1 - m on irregular particles, up to the smoothing order
///   where a
///                transition is declared; `truncated` at an edge or corner
///   h fixed:     1 + d/2 for displaced lattices, d/2 for independent positions (Monte Carlo)
///   joint:       the smaller of s `smoothing` and 1 + d/2 - s(m + d/2), or, for independent positions,
///                (1 - s) d/2 + s(1 - m); up to the larger one in three dimensions, whose ladders
///                start where noise rules; the smoothing order on lattices
///
/// with ± 0.25: theory's own steps are d/2, half an order in three dimensions. On rings it is a lower bound.
/// Nothing for operators without a continuous limit, for rings and settled tiles off h/dx fixed, whose noise
/// has no such law, and where the constant depends on an h/dx that changes (joint path at edges and of
/// lattice sums without a field).
std::optional<Expected> expected_order(const solver::Operator& op, const OperatorLadder& ladder);

/// The ladders of a tier: "quick" (two dimensions), "nightly" (finer, and three dimensions).
std::vector<OperatorLadder> operator_ladders(std::string_view tier);

/// Told what has been evaluated: a line of text, the share that is done, and whether a ladder is complete.
using OperatorProgress = std::function<void(const std::string& what, double fraction, bool ladder_done)>;

/// Evaluates all operators on all ladders and judges them.
std::vector<OperatorStudy> run_operator_studies(std::span<const solver::Operator* const> operators,
                                                std::span<const OperatorLadder> ladders,
                                                const solver::Kernel& kernel,
                                                const OperatorProgress& progress = {});

/// The declared properties of one operator, in two and three dimensions.
std::vector<PropertyCheck> check_properties(const solver::Operator& op, const solver::Kernel& kernel);

/// Nanoseconds per pair of one application (Google Benchmark, one thread, a periodic 20 % jitter), with the
/// operators in the order given. Two-sweep operators count their pairs twice.
struct OperatorCost {
    std::string op;
    int dimension;
    double nanoseconds_per_pair; ///< median of the repetitions
    double spread;               ///< largest / smallest - 1
    double pairs;                ///< of the set that was timed
};
std::vector<OperatorCost> measure_costs(std::span<const solver::Operator* const> operators,
                                        const solver::Kernel& kernel);

/// Error against cost at h/dx fixed on 10 % jitter, for the operators that approximate the same thing.
struct OperatorFront {
    std::string approximates;
    std::string cost; ///< "nanoseconds" or "pair_evaluations"
    std::vector<CostCurve> curves;
    std::vector<FrontRow> rows;
};
std::vector<OperatorFront> operator_fronts(std::span<const OperatorStudy> studies,
                                           std::span<const OperatorCost> costs);

} // namespace sphvv::verification
