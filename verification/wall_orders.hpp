#pragma once

#include "sphvv/verification/case.hpp"

/// What shear flows along walls owe to the wall method: shared by the cases that are such flows.
namespace sphvv::verification::wall_orders {

/// Orders of the velocity by scheme and wall method, derived as follows. At the wall y = 0, where u = w, the
/// flow has u = w + a y + b y^2 + O(y^3).
///
/// Images of the fluid with 2w - u continue it with -b y^2: the second derivative jumps by 4b, and Laplacians
/// of the particles whose support reaches beyond the wall, a layer as thick as h, are wrong by O(1). The
/// error solves nu e'' = -(that) with e = 0 at the wall: e = O(h^2) everywhere. Layers of particles with the
/// velocity w continue the flow without a gradient: Laplacians of the same layer are wrong by a O(1/h), and
/// e = O(h).
///
/// Steps: up to Re = 5 and from 10 spacings on, projections keep to the viscous limit, dt proportional to
/// h^2; with a limit that changes along a ladder the errors of space and time may cancel at its coarse end.
/// WCSPH keeps to the acoustic one, dt proportional to h, with a fiftieth of their error.
///
/// The Morris Laplacian ends at 0.5 to 1.4e-3 of the viscous term (verification rules, §4). Where images
/// leave an error of that size on the ladder, WCSPH, which has no other, shows no order.
enum class MorrisFloor { below, reached };
std::vector<Expectation> expectations(MorrisFloor floor);

/// The ladders of a case, quick, nightly and full.
std::vector<Study> studies(const std::string& name);

} // namespace sphvv::verification::wall_orders
