// Every registered kernel passes every check; every check refuses a kernel that is damaged on purpose; every
// known error in print is caught.
//   verification_kernel_checks --gtest_filter='*wendland_c2*'
#include "sphvv/verification/kernel_checks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace {

using namespace sphvv::verification;
using sphvv::solver::Kernel;
using sphvv::solver::kernel_slopes;
namespace kernels = sphvv::solver::kernels;
using std::numbers::pi;

using CheckInDimension = std::pair<std::string, int>;

const KernelCheck& find(const std::vector<KernelCheck>& checks, const std::string& name, int dimension = 0) {
    const auto found = std::ranges::find_if(checks, [&](const KernelCheck& check) {
        return check.check == name && check.dimension == dimension;
    });
    if (found == checks.end()) {
        throw std::out_of_range("no check " + name);
    }
    return *found;
}

std::set<CheckInDimension> failures(const Kernel& kernel) {
    std::set<CheckInDimension> result;
    for (const KernelCheck& check : check_kernel(kernel)) {
        if (!check.passes) {
            result.emplace(check.check, check.dimension);
        }
    }
    return result;
}

class EveryKernel : public testing::TestWithParam<const Kernel*> {};

INSTANTIATE_TEST_SUITE_P(All, EveryKernel, testing::ValuesIn(kernels::all().begin(), kernels::all().end()),
                         [](const auto& test) { return std::string(test.param->name); });

TEST_P(EveryKernel, PassesEveryCheck) {
    for (const KernelCheck& check : check_kernel(*GetParam())) {
        EXPECT_TRUE(check.passes) << check.check << " in " << check.dimension << "-D: " << check.value
                                  << ", expected " << check.expected << " ± " << check.tolerance << ": "
                                  << check.why;
        EXPECT_EQ(check.kernel, GetParam()->name);
        EXPECT_FALSE(check.why.empty());
    }
}

// The same inequality, in each dimension, from the other side.
TEST_P(EveryKernel, FailsWithTheOppositeDeclarations) {
    for (const int dim : {1, 2, 3}) {
        Kernel kernel = *GetParam();
        kernel.nonnegative_transform[dim] = !kernel.nonnegative_transform[dim];
        EXPECT_EQ(failures(kernel), std::set<CheckInDimension>({{"transform", dim}}));
        kernel = *GetParam();
        kernel.normalisation[dim] *= 1 + 1e-9;
        EXPECT_TRUE(failures(kernel).contains({"unit integral", dim}));
    }
    for (const int change : {-1, 1}) {
        Kernel kernel = *GetParam();
        kernel.smoothness += change;
        EXPECT_TRUE(failures(kernel).contains({"smoothness", 0})) << change;
    }
}

// The variance of a B-spline of n boxes of width h is n h^2/12; of the Gaussian, dim/2 h^2 but for the cut.
TEST(KernelChecks, FindKnownSecondMoments) {
    const std::map<std::string, double> known{
        {"cubic_spline", 4. / 12}, {"quartic_spline", 5. / 12}, {"quintic_spline", 6. / 12}};
    for (const auto& [name, variance] : known) {
        EXPECT_NEAR(find(check_kernel(kernels::find(name)), "second moment", 1).value, variance, 1e-12);
    }
    for (const int dim : {1, 2, 3}) {
        EXPECT_NEAR(find(check_kernel(kernels::find("gaussian")), "second moment", dim).value, dim / 2.,
                    0.005 * dim);
    }
}

// Zeros of f'': Xu 2009 §2.1.4 and the table of Issa 2005; Wendland's from f' = -q (1-q/2)^n p(q).
TEST(KernelChecks, FindWhereTheSlopeIsSteepest) {
    const std::map<std::string, double> known{
        {"cubic_spline", 2. / 3}, {"quartic_spline", 0.6910}, {"quintic_spline", 0.7593},
        {"quadratic", 0},         {"wendland_c2", 0.5},       {"gaussian", std::numbers::sqrt2 / 2}};
    for (const auto& [name, q] : known) {
        EXPECT_NEAR(find(check_kernel(kernels::find(name)), "steepest").value, q, 5e-5) << name;
    }
    const KernelCheck quintic = find(check_kernel(kernels::find("quintic_spline")), "steepest");
    EXPECT_NE(quintic.why.find("0.9871 dx"), std::string::npos) << quintic.why;
}

// The transform of the 1-D B-spline is [sin(k/2)/(k/2)]^n: an odd power is negative in its first lobe.
TEST(KernelChecks, FindTheTransformOfTheQuartic) {
    double least = 0;
    for (int step = 1; step <= 600; ++step) {
        const double half = 0.5 * (0.05 * step);
        least = std::min(least, std::pow(std::sin(half) / half, 5));
    }
    const auto checks = check_kernel(kernels::find("quartic_spline"));
    EXPECT_NEAR(find(checks, "transform", 1).value, least, 1e-13);
    EXPECT_LT(least, -1e-4);
}

