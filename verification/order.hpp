#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sphvv::verification {

/// One resolution of a ladder: particle spacing or smoothing length, and the error of each seed (one entry
/// for a deterministic start). Errors are relative ones wherever round-off is to be recognised.
struct Rung {
    double h;
    std::vector<double> errors;
};

/// The band in which theory or a citation puts the order; a missing bound makes it one-sided.
struct Expected {
    std::optional<double> low;
    std::optional<double> high;
    std::string source;
};

/// Slope of log e on log h. The vectors run from the coarsest rung to the finest,
/// whatever the order of the input.
struct OrderFit {
    double order;                 ///< least-squares slope over all rungs
    double ci95;                  ///< half-width of its 95 % confidence interval (Student's t, rungs - 2)
    std::vector<double> pairwise; ///< log(e_{k-1}/e_k)/log(h_{k-1}/h_k); NaN at the coarsest rung
    std::vector<double> spread{}; ///< standard deviation of log e over the seeds; 0 for a single seed
    double seed_ci95 = 0;         ///< half-width that the seed spread alone accounts for
};

enum class Verdict { pass, fail, inconclusive };

/// PASS, FAIL or INCONCLUSIVE.
std::string_view to_string(Verdict verdict);

struct Judgement {
    Verdict verdict;
    std::string reason;          ///< one clause with the number that decided
    std::optional<OrderFit> fit; ///< empty for a single rung, and where an error has no logarithm
};

/// Least-squares slope of y_k on x_k = log h_k, where y_k is the mean of log e over the seeds of rung k:
/// seeds are repeats of one rung, not further rungs. With S = sum (x_k - <x>)^2,
///
///   order = sum (x_k - <x>)(y_k - <y>) / S
///   ci95 = t_{0.975,n-2} sqrt(RSS/(n-2)/S)
///   seed_ci95 = t_{0.975,M} sqrt(sum w_k^2 s_k^2/m_k),  w_k = (x_k - <x>)/S,  M = sum (m_k - 1),
///
/// for n rungs, rung k of m_k seeds with standard deviation s_k (Draper & Smith, Applied Regression Analysis,
/// 3rd ed., chapter 1). Two rungs leave no degree of freedom: ci95 is then infinite.
///
/// Throws std::invalid_argument for fewer than two rungs, an h that is repeated or not positive, a rung
/// without error, and an error without a logarithm.
OrderFit fit_order(std::span<const Rung> rungs);

/// The verdict on a ladder. The first of these rules that applies decides:
///
///  1. INCONCLUSIVE  an error is negative or not finite
///  2. INCONCLUSIVE  no error exceeds 1e-12 (round-off)
///  3. INCONCLUSIVE  fewer than four rungs, or h_max/h_min below 4
///  4. INCONCLUSIVE  the ladder is not in its asymptotic range:
///     - round-off: an error is zero; or the coarsest is below 1e-12; or the finer error of a pair is, and
///       the order of that pair is less than half of the largest
///     - floor: from the largest pairwise order (above 0.5) on they fall to less than half of it, but not
///       below -0.5, as where the error tends to a constant
///     - pre-asymptotic: the pairwise orders rise, or fall, all along the ladder by more than 0.5
///     - noise: ci95 or seed_ci95 exceeds 0.5, too wide to separate two consecutive integers; or a rung is
///       off the line by more than a factor 1.5; or the seed spread explains a drift as above
///  5. PASS          slope and finest pairwise order are both inside the band
///  6. FAIL          the whole interval order ± ci95 is outside the band
///  7. INCONCLUSIVE  anything else
///
/// Where every pairwise order is inside the band, floor and drift are no reason to withhold a verdict, nor
/// are the residuals that a drift leaves: the orders of a known crossover, say a first-order leading error
/// under a second-order smoothing error with the band [0.9, 2], change along the ladder as was expected.
/// Bounds are inclusive, with a slack of 1e-9 for rounding.
///
/// Throws std::invalid_argument as fit_order does for h and missing errors, and for a band without bounds or
/// upside down.
Judgement judge(std::span<const Rung> rungs, const Expected& expected);

} // namespace sphvv::verification
