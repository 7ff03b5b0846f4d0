#include "sphvv/verification/norms.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace sphvv::verification;
using Array = std::vector<double>;

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Vectors {
    Array x, y;
};

Norms plane_norms(const Vectors& value, const Vectors& reference, const Array& volume) {
    const std::array<std::span<const double>, 2> value_components{value.x, value.y};
    const std::array<std::span<const double>, 2> reference_components{reference.x, reference.y};
    return vector_norms(value_components, reference_components, volume);
}

void expect_all_nan(const Norms& norms) {
    for (const double norm : {norms.l1, norms.l2, norms.linf, norms.l1_abs, norms.l2_abs, norms.linf_abs}) {
        EXPECT_TRUE(std::isnan(norm));
    }
}

TEST(ScalarNorms, AgreeWithHandComputation) {
    // Errors 1, -2, 0 with volumes 1, 2, 5; references 2, 4, -4.
    const auto norms = scalar_norms(Array{3, 2, -4}, Array{2, 4, -4}, Array{1, 2, 5});
    EXPECT_DOUBLE_EQ(norms.l1_abs, 5.0 / 8);
    EXPECT_DOUBLE_EQ(norms.l2_abs, std::sqrt(9.0 / 8));
    EXPECT_DOUBLE_EQ(norms.linf_abs, 2);
    EXPECT_DOUBLE_EQ(norms.l1, 5.0 / 30);
    EXPECT_DOUBLE_EQ(norms.l2, std::sqrt(9.0 / 116));
    EXPECT_DOUBLE_EQ(norms.linf, 0.5);
    EXPECT_TRUE(norms.relative);
}

TEST(ScalarNorms, FallBackToAbsoluteWhereTheReferenceVanishes) {
    const auto norms = scalar_norms(Array{3, -4}, Array{0, 0}, Array{1, 1});
    EXPECT_FALSE(norms.relative);
    EXPECT_DOUBLE_EQ(norms.l1, 3.5);
    EXPECT_DOUBLE_EQ(norms.l2, std::sqrt(12.5));
    EXPECT_DOUBLE_EQ(norms.linf, 4);
    EXPECT_EQ(norms.l1, norms.l1_abs);
    EXPECT_EQ(norms.l2, norms.l2_abs);
    EXPECT_EQ(norms.linf, norms.linf_abs);
    EXPECT_FALSE(scalar_norms(Array{1}, Array{1e-301}, Array{1}).relative);
    EXPECT_TRUE(scalar_norms(Array{1}, Array{1e-299}, Array{1}).relative);
}

TEST(ScalarNorms, AreZeroForAnExactField) {
    const auto norms = scalar_norms(Array{1, 2}, Array{1, 2}, Array{1, 1});
    EXPECT_EQ(norms.l1, 0);
    EXPECT_EQ(norms.l2, 0);
    EXPECT_EQ(norms.linf, 0);
}

// House fault 2: volumes inside the p-th power.
TEST(ScalarNorms, AConstantErrorDoesNotConvergeUnderRefinement) {
    for (const std::size_t n : {10U, 20U, 40U, 80U}) {
        const std::size_t particles = n * n;
        const auto norms = scalar_norms(Array(particles, 1.25), Array(particles, 1),
                                        Array(particles, 1 / static_cast<double>(particles)));
        EXPECT_NEAR(norms.l1, 0.25, 1e-13) << n;
        EXPECT_NEAR(norms.l2, 0.25, 1e-13) << n;
        EXPECT_NEAR(norms.linf, 0.25, 1e-13) << n;
    }
}

TEST(ScalarNorms, AreOrderedAndBlindToTheUnitOfVolume) {
    for (unsigned seed = 1; seed <= 200; ++seed) {
        std::mt19937_64 engine(seed);
        std::normal_distribution<double> field(0, std::pow(10.0, static_cast<double>(seed % 13) - 6));
        std::uniform_real_distribution<double> uniform(0.1, 3);
        const std::size_t particles = 1 + seed % 37;
        Array value(particles);
        Array reference(particles);
        Array volume(particles);
        Array scaled(particles);
        for (std::size_t i = 0; i < particles; ++i) {
            value[i] = field(engine);
            reference[i] = field(engine);
            volume[i] = uniform(engine);
            scaled[i] = 1e-6 * volume[i];
        }
        const auto norms = scalar_norms(value, reference, volume);
        EXPECT_LE(norms.l1_abs, norms.l2_abs * (1 + 1e-14)) << seed;
        EXPECT_LE(norms.l2_abs, norms.linf_abs * (1 + 1e-14)) << seed;
        const auto in_other_unit = scalar_norms(value, reference, scaled);
        EXPECT_NEAR(in_other_unit.l1, norms.l1, 1e-12 * norms.l1) << seed;
        EXPECT_NEAR(in_other_unit.l2, norms.l2, 1e-12 * norms.l2) << seed;
    }
}

