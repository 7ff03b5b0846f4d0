#pragma once

#include "sphvv/solver/box.hpp"

#include <cstdint>
#include <vector>

namespace sphvv::solver {

/// Centres of a square (cubic) lattice of spacing dx that fills the box; direction 0 runs fastest. Component
/// by component. Throws UserError if the spacing does not divide every side of the box.
template <int Dim>
std::array<std::vector<double>, Dim> lattice(const Box<Dim>& box, double dx);

/// Displaces every point by a uniform random vector of the cube [-amplitude, amplitude]^Dim (m). The sequence
/// depends on the seed only, not on the machine or the standard library.
template <int Dim>
void jitter(std::array<std::vector<double>, Dim>& points, double amplitude, std::uint64_t seed);

} // namespace sphvv::solver
