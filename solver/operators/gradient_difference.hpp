#pragma once

#include "sphvv/solver/operators/row.hpp"

namespace sphvv::solver {

/// G-: grad A_i = sum_j V_j (A_j - A_i) gradW_ij (unit of A per m); exact for constants. Multiplied from the
/// left by L_i (renormalisation.hpp) it is exact for linear fields. Source: Xu 2009 §2.1.2.
template <int Dim, class Volume>
Vector<Dim> gradient_difference(const Row<Dim>& row, int i, const double* A, const Volume& volume) {
    std::array<Lanes, Dim> total{};
    for (int k = 0; k < row.padded; k += lane_count) {
        const Lanes difference = gather(A, row.index + k) - A[i];
        const Lanes weight = volume(row.index + k) * load(row.slope + k) * difference;
        for (int d = 0; d < Dim; ++d) {
            total[d] += weight * load(row.separation[d] + k);
        }
    }
    return lane_sums<Dim>(total);
}

/// G-: (grad u)_ab = du_a/dx_b = sum_j V_j (u_j - u_i)_a (gradW_ij)_b (1/s); exact for constants. Multiplied
/// from the right by L_i it is exact for linear fields.
template <int Dim, class Volume>
Matrix<Dim> vector_gradient_difference(const Row<Dim>& row, int i, const std::array<const double*, Dim>& u,
                                       const Volume& volume) {
    std::array<std::array<Lanes, Dim>, Dim> total{};
    for (int k = 0; k < row.padded; k += lane_count) {
        const Lanes weight = volume(row.index + k) * load(row.slope + k);
        std::array<Lanes, Dim> gradW;
        for (int b = 0; b < Dim; ++b) {
            gradW[b] = weight * load(row.separation[b] + k);
        }
        for (int a = 0; a < Dim; ++a) {
            const Lanes difference = gather(u[a], row.index + k) - u[a][i];
            for (int b = 0; b < Dim; ++b) {
                total[a][b] += difference * gradW[b];
            }
        }
    }
    Matrix<Dim> result;
    for (int a = 0; a < Dim; ++a) {
        for (int b = 0; b < Dim; ++b) {
            result(a, b) = sum(total[a][b]);
        }
    }
    return result;
}

} // namespace sphvv::solver
