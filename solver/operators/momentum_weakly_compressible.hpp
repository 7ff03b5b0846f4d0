#pragma once

#include "sphvv/solver/operators/laplacian_morris.hpp"

namespace sphvv::solver {

/// What a weakly compressible momentum equation reads of the particles.
template <int Dim>
struct MomentumFields {
    std::array<const double*, Dim> u;            ///< m/s
    const double* pressure_over_squared_density; ///< p/rho^2, m5/(kg s2)
    const double* specific_volume;               ///< 1/rho, m3/kg
};

/// Acceleration of particle i (m/s2) by pressure and viscosity,
/// -sum_j m (p_i/rho_i^2 + p_j/rho_j^2) gradW_ij + sum_j m 2 mu/(rho_i rho_j) F_ij r^2/(r^2+eta^2) (u_i -
/// u_j). Pairwise antisymmetric, so that linear momentum is conserved exactly. Source: Lee 2008 §1.1, §1.3
/// (Morris viscosity).
template <int Dim>
Vector<Dim> momentum_weakly_compressible(const Row<Dim>& row, int i, const MomentumFields<Dim>& fields,
                                         double m, double mu, double eta_squared) {
    std::array<Lanes, Dim> total{};
    const double P_i = fields.pressure_over_squared_density[i];
    const double viscous_i = 2 * mu * m * fields.specific_volume[i];
    for (int k = 0; k < row.padded; k += lane_count) {
        const int* j = row.index + k;
        const Lanes slope = load(row.slope + k);
        const Lanes pressure = -m * (P_i + gather(fields.pressure_over_squared_density, j)) * slope;
        const Lanes viscous =
            viscous_i * gather(fields.specific_volume, j) * regularised_slope<Dim>(row, k, eta_squared);
        for (int d = 0; d < Dim; ++d) {
            total[d] +=
                pressure * load(row.separation[d] + k) + viscous * (fields.u[d][i] - gather(fields.u[d], j));
        }
    }
    return lane_sums<Dim>(total);
}

} // namespace sphvv::solver
