#pragma once

#include "sphvv/solver/operators/laplacian_morris.hpp"

#include <cmath>

namespace sphvv::solver {

/// R_i = sum_j (rbar_i/r_ij)^2 n_ij in two dimensions and 0.216 sum_j (rbar_i/r_ij)^3 n_ij in three (pure
/// number), over the neighbours within the support, with rbar_i their mean distance and n_ij from j to i: it
/// points away from where particles crowd. Coincident particles (r = 0) have no direction and add nothing.
///
/// Source: Xu 2009 §2.3, which is two-dimensional. In three dimensions an inverse square law has no
/// divergence, so evenly spread neighbours would not drive a displaced particle back (Earnshaw's theorem);
/// the power must exceed dim - 1. With power dim the restoring rate, -dR/d(dr) = (rbar^dim/dim) sum
/// r^-(dim+1), is on a lattice within 3.9 dx 24.3/dx in two dimensions and 112.7/dx in three: the factor
/// 0.216 gives both the same rate, so that C keeps its meaning (and C = 0.04 does not overshoot).
template <int Dim>
Vector<Dim> shifting_vector(const Row<Dim>& row, double support_radius) {
    std::array<Lanes, Dim> total{};
    Lanes distances{};
    Lanes count{};
    for (int k = 0; k < row.padded; k += lane_count) {
        const Lanes r2 = squared_separation<Dim>(row, k);
        const auto inside = (r2 > 0) & (r2 < support_radius * support_radius);
        const Lanes safe = select(inside, r2, 1);
        const Lanes r = sqrt(safe);
        const Lanes weight = select(inside, 1 / (Dim == 2 ? safe * r : safe * safe), 0);
        distances += select(inside, r, 0);
        count += select(inside, 1, 0);
        for (int d = 0; d < Dim; ++d) {
            total[d] += weight * load(row.separation[d] + k);
        }
    }
    const double neighbours = sum(count);
    if (neighbours == 0) {
        return Vector<Dim>::Zero();
    }
    const double mean_distance = sum(distances) / neighbours;
    constexpr double same_rate = Dim == 2 ? 1 : 0.216;
    return same_rate * std::pow(mean_distance, Dim) * lane_sums<Dim>(total);
}

} // namespace sphvv::solver
