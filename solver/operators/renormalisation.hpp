#pragma once

#include "sphvv/solver/operators/row.hpp"

#include <Eigen/LU>

#include <cmath>

namespace sphvv::solver {

/// L_i = [sum_j V_j (r_j - r_i) (x) gradW_ij]^-1 (pure number, symmetric), which makes a difference gradient
/// exact for linear fields. Source: Xu 2009 §2.1.2; Oger 2007. Where the neighbours do not span the space
/// (determinant under 1e-6, against 1 in a full support) there is nothing to normalise by, and the identity
/// is returned.
template <int Dim, class Volume>
Matrix<Dim> renormalisation(const Row<Dim>& row, const Volume& volume) {
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
    if (!(std::abs(M.determinant()) > 1e-6)) {
        return Matrix<Dim>::Identity();
    }
    return M.inverse();
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