TEST(ScalarNorms, WeighParticlesByVolume) {
    // One large particle is worth the four small ones that tile it.
    const auto split = scalar_norms(Array{1, 1, 1, 1, 5}, Array{2, 2, 2, 2, 3}, Array{1, 1, 1, 1, 4});
    const auto whole = scalar_norms(Array{1, 5}, Array{2, 3}, Array{4, 4});
    EXPECT_DOUBLE_EQ(split.l1, whole.l1);
    EXPECT_DOUBLE_EQ(split.l2, whole.l2);
    EXPECT_DOUBLE_EQ(split.linf, whole.linf);
}

// House fault 3: each field is measured against its own reference, so neither side's unit can show.
TEST(ScalarNorms, RelativeNormsAreBlindToTheUnitOfTheField) {
    const Array value{1.1, -1.8, 3.2};
    const Array reference{1, -2, 3};
    const Array volume{1, 2, 1};
    const auto norms = scalar_norms(value, reference, volume);
    for (const double unit : {1e-200, 1e-3, 998.0, 1e200}) {
        Array scaled_value = value;
        Array scaled_reference = reference;
        for (std::size_t i = 0; i < value.size(); ++i) {
            scaled_value[i] *= unit;
            scaled_reference[i] *= unit;
        }
        const auto scaled = scalar_norms(scaled_value, scaled_reference, volume);
        EXPECT_NEAR(scaled.l1, norms.l1, 1e-13) << unit;
        EXPECT_NEAR(scaled.l2, norms.l2, 1e-13) << unit;
        EXPECT_NEAR(scaled.linf, norms.linf, 1e-13) << unit;
        EXPECT_NEAR(scaled.l1_abs / unit, norms.l1_abs, 1e-13) << unit;
        EXPECT_NEAR(scaled.l2_abs / unit, norms.l2_abs, 1e-13) << unit;
        EXPECT_NEAR(scaled.linf_abs / unit, norms.linf_abs, 1e-13) << unit;
    }
}

TEST(ScalarNorms, NeverSkipANan) {
    for (std::size_t place = 0; place < 3; ++place) {
        Array spoiled{1, 2, 3};
        spoiled[place] = nan_value;
        expect_all_nan(scalar_norms(spoiled, Array{1, 1, 1}, Array{1, 1, 1}));
        expect_all_nan(scalar_norms(Array{1, 1, 1}, spoiled, Array{1, 1, 1}));
        expect_all_nan(scalar_norms_up_to_a_constant(spoiled, Array{1, 2, 1}, Array{1, 1, 1}));
    }
    expect_all_nan(scalar_norms(Array{infinity, nan_value}, Array{1, 1}, Array{1, 1}));
    expect_all_nan(scalar_norms(Array{nan_value}, Array{0}, Array{1}));
}

TEST(ScalarNorms, AreInfiniteForAnInfiniteValue) {
    const auto norms = scalar_norms(Array{1, -infinity}, Array{1, 1}, Array{1, 1});
    EXPECT_EQ(norms.l1, infinity);
    EXPECT_EQ(norms.l2, infinity);
    EXPECT_EQ(norms.linf, infinity);
}

TEST(ScalarNorms, RejectWhatCannotBeMeasured) {
    EXPECT_THROW(scalar_norms(Array{}, Array{}, Array{}), std::invalid_argument);
    EXPECT_THROW(scalar_norms(Array{1}, Array{1, 2}, Array{1, 1}), std::invalid_argument);
    EXPECT_THROW(scalar_norms(Array{1, 2}, Array{1}, Array{1, 1}), std::invalid_argument);
    EXPECT_THROW(scalar_norms(Array{1, 2}, Array{1, 2}, Array{1}), std::invalid_argument);
    for (const double bad : {0.0, -1.0, nan_value, infinity}) {
        EXPECT_THROW(scalar_norms(Array{1, 2}, Array{1, 2}, Array{1, bad}), std::invalid_argument) << bad;
    }
    EXPECT_THROW(mean_removed(Array{}, Array{}), std::invalid_argument);
    EXPECT_THROW(mean_removed(Array{1}, Array{1, 1}), std::invalid_argument);
    EXPECT_THROW(mean_removed(Array{1}, Array{-1}), std::invalid_argument);
}

