#include "sphvv/solver/projection/old_positions.hpp"

namespace sphvv::solver::schemes {
namespace {

template <int Dim>
void assemble(Simulation<Dim>& s) {
    projection::add_stages_at_old_positions(s, s.settings.number("relaxation"));
}

} // namespace

const Scheme& isph_asai() {
    static const Scheme scheme{
        .name = "isph_asai",
        .summary = "isph_lee with relaxed density invariance: the pressure takes back a share of the density "
                   "error",
        .formula = "isph_lee with Lap p = (rho0/dt) div u* + alpha (rho0 - rho)/dt^2, rho = sum m W",
        .source = "Asai 2012 (whose pressure solver stops at 1e-9)",
        .compressible = false,
        .keys = joined(
            projection::keys_at_old_positions("quintic_spline", 1.2),
            {Key::number("relaxation", 0.1, 0, 1, "1",
                         "alpha, the share of the density error that a step takes off; the paper finds "
                         "0.1 to 0.2 at dx = 10 mm and far less at finer dx and the same dt")}),
        .time_order = projection::euler_order,
        .conserves = projection::conserves,
        .assemble_2d = assemble<2>,
        .assemble_3d = assemble<3>,
    };
    return scheme;
}

} // namespace sphvv::solver::schemes
