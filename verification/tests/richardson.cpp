#include "sphvv/verification/richardson.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <vector>

namespace {

using namespace sphvv::verification;

std::vector<Resolved> law(double limit, double factor, double p, const std::vector<double>& spacings) {
    std::vector<Resolved> rungs;
    rungs.reserve(spacings.size());
    for (const double h : spacings) {
        rungs.push_back({h, limit + factor * std::pow(h, p)});
    }
    return rungs;
}

void expect_no_number(const Richardson& result, Approach approach) {
    EXPECT_EQ(result.approach, approach) << result.reason;
    EXPECT_FALSE(result.order.has_value());
    EXPECT_FALSE(result.extrapolated.has_value());
    EXPECT_FALSE(result.gci_fine.has_value());
    EXPECT_FALSE(result.gci_coarse.has_value());
    EXPECT_FALSE(result.asymptotic_ratio.has_value());
    EXPECT_FALSE(result.in_asymptotic_range);
    EXPECT_FALSE(result.reason.empty());
}

TEST(Richardson, RecoversExactLaws) {
    const std::vector<std::vector<double>> ladders{
        {0.4, 0.2, 0.1}, {0.3, 0.2, 0.1}, {0.5, 0.2, 0.15}, {0.1, 0.15, 0.33}, {0.2, 0.1, 0.4}};
    for (const auto& spacings : ladders) {
        for (const double p : {0.5, 1.0, 2.0, 3.7}) {
            for (const double factor : {0.8, -0.8}) {
                const auto result = richardson(law(1.5, factor, p, spacings));
                ASSERT_EQ(result.approach, Approach::monotone) << result.reason;
                EXPECT_NEAR(*result.order, p, 1e-9);
                EXPECT_NEAR(*result.extrapolated, 1.5, 1e-9);
            }
        }
    }
}

TEST(Richardson, IndexIsTheTrueErrorTimesTheSafetyFactor) {
    // f0 = 2, C = 1, p = 2 at h = 0.1, 0.2, 0.5: true errors 0.01 and 0.04.
    const auto result = richardson(law(2, 1, 2, {0.1, 0.2, 0.5}));
    EXPECT_TRUE(result.gci_relative);
    EXPECT_NEAR(*result.gci_fine, 1.25 * 0.01 / 2.01, 1e-12);
    EXPECT_NEAR(*result.gci_coarse, 1.25 * 0.04 / 2.04, 1e-12);
    EXPECT_NEAR(*result.asymptotic_ratio, 2.01 / 2.04, 1e-12);
    EXPECT_TRUE(result.in_asymptotic_range);
}

// NPARC Alliance CFD Verification and Validation, "Examining Spatial (Grid) Convergence": pressure recovery
// on three grids, p = 1.786170, f0 = 0.97130, GCI 0.103083 % and 0.356249 %.
TEST(Richardson, AgreesWithThePublishedExample) {
    const auto result = richardson(std::vector<Resolved>{{1, 0.97050}, {2, 0.96854}, {4, 0.96178}});
    EXPECT_NEAR(*result.order, 1.786170, 1e-6);
    EXPECT_NEAR(*result.extrapolated, 0.97130, 1e-5);
    EXPECT_NEAR(*result.gci_fine, 0.00103083, 1e-8);
    EXPECT_NEAR(*result.gci_coarse, 0.00356249, 1e-8);
    EXPECT_NEAR(*result.asymptotic_ratio, 0.97050 / 0.96854, 1e-9);
    EXPECT_TRUE(result.in_asymptotic_range);
}

TEST(Richardson, IndexIsAbsoluteWhereAValueIsZero) {
    // f = 1 - h on h = 1, 1/2, 1/4 vanishes at the coarsest rung only; shifted, at the middle and at the
    // finest.
    EXPECT_TRUE(richardson(law(1, -1, 1, {1, 0.5, 0.25})).gci_relative);
    const auto middle = richardson(law(0.5, -1, 1, {1, 0.5, 0.25}));
    EXPECT_FALSE(middle.gci_relative);
    EXPECT_NEAR(*middle.gci_fine, 1.25 * 0.25, 1e-12);
    EXPECT_NEAR(*middle.gci_coarse, 1.25 * 0.5, 1e-12);
    EXPECT_NEAR(*middle.asymptotic_ratio, 1, 1e-12);
    EXPECT_FALSE(richardson(law(0.25, -1, 1, {1, 0.5, 0.25})).gci_relative);
}

TEST(Richardson, IndexOfANegativeQuantityIsPositive) {
    const auto result = richardson(law(-2, -1, 2, {0.1, 0.2, 0.5}));
    EXPECT_NEAR(*result.gci_fine, 1.25 * 0.01 / 2.01, 1e-12);
    EXPECT_NEAR(*result.gci_coarse, 1.25 * 0.04 / 2.04, 1e-12);
}

TEST(Richardson, FormalOrderMakesTheAsymptoticCheckReal) {
    // First-order values of a second-order scheme: the observed p hides it, the formal one does not.
    const auto rungs = law(100, 1, 1, {0.1, 0.2, 0.4});
    EXPECT_TRUE(richardson(rungs).in_asymptotic_range);
    const auto checked = richardson(rungs, 2);
    EXPECT_NEAR(*checked.order, 1, 1e-9);
    EXPECT_NEAR(*checked.asymptotic_ratio, 0.5, 1e-3); // changes 0.2 and 0.1 over r^2 = 4
    EXPECT_FALSE(checked.in_asymptotic_range);
    EXPECT_TRUE(richardson(law(100, 1, 2, {0.1, 0.2, 0.4}), 2).in_asymptotic_range);
    // The index stays that of the observed order.
    EXPECT_EQ(*checked.gci_fine, *richardson(rungs).gci_fine);
    EXPECT_THROW(richardson(rungs, 0), std::invalid_argument);
    EXPECT_THROW(richardson(rungs, -1), std::invalid_argument);
}

TEST(Richardson, FormalOrderIsCheckedWithUnequalRatios) {
    EXPECT_NEAR(*richardson(law(1e4, 1, 2, {0.1, 0.15, 0.4}), 2).asymptotic_ratio, 1, 1e-4);
}

TEST(Richardson, GrosslyDifferentRungsAreNotAsymptotic) {
    const auto result = richardson(law(1, 1, 2, {1, 0.5, 0.25}));
    EXPECT_NEAR(*result.asymptotic_ratio, 1.0625 / 1.25, 1e-9);
    EXPECT_FALSE(result.in_asymptotic_range);
}

TEST(Richardson, OscillationHasNoOrder) {
    expect_no_number(richardson(std::vector<Resolved>{{0.4, 1}, {0.2, 2}, {0.1, 1.5}}),
                     Approach::oscillatory);
    expect_no_number(richardson(std::vector<Resolved>{{0.4, 2}, {0.2, 1}, {0.1, 1.5}}),
                     Approach::oscillatory);
}

TEST(Richardson, DivergenceHasNoOrder) {
    expect_no_number(richardson(law(1, 1, -1, {0.4, 0.2, 0.1})), Approach::divergent);
    expect_no_number(richardson(law(1, 1, -0.01, {0.5, 0.2, 0.15})), Approach::divergent);
    expect_no_number(richardson(std::vector<Resolved>{{0.4, 3}, {0.2, 2}, {0.1, 1}}), Approach::divergent);
    // A change that shrinks only because the step does, f = log h, has order zero.
    expect_no_number(
        richardson(std::vector<Resolved>{{0.8, std::log(0.8)}, {0.2, std::log(0.2)}, {0.1, std::log(0.1)}}),
        Approach::divergent);
}

TEST(Richardson, RoundOffHasNoOrder) {
    expect_no_number(richardson(law(1, 0, 2, {0.4, 0.2, 0.1})), Approach::undetermined);
    expect_no_number(richardson(std::vector<Resolved>{{0.4, 1.1}, {0.2, 1}, {0.1, 1 + 2e-16}}),
                     Approach::undetermined);
    expect_no_number(richardson(std::vector<Resolved>{{0.4, 1}, {0.2, 1}, {0.1, 1.1}}),
                     Approach::undetermined);
    expect_no_number(richardson(std::vector<Resolved>{{0.4, 2}, {0.2, 1}, {0.1, 1 - 1e-12}}),
                     Approach::undetermined);
}

TEST(Richardson, AValueThatIsNoneHasNoOrder) {
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        for (std::size_t place = 0; place < 3; ++place) {
            auto rungs = law(1, 1, 2, {0.4, 0.2, 0.1});
            rungs[place].value = bad;
            const auto result = richardson(rungs);
            expect_no_number(result, Approach::undetermined);
            EXPECT_EQ(result.reason.find("the value at h = 0."), 0U) << result.reason;
        }
    }
}

TEST(Richardson, RejectsWhatAreNotThreeRungs) {
    EXPECT_THROW(richardson(law(1, 1, 2, {0.2, 0.1})), std::invalid_argument);
    EXPECT_THROW(richardson(law(1, 1, 2, {0.8, 0.4, 0.2, 0.1})), std::invalid_argument);
    EXPECT_THROW(richardson(law(1, 1, 2, {0.2, 0.2, 0.1})), std::invalid_argument);
    EXPECT_THROW(richardson(law(1, 1, 2, {0.2, 0.1, 0.1})), std::invalid_argument);
    EXPECT_THROW(richardson(law(1, 1, 2, {0.2, 0.1, 0.0})), std::invalid_argument);
    EXPECT_THROW(richardson(law(1, 1, 2, {0.2, 0.1, -0.1})), std::invalid_argument);
    EXPECT_THROW(richardson(law(1, 1, 2, {0.2, 0.1, std::numeric_limits<double>::quiet_NaN()})),
                 std::invalid_argument);
}

} // namespace
