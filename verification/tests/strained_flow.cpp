#include "sphvv/verification/strained_flow.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace sphvv::verification {
namespace {

using std::numbers::pi;

// The formulas of the header, for matrices taken at random.
TEST(StrainedFlow, DriftAndProjectionOfALinearFlow) {
    for (const double strain : {0.3, 0.9}) {
        for (const double spin : {0., 0.7}) {
            Eigen::Matrix2d A;
            A << strain, -spin, spin, -strain;
            const double dt = 0.8;
            const Eigen::Matrix2d carried = A * (Eigen::Matrix2d::Identity() + dt * A).inverse();
            const Eigen::Matrix2d projected = carried - carried.trace() / 2 * Eigen::Matrix2d::Identity();
            EXPECT_LT((projected - A / (1 + dt * dt * A.determinant())).norm(), 1e-12);
        }
    }
}

// L/(2 pi U) but for O(1/n^2): the chord of the sine between two particles is flatter than its slope.
TEST(StrainedFlow, FoldsAtTheInverseOfTheLargestStrain) {
    for (const int n : {20, 40}) {
        const double off = fold_step({"isph_df", n}) * 2 * pi - 1;
        EXPECT_NEAR(off * n * n, pi * pi / 6, 0.05);
    }
}

TEST(StrainedFlow, IsKeptByShortStepsAndLostByFoldingOnes) {
    const StrainedFlow flow{"isph_df"};
    EXPECT_TRUE(keeps_arrangement(flow, 0.1 * fold_step(flow)));
    EXPECT_FALSE(keeps_arrangement(flow, fold_step(flow)));
    EXPECT_FALSE(keeps_arrangement(flow, 2 * fold_step(flow)));
}

} // namespace
} // namespace sphvv::verification
