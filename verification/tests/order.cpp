#include "sphvv/verification/order.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace sphvv::verification;
using Errors = std::vector<double>;

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

// Percentiles of Student's t from printed tables (two-sided 95 %).
constexpr double t2 = 4.302653;
constexpr double t3 = 3.182446;
constexpr double t4 = 2.776445;

const Expected second_order{1.8, 2.2, "synthetic"};
const Expected first_to_second{0.9, 2.0, "synthetic"};

/// h = 1, 1/2, 1/4, …
std::vector<Rung> halved(const Errors& errors) {
    std::vector<Rung> rungs;
    for (std::size_t k = 0; k < errors.size(); ++k) {
        rungs.push_back({std::ldexp(1, -static_cast<int>(k)), {errors[k]}});
    }
    return rungs;
}

std::vector<Rung> law(int rungs, const std::function<double(double)>& error) {
    Errors errors;
    for (int k = 0; k < rungs; ++k) {
        errors.push_back(error(std::ldexp(1, -k)));
    }
    return halved(errors);
}

std::vector<Rung> from_orders(double coarsest, const Errors& orders) {
    Errors errors{coarsest};
    for (const double order : orders) {
        errors.push_back(errors.back() * std::exp2(-order));
    }
    return halved(errors);
}

void expect_verdict(const Judgement& judgement, Verdict verdict, const std::string& reason) {
    EXPECT_EQ(judgement.verdict, verdict) << judgement.reason;
    EXPECT_NE(judgement.reason.find(reason), std::string::npos) << judgement.reason;
}

void expect_starts(const Judgement& judgement, Verdict verdict, const std::string& reason) {
    EXPECT_EQ(judgement.verdict, verdict) << judgement.reason;
    EXPECT_EQ(judgement.reason.find(reason), 0U) << judgement.reason;
}

TEST(Verdict, IsPrintedInCapitals) {
    EXPECT_EQ(to_string(Verdict::pass), "PASS");
    EXPECT_EQ(to_string(Verdict::fail), "FAIL");
    EXPECT_EQ(to_string(Verdict::inconclusive), "INCONCLUSIVE");
}

TEST(FitOrder, RecoversPowerLaws) {
    for (const double p : {-2.0, -1.0, -0.5, 0.0, 1.0, 1.5, 2.0, 4.0, 6.0}) {
        std::vector<Rung> rungs;
        for (const double h : {0.3, 0.17, 0.1, 0.045, 0.02}) {
            rungs.push_back({h, {0.7 * std::pow(h, p)}});
        }
        const auto fit = fit_order(rungs);
        EXPECT_NEAR(fit.order, p, 1e-12);
        EXPECT_NEAR(fit.ci95, 0, 1e-12);
        EXPECT_EQ(fit.seed_ci95, 0);
        ASSERT_EQ(fit.pairwise.size(), 5U);
        EXPECT_TRUE(std::isnan(fit.pairwise[0]));
        for (std::size_t k = 1; k < 5; ++k) {
            EXPECT_NEAR(fit.pairwise[k], p, 1e-12);
        }
    }
}

// Residuals a(1, -3, 3, -1) in log2 e leave mean and slope untouched; their sum of squares is 20 a^2, that of
// x is 5.
TEST(FitOrder, IntervalOfFourRungsIsStudents) {
    const double a = 0.05;
    const auto rungs =
        halved({std::exp2(a), std::exp2(-2 - 3 * a), std::exp2(-4 + 3 * a), std::exp2(-6 - a)});
    const auto fit = fit_order(rungs);
    EXPECT_NEAR(fit.order, 2, 1e-12);
    EXPECT_NEAR(fit.ci95, t2 * std::sqrt(20 * a * a / 2 / 5), 1e-7);
    EXPECT_NEAR(fit.pairwise[1], 2 + 4 * a, 1e-12);
    EXPECT_NEAR(fit.pairwise[2], 2 - 6 * a, 1e-12);
    EXPECT_NEAR(fit.pairwise[3], 2 + 4 * a, 1e-12);
    expect_verdict(judge(rungs, {1.8, 2.2, ""}), Verdict::pass, "order 2.00 ± 0.30");
}

