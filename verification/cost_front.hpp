#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sphvv::verification {

/// Error against cost of one scheme on one case; entry k of both arrays is one run. Cost is seconds or any
/// work count, the same for all curves that are compared.
struct CostCurve {
    std::string name;
    std::vector<double> error, cost;
};

/// Where a curve stands among the others.
struct FrontRow {
    std::string name;
    bool on_front;
    std::optional<double> slower_by; ///< cost over that of `than`, both at `at_error`; empty on the front
    double at_error;                 ///< the error level that decided; NaN for a curve without a finite error
    std::string than;                ///< the curve that is cheaper; empty on the front
};

/// The error/cost front (DiffEqDevTools calls the same data a WorkPrecisionSet), one row a curve in the order
/// given.
///
/// A curve's cost at a level E is that of the first point with error <= E on the walk from its cheapest run
/// to its dearest, straight in (log error, log cost) between runs. No run beyond the walk is imagined: nobody
/// reaches a level below his smallest error, and whoever is below E already with his cheapest run reaches E
/// for the cost of that run, since that run was made and has that error or less. Not an extrapolation, but an
/// upper bound on the cost.
///
/// A curve is on the front if at some level between its smallest and its largest error nobody reaches that
/// level for less; at_error is the smallest such level. Every other curve is held against whoever is cheaper
/// at the smallest error that lies within the range of errors of both, so that the ratio is one of
/// interpolated costs at *equal* error; of several, against the cheapest. Without such an error slower_by is
/// empty, and at_error and than name the curve's own smallest error and who has that or less for the least
/// cost.
///
/// Runs whose error is not finite (diverged) are left out; a curve of only such runs is off the front. Throws
/// std::invalid_argument for arrays of different length, an error that is zero or negative (it has no
/// logarithm), and a cost that is not positive and finite.
std::vector<FrontRow> cost_front(std::span<const CostCurve> curves);

} // namespace sphvv::verification