TEST(KernelChecks, ReportTheJumpOfTheCutGaussian) {
    const auto checks = check_kernel(kernels::find("gaussian"));
    EXPECT_NEAR(find(checks, "value at the edge").value, std::exp(-9), 1e-15);
    // the surface term: the area of the edge, 4 pi 3^2, times 3 W
    const double deficit =
        4 * pi * 27 * std::exp(-9) / (std::pow(pi, 1.5) * std::erf(3) - 6 * pi * std::exp(-9));
    EXPECT_NEAR(find(checks, "gradient of a linear field", 3).value, deficit - 3, 1e-12);
}

/// Batch function of a damaged profile whose f'/q is formed by division.
template <double (*Derivative)(double)>
struct Divided {
    static double derivative_over_q(double q) { return q > 0 ? Derivative(q) / q : 0; }
};

double damaged_positive(double q) {
    return q < 2 ? 1 - q * q / 2 + q * q * q / 8 - 0.1 : 0;
}
double rising(double q) {
    return q < 2 ? (4 - q * q) * (4 - q * q) * (1 + q * q) : 0;
}
double hat(double q) {
    return q < 2 ? 1 - q / 2 : 0;
}
double hat_derivative(double q) {
    return q < 2 ? -0.5 : 0;
}
double long_tail(double q) {
    return std::exp(-q);
}
double rising_derivative(double q) {
    return q < 2 ? 2 * q * (4 - q * q) * (2 - 3 * q * q) : 0;
}
double not_a_number(double) {
    return std::numeric_limits<double>::quiet_NaN();
}

struct Damage {
    const char* what;
    const char* kernel;
    std::vector<CheckInDimension> caught_by;
    void (*apply)(Kernel&);
};

const Kernel& wendland() {
    return kernels::find("wendland_c2");
}

const std::vector<Damage> damages{
    {"2-D constant 0.1 % too large",
     "wendland_c2",
     {{"unit integral", 2}},
     [](Kernel& kernel) { kernel.normalisation[2] *= 1.001; }},
    {"3-D constant in 2-D",
     "cubic_spline",
     {{"unit integral", 2}},
     [](Kernel& kernel) { kernel.normalisation[2] = kernel.normalisation[3]; }},
    {"constants of another spline",
     "quintic_spline",
     {{"unit integral", 1}, {"unit integral", 2}, {"unit integral", 3}},
     [](Kernel& kernel) { kernel.normalisation = kernels::find("quartic_spline").normalisation; }},
    {"no constant in 1-D",
     "cubic_spline",
     {{"unit integral", 1}},
     [](Kernel& kernel) { kernel.normalisation[1] = 0; }},
    {"sign of the derivative",
     "wendland_c2",
     {{"derivative", 0}, {"monotonicity", 0}, {"slopes", 0}},
     [](Kernel& kernel) { kernel.derivative = [](double q) { return -wendland().derivative(q); }; }},
    {"derivative of a spline between its knots",
     "quintic_spline",
     {{"derivative", 0}},
     [](Kernel& kernel) {
         kernel.derivative = [](double q) {
             return kernels::find("quintic_spline").derivative(q) + (q > 2 && q < 3 ? -1e-6 : 0);
         };
     }},
    {"steepest elsewhere",
     "wendland_c2",
     {{"steepest", 0}, {"derivative", 0}},
     [](Kernel& kernel) { kernel.derivative = [](double q) { return (1 + q) * wendland().derivative(q); }; }},
    {"slopes 1 % too large",
     "wendland_c2",
     {{"slopes", 0},
      {"gradient of a linear field", 1},
      {"gradient of a linear field", 2},
      {"gradient of a linear field", 3},
      {"second moment", 1},
      {"second moment", 2},
      {"second moment", 3}},
     [](Kernel& kernel) {
         kernel.slopes = [](std::span<const double> squared, double h, double scale, double* slope) {
             wendland().slopes(squared, h, 1.01 * scale, slope);
         };
     }},
    {"slopes that ignore h",
     "wendland_c2",
     {{"slopes", 0}},
     [](Kernel& kernel) {
         kernel.slopes = [](std::span<const double> squared, double, double scale, double* slope) {
             wendland().slopes(squared, 1, scale, slope);
         };
     }},
    {"slopes that go on beyond the support",
     "quadratic",
     {{"beyond the support", 0}},
     [](Kernel& kernel) {
         kernel.slopes = [](std::span<const double> squared, double h, double scale, double* slope) {
             kernels::find("quadratic").slopes(squared, h, scale, slope);
             for (std::size_t k = 0; k < squared.size(); ++k) {
                 slope[k] -= squared[k] > 4 * h * h ? 1e-9 : 0;
             }
         };
     }},
    {"infinite slope at r = 0",
     "quadratic",
     {{"slopes", 0}},
     [](Kernel& kernel) {
         kernel.slopes = [](std::span<const double> squared, double h, double scale, double* slope) {
             kernels::find("quadratic").slopes(squared, h, scale, slope);
             slope[0] = squared[0] == 0 ? -std::numeric_limits<double>::infinity() : slope[0];
         };
     }},
    {"negative near the edge",
     "wendland_c2",
     {{"positivity", 0}},
     [](Kernel& kernel) { kernel.f = damaged_positive; }},
    {"rises before it falls",
     "wendland_c2",
     {{"monotonicity", 0}},
     [](Kernel& kernel) {
         kernel.f = rising;
         kernel.derivative = rising_derivative;
     }},
    {"support too short",
     "wendland_c2",
     {{"value at the edge", 0}, {"slope at the edge", 0}},
     [](Kernel& kernel) { kernel.support = 1.75; }},
    {"value goes on beyond the support",
     "wendland_c2",
     {{"beyond the support", 0}},
     [](Kernel& kernel) { kernel.f = long_tail; }},
    {"jump declared, none there",
     "wendland_c2",
     {{"value at the edge", 0}, {"smoothness", 0}},
     [](Kernel& kernel) { kernel.smoothness = -1; }},
    {"hat declared smooth",
     "wendland_c2",
     {{"smoothness", 0}, {"slope at the edge", 0}, {"slope at the origin", 0}},
     [](Kernel& kernel) {
         kernel.f = hat;
         kernel.derivative = hat_derivative;
         kernel.slopes = kernel_slopes<Divided<hat_derivative>>;
     }},
    {"cone declared smooth",
     "quadratic",
     {{"slope at the origin", 0}},
     [](Kernel& kernel) { kernel.smoothness = 1; }},
};

