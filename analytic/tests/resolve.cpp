#include "sphvv/analytic/solutions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace sphvv::analytic {
namespace {

Solution example() {
    Solution solution{};
    solution.name = "example";
    solution.dimension = 2;
    solution.parameters = {{"re", "1", "Reynolds number", 100, 1e-3, 1e8},
                           {"speed", "m/s", "largest speed", 1, 0.1, 2.5}};
    return solution;
}

/// What std::invalid_argument says, or "" where nothing is thrown.
template <class Call>
std::string refusal(const Call& call) {
    try {
        call();
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "";
}

std::string refusal_of(const Values& given) {
    return refusal([&] { resolve(example(), given); });
}

TEST(Resolve, TakesTheDeclaredValuesWhereNoneAreGiven) {
    EXPECT_EQ(resolve(example(), {}), (Values{{"re", 100}, {"speed", 1}}));
    EXPECT_EQ(resolve(example(), {{"speed", 2}}), (Values{{"re", 100}, {"speed", 2}}));
}

TEST(Resolve, TakesTheEndsOfAnInterval) {
    EXPECT_EQ(resolve(example(), {{"speed", 0.1}, {"re", 1e8}}), (Values{{"re", 1e8}, {"speed", 0.1}}));
    EXPECT_EQ(resolve(example(), {{"speed", 2.5}, {"re", 1e-3}}), (Values{{"re", 1e-3}, {"speed", 2.5}}));
}

TEST(Resolve, ResolvedValuesStayWhatTheyAre) {
    const Values values = resolve(example(), {{"re", 7}});
    EXPECT_EQ(resolve(example(), values), values);
}

TEST(Resolve, NamesAnUnknownKeyAndTheAcceptedOnes) {
    EXPECT_EQ(refusal_of({{"reynolds", 10}}),
              "The exact solution example has no parameter \"reynolds\"; accepted: re in [0.001, 1e+08], "
              "speed in [0.1, 2.5] m/s.");
    Solution bare = example();
    bare.parameters.clear();
    EXPECT_EQ(refusal([&] {
                  resolve(bare, {{"re", 10}});
              }),
              "The exact solution example has no parameter \"re\"; accepted: none.");
}

TEST(Resolve, NamesAValueOutsideItsInterval) {
    EXPECT_EQ(refusal_of({{"speed", -1}}),
              "The exact solution example cannot take speed = -1; accepted: speed in [0.1, 2.5] m/s.");
    EXPECT_EQ(
        refusal_of({{"speed", std::nextafter(2.5, 3)}}),
        "The exact solution example cannot take speed = 2.5000000000000004; accepted: speed in [0.1, 2.5] "
        "m/s.");
}

TEST(Resolve, RefusesWhatIsNoNumber) {
    EXPECT_EQ(refusal_of({{"re", std::numeric_limits<double>::quiet_NaN()}}),
              "The exact solution example cannot take re = nan; accepted: re in [0.001, 1e+08].");
    EXPECT_EQ(refusal_of({{"re", std::numeric_limits<double>::infinity()}}),
              "The exact solution example cannot take re = inf; accepted: re in [0.001, 1e+08].");
}

TEST(Find, NamesAnUnknownSolutionAndTheAcceptedOnes) {
    std::string names;
    for (const Solution* solution : solutions::all()) {
        names.append(names.empty() ? "" : ", ").append(solution->name);
    }
    EXPECT_EQ(refusal([] { solutions::find("taylor green"); }),
              "There is no exact solution \"taylor green\"; accepted: " + names + ".");
    EXPECT_NE(refusal([] { solutions::find(""); }), "");
}

TEST(Quantity, NamesAnUnknownQuantityAndTheAcceptedOnes) {
    const Solution& column = solutions::find("hydrostatic");
    EXPECT_EQ(refusal([&] { quantity(column, "depth", {}); }),
              "The exact solution hydrostatic has no quantity \"depth\"; accepted: settled_depth, "
              "bed_pressure, motion.");
    const Solution& vortices = solutions::find("taylor_green");
    EXPECT_EQ(refusal([&] { quantity(vortices, "depth", {}); }),
              "The exact solution taylor_green has no quantity \"depth\"; accepted: none.");
    EXPECT_TRUE(boundaries(vortices, {}).empty());
    EXPECT_EQ(density(State{}, vortices.medium({})), 1000);
}

} // namespace
} // namespace sphvv::analytic
