#include "sphvv/solver/operators/gradient_difference.hpp"
#include "sphvv/solver/operators/renormalisation.hpp"
#include "sphvv/solver/operators/shifting_vector.hpp"
#include "sphvv/solver/projection/projection.hpp"

namespace sphvv::solver::schemes {
namespace {

/// Moves every particle by dr_i = C u_max dt R_i and carries velocity and pressure along by their first-order
/// Taylor expansion, A(r + dr) = A(r) + grad A . dr. (The thesis corrects the velocity; the pressure is
/// corrected here too, because it is compared, and guessed from, at the new position.) Without a field for
/// the corrections there are none.
template <int Dim>
void shift(Simulation<Dim>& s, Field& displacement, Field* correction) {
    Particles<Dim>& particles = s.particles;
    Field& pressure = particles.field("pressure", 1, Lifetime::state, "shifting");
    const UniformVolume volume{s.particle_mass / s.density};
    // The list was made at r*: it follows the particles to r^{n+1}, or is made anew if they went too far for
    // it.
    if (!s.neighbours.follow(constant_arrays<Dim>(displacement))) {
        renew_neighbours(s);
    }
    const double length = s.settings.number("shift_coefficient") * maximum_speed(s) * s.time_step;
    const double longest = s.settings.number("shift_limit") * s.particle_spacing;
    const auto u = constant_arrays<Dim>(particles.velocity);
    const double* p = pressure[0];
    for_each_row(s.neighbours, [&](int i, const Row<Dim>& row) {
        Vector<Dim> dr = length * shifting_vector<Dim>(row, s.neighbours.support_radius());
        dr *= std::min(1.0, longest / std::max(dr.norm(), 1e-300));
        for (int d = 0; d < Dim; ++d) {
            displacement[d][i] = dr[d];
        }
        if (correction) {
            const Vector<Dim> L_dr = renormalisation<Dim>(row, volume) * dr;
            const Vector<Dim> velocity_change = vector_gradient_difference<Dim>(row, i, u, volume) * L_dr;
            for (int d = 0; d < Dim; ++d) {
                (*correction)[d][i] = velocity_change[d];
            }
            (*correction)[Dim][i] = gradient_difference<Dim>(row, i, p, volume).dot(L_dr);
        }
    });
    s.count_sweeps(correction ? 4 : 1);
    const int count = static_cast<int>(particles.size());
#pragma omp parallel for schedule(static)
    for (int i = 0; i < count; ++i) {
        for (int d = 0; d < Dim; ++d) {
            particles.position[d][i] += displacement[d][i];
        }
    }
    if (correction) {
#pragma omp parallel for schedule(static)
        for (int i = 0; i < count; ++i) {
            for (int d = 0; d < Dim; ++d) {
                particles.velocity[d][i] += (*correction)[d][i];
            }
            pressure[0][i] += (*correction)[Dim][i];
        }
    }
}

template <int Dim>
void assemble(Simulation<Dim>& s) {
    projection::add_divergence_free_stages(s);
    Field& displacement = s.particles.field("velocity_next", Dim, Lifetime::scratch, "shifting");
    Field* correction = s.settings.word("shift_correction") == "first"
                            ? &s.particles.field("shift_correction", Dim + 1, Lifetime::scratch, "shifting")
                            : nullptr;
    s.add_stage("shifting",
                [&displacement, correction](Simulation<Dim>& sim) { shift(sim, displacement, correction); });
}

} // namespace

const Scheme& isph_dfs() {
    static const Scheme scheme{
        .name = "isph_dfs",
        .summary = "isph_df with particle shifting, which keeps the arrangement even",
        .formula = "isph_df, then dr = C u_max dt R, R_i = sum_j (rbar_i/r_ij)^2 n_ij, u += grad u . dr",
        .source = "Xu, Stansby & Laurence 2009; Xu 2009 §2.3 (ISPH_DFS)",
        .compressible = false,
        .keys = joined(projection::keys(),
                       {Key::number("shift_coefficient", 0.04, 0, 1, "1", "C in dr = C u_max dt R"),
                        Key::number("shift_limit", 0.1, 0, 1e3, "1", "|dr| <= this dx"),
                        Key::word("shift_correction", "first", {"first", "none"},
                                  "Taylor correction of the shifted fields")}),
        .time_order = projection::euler_order,
        .assemble_2d = assemble<2>,
        .assemble_3d = assemble<3>,
    };
    return scheme;
}

} // namespace sphvv::solver::schemes
