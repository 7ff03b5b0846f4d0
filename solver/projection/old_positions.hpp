#pragma once

#include "sphvv/solver/projection/projection.hpp"

namespace sphvv::solver::projection {

/// The keys of a scheme with these stages: those of every projection, with Lee's gradient and limits of the
/// time step, and the limit by the acceleration.
std::vector<Key> keys_at_old_positions(std::string_view kernel, double h_over_dx);

/// Stages of Lee 2008 §1.2, all operators at r^n: u* = u^n + dt nu Laplacian u^n; Laplacian p = (rho/dt)
/// div u*; u^{n+1} = u* - (dt/rho) grad p; r^{n+1} = r^n + dt u^{n+1}.
///
/// With a relaxation alpha > 0 the source is (rho_0/dt) div u* + alpha (rho_0 - rho^n)/dt^2 (Asai 2012), with
/// the summation density rho^n: div u^{n+1} = alpha (rho^n - rho_0)/(rho_0 dt), which
/// takes off the share alpha of the density error in a step.
template <int Dim>
void add_stages_at_old_positions(Simulation<Dim>& simulation, double relaxation);

} // namespace sphvv::solver::projection
