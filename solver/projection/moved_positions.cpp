#include "sphvv/solver/projection/moved_positions.hpp"

namespace sphvv::solver::projection {
namespace {

/// Widening of the neighbour search by this share of the support, so that the list made at r* can follow the
/// particles to r^{n+1}, which differs by (dt/2)(u^{n+1} - u^n), at most 0.1 h |u^{n+1} - u^n|/u_max.
constexpr double search_skin = 0.03;

/// u^{n+1} = u* - (dt/rho) grad p, and r^{n+1} = r* + (dt/2)(u^{n+1} - u^n), which equals r^n + (dt/2)(u^n +
/// u^{n+1}).
template <int Dim>
void project(Simulation<Dim>& s, Projection<Dim>& p) {
    subtract_pressure_gradient(s, p, p.pressure, s.time_step, p.velocity_next);
    const auto u = arrays<Dim>(s.particles.velocity);
    const auto next = arrays<Dim>(p.velocity_next);
    const auto x = arrays<Dim>(s.particles.position);
    const int count = static_cast<int>(s.particles.size());
#pragma omp parallel for schedule(static)
    for (int i = 0; i < count; ++i) {
        for (int d = 0; d < Dim; ++d) {
            const double correction = 0.5 * s.time_step * (next[d][i] - u[d][i]);
            x[d][i] += correction;
            u[d][i] = next[d][i];
            next[d][i] = correction;
        }
    }
}

} // namespace

template <int Dim>
void add_stages_at_moved_positions(Simulation<Dim>& s) {
    const auto projection = make_projection(s, Density::constant);
    s.add_stage("time_step", choose_time_step<Dim>);
    s.add_stage("drift", [](Simulation<Dim>& sim) {
        drift(sim);
        sim.positions_time = sim.time + sim.time_step;
    });
    s.add_stage("neighbours", [](Simulation<Dim>& sim) { find_neighbours(sim, search_skin); });
    add_surface_stage(s);
    add_forces_stages(s, projection);
    s.add_stage("pressure_poisson", [projection](Simulation<Dim>& sim) {
        write_divergence_equations(sim, *projection);
        solve_poisson(sim, projection->poisson, projection->pressure);
    });
    s.add_stage("projection", [projection](Simulation<Dim>& sim) { project(sim, *projection); });
}

template void add_stages_at_moved_positions(Simulation<2>&);
template void add_stages_at_moved_positions(Simulation<3>&);

} // namespace sphvv::solver::projection
