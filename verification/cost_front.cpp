#include "sphvv/verification/cost_front.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string_view>

namespace sphvv::verification {
namespace {

constexpr double tie = 1e-12; // two log costs that differ by rounding are equal

struct LogPoint {
    double error, cost;
};

/// The runs of one curve from cheap to dear.
struct Walk {
    std::string_view name;
    std::vector<LogPoint> points;
    double smallest_error = std::numeric_limits<double>::infinity(); // all in logarithms
    double largest_error = -std::numeric_limits<double>::infinity();

    bool covers(double error) const { return smallest_error <= error && error <= largest_error; }
};

/// log cost as a linear function of log error on one interval of error.
struct Line {
    double error, cost, slope;

    double at(double level) const { return cost + slope * (level - error); }
};

Walk walk_along(const CostCurve& curve) {
    if (curve.error.size() != curve.cost.size()) {
        throw std::invalid_argument("the curve '" + curve.name + "' has " +
                                    std::to_string(curve.error.size()) + " errors and " +
                                    std::to_string(curve.cost.size()) + " costs");
    }
    Walk walk{curve.name, {}};
    for (std::size_t k = 0; k < curve.error.size(); ++k) {
        if (!(curve.cost[k] > 0) || !std::isfinite(curve.cost[k])) {
            throw std::invalid_argument("the curve '" + curve.name + "' has the cost " +
                                        std::to_string(curve.cost[k]) + "; costs are positive and finite");
        }
        if (curve.error[k] <= 0) {
            throw std::invalid_argument("the curve '" + curve.name + "' has the error " +
                                        std::to_string(curve.error[k]) + ", which has no logarithm");
        }
        if (std::isfinite(curve.error[k])) {
            walk.points.push_back({std::log(curve.error[k]), std::log(curve.cost[k])});
            walk.smallest_error = std::min(walk.smallest_error, walk.points.back().error);
            walk.largest_error = std::max(walk.largest_error, walk.points.back().error);
        }
    }
    std::sort(walk.points.begin(), walk.points.end(), [](const LogPoint& a, const LogPoint& b) {
        return a.cost < b.cost || (a.cost == b.cost && a.error < b.error);
    });
    return walk;
}

/// The piece of the walk on which `level` is first reached; valid from there up to the next larger error of
/// any run.
std::optional<Line> piece_reaching(const Walk& walk, double level) {
    const auto reached = std::find_if(walk.points.begin(), walk.points.end(),
                                      [&](const LogPoint& point) { return point.error <= level; });
    if (reached == walk.points.end()) {
        return std::nullopt;
    }
    if (reached == walk.points.begin()) {
        return Line{reached->error, reached->cost, 0};
    }
    const LogPoint& before = *(reached - 1);
    return Line{reached->error, reached->cost,
                (before.cost - reached->cost) / (before.error - reached->error)};
}

std::optional<double> cost_at(const Walk& walk, double level) {
    const auto piece = piece_reaching(walk, level);
    return piece ? std::optional(piece->at(level)) : std::nullopt;
}

/// All errors of all runs within the curve's own range, ascending: between two of them every cost is one
/// line.
std::vector<double> breakpoints(std::span<const Walk> walks, const Walk& own) {
    std::vector<double> levels;
    for (const Walk& walk : walks) {
        for (const LogPoint& point : walk.points) {
            if (own.covers(point.error)) {
                levels.push_back(point.error);
            }
        }
    }
    std::sort(levels.begin(), levels.end());
    levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
    return levels;
}

/// The smallest level in [low, high] at which nobody is cheaper (own, among the walks, never is). Costs being
/// lines there, each rival leaves one end of the interval or the other.
std::optional<double> cheapest_within(std::span<const Walk> walks, const Walk& own, double low, double high) {
    const Line own_cost = *piece_reaching(own, low);
    double from = low;
    double to = high;
    for (const Walk& rival : walks) {
        const auto rival_cost = piece_reaching(rival, low);
        if (!rival_cost) {
            continue;
        }
        const double excess_low = own_cost.at(low) - rival_cost->at(low) - tie;
        const double excess_high = own_cost.at(high) - rival_cost->at(high) - tie;
        if (excess_low > 0 && excess_high > 0) {
            return std::nullopt;
        }
        const double crossing = low + (high - low) * excess_low / (excess_low - excess_high);
        if (excess_low > 0) {
            from = std::max(from, crossing);
        } else if (excess_high > 0) {
            to = std::min(to, crossing);
        }
    }
    return from <= to ? std::optional(from) : std::nullopt;
}

std::optional<double> level_on_front(std::span<const Walk> walks, const Walk& own) {
    const auto levels = breakpoints(walks, own);
    for (std::size_t k = 0; k < levels.size(); ++k) {
        const double high = k + 1 < levels.size() ? levels[k + 1] : levels[k];
        if (const auto level = cheapest_within(walks, own, levels[k], high)) {
            return level;
        }
    }
    return std::nullopt;
}

/// Who undercuts `own` at the smallest error common to both; of several there, the cheapest.
FrontRow undercut_at_equal_error(std::span<const Walk> walks, const Walk& own, FrontRow row) {
    double smallest = std::numeric_limits<double>::infinity();
    double largest_excess = 0;
    for (const Walk& rival : walks) {
        const double level = std::max(own.smallest_error, rival.smallest_error);
        if (!own.covers(level) || !rival.covers(level)) {
            continue;
        }
        const double excess = *cost_at(own, level) - *cost_at(rival, level);
        if (excess > tie && (level < smallest || (level == smallest && excess > largest_excess))) {
            smallest = level;
            largest_excess = excess;
            row.slower_by = std::exp(excess);
            row.at_error = std::exp(level);
            row.than = rival.name;
        }
    }
    return row;
}

/// Who has the smallest error of `own`, or less, for the least cost.
FrontRow undercut_by_a_better_run(std::span<const Walk> walks, const Walk& own, FrontRow row) {
    double cheapest = std::numeric_limits<double>::infinity();
    row.at_error = std::exp(own.smallest_error);
    for (const Walk& rival : walks) {
        const auto cost = cost_at(rival, own.smallest_error);
        if (cost && *cost < cheapest) {
            cheapest = *cost;
            row.than = rival.name;
        }
    }
    return row;
}

FrontRow place(std::span<const Walk> walks, const Walk& own) {
    FrontRow row{std::string(own.name), false, std::nullopt, std::numeric_limits<double>::quiet_NaN(), {}};
    if (own.points.empty()) {
        return row;
    }
    if (const auto level = level_on_front(walks, own)) {
        row.on_front = true;
        row.at_error = std::exp(*level);
        return row;
    }
    const FrontRow equal = undercut_at_equal_error(walks, own, row);
    return equal.slower_by ? equal : undercut_by_a_better_run(walks, own, row);
}

} // namespace

std::vector<FrontRow> cost_front(std::span<const CostCurve> curves) {
    std::vector<Walk> walks;
    walks.reserve(curves.size());
    for (const CostCurve& curve : curves) {
        walks.push_back(walk_along(curve));
    }
    std::vector<FrontRow> rows;
    rows.reserve(walks.size());
    for (const Walk& walk : walks) {
        rows.push_back(place(walks, walk));
    }
    return rows;
}

} // namespace sphvv::verification
