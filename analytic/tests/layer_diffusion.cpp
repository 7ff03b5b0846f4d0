// The two series of every layer against each other, their own derivatives and means, and their starts.
#include "sphvv/analytic/layer_diffusion.hpp"

#include "sphvv/analytic/tests/checks.hpp"

#include <gtest/gtest.h>

namespace sphvv::analytic::layer {
namespace {

using Series = Profile (*)(double, double, int);
using Sum = Profile (*)(double, double);

struct Layer {
    const char* name;
    Series by_eigenfunctions;
    Series by_images;
    Sum sum;
};

const std::array layers{Layer{"forced", forced_by_eigenfunctions, forced_by_images, forced},
                        Layer{"released", released_by_eigenfunctions, released_by_images, released},
                        Layer{"dragged", dragged_by_eigenfunctions, dragged_by_images, dragged}};

double difference(const Profile& a, const Profile& b) {
    return std::max(
        {std::abs(a.value - b.value), std::abs(a.gradient - b.gradient), std::abs(a.mean - b.mean)});
}

TEST(LayerDiffusion, EigenfunctionsAndImagesAgree) {
    for (const Layer& layer : layers) {
        for (const double tau : {0.01, 0.05, 0.1, 0.2, 0.5}) {
            for (double zeta = 0; zeta <= 1; zeta += 0.125) {
                EXPECT_LT(difference(layer.by_eigenfunctions(zeta, tau, 25), layer.by_images(zeta, tau, 10)),
                          5e-15)
                    << layer.name << " at " << zeta << ", " << tau;
            }
        }
    }
}

TEST(LayerDiffusion, TruncatesBelowRoundOffWhereItSwitches) {
    for (const Layer& layer : layers) {
        for (double zeta = 0; zeta <= 1; zeta += 0.125) {
            EXPECT_LT(difference(layer.by_eigenfunctions(zeta, switch_time, eigenfunction_terms),
                                 layer.by_eigenfunctions(zeta, switch_time, 60)),
                      1e-16);
            EXPECT_LT(difference(layer.by_images(zeta, switch_time, image_terms),
                                 layer.by_images(zeta, switch_time, 40)),
                      1e-16);
            // A fault of the switch would show: too few terms are seen.
            EXPECT_GT(difference(layer.by_eigenfunctions(0.3, switch_time / 20, eigenfunction_terms),
                                 layer.by_images(0.3, switch_time / 20, image_terms)),
                      1e-5);
        }
    }
}

TEST(LayerDiffusion, GradientAndMeanBelongToTheValue) {
    const Domain line{{0, 0, 0}, {1, 0, 0}, {}};
    for (const Layer& layer : layers) {
        for (const double tau : {1e-3, 0.04, 0.3}) {
            const double slope =
                checks::derivatives([&](double s) { return layer.sum(0.4 + s, tau).value; }, 1e-3).first;
            EXPECT_NEAR(layer.sum(0.4, tau).gradient, slope, 1e-11) << layer.name;
            const double mean =
                checks::volume_mean(line, 1, [&](const Vector& x) { return layer.sum(x[0], tau).value; });
            EXPECT_NEAR(layer.sum(0.4, tau).mean, mean, 1e-14) << layer.name;
        }
    }
}

TEST(LayerDiffusion, StartsAsStated) {
    for (const double zeta : {0.1, 0.5, 0.9}) {
        EXPECT_NEAR(forced(zeta, 1e-6).value, 2e-6, 1e-18);
        EXPECT_NEAR(released(zeta, 1e-6).value, zeta, 1e-15);
        EXPECT_EQ(dragged(zeta, 1e-6).value, 0);
        EXPECT_EQ(forced(zeta, 0).value, 0);
        EXPECT_EQ(released(zeta, 0).value, zeta);
        EXPECT_EQ(dragged(zeta, 0).value, 0);
    }
}

TEST(LayerDiffusion, SquareMeansHoldForThinLayers) {
    const Domain line{{0, 0, 0}, {1, 0, 0}, {}};
    for (const double tau : {1e-7, 1e-4, 0.01, 0.3}) {
        for (const double s : {0.0, 0.3, 1.0}) {
            for (const double a : {0.0, 1.0}) {
                const double exact = checks::volume_mean(line, 1, [&](const Vector& x) {
                    const double f = (1 - s) * forced(x[0], tau).value + s * forced_steady(x[0]).value +
                                     a * released(x[0], tau).value;
                    return f * f;
                });
                EXPECT_NEAR(forced_square_mean(s, a, tau) / exact, 1, 1e-10) << s << " " << a << " " << tau;
            }
            const double exact = checks::volume_mean(line, 1, [&](const Vector& x) {
                const double f = (1 - s) * dragged(x[0], tau).value + s * x[0];
                return f * f;
            });
            EXPECT_NEAR(dragged_square_mean(s, tau) / exact, 1, 1e-10) << s << " " << tau;
        }
    }
    EXPECT_EQ(forced_square_mean(0, 0, 0), 0);
    EXPECT_EQ(dragged_square_mean(0, 0), 0);
}

TEST(LayerDiffusion, RepeatedErrorFunctionsHaveTheirValuesAtZero) { // iⁿerfc(0) = 1/(2ⁿ Γ(n/2 + 1))
    for (int n = 0; n < 8; ++n) {
        EXPECT_NEAR(repeated_erfc(n, 0), 1 / (std::pow(2, n) * std::tgamma(n / 2. + 1)), 1e-16);
        EXPECT_NEAR(checks::derivatives([&](double s) { return repeated_erfc(n + 1, 0.7 + s); }, 0.01).first,
                    -repeated_erfc(n, 0.7), 1e-13);
    }
}

} // namespace
} // namespace sphvv::analytic::layer
