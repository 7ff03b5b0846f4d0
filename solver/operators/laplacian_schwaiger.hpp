#pragma once

#include "sphvv/solver/operators/gradient_difference.hpp"
#include "sphvv/solver/operators/laplacian_morris.hpp"
#include "sphvv/solver/operators/renormalisation.hpp"

namespace sphvv::solver {

/// LS: Laplacian of every component of u at i, (tr L_i/dim) {2 sum_j V_j (u_i - u_j) F_ij - 2 grad u_i . S_i}
/// with the normalised G- gradient (unit of u per m2). Source: Schwaiger 2008, in the corrected form of the
/// Xu sheet §1.4.
template <int Dim, class Volume>
Vector<Dim> laplacian_schwaiger(const Row<Dim>& row, int i, const std::array<const double*, Dim>& u,
                                const Volume& volume, const Matrix<Dim>& L) {
    const Vector<Dim> S = gradient_of_unity<Dim>(row, volume);
    const Matrix<Dim> gradient = vector_gradient_difference<Dim>(row, i, u, volume) * L;
    return L.trace() / Dim * (laplacian_morris<Dim>(row, i, u, volume, 0.0) - 2 * gradient * S);
}

/// The same of a scalar.
template <int Dim, class Volume>
double laplacian_schwaiger_scalar(const Row<Dim>& row, int i, const double* A, const Volume& volume,
                                  const Matrix<Dim>& L) {
    const Vector<Dim> S = gradient_of_unity<Dim>(row, volume);
    const Vector<Dim> gradient = L * gradient_difference<Dim>(row, i, A, volume);
    return L.trace() / Dim * (laplacian_morris_scalar<Dim>(row, i, A, volume, 0.0) - 2 * gradient.dot(S));
}

/// The same operator as a matrix: weights with -Laplacian A_i = sum_j w_ij (A_i - A_j),
/// w_ij = (tr L_i/dim) V_j [-2 F_ij - 2 (L_i gradW_ij).S_i]. Not symmetric. Returns sum_j w_ij.
template <int Dim, class Volume>
double laplacian_schwaiger_weights(const Row<Dim>& row, const Volume& volume, const Matrix<Dim>& L,
                                   double* weights) {
    const Vector<Dim> LS = L * gradient_of_unity<Dim>(row, volume);
    const double scale = -2 * L.trace() / Dim;
    Lanes total{};
    for (int k = 0; k < row.padded; k += lane_count) {
        Lanes along = 1;
        for (int d = 0; d < Dim; ++d) {
            along += load(row.separation[d] + k) * LS[d];
        }
        const Lanes weight = scale * volume(row.index + k) * load(row.slope + k) * along;
        store(weights + k, weight);
        total += weight;
    }
    return sum(total);
}

} // namespace sphvv::solver
