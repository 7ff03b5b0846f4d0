#pragma once

#include "sphvv/solver/operators/row.hpp"

#include <Eigen/Cholesky>

#include <limits>
#include <optional>

namespace sphvv::solver {

/// Terms of a Taylor polynomial of that degree without its constant: 5 and 9 in two dimensions, 9 and 19 in
/// three.
constexpr int taylor_terms(int dim, int degree) {
    int terms = 1;
    for (int k = 1; k <= dim; ++k) {
        terms = terms * (degree + k) / k;
    }
    return terms - 1;
}

/// Monomials x^a y^b z^c/(a! b! c!) of degree 1 … Degree, so that a coefficient is a derivative: first x, y(,
/// z), then xx, xy, (xz,) yy(, yz, zz), then the third degree in the same manner. Eight points at once.
template <int Dim, int Degree>
std::array<Lanes, taylor_terms(Dim, Degree)> taylor_monomials(const std::array<Lanes, Dim>& x) {
    static_assert(Degree == 2 || Degree == 3);
    std::array<Lanes, taylor_terms(Dim, Degree)> p;
    int m = 0;
    for (int a = 0; a < Dim; ++a) {
        p[m++] = x[a];
    }
    for (int a = 0; a < Dim; ++a) {
        for (int b = a; b < Dim; ++b) {
            p[m++] = x[a] * x[b] * (a == b ? 1. / 2 : 1.);
        }
    }
    if constexpr (Degree == 3) {
        for (int a = 0; a < Dim; ++a) {
            for (int b = a; b < Dim; ++b) {
                for (int c = b; c < Dim; ++c) {
                    const int equal = (a == b) + (b == c);
                    p[m++] = x[a] * x[b] * x[c] * (equal == 2 ? 1. / 6 : equal == 1 ? 1. / 2 : 1.);
                }
            }
        }
    }
    return p;
}

/// Derivatives of A at i up to that degree, in the order of taylor_monomials: the polynomial through A_i that
/// minimises sum_j (-F_ij) [A_j - A_i - p(r_j - r_i)]^2. Exact for polynomials of that degree on any
/// arrangement. Lengths are scaled by h before the solve. Nothing where the neighbours do not determine it
/// (smallest pivot of the normal matrix below 1e-10 of the largest). Source: Lancaster & Salkauskas 1981;
/// Dilts 1999.
template <int Dim, int Degree>
std::optional<Eigen::Matrix<double, taylor_terms(Dim, Degree), 1>>
taylor_coefficients(const Row<Dim>& row, int i, const double* A, double h) {
    constexpr int terms = taylor_terms(Dim, Degree);
    if (row.count < terms) {
        return std::nullopt;
    }
    std::array<Lanes, terms*(terms + 1) / 2> moments{};
    std::array<Lanes, terms> right{};
    for (int k = 0; k < row.padded; k += lane_count) {
        std::array<Lanes, Dim> x;
        for (int d = 0; d < Dim; ++d) {
            x[d] = load(row.separation[d] + k) * (-1 / h);
        }
        const Lanes weight = -load(row.slope + k);
        const Lanes difference = gather(A, row.index + k) - A[i];
        const auto p = taylor_monomials<Dim, Degree>(x);
        for (int m = 0, entry = 0; m < terms; ++m) {
            const Lanes weighted = weight * p[m];
            right[m] += weighted * difference;
            for (int n = 0; n <= m; ++n, ++entry) {
                moments[entry] += weighted * p[n];
            }
        }
    }
    Eigen::Matrix<double, terms, terms> normal;
    Eigen::Matrix<double, terms, 1> derivatives;
    for (int m = 0, entry = 0; m < terms; ++m) {
        derivatives[m] = sum(right[m]);
        for (int n = 0; n <= m; ++n, ++entry) {
            normal(m, n) = normal(n, m) = sum(moments[entry]);
        }
    }
    const Eigen::LDLT<Eigen::Matrix<double, terms, terms>> factors(normal);
    if (!(factors.vectorD().minCoeff() > 1e-10 * factors.vectorD().maxCoeff())) {
        return std::nullopt;
    }
    derivatives = factors.solve(derivatives).eval();
    constexpr int second = Dim;
    constexpr int third = taylor_terms(Dim, 2);
    for (int m = 0; m < terms; ++m) {
        derivatives[m] /= m < second ? h : m < third ? h * h : h * h * h;
    }
    return derivatives;
}

/// Gradient (unit of A per m) by moving least squares of that degree.
template <int Dim, int Degree>
Vector<Dim> gradient_mls(const Row<Dim>& row, int i, const double* A, double h) {
    const auto derivatives = taylor_coefficients<Dim, Degree>(row, i, A, h);
    if (!derivatives) {
        return Vector<Dim>::Constant(std::numeric_limits<double>::quiet_NaN());
    }
    return derivatives->template head<Dim>();
}

/// Laplacian (unit of A per m2) by moving least squares of that degree.
template <int Dim, int Degree>
double laplacian_mls(const Row<Dim>& row, int i, const double* A, double h) {
    const auto derivatives = taylor_coefficients<Dim, Degree>(row, i, A, h);
    if (!derivatives) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    double total = 0;
    for (int a = 0, m = Dim; a < Dim; ++a) {
        total += (*derivatives)[m];
        m += Dim - a;
    }
    return total;
}

} // namespace sphvv::solver
