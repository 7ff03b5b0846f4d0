#include "sphvv/solver/projection/projection.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sphvv::solver::schemes {
namespace {

using projection::Projection;

/// max_i |rho_0 - rho_i|/rho_0, which is |sigma_0 - sigma_i|/sigma_0 with sigma_0 = rho_0/m; with
/// target_density() in the place of rho_0, as in the equations that take the error out.
template <int Dim>
double largest_density_error(const Simulation<Dim>& s, const Field& density) {
    const int count = static_cast<int>(s.particles.size());
    const double* rho = density[0];
    const double target = projection::target_density(s, density);
    double largest = 0;
#pragma omp parallel for schedule(static) reduction(max : largest)
    for (int i = 0; i < count; ++i) {
        largest = std::max(largest, std::abs(target - rho[i]) / s.density);
    }
    return largest;
}

/// r^{(m+1)} = r^{(m)} - (dt^2/2) grad p/rho with (dt^2/2) div(grad p/rho) = (sigma_0 - sigma)/sigma_0 at
/// r^{(m)}, until the largest |right-hand side| is below density_tolerance, or density_iterations times.
///
/// This pressure is no guess for that of the divergence-free half, nor the other way round: it is kept in a
/// field of its own.
template <int Dim>
void make_density_invariant(Simulation<Dim>& s, Projection<Dim>& p, Field& density_pressure) {
    const double tolerance = s.settings.number("density_tolerance");
    const int most = s.settings.integer("density_iterations");
    const double tau_squared = s.time_step * s.time_step / 2;
    renew_neighbours(s, s.time + s.time_step);
    projection::sum_density(s, *p.density);
    for (int m = 0; m < most && largest_density_error(s, *p.density) >= tolerance; ++m) {
        projection::write_density_equations(s, p, tau_squared);
        projection::solve_poisson(s, p.poisson, density_pressure);
        projection::subtract_pressure_gradient(s, p, density_pressure, tau_squared, s.particles.position);
        renew_neighbours(s, s.time + s.time_step);
        projection::sum_density(s, *p.density);
    }
}

template <int Dim>
void form_first_half_forced_velocity(Simulation<Dim>& s, Projection<Dim>& p) {
    projection::form_forced_velocity(s, p, s.time_step / 2, s.time_step / 2);
}

template <int Dim>
void form_second_half_forced_velocity(Simulation<Dim>& s, Projection<Dim>& p) {
    projection::form_forced_velocity(s, p, s.time_step / 2, s.time_step);
}

/// Takes over u^{*,1/2} as the velocity: u^n is not needed any more.
template <int Dim>
void take_over_velocity(Simulation<Dim>& s, Projection<Dim>& p) {
    std::swap(s.particles.velocity.components, p.velocity_next.components);
}

/// u^{n+1} = u* - (dt/2 rho) grad P with div(grad P/rho) = (2/dt) div u*.
///
/// P is twice the physical pressure: the half-step dt/2 multiplies it, although it alone has to supply the
/// change of momentum of the whole step, since the pressure of the density-invariant half moves particles
/// but never enters the velocity (Xu sheet §2). The equations are linear in P; here they are solved for p =
/// P/2, which is the pressure: div(grad p/rho) = div u*/dt, u^{n+1} = u* - (dt/rho) grad p.
template <int Dim>
void make_divergence_free(Simulation<Dim>& s, Projection<Dim>& p) {
    projection::write_divergence_equations(s, p);
    projection::solve_poisson(s, p.poisson, p.pressure);
}

template <int Dim>
void assemble(Simulation<Dim>& s) {
    const auto shared = projection::make_projection(s, projection::Density::summed);
    Field& density_pressure = s.particles.field("density_pressure", 1, Lifetime::state, "density_invariance");
    s.add_stage("time_step", projection::choose_time_step<Dim>);
    s.add_stage("neighbours", [](Simulation<Dim>& sim) { find_neighbours(sim, 0); });
    add_surface_stage(s);
    s.add_stage(projection::forces_name(s), [shared](Simulation<Dim>& sim) {
        form_first_half_forced_velocity(sim, *shared);
        take_over_velocity(sim, *shared);
    });
    s.add_stage("drift", projection::drift<Dim>);
    s.add_stage("density_invariance", [shared, &density_pressure](Simulation<Dim>& sim) {
        make_density_invariant(sim, *shared, density_pressure);
    });
    s.add_stage("second_" + projection::forces_name(s),
                [shared](Simulation<Dim>& sim) { form_second_half_forced_velocity(sim, *shared); });
    s.add_stage("pressure_poisson", [shared](Simulation<Dim>& sim) { make_divergence_free(sim, *shared); });
    s.add_stage("projection", [shared](Simulation<Dim>& sim) {
        projection::subtract_pressure_gradient(sim, *shared, shared->pressure, sim.time_step,
                                               shared->velocity_next);
        take_over_velocity(sim, *shared);
    });
}

} // namespace

const Scheme& isph_dfdi() {
    static const Scheme scheme{
        .name = "isph_dfdi",
        .summary =
            "truly incompressible SPH that keeps both: positions to the density, then velocities free of "
            "divergence",
        .formula =
            "u* = u + dt/2 nu Lap u; r' = r + dt u*, then r' -= dt^2/2 grad q/rho with dt^2/2 div(grad "
            "q/rho) = (rho0 - rho)/rho0 until it is below 1 %; u** = u* + dt/2 nu Lap u*; div(grad "
            "p/rho) = div u**/dt; u' = u** - (dt/rho) grad p; rho = sum m W",
        .source = "Hu & Adams 2007; Xu 2009 §2.2 (ISPH_DFDI), whose p is twice this one",
        .compressible = false,
        .keys = joined(projection::keys(),
                       {Key::number("density_tolerance", 0.01, 1e-9, 1, "1",
                                    "density invariance goes on until max|rho0 - rho|/rho0 is below this"),
                        Key::integer("density_iterations", 20, 0, 1000, "of density invariance, at most")}),
        .time_order = projection::euler_order,
        .conserves = projection::conserves,
        .assemble_2d = assemble<2>,
        .assemble_3d = assemble<3>,
    };
    return scheme;
}

} // namespace sphvv::solver::schemes