TEST(ScalarNorms, ExceptionNamesTheOffender) {
    try {
        scalar_norms(Array{1, 2}, Array{1, 2}, Array{1, -3});
        FAIL() << "a negative volume was accepted";
    } catch (const std::invalid_argument& error) {
        EXPECT_NE(std::string(error.what()).find("volume[1]"), std::string::npos) << error.what();
    }
}

TEST(VectorNorms, AgreeWithHandComputation) {
    // Error lengths 5 and 0, reference lengths 1 and 2, volumes 1 and 3.
    const auto norms = plane_norms({{3, 0}, {5, 2}}, {{0, 0}, {1, 2}}, {1, 3});
    EXPECT_DOUBLE_EQ(norms.l1_abs, 5.0 / 4);
    EXPECT_DOUBLE_EQ(norms.l2_abs, std::sqrt(25.0 / 4));
    EXPECT_DOUBLE_EQ(norms.linf_abs, 5);
    EXPECT_DOUBLE_EQ(norms.l1, 5.0 / 7);
    EXPECT_DOUBLE_EQ(norms.l2, std::sqrt(25.0 / 13));
    EXPECT_DOUBLE_EQ(norms.linf, 2.5);
}

TEST(VectorNorms, OfOneComponentAreTheScalarOnes) {
    const Array value{3, 2, -4};
    const Array reference{2, 4, -4};
    const Array volume{1, 2, 5};
    const std::array<std::span<const double>, 1> value_component{value};
    const std::array<std::span<const double>, 1> reference_component{reference};
    const auto vector = vector_norms(value_component, reference_component, volume);
    const auto scalar = scalar_norms(value, reference, volume);
    EXPECT_DOUBLE_EQ(vector.l1, scalar.l1);
    EXPECT_DOUBLE_EQ(vector.l2, scalar.l2);
    EXPECT_DOUBLE_EQ(vector.linf, scalar.linf);
}

TEST(VectorNorms, TakeThreeComponents) {
    const Array a{2};
    const Array b{3};
    const Array c{6};
    const Array zero{0};
    const std::array<std::span<const double>, 3> value{a, b, c};
    const std::array<std::span<const double>, 3> reference{zero, zero, zero};
    EXPECT_DOUBLE_EQ(vector_norms(value, reference, Array{1}).l2, 7);
}

// House fault 5: velocity compared by magnitude.
TEST(VectorNorms, SeeAWrongDirectionOfTheRightMagnitude) {
    Vectors flow;
    Vectors turned;
    for (int i = 0; i < 100; ++i) {
        const double angle = 2 * std::numbers::pi * i / 100;
        flow.x.push_back(std::cos(angle));
        flow.y.push_back(std::sin(angle));
        turned.x.push_back(-std::sin(angle));
        turned.y.push_back(std::cos(angle));
    }
    const auto norms = plane_norms(turned, flow, Array(100, 0.01));
    EXPECT_NEAR(norms.l1, std::numbers::sqrt2, 1e-13);
    EXPECT_NEAR(norms.l2, std::numbers::sqrt2, 1e-13);
    EXPECT_NEAR(norms.linf, std::numbers::sqrt2, 1e-13);
}

TEST(VectorNorms, AreOrderedAndRotationInvariant) {
    for (unsigned seed = 1; seed <= 100; ++seed) {
        std::mt19937_64 engine(seed);
        std::normal_distribution<double> normal;
        std::uniform_real_distribution<double> uniform(0.5, 2);
        Vectors value;
        Vectors reference;
        Vectors rotated_value;
        Vectors rotated_reference;
        Array volume;
        const double cosine = std::cos(seed);
        const double sine = std::sin(seed);
        const auto add = [&](Vectors& original, Vectors& rotated) {
            const double x = normal(engine);
            const double y = normal(engine);
            original.x.push_back(x);
            original.y.push_back(y);
            rotated.x.push_back(cosine * x - sine * y);
            rotated.y.push_back(sine * x + cosine * y);
        };
        for (int i = 0; i < 30; ++i) {
            add(value, rotated_value);
            add(reference, rotated_reference);
            volume.push_back(uniform(engine));
        }
        const auto norms = plane_norms(value, reference, volume);
        EXPECT_LE(norms.l1_abs, norms.l2_abs);
        EXPECT_LE(norms.l2_abs, norms.linf_abs);
        const auto rotated = plane_norms(rotated_value, rotated_reference, volume);
        EXPECT_NEAR(rotated.l1, norms.l1, 1e-12);
        EXPECT_NEAR(rotated.l2, norms.l2, 1e-12);
        EXPECT_NEAR(rotated.linf, norms.linf, 1e-12);
    }
}

