#include "sphvv/verification/order.hpp"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_fit.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iomanip>
#include <limits>
#include <numeric>
#include <sstream>
#include <stdexcept>

namespace sphvv::verification {
namespace {

constexpr std::size_t least_rungs = 4;
constexpr double least_span = 4;
constexpr double round_off = 1e-12;           // of a relative error summed over neighbours and steps
constexpr double rounding_slack = 1e-9;       // of a bound or a span that is met exactly
constexpr double undecided_width = 0.5;       // two integer orders cannot be told apart beyond it
constexpr double monotone_slack = 0.05;       // a floor reached is flat, not exactly monotone
constexpr double largest_misfit_factor = 1.5; // of one rung's error against the fitted line

/// Rungs from coarse to fine, in logarithms.
struct LogLadder {
    std::vector<double> log_h;
    std::vector<double> log_error; // seed mean
    std::vector<double> spread;    // standard deviation over seeds
    std::vector<double> variance;  // of the seed mean
    double seed_freedom = 0;       // sum of seeds - 1
};

std::string number(double x) {
    std::ostringstream text;
    text << std::setprecision(3) << x;
    return text.str();
}

std::string decimals(double x) {
    std::ostringstream text;
    text << std::fixed << std::setprecision(2) << x;
    return text.str();
}

std::vector<Rung> coarse_to_fine(std::span<const Rung> rungs) {
    std::vector<Rung> ladder(rungs.begin(), rungs.end());
    for (const Rung& rung : ladder) {
        if (!(rung.h > 0) || !std::isfinite(rung.h)) {
            throw std::invalid_argument("a ladder needs positive finite h; one rung has h = " +
                                        number(rung.h));
        }
        if (rung.errors.empty()) {
            throw std::invalid_argument("the rung at h = " + number(rung.h) +
                                        " has no error; give one for each seed");
        }
    }
    std::sort(ladder.begin(), ladder.end(), [](const Rung& a, const Rung& b) { return a.h > b.h; });
    for (std::size_t k = 1; k < ladder.size(); ++k) {
        if (ladder[k - 1].h <= ladder[k].h * (1 + rounding_slack)) {
            throw std::invalid_argument("two rungs have h = " + number(ladder[k].h) +
                                        "; give the seeds of one resolution as errors of one rung");
        }
    }
    return ladder;
}

double mean(std::span<const double> values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double variance(std::span<const double> values) {
    if (values.size() < 2) {
        return 0;
    }
    const double centre = mean(values);
    double sum = 0;
    for (const double x : values) {
        sum += (x - centre) * (x - centre);
    }
    return sum / static_cast<double>(values.size() - 1);
}

LogLadder logarithms(std::span<const Rung> ladder) {
    LogLadder logs;
    for (const Rung& rung : ladder) {
        std::vector<double> log_errors;
        for (const double error : rung.errors) {
            if (!(error > 0) || !std::isfinite(error)) {
                throw std::invalid_argument("an order needs positive finite errors; the rung at h = " +
                                            number(rung.h) + " has " + number(error));
            }
            log_errors.push_back(std::log(error));
        }
        const auto seeds = static_cast<double>(log_errors.size());
        logs.log_h.push_back(std::log(rung.h));
        logs.log_error.push_back(mean(log_errors));
        logs.spread.push_back(std::sqrt(variance(log_errors)));
        logs.variance.push_back(variance(log_errors) / seeds);
        logs.seed_freedom += seeds - 1;
    }
    return logs;
}

double student_t_975(double degrees_of_freedom) {
    return gsl_cdf_tdist_Pinv(0.975, degrees_of_freedom);
}

/// Half-width of the 95 % interval of sum w_k <log e>_k that the seeds alone give; 0 without repeats.
double seed_half_width(const LogLadder& logs, std::span<const double> weights) {
    if (logs.seed_freedom < 1) {
        return 0;
    }
    double sum = 0;
    for (std::size_t k = 0; k < weights.size(); ++k) {
        sum += weights[k] * weights[k] * logs.variance[k];
    }
    return student_t_975(logs.seed_freedom) * std::sqrt(sum);
}

std::vector<double> slope_weights(std::span<const double> x) {
    const double centre = mean(x);
    double sum = 0;
    for (const double xk : x) {
        sum += (xk - centre) * (xk - centre);
    }
    std::vector<double> weights;
    for (const double xk : x) {
        weights.push_back((xk - centre) / sum);
    }
    return weights;
}

double pairwise_order(const LogLadder& logs, std::size_t k) {
    return (logs.log_error[k - 1] - logs.log_error[k]) / (logs.log_h[k - 1] - logs.log_h[k]);
}

/// The change of the pairwise order from the pair ending at rung `from` to the one ending at rung `to` that
/// seeds alone may cause.
double seed_drift(const LogLadder& logs, std::size_t from, std::size_t to) {
    std::vector<double> weights(logs.log_h.size(), 0.0);
    const auto add = [&](std::size_t k, double sign) {
        const double step = logs.log_h[k - 1] - logs.log_h[k];
        weights[k - 1] += sign / step;
        weights[k] -= sign / step;
    };
    add(to, 1);
    add(from, -1);
    return seed_half_width(logs, weights);
}

OrderFit fitted(const LogLadder& logs) {
    const std::size_t rungs = logs.log_h.size();
    if (rungs < 2) {
        throw std::invalid_argument("an order needs at least 2 rungs; the ladder has " +
                                    std::to_string(rungs));
    }
    double intercept = 0;
    double slope = 0;
    double cov00 = 0;
    double cov01 = 0;
    double slope_variance = 0;
    double residual = 0;
    gsl_fit_linear(logs.log_h.data(), 1, logs.log_error.data(), 1, rungs, &intercept, &slope, &cov00, &cov01,
                   &slope_variance, &residual);
    OrderFit result{slope, std::numeric_limits<double>::infinity(), {}, logs.spread, 0};
    if (rungs > 2) {
        result.ci95 = student_t_975(static_cast<double>(rungs - 2)) * std::sqrt(slope_variance);
    }
    result.seed_ci95 = seed_half_width(logs, slope_weights(logs.log_h));
    result.pairwise.push_back(std::numeric_limits<double>::quiet_NaN());
    for (std::size_t k = 1; k < rungs; ++k) {
        result.pairwise.push_back(pairwise_order(logs, k));
    }
    return result;
}

void check_band(const Expected& expected) {
    if (!expected.low && !expected.high) {
        throw std::invalid_argument("an expected order needs a lower bound, an upper bound or both");
    }
    const auto not_a_number = [](const std::optional<double>& bound) { return bound && std::isnan(*bound); };
    if (not_a_number(expected.low) || not_a_number(expected.high) ||
        (expected.low && expected.high && *expected.low > *expected.high)) {
        throw std::invalid_argument("an expected order needs low <= high");
    }
}

std::string band_text(const Expected& expected) {
    return (expected.low ? "[" + number(*expected.low) : std::string("(-inf")) + ", " +
           (expected.high ? number(*expected.high) + "]" : std::string("inf)"));
}

bool inside(double order, const Expected& expected) {
    return (!expected.low || order >= *expected.low - rounding_slack) &&
           (!expected.high || order <= *expected.high + rounding_slack);
}

bool interval_outside(const OrderFit& fit, const Expected& expected) {
    return (expected.low && fit.order + fit.ci95 < *expected.low - rounding_slack) ||
           (expected.high && fit.order - fit.ci95 > *expected.high + rounding_slack);
}

std::string interval_text(const OrderFit& fit) {
    return "order " + decimals(fit.order) + " ± " + decimals(fit.ci95);
}

template <typename Predicate>
const Rung* first_rung_with(std::span<const Rung> ladder, Predicate predicate) {
    const auto found = std::find_if(ladder.begin(), ladder.end(), [&](const Rung& rung) {
        return std::any_of(rung.errors.begin(), rung.errors.end(), predicate);
    });
    return found == ladder.end() ? nullptr : &*found;
}

std::optional<std::string> unusable_error(std::span<const Rung> ladder) {
    const auto unusable = [](double error) { return !std::isfinite(error) || error < 0; };
    if (const Rung* rung = first_rung_with(ladder, unusable)) {
        const double error = *std::find_if(rung->errors.begin(), rung->errors.end(), unusable);
        return "the error at h = " + number(rung->h) + " is " + number(error);
    }
    return std::nullopt;
}

std::optional<std::string> nothing_but_round_off(std::span<const Rung> ladder) {
    const auto resolved = [](double error) { return error > round_off; };
    if (ladder.empty() || first_rung_with(ladder, resolved)) {
        return std::nullopt;
    }
    return "round-off: no error exceeds " + number(round_off);
}

std::optional<std::string> too_short(std::span<const Rung> ladder) {
    if (ladder.size() < least_rungs) {
        return std::to_string(ladder.size()) + (ladder.size() == 1 ? " rung" : " rungs") +
               ": an order verdict needs " + std::to_string(least_rungs);
    }
    const double span = ladder.front().h / ladder.back().h;
    if (span < least_span * (1 - rounding_slack)) {
        return "h spans a factor " + number(span) + ": an order verdict needs " + number(least_span);
    }
    return std::nullopt;
}

std::optional<std::string> zero_error(std::span<const Rung> ladder) {
    if (const Rung* rung = first_rung_with(ladder, [](double error) { return error == 0; })) {
        return "round-off: the error at h = " + number(rung->h) + " is 0";
    }
    return std::nullopt;
}

bool falls(std::span<const double> orders) {
    return std::adjacent_find(orders.begin(), orders.end(), [](double coarse, double fine) {
               return fine > coarse + monotone_slack;
           }) == orders.end();
}

bool rises(std::span<const double> orders) {
    return std::adjacent_find(orders.begin(), orders.end(), [](double coarse, double fine) {
               return fine < coarse - monotone_slack;
           }) == orders.end();
}

/// Rung at which the pair of the largest pairwise order ends.
std::size_t largest_pairwise(const OrderFit& fit) {
    return static_cast<std::size_t>(std::max_element(fit.pairwise.begin() + 1, fit.pairwise.end()) -
                                    fit.pairwise.begin());
}

std::optional<std::string> round_off_reached(const LogLadder& logs, const OrderFit& fit) {
    const auto reached = [&](std::size_t k) {
        return "round-off: the error at h = " + number(std::exp(logs.log_h[k])) + " is " +
               number(std::exp(logs.log_error[k]));
    };
    if (logs.log_error.front() < std::log(round_off)) {
        return reached(0);
    }
    const double largest = fit.pairwise[largest_pairwise(fit)];
    for (std::size_t k = 1; k < fit.pairwise.size(); ++k) {
        if (logs.log_error[k] < std::log(round_off) && fit.pairwise[k] < largest / 2) {
            return reached(k);
        }
    }
    return std::nullopt;
}

std::optional<std::string> floor_reached(const LogLadder& logs, const OrderFit& fit) {
    const std::size_t top = largest_pairwise(fit);
    const double largest = fit.pairwise[top];
    const double finest = fit.pairwise.back();
    const auto tail = std::span(fit.pairwise).subspan(top);
    if (largest <= 0.5 || finest >= largest / 2 || finest < -0.5 || !falls(tail) ||
        largest - finest <= seed_drift(logs, top, fit.pairwise.size() - 1)) {
        return std::nullopt;
    }
    return "floor: the pairwise order falls from " + decimals(largest) + " to " + decimals(finest);
}

bool monotone(const OrderFit& fit) {
    const auto orders = std::span(fit.pairwise).subspan(1);
    return falls(orders) || rises(orders);
}

std::optional<std::string> drift(const LogLadder& logs, const OrderFit& fit) {
    const double coarsest = fit.pairwise[1];
    const double finest = fit.pairwise.back();
    if (!monotone(fit) || std::abs(finest - coarsest) <= undecided_width) {
        return std::nullopt;
    }
    const double by_seeds = seed_drift(logs, 1, fit.pairwise.size() - 1);
    const std::string change = "from " + decimals(coarsest) + " to " + decimals(finest);
    if (std::abs(finest - coarsest) <= by_seeds) {
        return "noise: the pairwise order drifts " + change + ", within the ±" + decimals(by_seeds) +
               " of the seeds";
    }
    return "pre-asymptotic: the pairwise order drifts " + change;
}

std::optional<std::string> rung_off_the_line(const LogLadder& logs, const OrderFit& fit) {
    const double mean_log_h = mean(logs.log_h);
    const double mean_log_error = mean(logs.log_error);
    for (std::size_t k = 0; k < logs.log_h.size(); ++k) {
        const double line = mean_log_error + fit.order * (logs.log_h[k] - mean_log_h);
        const double misfit = std::abs(logs.log_error[k] - line);
        if (misfit > std::log(largest_misfit_factor)) {
            return "noise: the error at h = " + number(std::exp(logs.log_h[k])) + " is a factor " +
                   decimals(std::exp(misfit)) + " off the fitted line";
        }
    }
    return std::nullopt;
}

std::optional<std::string> undecided_interval(double half_width, const char* whose) {
    if (half_width <= undecided_width) {
        return std::nullopt;
    }
    return std::string("noise: the 95 % interval ") + whose + "±" + decimals(half_width) + " exceeds ±" +
           decimals(undecided_width);
}

std::optional<std::string> not_asymptotic(const LogLadder& logs, const OrderFit& fit,
                                          const Expected& expected) {
    const bool all_inside = std::all_of(fit.pairwise.begin() + 1, fit.pairwise.end(),
                                        [&](double order) { return inside(order, expected); });
    auto reason = round_off_reached(logs, fit);
    if (!reason && !all_inside) {
        reason = floor_reached(logs, fit);
    }
    if (!reason && !all_inside) {
        reason = drift(logs, fit);
    }
    // The residuals of an expected drift are its curvature, not noise.
    const bool expected_drift = all_inside && monotone(fit);
    if (!reason && !expected_drift) {
        reason = undecided_interval(fit.ci95, "");
    }
    if (!reason && !expected_drift) {
        reason = rung_off_the_line(logs, fit);
    }
    return reason ? reason : undecided_interval(fit.seed_ci95, "of the seeds ");
}

Judgement against_band(const OrderFit& fit, const Expected& expected) {
    const double finest = fit.pairwise.back();
    const std::string band = band_text(expected);
    if (inside(fit.order, expected) && inside(finest, expected)) {
        return {Verdict::pass,
                interval_text(fit) + " and finest pairwise order " + decimals(finest) + " are inside " + band,
                fit};
    }
    if (interval_outside(fit, expected)) {
        return {Verdict::fail, interval_text(fit) + " is wholly outside " + band, fit};
    }
    if (inside(fit.order, expected)) {
        return {Verdict::inconclusive,
                "finest pairwise order " + decimals(finest) + " is outside " + band + " though " +
                    interval_text(fit) + " is not",
                fit};
    }
    return {Verdict::inconclusive, interval_text(fit) + " is outside " + band + " but its interval is not",
            fit};
}

} // namespace

std::string_view to_string(Verdict verdict) {
    switch (verdict) {
    case Verdict::pass:
        return "PASS";
    case Verdict::fail:
        return "FAIL";
    case Verdict::inconclusive:
        return "INCONCLUSIVE";
    }
    throw std::invalid_argument("not a verdict");
}

OrderFit fit_order(std::span<const Rung> rungs) {
    return fitted(logarithms(coarse_to_fine(rungs)));
}

Judgement judge(std::span<const Rung> rungs, const Expected& expected) {
    check_band(expected);
    const std::vector<Rung> ladder = coarse_to_fine(rungs);
    if (const auto reason = unusable_error(ladder)) {
        return {Verdict::inconclusive, *reason, std::nullopt};
    }
    const auto zero = zero_error(ladder);
    const std::optional<OrderFit> slope =
        zero || ladder.size() < 2 ? std::nullopt : std::optional(fitted(logarithms(ladder)));
    if (const auto reason = nothing_but_round_off(ladder)) {
        return {Verdict::inconclusive, *reason, slope};
    }
    if (const auto reason = too_short(ladder)) {
        return {Verdict::inconclusive, *reason, slope};
    }
    if (zero) {
        return {Verdict::inconclusive, *zero, std::nullopt};
    }
    if (const auto reason = not_asymptotic(logarithms(ladder), *slope, expected)) {
        return {Verdict::inconclusive, *reason, slope};
    }
    return against_band(*slope, expected);
}

} // namespace sphvv::verification
