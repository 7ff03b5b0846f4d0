#include "sphvv/verification/stability.hpp"

#include "sphvv/solver/error.hpp"

#include <gtest/gtest.h>

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

// Just below and above the limit of theory the solver's disturbances keep and grow: the rate is that of
// theory, too.
TEST(Disturbances, GrowBeyondTheLimitAtTheRateOfTheory) {
    for (const char* scheme :
         {"wcsph:background_pressure=0", "wcsph:background_pressure=0:viscosity=monaghan_cleary"}) {
        const LatticeScene scene{.scheme = scheme, .viscosity = 0.2};
        const LatticeState state = lattice_state(scene);
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

TEST(StabilityStudies, HaveNamesOfTheirOwnAndSchemesThatTheTheoryCovers) {
    std::set<std::string> names;
    for (const StabilityStudy& study : stability_studies()) {
        EXPECT_TRUE(names.insert(study.name).second) << study.name;
        EXPECT_FALSE(study.schemes.empty());
        for (const std::string& scheme : study.schemes) {
            EXPECT_NO_THROW(lattice_state({.scheme = scheme})) << scheme;
        }
    }
}

TEST(StabilityStudies, RefuseWhatTheTheoryDoesNotCover) {
    for (const char* scheme :
         {"isph_mls", "isph_di", "wcsph:pressure_force=taylor", "wcsph:continuity=renormalised",
          "isph_dfs:laplacian=schwaiger", "wcsph:colour=red", "sph"}) {
        EXPECT_THROW(lattice_state({.scheme = scheme}), UserError) << scheme;
    }
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
    judge(map);
    results.maps.push_back(map);
    nlohmann::ordered_json document;
    add_to_document(results, document);
    EXPECT_TRUE(document["stability_limits"][0]["theory"].is_null());
    EXPECT_EQ(document["stability_limits"][0]["measured"], 2);
    EXPECT_TRUE(document["stability_maps"][0]["measured"][0].is_null());
    EXPECT_EQ(document.dump().find("nan"), std::string::npos);
    EXPECT_NE(markdown(results).find("(!)"), std::string::npos);
}

} // namespace
} // namespace sphvv::verification
