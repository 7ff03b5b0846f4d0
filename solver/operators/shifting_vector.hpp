#pragma once

#include "sphvv/solver/operators/laplacian_morris.hpp"

namespace sphvv::solver {

/// R_i = sum_j (rbar_i^2/r_ij^2) n_ij over the neighbours within the support, with rbar_i their mean distance
/// and n_ij from j to i (pure number): it points away from where particles crowd. Coincident particles (r =
/// 0) have no direction and add nothing. Source: Xu 2009 §2.3.
template <int Dim>
Vector<Dim> shifting_vector(const Row<Dim>& row, double support_radius) {
    std::array<Lanes, Dim> total{};
    Lanes distances{};
    Lanes count{};
    const Lanes one = Lanes{} + 1.0;
    for (int k = 0; k < row.padded; k += lane_count) {
        const Lanes r2 = squared_separation<Dim>(row, k);
        const auto inside = (r2 > 0) & (r2 < support_radius * support_radius);
        const Lanes safe = inside ? r2 : one;
        Lanes r;
        for (int l = 0; l < lane_count; ++l) {
            r[l] = __builtin_sqrt(safe[l]);
        }
        const Lanes weight = inside ? 1 / (safe * r) : Lanes{};
        distances += inside ? r : Lanes{};
        count += inside ? one : Lanes{};
        for (int d = 0; d < Dim; ++d) {
            total[d] += weight * load(row.separation[d] + k);
        }
    }
    const double neighbours = sum(count);
    if (neighbours == 0) {
        return Vector<Dim>::Zero();
    }
    const double mean_distance = sum(distances) / neighbours;
    return mean_distance * mean_distance * lane_sums<Dim>(total);
}

} // namespace sphvv::solver
