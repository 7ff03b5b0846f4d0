// Where lattices put their points, and what jitter does to them.
#include "sphvv/solver/arrangements.hpp"

#include "sphvv/solver/error.hpp"
#include "sphvv/solver/tests/scenes.hpp"

#include <gtest/gtest.h>

namespace sphvv::solver {
namespace {

using namespace scenes;

TEST(Lattice, HasTheCentresOfItsCellsWithDirection0Fastest) {
    const Box<2> box{{-1, 3}, {2, 4}, {true, false}};
    const Points<2> points = lattice<2>(box, 0.5);
    ASSERT_EQ(size<2>(points), 6 * 2);
    for (int k = 0; k < 12; ++k) {
        EXPECT_DOUBLE_EQ(points[0][k], -0.75 + 0.5 * (k % 6));
        EXPECT_DOUBLE_EQ(points[1][k], k < 6 ? 3.25 : 3.75);
    }
    const Points<3> cubic = lattice<3>({{0, 0, 0}, {1, 2, 3}, {}}, 1);
    EXPECT_EQ(cubic[0], std::vector(6, 0.5));
    EXPECT_EQ(cubic[1], (std::vector{0.5, 1.5, 0.5, 1.5, 0.5, 1.5}));
    EXPECT_EQ(cubic[2], (std::vector{0.5, 0.5, 1.5, 1.5, 2.5, 2.5}));
}

TEST(Lattice, FillsTheBoxForAnySpacingThatDividesIt) {
    for (int n = 1; n < 400; ++n) {
        EXPECT_EQ(size<2>(lattice<2>(cube<2>(0.7, true), 0.7 / n)), n * n);
    }
    for (const double dx : {0.3, 1.1, 2.0, 0.1000001}) {
        EXPECT_THROW(lattice<2>(cube<2>(1, true), dx), UserError) << dx;
    }
}

TEST(Jitter, IsUniformWithinItsAmplitude) {
    constexpr double amplitude = 0.3;
    constexpr int n = 40;
    const Points<2> start = lattice<2>(cube<2>(n, true), 1);
    Points<2> points = start;
    jitter<2>(points, amplitude, 7);
    for (int d = 0; d < 2; ++d) {
        double mean = 0;
        double square = 0;
        for (int i = 0; i < n * n; ++i) {
            const double moved = points[d][i] - start[d][i];
            EXPECT_LE(std::abs(moved), amplitude);
            mean += moved / (n * n);
            square += moved * moved / (n * n);
        }
        // four standard deviations of the mean and of the mean square, a^2/3 with variance 4 a^4/45
        EXPECT_NEAR(mean, 0, 4 * amplitude / std::sqrt(3.) / n);
        EXPECT_NEAR(square, amplitude * amplitude / 3, 4 * amplitude * amplitude * std::sqrt(4. / 45) / n);
    }
}

TEST(Jitter, DependsOnItsSeedOnly) {
    const auto displaced = [](double amplitude, std::uint64_t seed) {
        Points<3> points = lattice<3>(cube<3>(1, true), 0.25);
        jitter<3>(points, amplitude, seed);
        return points;
    };
    EXPECT_EQ(displaced(0.1, 7), displaced(0.1, 7));
    EXPECT_NE(displaced(0.1, 7), displaced(0.1, 8));
    EXPECT_EQ(displaced(0, 7), lattice<3>(cube<3>(1, true), 0.25));
    // the standard prescribes the engine to the bit: component by component of one particle after the other
    std::mt19937_64 engine(7);
    const Points<3> start = lattice<3>(cube<3>(1, true), 0.25);
    const Points<3> points = displaced(0.1, 7);
    for (int i = 0; i < size<3>(points); ++i) {
        for (int d = 0; d < 3; ++d) {
            const auto uniform =
                static_cast<double>(std::floor(static_cast<long double>(engine()) / 2048) / 0x1p53L);
            EXPECT_NEAR(points[d][i], start[d][i] + 0.1 * (2 * uniform - 1), 1e-16);
        }
    }
}

} // namespace
} // namespace sphvv::solver
