#include "sphvv/verification/cost_front.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>
#include <vector>

namespace {

using namespace sphvv::verification;

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

std::vector<FrontRow> front(const std::vector<CostCurve>& curves) {
    return cost_front(curves);
}

void expect_on_front(const FrontRow& row, double at_error) {
    EXPECT_TRUE(row.on_front) << row.name;
    EXPECT_FALSE(row.slower_by.has_value());
    EXPECT_NEAR(row.at_error, at_error, 1e-9 * at_error) << row.name;
    EXPECT_TRUE(row.than.empty());
}

void expect_slower(const FrontRow& row, double by, double at_error, const std::string& than) {
    EXPECT_FALSE(row.on_front) << row.name;
    ASSERT_TRUE(row.slower_by.has_value()) << row.name;
    EXPECT_NEAR(*row.slower_by, by, 1e-9 * by) << row.name;
    EXPECT_NEAR(row.at_error, at_error, 1e-9 * at_error) << row.name;
    EXPECT_EQ(row.than, than);
}

TEST(CostFront, OfOneCurveIsThatCurve) {
    const auto rows = front({{"alone", {0.1, 0.01}, {1, 10}}});
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_EQ(rows[0].name, "alone");
    expect_on_front(rows[0], 0.01);
    EXPECT_TRUE(front({}).empty());
}

TEST(CostFront, AnEvenlyDearerCurveIsSlowerByThatFactor) {
    const auto rows =
        front({{"dear", {1e-1, 1e-2, 1e-3}, {4, 40, 400}}, {"cheap", {1e-1, 1e-2, 1e-3}, {1, 10, 100}}});
    expect_slower(rows[0], 4, 1e-3, "cheap");
    expect_on_front(rows[1], 1e-3);
}

TEST(CostFront, InterpolatesInLogarithms) {
    // The cheap curve costs 1/error: 10^2.5 at 10^-2.5, where the dear one ends.
    const double end = std::pow(10, -2.5);
    const auto rows = front({{"dear", {1e-1, end}, {50, 5000}}, {"cheap", {1e-1, 1e-3}, {10, 1000}}});
    expect_slower(rows[0], 5000 / std::pow(10, 2.5), end, "cheap");
}

TEST(CostFront, ComparesAtTheSmallestErrorThatBothHave) {
    // "dear" goes to 1e-3 and "cheap" only to 1e-2; "sharp" has less error for less from its coarsest run on,
    // so nothing equal can be compared with it.
    const auto rows = front({{"dear", {1e-1, 1e-3}, {100, 10000}},
                             {"cheap", {1e-1, 1e-2}, {1, 2}},
                             {"sharp", {5e-4, 1e-4}, {500, 5000}}});
    expect_slower(rows[0], 1000 / 2.0, 1e-2, "cheap");
    expect_on_front(rows[1], 1e-2);
    expect_on_front(rows[2], 1e-4);
}

TEST(CostFront, AmongSeveralTakesTheCheapest) {
    const std::vector<double> errors{1e-1, 1e-2};
    const auto rows = front(
        {{"c", errors, {9, 90}}, {"b", errors, {3, 30}}, {"a", errors, {1, 10}}, {"b2", errors, {2, 20}}});
    expect_slower(rows[0], 9, 1e-2, "a");
    expect_slower(rows[1], 3, 1e-2, "a");
    expect_on_front(rows[2], 1e-2);
    expect_slower(rows[3], 2, 1e-2, "a");
}

TEST(CostFront, CrossingCurvesAreBothOnIt) {
    // First order 1/e against second order 30 e^{-1/2}: equal at e = 1/900.
    const auto rows =
        front({{"first", {1e-1, 1e-4}, {10, 1e4}}, {"second", {1e-1, 1e-4}, {30 * std::pow(10, 0.5), 3000}}});
    expect_on_front(rows[0], 1.0 / 900);
    expect_on_front(rows[1], 1e-4);
}

TEST(CostFront, HoldsACurveThatLeadsInItsMiddleOnly) {
    const auto rows = front({{"straight", {1e-1, 1e-3}, {10, 1000}}, // 100 at 1e-2
                             {"bend", {1e-1, 1e-2, 1e-3}, {20, 50, 2000}}});
    expect_on_front(rows[0], 1e-3);
    // log10 cost 2 + log10(1/2) + s log10(40) meets 2 + s at s decades below 1e-2.
    const double s = std::log10(2.0) / std::log10(4.0);
    expect_on_front(rows[1], 1e-2 * std::pow(10, -s));
}

TEST(CostFront, FindsALeadThatNoRunShows) {
    // Three straight lines of log10 cost over s = -1 - log10 error; the third is below both others only about
    // the point where these cross, between two errors that anybody ran.
    const auto at = [](double exponent) { return std::pow(10, exponent); };
    const CostCurve steep{"steep", {at(-1), at(-3)}, {at(1), at(4)}};
    const CostCurve flat{"flat", {at(-0.9), at(-1), at(-3)}, {at(2.2), at(2.3), at(2.6)}};
    // 1 + 1.5 s and 2.3 + 0.15 s cross at s = 1.3/1.35, at 2.4444.
    const CostCurve leads{"own", {at(-1), at(-3)}, {at(2.43) / at(0.5), at(2.43) * at(0.5)}};
    // 1.93 + 0.5 s: 2.4115 < 2.4444 at the crossing, 1.93 > 1 at s = 0, 2.93 > 2.6 at s = 2.
    const auto rows = front({steep, flat, leads});
    EXPECT_TRUE(rows[2].on_front);
    // It meets the flat line at s = 0.37/0.35, the smallest error at which it leads.
    EXPECT_NEAR(std::log10(rows[2].at_error), -1 - 0.37 / 0.35, 1e-9);
    // Raised by 0.05 it misses the crossing.
    const CostCurve misses{"own", leads.error, {leads.cost[0] * at(0.05), leads.cost[1] * at(0.05)}};
    const auto missed = front({steep, flat, misses});
    expect_slower(missed[2], at(2.98 - 2.6), at(-3), "flat");
}

TEST(CostFront, AMoreAccurateAndCheaperRunTakesTheFrontWithoutARatio) {
    const auto rows =
        front({{"crude", {1e-1, 1e-2}, {10, 100}}, {"sharp", {1e-4, 1e-5}, {5, 50}}, {"fair", {1e-3}, {7}}});
    EXPECT_FALSE(rows[0].on_front);
    EXPECT_FALSE(rows[0].slower_by.has_value());
    EXPECT_NEAR(rows[0].at_error, 1e-2, 1e-14);
    EXPECT_EQ(rows[0].than, "sharp");
    expect_on_front(rows[1], 1e-5);
    EXPECT_FALSE(rows[2].on_front);
    EXPECT_EQ(rows[2].than, "sharp");
}

TEST(CostFront, BeatingEachRivalSomewhereIsNotBeatingAllAnywhere) {
    // log10 cost over s = -1 - log10 error: own 3 + s/2 is below 1.5 + 1.5 s for s > 1.5, below 2.5 + 1.5 s
    // for s > 0.5 and below 3.4 + 0.1 s for s < 1: never below all three.
    const auto line = [](const char* name, double constant, double slope) {
        return CostCurve{name, {1e-1, 1e-3}, {std::pow(10, constant), std::pow(10, constant + 2 * slope)}};
    };
    const auto rows =
        front({line("a", 1.5, 1.5), line("b", 2.5, 1.5), line("c", 3.4, 0.1), line("own", 3, 0.5)});
    expect_slower(rows[3], std::pow(10, 4 - 3.6), 1e-3, "c");
}

TEST(CostFront, PrefersTheSmallestCommonErrorToTheLargestRatio) {
    const CostCurve own{"own", {1e-1, 1e-3}, {1e4, 1e6}};
    const CostCurve short_one{"short", {1e-1, 1e-2}, {1, 10}};
    const CostCurve long_one{"long", {1e-1, 1e-3}, {1e3, 1e5}};
    expect_slower(front({own, short_one, long_one})[0], 10, 1e-3, "long");
    expect_slower(front({own, long_one, short_one})[0], 10, 1e-3, "long");
}

TEST(CostFront, IsNotSlowerThanADearerCurveNorAtAnErrorItNeverHad) {
    const CostCurve sharp{"sharp", {1e-4}, {5}};
    const auto beside_dearer =
        front({{"own", {1e-1, 1e-2}, {10, 100}}, {"dear", {1e-1, 1e-2}, {20, 200}}, sharp});
    EXPECT_FALSE(beside_dearer[0].on_front);
    EXPECT_FALSE(beside_dearer[0].slower_by.has_value());
    EXPECT_EQ(beside_dearer[0].than, "sharp");
    const auto beside_cruder = front({{"own", {1e-3}, {100}}, {"crude", {1e-1}, {1}}, sharp});
    EXPECT_FALSE(beside_cruder[0].on_front);
    EXPECT_FALSE(beside_cruder[0].slower_by.has_value());
    EXPECT_EQ(beside_cruder[0].than, "sharp");
}

TEST(CostFront, NobodyIsExtrapolatedToSmallerErrors) {
    // By its trend "cheap" would have 1e-3 for 1000, but it was never run there.
    const auto rows = front({{"cheap", {1e-1, 1e-2}, {10, 100}}, {"dear", {1e-2, 1e-3}, {1e5, 1e6}}});
    expect_on_front(rows[0], 1e-2);
    expect_on_front(rows[1], 1e-3);
}

TEST(CostFront, NobodyIsExtrapolatedToLargerErrors) {
    // "sharp" was never run for less than 50, so it has no claim on a large error for 10.
    const auto rows = front({{"crude", {1e-1}, {10}}, {"sharp", {1e-3, 1e-5}, {50, 500}}});
    expect_on_front(rows[0], 1e-1);
    expect_on_front(rows[1], 1e-5);
}

TEST(CostFront, WalksFromCheapToDearAndIgnoresSetbacks) {
    // The second run is dearer and worse than the first; from it on the walk is straight to the third.
    const std::vector<double> error{1e-1, 2e-1, 1e-3};
    const std::vector<double> cost{1, 10, 1000};
    const double fraction = std::log(20.0) / std::log(200.0); // of the way from 2e-1 to 1e-3, at 1e-2
    const auto rows = front({{"probe", {1e-2}, {1e5}}, {"setback", error, cost}});
    expect_slower(rows[0], 1e5 / (10 * std::pow(100, fraction)), 1e-2, "setback");
    expect_on_front(rows[1], 1e-3);
    // At 0.15 the first run does.
    const auto coarse = front({{"probe", {0.15}, {7}}, {"setback", error, cost}});
    expect_slower(coarse[0], 7, 0.15, "setback");
}

TEST(CostFront, DoesNotDependOnTheOrderOfRunsNorOnTheUnitOfCost) {
    const std::vector<CostCurve> curves{{"a", {1e-1, 3e-2, 1e-2}, {2, 9, 70}},
                                        {"b", {2e-1, 3e-2, 1.5e-2}, {3, 9.5, 60}},
                                        {"c", {1e-1, 2e-2}, {50, 500}}};
    auto shuffled = curves;
    for (CostCurve& curve : shuffled) {
        std::reverse(curve.error.begin(), curve.error.end());
        std::reverse(curve.cost.begin(), curve.cost.end());
        for (double& cost : curve.cost) {
            cost *= 1e6;
        }
    }
    const auto rows = front(curves);
    const auto other = front(shuffled);
    for (std::size_t k = 0; k < rows.size(); ++k) {
        EXPECT_EQ(rows[k].on_front, other[k].on_front);
        EXPECT_NEAR(rows[k].at_error, other[k].at_error, 1e-9 * rows[k].at_error);
        EXPECT_EQ(rows[k].than, other[k].than);
        EXPECT_NEAR(rows[k].slower_by.value_or(0), other[k].slower_by.value_or(0), 1e-9);
    }
}

TEST(CostFront, EqualCurvesAreBothOnIt) {
    const auto rows = front({{"a", {1e-1, 1e-2}, {3, 30}}, {"b", {1e-1, 1e-2}, {3, 30}}});
    expect_on_front(rows[0], 1e-2);
    expect_on_front(rows[1], 1e-2);
}

TEST(CostFront, LeavesDivergedRunsOut) {
    const auto rows =
        front({{"partly", {nan_value, 1e-2, infinity}, {1, 10, 100}}, {"wholly", {nan_value}, {1}}});
    expect_on_front(rows[0], 1e-2);
    EXPECT_FALSE(rows[1].on_front);
    EXPECT_FALSE(rows[1].slower_by.has_value());
    EXPECT_TRUE(std::isnan(rows[1].at_error));
    EXPECT_TRUE(rows[1].than.empty());
    EXPECT_FALSE(front({{"none", {}, {}}})[0].on_front);
    // A cheap run that diverged reaches no level, however large.
    EXPECT_FALSE(front({{"partly", {infinity, 1e-2}, {1, 10}}, {"sharp", {1e-2, 1e-3}, {5, 6}}})[0].on_front);
}

TEST(CostFront, RejectsWhatHasNoLogarithm) {
    EXPECT_THROW(front({{"a", {1e-1, 1e-2}, {1}}}), std::invalid_argument);
    EXPECT_THROW(front({{"a", {1e-1}, {1, 2}}}), std::invalid_argument);
    EXPECT_THROW(front({{"a", {0}, {1}}}), std::invalid_argument);
    EXPECT_THROW(front({{"a", {-0.1}, {1}}}), std::invalid_argument);
    for (const double bad : {0.0, -1.0, nan_value, infinity}) {
        EXPECT_THROW(front({{"a", {0.1}, {bad}}}), std::invalid_argument) << bad;
    }
}

/// Cost at a level by exhaustive search over runs and segments, for comparison.
double cost_by_search(const CostCurve& curve, double level) {
    std::vector<std::size_t> by_cost(curve.cost.size());
    std::iota(by_cost.begin(), by_cost.end(), 0U);
    std::sort(by_cost.begin(), by_cost.end(), [&](auto a, auto b) { return curve.cost[a] < curve.cost[b]; });
    double cheapest = infinity;
    for (std::size_t k = 0; k < by_cost.size(); ++k) {
        const double error = curve.error[by_cost[k]];
        const double cost = curve.cost[by_cost[k]];
        if (error <= level) {
            cheapest = std::min(cheapest, cost);
        }
        const double before = k > 0 ? curve.error[by_cost[k - 1]] : error;
        if (before > level && level > error) {
            const double part = std::log(before / level) / std::log(before / error);
            const double start = curve.cost[by_cost[k - 1]];
            cheapest = std::min(cheapest, start * std::pow(cost / start, part));
        }
    }
    return cheapest;
}

bool leads_at(const std::vector<CostCurve>& curves, std::size_t own, double level) {
    const double cost = cost_by_search(curves[own], level);
    bool leads = cost < infinity;
    for (std::size_t rival = 0; rival < curves.size(); ++rival) {
        leads = leads && (rival == own || cost_by_search(curves[rival], level) >= cost * (1 - 1e-9));
    }
    return leads;
}

bool leads_somewhere(const std::vector<CostCurve>& curves, std::size_t own) {
    const auto [low, high] = std::minmax_element(curves[own].error.begin(), curves[own].error.end());
    for (int k = 0; k <= 2000; ++k) {
        if (leads_at(curves, own, *low * std::pow(*high / *low, k / 2000.0))) {
            return true;
        }
    }
    return false;
}

TEST(CostFront, AgreesWithSearchOnRandomCurves) {
    int off = 0;
    for (unsigned seed = 1; seed <= 200; ++seed) {
        std::mt19937_64 engine(seed);
        std::normal_distribution<double> noise(0, 0.6);
        std::uniform_real_distribution<double> offset(0, 1.5);
        std::vector<CostCurve> curves;
        for (int c = 0; c < 4; ++c) {
            CostCurve curve{std::string(1, static_cast<char>('a' + c)), {}, {}};
            const double start = offset(engine);
            for (int k = 0; k < 5; ++k) {
                curve.cost.push_back(std::exp(k + start));
                curve.error.push_back(std::exp(-k + start + noise(engine)));
            }
            curves.push_back(curve);
        }
        const auto rows = front(curves);
        EXPECT_TRUE(std::any_of(rows.begin(), rows.end(), [](const FrontRow& row) { return row.on_front; }))
            << seed;
        for (std::size_t c = 0; c < curves.size(); ++c) {
            const double level = rows[c].at_error * (1 + 1e-12);
            EXPECT_EQ(rows[c].on_front, leads_at(curves, c, level)) << seed << ' ' << c;
            EXPECT_TRUE(rows[c].on_front || !leads_somewhere(curves, c)) << seed << ' ' << c;
            if (rows[c].slower_by) {
                const auto rival = static_cast<std::size_t>(rows[c].than[0] - 'a');
                const double ratio = cost_by_search(curves[c], level) / cost_by_search(curves[rival], level);
                EXPECT_NEAR(*rows[c].slower_by, ratio, 1e-6 * ratio) << seed << ' ' << c;
                EXPECT_GT(*rows[c].slower_by, 1);
                ++off;
            }
        }
    }
    EXPECT_GT(off, 100);
}

} // namespace
