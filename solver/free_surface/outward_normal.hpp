#pragma once

#include "sphvv/solver/operators/renormalisation.hpp"

namespace sphvv::solver {

/// n_i = -L_i S_i/|L_i S_i| with S_i = sum_j V_j gradW_ij and L_i the inverse of `moments` (the identity
/// where they are singular): unit vector out of the fluid at a surface particle. Zero where the neighbours
/// lie evenly about the particle (|S_i| below 1e-9 sum V_j |gradW_ij|) and where there are none: inside a
/// lattice, in the middle of a jet, at a lone particle. Inside a disordered fluid it is a direction without a
/// meaning. Source: Marrone et al. 2010 (J. Comput. Phys. 229, 3652).
template <int Dim, class Volume>
Vector<Dim> outward_normal(const Row<Dim>& row, const Volume& volume, const Matrix<Dim>& moments) {
    std::array<Lanes, Dim> total{};
    Lanes size{};
    for (int k = 0; k < row.padded; k += lane_count) {
        const Lanes weight = volume(row.index + k) * load(row.slope + k);
        for (int d = 0; d < Dim; ++d) {
            const Lanes component = weight * load(row.separation[d] + k);
            total[d] += component;
            size += select(component < 0, -component, component);
        }
    }
    const Vector<Dim> S = lane_sums<Dim>(total);
    if (!(S.norm() > 1e-9 * sum(size))) {
        return Vector<Dim>::Zero();
    }
    const double scale = moments.trace() / Dim;
    const bool determined = moments.determinant() > 1e-6 * std::pow(scale, Dim);
    const Vector<Dim> direction = determined ? Vector<Dim>(-moments.inverse() * S) : Vector<Dim>(-S);
    return direction.normalized();
}

template <int Dim, class Volume>
Vector<Dim> outward_normal(const Row<Dim>& row, const Volume& volume) {
    return outward_normal<Dim>(row, volume, first_moments<Dim>(row, volume));
}

} // namespace sphvv::solver
