#pragma once

#include "sphvv/solver/linear/pressure_poisson.hpp"
#include "sphvv/solver/schemes.hpp"

namespace sphvv::solver::projection {

/// The keys of a pressure-projection scheme.
std::vector<Key> keys();

/// Order in time of u^{n+1} = u^n + dt (...)(r* = r^n + dt u^n): one.
TimeOrder euler_order(const Settings& settings);

/// Solves the problem whose weights and sources are written, from the pressure as first guess; books the
/// iterations and the matrix entries. Throws Diverged where the solver stops short of its tolerance.
template <int Dim>
void solve_poisson(Simulation<Dim>& simulation, PressurePoisson<Dim>& poisson, Field& pressure);

/// Stages of ISPH_DF (Cummins & Rudman 1999; Xu 2009 §2.2): r* = r^n + dt u^n; u* = u^n + dt nu Laplacian u^n
/// and the Poisson equation Laplacian p = (rho/dt) div u* at r*; u^{n+1} = u* - (dt/rho) grad p; r^{n+1} =
/// r^n + (dt/2)(u^n + u^{n+1}).
template <int Dim>
void add_divergence_free_stages(Simulation<Dim>& simulation);

} // namespace sphvv::solver::projection
