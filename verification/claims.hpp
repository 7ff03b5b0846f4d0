#pragma once

#include "sphvv/verification/order.hpp"
#include "sphvv/verification/run.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// What a published claim is measured with.
namespace sphvv::verification {

/// A number as printf writes it.
inline std::string number(double value, const char* format) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

/// A share as a percentage.
inline std::string percent(double share) {
    return number(100 * share, "%.3g %%");
}

/// The first run of that scheme (or variant, by its label) and rung, or nullptr.
inline const RunRecord* find_run(std::span<const RunRecord> runs, std::string_view scheme, int n) {
    for (const RunRecord& run : runs) {
        if (run.scheme == scheme && run.n == n) {
            return &run;
        }
    }
    return nullptr;
}

/// Relative L2 error of a field at the end of a run; not a number where it has none.
inline double l2_error(const RunRecord& run, std::string_view field) {
    const auto found = std::ranges::find(run.errors, field, &FieldError::field);
    return found == run.errors.end() ? std::nan("") : found->norms.l2;
}

/// Largest relative error of the pressure at the end, from `low` to `high`, in every run of that scheme and
/// rung: the range over the seeds, and how the first run ended that did not get there.
inline std::optional<Claim::Finding> largest_pressure_error(std::span<const RunRecord> runs,
                                                            std::string_view scheme, int n, double low,
                                                            double high) {
    std::vector<double> largest;
    std::vector<double> mean;
    std::vector<const RunRecord*> ended;
    for (const RunRecord& run : runs) {
        if (run.scheme == scheme && run.n == n) {
            const auto found = std::ranges::find(run.errors, "pressure", &FieldError::field);
            if (found == run.errors.end()) {
                ended.push_back(&run);
            } else {
                largest.push_back(found->norms.linf);
                mean.push_back(found->norms.l2);
            }
        }
    }
    std::string text;
    if (!ended.empty()) {
        text = std::to_string(ended.size()) + " of " + std::to_string(ended.size() + largest.size()) +
               " ended early, the first at t = " + number(ended[0]->time, "%.4f") +
               " s: " + ended[0]->diagnosis;
    }
    if (largest.empty()) {
        return ended.empty() ? std::nullopt : std::optional(Claim::Finding{text, false});
    }
    const auto range = [](std::vector<double> values) {
        std::sort(values.begin(), values.end());
        return (values.size() > 1 ? percent(values.front()) + " to " : "") + percent(values.back());
    };
    const auto inside = [&](double error) { return error >= low && error <= high; };
    text += (text.empty() ? "largest " : "; otherwise largest ") + range(largest) + ", L2 " + range(mean);
    return Claim::Finding{text, ended.empty() && std::all_of(largest.begin(), largest.end(), inside)};
}

/// Largest relative L2 error of the velocity over the run.
inline double largest_l2_error(const RunRecord& run) {
    double largest = 0;
    for (const Deviation& at : run.history) {
        largest = std::max(largest, at.find("velocity")->l2);
    }
    return largest;
}

/// Pair evaluations and matrix entries.
inline double work_of(const RunRecord& run) {
    return static_cast<double>(run.work.pair_evaluations) + static_cast<double>(run.work.matrix_entries);
}

/// "ends at t = 0.31", or what a survivor is described with.
inline std::string fate(const RunRecord& run, const std::string& if_survived) {
    return run.survived ? if_survived : "ends at t = " + number(run.time, "%.2f");
}

/// Least-squares order of the L2 error of a field over the rungs with from <= n <= to, all seeds of a rung
/// together; nothing unless there are five rungs (or fewer are asked for) and all runs survived.
inline std::optional<double> fitted_order(std::span<const RunRecord> runs, std::string_view scheme,
                                          std::string_view field, int from, std::size_t rungs_needed = 5,
                                          int to = std::numeric_limits<int>::max()) {
    std::vector<Rung> rungs;
    for (const RunRecord& run : runs) {
        if (run.scheme == scheme && run.n >= from && run.n <= to) {
            if (!run.survived) {
                return std::nullopt;
            }
            if (rungs.empty() || rungs.back().h != run.h) {
                rungs.push_back({run.h, {}});
            }
            rungs.back().errors.push_back(l2_error(run, field));
        }
    }
    if (rungs.size() < rungs_needed) {
        return std::nullopt;
    }
    return fit_order(rungs).order;
}

/// Cost at which a scheme's velocity error comes down to `error`, between two rungs on a straight line in
/// logarithms, from the first seed of each; nothing where the rungs do not bracket it.
template <class Cost>
std::optional<double> cost_at_error(std::span<const RunRecord> runs, std::string_view scheme, double error,
                                    const Cost& cost) {
    const RunRecord* coarser = nullptr;
    for (const RunRecord& run : runs) {
        if (run.scheme != scheme || run.seed != 1 || !run.survived) {
            continue;
        }
        if (coarser != nullptr && l2_error(*coarser, "velocity") >= error &&
            l2_error(run, "velocity") <= error) {
            const double share = std::log(l2_error(*coarser, "velocity") / error) /
                                 std::log(l2_error(*coarser, "velocity") / l2_error(run, "velocity"));
            return cost(*coarser) * std::pow(cost(run) / cost(*coarser), share);
        }
        coarser = &run;
    }
    return std::nullopt;
}

/// The same for work and for seconds.
inline std::optional<double> work_at_error(std::span<const RunRecord> runs, std::string_view scheme,
                                           double error) {
    return cost_at_error(runs, scheme, error, work_of);
}

inline std::optional<double> seconds_at_error(std::span<const RunRecord> runs, std::string_view scheme,
                                              double error) {
    return cost_at_error(runs, scheme, error, [](const RunRecord& run) { return run.seconds; });
}

} // namespace sphvv::verification
