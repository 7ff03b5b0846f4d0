#include "sphvv/verification/stability.hpp"

#include "sphvv/solver/error.hpp"
#include "sphvv/solver/schemes.hpp"
#include "sphvv/verification/linearised_step.hpp"
#include "sphvv/verification/scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace sphvv::verification {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

StabilityLimit limit_with(double theory, double measured) {
    StabilityLimit limit{};
    limit.theory = theory;
    limit.measured = measured;
    limit.low = 0.95;
    limit.high = 1.05;
    judge(limit);
    return limit;
}

TEST(StabilityLimits, PassWithinFivePerCentOfTheory) {
    EXPECT_EQ(limit_with(2, 2.09).verdict, "PASS");
    EXPECT_EQ(limit_with(2, 2.11).verdict, "FAIL");
    EXPECT_EQ(limit_with(2, 1.89).verdict, "FAIL");
    EXPECT_EQ(limit_with(2, infinity).verdict, "FAIL");
    EXPECT_EQ(limit_with(2, 0).verdict, "FAIL");
    EXPECT_EQ(limit_with(infinity, infinity).verdict, "PASS");
    EXPECT_EQ(limit_with(infinity, 2).verdict, "FAIL");
    EXPECT_EQ(limit_with(0, 0).verdict, "PASS");
    EXPECT_EQ(limit_with(0, 1).verdict, "FAIL");
    EXPECT_EQ(limit_with(std::nan(""), 1).verdict, "FAIL");
    EXPECT_EQ(limit_with(1, std::nan("")).verdict, "FAIL");
}

// In a strained flow theory is a bound: anything from the published step to the fold will do.
TEST(StabilityLimits, HaveBandsOfTheirOwn) {
    for (const auto& [measured, verdict] :
         {std::pair{0.9, "FAIL"}, {1., "PASS"}, {12., "PASS"}, {12.1, "FAIL"}, {infinity, "FAIL"}}) {
        StabilityLimit limit{};
        limit.theory = 12;
        limit.low = 1. / 12;
        limit.high = 1.005;
        limit.measured = measured;
        judge(limit);
        EXPECT_EQ(limit.verdict, verdict) << measured;
    }
}

TEST(StabilityMaps, CountThePointsThatTheoryMisses) {
    StabilityMap map{};
    map.x = {1, 2};
    map.y = {1, 2};
    map.theory = {1, 1.003, 1.5, 1.5};
    map.grows = {0, 0, 1, 1};
    judge(map);
    EXPECT_EQ(map.verdict, "PASS");
    EXPECT_EQ(map.undecided, 1);
    map.grows = {1, 0, 1, 0};
    judge(map);
    EXPECT_EQ(map.verdict, "FAIL");
    EXPECT_EQ(map.disagreements, 2);
    StabilityResults results;
    results.maps.push_back(map);
    EXPECT_EQ(exit_status(results), 1);
}

TEST(StabilityMaps, AreInconclusiveWhereMostPointsGrowTooSlowlyToTell) {
    StabilityMap map{};
    map.x = {1, 2, 3};
    map.y = {1};
    map.theory = {1.003, 1.003, 1.5};
    map.grows = {0, 1, 1};
    judge(map);
    EXPECT_EQ(map.verdict, "INCONCLUSIVE");
    map.grows = {0, 1, 0};
    judge(map);
    EXPECT_EQ(map.verdict, "FAIL");
}

// Just below and above the limit of theory the solver's disturbances keep and grow: the rate is that of
// theory, too.
TEST(Disturbances, GrowBeyondTheLimitAtTheRateOfTheory) {
    for (const char* scheme :
         {"wcsph:background_pressure=0", "wcsph:background_pressure=0:viscosity=monaghan_cleary"}) {
        const LatticeScene scene{.scheme = scheme, .viscosity = 0.2};
        const LatticeState state = lattice_state(scene).value();
        const double limit = stability_limit(state, Stepping::explicit_euler, 1e-4, 16);
        ASSERT_GT(limit, 1e-4);
        EXPECT_FALSE(disturb(scene, 0.98 * limit).grows) << scheme;
        const Disturbance grown = disturb(scene, 1.02 * limit);
        EXPECT_TRUE(grown.grows) << scheme;
        EXPECT_NEAR(std::log(grown.growth),
                    std::log(growth_factor(state, Stepping::explicit_euler, 1.02 * limit, 16)),
                    0.15 * std::log(grown.growth))
            << scheme;
    }
    const Disturbance far = disturb({.scheme = "wcsph"}, 1);
    EXPECT_TRUE(far.grows);
}

