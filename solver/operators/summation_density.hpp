#pragma once

#include "sphvv/solver/operators/laplacian_morris.hpp"

namespace sphvv::solver {

/// sum_j m_j W_ij, the particle itself with `own_mass` included (kg/m^dim; with volumes for masses the sum of
/// the kernel, a pure number near 1). Source: Gingold & Monaghan 1977; Asai 2012 (particle density).
template <int Dim, class Mass>
double summation_density(const Row<Dim>& row, const Kernel& kernel, double h, const Mass& mass,
                         double own_mass) {
    constexpr double outside = 1e100; // m2: where the entries that pad a row, which name i itself, are put
    const double scale = kernel.value_scale(Dim, h);
    Lanes total{};
    for (int k = 0; k < row.padded; k += lane_count) {
        std::array<double, lane_count> squared;
        std::array<double, lane_count> W;
        store(squared.data(), squared_separation<Dim>(row, k));
        for (int l = row.count - k; l < lane_count; ++l) {
            squared[l] = outside;
        }
        kernel.values(squared, h, scale, W.data());
        total += mass(row.index + k) * load(W.data());
    }
    return own_mass * kernel.value(Dim, 0, h) + sum(total);
}

} // namespace sphvv::solver
