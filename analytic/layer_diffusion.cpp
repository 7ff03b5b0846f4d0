#include "sphvv/analytic/layer_diffusion.hpp"

#include <gsl/gsl_sf_zeta.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sphvv::analytic::layer {
namespace {

using std::numbers::pi;

constexpr double negligible_exponent = 40; // e^-40 = 4e-18
constexpr double most_terms = 1e5;

double sign_of(int m) {
    return m % 2 == 0 ? 1 : -1;
}

/// Number of eigenfunctions n, with eigenvalues of about (n pi)^2, that have not yet decayed at tau.
int living_terms(double tau) {
    const double terms = tau > 0 ? std::ceil(std::sqrt(negligible_exponent / tau) / pi) + 1 : most_terms;
    return static_cast<int>(std::min(terms, most_terms));
}

} // namespace

double repeated_erfc(int n, double x) {
    double before = 2 / std::sqrt(pi) * std::exp(-x * x); // i⁻¹erfc
    double value = std::erfc(x);
    for (int k = 1; k <= n; ++k) {
        const double next = (before - 2 * x * value) / (2 * k);
        before = value;
        value = next;
    }
    return value;
}

Profile forced_steady(double zeta) {
    return {zeta * (2 - zeta), 2 - 2 * zeta, 2. / 3};
}

Profile forced_by_eigenfunctions(double zeta, double tau, int terms) {
    Profile f = forced_steady(zeta);
    for (int n = 0; n < terms; ++n) {
        const double lambda = (n + 0.5) * pi;
        const double decayed = 4 / (lambda * lambda) * std::exp(-lambda * lambda * tau);
        f.value -= decayed / lambda * std::sin(lambda * zeta);
        f.gradient -= decayed * std::cos(lambda * zeta);
        f.mean -= decayed / (lambda * lambda);
    }
    return f;
}

Profile forced_by_images(double zeta, double tau, int terms) {
    if (tau <= 0) {
        return {0, 0, 0};
    }
    const double width = 2 * std::sqrt(tau);
    Profile f{1, 0, 1};
    for (int m = 0; m < terms; ++m) {
        const double below = (2 * m + zeta) / width;
        const double above = (2 * m + 2 - zeta) / width;
        f.value -= 4 * sign_of(m) * (repeated_erfc(2, below) + repeated_erfc(2, above));
        f.gradient += 4 * sign_of(m) * (repeated_erfc(1, below) - repeated_erfc(1, above)) / width;
        f.mean -= 4 * sign_of(m) * width *
                  (repeated_erfc(3, 2 * m / width) - repeated_erfc(3, 2 * (m + 1) / width));
    }
    return {2 * tau * f.value, 2 * tau * f.gradient, 2 * tau * f.mean};
}

Profile forced(double zeta, double tau) {
    return tau < switch_time ? forced_by_images(zeta, tau) : forced_by_eigenfunctions(zeta, tau);
}

Profile released_by_eigenfunctions(double zeta, double tau, int terms) {
    Profile f{0, 0, 0};
    for (int n = 0; n < terms; ++n) {
        const double lambda = (n + 0.5) * pi;
        const double decayed = 2 * sign_of(n) / lambda * std::exp(-lambda * lambda * tau);
        f.value += decayed / lambda * std::sin(lambda * zeta);
        f.gradient += decayed * std::cos(lambda * zeta);
        f.mean += decayed / (lambda * lambda);
    }
    return f;
}

Profile released_by_images(double zeta, double tau, int terms) {
    if (tau <= 0) {
        return {zeta, 1, 0.5};
    }
    const double width = 2 * std::sqrt(tau);
    Profile f{zeta, 1, 0.5};
    for (int m = 0; m < terms; ++m) {
        const double above = (2 * m + 1 - zeta) / width;
        const double below = (2 * m + 1 + zeta) / width;
        f.value -= sign_of(m) * width * (repeated_erfc(1, above) - repeated_erfc(1, below));
        f.gradient -= sign_of(m) * (std::erfc(above) + std::erfc(below));
        f.mean -= sign_of(m) * width * width *
                  (repeated_erfc(2, 2 * m / width) - 2 * repeated_erfc(2, (2 * m + 1) / width) +
                   repeated_erfc(2, (2 * m + 2) / width));
    }
    return f;
}

Profile released(double zeta, double tau) {
    return tau < switch_time ? released_by_images(zeta, tau) : released_by_eigenfunctions(zeta, tau);
}

Profile dragged_by_eigenfunctions(double zeta, double tau, int terms) {
    Profile f{zeta, 1, 0.5};
    for (int n = 1; n <= terms; ++n) {
        const double lambda = n * pi;
        const double decayed = 2 * sign_of(n) * std::exp(-lambda * lambda * tau);
        f.value += decayed / lambda * std::sin(lambda * zeta);
        f.gradient += decayed * std::cos(lambda * zeta);
        f.mean += decayed / (lambda * lambda) * (1 - sign_of(n));
    }
    return f;
}

Profile dragged_by_images(double zeta, double tau, int terms) {
    if (tau <= 0) {
        return {zeta < 1 ? 0. : 1., 0, 0};
    }
    const double width = 2 * std::sqrt(tau);
    Profile f{0, 0, 0};
    for (int m = 0; m < terms; ++m) {
        const double above = (2 * m + 1 - zeta) / width;
        const double below = (2 * m + 1 + zeta) / width;
        f.value += std::erfc(above) - std::erfc(below);
        f.gradient += 2 / std::sqrt(pi) * (std::exp(-above * above) + std::exp(-below * below)) / width;
        f.mean += width * (repeated_erfc(1, 2 * m / width) - 2 * repeated_erfc(1, (2 * m + 1) / width) +
                           repeated_erfc(1, (2 * m + 2) / width));
    }
    return f;
}

Profile dragged(double zeta, double tau) {
    return tau < switch_time ? dragged_by_images(zeta, tau) : dragged_by_eigenfunctions(zeta, tau);
}

double forced_square_mean(double s, double a, double tau) {
    const int terms = living_terms(tau);
    const auto risen = [&](double lambda) { // 1 − (1 − s) e^{−λ²τ} without cancellation for small τ
        return s - (1 - s) * std::expm1(-lambda * lambda * tau);
    };
    double sum = 16 * gsl_sf_hzeta(6, terms + 0.5) / std::pow(pi, 6) * std::pow(risen(terms * pi), 2);
    for (int n = terms - 1; n >= 0; --n) { // the smallest first
        const double lambda = (n + 0.5) * pi;
        const double coefficient = 4 / (lambda * lambda * lambda) * risen(lambda) +
                                   2 * a * sign_of(n) / (lambda * lambda) * std::exp(-lambda * lambda * tau);
        sum += coefficient * coefficient;
    }
    return sum / 2;
}

double dragged_square_mean(double s, double tau) {
    const int terms = living_terms(tau);
    const auto risen = [&](double lambda) { return s - (1 - s) * std::expm1(-lambda * lambda * tau); };
    double sum = 4 * gsl_sf_hzeta(2, terms + 1) / (pi * pi) * std::pow(risen(terms * pi), 2);
    for (int n = terms; n >= 1; --n) {
        const double lambda = n * pi;
        const double coefficient = 2 / lambda * risen(lambda);
        sum += coefficient * coefficient;
    }
    return sum / 2;
}

} // namespace sphvv::analytic::layer
