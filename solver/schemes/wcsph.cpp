#include "sphvv/solver/operators/divergence_difference.hpp"
#include "sphvv/solver/operators/momentum_weakly_compressible.hpp"
#include "sphvv/solver/schemes.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace sphvv::solver::schemes {
namespace {

/// Widening of the neighbour search by this share of the support: the predictor moves particles by (dt/2) u,
/// at most 0.2 h U/c0 = 0.02 h at the acoustic limit.
constexpr double search_skin = 0.03;

/// Tait's equation of state, p = (rho0 c0^2/gamma) [(rho/rho0)^gamma - 1] + p_b.
struct Tait {
    double density;
    double sound_speed;
    double gamma;
    double background;

    double stiffness() const { return density * sound_speed * sound_speed / gamma; }
    double pressure(double rho) const {
        return stiffness() * (std::pow(rho / density, gamma) - 1) + background;
    }
    double density_at(double p) const {
        return density * std::pow(1 + (p - background) / stiffness(), 1 / gamma);
    }
};

template <int Dim>
struct Fields {
    Field& density;
    Field& pressure;
    Field& pressure_over_squared_density;
    Field& specific_volume;
    Field& acceleration;
    Tait tait;
    double eta_squared;
};

template <int Dim>
void choose_time_step(Simulation<Dim>& s, double sound_speed) {
    const double fixed = s.settings.number("time_step");
    const double h = s.smoothing_length;
    double limit = fixed;
    if (fixed == 0) {
        // Lee 2008 §1.3: 0.4 h/c0, 0.25 sqrt(h/|f|), 0.125 h^2/nu.
        limit = std::min(s.settings.number("acoustic_limit") * h / sound_speed,
                         s.settings.number("viscous_limit") * h * h / s.kinematic_viscosity);
        if (s.maximum_acceleration > 0) {
            limit = std::min(limit, s.settings.number("force_limit") * std::sqrt(h / s.maximum_acceleration));
        }
    }
    s.time_step = even_step(s, limit);
}

/// acceleration(density, pressure, velocity) on the current neighbour list.
template <int Dim>
void accelerate(Simulation<Dim>& s, Fields<Dim>& f) {
    const int count = static_cast<int>(s.particles.size());
    const double* rho = f.density[0];
    const double* p = f.pressure[0];
    double* P = f.pressure_over_squared_density[0];
    double* volume = f.specific_volume[0];
#pragma omp parallel for simd schedule(static)
    for (int i = 0; i < count; ++i) {
        volume[i] = 1 / rho[i];
        P[i] = p[i] * volume[i] * volume[i];
    }
    const MomentumFields<Dim> fields{constant_arrays<Dim>(s.particles.velocity), P, volume};
    const double mu = s.density * s.kinematic_viscosity;
    const auto a = arrays<Dim>(f.acceleration);
    for_each_row(s.neighbours, [&](int i, const Row<Dim>& row) {
        const Vector<Dim> total =
            momentum_weakly_compressible<Dim>(row, i, fields, s.particle_mass, mu, f.eta_squared);
        for (int d = 0; d < Dim; ++d) {
            a[d][i] = total[d];
        }
    });
    s.count_sweeps(1);
}

template <int Dim>
double largest(const Field& field, int count) {
    double squared_maximum = 0;
#pragma omp parallel for schedule(static) reduction(max : squared_maximum)
    for (int i = 0; i < count; ++i) {
        double squared = 0;
        for (int d = 0; d < Dim; ++d) {
            squared += field[d][i] * field[d][i];
        }
        squared_maximum = std::max(squared_maximum, squared);
    }
    return std::sqrt(squared_maximum);
}

/// target += scale * increment, component by component.
template <int Dim>
void add_scaled(Field& target, double scale, const Field& increment, int count) {
    for (int d = 0; d < Dim; ++d) {
        double* to = target[d];
        const double* from = increment[d];
#pragma omp parallel for simd schedule(static)
        for (int i = 0; i < count; ++i) {
            to[i] += scale * from[i];
        }
    }
}

/// rate_i = drho_i/dt = sum_j m (u_i - u_j).gradW_ij, on the current neighbour list. Source: Lee 2008 §1.3,
/// Issa S2.
template <int Dim>
void continuity(Simulation<Dim>& s, double* rate) {
    const auto u = constant_arrays<Dim>(s.particles.velocity);
    const UniformVolume mass{s.particle_mass};
    for_each_row(s.neighbours,
                 [&](int i, const Row<Dim>& row) { rate[i] = -divergence_difference<Dim>(row, i, u, mass); });
    s.count_sweeps(1);
}

template <int Dim>
void update_pressure(Simulation<Dim>& s, Fields<Dim>& f) {
    const int count = static_cast<int>(s.particles.size());
    const double* rho = f.density[0];
    double* p = f.pressure[0];
#pragma omp parallel for schedule(static)
    for (int i = 0; i < count; ++i) {
        p[i] = f.tait.pressure(rho[i]);
    }
}

/// Lee 2008 §1.1: u^{n+1} from p^n, u^n; r^{n+1} = r^n + dt u^{n+1}; rho^{n+1} = rho^n - dt rho^n div
/// u^{n+1}, on the neighbours of r^n. Updating rho with the new velocity makes the acoustic part symplectic:
/// with the old one the step is forward Euler for sound and unstable at any dt > nu/c0^2.
template <int Dim>
void add_explicit_stages(Simulation<Dim>& s, const std::shared_ptr<Fields<Dim>>& f) {
    Field& rate = s.particles.field("density_rate", 1, Lifetime::scratch, "continuity");
    s.add_stage("neighbours", [](Simulation<Dim>& sim) { find_neighbours(sim, 0); });
    s.add_stage("momentum", [f](Simulation<Dim>& sim) {
        const int count = static_cast<int>(sim.particles.size());
        accelerate(sim, *f);
        sim.maximum_acceleration = largest<Dim>(f->acceleration, count);
        add_scaled<Dim>(sim.particles.velocity, sim.time_step, f->acceleration, count);
    });
    s.add_stage("continuity", [f, &rate](Simulation<Dim>& sim) {
        continuity(sim, rate[0]);
        add_scaled<1>(f->density, sim.time_step, rate, static_cast<int>(sim.particles.size()));
    });
    s.add_stage("drift", [](Simulation<Dim>& sim) {
        add_scaled<Dim>(sim.particles.position, sim.time_step, sim.particles.velocity,
                        static_cast<int>(sim.particles.size()));
    });
}

/// Issa 2005 §3, scheme PC: X^{n+1/2} = X^n + (dt/2) R(X^n); X^{n+1} = X^n + dt R(X^{n+1/2}); second order.
template <int Dim>
void add_predictor_corrector_stages(Simulation<Dim>& s, const std::shared_ptr<Fields<Dim>>& f) {
    Field& rate = s.particles.field("density_rate", 1, Lifetime::scratch, "continuity");
    Field& start = s.particles.field("step_start", 2 * Dim + 1, Lifetime::scratch, "predictor");
    Field& moved = s.particles.field("predictor_displacement", Dim, Lifetime::scratch, "predictor");
    s.add_stage("neighbours", [](Simulation<Dim>& sim) { find_neighbours(sim, search_skin); });
    s.add_stage("predictor", [f, &rate, &start, &moved](Simulation<Dim>& sim) {
        const int count = static_cast<int>(sim.particles.size());
        const double half = 0.5 * sim.time_step;
        accelerate(sim, *f);
        sim.maximum_acceleration = largest<Dim>(f->acceleration, count);
        continuity(sim, rate[0]);
        for (int d = 0; d < Dim; ++d) {
            start.components[d] = sim.particles.position.components[d];
            start.components[Dim + d] = sim.particles.velocity.components[d];
            std::fill(moved.components[d].begin(), moved.components[d].end(), 0.0);
        }
        start.components.back() = f->density.components[0];
        add_scaled<Dim>(moved, half, sim.particles.velocity, count);
        add_scaled<Dim>(sim.particles.position, 1, moved, count);
        add_scaled<Dim>(sim.particles.velocity, half, f->acceleration, count);
        add_scaled<1>(f->density, half, rate, count);
        update_pressure(sim, *f);
    });
    s.add_stage("corrector", [f, &rate, &start, &moved](Simulation<Dim>& sim) {
        const int count = static_cast<int>(sim.particles.size());
        if (!sim.neighbours.follow(constant_arrays<Dim>(moved))) {
            renew_neighbours(sim);
        }
        accelerate(sim, *f);
        continuity(sim, rate[0]);
        for (int d = 0; d < Dim; ++d) {
            sim.particles.position.components[d] = start.components[d];
        }
        add_scaled<Dim>(sim.particles.position, sim.time_step, sim.particles.velocity, count);
        for (int d = 0; d < Dim; ++d) {
            sim.particles.velocity.components[d] = start.components[Dim + d];
        }
        f->density.components[0] = start.components.back();
        add_scaled<Dim>(sim.particles.velocity, sim.time_step, f->acceleration, count);
        add_scaled<1>(f->density, sim.time_step, rate, count);
    });
}

template <int Dim>
void assemble(Simulation<Dim>& s) {
    const double sound_speed = s.settings.number("c0_over_u") * s.reference_speed;
    const double eta = s.settings.number("eta_over_h") * s.smoothing_length;
    Particles<Dim>& particles = s.particles;
    auto fields = std::make_shared<Fields<Dim>>(Fields<Dim>{
        particles.field("density", 1, Lifetime::state, "continuity"),
        particles.field("pressure", 1, Lifetime::state, "equation_of_state"),
        particles.field("pressure_over_squared_density", 1, Lifetime::scratch, "momentum"),
        particles.field("specific_volume", 1, Lifetime::scratch, "momentum"),
        particles.field("acceleration", Dim, Lifetime::scratch, "momentum"),
        Tait{s.density, sound_speed, s.settings.number("gamma"),
             s.settings.number("background_pressure") * s.density * s.reference_speed * s.reference_speed},
        eta * eta});
    s.add_stage("time_step", [sound_speed](Simulation<Dim>& sim) { choose_time_step(sim, sound_speed); });
    if (s.settings.word("integrator") == "explicit") {
        add_explicit_stages(s, fields);
    } else {
        add_predictor_corrector_stages(s, fields);
    }
    s.add_stage("equation_of_state", [fields](Simulation<Dim>& sim) { update_pressure(sim, *fields); });
    // The scene gives the pressure at the start; the density that goes with it keeps the start free of sound.
    const int count = static_cast<int>(particles.size());
    for (int i = 0; i < count; ++i) {
        fields->density[0][i] = fields->tait.density_at(fields->pressure[0][i] + fields->tait.background);
    }
    update_pressure(s, *fields);
}

TimeOrder time_order(const Settings& settings) {
    return settings.word("integrator") == "explicit"
               ? TimeOrder{1, "symplectic Euler (Lee 2008 §1.1)"}
               : TimeOrder{2, "midpoint predictor-corrector (Issa 2005 §3, scheme PC)"};
}

} // namespace

