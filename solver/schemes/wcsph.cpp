#include "sphvv/solver/schemes.hpp"
#include "sphvv/solver/weakly_compressible/rates.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace sphvv::solver::schemes {
namespace {

using namespace weakly_compressible;

/// Widening of the neighbour search by this share of the support: the predictor moves particles by (dt/2) u,
/// at most 0.2 h U/c0 = 0.02 h at the acoustic limit.
constexpr double search_skin = 0.03;

template <int Dim>
void choose_time_step(Simulation<Dim>& s, double sound_speed) {
    const double fixed = s.settings.number("time_step");
    const double h = s.smoothing_length;
    double limit = fixed;
    if (fixed == 0) {
        // Lee 2008 §1.3: 0.4 h/c0, 0.25 sqrt(h/|f|), 0.125 h^2/nu.
        limit = std::min(s.settings.number("acoustic_limit") * h / sound_speed,
                         s.settings.number("viscous_limit") * h * h / largest_viscosity(s));
        if (s.maximum_acceleration > 0) {
            limit = std::min(limit, s.settings.number("force_limit") * std::sqrt(h / s.maximum_acceleration));
        }
    }
    s.time_step = even_step(s, limit);
}

template <int Dim>
void add_time_step_stage(Simulation<Dim>& s, const std::shared_ptr<Rates<Dim>>& f) {
    s.add_stage("time_step", [f](Simulation<Dim>& sim) { choose_time_step(sim, f->tait.sound_speed); });
}

/// Lee 2008 §1.1: u^{n+1} from p^n, u^n; r^{n+1} = r^n + dt u^{n+1}; rho^{n+1} = rho^n - dt rho^n div
/// u^{n+1}, on the neighbours of r^n. Updating rho with the new velocity makes the acoustic part symplectic:
/// with the old one the step is forward Euler for sound and unstable at any dt > nu/c0^2.
template <int Dim>
void add_explicit_stages(Simulation<Dim>& s, const std::shared_ptr<Rates<Dim>>& f) {
    if (!s.turbulence) {
        add_time_step_stage(s, f);
    }
    s.add_stage("neighbours", [](Simulation<Dim>& sim) { find_neighbours(sim, 0); });
    add_wall_function_stage(s);
    if (s.turbulence) {
        // The limit of the step is that of the eddy viscosity which acts in it.
        add_turbulence_stages(s);
        add_time_step_stage(s, f);
    }
    add_flow_driver_stage(s);
    s.add_stage("momentum", [f](Simulation<Dim>& sim) {
        accelerate(sim, *f);
        sim.maximum_acceleration = largest_norm<Dim>(f->acceleration);
        add_scaled<Dim>(sim.particles.velocity, sim.time_step, f->acceleration);
    });
    s.add_stage("continuity", [f](Simulation<Dim>& sim) {
        continuity(sim, *f);
        add_scaled<1>(f->density, sim.time_step, f->density_rate);
    });
    s.add_stage("drift", [](Simulation<Dim>& sim) {
        add_scaled<Dim>(sim.particles.position, sim.time_step, sim.particles.velocity);
    });
    add_wall_transport_stage(s);
}

/// Issa 2005 §3, scheme PC: X^{n+1/2} = X^n + (dt/2) R(X^n); X^{n+1} = X^n + dt R(X^{n+1/2}); second order.
template <int Dim>
void add_predictor_corrector_stages(Simulation<Dim>& s, const std::shared_ptr<Rates<Dim>>& f) {
    Field& start = s.particles.field("step_start", 2 * Dim + 1, Lifetime::scratch, "predictor");
    // The list follows the particles; walls that move, and their images, ask for a new one anyway.
    Field* const moved =
        s.walls_move() ? nullptr
                       : &s.particles.field("predictor_displacement", Dim, Lifetime::scratch, "predictor");
    add_time_step_stage(s, f);
    s.add_stage("neighbours", [](Simulation<Dim>& sim) { find_neighbours(sim, search_skin); });
    s.add_stage("predictor", [f, &start, moved](Simulation<Dim>& sim) {
        const double half = 0.5 * sim.time_step;
        accelerate(sim, *f);
        sim.maximum_acceleration = largest_norm<Dim>(f->acceleration);
        continuity(sim, *f);
        for (int d = 0; d < Dim; ++d) {
            start.components[d] = sim.particles.position.components[d];
            start.components[Dim + d] = sim.particles.velocity.components[d];
        }
        start.components.back() = f->density.components[0];
        if (moved != nullptr) {
            for (auto& component : moved->components) {
                std::ranges::fill(component, 0.0);
            }
            add_scaled<Dim>(*moved, half, sim.particles.velocity);
            add_scaled<Dim>(sim.particles.position, 1, *moved);
        } else {
            add_scaled<Dim>(sim.particles.position, half, sim.particles.velocity);
        }
        add_scaled<Dim>(sim.particles.velocity, half, f->acceleration);
        add_scaled<1>(f->density, half, f->density_rate);
        update_pressure(sim, *f);
    });
    s.add_stage("corrector", [f, &start, moved](Simulation<Dim>& sim) {
        if (moved != nullptr) {
            sim.fill_walls(*moved, Parity::displacement); // images in walls that stay
        }
        if (moved == nullptr || sim.walls_move() || !sim.neighbours.follow(constant_arrays<Dim>(*moved))) {
            renew_neighbours(sim, sim.time + 0.5 * sim.time_step);
        }
        sim.set_body_force(sim.time + 0.5 * sim.time_step);
        accelerate(sim, *f);
        continuity(sim, *f);
        for (int d = 0; d < Dim; ++d) {
            sim.particles.position.components[d] = start.components[d];
        }
        add_scaled<Dim>(sim.particles.position, sim.time_step, sim.particles.velocity);
        for (int d = 0; d < Dim; ++d) {
            sim.particles.velocity.components[d] = start.components[Dim + d];
        }
        f->density.components[0] = start.components.back();
        add_scaled<Dim>(sim.particles.velocity, sim.time_step, f->acceleration);
        add_scaled<1>(f->density, sim.time_step, f->density_rate);
    });
}

/// What the Verlet scheme remembers of the step before.
template <int Dim>
struct StepBefore {
    Field& velocity;
    Field& density;
    bool leaps = false; ///< over two steps; otherwise the step in progress is an Euler step
};

/// Nothing to leap from in the first step; the two solutions of a leap over two steps, on odd and even steps,
/// drift apart unless an Euler step brings them together now and then; and the leap needs steps of one
/// length.
template <int Dim>
bool leaps(const Simulation<Dim>& s, double time_step_before) {
    constexpr double round_off = 1e-9; // of dividing the time left into even steps
    return s.step > 1 && (s.step - 1) % s.settings.integer("restart_interval") != 0 &&
           std::abs(s.time_step - time_step_before) <= round_off * s.time_step;
}

/// value^{n+1} = value^{n-1} + 2 dt rate, or value^n + dt rate; value^n becomes the value before.
template <int Components>
void step_verlet(Field& value, Field& before, double dt, bool leap, const Field& rate, int count) {
    for (int d = 0; d < Components; ++d) {
        double* now = value[d];
        double* then = before[d];
        const double* change = rate[d];
        const double* from = leap ? then : now;
        const double step = leap ? 2 * dt : dt;
#pragma omp parallel for simd schedule(static)
        for (int i = 0; i < count; ++i) {
            const double next = from[i] + step * change[i];
            then[i] = now[i];
            now[i] = next;
        }
    }
}

/// u^{n+1} = u^{n-1} + 2 dt a^n, rho^{n+1} = rho^{n-1} + 2 dt (drho/dt)^n, r^{n+1} = r^n + dt u^n + dt^2/2
/// a^n; u^n + dt a^n and rho^n + dt (drho/dt)^n where it does not leap. Source: Verlet 1967, in the form of
/// SPHysics (Gomez-Gesteira et al. 2012).
template <int Dim>
void add_verlet_stages(Simulation<Dim>& s, const std::shared_ptr<Rates<Dim>>& f) {
    const auto before = std::make_shared<StepBefore<Dim>>(
        StepBefore<Dim>{s.particles.field("previous_velocity", Dim, Lifetime::state, "verlet"),
                        s.particles.field("previous_density", 1, Lifetime::state, "verlet")});
    s.add_stage("time_step", [f, before](Simulation<Dim>& sim) {
        const double time_step_before = sim.time_step;
        choose_time_step(sim, f->tait.sound_speed);
        before->leaps = leaps(sim, time_step_before);
    });
    s.add_stage("neighbours", [](Simulation<Dim>& sim) { find_neighbours(sim, 0); });
    s.add_stage("momentum", [f](Simulation<Dim>& sim) {
        accelerate(sim, *f);
        sim.maximum_acceleration = largest_norm<Dim>(f->acceleration);
    });
    s.add_stage("continuity", [f](Simulation<Dim>& sim) { continuity(sim, *f); });
    s.add_stage("verlet", [f, before](Simulation<Dim>& sim) {
        const int count = static_cast<int>(sim.particles.size());
        const double dt = sim.time_step;
        add_scaled<Dim>(sim.particles.position, dt, sim.particles.velocity);
        add_scaled<Dim>(sim.particles.position, dt * dt / 2, f->acceleration);
        step_verlet<Dim>(sim.particles.velocity, before->velocity, dt, before->leaps, f->acceleration, count);
        step_verlet<1>(f->density, before->density, dt, before->leaps, f->density_rate, count);
    });
}

/// Eddy viscosity and velocity at the edge are formed once in a step: in one with several levels they would
/// be those of another level. And a driven flow is unstable where a step leaps over the one before
/// (flow_driver.hpp).
template <int Dim>
void refuse_levels(const Simulation<Dim>& s, const std::string& integrator) {
    if ((s.turbulence || s.wall_friction || s.flow_driver) && integrator != "explicit") {
        throw UserError("integrator '" + integrator +
                        "' has no turbulence, wall function or flow driver; accepted with them: explicit");
    }
}

template <int Dim>
void assemble(Simulation<Dim>& s) {
    // At a free surface p is 0: nothing outside would hold a background pressure.
    const double background = s.free_surface ? 0 : s.settings.number("background_pressure");
    const Tait tait{s.density, s.settings.number("c0_over_u") * s.reference_speed, s.settings.number("gamma"),
                    background * s.density * s.reference_speed * s.reference_speed};
    const auto f = std::make_shared<Rates<Dim>>(rates(s, tait));
    const std::string& integrator = s.settings.word("integrator");
    refuse_levels(s, integrator);
    if (integrator == "explicit") {
        add_explicit_stages(s, f);
    } else if (integrator == "predictor_corrector") {
        add_predictor_corrector_stages(s, f);
    } else {
        add_verlet_stages(s, f);
    }
    s.add_stage("equation_of_state", [f](Simulation<Dim>& sim) { update_pressure(sim, *f); });
    s.elastic_energy = [f](const Simulation<Dim>& sim) { return elastic_energy(sim, *f); };
    s.internal_torque = [f](const Simulation<Dim>& sim) { return internal_torque(sim, *f); };
    // The scene gives the pressure at the start; the density that goes with it keeps the start free of sound.
    const int count = static_cast<int>(s.particles.size());
    for (int i = 0; i < count; ++i) {
        f->density[0][i] = tait.density_at(f->pressure[0][i] + tait.background);
    }
    update_pressure(s, *f);
}

TimeOrder time_order(const Settings& settings) {
    const std::string& integrator = settings.word("integrator");
    if (integrator == "explicit") {
        return {1, "symplectic Euler (Lee 2008 §1.1)"};
    }
    if (integrator == "verlet") {
        // The Euler step of a restart, wrong by O(dt^2), starts the chain of odd steps; the even ones leap
        // from the state at the restart. After an even number of steps the next restart drops the odd chain
        // and its error; after an odd number it goes on from there, and the errors of T/dt restarts add up.
        const bool even = settings.integer("restart_interval") % 2 == 0;
        return {even ? 2. : 1.,
                even ? "Verlet 1967; restarts after an even number of steps leave no trace"
                     : "Verlet 1967 with an Euler step at restarts after an odd number of steps"};
    }
    return {2, "midpoint predictor-corrector (Issa 2005 §3, scheme PC)"};
}

/// Energy: pairs of continuity and pressure force that are variational (Oger 2007). Torque: forces along the
/// line of the pair have none; nor has the sum of the coherent renormalised ones, because the renormalised
/// divergence of a rotation vanishes.
Conserves conserves(const Settings& settings) {
    const std::string& force = settings.word("pressure_force");
    const std::string& rate = settings.word("continuity");
    const bool coherent = force == "renormalised_coherent";
    const bool antisymmetric = coherent || force == "sigma_1" || force == "sigma_2";
    return {.momentum = antisymmetric,
            .angular_momentum = antisymmetric && settings.word("viscosity") == "monaghan_cleary",
            .energy = rate == (coherent ? "renormalised" : force) && antisymmetric};
}

} // namespace

