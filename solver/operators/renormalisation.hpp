#pragma once

#include "sphvv/solver/operators/row.hpp"

#include <Eigen/LU>

#include <optional>

namespace sphvv::solver {

/// M_i = sum_j V_j (r_j - r_i) (x) gradW_ij (pure number, symmetric, positive semidefinite), near the
/// identity in a full support.
template <int Dim, class Volume>
Matrix<Dim> first_moments(const Row<Dim>& row, const Volume& volume) {
    std::array<Lanes, Dim*(Dim + 1) / 2> moments{};
    for (int k = 0; k < row.padded; k += lane_count) {
        const Lanes weight = -volume(row.index + k) * load(row.slope + k);
        for (int a = 0, m = 0; a < Dim; ++a) {
            const Lanes weighted = weight * load(row.separation[a] + k);
            for (int b = a; b < Dim; ++b, ++m) {
                moments[m] += weighted * load(row.separation[b] + k);
            }
        }
    }
    Matrix<Dim> M;
    for (int a = 0, m = 0; a < Dim; ++a) {
        for (int b = a; b < Dim; ++b, ++m) {
            M(a, b) = M(b, a) = sum(moments[m]);
        }
    }
    return M;
}

/// L_i = M_i^-1, which makes a difference gradient exact for linear fields. Source: Xu 2009 §2.1.2; Oger
/// 2007. Nothing where the neighbours do not span the space, or only just: det M below 1e-6 (tr M/dim)^dim,
/// whatever the size of M, so that cond L stays below 4e6 in 2-D and in 3-D (largest eigenvalue 1, smallest
/// x: x > 1e-6 (1 + x)^2/4; with a third one y, the worst is y = 1/2: x > 1e-6/4).
template <int Dim, class Volume>
std::optional<Matrix<Dim>> determined_renormalisation(const Row<Dim>& row, const Volume& volume) {
    const Matrix<Dim> M = first_moments<Dim>(row, volume);
    double scale = 1;
    for (int d = 0; d < Dim; ++d) {
        scale *= M.trace() / Dim;
    }
    if (!(M.determinant() > 1e-6 * scale)) {
        return std::nullopt;
    }
    return M.inverse();
}

/// L_i, or the identity where the neighbours do not determine it: what a scheme does with a stray particle.
template <int Dim, class Volume>
Matrix<Dim> renormalisation(const Row<Dim>& row, const Volume& volume) {
    return determined_renormalisation<Dim>(row, volume).value_or(Matrix<Dim>::Identity());
}

/// S_i = sum_j V_j gradW_ij (1/m), zero in a full regular support.
template <int Dim, class Volume>
Vector<Dim> gradient_of_unity(const Row<Dim>& row, const Volume& volume) {
    std::array<Lanes, Dim> total{};
    for (int k = 0; k < row.padded; k += lane_count) {
        const Lanes weight = volume(row.index + k) * load(row.slope + k);
        for (int d = 0; d < Dim; ++d) {
            total[d] += weight * load(row.separation[d] + k);
        }
    }
    return lane_sums<Dim>(total);
}

} // namespace sphvv::solver
