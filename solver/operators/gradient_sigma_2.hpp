#pragma once

#include "sphvv/solver/operators/row.hpp"

namespace sphvv::solver {

/// grad A_i = rho_i sum_j m_j (A_i/rho_i^2 + A_j/rho_j^2) gradW_ij (unit of A per m), with mass(j) = m_j
/// (kg); grad A/rho is pairwise antisymmetric where all masses are alike. Source: Monaghan 1992; Lee 2008
/// §1.3; Oger et al. 2007, sigma = 2.
template <int Dim, class Mass>
Vector<Dim> gradient_sigma_2(const Row<Dim>& row, int i, const double* A, const Mass& mass,
                             const double* rho) {
    std::array<Lanes, Dim> total{};
    const double own = A[i] / (rho[i] * rho[i]);
    for (int k = 0; k < row.padded; k += lane_count) {
        const int* j = row.index + k;
        const Lanes rho_j = gather(rho, j);
        const Lanes weight = mass(j) * load(row.slope + k) * (own + gather(A, j) / (rho_j * rho_j));
        for (int d = 0; d < Dim; ++d) {
            total[d] += weight * load(row.separation[d] + k);
        }
    }
    return rho[i] * lane_sums<Dim>(total);
}

} // namespace sphvv::solver
