#pragma once

#include "sphvv/solver/projection/projection.hpp"

namespace sphvv::solver::projection {

/// Stages of ISPH_DF (Cummins & Rudman 1999; Xu 2009 §2.2): r* = r^n + dt u^n; u* = u^n + dt nu Laplacian u^n
/// and the Poisson equation Laplacian p = (rho/dt) div u* at r*; u^{n+1} = u* - (dt/rho) grad p; r^{n+1} =
/// r^n + (dt/2)(u^n + u^{n+1}). Afterwards velocity_next holds how far each particle is from where the list
/// of neighbours was made.
template <int Dim>
void add_stages_at_moved_positions(Simulation<Dim>& simulation);

} // namespace sphvv::solver::projection
