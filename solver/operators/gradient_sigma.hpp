#pragma once

#include "sphvv/solver/operators/row.hpp"

namespace sphvv::solver {

/// Symmetric gradient of the sigma family (unit of A per m),
/// rho_i sum_j m_j (A_i rho_j^(sigma-2)/rho_i^sigma + A_j rho_i^(sigma-2)/rho_j^sigma) gradW_ij with m_j =
/// rho_j V_j. Pairwise antisymmetric after multiplication by V_i. sigma = 1 is (A_i + A_j)/(rho_i rho_j),
/// sigma = 2 is Monaghan's. Source: Oger et al. 2007.
template <int Dim, int Sigma>
Vector<Dim> gradient_sigma(const Row<Dim>& row, int i, const double* A, const double* rho, const double* V) {
    static_assert(Sigma == 1 || Sigma == 2);
    Vector<Dim> total = Vector<Dim>::Zero();
    for (int k = 0; k < row.count; ++k) {
        const int j = row.index[k];
        const double m = rho[j] * V[j];
        const double pair = Sigma == 1 ? (A[i] + A[j]) / (rho[i] * rho[j])
                                       : A[i] / (rho[i] * rho[i]) + A[j] / (rho[j] * rho[j]);
        const double weight = rho[i] * m * pair * row.slope[k];
        for (int d = 0; d < Dim; ++d) {
            total[d] += weight * row.separation[d][k];
        }
    }
    return total;
}

} // namespace sphvv::solver
