#include "sphvv/solver/projection/old_positions.hpp"

namespace sphvv::solver::schemes {
namespace {

template <int Dim>
void assemble(Simulation<Dim>& s) {
    projection::add_stages_at_old_positions(s, 0);
}

} // namespace

const Scheme& isph_lee() {
    static const Scheme scheme{
        .name = "isph_lee",
        .summary =
            "truly incompressible SPH, divergence-free projection at the old positions, which conserves "
            "momentum",
        .formula = "u* = u + dt nu Lap u; Lap p = (rho/dt) div u*; u' = u* - (dt/rho) grad p; r' = r + dt u'",
        .source = "Lee 2008 §1.2 (whose pressure solver stops at 1e-2)",
        .compressible = false,
        .keys = projection::keys_at_old_positions("quartic_spline", 1.3),
        .time_order = projection::euler_order,
        .conserves = projection::conserves,
        .assemble_2d = assemble<2>,
        .assemble_3d = assemble<3>,
    };
    return scheme;
}

} // namespace sphvv::solver::schemes
