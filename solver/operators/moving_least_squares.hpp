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

/// (r_j - r_i)/h for eight neighbours.
template <int Dim>
std::array<Lanes, Dim> scaled_offsets(const Row<Dim>& row, int k, double h) {
    std::array<Lanes, Dim> x;
    for (int d = 0; d < Dim; ++d) {
        x[d] = load(row.separation[d] + k) * (-1 / h);
    }
    return x;
}

/// Factors of the normal matrix N = sum_j (-F_ij) p p^T of a fit with the monomials p of (r_j - r_i)/h.
/// Nothing where the neighbours do not determine the fit (smallest pivot below 1e-10 of the largest).
template <int Dim, int Degree>
auto taylor_normal_matrix(const Row<Dim>& row, double h) {
    constexpr int terms = taylor_terms(Dim, Degree);
    using Factors = Eigen::LDLT<Eigen::Matrix<double, terms, terms>>;
    if (row.count < terms) {
        return std::optional<Factors>();
    }
    std::array<Lanes, terms*(terms + 1) / 2> moments{};
    for (int k = 0; k < row.padded; k += lane_count) {
        const Lanes weight = -load(row.slope + k);
        const auto p = taylor_monomials<Dim, Degree>(scaled_offsets<Dim>(row, k, h));
        for (int m = 0, entry = 0; m < terms; ++m) {
            const Lanes weighted = weight * p[m];
            for (int n = 0; n <= m; ++n, ++entry) {
                moments[entry] += weighted * p[n];
            }
        }
    }
    Eigen::Matrix<double, terms, terms> normal;
    for (int m = 0, entry = 0; m < terms; ++m) {
        for (int n = 0; n <= m; ++n, ++entry) {
            normal(m, n) = normal(n, m) = sum(moments[entry]);
        }
    }
    std::optional<Factors> factors(normal);
    if (!(factors->vectorD().minCoeff() > 1e-10 * factors->vectorD().maxCoeff())) {
        factors.reset();
    }
    return factors;
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
    const auto factors = taylor_normal_matrix<Dim, Degree>(row, h);
    if (!factors) {
        return std::nullopt;
    }
    std::array<Lanes, terms> right{};
    for (int k = 0; k < row.padded; k += lane_count) {
        const Lanes weighted = -load(row.slope + k) * (gather(A, row.index + k) - A[i]);
        const auto p = taylor_monomials<Dim, Degree>(scaled_offsets<Dim>(row, k, h));
        for (int m = 0; m < terms; ++m) {
            right[m] += weighted * p[m];
        }
    }
    Eigen::Matrix<double, terms, 1> derivatives;
    for (int m = 0; m < terms; ++m) {
        derivatives[m] = sum(right[m]);
    }
    derivatives = factors->solve(derivatives).eval();
    constexpr int second = Dim;
    constexpr int third = taylor_terms(Dim, 2);
    for (int m = 0; m < terms; ++m) {
        derivatives[m] /= m < second ? h : m < third ? h * h : h * h * h;
    }
    return derivatives;
}

/// The same fit as weights: derivative m of any A at i (in the order of taylor_monomials) is
/// sum_j w_j (A_j - A_i), w_j = (-F_ij) p(r_j - r_i) . N^-1 e_m. Writes the rows of the gradient (1/m) and,
/// in `laplacian` (1/m2), that of the Laplacian; returns the sum of the latter, or nothing where the
/// neighbours do not determine the fit.
template <int Dim, int Degree>
std::optional<double> taylor_weights(const Row<Dim>& row, double h, const std::array<double*, Dim>& gradient,
                                     double* laplacian) {
    constexpr int terms = taylor_terms(Dim, Degree);
    const auto factors = taylor_normal_matrix<Dim, Degree>(row, h);
    if (!factors) {
        return std::nullopt;
    }
    Eigen::Matrix<double, terms, Dim + 1> wanted = Eigen::Matrix<double, terms, Dim + 1>::Zero();
    for (int a = 0, m = Dim; a < Dim; ++a) {
        wanted(a, a) = 1 / h;
        wanted(m, Dim) = 1 / (h * h);
        m += Dim - a;
    }
    const Eigen::Matrix<double, terms, Dim + 1> solved = factors->solve(wanted);
    Lanes total{};
    for (int k = 0; k < row.padded; k += lane_count) {
        const auto p = taylor_monomials<Dim, Degree>(scaled_offsets<Dim>(row, k, h));
        const Lanes weight = -load(row.slope + k);
        std::array<Lanes, Dim + 1> value{};
        for (int m = 0; m < terms; ++m) {
            for (int c = 0; c <= Dim; ++c) {
                value[c] += solved(m, c) * p[m];
            }
        }
        for (int d = 0; d < Dim; ++d) {
            store(gradient[d] + k, weight * value[d]);
        }
        const Lanes second = weight * value[Dim];
        store(laplacian + k, second);
        total += second;
    }
    return sum(total);
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