// Residuals a(2, -1, -2, -1, 2): sum of squares 14 a^2, that of x is 10.
TEST(FitOrder, IntervalOfFiveRungsIsStudents) {
    const double a = 0.1;
    const auto fit = fit_order(halved({std::exp2(2 * a), std::exp2(-1 - a), std::exp2(-2 - 2 * a),
                                       std::exp2(-3 - a), std::exp2(-4 + 2 * a)}));
    EXPECT_NEAR(fit.order, 1, 1e-12);
    EXPECT_NEAR(fit.ci95, t3 * std::sqrt(14 * a * a / 3 / 10), 1e-7);
}

TEST(FitOrder, LeavesTwoRungsWithoutInterval) {
    const auto fit = fit_order(halved({4, 1}));
    EXPECT_NEAR(fit.order, 2, 1e-12);
    EXPECT_EQ(fit.ci95, infinity);
}

TEST(FitOrder, SortsFromCoarseToFine) {
    const std::vector<Rung> rungs{{0.25, {1}}, {1, {8}}, {0.5, {3}}, {2, {30}}};
    const auto fit = fit_order(rungs);
    EXPECT_GT(fit.order, 0);
    EXPECT_NEAR(fit.pairwise[1], std::log2(30.0 / 8), 1e-12);
    EXPECT_NEAR(fit.pairwise[3], std::log2(3.0), 1e-12);
    EXPECT_EQ(judge(rungs, second_order).fit->pairwise[1], fit.pairwise[1]);
}

TEST(FitOrder, TakesTheMeanOfLogarithmsOverSeeds) {
    // Geometric means 16, 4, 1, so that arithmetic ones would read another order.
    const std::vector<Rung> rungs{{4, {16, 16}}, {2, {1, 16}}, {1, {1, 1}}};
    const auto fit = fit_order(rungs);
    EXPECT_NEAR(fit.order, 2, 1e-12);
    EXPECT_NEAR(fit.ci95, 0, 1e-12);
    EXPECT_EQ(fit.spread[0], 0);
    EXPECT_NEAR(fit.spread[1], std::log(16.0) / std::sqrt(2.0), 1e-12);
}

TEST(FitOrder, SeedsAreNotExtraRungs) {
    // Two rungs of many seeds still have no degree of freedom.
    EXPECT_EQ(fit_order(std::vector<Rung>{{2, {4, 4.1, 3.9}}, {1, {1, 1.1, 0.9}}}).ci95, infinity);
}

TEST(FitOrder, SeedIntervalIsStudents) {
    // Two seeds e^{±s} a rung: variance of each mean s^2; weights -3, -1, 1, 3 over 10 log 2; 4 degrees of
    // freedom.
    const double s = 0.1;
    std::vector<Rung> rungs;
    for (int k = 0; k < 4; ++k) {
        const double error = std::ldexp(1, -2 * k);
        rungs.push_back({std::ldexp(1, -k), {error * std::exp(s), error * std::exp(-s)}});
    }
    const auto fit = fit_order(rungs);
    EXPECT_NEAR(fit.order, 2, 1e-12);
    EXPECT_NEAR(fit.spread[2], s * std::sqrt(2.0), 1e-12);
    EXPECT_NEAR(fit.seed_ci95, t4 * s * std::sqrt(20.0) / (10 * std::log(2.0)), 1e-7);
}

