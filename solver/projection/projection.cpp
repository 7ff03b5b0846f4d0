#include "sphvv/solver/projection/projection.hpp"

#include "sphvv/solver/linear/pressure_poisson.hpp"
#include "sphvv/solver/operators/divergence_difference.hpp"
#include "sphvv/solver/operators/gradient_difference.hpp"
#include "sphvv/solver/operators/laplacian_morris.hpp"
#include "sphvv/solver/operators/laplacian_schwaiger.hpp"
#include "sphvv/solver/operators/renormalisation.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace sphvv::solver::projection {
namespace {

/// Widening of the neighbour search by this share of the support, so that the list made at r* can follow the
/// particles to r^{n+1}, which differs by (dt/2)(u^{n+1} - u^n), at most 0.1 h |u^{n+1} - u^n|/u_max.
constexpr double search_skin = 0.03;

/// What the stages of one step share.
template <int Dim>
struct Fields {
    Field& pressure;
    Field& velocity_next;   ///< u*, then u^{n+1}, while velocity still holds u^n
    Field* renormalisation; ///< L_i at r*, row by row; none if nothing needs it
    bool normalised;
    bool schwaiger;
    double eta_squared;
    UniformVolume volume;
    PressurePoisson<Dim> poisson;
};

template <int Dim>
void write_matrix(Field& field, int i, const Matrix<Dim>& L) {
    for (int a = 0; a < Dim; ++a) {
        for (int b = 0; b < Dim; ++b) {
            field[a * Dim + b][i] = L(a, b);
        }
    }
}

template <int Dim>
Matrix<Dim> read_matrix(const Field& field, int i) {
    Matrix<Dim> L;
    for (int a = 0; a < Dim; ++a) {
        for (int b = 0; b < Dim; ++b) {
            L(a, b) = field[a * Dim + b][i];
        }
    }
    return L;
}

template <int Dim>
void choose_time_step(Simulation<Dim>& s) {
    const double fixed = s.settings.number("time_step");
    const double h = s.smoothing_length;
    // Xu 2009 §3.4: 0.2 h/u_max and 0.2 h^2/nu. The thesis used one common step for all methods at a Reynolds
    // number, so u_max is the largest speed that the scene expects; a flow that exceeds it shortens the step.
    // (With the current speed of a decaying flow the last steps grow to 0.2 h/u_max(t): at Re = 100, 20^2,
    // that triples the velocity error.)
    const double u_max = std::max(s.reference_speed, maximum_speed(s));
    const double limit = fixed > 0
                             ? fixed
                             : std::min(s.settings.number("advective_limit") * h / u_max,
                                        s.settings.number("viscous_limit") * h * h / s.kinematic_viscosity);
    s.time_step = even_step(s, limit);
}

template <int Dim>
void drift(Simulation<Dim>& s) {
    const int count = static_cast<int>(s.particles.size());
    for (int d = 0; d < Dim; ++d) {
        double* x = s.particles.position[d];
        const double* u = s.particles.velocity[d];
#pragma omp parallel for simd schedule(static)
        for (int i = 0; i < count; ++i) {
            x[i] += s.time_step * u[i];
        }
    }
}

/// L_i and u* = u^n + dt nu Laplacian u^n.
template <int Dim>
void add_viscosity(Simulation<Dim>& s, Fields<Dim>& f) {
    const auto u = constant_arrays<Dim>(s.particles.velocity);
    const auto next = arrays<Dim>(f.velocity_next);
    const double dt_nu = s.time_step * s.kinematic_viscosity;
    const bool needs_L = f.renormalisation != nullptr;
    for_each_row(s.neighbours, [&](int i, const Row<Dim>& row) {
        Vector<Dim> laplacian;
        if (needs_L) {
            const Matrix<Dim> L = renormalisation<Dim>(row, f.volume);
            write_matrix<Dim>(*f.renormalisation, i, L);
            laplacian = f.schwaiger ? laplacian_schwaiger<Dim>(row, i, u, f.volume, L)
                                    : laplacian_morris<Dim>(row, i, u, f.volume, f.eta_squared);
        } else {
            laplacian = laplacian_morris<Dim>(row, i, u, f.volume, f.eta_squared);
        }
        for (int d = 0; d < Dim; ++d) {
            next[d][i] = u[d][i] + dt_nu * laplacian[d];
        }
    });
    s.count_sweeps((needs_L ? 1 : 0) + (f.schwaiger ? 3 : 1));
}

/// sum_j w_ij (p_i - p_j) = -(rho/dt) div u*.
template <int Dim>
void solve_pressure(Simulation<Dim>& s, Fields<Dim>& f) {
    const auto u = constant_arrays<Dim>(f.velocity_next);
    const double scale = -s.density / s.time_step;
    f.poisson.reset(s.neighbours);
    for_each_row(s.neighbours, [&](int i, const Row<Dim>& row) {
        double divergence = 0;
        if (f.normalised) {
            const Matrix<Dim> L = read_matrix<Dim>(*f.renormalisation, i);
            divergence = (vector_gradient_difference<Dim>(row, i, u, f.volume) * L).trace();
        } else {
            divergence = divergence_difference<Dim>(row, i, u, f.volume);
        }
        f.poisson.source(i) = scale * divergence;
        f.poisson.diagonal(i) =
            f.schwaiger ? laplacian_schwaiger_weights<Dim>(
                              row, f.volume, read_matrix<Dim>(*f.renormalisation, i), f.poisson.weights(i))
                        : laplacian_morris_weights<Dim>(row, f.volume, f.eta_squared, f.poisson.weights(i));
    });
    s.count_sweeps(f.schwaiger ? 3 : 2);
    solve_poisson(s, f.poisson, f.pressure);
}

/// u^{n+1} = u* - (dt/rho) grad p, and r^{n+1} = r* + (dt/2)(u^{n+1} - u^n), which equals r^n + (dt/2)(u^n +
/// u^{n+1}).
template <int Dim>
void project(Simulation<Dim>& s, Fields<Dim>& f) {
    const auto u = arrays<Dim>(s.particles.velocity);
    const auto next = arrays<Dim>(f.velocity_next);
    const auto x = arrays<Dim>(s.particles.position);
    const double scale = s.time_step / s.density;
    for_each_row(s.neighbours, [&](int i, const Row<Dim>& row) {
        Vector<Dim> gradient = gradient_difference<Dim>(row, i, f.pressure[0], f.volume);
        if (f.normalised) {
            gradient = read_matrix<Dim>(*f.renormalisation, i) * gradient;
        }
        for (int d = 0; d < Dim; ++d) {
            next[d][i] -= scale * gradient[d];
        }
    });
    s.count_sweeps(1);
    const int count = static_cast<int>(s.particles.size());
#pragma omp parallel for schedule(static)
    for (int i = 0; i < count; ++i) {
        for (int d = 0; d < Dim; ++d) {
            const double correction = 0.5 * s.time_step * (next[d][i] - u[d][i]);
            x[d][i] += correction;
            u[d][i] = next[d][i];
            next[d][i] = correction; // how far the particle is now from where the neighbour list was made
        }
    }
}

} // namespace

