#pragma once

#include "sphvv/solver/lanes.hpp"
#include "sphvv/solver/neighbours/neighbour_list.hpp"

#include <Eigen/Core>

namespace sphvv::solver {

/// An operator is evaluated at one particle i from its row of pairs. Several operators evaluated one after
/// the other in the same sweep read the row from cache.
template <int Dim>
using Row = typename NeighbourList<Dim>::Row;

template <int Dim>
using Vector = Eigen::Matrix<double, Dim, 1>;
template <int Dim>
using Matrix = Eigen::Matrix<double, Dim, Dim>;

/// All particles have the volume V (m^dim).
struct UniformVolume {
    double V;
    double operator()(const int*) const { return V; }
};

/// Particle j has the volume V[j] (m^dim).
struct VolumeField {
    const double* V;
    Lanes operator()(const int* j) const { return gather(V, j); }
};

/// Particle j has the mass m (kg) and the density rho[j] (kg/m^dim), and so the volume m/rho[j] (m^dim).
struct MassOverDensity {
    double m;
    const double* rho;
    Lanes operator()(const int* j) const { return m / gather(rho, j); }
};

template <int Dim>
Vector<Dim> lane_sums(const std::array<Lanes, Dim>& lanes) {
    Vector<Dim> result;
    for (int d = 0; d < Dim; ++d) {
        result[d] = sum(lanes[d]);
    }
    return result;
}

} // namespace sphvv::solver
