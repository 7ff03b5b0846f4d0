#pragma once

#include "sphvv/solver/operators/row.hpp"

namespace sphvv::solver {

/// Components that a symmetric matrix is stored with: its upper triangle, row by row.
template <int Dim>
inline constexpr int symmetric_components = Dim*(Dim + 1) / 2;

/// Position of entry (a, b) among them.
template <int Dim>
constexpr int symmetric_component(int a, int b) {
    const int low = a < b ? a : b;
    const int high = a < b ? b : a;
    return low * Dim - low * (low - 1) / 2 + high - low;
}

/// Stores a symmetric matrix of particle i.
template <int Dim>
void write_symmetric(const std::array<double*, symmetric_components<Dim>>& arrays, int i,
                     const Matrix<Dim>& M) {
    for (int a = 0; a < Dim; ++a) {
        for (int b = a; b < Dim; ++b) {
            arrays[symmetric_component<Dim>(a, b)][i] = M(a, b);
        }
    }
}

/// The symmetric matrix of particle i.
template <int Dim>
Matrix<Dim> read_symmetric(const std::array<const double*, symmetric_components<Dim>>& arrays, int i) {
    Matrix<Dim> M;
    for (int a = 0; a < Dim; ++a) {
        for (int b = 0; b < Dim; ++b) {
            M(a, b) = arrays[symmetric_component<Dim>(a, b)][i];
        }
    }
    return M;
}

} // namespace sphvv::solver