TimeOrder euler_order(const Settings& /*settings*/) {
    return {1,
            "forward Euler: viscosity of the old velocity, pressure constant over the step (Xu 2009 §2.2)"};
}

template <int Dim>
void solve_poisson(Simulation<Dim>& s, PressurePoisson<Dim>& poisson, Field& pressure) {
    const LinearSolve solve = poisson.solve(pressure[0]);
    s.work.solver_iterations += solve.iterations;
    s.work.matrix_entries += solve.matrix_entries;
    if (!solve.converged) {
        throw Diverged("pressure solver stopped at residual " + shortest(solve.residual) + " after " +
                       std::to_string(solve.iterations) + " iterations at t = " + shortest(s.time) +
                       ", step " + std::to_string(s.step));
    }
}

template void solve_poisson(Simulation<2>&, PressurePoisson<2>&, Field&);
template void solve_poisson(Simulation<3>&, PressurePoisson<3>&, Field&);

std::vector<Key> keys() {
    return joined(
        common_keys("quintic_spline", 1.3),
        {Key::word("laplacian", "morris", {"morris", "schwaiger"},
                   "Laplacian of viscosity and pressure: LM or LS"),
         Key::word("gradient", "normalised", {"normalised", "plain"},
                   "gradient and divergence: renormalised G- or G-"),
         Key::number("eta_over_h", 0, 0, 1, "1", "eta/h in the Morris Laplacian"),
         Key::number("advective_limit", 0.2, 1e-4, 2, "1", "dt <= this h/u_max"),
         Key::number("viscous_limit", 0.2, 1e-4, 2, "1", "dt <= this h^2/nu"),
         Key::number("pressure_tolerance", 1e-5, 1e-14, 0.1, "1", "relative residual of the pressure solve"),
         Key::word("preconditioner", "two_level", {"two_level", "jacobi"}, "of the pressure solve")});
}

template <int Dim>
void add_divergence_free_stages(Simulation<Dim>& s) {
    using Poisson = PressurePoisson<Dim>;
    const bool schwaiger = s.settings.word("laplacian") == "schwaiger";
    const bool normalised = s.settings.word("gradient") == "normalised";
    const double eta = s.settings.number("eta_over_h") * s.smoothing_length;
    typename Poisson::Options options;
    options.tolerance = s.settings.number("pressure_tolerance");
    options.symmetric = !schwaiger;
    options.preconditioner = s.settings.word("preconditioner") == "jacobi"
                                 ? Poisson::Preconditioner::jacobi
                                 : Poisson::Preconditioner::two_level;
    Particles<Dim>& particles = s.particles;
    auto fields = std::make_shared<Fields<Dim>>(Fields<Dim>{
        particles.field("pressure", 1, Lifetime::state, "pressure_poisson"),
        particles.field("velocity_next", Dim, Lifetime::scratch, "viscosity"),
        normalised || schwaiger
            ? &particles.field("renormalisation", Dim * Dim, Lifetime::scratch, "viscosity")
            : nullptr,
        normalised, schwaiger, eta * eta, UniformVolume{s.particle_mass / s.density}, Poisson(options)});
    s.add_stage("time_step", choose_time_step<Dim>);
    s.add_stage("drift", drift<Dim>);
    s.add_stage("neighbours", [](Simulation<Dim>& sim) { find_neighbours(sim, search_skin); });
    s.add_stage("viscosity", [fields](Simulation<Dim>& sim) { add_viscosity(sim, *fields); });
    s.add_stage("pressure_poisson", [fields](Simulation<Dim>& sim) { solve_pressure(sim, *fields); });
    s.add_stage("projection", [fields](Simulation<Dim>& sim) { project(sim, *fields); });
}

template void add_divergence_free_stages(Simulation<2>&);
template void add_divergence_free_stages(Simulation<3>&);

} // namespace sphvv::solver::projection