TEST(FitOrder, RejectsWhatIsNotALadder) {
    EXPECT_THROW(fit_order(halved({})), std::invalid_argument);
    EXPECT_THROW(fit_order(halved({1})), std::invalid_argument);
    EXPECT_THROW(fit_order(halved({1, 0, 0.1})), std::invalid_argument);
    EXPECT_THROW(fit_order(halved({1, -0.5, 0.1})), std::invalid_argument);
    EXPECT_THROW(fit_order(halved({1, nan_value, 0.1})), std::invalid_argument);
    for (const double h : {0.0, -1.0, 0.5, nan_value, infinity}) {
        const std::vector<Rung> rungs{{1, {1}}, {0.5, {0.25}}, {h, {0.1}}};
        EXPECT_THROW(fit_order(rungs), std::invalid_argument) << h;
        EXPECT_THROW(judge(rungs, second_order), std::invalid_argument) << h;
    }
    const std::vector<Rung> no_error{{1, {1}}, {0.5, {}}};
    EXPECT_THROW(fit_order(no_error), std::invalid_argument);
    EXPECT_THROW(judge(no_error, second_order), std::invalid_argument);
}

TEST(Judge, RejectsABandThatIsNone) {
    const auto rungs = from_orders(1, {2, 2, 2});
    EXPECT_THROW(judge(rungs, {std::nullopt, std::nullopt, ""}), std::invalid_argument);
    EXPECT_THROW(judge(rungs, {2.2, 1.8, ""}), std::invalid_argument);
    EXPECT_THROW(judge(rungs, {nan_value, 1.8, ""}), std::invalid_argument);
    EXPECT_THROW(judge(rungs, {1.8, nan_value, ""}), std::invalid_argument);
}

TEST(Judge, PassesTheExpectedOrder) {
    for (const double p : {-2.0, -1.0, 0.0, 1.0, 2.0, 4.0}) {
        const auto rungs = from_orders(0.1, {p, p, p});
        expect_verdict(judge(rungs, {p - 0.2, p + 0.2, ""}), Verdict::pass, "inside");
        expect_verdict(judge(rungs, {p, p, ""}), Verdict::pass, "inside");
        expect_verdict(judge(rungs, {p - 0.2, std::nullopt, ""}), Verdict::pass, "inf)");
        expect_verdict(judge(rungs, {std::nullopt, p + 0.2, ""}), Verdict::pass, "(-inf");
    }
}

TEST(Judge, FailsAnotherOrder) {
    for (const double p : {-2.0, -1.0, 0.0, 1.0, 2.0, 4.0}) {
        const auto rungs = from_orders(0.1, {p, p, p});
        expect_verdict(judge(rungs, {p + 0.1, p + 1, ""}), Verdict::fail,
                       "order " + std::to_string(p).substr(0, 3));
        expect_verdict(judge(rungs, {p - 1, p - 0.1, ""}), Verdict::fail, "wholly outside");
        expect_verdict(judge(rungs, {p + 0.1, std::nullopt, ""}), Verdict::fail, "wholly outside");
        expect_verdict(judge(rungs, {std::nullopt, p - 0.1, ""}), Verdict::fail, "wholly outside");
    }
}

TEST(Judge, FailsFirstOrderWhereSecondIsExpected) {
    expect_verdict(judge(from_orders(0.1, {1, 1, 1}), second_order), Verdict::fail, "order 1.00 ± 0.00");
}

TEST(Judge, FailsAConstantError) {
    expect_verdict(judge(halved({0.3, 0.3, 0.3, 0.3}), second_order), Verdict::fail, "order 0.00");
}

// House fault 11: half of the kinetic energy missing at every rung is a velocity error of 1 - sqrt(1/2), plus
// the scheme's own.
TEST(Judge, FailsAFieldThatMissesHalfOfItsKineticEnergy) {
    const double missing = 1 - std::sqrt(0.5);
    const auto rungs = law(5, [&](double h) { return missing + 0.1 * h * h / 100; });
    expect_verdict(judge(rungs, second_order), Verdict::fail, "order 0.00");
    expect_verdict(judge(rungs, first_to_second), Verdict::fail, "order 0.00");
}

