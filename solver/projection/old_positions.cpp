#include "sphvv/solver/projection/old_positions.hpp"

#include <utility>

namespace sphvv::solver::projection {
namespace {

/// Adds alpha (rho_0 - rho^n)/dt^2 to the source of Laplacian p, that is minus it to the source of -Laplacian
/// p, which is what the solver's equations are of.
template <int Dim>
void relax_density(Simulation<Dim>& s, PressurePoisson<Dim>& poisson, const Field& density,
                   double relaxation) {
    const int count = static_cast<int>(s.particles.size());
    const double scale = relaxation / (s.time_step * s.time_step);
    const double target = target_density(s, density);
    const double* rho = density[0];
#pragma omp parallel for schedule(static)
    for (int i = 0; i < count; ++i) {
        poisson.source(i) -= scale * (target - rho[i]);
    }
    poisson.set_round_off(sum_round_off * (s.density * scale + s.density * s.reference_speed /
                                                                   (s.smoothing_length * s.time_step)));
}

/// u^{n+1} = u* - (dt/rho) grad p, and the largest acceleration, (u^{n+1} - u^n)/dt.
template <int Dim>
void project(Simulation<Dim>& s, Projection<Dim>& p) {
    subtract_pressure_gradient(s, p, p.pressure, s.time_step, p.velocity_next);
    std::swap(s.particles.velocity.components, p.velocity_next.components);
    Field& change = p.velocity_next;
    add_scaled<Dim>(change, -1, s.particles.velocity);
    s.maximum_acceleration = largest_norm<Dim>(change) / s.time_step;
}

} // namespace

std::vector<Key> keys_at_old_positions(std::string_view kernel, double h_over_dx) {
    return joined(keys({kernel, h_over_dx, "symmetric", 0.4, 0.125}),
                  {Key::number("force_limit", 0.25, 1e-4, 10, "1", "dt <= this sqrt(h/|du/dt|)")});
}

template <int Dim>
void add_stages_at_old_positions(Simulation<Dim>& s, double relaxation) {
    const auto projection = make_projection(s, Density::constant);
    Field* density =
        relaxation > 0 ? &s.particles.field("particle_density", 1, Lifetime::scratch, "density") : nullptr;
    s.add_stage("time_step", choose_time_step<Dim>);
    s.add_stage("neighbours", [](Simulation<Dim>& sim) { find_neighbours(sim, 0); });
    add_surface_stage(s);
    add_forces_stages(s, projection);
    if (density != nullptr) {
        s.add_stage("density", [density](Simulation<Dim>& sim) { sum_density(sim, *density); });
    }
    s.add_stage("pressure_poisson", [projection, density, relaxation](Simulation<Dim>& sim) {
        write_divergence_equations(sim, *projection);
        if (density != nullptr) {
            relax_density(sim, projection->poisson, *density, relaxation);
        }
        solve_poisson(sim, projection->poisson, projection->pressure);
    });
    s.add_stage("projection", [projection](Simulation<Dim>& sim) { project(sim, *projection); });
    s.add_stage("drift", drift<Dim>);
}

template void add_stages_at_old_positions(Simulation<2>&, double);
template void add_stages_at_old_positions(Simulation<3>&, double);

} // namespace sphvv::solver::projection
