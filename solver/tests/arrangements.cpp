// Where lattices put their points, and what jitter does to them.
#include "sphvv/solver/arrangements.hpp"

#include "sphvv/solver/error.hpp"
#include "sphvv/solver/kernels.hpp"
#include "sphvv/solver/tests/scenes.hpp"
#include "sphvv/solver/unstructured.hpp"

#include <gtest/gtest.h>
#include <omp.h>

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

/// Coordinates of a point and of its images beyond the sides of the box, along one direction.
std::array<double, 3> with_images(const Box<2>& box, int d, double x) {
    return box.periodic[d] ? std::array{x, x - box.length(d), x + box.length(d)}
                           : std::array{x, 2 * box.low[d] - x, 2 * box.high[d] - x};
}

struct Evenness {
    double deviation = 0;      ///< root mean square of rho/(N m/volume) - 1, images included
    double closest = infinity; ///< distance of the closest pair, images left out, over dx
};

/// By brute force.
Evenness evenness_of(const Box<2>& box, const Points<2>& points) {
    const int count = size<2>(points);
    const double volume = box.volume() / count;
    const double dx = std::sqrt(volume);
    const Kernel& kernel = kernels::find("cubic_spline");
    Evenness result;
    for (int a = 0; a < count; ++a) {
        double density = 0;
        for (int b = 0; b < count; ++b) {
            for (const double x : with_images(box, 0, points[0][b])) {
                for (const double y : with_images(box, 1, points[1][b])) {
                    density +=
                        volume * kernel.value(2, std::hypot(points[0][a] - x, points[1][a] - y), 1.3 * dx);
                }
            }
            if (b != a) {
                result.closest =
                    std::min(result.closest,
                             std::hypot(points[0][a] - points[0][b], points[1][a] - points[1][b]) / dx);
            }
        }
        result.deviation += (density - 1) * (density - 1) / count;
    }
    result.deviation = std::sqrt(result.deviation);
    return result;
}

const Box<2> channel{{-1, 3}, {1, 4}, {true, false}};

// Derived in unstructured.hpp: 0.047 of the start, for the mean square of many waves; of one set half of that
// may be missing. A push of the excess alone lets points come together.
TEST(Unstructured, SettlesAndKeepsItsPointsApart) {
    for (const Box<2>& box : {channel, cube<2>(1, false)}) {
        for (const std::uint64_t seed : {1, 2, 3}) {
            const Evenness start = evenness_of(box, unstructured<2>(box, 400, seed, 0));
            const Points<2> points = unstructured<2>(box, 400, seed);
            const Evenness end = evenness_of(box, points);
            EXPECT_GT(start.deviation, 0.3);
            EXPECT_LT(end.deviation, start.deviation / 10);
            EXPECT_GT(end.closest, 0.7);
            for (int d = 0; d < 2; ++d) {
                const auto [low, high] = std::ranges::minmax(points[d]);
                EXPECT_GE(low, box.low[d]);
                EXPECT_LE(high, box.high[d]);
            }
            if (!box.periodic[0]) { // away from a wall as from one's image
                EXPECT_GT(std::ranges::min(points[0]), box.low[0] + 0.2 / 20);
            }
        }
    }
}

TEST(Unstructured, StaysWithoutStructure) { // a lattice has one distance to the nearest neighbour
    const Points<2> points = unstructured<2>(cube<2>(1, false), 400, 1);
    double least = infinity;
    double most = 0;
    for (int a = 0; a < 400; ++a) {
        double nearest = infinity;
        for (int b = 0; b < 400; ++b) {
            if (b != a) {
                nearest =
                    std::min(nearest, std::hypot(points[0][a] - points[0][b], points[1][a] - points[1][b]));
            }
        }
        least = std::min(least, nearest);
        most = std::max(most, nearest);
    }
    EXPECT_GT(most, 1.1 * least);
}

TEST(Unstructured, DependsOnItsSeedOnly) {
    const auto points = [](int threads, std::uint64_t seed) {
        const int allowed = omp_get_max_threads();
        omp_set_num_threads(threads);
        auto result = unstructured<3>(cube<3>(1, true), 600, seed, 10);
        omp_set_num_threads(allowed);
        return result;
    };
    EXPECT_EQ(points(1, 7), points(2, 7));
    EXPECT_NE(points(1, 7), points(1, 8));
}

TEST(Unstructured, RefusesABoxThatHoldsNoSupport) {
    EXPECT_NO_THROW(unstructured<2>(cube<2>(1, false), 9, 1));
    EXPECT_THROW(unstructured<2>(cube<2>(1, false), 4, 1), UserError);
    EXPECT_THROW(unstructured<2>(cube<2>(1, true), 9, 1), UserError);
}

} // namespace
} // namespace sphvv::solver
