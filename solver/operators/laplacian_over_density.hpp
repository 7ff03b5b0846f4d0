#pragma once

#include "sphvv/solver/operators/laplacian_morris.hpp"
#include "sphvv/solver/operators/renormalisation.hpp"

namespace sphvv::solver {

/// div((1/rho) grad A) in Morris form as a matrix: weights w_ij = -8 m/(rho_i + rho_j)^2 F_ij r^2/(r^2 +
/// eta^2)
/// >= 0 with -div((1/rho) grad A)_i = sum_j w_ij (A_i - A_j), and w_ij = w_ji. Returns sum_j w_ij. With a
/// constant density it is laplacian_morris_weights() over rho. Source: Issa 2005 (2.93); Shao & Lo 2003.
template <int Dim>
double laplacian_over_density_morris_weights(const Row<Dim>& row, int i, const MassOverDensity& particles,
                                             double eta_squared, double* weights) {
    return with_slope<Dim>(eta_squared, [&](const auto& slope) {
        Lanes total{};
        for (int k = 0; k < row.padded; k += lane_count) {
            const Lanes densities = particles.rho[i] + gather(particles.rho, row.index + k);
            const Lanes weight = -8 * particles.m / (densities * densities) * slope(row, k);
            store(weights + k, weight);
            total += weight;
        }
        return sum(total);
    });
}

/// The same in Schwaiger form, w_ij = (tr L_i/dim) V_j (1/rho_i + 1/rho_j) [-F_ij - (L_i gradW_ij).S_i]. Not
/// symmetric. Source: Schwaiger 2008 with lambda = 1/rho, in the corrected form of the Xu sheet §1.4, whose
/// grad(lambda A) - A_i grad lambda + lambda_i grad A is sum_j V_j (lambda_i + lambda_j) (A_j - A_i) L_i
/// gradW.
template <int Dim>
double laplacian_over_density_schwaiger_weights(const Row<Dim>& row, int i, const MassOverDensity& particles,
                                                const Matrix<Dim>& L, double* weights) {
    const Vector<Dim> LS = L * gradient_of_unity<Dim>(row, particles);
    const double scale = -L.trace() / Dim;
    Lanes total{};
    for (int k = 0; k < row.padded; k += lane_count) {
        Lanes along = 1;
        for (int d = 0; d < Dim; ++d) {
            along += load(row.separation[d] + k) * LS[d];
        }
        const Lanes rho_j = gather(particles.rho, row.index + k);
        const Lanes lambdas = 1 / particles.rho[i] + 1 / rho_j;
        const Lanes weight = scale * particles.m / rho_j * lambdas * load(row.slope + k) * along;
        store(weights + k, weight);
        total += weight;
    }
    return sum(total);
}

} // namespace sphvv::solver