TEST(KernelChecks, CatchEveryDamage) {
    std::set<std::string> able_to_fail;
    for (const Damage& damage : damages) {
        SCOPED_TRACE(damage.what);
        Kernel kernel = kernels::find(damage.kernel);
        damage.apply(kernel);
        const auto failed = failures(kernel);
        for (const CheckInDimension& check : damage.caught_by) {
            EXPECT_TRUE(failed.contains(check)) << check.first << " in " << check.second << "-D";
            able_to_fail.insert(check.first);
        }
    }
    able_to_fail.insert("transform"); // EveryKernel.FailsWithTheOppositeDeclarations
    for (const KernelCheck& check : check_kernel(wendland())) {
        EXPECT_TRUE(able_to_fail.contains(check.check)) << "no damage is caught by " << check.check;
    }
}

TEST(KernelChecks, FailWhereNothingCanBeEvaluated) {
    Kernel kernel = wendland();
    kernel.f = not_a_number;
    kernel.derivative = not_a_number;
    kernel.slopes = kernel_slopes<Divided<not_a_number>>;
    for (const KernelCheck& check : check_kernel(kernel)) {
        EXPECT_FALSE(check.passes) << check.check;
    }
}

TEST(KnownErrors, AreCaughtWithTheIntegralThatTheRightConstantsImply) {
    const std::array integrals{2. / 3,
                               360. / 359,
                               51. / 2000 * 1199 * pi / 96,
                               51. / 2000 * 20 * pi,
                               840. / 478,
                               160. / 49,
                               8.,
                               5. / 6,
                               8. / 9,
                               11. / 12};
    ASSERT_EQ(known_errors().size(), integrals.size());
    for (std::size_t k = 0; k < integrals.size(); ++k) {
        const KernelCheck check = check_known_error(known_errors()[k]);
        EXPECT_TRUE(check.passes) << check.check << ": " << check.value;
        EXPECT_NEAR(check.value, integrals[k], 1e-11) << check.check;
        EXPECT_GT(std::abs(check.value - 1), 5e-4) << check.check;
    }
}

TEST(KnownErrors, AreNotCaughtWhereTheConstantIsRight) {
    for (const Kernel* kernel : kernels::all()) {
        for (const int dim : {1, 2, 3}) {
            const KnownError right{"no error", "", "", kernel->name, dim, kernel->normalisation[dim]};
            EXPECT_FALSE(check_known_error(right).passes) << kernel->name << " in " << dim << "-D";
        }
    }
}

TEST(KnownErrors, AreNamedOnceAndSourced) {
    std::set<std::string_view> names;
    for (const KnownError& error : known_errors()) {
        EXPECT_TRUE(names.insert(error.name).second) << error.name;
        EXPECT_FALSE(error.printed.empty());
        EXPECT_FALSE(error.source.empty());
    }
}

} // namespace
