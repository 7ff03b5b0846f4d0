#pragma once

#include <string>

/// How long a step a strained flow bears: Taylor-Green vortices without viscosity, U = L = 1, on a lattice of
/// n x n particles with n a multiple of 4, so that the saddle points of the flow lie midway between
/// particles.
///
/// The published bound of incompressible schemes is dt <= 0.2 h/U. A Lagrangian scheme in a uniform stream
/// knows nothing of the stream (Galilean invariance): there is no such limit of stability. In a flow
/// u = A r with tr A = 0 the particles drift to r* = F r, F = I + dt A, and carry u = A F^-1 r*. As A^2 =
/// -det A I, this is
///   A F^-1 = (A + dt det A I)/(1 + dt^2 det A),
/// whose isotropic part is what a projection takes off: A becomes A/(1 + dt^2 det A), that is s/(1 - sigma^2)
/// of a strain s with sigma = s dt, and omega/(1 + theta^2) of a rotation with theta = omega dt. F is
/// singular at sigma = 1: the drift folds the fluid, r* is no arrangement any more. Of Taylor-Green vortices
/// the largest strain is s = 2 pi U/L, and the fold lies at
///   dt = L/(2 pi U) = n dx/(2 pi U), or n/(0.4 pi h/dx) times the published bound:
/// 0.61 n of it at h/dx = 1.3. So the published bound is one of accuracy, not of stability.
///
/// (That is the projection of a linear flow. In the vortices the pressure of the rest of the flow adds to it
/// at second order in dt, which moves no fold: F is that of the drift alone.)
///
/// Beyond the fold there are caustics, across which particles of different places mix, so that no run keeps
/// its arrangement there. Below it a run is squeezed by the flow itself, by e^-1 in the time 1/s, and how
/// much shorter than the fold its longest step is depends on the scheme: theory gives bounds, the published
/// step from below (else it would be one of stability, and too long) and the fold from above.
namespace sphvv::verification {

struct StrainedFlow {
    std::string scheme; ///< a variant, as variant_of() reads it
    int n = 20;
};

/// Two particles closer than this share of dx have lost their places on the lattice.
constexpr double least_spacing = 0.1;

/// dt (s) at which the two particles astride a saddle point meet in the first drift: dx/(2 U sin(pi/n)),
/// which is the fold but for O(1/n^2).
double fold_step(const StrainedFlow& flow);

/// Whether a run to t = 1/s, in steps of dt (s), keeps least_spacing and 1.1 of its kinetic energy. One step
/// more is taken, which sees the arrangement that the last one left.
bool keeps_arrangement(const StrainedFlow& flow, double dt);

} // namespace sphvv::verification
