// Every registered kernel against the definition of a smoothing kernel; constants that were published wrongly
// against the same checks.
//   solver_kernels --gtest_filter='*wendland_c2*'
#include "sphvv/solver/kernels.hpp"

#include "sphvv/solver/settings.hpp"
#include "sphvv/solver/tests/scenes.hpp"

#include <gsl/gsl_integration.h>
#include <gtest/gtest.h>

#include <filesystem>

namespace sphvv::solver {
namespace {

using scenes::pi;

/// Kernels are made of smooth pieces whose ends are multiples of this share of h.
constexpr double piece = 0.25;

int pieces(const Kernel& kernel) {
    return static_cast<int>(std::lround(kernel.support / piece));
}

/// Surface of the unit sphere.
constexpr std::array<double, 4> sphere{0, 2, 2 * pi, 4 * pi};

/// Integral over all space of a function of the distance that vanishes outside the support: Gauss-Legendre,
/// exact for polynomials of degree 31 on each piece.
template <class Function>
double integral_over_space(const Kernel& kernel, int dim, double h, const Function& function) {
    gsl_integration_glfixed_table* table = gsl_integration_glfixed_table_alloc(16);
    double total = 0;
    for (int part = 0; part < pieces(kernel); ++part) {
        for (std::size_t k = 0; k < 16; ++k) {
            double r = 0;
            double weight = 0;
            gsl_integration_glfixed_point(part * piece * h, (part + 1) * piece * h, k, &r, &weight, table);
            total += weight * sphere[dim] * std::pow(r, dim - 1) * function(r);
        }
    }
    gsl_integration_glfixed_table_free(table);
    return total;
}

/// A kernel with a slope at the origin is a cone there: no derivative is continuous, and F = W'/r has no
/// limit.
bool is_cone(const Kernel& kernel) {
    return kernel.derivative(0) != 0;
}

double integral(const Kernel& kernel, int dim, double h) {
    return integral_over_space(kernel, dim, h, [&](double r) { return kernel.value(dim, r, h); });
}

/// Derivative by central differences of order 8 (Fornberg 1988, table 1).
template <class Function>
double difference(const Function& function, double q, double step) {
    constexpr std::array weights{4. / 5, -1. / 5, 4. / 105, -1. / 280};
    double result = 0;
    for (int m = 1; m <= 4; ++m) {
        result += weights[m - 1] * (function(q + m * step) - function(q - m * step));
    }
    return result / step;
}

double slope_of_profile(const Kernel& kernel, double q) {
    double result = 0;
    const double squared = q * q;
    kernel.slopes({&squared, 1}, 1, 1, &result);
    return result;
}

TEST(Kernels, AreTheFilesOfTheFolder) {
    std::vector<std::string> stems;
    for (const auto& entry : std::filesystem::directory_iterator(SPHVV_SOLVER_FOLDER "/kernels")) {
        if (entry.path().extension() == ".cpp") {
            stems.push_back(entry.path().stem().string());
        }
    }
    std::ranges::sort(stems);
    std::vector<std::string> names;
    for (const Kernel* kernel : kernels::all()) {
        names.emplace_back(kernel->name);
    }
    EXPECT_FALSE(names.empty());
    EXPECT_EQ(names, stems);
}

TEST(Kernels, RefuseAnUnknownNameAndNameTheKnownOnes) {
    try {
        kernels::find("quintic");
        FAIL() << "found";
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("quintic_spline, wendland_c2"), std::string::npos)
            << error.what();
    }
}

class EveryKernel : public testing::TestWithParam<const Kernel*> {
protected:
    const Kernel& kernel = *GetParam();
    scenes::Random random{20240607};
};

INSTANTIATE_TEST_SUITE_P(All, EveryKernel, testing::ValuesIn(kernels::all().begin(), kernels::all().end()),
                         [](const auto& test) { return std::string(test.param->name); });

TEST_P(EveryKernel, IsFoundByItsName) {
    EXPECT_EQ(&kernels::find(kernel.name), &kernel);
}

TEST_P(EveryKernel, IsDeclaredInFull) {
    EXPECT_FALSE(kernel.name.empty());
    EXPECT_FALSE(kernel.summary.empty());
    EXPECT_FALSE(kernel.formula.empty());
    EXPECT_FALSE(kernel.source.empty());
    EXPECT_GT(kernel.support, 0);
    EXPECT_GE(kernel.smoothness, -1);
    EXPECT_LE(kernel.smoothness, is_cone(kernel) ? 0 : 6);
    EXPECT_EQ(std::fmod(kernel.support, piece), 0) << "the quadrature below needs whole pieces";
}

TEST_P(EveryKernel, IntegratesToOne) {
    for (const int dim : {1, 2, 3}) {
        for (const double h : {1.0, 0.013, 70.0}) {
            EXPECT_NEAR(integral(kernel, dim, h), 1, 1e-13) << dim << "-D, h = " << h;
        }
    }
}

// By parts: the integral of -F r^2 = -W' r over space is dim times the integral of W, less what a jump at the
// edge of the support leaves there.
TEST_P(EveryKernel, HasASlopeOfUnitFirstMoment) {
    for (const int dim : {1, 2, 3}) {
        for (const double h : {1.0, 0.013, 70.0}) {
            const double moment = integral_over_space(
                kernel, dim, h, [&](double r) { return -kernel.slope(dim, r, h) * r * r; });
            const double jump = kernel.smoothness < 0 ? kernel.f(std::nextafter(kernel.support, 0.)) : 0;
            const double at_edge =
                sphere[dim] * kernel.normalisation[dim] * std::pow(kernel.support, dim) * jump;
            EXPECT_NEAR(moment, dim - at_edge, 1e-12) << dim << "-D, h = " << h;
        }
    }
}

TEST_P(EveryKernel, HasTheDerivativeOfItsProfile) {
    constexpr double step = 1. / 512;
    for (int part = 0; part < pieces(kernel); ++part) {
        for (int draw = 0; draw < 20; ++draw) {
            const double q = random.uniform(part * piece + 4 * step, (part + 1) * piece - 4 * step);
            // round-off of f over the step
            EXPECT_NEAR(kernel.derivative(q), difference(kernel.f, q, step), 1e-12 * kernel.f(0)) << q;
        }
    }
}

TEST_P(EveryKernel, IsContinuousWithItsDerivativeAndSlope) {
    constexpr double apart = 1e-9;
    const int last = kernel.smoothness < 0 ? pieces(kernel) - 1 : pieces(kernel);
    for (int part = 1; part <= last; ++part) {
        const double q = part * piece;
        const double tolerance = 10 * apart * kernel.f(0);
        EXPECT_NEAR(kernel.f(q - apart), kernel.f(q + apart), tolerance) << q;
        EXPECT_NEAR(kernel.derivative(q - apart), kernel.derivative(q + apart), tolerance) << q;
        EXPECT_NEAR(slope_of_profile(kernel, q - apart), slope_of_profile(kernel, q + apart), tolerance / q)
            << q;
    }
}

TEST_P(EveryKernel, IsPositiveAndFallsMonotonicallyToZero) {
    constexpr int samples = 3000;
    for (int k = 0; k < samples; ++k) {
        const double q = kernel.support * k / samples;
        EXPECT_GT(kernel.f(q), 0) << q;
        EXPECT_GE(kernel.f(q), kernel.f(kernel.support * (k + 1) / samples)) << q;
        EXPECT_LE(kernel.derivative(q), 0) << q;
        if (q > 0) {
            EXPECT_LT(slope_of_profile(kernel, q), 0) << q;
        }
    }
}

TEST_P(EveryKernel, VanishesAtAndBeyondItsSupport) {
    for (const double q :
         {kernel.support, std::nextafter(kernel.support, 9.), kernel.support + 1e-6, 7.0, 1e3, 1e50}) {
        EXPECT_EQ(kernel.f(q), 0) << q;
        EXPECT_EQ(kernel.derivative(q), 0) << q;
        EXPECT_EQ(slope_of_profile(kernel, q), 0) << q;
    }
    for (const int dim : {1, 2, 3}) {
        for (const double h : {1e-6, 1.0, 1e6}) {
            EXPECT_EQ(kernel.slope(dim, 1e50, h), 0) << h;
            EXPECT_EQ(kernel.value(dim, 1e50, h), 0) << h;
        }
    }
}

TEST_P(EveryKernel, HasTheSlopeOfItsDerivative) {
    std::vector<double> samples;
    for (int part = 1; part <= pieces(kernel) + 1; ++part) {
        const double q = part * piece;
        samples.insert(samples.end(), {std::nextafter(q, 0.), q, std::nextafter(q, 9.)});
    }
    for (int draw = 0; draw < 1000; ++draw) {
        samples.push_back(random.uniform(0, kernel.support));
        samples.push_back(std::pow(10, random.uniform(-4, 0)));
    }
    for (const double q : samples) {
        // the derivative is a difference of numbers of the size of f(0)
        EXPECT_NEAR(slope_of_profile(kernel, q), kernel.derivative(q) / q, 1e-14 * kernel.f(0) * (1 + 1 / q))
            << q;
    }
}

TEST_P(EveryKernel, HasAFiniteSlopeAtTheOrigin) {
    const double at_origin = slope_of_profile(kernel, 0);
    ASSERT_TRUE(std::isfinite(at_origin));
    if (is_cone(kernel)) {
        EXPECT_EQ(at_origin, 0) << "the gradient has no direction";
        EXPECT_TRUE(std::isfinite(slope_of_profile(kernel, 1e-150)));
        return;
    }
    EXPECT_LT(at_origin, 0);
    for (const double q : {1e-150, 1e-12, 1e-8, 1e-6}) {
        EXPECT_NEAR(slope_of_profile(kernel, q) / at_origin, 1, 1e-14 + 10 * q) << q;
    }
}

TEST_P(EveryKernel, GivesTheSameSlopesInBatchesAsOneByOne) {
    constexpr double h = 0.3;
    for (std::size_t count = 0; count <= 19; ++count) {
        const std::vector<double> squared = random.values(count, 0, 1.2 * std::pow(kernel.support * h, 2));
        std::vector<double> batch(count + 1, 42.0);
        for (const int dim : {1, 2, 3}) {
            kernel.slopes(squared, h, kernel.slope_scale(dim, h), batch.data());
            for (std::size_t k = 0; k < count; ++k) {
                const double alone = kernel.slope(dim, std::sqrt(squared[k]), h);
                EXPECT_NEAR(batch[k], alone, 1e-12 * std::abs(alone) + 1e-14 * kernel.slope_scale(dim, h));
            }
            EXPECT_EQ(batch[count], 42) << "written beyond the end";
        }
    }
}

TEST_P(EveryKernel, GivesTheSameValuesInBatchesAsOneByOne) {
    constexpr double h = 0.3;
    for (std::size_t count = 0; count <= 19; ++count) {
        const std::vector<double> squared = random.values(count, 0, 1.2 * std::pow(kernel.support * h, 2));
        std::vector<double> batch(count + 1, 42.0);
        for (const int dim : {1, 2, 3}) {
            kernel.values(squared, h, kernel.value_scale(dim, h), batch.data());
            for (std::size_t k = 0; k < count; ++k) {
                const double alone = kernel.value(dim, std::sqrt(squared[k]), h);
                EXPECT_NEAR(batch[k], alone, 1e-12 * alone + 1e-14 * kernel.value(dim, 0, h));
            }
            EXPECT_EQ(batch[count], 42) << "written beyond the end";
        }
    }
}

TEST_P(EveryKernel, HasAGradientThatIsItsSlopeTimesTheSeparation) {
    constexpr double h = 0.7;
    for (const int dim : {1, 2, 3}) {
        for (int part = 0; part < pieces(kernel); ++part) {
            const double q = (part + 0.5) * piece;
            const double gradient =
                difference([&](double r) { return kernel.value(dim, r, h); }, q * h, h / 512);
            EXPECT_NEAR(kernel.slope(dim, q * h, h) * q * h, gradient, 1e-12 * kernel.value(dim, 0, h) / h);
        }
    }
}

TEST(QuinticSpline, HasThePublishedValues) {
    const Kernel& kernel = kernels::find("quintic_spline");
    EXPECT_EQ(kernel.support, 3);
    // 3^5 - 6 2^5 + 15, 2^5 - 6, 1 (Schoenberg's cardinal spline M6 times 120)
    EXPECT_DOUBLE_EQ(kernel.f(0), 66);
    EXPECT_DOUBLE_EQ(kernel.f(1), 26);
    EXPECT_DOUBLE_EQ(kernel.f(2), 1);
    // expansion about the origin: f' = -5 (24 q - 24 q^3 + 10 q^4)
    EXPECT_DOUBLE_EQ(slope_of_profile(kernel, 0), -120);
    EXPECT_DOUBLE_EQ(kernel.normalisation[1], 1. / 120);
    EXPECT_DOUBLE_EQ(kernel.normalisation[2], 7 / (478 * pi));
    EXPECT_DOUBLE_EQ(kernel.normalisation[3], 1 / (120 * pi));
}

// The slope is steepest where f'' = 0: 24 - 72 q^2 + 40 q^3 = 0, q = 0.7593 (Xu sheet §1.2).
TEST(QuinticSpline, IsSteepestAtThePublishedDistance) {
    const Kernel& kernel = kernels::find("quintic_spline");
    double steepest = 0;
    for (int sample = 0; sample < 300000; ++sample) {
        const double q = 1e-5 * sample;
        steepest = kernel.derivative(q) < kernel.derivative(steepest) ? q : steepest;
    }
    EXPECT_NEAR(steepest, 0.7593, 5e-5);
}

TEST(WendlandC2, HasThePublishedValues) {
    const Kernel& kernel = kernels::find("wendland_c2");
    EXPECT_EQ(kernel.support, 2);
    EXPECT_DOUBLE_EQ(kernel.f(0), 1);
    EXPECT_DOUBLE_EQ(kernel.f(1), 3. / 16);
    EXPECT_DOUBLE_EQ(kernel.derivative(1), -5. / 8);
    EXPECT_DOUBLE_EQ(slope_of_profile(kernel, 0), -5);
    EXPECT_DOUBLE_EQ(kernel.normalisation[1], 3. / 4);
    EXPECT_DOUBLE_EQ(kernel.normalisation[2], 7 / (4 * pi));
    EXPECT_DOUBLE_EQ(kernel.normalisation[3], 21 / (16 * pi));
}

struct PublishedValues {
    const char* kernel;
    double support;
    double at_zero;
    double at_one;
    std::array<double, 3> normalisation;
};

// Table of Xu 2009 App. A; Issa 2005 §3.2 with the exact constants; Dehnen & Aly 2012 table 1 with H = 2h.
// 1-D Wendland: four times the integral of (1-x)^6 (1 + 6x + 35/3 x^2) over (0, 1) is
// 4 (1/7 + 3/28 + 5/108) = 32/27; of (1-x)^8 (1 + 8x + 25x^2 + 32x^3), 4 (1/9 + 4/45 + 5/99 + 8/495) = 16/15.
const std::array published{
    PublishedValues{"cubic_spline", 2, 1, 1. / 4, {2. / 3, 10 / (7 * pi), 1 / pi}},
    PublishedValues{"quartic_spline", 2.5, 115. / 8, 4.75, {1. / 24, 96 / (1199 * pi), 1 / (20 * pi)}},
    PublishedValues{"quadratic", 2, 3. / 4, 3. / 16, {1, 2 / pi, 5 / (4 * pi)}},
    PublishedValues{"wendland_c4", 2, 1, 83. / 768, {27. / 32, 9 / (4 * pi), 495 / (256 * pi)}},
    PublishedValues{"wendland_c6", 2, 1, 61. / 1024, {15. / 16, 78 / (28 * pi), 1365 / (512 * pi)}},
};

TEST(Kernels, HaveThePublishedValues) {
    for (const PublishedValues& values : published) {
        SCOPED_TRACE(values.kernel);
        const Kernel& kernel = kernels::find(values.kernel);
        EXPECT_EQ(kernel.support, values.support);
        EXPECT_DOUBLE_EQ(kernel.f(0), values.at_zero);
        EXPECT_DOUBLE_EQ(kernel.f(1), values.at_one);
        for (int dim = 1; dim <= 3; ++dim) {
            EXPECT_DOUBLE_EQ(kernel.normalisation[dim], values.normalisation[dim - 1]) << dim << "-D";
        }
    }
}

// The cut takes so little that its constants are those of the uncut Gaussian to 5e-4.
TEST(Gaussian, IsTheUncutOneButForTheRenormalisation) {
    const Kernel& kernel = kernels::find("gaussian");
    EXPECT_DOUBLE_EQ(kernel.f(2), std::exp(-4));
    EXPECT_EQ(kernel.f(3), 0);
    for (int dim = 1; dim <= 3; ++dim) {
        const double uncut = std::pow(pi, -dim / 2.);
        EXPECT_GT(kernel.normalisation[dim], uncut);
        EXPECT_NEAR(kernel.normalisation[dim] / uncut, 1, 5e-4);
    }
}

struct PublishedMistake {
    const char* description;
    const char* kernel;
    int dim;
    double constant;
    double integral;
};

// The integrals follow from the right constants.
const std::array mistakes{
    PublishedMistake{"quintic 3/(359 pi) in 3-D", "quintic_spline", 3, 3 / (359 * pi), 360. / 359},
    PublishedMistake{"quintic 2-D constant in 3-D", "quintic_spline", 3, 7 / (478 * pi), 840. / 478},
    PublishedMistake{"quintic 3-D constant in 2-D", "quintic_spline", 2, 1 / (120 * pi), 478. / 840},
    PublishedMistake{"Wendland 7/(8 pi) in 3-D (Xu 2009)", "wendland_c2", 3, 7 / (8 * pi), 2. / 3},
    PublishedMistake{"Wendland 2-D constant in 3-D", "wendland_c2", 3, 7 / (4 * pi), 4. / 3},
    PublishedMistake{"constant 5/8 of the 1-D Wendland polynomial (1-q/2)^3 (3q/2+1)", "wendland_c2", 1,
                     5. / 8, 5. / 6},
};

TEST(PublishedMistakes, AreCaughtByTheUnitIntegral) {
    for (const PublishedMistake& mistake : mistakes) {
        SCOPED_TRACE(mistake.description);
        Kernel wrong = kernels::find(mistake.kernel);
        wrong.normalisation[mistake.dim] = mistake.constant;
        const double found = integral(wrong, mistake.dim, 1);
        EXPECT_NEAR(found, mistake.integral, 1e-12);
        EXPECT_GT(std::abs(found - 1), 1e-3);
    }
}

} // namespace
} // namespace sphvv::solver
