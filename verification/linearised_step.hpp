#pragma once

#include "sphvv/verification/lattice_scene.hpp"

#include <Eigen/Core>

#include <vector>

/// Linear stability of a whole solver step on a square lattice, for schemes of which no closed form is known.
///
/// To first order in a disturbance, one step maps the state of all particles on itself,
///   s'(R) = sum over R' of G(R - R') s(R'),
/// with the same S x S blocks G for every particle, because the lattice has no place of its own: rest,
/// uniform motion and free fall are steady but for a motion of the whole. S counts every component that a
/// step hands to the next: position, velocity and all fields of Lifetime::state. So G follows from disturbing
/// ONE particle: central differences in each of its S components, 2 S steps of the solver. A disturbance
/// exp(i k.R) is multiplied by
///   M(k) = sum over R of G(R) exp(-i k.R)
/// in a step, and grows if the spectral radius of M(k) is above 1.
///
/// What the differences do not see, and what becomes of it:
/// - Modes that are neutral, such as a displacement at rest (r' = r + dt u with a u that nothing changes),
///   stand in Jordan blocks with the eigenvalue 1, which errors of 1e-9 in M split by 3e-5: far below the
///   growth at which a step counts as unstable.
/// - What is even in the disturbance has no derivative, and central differences drop it: the root mean square
///   or largest velocity of fluid at rest, which scales the shifts of isph_dfs and isph_mls. Shifts at rest
///   are of second order. In a uniform stream that speed is a constant, and they are part of M.
/// - A threshold that the disturbance does not reach: isph_dfdi takes density errors out above 1 % only, so
///   that its M is that without density invariance. With density_tolerance=1e-9 and density_iterations=1 it
///   is taken out once in every step, and M is that.
/// - The first guess of the pressure: its column is 0, as the equations are solved to 1e-10.
/// - Strengths of repulsion that differ from particle to particle (shift_disorder of isph_mls): the map of a
///   moving lattice is the same for all particles only without them.
/// Derived here; held against the closed form (von_neumann.hpp) and against the eigenvalues of the whole
/// Jacobian of a small lattice (tests/linearised_step.cpp).
namespace sphvv::verification {

/// M(k) of a scene stepped by dt (s), for one of each pair k, -k of the wave vectors 2 pi (a, b)/(n dx) but
/// 0, in the order of a, b >= 0. `step` is the number of the step: a scheme may start in another way than it
/// goes on. Throws Diverged if a step of the disturbed lattice ends the run.
std::vector<Eigen::MatrixXcd> linearised_step(const LatticeScene& scene, double dt, int step = 1);

/// Largest factor by which a step multiplies a disturbance; for Verlet's scheme, which restarts, the mean
/// over a cycle.
double linearised_growth(const LatticeScene& scene, double dt);

/// Largest dt (s) below which linearised_growth() <= unstable_growth (von_neumann.hpp), from `from` to
/// `most`, to 0.1 %; 0 if it grows at `from`, infinite if it does not at `most`. In between, steps of 25 %
/// are taken: windows of instability that are narrower are not looked for.
double linearised_limit(const LatticeScene& scene, double from, double most);

} // namespace sphvv::verification
