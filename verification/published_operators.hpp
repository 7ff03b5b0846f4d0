#pragma once

#include "sphvv/solver/kernels.hpp"

#include <string>
#include <vector>

namespace sphvv::verification {

/// One figure about an operator that a publication, or our specification sheet of it, prints, and ours.
struct PublishedFigure {
    std::string id;
    std::string text;      ///< what is measured, and how it is judged
    std::string published; ///< as printed, with its unit
    std::string source;
    std::string ours;
    double reference; ///< the printed number, in the printed unit
    double value;     ///< ours, in the same unit
    double tolerance; ///< on |value - reference|, as a fraction of |reference|
    bool is_bound;    ///< the value must only stay below the reference
    bool agrees;
    std::string waiver; ///< why it is known not to agree; empty where it must
};

/// |value - reference| <= tolerance |reference|, or, for a bound, value < reference. A value that is not
/// finite never agrees.
bool agrees(const PublishedFigure& figure);

/// Every figure of Xu 2009 §3.5 and §6.2 (truncated supports, wall and open-channel Poisson problems), of the
/// bias by eta and of the neighbour counts of Oger 2007, reproduced by the operators of solver/operators/.
///
/// The tolerance is the larger of 2 % and half a unit of the last printed digit unless the text says
/// otherwise. Takes about a second. `quintic_spline` is the kernel of Xu 2009; a test puts a faulty one in
/// its place.
std::vector<PublishedFigure>
published_operator_figures(const solver::Kernel& quintic_spline = solver::kernels::find("quintic_spline"));

/// How far the sums over neighbours are from integrals, at one h/dx.
struct ConsistencyRow {
    double h_over_dx;
    double neighbours;   ///< mean number of particles within the support of a point
    double worst_zeroth; ///< largest component of |h sum_j V_j gradW_ij|, 0 for integrals
    double worst_first;  ///< largest component of |sum_j V_j (r_j - r_i) (x) gradW_ij - I|
    double jitter;       ///< random displacement of the particles from a square lattice, dx
};

/// The consistency sums of Oger 2007 (Figs. 1 and 2), which prints curves only and finds that h/dx of about 3
/// is needed: extreme values over 500 arbitrary points between the particles (not at particles, where the
/// zeroth sum vanishes on a lattice by symmetry), two-dimensional, V = dx^2. The paper's particle set is
/// not on our sheet, so a lattice and one jittered by 0.2 dx are both given. Fixed seeds.
std::vector<ConsistencyRow>
oger_consistency_sums(const solver::Kernel& cubic_spline = solver::kernels::find("cubic_spline"));

} // namespace sphvv::verification
