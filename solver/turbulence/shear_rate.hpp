#pragma once

#include "sphvv/solver/simulation.hpp"
#include "sphvv/solver/turbulence.hpp"

#include <cmath>

/// What models have in common in which nu_T follows from the shear rate at the particle.
namespace sphvv::solver::turbulence {

/// S = sqrt(2 s_ab s_ab), 1/s, with s the symmetric part of du_a/dx_b: |du/dz| in shear, 0 in solid rotation.
/// Source: Issa 2005 §5.1.
template <int Dim>
double shear_rate(const Matrix<Dim>& velocity_gradient) {
    const Matrix<Dim> s = (velocity_gradient + velocity_gradient.transpose()) / 2;
    return std::sqrt(2 * s.squaredNorm());
}

template <int Dim>
Matrix<Dim> matrix_at(const Field& field, int i) {
    Matrix<Dim> result;
    for (int a = 0; a < Dim; ++a) {
        for (int b = 0; b < Dim; ++b) {
            result(a, b) = field[a * Dim + b][i];
        }
    }
    return result;
}

template <class Formula, int Dim>
EddyViscosity<Dim> from_shear_rate(Simulation<Dim>& s, const Settings& settings) {
    return [formula = Formula(settings, s.smoothing_length)](Simulation<Dim>& sim, const Field& gradient,
                                                             Field& nu_T) {
        const Field* distance = sim.particles.find("wall_distance");
        const double* z = distance == nullptr ? nullptr : (*distance)[0];
        const int count = static_cast<int>(sim.particles.size());
        double* result = nu_T[0];
#pragma omp parallel for schedule(static)
        for (int i = 0; i < count; ++i) {
            const double squared_length = formula.squared_length(z == nullptr ? 0 : z[i]);
            result[i] = squared_length * shear_rate<Dim>(matrix_at<Dim>(gradient, i));
        }
    };
}

/// Completes a declaration with the formula of a length, nu_T = L^2 S: a type with
///   Formula(const Settings&, double smoothing_length)
///   double squared_length(double wall_distance) const; // L^2, m2
template <class Formula>
TurbulenceModel with_length(TurbulenceModel declaration) {
    declaration.assemble_2d = from_shear_rate<Formula, 2>;
    declaration.assemble_3d = from_shear_rate<Formula, 3>;
    return declaration;
}

} // namespace sphvv::solver::turbulence
