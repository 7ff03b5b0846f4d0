#pragma once

#include "sphvv/solver/kernels.hpp"

/// What a kernel does to a square lattice under pressure, from the kernel alone.
namespace sphvv::verification {

/// f''(dx/h) of the kernel W = C f(r/h)/h^dim: by Swegle's criterion in one dimension, w'' T > 0 with the
/// stress T = -p, particles under pressure are unstable where it is negative. Source: Swegle et al. 1995;
/// Issa 2005 §2.8.
double swegle_number(const solver::Kernel& kernel, double h_over_dx);

/// Smallest value, over that at k = 0, of the kernel's Fourier transform in two dimensions,
/// 2 pi int W(r) J_0(k r) r dr, at the wave numbers that a square lattice resolves, k <= sqrt(2) pi/dx. Where
/// it is negative particles under pressure may pair: Dehnen & Aly 2012. It is their energy at the wave number
/// k alone; the lattice adds that of every alias of k (lattice_growth).
double smallest_transform(const solver::Kernel& kernel, double h_over_dx);

/// Growth of the worst disturbance of an infinite square lattice in two dimensions under a uniform pressure:
/// sigma^2 rho dx^2/p, with sigma (1/s) its rate; 0 where there is none that grows.
///
/// A displacement xi e^(i k.r) changes the force -sum_j m (p_i + p_j)/(rho_i rho_j) gradW_ij by the constant
/// pressure times K xi, K = 2 sum_j V (1 - cos k.r_j) grad grad W(r_j), and by the change of density that it
/// makes, rho c0^2 g (g.xi) with g = sum_j V sin(k.r_j) gradW(r_j). As c0^2 >> p/rho, what grows keeps the
/// density, xi.g = 0: sigma^2 = -(p/rho) min over k of xi.K xi. The minimum is taken over k on a grid of
/// pi/(12 dx). Derived here; the energy Hessian of Issa 2005, appendix B, for the modes of a lattice.
double lattice_growth(const solver::Kernel& kernel, double h_over_dx);

} // namespace sphvv::verification
