#include "sphvv/solver/operators/gradient_difference.hpp"
#include "sphvv/solver/operators/renormalisation.hpp"
#include "sphvv/solver/operators/shifting_vector.hpp"
#include "sphvv/solver/projection/moved_positions.hpp"

#include <algorithm>
#include <cmath>

namespace sphvv::solver::schemes {
namespace {

template <int Dim>
struct Shift {
    Field& displacement; ///< dr_i, m
    Field* correction;   ///< of velocity and pressure; none without a Taylor correction
    Field* gradient; ///< of every component of the velocity, then of the pressure; none below second order
};

/// Only neighbours nearer to i than i is to the free surface push it, and nothing pushes a particle of the
/// surface. Source: Xu 2009 §2.3.
template <int Dim>
double shifting_radius(const Simulation<Dim>& s, int i, const Row<Dim>& row) {
    double radius = s.neighbours.support_radius();
    if (!s.free_surface) {
        return radius;
    }
    const std::vector<std::uint8_t>& at_surface = s.free_surface->at_surface;
    if (at_surface[i] != 0) {
        return 0;
    }
    for (int k = 0; k < row.count; ++k) {
        const int j = row.index[k];
        if (j < static_cast<int>(at_surface.size()) && at_surface[j] != 0) {
            double squared = 0;
            for (int d = 0; d < Dim; ++d) {
                squared += row.separation[d][k] * row.separation[d][k];
            }
            radius = std::min(radius, std::sqrt(squared));
        }
    }
    return radius;
}

/// dr_i = C u_max dt R_i and grad A . dr, with the normalised gradient G-. (The thesis corrects the velocity;
/// the pressure is corrected here too, because it is compared, and guessed from, at the new position.)
template <int Dim>
void form_shift(Simulation<Dim>& s, const UniformVolume& volume, const double* p, const Shift<Dim>& f) {
    const double length = s.settings.number("shift_coefficient") * maximum_speed(s) * s.time_step;
    const double longest = s.settings.number("shift_limit") * s.particle_spacing;
    const auto u = constant_arrays<Dim>(s.particles.velocity);
    for_each_row(s.neighbours, [&](int i, const Row<Dim>& row) {
        Vector<Dim> dr = length * shifting_vector<Dim>(row, shifting_radius(s, i, row));
        dr *= std::min(1.0, longest / std::max(dr.norm(), 1e-300));
        for (int d = 0; d < Dim; ++d) {
            f.displacement[d][i] = dr[d];
        }
        if (f.correction == nullptr) {
            return;
        }
        const Matrix<Dim> L = renormalisation<Dim>(row, volume);
        const Vector<Dim> L_dr = L * dr;
        const Matrix<Dim> grad_u = vector_gradient_difference<Dim>(row, i, u, volume);
        const Vector<Dim> grad_p = gradient_difference<Dim>(row, i, p, volume);
        const Vector<Dim> velocity_change = grad_u * L_dr;
        for (int d = 0; d < Dim; ++d) {
            (*f.correction)[d][i] = velocity_change[d];
        }
        (*f.correction)[Dim][i] = grad_p.dot(L_dr);
        if (f.gradient != nullptr) {
            const Matrix<Dim> normalised_u = grad_u * L;
            const Vector<Dim> normalised_p = L * grad_p;
            for (int b = 0; b < Dim; ++b) {
                for (int a = 0; a < Dim; ++a) {
                    (*f.gradient)[a * Dim + b][i] = normalised_u(a, b);
                }
                (*f.gradient)[Dim * Dim + b][i] = normalised_p[b];
            }
        }
    });
    s.count_sweeps(f.correction != nullptr ? 4 : 1);
}

/// Adds 1/2 dr . (grad grad A) . dr to the corrections, with grad grad A_i = sum_j V_j (grad A_j - grad A_i)
/// (x) L_i gradW_ij. Source: Xu 2009 §2.3.
template <int Dim>
void add_second_order(Simulation<Dim>& s, const UniformVolume& volume, const Shift<Dim>& f) {
    for_each_row(s.neighbours, [&](int i, const Row<Dim>& row) {
        Vector<Dim> dr;
        for (int d = 0; d < Dim; ++d) {
            dr[d] = f.displacement[d][i];
        }
        const Vector<Dim> L_dr = renormalisation<Dim>(row, volume) * dr;
        for (int a = 0; a <= Dim; ++a) {
            std::array<const double*, Dim> gradient;
            for (int b = 0; b < Dim; ++b) {
                gradient[b] = (*f.gradient)[a * Dim + b];
            }
            const Vector<Dim> change = vector_gradient_difference<Dim>(row, i, gradient, volume) * L_dr;
            (*f.correction)[a][i] += 0.5 * dr.dot(change);
        }
    });
    s.count_sweeps(Dim + 2);
}

/// Moves every particle by dr_i and carries velocity and pressure along by their Taylor expansion, A(r + dr)
/// = A(r) + grad A . dr (+ 1/2 dr . grad grad A . dr).
template <int Dim>
void shift(Simulation<Dim>& s, const Shift<Dim>& f) {
    Particles<Dim>& particles = s.particles;
    Field& pressure = particles.field("pressure", 1, Lifetime::state, "shifting");
    const UniformVolume volume{s.particle_mass / s.density};
    // The list was made at r*: it follows the particles to r^{n+1}, or is made anew if they went too far for
    // it.
    s.fill_walls(f.displacement, Parity::displacement);
    if (!s.neighbours.follow(constant_arrays<Dim>(f.displacement))) {
        renew_neighbours(s, s.time + s.time_step);
    }
    s.fill_walls(particles.velocity, Parity::velocity);
    s.fill_walls_pressure(pressure);
    form_shift(s, volume, pressure[0], f);
    if (f.gradient != nullptr) {
        add_second_order(s, volume, f);
    }
    add_scaled<Dim>(particles.position, 1, f.displacement);
    if (f.correction != nullptr) {
        const int count = static_cast<int>(particles.size());
#pragma omp parallel for schedule(static)
        for (int i = 0; i < count; ++i) {
            for (int d = 0; d < Dim; ++d) {
                particles.velocity[d][i] += (*f.correction)[d][i];
            }
            pressure[0][i] += (*f.correction)[Dim][i];
        }
    }
}

template <int Dim>
void assemble(Simulation<Dim>& s) {
    projection::add_stages_at_moved_positions(s);
    const std::string& order = s.settings.word("shift_correction");
    const auto scratch = [&](const char* name, int components) {
        return &s.particles.field(name, components, Lifetime::scratch, "shifting");
    };
    const Shift<Dim> fields{*scratch("velocity_next", Dim),
                            order == "none" ? nullptr : scratch("shift_correction", Dim + 1),
                            order == "second" ? scratch("shift_gradient", Dim * (Dim + 1)) : nullptr};
    s.add_stage("shifting", [fields](Simulation<Dim>& sim) { shift(sim, fields); });
}

/// A Taylor correction of the velocity is no force between particles.
Conserves conserves(const Settings& settings) {
    return settings.word("shift_correction") == "none" ? projection::conserves(settings)
                                                       : Conserves{false, false, false};
}

} // namespace

const Scheme& isph_dfs() {
    static const Scheme scheme{
        .name = "isph_dfs",
        .summary = "isph_df with particle shifting, which keeps the arrangement even",
        .formula =
            "isph_df, then dr = C u_max dt R, R_i = sum_j (rbar_i/r_ij)^2 n_ij, u += grad u . dr (+ 1/2 "
            "dr . grad grad u . dr)",
        .source = "Xu, Stansby & Laurence 2009; Xu 2009 §2.3 (ISPH_DFS)",
        .compressible = false,
        .keys = joined(projection::keys(),
                       {Key::number("shift_coefficient", 0.04, 0, 1, "1", "C in dr = C u_max dt R"),
                        Key::number("shift_limit", 0.1, 0, 1e3, "1", "|dr| <= this dx"),
                        Key::word("shift_correction", "first", {"first", "second", "none"},
                                  "order of the Taylor correction of the shifted fields")}),
        .time_order = projection::euler_order,
        .conserves = conserves,
        .assemble_2d = assemble<2>,
        .assemble_3d = assemble<3>,
    };
    return scheme;
}

} // namespace sphvv::solver::schemes