TEST(Judge, IsInconclusiveWhereTheIntervalReachesTheBand) {
    // Orders 2, 1.6, 2, 1.6: slope 1.8 ± 0.16 against [1.85, 2.2]; then against [1.75, 2.2] only the finest
    // is out.
    const auto rungs = from_orders(1, {2, 1.6, 2, 1.6});
    expect_verdict(judge(rungs, {1.85, 2.2, ""}), Verdict::inconclusive, "its interval is not");
    expect_verdict(judge(rungs, {1.75, 2.2, ""}), Verdict::inconclusive,
                   "finest pairwise order 1.60 is outside");
    expect_verdict(judge(rungs, {1.5, 2.2, ""}), Verdict::pass, "order 1.80");
    expect_verdict(judge(rungs, {1.0, 1.75, ""}), Verdict::inconclusive, "its interval is not");
}

TEST(Judge, NeedsSlopeAsWellAsFinestPairInside) {
    const auto rungs = from_orders(1, {1.6, 2, 1.6, 2});
    expect_verdict(judge(rungs, {1.85, 2.2, ""}), Verdict::inconclusive, "order 1.80");
}

// House fault 13: a ladder too short to decide.
TEST(Judge, IsInconclusiveForFewRungs) {
    expect_starts(judge(halved({1, 0.25, 0.0625}), second_order), Verdict::inconclusive,
                  "3 rungs: an order verdict needs 4");
    expect_starts(judge(halved({1, 0.25}), second_order), Verdict::inconclusive, "2 rungs:");
    expect_starts(judge(halved({1}), second_order), Verdict::inconclusive, "1 rung:");
    expect_starts(judge(halved({}), second_order), Verdict::inconclusive, "0 rungs:");
    EXPECT_TRUE(judge(halved({1, 0.25}), second_order).fit.has_value());
    EXPECT_FALSE(judge(halved({1}), second_order).fit.has_value());
}

TEST(Judge, IsInconclusiveForANarrowLadder) {
    const auto narrow = [](double finest) {
        std::vector<Rung> rungs;
        for (const double h : {1.0, 0.7, 0.4, finest}) {
            rungs.push_back({h, {h * h}});
        }
        return rungs;
    };
    expect_starts(judge(narrow(1 / 3.9), second_order), Verdict::inconclusive, "h spans a factor 3.9");
    EXPECT_EQ(judge(narrow(0.25), second_order).verdict, Verdict::pass);
    EXPECT_EQ(judge(narrow(0.25 * (1 + 1e-12)), second_order).verdict, Verdict::pass);
}

TEST(Judge, IsInconclusiveForAnErrorThatIsNone) {
    for (const double bad : {nan_value, infinity, -0.01}) {
        const auto judgement = judge(halved({1, 0.25, bad, 1.0 / 64}), second_order);
        expect_verdict(judgement, Verdict::inconclusive, "h = 0.25 is");
        EXPECT_FALSE(judgement.fit.has_value());
    }
    const std::vector<Rung> one_seed{
        {1, {1, 1}}, {0.5, {0.25, nan_value}}, {0.25, {0.06, 0.06}}, {0.1, {0.01, 0.01}}};
    expect_verdict(judge(one_seed, second_order), Verdict::inconclusive, "h = 0.5 is nan");
}

