#pragma once

#include "sphvv/solver/box.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sphvv::solver {

/// Points without structure that fill a box: `count` independent uniform ones, drawn as jitter() draws,
/// settled by an iteration after Whitworth,
///
///   r_a += h sum_b V (rho_b/rho) W(r_ab) r_ab/|r_ab|,  r_ab = r_a - r_b,  rho_b = m sum_c W(r_bc),
///
/// with V = m/rho the volume of the box over `count`, and rho = N m/volume. Beyond sides that are not
/// periodic lie mirror images, and points that pass such a side are reflected. W: cubic spline, h = 1.3 dx
/// with dx^Dim = V. Component by component, m.
///
/// Whitworth's factor is (rho_b - rho)/rho: what is denser than the mean pushes, and what is less dense
/// pulls. It evens out rho_b, but rho_b does not see two points that have come together, and the pull makes
/// more of them: after 100 iterations the closest pairs are 1e-6 dx apart. With rho_b/rho every point pushes,
/// in a lattice evenly. A small wave of the density, exp(ik.r), then loses the share h k G(k) [1 + W^(k)] of
/// itself in each iteration, G(k) = int W(r) cos(theta) sin(kr cos(theta)) and W^ the transform of W, the 1
/// being that of the push, which sees short waves, too. It lies between 0 and 1.5 for all k, so that every
/// wave dies out (2 would be the limit of stability), long ones last, with G = k <r>/Dim. What is left of
/// white noise, which independent points are, has after m iterations in two dimensions a root mean square
/// deviation of rho_b of
///
///   [1 + 2 m h <r>/s^2]^(-1/2) of that before,  W^ = exp(-s^2 k^2/2),  s^2 = <r^2>/2,
///
/// 0.047 at m = 100 (<r> = 0.714 h, <r^2> = 0.633 h^2), and not much more than half a per cent, the lattice
/// sum of the kernel.
///
/// The points depend on seed, count and box only, not on the number of threads. Source: Issa 2005 §3 (without
/// the volume), after Whitworth; the factor rho_b/rho: derived above. Throws UserError if a side is shorter
/// than a kernel support, or a periodic one than two.
template <int Dim>
std::array<std::vector<double>, Dim> unstructured(const Box<Dim>& box, std::size_t count, std::uint64_t seed,
                                                  int iterations = 100);

} // namespace sphvv::solver
