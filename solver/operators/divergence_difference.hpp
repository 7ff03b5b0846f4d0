#pragma once

#include "sphvv/solver/operators/row.hpp"

namespace sphvv::solver {

/// div u_i = sum_j V_j (u_j - u_i) . gradW_ij (1/s); exact for constants. Source: Xu 2009 §2.1.2. The
/// normalised form is the trace of vector_gradient_difference() L_i.
template <int Dim, class Volume>
double divergence_difference(const Row<Dim>& row, int i, const std::array<const double*, Dim>& u,
                             const Volume& volume) {
    Lanes total{};
    for (int k = 0; k < row.padded; k += lane_count) {
        Lanes approach{};
        for (int d = 0; d < Dim; ++d) {
            approach += (gather(u[d], row.index + k) - u[d][i]) * load(row.separation[d] + k);
        }
        total += volume(row.index + k) * load(row.slope + k) * approach;
    }
    return sum(total);
}

} // namespace sphvv::solver
