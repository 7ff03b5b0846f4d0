#pragma once

#include "sphvv/solver/kernels.hpp"

#include <string_view>

/// Linear stability of the SPH equations on a square lattice at rest, from the kernel and the sums alone.
///
/// A disturbance of displacement xi, velocity v and relative density s, each times exp(i k.R) at the lattice
/// point R, of a fluid with density rho, pressure p, sound speed c and viscosity nu obeys
///   dxi/dt = v,   ds/dt = i g.v,
///   dv/dt  = i (c^2 - 2 p/rho) g s - (p/rho) K xi + N v
/// with sums over the lattice neighbours d, V = dx^2 and F = (d.gradW)/(d^2 + eta^2):
///   g = V sum sin(k.d) gradW(d)                       (-k for long waves),
///   K = 2 V sum (1 - cos k.d) grad gradW(d),
///   N = 2 nu V sum (1 - cos k.d) F                    (Morris), or
///   N = 8 nu V sum (1 - cos k.d) gradW d^T/(d^2 + eta^2)  (Monaghan-Cleary).
/// They are those of the antisymmetric pressure forces sigma_1 and sigma_2 with a continuity equation of the
/// same kind: the two differ at second order only. Derived here; the numbers are held against derivatives of
/// the solver's own steps (tests/von_neumann.cpp).
namespace sphvv::verification {

/// The undisturbed state; SI units.
struct LatticeState {
    const solver::Kernel* kernel;
    double h_over_dx;
    double dx = 1;
    double density = 1;
    double pressure = 0;
    double sound_speed = 0; ///< 0: incompressible
    double viscosity = 0;
    bool monaghan_cleary = false;
    double eta_over_h = 0;
};

/// How a step is staged: what the schemes of solver/schemes/ do to a small disturbance.
enum class Stepping {
    explicit_euler,      ///< wcsph: v with the rates at the start, then s and xi with the new v
    predictor_corrector, ///< wcsph: midpoint rule, I + dt R + dt^2 R^2/2
    verlet,              ///< wcsph: leaps over two steps, an Euler step every 50
    projection           ///< isph_df: v* = (I + dt N) v, less its gradient part g g^T/(alpha^2 l)
};
std::string_view to_string(Stepping stepping);

/// Largest factor by which a step of dt (s) multiplies the amplitude of a disturbance, over all wave vectors
/// k = 2 pi (a, b)/(n dx) but 0: those of a periodic box of n by n particles. For Verlet's scheme, with its
/// restarts, the mean over a cycle of 50 steps.
double growth_factor(const LatticeState& state, Stepping stepping, double dt, int n);

/// Growth per step at which a scheme counts as unstable: a factor sqrt(2) in amplitude over 200 steps. A
/// limit that is sharp does not feel it. The midpoint rule has no other: undamped waves of frequency w grow
/// by (w dt)^4/8 in every step, however small.
constexpr double unstable_growth = 1.00173;

/// Largest dt (s) below which growth_factor() <= unstable_growth, between `from` and 1e4 times it, to 1e-6.
/// Infinite if there is none, 0 if it grows at `from` already.
double stability_limit(const LatticeState& state, Stepping stepping, double from, int n);

} // namespace sphvv::verification