TEST(VectorNorms, NeverSkipANan) {
    expect_all_nan(plane_norms({{1, 2}, {nan_value, 2}}, {{1, 1}, {1, 1}}, {1, 1}));
    expect_all_nan(plane_norms({{1, 2}, {1, 2}}, {{1, nan_value}, {1, 1}}, {1, 1}));
    expect_all_nan(plane_norms({{infinity, 2}, {nan_value, 2}}, {{1, 1}, {1, 1}}, {1, 1}));
    expect_all_nan(plane_norms({{nan_value, 2}, {infinity, 2}}, {{1, 1}, {1, 1}}, {1, 1}));
}

TEST(VectorNorms, RejectWhatCannotBeMeasured) {
    const Array one{1};
    const Array two{1, 2};
    const std::array<std::span<const double>, 1> single{one};
    const std::array<std::span<const double>, 2> both{one, one};
    const std::array<std::span<const double>, 1> longer{two};
    EXPECT_THROW(vector_norms(single, both, one), std::invalid_argument);
    EXPECT_THROW(vector_norms({}, {}, one), std::invalid_argument);
    EXPECT_THROW(vector_norms(longer, single, one), std::invalid_argument);
    EXPECT_THROW(vector_norms(single, longer, one), std::invalid_argument);
    EXPECT_THROW(vector_norms(single, single, Array{0}), std::invalid_argument);
}

TEST(MeanRemoved, TakesTheVolumeMeanAway) {
    const auto field = mean_removed(Array{1, 5}, Array{3, 1}); // mean 2
    EXPECT_DOUBLE_EQ(field[0], -1);
    EXPECT_DOUBLE_EQ(field[1], 3);
}

TEST(MeanRemoved, NormsDoNotSeeAConstantOnEitherSide) {
    const Array value{1.5, -1, 0.25, 2};
    const Array reference{1, -1.5, 0.5, 2};
    const Array volume{1, 2, 1, 0.5};
    const auto norms = scalar_norms_up_to_a_constant(value, reference, volume);
    Array lifted_value = value;
    Array lifted_reference = reference;
    for (std::size_t i = 0; i < value.size(); ++i) {
        lifted_value[i] += 1000;
        lifted_reference[i] -= 70;
    }
    const auto lifted = scalar_norms_up_to_a_constant(lifted_value, lifted_reference, volume);
    EXPECT_NEAR(lifted.l1, norms.l1, 1e-11);
    EXPECT_NEAR(lifted.l2, norms.l2, 1e-11);
    EXPECT_NEAR(lifted.linf, norms.linf, 1e-11);
    EXPECT_TRUE(lifted.relative);
    EXPECT_GT(scalar_norms(lifted_value, reference, volume).l1, 100);
}

TEST(MeanRemoved, RelativeNormsDivideByTheCentredReference) {
    // Centred reference ±1, centred value ±1.5.
    const auto norms = scalar_norms_up_to_a_constant(Array{8.5, 11.5}, Array{4, 6}, Array{2, 2});
    EXPECT_DOUBLE_EQ(norms.l1, 0.5);
    EXPECT_DOUBLE_EQ(norms.l2, 0.5);
    EXPECT_DOUBLE_EQ(norms.linf, 0.5);
}

TEST(MeanRemoved, AConstantReferenceLeavesNothingToDivideBy) {
    const auto norms = scalar_norms_up_to_a_constant(Array{1.1, 0.9, 1, 1}, Array(4, 0.1), Array(4, 0.3));
    EXPECT_FALSE(norms.relative);
    EXPECT_NEAR(norms.linf, 0.1, 1e-15);
    // Constant but for its last digit.
    const Array rounded{1e5, std::nextafter(1e5, 2e5)};
    EXPECT_FALSE(scalar_norms_up_to_a_constant(Array{1, 2}, rounded, Array{1, 1}).relative);
}

} // namespace