TEST(Judge, NamesRoundOff) {
    // Nothing else in the ladder; also zero throughout.
    expect_starts(judge(halved({2e-15, 1e-15, 3e-15, 8e-16}), second_order), Verdict::inconclusive,
                  "round-off");
    expect_starts(judge(halved({0, 0, 0, 0}), second_order), Verdict::inconclusive, "round-off");
    expect_starts(judge(halved({0, 0}), second_order), Verdict::inconclusive, "round-off");
    // Perfect second order of errors that mean nothing.
    expect_starts(judge(from_orders(9e-13, {2, 2, 2}), second_order), Verdict::inconclusive, "round-off");
    // Reached at the fine end; grown there, as of a Laplacian whose round-off is that of 1/h^2; an exact
    // zero.
    expect_starts(judge(halved({1e-4, 4e-7, 1.5e-9, 6e-12, 3e-14, 3e-14}), {7.5, 8.5, ""}),
                  Verdict::inconclusive, "round-off: the error at h = 0.0312 is 3e-14");
    expect_starts(judge(from_orders(5e-13, {-2, -2, -2}), second_order), Verdict::inconclusive, "round-off");
    expect_starts(judge(halved({1, 0.25, 0, 1.0 / 64}), second_order), Verdict::inconclusive,
                  "round-off: the error at h = 0.25 is 0");
    // Round-off passes for no order, not even zero.
    expect_starts(judge(halved({5e-13, 5e-13, 5e-13, 5e-13}), {-0.2, 0.2, ""}), Verdict::inconclusive,
                  "round-off");
}

TEST(Judge, DoesNotTakeAHighOrderForRoundOff) {
    EXPECT_EQ(judge(from_orders(5e-10, {2, 2, 2}), second_order).verdict, Verdict::pass);
    // The finest error is 2e-13, on the line.
    EXPECT_EQ(judge(from_orders(1e-2, {8.9, 8.9, 8.9, 8.9}), {8.5, 9.5, ""}).verdict, Verdict::pass);
}

TEST(Judge, NamesAFloor) {
    for (const double floor : {0.01, 0.03, 0.1}) {
        expect_starts(judge(law(5, [&](double h) { return h * h + floor; }), second_order),
                      Verdict::inconclusive, "floor: the pairwise order falls from 1.");
    }
    // The dip above it, where smoothing and quadrature error cancel, and a floor that is not exactly flat.
    expect_starts(judge(from_orders(1, {2, 2.1, 3.5, 0.2}), second_order), Verdict::inconclusive,
                  "floor: the pairwise order falls from 3.50 to 0.20");
    expect_starts(judge(from_orders(1, {2, 0.5, 0.01, -0.01, 0.01}), second_order), Verdict::inconclusive,
                  "floor: the pairwise order falls from 2.00 to 0.01");
    expect_starts(judge(from_orders(1, {1.9, 0.4, 0.1}), second_order), Verdict::inconclusive, "floor");
}

TEST(Judge, AFloorBelowAConvergingErrorNeitherPassesNorFails) {
    for (int power = -12; power < 0; ++power) {
        for (const int rungs : {4, 5, 6, 8}) {
            const double floor = std::exp(power);
            const auto ladder = law(rungs, [&](double h) { return h * h + floor; });
            const auto judgement = judge(ladder, second_order);
            const double coarsest = judgement.fit->pairwise[1];
            const double finest = judgement.fit->pairwise.back();
            if (coarsest > 0.5 && finest < 1.5) {
                EXPECT_EQ(judgement.verdict, Verdict::inconclusive)
                    << floor << ' ' << rungs << judgement.reason;
            }
        }
    }
}

TEST(Judge, AFloorThatIsExpectedPasses) {
    expect_verdict(judge(from_orders(0.014, {0.1, 0.05, -0.02, 0.01}), {-0.2, 0.2, ""}), Verdict::pass,
                   "inside");
}

TEST(Judge, AnOrderThatComesBackIsNotAFloor) {
    expect_starts(judge(from_orders(1, {2, 0.2, 0.9}), second_order), Verdict::inconclusive, "noise");
}

TEST(Judge, GrowthAfterConvergenceIsNotAFloor) {
    expect_starts(judge(from_orders(1, {1, 0, -0.9}), {-1.2, -0.8, ""}), Verdict::inconclusive,
                  "pre-asymptotic");
}