const Scheme& wcsph() {
    static const Scheme scheme{
        .name = "wcsph",
        .summary = "weakly compressible SPH, continuity equation, Tait equation of state, Morris viscosity",
        .formula =
            "drho/dt = sum m u_ij.gradW; du/dt = -sum m (p_i/rho_i^2 + p_j/rho_j^2) gradW + viscosity; "
            "p = (rho0 c0^2/gamma) [(rho/rho0)^gamma - 1]",
        .source = "Lee 2008 §1.1; Issa 2005 §3 (predictor-corrector)",
        .compressible = true,
        .keys = joined(
            common_keys("wendland_c2", 1.3),
            {Key::word("integrator", "explicit", {"explicit", "predictor_corrector"},
                       "explicit: Lee 2008, first order; predictor_corrector: Issa 2005, second order"),
             Key::number("c0_over_u", 10, 1, 1e4, "1", "sound speed over the largest expected speed"),
             Key::number("gamma", 7, 1, 20, "1", "exponent of the Tait equation"),
             Key::number("background_pressure", 0.5, 0, 1e6, "1",
                         "constant added to p, in units of rho0 U^2; 0.5 keeps Bernoulli pressures from "
                         "tension, which is unstable (Swegle); the papers use 0"),
             Key::number("eta_over_h", 0, 0, 1, "1", "eta/h in the Morris viscosity"),
             Key::number("acoustic_limit", 0.4, 1e-4, 10, "1", "dt <= this h/c0"),
             Key::number("viscous_limit", 0.125, 1e-4, 10, "1", "dt <= this h^2/nu"),
             Key::number("force_limit", 0.25, 1e-4, 10, "1", "dt <= this sqrt(h/|du/dt|)")}),
        .time_order = time_order,
        .assemble_2d = assemble<2>,
        .assemble_3d = assemble<3>,
    };
    return scheme;
}

} // namespace sphvv::solver::schemes