TEST(StabilityStudies, HaveNamesOfTheirOwnAndSchemesThatTheyTake) {
    std::set<std::string> names;
    for (const StabilityStudy& study : stability_studies()) {
        EXPECT_TRUE(names.insert(study.name).second) << study.name;
        EXPECT_FALSE(study.schemes.empty());
        for (const std::string& scheme : study.schemes) {
            EXPECT_NO_THROW(check_scheme(study, scheme)) << scheme;
        }
    }
}

TEST(StabilityStudies, TakeEverySchemeInTheQuickTier) {
    std::set<std::string_view> taken;
    for (const StabilityStudy& study : stability_studies()) {
        for (const std::string& scheme : study.schemes) {
            if (study.tier == Tier::quick) {
                taken.insert(variant_of(scheme).scheme->name);
            }
        }
    }
    for (const solver::Scheme* scheme : solver::schemes::all()) {
        EXPECT_TRUE(taken.contains(scheme->name)) << scheme->name;
    }
}

TEST(StabilityStudies, RefuseWhatHasNoSuchLimit) {
    const auto study = [](const char* name) {
        return *std::ranges::find(stability_studies(), name, &StabilityStudy::name);
    };
    EXPECT_THROW(check_scheme(study("stability/acoustic"), "isph_df"), UserError);
    EXPECT_THROW(check_scheme(study("stability/pairing_map"), "isph_df"), UserError);
    EXPECT_THROW(check_scheme(study("stability/advective"), "wcsph"), UserError);
    EXPECT_THROW(check_scheme(study("stability/viscous"), "wcsph:colour=red"), UserError);
    EXPECT_THROW(check_scheme(study("stability/viscous"), "sph"), UserError);
    EXPECT_NO_THROW(check_scheme(study("stability/viscous"), "isph_mls"));
}

TEST(LatticeSums, CoverTheirOwnFormsOnly) {
    for (const char* scheme : {"isph_mls", "isph_di", "wcsph:pressure_force=taylor",
                               "wcsph:continuity=renormalised", "isph_dfs:laplacian=schwaiger"}) {
        EXPECT_FALSE(lattice_state({.scheme = scheme})) << scheme;
    }
    EXPECT_TRUE(lattice_state({.scheme = "isph_dfs"}));
    EXPECT_FALSE(lattice_state({.scheme = "isph_dfs", .speed = 1})) << "shifts move it";
}

// A scheme of which theory is the linearised step: the run agrees on both sides of its limit.
TEST(Disturbances, GrowBeyondTheLimitOfTheLinearisedStep) {
    const LatticeScene scene{.scheme = "isph_di", .viscosity = 1};
    const double unit = scene.dx() * scene.dx();
    const double limit = linearised_limit(scene, 0.1 * unit, 10 * unit);
    EXPECT_FALSE(disturb(scene, 0.98 * limit).grows);
    EXPECT_TRUE(disturb(scene, 1.02 * limit).grows);
}

// Shifts drive a square lattice in a stream apart; without them a displaced particle stays displaced.
TEST(Disturbances, OfALatticeThatMovesAreDisplacements) {
    const double dt = 0.05;
    EXPECT_FALSE(disturb({.scheme = "isph_df", .speed = 1}, dt).grows);
    EXPECT_TRUE(disturb({.scheme = "isph_dfs", .speed = 1}, dt).grows);
    EXPECT_FALSE(disturb({.scheme = "isph_df", .body_force = 1}, dt).grows);
}

TEST(StabilityResults, StandInTheDocument) {
    StabilityResults results;
    results.limits.push_back(limit_with(infinity, 2));
    StabilityMap map{};
    map.x = {1};
    map.y = {1};
    map.theory = {1};
    map.measured = {infinity};
    map.grows = {1};
    map.criterion = "w'' p < 0";
    map.by_criterion = {0};
    judge(map);
    results.maps.push_back(map);
    nlohmann::ordered_json document;
    add_to_document(results, document);
    EXPECT_TRUE(document["stability_limits"][0]["theory"].is_null());
    EXPECT_EQ(document["stability_limits"][0]["measured"], 2);
    EXPECT_EQ(document["stability_limits"][0]["high"], 1.05);
    EXPECT_EQ(document["stability_maps"][0]["by_criterion"][0], 0);
    EXPECT_TRUE(document["stability_maps"][0]["measured"][0].is_null());
    EXPECT_EQ(document.dump().find("nan"), std::string::npos);
    EXPECT_NE(markdown(results).find("(!)"), std::string::npos);
}

} // namespace
} // namespace sphvv::verification