TEST(Judge, NamesThePreAsymptoticRange) {
    expect_starts(judge(from_orders(1, {0.9, 1.4, 1.7, 1.9}), second_order), Verdict::inconclusive,
                  "pre-asymptotic: the pairwise order drifts from 0.90 to 1.90");
    expect_starts(judge(from_orders(1, {2, 1.7, 1.4}), second_order), Verdict::inconclusive,
                  "pre-asymptotic: the pairwise order drifts from 2.00 to 1.40");
    // Not enough of a drift: the interval and the finest pair decide.
    EXPECT_EQ(judge(from_orders(1, {1.75, 1.9, 2.0, 2.0}), second_order).verdict, Verdict::pass);
    expect_verdict(judge(from_orders(1, {1.4, 1.3, 1.1}), second_order), Verdict::fail, "order 1.27");
}

TEST(Judge, ACrossoverInsideItsBandPasses) {
    const auto crossover = law(5, [](double h) { return 0.1 * h + 0.3 * h * h; });
    expect_verdict(judge(crossover, first_to_second), Verdict::pass, "inside [0.9, 2]");
    // A drift whose curvature alone widens the interval beyond 0.5.
    const auto wide = judge(from_orders(1, {2, 1.5, 0.95}), first_to_second);
    expect_verdict(wide, Verdict::pass, "inside");
    EXPECT_GT(wide.fit->ci95, 0.5);
    // Half of the largest order is reached inside the band: no floor.
    EXPECT_EQ(judge(from_orders(1, {2, 1.5, 1.2, 0.95}), first_to_second).verdict, Verdict::pass);
    // One pair outside, and it is a drift again.
    expect_starts(judge(from_orders(1, {2.1, 1.5, 1.2, 1.1}), first_to_second), Verdict::inconclusive,
                  "pre-asymptotic");
}

TEST(Judge, PassesTheMeasuredFirstOrderLadder) {
    const auto judgement = judge(halved({6.8e-2, 2.7e-2, 1.5e-2, 6.5e-3}), first_to_second);
    expect_starts(judgement, Verdict::pass, "order 1.10 ± 0.27 and finest pairwise order 1.21");
}

TEST(Judge, NamesNoise) {
    expect_starts(judge(from_orders(1, {2, 1, 3}), second_order), Verdict::inconclusive,
                  "noise: the 95 % interval ±");
    // Noise is none the better for staying inside a wide band.
    expect_starts(judge(from_orders(1, {0.95, 1.95, 0.95}), first_to_second), Verdict::inconclusive, "noise");
}

// House fault 1: the mean of these pairwise orders is 2 whatever the middle rung says.
TEST(Judge, ABrokenMiddleRungNeverPasses) {
    for (const std::size_t rungs : {4U, 5U, 6U, 8U, 10U}) {
        for (std::size_t broken = 1; broken + 1 < rungs; ++broken) {
            for (const double factor : {0.05, 0.25, 0.5, 2.0, 4.0, 20.0}) {
                Errors errors;
                for (std::size_t k = 0; k < rungs; ++k) {
                    errors.push_back(std::ldexp(0.1, -2 * static_cast<int>(k)));
                }
                errors[broken] *= factor;
                const auto judgement = judge(halved(errors), second_order);
                EXPECT_EQ(judgement.verdict, Verdict::inconclusive)
                    << rungs << ' ' << broken << ' ' << factor << ' ' << judgement.reason;
            }
        }
    }
}

TEST(Judge, NamesTheRungOffTheLine) {
    Errors errors;
    for (int k = 0; k < 8; ++k) {
        errors.push_back(std::ldexp(0.1, -2 * k));
    }
    errors[4] *= 2;
    expect_verdict(judge(halved(errors), second_order), Verdict::inconclusive,
                   "the error at h = 0.0625 is a factor 1.8");
}

std::vector<Rung> seeded(const Errors& orders, double spread) {
    auto rungs = from_orders(0.1, orders);
    for (Rung& rung : rungs) {
        const double error = rung.errors.front();
        rung.errors.clear();
        for (const double deviation : {-2.0, -1.0, 0.0, 1.0, 2.0}) {
            rung.errors.push_back(error * std::exp(deviation * spread / std::sqrt(2.5)));
        }
    }
    return rungs;
}

