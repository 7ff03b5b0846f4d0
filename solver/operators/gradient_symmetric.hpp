#pragma once

#include "sphvv/solver/operators/row.hpp"

namespace sphvv::solver {

/// G+: grad A_i = sum_j V_j (A_i + A_j) gradW_ij (unit of A per m); pairwise antisymmetric where all volumes
/// are alike. Source: Xu 2009 §2.1.2.
template <int Dim, class Volume>
Vector<Dim> gradient_symmetric(const Row<Dim>& row, int i, const double* A, const Volume& volume) {
    std::array<Lanes, Dim> total{};
    for (int k = 0; k < row.padded; k += lane_count) {
        const Lanes weight = volume(row.index + k) * load(row.slope + k) * (A[i] + gather(A, row.index + k));
        for (int d = 0; d < Dim; ++d) {
            total[d] += weight * load(row.separation[d] + k);
        }
    }
    return lane_sums<Dim>(total);
}

} // namespace sphvv::solver
