#include "sphvv/verification/kernel_checks.hpp"

#include <gsl/gsl_integration.h>
#include <gsl/gsl_sf_bessel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <memory>
#include <numbers>
#include <numeric>
#include <sstream>

namespace sphvv::verification {
namespace {

using solver::Kernel;
using std::numbers::pi;

constexpr double piece = 0.25;             // knots of every spline in q are multiples of it
constexpr double quadrature_error = 1e-12; // round-off of a sum of a few hundred terms
constexpr double h_test = 0.7;             // any h but 1 shows a wrong power of h
constexpr int samples = 3000;              // of q across the support
constexpr double largest_kh = 30;          // transforms of smooth kernels are round-off beyond
constexpr double kh_step = 0.05;           // lobes are wider than 1
constexpr double h_over_dx = 1.3;          // Xu 2009, for distances in particle spacings

constexpr std::array<double, 4> unit_sphere{0, 2, 2 * pi, 4 * pi}; // its surface

std::string number(double x) {
    std::ostringstream text;
    text.precision(4);
    text << x;
    return text.str();
}

std::string percent(double x) {
    return number(100 * x) + " %";
}

/// The larger of two numbers; NaN if one is, so that it reaches the verdict.
double larger(double a, double b) {
    return a >= b || std::isnan(a) ? a : b;
}

KernelCheck equality(const Kernel& kernel, int dimension, std::string check, double value, double expected,
                     double tolerance, std::string why) {
    return {.kernel = std::string(kernel.name),
            .dimension = dimension,
            .check = std::move(check),
            .value = value,
            .expected = expected,
            .tolerance = tolerance,
            .passes = std::abs(value - expected) <= tolerance,
            .why = std::move(why)};
}

struct Node {
    double q;
    double weight;
};

/// Gauss-Legendre nodes of 16 points on each piece of the support: exact for polynomials of degree 31, and to
/// round-off for a Gaussian or a transform up to kh = 30.
std::vector<Node> nodes_of(const Kernel& kernel) {
    constexpr std::size_t points = 16;
    const std::unique_ptr<gsl_integration_glfixed_table, void (*)(gsl_integration_glfixed_table*)> table(
        gsl_integration_glfixed_table_alloc(points), gsl_integration_glfixed_table_free);
    std::vector<Node> nodes;
    for (int part = 0; part * piece < kernel.support; ++part) {
        const double end = std::min((part + 1) * piece, kernel.support);
        for (std::size_t k = 0; k < points; ++k) {
            Node node{};
            gsl_integration_glfixed_point(part * piece, end, k, &node.q, &node.weight, table.get());
            nodes.push_back(node);
        }
    }
    return nodes;
}

/// Integral over all space of a function of the distance r that vanishes outside the support.
template <class Function>
double integral_over_space(const Kernel& kernel, int dim, const Function& function) {
    double total = 0;
    for (const auto& [q, weight] : nodes_of(kernel)) {
        const double r = q * h_test;
        total += weight * h_test * unit_sphere[dim] * std::pow(r, dim - 1) * function(r);
    }
    return total;
}

double just_inside(const Kernel& kernel) {
    return std::nextafter(kernel.support, 0.0);
}

/// What integration by parts of q^n W' leaves at the edge of the support: zero unless the value jumps there.
double surface_term(const Kernel& kernel, int dim) {
    return unit_sphere[dim] * kernel.normalisation[dim] * std::pow(kernel.support, dim) *
           kernel.f(just_inside(kernel));
}

KernelCheck gradient_of_linear_field(const Kernel& kernel, int dim) {
    const double value =
        integral_over_space(kernel, dim, [&](double r) { return kernel.slope(dim, r, h_test) * r * r; });
    const double surface = surface_term(kernel, dim);
    std::string why = "by parts: -dim times the unit integral";
    if (kernel.smoothness < 0) {
        why += ", less the jump at the edge: the gradient of a linear field is " + percent(surface / dim) +
               " too small";
    }
    return equality(kernel, dim, "gradient of a linear field", value, surface - dim, 10 * quadrature_error,
                    std::move(why));
}

KernelCheck second_moment(const Kernel& kernel, int dim) {
    const double value =
        integral_over_space(kernel, dim, [&](double r) { return kernel.value(dim, r, h_test) * r * r; }) /
        (h_test * h_test);
    const double fourth_of_slope =
        integral_over_space(kernel, dim,
                            [&](double r) { return kernel.slope(dim, r, h_test) * r * r * r * r; }) /
        (h_test * h_test);
    const double surface = surface_term(kernel, dim) * kernel.support * kernel.support;
    return equality(kernel, dim, "second moment", value, (surface - fourth_of_slope) / (dim + 2),
                    10 * quadrature_error,
                    "by parts from the slopes; the smoothing error of a field is " +
                        number(value / (2 * dim)) + " h^2 times its Laplacian");
}

/// Angular mean of exp(i k x) over the sphere of radius x/k: cos, J0, sin(x)/x.
double wave(int dim, double x) {
    return dim == 1 ? std::cos(x) : dim == 2 ? gsl_sf_bessel_J0(x) : gsl_sf_bessel_j0(x);
}

struct Least {
    double value;
    double kh;
};

Least least_transform(const Kernel& kernel, int dim) {
    const std::vector<Node> nodes = nodes_of(kernel);
    std::vector<double> shells;
    shells.reserve(nodes.size());
    for (const auto& [q, weight] : nodes) {
        shells.push_back(weight * unit_sphere[dim] * std::pow(q, dim - 1) * kernel.value(dim, q, 1));
    }
    Least least{1, 0}; // the transform at k = 0
    for (int step = 1; step * kh_step <= largest_kh; ++step) {
        const double kh = step * kh_step;
        double transform = 0;
        for (std::size_t k = 0; k < nodes.size(); ++k) {
            transform += shells[k] * wave(dim, kh * nodes[k].q);
        }
        if (std::isnan(transform)) {
            return {transform, kh};
        }
        if (transform < least.value) {
            least = {transform, kh};
        }
    }
    return least;
}

KernelCheck transform_sign(const Kernel& kernel, int dim) {
    const Least least = least_transform(kernel, dim);
    const bool declared = kernel.nonnegative_transform[dim];
    KernelCheck result = equality(kernel, dim, "transform", least.value, 0, quadrature_error, "");
    result.passes = declared ? least.value >= -quadrature_error : least.value < -quadrature_error;
    result.why = std::string(declared ? "declared nonnegative: must not fall below -tolerance"
                                      : "declared to change sign: must fall below -tolerance") +
                 "; least at kh = " + number(least.kh) +
                 "; particles may pair where it is negative (Dehnen & Aly 2012)";
    return result;
}

constexpr double difference_step = 1. / 512;
constexpr double difference_reach = 4 * difference_step;

/// f' by central differences of order 8 (Fornberg 1988, table 1).
double difference(const Kernel& kernel, double q) {
    constexpr std::array weights{4. / 5, -1. / 5, 4. / 105, -1. / 280};
    double result = 0;
    for (int m = 1; m <= 4; ++m) {
        result += weights[m - 1] * (kernel.f(q + m * difference_step) - kernel.f(q - m * difference_step));
    }
    return result / difference_step;
}

KernelCheck derivative(const Kernel& kernel) {
    constexpr int per_piece = 50;
    double worst = 0;
    for (int part = 0; (part + 1) * piece <= kernel.support; ++part) {
        for (int k = 0; k < per_piece; ++k) {
            const double q =
                part * piece + difference_reach + (k + 0.5) / per_piece * (piece - 2 * difference_reach);
            worst = larger(worst, std::abs(kernel.derivative(q) - difference(kernel, q)));
        }
    }
    return equality(kernel, 0, "derivative", worst / kernel.f(0), 0, 2e-12,
                    "largest misfit of f' and differences of f over f(0); the tolerance is the round-off of "
                    "the differences");
}

KernelCheck slopes(const Kernel& kernel) {
    constexpr double scale = -3; // any but 1
    std::vector<double> q{0};
    for (int k = 0; k < samples; ++k) {
        q.push_back(kernel.support * (k + 0.5) / samples);
        q.push_back(std::pow(10.0, -8.0 * k / samples));
    }
    std::vector<double> squared;
    std::transform(q.begin(), q.end(), std::back_inserter(squared),
                   [](double x) { return x * x * h_test * h_test; });
    std::vector<double> slope(q.size());
    kernel.slopes(squared, h_test, scale, slope.data());
    double worst = std::isfinite(slope[0]) ? 0 : HUGE_VAL;
    for (std::size_t k = 1; k < q.size(); ++k) {
        const double misfit = std::abs(slope[k] / scale * q[k] - kernel.derivative(q[k]));
        worst = larger(worst, misfit);
    }
    return equality(kernel, 0, "slopes", worst / kernel.f(0), 0, 1e-13,
                    "largest misfit of q slopes() and f' over f(0); r = 0 must be finite");
}

KernelCheck positivity(const Kernel& kernel) {
    int failures = 0;
    for (int k = 0; k < samples; ++k) {
        failures += kernel.f(kernel.support * k / samples) > 0 ? 0 : 1;
    }
    return equality(kernel, 0, "positivity", failures, 0, 0,
                    "a density or a weight of one sign; counted over " + std::to_string(samples) +
                        " samples inside the support");
}

KernelCheck monotonicity(const Kernel& kernel) {
    double rise = 0;
    for (int k = 0; k < samples; ++k) {
        const double q = kernel.support * k / samples;
        const double next = kernel.support * (k + 1) / samples;
        rise = larger(rise, larger(kernel.f(next) - kernel.f(q), kernel.derivative(q)));
    }
    return equality(kernel, 0, "monotonicity", rise / kernel.f(0), 0, 1e-15,
                    "a nearer particle never counts less, and pressure never attracts");
}

KernelCheck value_at_edge(const Kernel& kernel) {
    const double value = kernel.f(just_inside(kernel)) / kernel.f(0);
    KernelCheck result = equality(kernel, 0, "value at the edge", value, 0, quadrature_error,
                                  "a continuous kernel falls to zero");
    if (kernel.smoothness < 0) {
        result.passes = value > result.tolerance;
        result.why = "smoothness -1 declares a jump: must exceed the tolerance";
    }
    return result;
}

KernelCheck slope_at_edge(const Kernel& kernel) {
    const double value = kernel.derivative(just_inside(kernel)) / kernel.f(0);
    KernelCheck result = equality(kernel, 0, "slope at the edge", value, 0, quadrature_error,
                                  "a kernel with a continuous derivative has none at the edge");
    if (kernel.smoothness < 1) {
        result.passes = value <= 0 && std::isfinite(value);
        result.why = "smoothness " + std::to_string(kernel.smoothness) + " allows any slope <= 0";
    }
    return result;
}

KernelCheck slope_at_origin(const Kernel& kernel) {
    const double value = kernel.derivative(0) / kernel.f(0);
    KernelCheck result = equality(kernel, 0, "slope at the origin", value, 0, quadrature_error,
                                  "a kernel with a continuous derivative is flat at r = 0");
    if (kernel.smoothness < 1) {
        result.passes = value <= 0 && std::isfinite(value);
        result.why = "smoothness " + std::to_string(kernel.smoothness) +
                     " allows a cone (slope < 0), whose W'/r has no limit at r = 0";
    }
    return result;
}

KernelCheck beyond_support(const Kernel& kernel) {
    double largest = 0;
    for (const double q : {kernel.support, std::nextafter(kernel.support, 2 * kernel.support),
                           kernel.support + 1e-6, 1.5 * kernel.support, 1e3, 1e50}) {
        double slope = 0;
        const double squared = q * q;
        kernel.slopes({&squared, 1}, 1, 1, &slope);
        for (const double x : {kernel.f(q), kernel.derivative(q), slope}) {
            largest = larger(largest, std::abs(x));
        }
    }
    return equality(kernel, 0, "beyond the support", largest, 0, 0,
                    "neighbour lists end at the support, and carry pairs beyond it in their skin");
}

/// Largest |8th difference| of spacing `step` of f continued evenly to q < 0. It falls as step^min(s + 1, 8)
/// where the s-th derivative is the last continuous one, whatever the knots.
double largest_difference(const Kernel& kernel, double step) {
    constexpr std::array<double, 9> binomial{1, -8, 28, -56, 70, -56, 28, -8, 1};
    constexpr int shifts = 4; // against the knots
    double largest = 0;
    for (int k = -8 * shifts; k * step / shifts <= kernel.support; ++k) {
        double sum = 0;
        for (int m = 0; m <= 8; ++m) {
            sum += binomial[m] * kernel.f(std::abs((k * 1.0 / shifts + m) * step));
        }
        largest = larger(largest, std::abs(sum));
    }
    return largest;
}

KernelCheck smoothness(const Kernel& kernel) {
    constexpr double step = 1. / 128; // fine enough for the jump to rule, coarse enough for round-off not to
    const double rate = std::log2(largest_difference(kernel, 2 * step) / largest_difference(kernel, step));
    return equality(kernel, 0, "smoothness", rate - 1, kernel.smoothness, 0.3,
                    "declared; the jump of the next derivative rules the rate at which differences fall");
}

/// Where a function of q is least on [from, to]; 0 if that is at the first sample, NaN if there is no number.
template <class Function>
double place_of_minimum(const Function& function, double from, double to) {
    const double spacing = (to - from) / samples;
    int least = 0;
    for (int k = 1; k < samples; ++k) {
        least = function(from + k * spacing) < function(from + least * spacing) ? k : least;
    }
    if (least == 0) {
        return std::isnan(function(from)) ? function(from) : 0;
    }
    double low = from + (least - 1) * spacing;
    double high = from + (least + 1) * spacing;
    while (high - low > 1e-9) {
        const double third = (high - low) / 3;
        if (function(low + third) < function(high - third)) {
            high -= third;
        } else {
            low += third;
        }
    }
    return std::midpoint(low, high);
}

KernelCheck steepest(const Kernel& kernel) {
    const double value = place_of_minimum([&](double q) { return kernel.derivative(q); }, 0, kernel.support);
    const double inflection = place_of_minimum([&](double q) { return difference(kernel, q); },
                                               difference_reach, kernel.support - difference_reach);
    const std::string closer = value > 0 ? "pairs closer than " + number(value * h_over_dx) +
                                               " dx, at h/dx = " + number(h_over_dx) +
                                               ", repel less the closer they are"
                                         : "pairs repel the more the closer they are";
    return equality(kernel, 0, "steepest", value, inflection, 1e-5, "q of the inflection of f; " + closer);
}

constexpr std::string_view polynomial_of_1d = "Dehnen & Aly 2012 table 1, H = 2h, where it is right";
constexpr std::string_view trixi = "TrixiParticles.jl 0.3, documentation of WendlandC2Kernel";

// In units of h: C_dim of W = C_dim / h^dim f(q).
constexpr std::array errors{
    KnownError{"Wendland C2 in 3-D, Xu", "7/(8 pi h^3)", "Xu 2009 App. A", "wendland_c2", 3, 7 / (8 * pi)},
    KnownError{"quintic spline in 3-D, 359", "3/(359 pi h^3)",
               "much quoted beside the right 7/(478 pi h^2); GANDALF src/QuinticKernel.cpp (17b658c)",
               "quintic_spline", 3, 3 / (359 * pi)},
    KnownError{"quartic spline in 2-D, Issa", "51/2000, for 96/(1199 pi)", "Issa 2005 §3.2", "quartic_spline",
               2, 51. / 2000},
    KnownError{"quartic spline in 3-D, Issa", "51/2000, the 2-D constant", "Issa 2005 eq. 6.44",
               "quartic_spline", 3, 51. / 2000},
    KnownError{"quintic spline in 3-D, Issa", "7/(478 pi), the 2-D constant", "Issa 2005 eq. 6.45",
               "quintic_spline", 3, 7 / (478 * pi)},
    KnownError{"Wendland C2 in 2-D, TrixiParticles", "40/(7 pi) with (1-q/2)^4 (2q+1), for 7/(4 pi)", trixi,
               "wendland_c2", 2, 40 / (7 * pi)},
    KnownError{"Wendland C2 in 3-D, TrixiParticles",
               "21/(2 pi) with (1-q/2)^4 (2q+1): right for the support h", trixi, "wendland_c2", 3,
               21 / (2 * pi)},
    KnownError{"Wendland C2 in 1-D, of the 1-D polynomial", "5/(8h), of (1-q/2)^3 (3/2 q + 1)",
               polynomial_of_1d, "wendland_c2", 1, 5. / 8},
    KnownError{"Wendland C4 in 1-D, of the 1-D polynomial", "3/(4h), of (1-q/2)^5 (2q^2 + 5/2 q + 1)",
               polynomial_of_1d, "wendland_c4", 1, 3. / 4},
    KnownError{"Wendland C6 in 1-D, of the 1-D polynomial",
               "55/(64h), of (1-q/2)^7 (21/8 q^3 + 19/4 q^2 + 7/2 q + 1)", polynomial_of_1d, "wendland_c6", 1,
               55. / 64},
};

} // namespace

KernelCheck unit_integral(const Kernel& kernel, int dimension) {
    const double value =
        integral_over_space(kernel, dimension, [&](double r) { return kernel.value(dimension, r, h_test); });
    return equality(kernel, dimension, "unit integral", value, 1, quadrature_error,
                    "definition: the smoothed value of a constant field is the constant");
}

std::vector<KernelCheck> check_kernel(const Kernel& kernel) {
    std::vector<KernelCheck> checks;
    for (const int dim : {1, 2, 3}) {
        checks.push_back(unit_integral(kernel, dim));
        checks.push_back(gradient_of_linear_field(kernel, dim));
        checks.push_back(second_moment(kernel, dim));
        checks.push_back(transform_sign(kernel, dim));
    }
    for (KernelCheck (*check)(const Kernel&) :
         {derivative, slopes, positivity, monotonicity, value_at_edge, slope_at_edge, slope_at_origin,
          beyond_support, smoothness, steepest}) {
        checks.push_back(check(kernel));
    }
    return checks;
}

std::span<const KnownError> known_errors() {
    return errors;
}

KernelCheck check_known_error(const KnownError& error) {
    Kernel wrong = solver::kernels::find(error.kernel);
    wrong.normalisation[error.dimension] = error.constant;
    KernelCheck result = unit_integral(wrong, error.dimension);
    result.check = "known error: " + std::string(error.name);
    result.passes = !result.passes;
    result.why = "passes if the unit integral refuses " + std::string(error.printed) + " (" +
                 std::string(error.source) + ")";
    return result;
}

} // namespace sphvv::verification