TEST(Judge, SeedsOfSmallSpreadDoNotChangeTheVerdict) {
    const auto judgement = judge(seeded({2, 2, 2}, 0.1), second_order);
    expect_verdict(judgement, Verdict::pass, "order 2.00 ± 0.00");
    EXPECT_NEAR(judgement.fit->spread[0], 0.1, 1e-12);
    expect_verdict(judge(seeded({1, 1, 1}, 0.1), second_order), Verdict::fail, "order 1.00");
    expect_starts(judge(seeded({1.9, 1.2, 0.3}, 0.05), second_order), Verdict::inconclusive, "floor");
    expect_starts(judge(seeded({1.2, 1.6, 1.9}, 0.05), second_order), Verdict::inconclusive,
                  "pre-asymptotic");
}

TEST(Judge, AStraightMeanOfScatteredSeedsIsNoise) {
    expect_starts(judge(seeded({2, 2, 2}, 1.0), second_order), Verdict::inconclusive,
                  "noise: the 95 % interval of the seeds ±");
}

// A drift from 1.2 to 1.9 is judged against what the seeds may cause: the variance of each mean is s^2/5,
// four means enter, 16 degrees of freedom (t = 2.1199), pairs log 2 apart.
TEST(Judge, ADriftWithinTheSeedSpreadIsNoise) {
    const double decisive = 0.7 * std::log(2.0) / (2.1199 * std::sqrt(4.0 / 5));
    expect_starts(judge(seeded({1.2, 1.6, 1.9}, 1.01 * decisive), second_order), Verdict::inconclusive,
                  "noise: the pairwise order drifts from 1.20 to 1.90");
    expect_starts(judge(seeded({1.2, 1.6, 1.9}, 0.99 * decisive), second_order), Verdict::inconclusive,
                  "pre-asymptotic");
}

// A fall from the second pair (1.6) to the third (0.7): the rung they share enters twice, so 1 + 4 + 1
// variances.
TEST(Judge, AFloorWithinTheSeedSpreadIsNotNamedOne) {
    const double decisive = 0.9 * std::log(2.0) / (2.1199 * std::sqrt(6.0 / 5));
    const auto floor = [](double spread) { return judge(seeded({1.5, 1.6, 0.7}, spread), second_order); };
    expect_starts(floor(0.99 * decisive), Verdict::inconclusive, "floor");
    expect_starts(floor(1.01 * decisive), Verdict::inconclusive, "noise");
}

// Truly second-order ladders with 5 % of seeded noise: never FAIL against the truth, never PASS against
// another order.
TEST(Judge, IsRightOnRandomLadders) {
    int passed = 0;
    for (unsigned seed = 1; seed <= 500; ++seed) {
        std::mt19937_64 engine(seed);
        std::normal_distribution<double> noise(0, 0.05);
        const auto rungs = law(5, [&](double h) { return 0.1 * h * h * std::exp(noise(engine)); });
        const auto judgement = judge(rungs, second_order);
        EXPECT_NE(judgement.verdict, Verdict::fail) << seed << ' ' << judgement.reason;
        passed += judgement.verdict == Verdict::pass ? 1 : 0;
        EXPECT_NE(judge(rungs, {0.8, 1.2, ""}).verdict, Verdict::pass) << seed;
    }
    EXPECT_GT(passed, 450);
}

// The 95 % interval holds the truth 95 times in 100: 1.96 sqrt(0.95 × 0.05/2000) = 0.0096.
TEST(FitOrder, IntervalCoversTheTruthAsOftenAsItSays) {
    std::mt19937_64 engine(2024);
    std::normal_distribution<double> noise(0, 0.1);
    int covered = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        const auto fit = fit_order(law(4, [&](double h) { return h * std::exp(noise(engine)); }));
        covered += std::abs(fit.order - 1) <= fit.ci95 ? 1 : 0;
    }
    EXPECT_NEAR(covered / 2000.0, 0.95, 0.015);
}

} // namespace
