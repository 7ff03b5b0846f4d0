#pragma once

#include "sphvv/solver/operators/row.hpp"

namespace sphvv::solver {

/// div grad u + 2 grad div u at i, 2(dim+2) sum_j V_j (u_ij . r_ij)/(r_ij^2 + eta^2) gradW_ij (unit of u per
/// m2): the Laplacian where div u = 0. Source: Cleary & Monaghan 1999; Lee 2008 §1.3 (8 in 2-D, 10 in 3-D).
template <int Dim, class Volume>
Vector<Dim> viscous_monaghan_cleary(const Row<Dim>& row, int i, const std::array<const double*, Dim>& u,
                                    const Volume& volume, double eta_squared) {
    std::array<Lanes, Dim> total{};
    for (int k = 0; k < row.padded; k += lane_count) {
        Lanes squared = eta_squared;
        Lanes along{};
        for (int d = 0; d < Dim; ++d) {
            const Lanes r = load(row.separation[d] + k);
            squared += r * r;
            along += r * (u[d][i] - gather(u[d], row.index + k));
        }
        // A coincident pair has no direction, and along = 0.
        const Lanes safe = select(squared > 0, squared, 1);
        const Lanes weight = 2 * (Dim + 2) * volume(row.index + k) * load(row.slope + k) * along / safe;
        for (int d = 0; d < Dim; ++d) {
            total[d] += weight * load(row.separation[d] + k);
        }
    }
    return lane_sums<Dim>(total);
}

} // namespace sphvv::solver
