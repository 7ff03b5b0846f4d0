#include "sphvv/solver/projection/moved_positions.hpp"

namespace sphvv::solver::schemes {

const Scheme& isph_df() {
    static const Scheme scheme{
        .name = "isph_df",
        .summary = "truly incompressible SPH, divergence-free projection, particles move with the flow",
        .formula = "r* = r + dt u; u* = u + dt nu Lap u; Lap p = (rho/dt) div u*; u' = u* - (dt/rho) grad p; "
                   "r' = r + dt (u + u')/2",
        .source = "Cummins & Rudman 1999; Xu 2009 §2.2 (ISPH_DF)",
        .compressible = false,
        .keys = projection::keys(),
        .time_order = projection::euler_order,
        .conserves = projection::conserves,
        .assemble_2d = projection::add_stages_at_moved_positions<2>,
        .assemble_3d = projection::add_stages_at_moved_positions<3>,
    };
    return scheme;
}

} // namespace sphvv::solver::schemes