const Scheme& wcsph() {
    static const Scheme scheme{
        .name = "wcsph",
        .summary =
            "weakly compressible SPH, continuity equation, Tait equation of state, in every published form",
        .formula =
            "drho/dt = sum m u_ij.gradW; du/dt = -sum m (p_i/rho_i^2 + p_j/rho_j^2) gradW + viscosity; "
            "p = (rho0 c0^2/gamma) [(rho/rho0)^gamma - 1]; other forms: continuity, pressure_force, "
            "viscosity",
        .source = "Lee 2008 §1.1; Issa 2005 §2, §3 (predictor-corrector); Oger et al. 2007; Verlet 1967",
        .compressible = true,
        .keys = joined(
            common_keys("wendland_c2", 1.3),
            {Key::word("continuity", "sigma_2", {"sigma_2", "sigma_1", "renormalised"},
                       "drho_i/dt: sigma_2, sum m u_ij.gradW; sigma_1, rho_i sum V_j u_ij.gradW; "
                       "renormalised, rho_i sum V_j u_ij.L_i gradW; energy is conserved with the "
                       "pressure_force sigma_2, sigma_1 and renormalised_coherent in turn"),
             Key::word("pressure_force", "sigma_2",
                       {"sigma_2", "sigma_1", "plain", "difference", "renormalised_coherent", "renormalised",
                        "taylor", "hybrid_taylor"},
                       "-sum m X_ij: sigma_2, X = (p_i/rho_i^2 + p_j/rho_j^2) gradW; otherwise rho_i rho_j X "
                       "is sigma_1, (p_i + p_j) gradW; plain, p_j gradW; difference, (p_j - p_i) gradW; "
                       "renormalised_coherent, (p_i L_i + p_j L_j) gradW; renormalised, (p_i + p_j) L_i "
                       "gradW; taylor, (p_j - p_i) L_i gradW; hybrid_taylor, taylor, but renormalised at and "
                       "next to particles whose lowest eigenvalue of 1/L_i is below 0.97"),
             Key::word("viscosity", "morris", {"morris", "monaghan_cleary"},
                       "morris: along u_ij; monaghan_cleary: along r_ij, with factor 2(dim+2); neither where "
                       "nu = 0"),
             Key::word(
                 "eddy_mean", "arithmetic", {"arithmetic", "logarithmic"},
                 "of the eddy viscosities of a pair, where turbulence is modelled; logarithmic: exact where "
                 "they grow in proportion to the distance from a wall"),
             Key::word("integrator", "explicit", {"explicit", "predictor_corrector", "verlet"},
                       "explicit: Lee 2008, first order; predictor_corrector: Issa 2005, second order; "
                       "verlet: a leap over two steps, as in SPHysics"),
             Key::integer("restart_interval", 50, 1, 1000000,
                          "verlet: every so many steps, and where the step has changed, an Euler step"),
             Key::number("c0_over_u", 10, 1, 1e4, "1", "sound speed over the largest expected speed"),
             Key::number("gamma", 7, 1, 20, "1", "exponent of the Tait equation"),
             Key::number(
                 "background_pressure", 0.5, 0, 1e6, "1",
                 "constant added to p, in units of rho0 U^2; 0.5 keeps Bernoulli pressures from "
                 "tension, which is unstable (Swegle); the papers use 0, and so does a scene with a free "
                 "surface"),
             Key::number("eta_over_h", 0, 0, 1, "1", "eta/h in the viscosity"),
             Key::number("acoustic_limit", 0.4, 1e-4, 10, "1", "dt <= this h/c0"),
             Key::number("viscous_limit", 0.125, 1e-4, 10, "1", "dt <= this h^2/nu"),
             Key::number("force_limit", 0.25, 1e-4, 10, "1", "dt <= this sqrt(h/|du/dt|)")}),
        .time_order = time_order,
        .conserves = conserves,
        .assemble_2d = assemble<2>,
        .assemble_3d = assemble<3>,
    };
    return scheme;
}

} // namespace sphvv::solver::schemes
