#pragma once

#include "sphvv/solver/operators/row.hpp"

namespace sphvv::solver {

/// Squared distance of eight pairs.
template <int Dim>
Lanes squared_separation(const Row<Dim>& row, int k) {
    Lanes r2{};
    for (int d = 0; d < Dim; ++d) {
        const Lanes r = load(row.separation[d] + k);
        r2 += r * r;
    }
    return r2;
}

/// F_ij of eight pairs, which is finite at r = 0 for every kernel but the quadratic.
template <int Dim>
struct PlainSlope {
    static constexpr double eta_squared = 0;
    Lanes operator()(const Row<Dim>& row, int k) const { return load(row.slope + k); }
};

/// F_ij r^2/(r^2 + eta^2) with eta > 0, which lowers the Laplacian by a fraction that no resolution removes
/// (0.9 % for the quintic spline and eta = 0.1 h: Xu sheet §1.4).
template <int Dim>
struct RegularisedSlope {
    double eta_squared; ///< m2
    Lanes operator()(const Row<Dim>& row, int k) const {
        const Lanes slope = load(row.slope + k);
        const Lanes r2 = squared_separation<Dim>(row, k);
        return slope * r2 / (r2 + eta_squared);
    }
};

/// body(slope) with the one or the other, so that its loop over pairs does not ask which.
template <int Dim, class Body>
auto with_slope(double eta_squared, const Body& body) {
    return eta_squared == 0 ? body(PlainSlope<Dim>{}) : body(RegularisedSlope<Dim>{eta_squared});
}

/// LM: Laplacian of every component of u at i, 2 sum_j V_j (u_i - u_j) F_ij r^2/(r^2 + eta^2) (unit of u per
/// m2). Source: Morris et al. 1997; Xu 2009 §2.1.3.
template <int Dim, class Volume>
Vector<Dim> laplacian_morris(const Row<Dim>& row, int i, const std::array<const double*, Dim>& u,
                             const Volume& volume, double eta_squared) {
    return with_slope<Dim>(eta_squared, [&](const auto& slope) {
        std::array<Lanes, Dim> total{};
        for (int k = 0; k < row.padded; k += lane_count) {
            const Lanes weight = 2 * volume(row.index + k) * slope(row, k);
            for (int d = 0; d < Dim; ++d) {
                total[d] += weight * (u[d][i] - gather(u[d], row.index + k));
            }
        }
        return lane_sums<Dim>(total);
    });
}

/// LM of a scalar.
template <int Dim, class Volume>
double laplacian_morris_scalar(const Row<Dim>& row, int i, const double* A, const Volume& volume,
                               double eta_squared) {
    return with_slope<Dim>(eta_squared, [&](const auto& slope) {
        Lanes total{};
        for (int k = 0; k < row.padded; k += lane_count) {
            total += 2 * volume(row.index + k) * slope(row, k) * (A[i] - gather(A, row.index + k));
        }
        return sum(total);
    });
}

/// The same operator as a matrix: weights w_ij >= 0 with -Laplacian A_i = sum_j w_ij (A_i - A_j). Returns
/// sum_j w_ij.
template <int Dim, class Volume>
double laplacian_morris_weights(const Row<Dim>& row, const Volume& volume, double eta_squared,
                                double* weights) {
    return with_slope<Dim>(eta_squared, [&](const auto& slope) {
        Lanes total{};
        for (int k = 0; k < row.padded; k += lane_count) {
            const Lanes weight = -2 * volume(row.index + k) * slope(row, k);
            store(weights + k, weight);
            total += weight;
        }
        return sum(total);
    });
}

} // namespace sphvv::solver
