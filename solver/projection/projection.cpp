#include "sphvv/solver/projection/projection.hpp"

#include "sphvv/solver/operators/divergence_difference.hpp"
#include "sphvv/solver/operators/gradient_difference.hpp"
#include "sphvv/solver/operators/gradient_sigma_2.hpp"
#include "sphvv/solver/operators/gradient_symmetric.hpp"
#include "sphvv/solver/operators/laplacian_morris.hpp"
#include "sphvv/solver/operators/laplacian_over_density.hpp"
#include "sphvv/solver/operators/laplacian_schwaiger.hpp"
#include "sphvv/solver/operators/renormalisation.hpp"
#include "sphvv/solver/operators/summation_density.hpp"
#include "sphvv/solver/operators/viscous_monaghan_cleary.hpp"

#include <algorithm>
#include <cmath>

namespace sphvv::solver::projection {
namespace {

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

Gradient gradient_of(const Settings& settings) {
    const std::string& word = settings.word("gradient");
    if (word == "normalised") {
        return Gradient::normalised;
    }
    return word == "plain" ? Gradient::plain : Gradient::symmetric;
}

Viscosity viscosity_of(const Settings& settings) {
    const std::string& word = settings.word("viscosity");
    if (word == "monaghan_cleary") {
        return Viscosity::monaghan_cleary;
    }
    return word == "laplacian" && settings.word("laplacian") == "schwaiger" ? Viscosity::schwaiger
                                                                            : Viscosity::morris;
}

template <int Dim>
typename PressurePoisson<Dim>::Options solver_options(const Settings& settings) {
    using Poisson = PressurePoisson<Dim>;
    typename Poisson::Options options;
    options.tolerance = settings.number("pressure_tolerance");
    options.symmetric = settings.word("laplacian") == "morris";
    options.preconditioner = settings.word("preconditioner") == "jacobi" ? Poisson::Preconditioner::jacobi
                                                                         : Poisson::Preconditioner::two_level;
    return options;
}

/// Of the fluid, or of the layer next to a free surface.
template <int Dim>
bool is_viscous(const Simulation<Dim>& s) {
    return s.kinematic_viscosity > 0 || (s.free_surface && s.free_surface->layer);
}

/// Throws UserError for what an implicit viscous step does not cover.
template <int Dim>
void check_implicit_viscosity(const Simulation<Dim>& s, Viscosity viscosity) {
    const auto refuse = [](const std::string& sentence) {
        throw UserError("viscous_step=implicit " + sentence + ", or viscous_step=explicit");
    };
    if (viscosity == Viscosity::monaghan_cleary) {
        refuse("solves for each component of the velocity by itself, and viscosity=monaghan_cleary couples "
               "them; give viscosity=laplacian or morris");
    }
    if (s.free_surface && s.free_surface->layer) {
        refuse("takes one viscosity, and surface_peclet=" + s.settings.text("surface_peclet") +
               " raises it near the surface; give surface_peclet=0");
    }
    if (s.free_surface && viscosity == Viscosity::schwaiger) {
        refuse("takes a Laplacian whose sum over fewer neighbours is a free surface without stress, which "
               "LS is not; give viscosity=morris");
    }
    if (!s.walls.empty() && (s.wall_method != WallMethod::mirror || !s.wall_particles.empty())) {
        refuse("takes walls of images alone; give wall_method=mirror");
    }
    for (const Wall<Dim>& wall : s.walls) {
        for (std::size_t i = 0; i < s.particles.size() && wall.slip == Slip::free_slip; ++i) {
            Vector<Dim> x;
            for (int d = 0; d < Dim; ++d) {
                x[d] = s.particles.position[d][i];
            }
            if (wall.normal(x).cwiseAbs().maxCoeff() < 1 - 1e-12) {
                refuse("solves for each component of the velocity by itself, and free slip at " + wall.name +
                       ", which does not lie along an axis, couples them; give a wall that does");
            }
        }
    }
}

template <int Dim>
std::optional<PressurePoisson<Dim>> implicit_viscosity_of(const Simulation<Dim>& s, Viscosity viscosity) {
    if (s.settings.word("viscous_step") == "explicit" || !is_viscous(s)) {
        return std::nullopt;
    }
    check_implicit_viscosity(s, viscosity);
    auto options = solver_options<Dim>(s.settings);
    options.tolerance = s.settings.number("viscous_tolerance");
    options.symmetric = viscosity == Viscosity::morris;
    return PressurePoisson<Dim>(options);
}

/// Runs body(volume) with the volumes m/rho_j of the summation density or m/rho_0.
template <int Dim, class Body>
void with_volume(const Simulation<Dim>& s, const Projection<Dim>& p, const Body& body) {
    if (p.density != nullptr) {
        body(MassOverDensity{s.particle_mass, (*p.density)[0]});
    } else {
        body(p.volume);
    }
}

template <int Dim>
void fill_density_images(const Simulation<Dim>& s, const Projection<Dim>& p) {
    if (p.density != nullptr) {
        s.fill_walls(*p.density, Parity::even);
    }
}

/// L_i, or the identity where nothing needs it: at a constant density the one that the viscosity left.
template <int Dim>
Matrix<Dim> renormalisation_at(const Projection<Dim>& p, bool needed, int i, const Row<Dim>& /*row*/,
                               const UniformVolume& /*volume*/) {
    return needed ? read_matrix<Dim>(*p.renormalisation, i) : Matrix<Dim>(Matrix<Dim>::Identity());
}

/// The same at a summed density, formed anew.
template <int Dim>
Matrix<Dim> renormalisation_at(const Projection<Dim>& /*p*/, bool needed, int /*i*/, const Row<Dim>& row,
                               const MassOverDensity& particles) {
    return needed ? renormalisation<Dim>(row, particles) : Matrix<Dim>(Matrix<Dim>::Identity());
}

/// Sweeps for it.
template <int Dim>
int renormalisation_sweeps(const Projection<Dim>& p, bool needed) {
    return needed && p.density != nullptr ? 1 : 0;
}

template <int Dim>
Vector<Dim> viscous_term(const Projection<Dim>& p, int i, const Row<Dim>& row,
                         const std::array<const double*, Dim>& u, const Matrix<Dim>& L) {
    switch (p.viscosity) {
    case Viscosity::schwaiger:
        return laplacian_schwaiger<Dim>(row, i, u, p.volume, L);
    case Viscosity::monaghan_cleary:
        return viscous_monaghan_cleary<Dim>(row, i, u, p.volume, p.eta_squared);
    case Viscosity::morris:
        break;
    }
    return laplacian_morris<Dim>(row, i, u, p.volume, p.eta_squared);
}

/// Div u. The symmetric gradient goes with the difference divergence, its adjoint.
template <int Dim, class Volume>
double divergence(const Projection<Dim>& p, int i, const Row<Dim>& row,
                  const std::array<const double*, Dim>& u, const Volume& volume, const Matrix<Dim>& L) {
    return p.gradient == Gradient::normalised
               ? (vector_gradient_difference<Dim>(row, i, u, volume) * L).trace()
               : divergence_difference<Dim>(row, i, u, volume);
}

template <int Dim>
Vector<Dim> symmetric_gradient(int i, const Row<Dim>& row, const double* A, const UniformVolume& volume) {
    return gradient_symmetric<Dim>(row, i, A, volume);
}

template <int Dim>
Vector<Dim> symmetric_gradient(int i, const Row<Dim>& row, const double* A,
                               const MassOverDensity& particles) {
    return gradient_sigma_2<Dim>(row, i, A, UniformVolume{particles.m}, particles.rho);
}

template <int Dim, class Volume>
Vector<Dim> pressure_gradient(const Projection<Dim>& p, int i, const Row<Dim>& row, const double* pressure,
                              const Volume& volume) {
    if (p.gradient == Gradient::symmetric) {
        return symmetric_gradient<Dim>(i, row, pressure, volume);
    }
    Vector<Dim> gradient = gradient_difference<Dim>(row, i, pressure, volume);
    if (p.gradient == Gradient::plain) {
        return gradient;
    }
    return renormalisation_at<Dim>(p, true, i, row, volume) * gradient;
}

/// Row i of -Laplacian.
template <int Dim>
double write_weights(Projection<Dim>& p, int i, const Row<Dim>& row, const UniformVolume& volume,
                     const Matrix<Dim>& L) {
    return p.schwaiger ? laplacian_schwaiger_weights<Dim>(row, volume, L, p.poisson.weights(i))
                       : laplacian_morris_weights<Dim>(row, volume, p.eta_squared, p.poisson.weights(i));
}

/// Row i of -div(grad/rho).
template <int Dim>
double write_weights(Projection<Dim>& p, int i, const Row<Dim>& row, const MassOverDensity& particles,
                     const Matrix<Dim>& L) {
    return p.schwaiger
               ? laplacian_over_density_schwaiger_weights<Dim>(row, i, particles, L, p.poisson.weights(i))
               : laplacian_over_density_morris_weights<Dim>(row, i, particles, p.eta_squared,
                                                            p.poisson.weights(i));
}

template <int Dim>
int weight_sweeps(const Projection<Dim>& p) {
    return p.schwaiger ? 2 : 1;
}

} // namespace

std::vector<Key> keys(const Defaults& defaults) {
    return joined(
        common_keys(defaults.kernel, defaults.h_over_dx),
        {Key::word("laplacian", "morris", {"morris", "schwaiger"}, "Laplacian of the pressure: LM or LS"),
         Key::word("viscosity", "laplacian", {"laplacian", "morris", "monaghan_cleary"},
                   "the same Laplacian, LM, or Monaghan-Cleary's form along the line of the pair. LS has no "
                   "condition of zero stress at a free surface, the symmetric sums of the others have"),
         Key::word("gradient", std::string(defaults.gradient), {"normalised", "plain", "symmetric"},
                   "gradient and divergence: renormalised G-, G-, or G+ with its adjoint, the divergence of "
                   "G-"),
         Key::number("eta_over_h", 0, 0, 1, "1", "eta/h in the Morris Laplacian and in Monaghan-Cleary's"),
         Key::number("advective_limit", defaults.advective_limit, 1e-4, 2, "1", "dt <= this h/u_max"),
         Key::number("viscous_limit", defaults.viscous_limit, 1e-4, 2, "1",
                     "dt <= this h^2/nu with an explicit viscous step, which is unstable far above it"),
         Key::word("viscous_step", "explicit", {"explicit", "implicit"},
                   "viscosity of the old velocity (forward Euler), or of the new one (backward Euler): a "
                   "linear solve for each component, stable at any step. Implicit takes LM, or LS without a "
                   "free surface, and walls of images (mirror)"),
         Key::number("implicit_viscous_limit", 1e6, 1e-4, 1e6, "1",
                     "dt <= this h^2/nu with an implicit viscous step, for accuracy alone: a mode that "
                     "decays at the rate lambda is off by lambda dt/2 of its decay"),
         Key::number("viscous_tolerance", 1e-8, 1e-14, 0.1, "1",
                     "relative residual of the implicit viscous step, in every step"),
         Key::word(
             "surface_pressure", "at_particle", {"at_particle", "true_position"},
             "at a free surface p = 0: at the particles found there (as published), or where the surface "
             "is, half a particle above the outermost row"),
         Key::number(
             "surface_peclet", 0, 0, 1e6, "1",
             "Pe_max of the damping viscosity u_max dx/Pe_max within 2 dx of a free surface; 0 for none. "
             "Xu 2009 §6.3: 7 to 150, 30 best"),
         Key::number("pressure_tolerance", 1e-5, 1e-14, 0.1, "1", "relative residual of the pressure solve"),
         Key::word("preconditioner", "two_level", {"two_level", "jacobi"},
                   "of the pressure solve, and of an implicit viscous step")});
}

template <int Dim>
SharedProjection<Dim> make_projection(Simulation<Dim>& s, Density density) {
    Particles<Dim>& particles = s.particles;
    const Settings& settings = s.settings;
    const Gradient gradient = gradient_of(settings);
    const Viscosity viscosity = viscosity_of(settings);
    const bool schwaiger = settings.word("laplacian") == "schwaiger";
    const double eta = settings.number("eta_over_h") * s.smoothing_length;
    if (s.free_surface) {
        s.free_surface->positions = settings.word("surface_pressure") == "true_position";
        s.free_surface->layer = settings.number("surface_peclet") > 0;
        if (s.free_surface->layer && viscosity != Viscosity::morris) {
            throw UserError("surface_peclet takes the viscosity LM; give viscosity=morris");
        }
    }
    const bool summed = density == Density::summed;
    const bool keeps_L = !summed && (gradient == Gradient::normalised || schwaiger);
    auto projection = std::make_shared<Projection<Dim>>(Projection<Dim>{
        particles.field("pressure", 1, Lifetime::state, "pressure_poisson"),
        particles.field("velocity_next", Dim, Lifetime::scratch, forces_name(s)),
        keeps_L ? &particles.field("renormalisation", Dim * Dim, Lifetime::scratch,
                                   is_viscous(s) ? "viscosity" : "renormalisation")
                : nullptr,
        summed ? &particles.field("particle_density", 1, Lifetime::scratch, "pressure_poisson") : nullptr,
        gradient, viscosity, schwaiger, eta * eta, UniformVolume{s.particle_mass / s.density},
        PressurePoisson<Dim>(solver_options<Dim>(settings)), implicit_viscosity_of(s, viscosity)});
    s.pair_bytes = [projection] {
        return projection->poisson.bytes() +
               (projection->implicit_viscosity ? projection->implicit_viscosity->bytes() : 0);
    };
    return projection;
}

template <int Dim>
double damping_viscosity(const Simulation<Dim>& s) {
    // isph_mls takes no such key, nor does a scene without a surface have one.
    const bool damped = s.free_surface && s.free_surface->layer;
    return damped ? s.reference_speed * s.particle_spacing / s.settings.number("surface_peclet") : 0;
}

template <int Dim>
void choose_time_step(Simulation<Dim>& s) {
    const Settings& settings = s.settings;
    const double h = s.smoothing_length;
    double limit = settings.number("time_step");
    if (limit == 0) {
        // Xu's thesis used one common step for all methods at a Reynolds number, so u_max is the largest
        // speed that the scene expects; a flow that exceeds it shortens the step. (With the current speed of
        // a decaying flow the last steps grow to 0.2 h/u_max(t): at Re = 100, 20^2, that triples the velocity
        // error.)
        const double u_max = std::max(s.reference_speed, maximum_speed(s));
        const bool implicit = settings.has("viscous_step") && settings.word("viscous_step") == "implicit";
        limit = std::min(settings.number("advective_limit") * h / u_max,
                         settings.number(implicit ? "implicit_viscous_limit" : "viscous_limit") * h * h /
                             std::max(s.kinematic_viscosity, damping_viscosity(s)));
        if (settings.has("force_limit") && s.maximum_acceleration > 0) {
            limit = std::min(limit, settings.number("force_limit") * std::sqrt(h / s.maximum_acceleration));
        }
    }
    s.time_step = even_step(s, limit);
}

template <int Dim>
void drift(Simulation<Dim>& s) {
    add_scaled<Dim>(s.particles.position, s.time_step, s.particles.velocity);
}

namespace {

/// u* with nu_i = max(nu, nu_d) near the surface: sum_j V_j (nu_i + nu_j) F_ij (u_i - u_j), LM of a viscosity
/// that varies. Source: Xu 2009 §6.3, §2.1.4.
template <int Dim>
void form_damped_velocity(Simulation<Dim>& s, Projection<Dim>& p, double dt) {
    const auto u = constant_arrays<Dim>(s.particles.velocity);
    const auto next = arrays<Dim>(p.velocity_next);
    const FreeSurface& surface = *s.free_surface;
    std::vector<double> nu(s.particles.with_images());
    for (std::size_t i = 0; i < s.particles.size(); ++i) {
        nu[i] = surface.near_surface[i] != 0 ? std::max(s.kinematic_viscosity, damping_viscosity(s))
                                             : s.kinematic_viscosity;
    }
    s.images.fill(nu.data(), static_cast<int>(s.particles.size()));
    const double V = s.particle_mass / s.density;
    for_each_row(s.neighbours, [&](int i, const Row<Dim>& row) {
        if (p.renormalisation != nullptr) {
            write_matrix<Dim>(*p.renormalisation, i, renormalisation<Dim>(row, p.volume));
        }
        const Vector<Dim> viscous = with_slope<Dim>(p.eta_squared, [&](const auto& slope) {
            std::array<Lanes, Dim> total{};
            for (int k = 0; k < row.padded; k += lane_count) {
                const Lanes weight = V * (gather(nu.data(), row.index + k) + nu[i]) * slope(row, k);
                for (int d = 0; d < Dim; ++d) {
                    total[d] += weight * (u[d][i] - gather(u[d], row.index + k));
                }
            }
            return lane_sums<Dim>(total);
        });
        for (int d = 0; d < Dim; ++d) {
            next[d][i] = u[d][i] + dt * (viscous[d] + s.body_force[d]);
        }
    });
    s.count_sweeps(p.renormalisation != nullptr ? 2 : 1);
}

/// Books a solve; `of` names it where it did not converge.
template <int Dim>
void book(Simulation<Dim>& s, const LinearSolve& solve, const std::string& of) {
    s.work.solver_iterations += solve.iterations;
    s.work.matrix_entries += solve.matrix_entries;
    if (solve.faulty >= 0) {
        throw Diverged(of + " " + solve.fault + ": particle " + std::to_string(s.particles.id[solve.faulty]) +
                       " at t = " + shortest(s.time) + ", step " + std::to_string(s.step));
    }
    if (!solve.converged) {
        throw Diverged(of + " solver stopped at residual " + shortest(solve.residual) + " after " +
                       std::to_string(solve.iterations) + " iterations at t = " + shortest(s.time) +
                       ", step " + std::to_string(s.step));
    }
}

template <int Dim>
void solve_viscous_velocity(Simulation<Dim>& s, Projection<Dim>& p, double dt, double forced) {
    PressurePoisson<Dim>& problem = *p.implicit_viscosity;
    problem.reset(s.neighbours, s.images);
    const bool schwaiger = p.viscosity == Viscosity::schwaiger;
    const bool needs_L = p.renormalisation != nullptr || schwaiger;
    for_each_row(s.neighbours, [&](int i, const Row<Dim>& row) {
        const Matrix<Dim> L = needs_L ? renormalisation<Dim>(row, p.volume) : Matrix<Dim>::Identity();
        if (p.renormalisation != nullptr) {
            write_matrix<Dim>(*p.renormalisation, i, L);
        }
        problem.diagonal(i) =
            schwaiger ? laplacian_schwaiger_weights<Dim>(row, p.volume, L, problem.weights(i))
                      : laplacian_morris_weights<Dim>(row, p.volume, p.eta_squared, problem.weights(i));
    });
    problem.add_identity(dt * s.kinematic_viscosity);
    s.count_sweeps((needs_L ? 1 : 0) + (schwaiger ? 2 : 1));
    const double pressed = s.has_wall_pressure_gradient() ? forced : 0;
    const Vector<Dim> share = pressed * Eigen::Map<const Vector<Dim>>(s.body_force.data());
    for (int d = 0; d < Dim; ++d) {
        const double* u = s.particles.velocity[d];
        for (int i = 0; i < problem.size(); ++i) {
            problem.source(i) = u[i] + dt * s.body_force[d];
        }
        if (!s.images.empty()) {
            auto image = s.images.reflected_component(d, share, pressed);
            problem.set_image_differences(image.offset);
            problem.set_image_signs(std::move(image.sign));
        }
        std::copy_n(u, problem.size(), p.velocity_next[d]);
        book(s, problem.solve(p.velocity_next[d]), "viscous");
    }
}

template <int Dim>
void form_viscous_velocity(Simulation<Dim>& s, Projection<Dim>& p, double dt) {
    s.fill_walls(s.particles.velocity, Parity::velocity);
    const auto u = constant_arrays<Dim>(s.particles.velocity);
    const auto next = arrays<Dim>(p.velocity_next);
    const double dt_nu = dt * s.kinematic_viscosity;
    if (s.free_surface && s.free_surface->layer) {
        form_damped_velocity(s, p, dt);
        return;
    }
    const bool schwaiger = p.viscosity == Viscosity::schwaiger;
    const bool needs_L = p.renormalisation != nullptr || schwaiger;
    for_each_row(s.neighbours, [&](int i, const Row<Dim>& row) {
        Vector<Dim> laplacian;
        if (needs_L) {
            const Matrix<Dim> L = renormalisation<Dim>(row, p.volume);
            if (p.renormalisation != nullptr) {
                write_matrix<Dim>(*p.renormalisation, i, L);
            }
            laplacian = viscous_term<Dim>(p, i, row, u, L);
        } else {
            laplacian = viscous_term<Dim>(p, i, row, u, Matrix<Dim>::Identity());
        }
        for (int d = 0; d < Dim; ++d) {
            next[d][i] = u[d][i] + dt_nu * laplacian[d] + dt * s.body_force[d];
        }
    });
    s.count_sweeps((needs_L ? 1 : 0) + (schwaiger ? 3 : 1));
}

} // namespace

template <int Dim>
void form_forced_velocity(Simulation<Dim>& s, Projection<Dim>& p, double dt, double forced) {
    s.set_body_force(s.time + s.time_step); // the pressure that takes it off again is that of the end
    if (p.implicit_viscosity) {
        solve_viscous_velocity(s, p, dt, forced);
        return;
    }
    if (is_viscous(s)) {
        form_viscous_velocity(s, p, dt);
        return;
    }
    const int count = static_cast<int>(s.particles.size());
    for (int d = 0; d < Dim; ++d) {
        const double* u = s.particles.velocity[d];
        double* next = p.velocity_next[d];
        const double change = dt * s.body_force[d];
#pragma omp parallel for simd schedule(static)
        for (int i = 0; i < count; ++i) {
            next[i] = u[i] + change;
        }
    }
}

template <int Dim>
std::string forces_name(const Simulation<Dim>& s) {
    return is_viscous(s) ? "viscosity" : "body_force";
}

template <int Dim>
void form_renormalisation(Simulation<Dim>& s, Projection<Dim>& p) {
    for_each_row(s.neighbours, [&](int i, const Row<Dim>& row) {
        write_matrix<Dim>(*p.renormalisation, i, renormalisation<Dim>(row, p.volume));
    });
    s.count_sweeps(1);
}

template <int Dim>
void add_forces_stages(Simulation<Dim>& s, const SharedProjection<Dim>& projection) {
    if (!is_viscous(s) && projection->renormalisation != nullptr) {
        s.add_stage("renormalisation",
                    [projection](Simulation<Dim>& sim) { form_renormalisation(sim, *projection); });
    }
    s.add_stage(forces_name(s), [projection](Simulation<Dim>& sim) {
        form_forced_velocity(sim, *projection, sim.time_step, sim.time_step);
    });
}

template <int Dim>
void sum_density(Simulation<Dim>& s, Field& density) {
    const UniformVolume mass{s.particle_mass};
    for_each_row(s.neighbours, [&](int i, const Row<Dim>& row) {
        density[0][i] = summation_density<Dim>(row, *s.kernel, s.smoothing_length, mass, s.particle_mass);
    });
    s.count_sweeps(1);
}

template <int Dim>
double target_density(const Simulation<Dim>& s, const Field& density) {
    if (s.free_surface) {
        return s.density;
    }
    const int count = static_cast<int>(s.particles.size());
    return deterministic_sum(count, [&](int i) { return density[0][i]; }) / count;
}

template <int Dim>
void write_divergence_equations(Simulation<Dim>& s, Projection<Dim>& p) {
    s.fill_walls_forced(p.velocity_next, s.time_step);
    fill_density_images(s, p);
    const auto u = constant_arrays<Dim>(p.velocity_next);
    // The density is in the weights where it varies.
    const double scale = p.density != nullptr ? -1 / s.time_step : -s.density / s.time_step;
    const bool needs_L = p.gradient == Gradient::normalised || p.schwaiger;
    p.poisson.reset(s.neighbours, s.images);
    p.poisson.set_round_off(sum_round_off * std::abs(scale) * s.reference_speed / s.smoothing_length);
    with_volume(s, p, [&](const auto& volume) {
        for_each_row(s.neighbours, [&](int i, const Row<Dim>& row) {
            const Matrix<Dim> L = renormalisation_at<Dim>(p, needs_L, i, row, volume);
            p.poisson.source(i) = scale * divergence<Dim>(p, i, row, u, volume, L);
            p.poisson.diagonal(i) = write_weights<Dim>(p, i, row, volume, L);
        });
    });
    s.count_sweeps(1 + weight_sweeps(p) + renormalisation_sweeps(p, needs_L));
}

template <int Dim>
void write_density_equations(Simulation<Dim>& s, Projection<Dim>& p, double tau_squared) {
    fill_density_images(s, p);
    const MassOverDensity particles{s.particle_mass, (*p.density)[0]};
    const double scale = 1 / (s.density * tau_squared);
    const double target = target_density(s, *p.density);
    p.poisson.reset(s.neighbours, s.images);
    p.poisson.set_round_off(sum_round_off * scale * s.density);
    for_each_row(s.neighbours, [&](int i, const Row<Dim>& row) {
        const Matrix<Dim> L = renormalisation_at<Dim>(p, p.schwaiger, i, row, particles);
        p.poisson.source(i) = -scale * (target - particles.rho[i]);
        p.poisson.diagonal(i) = write_weights<Dim>(p, i, row, particles, L);
    });
    s.count_sweeps(weight_sweeps(p) + renormalisation_sweeps(p, p.schwaiger));
}

Conserves conserves(const Settings& settings) {
    const bool central = viscosity_of(settings) == Viscosity::monaghan_cleary;
    const bool antisymmetric =
        settings.word("gradient") == "symmetric" && viscosity_of(settings) != Viscosity::schwaiger;
    return {.momentum = antisymmetric, .angular_momentum = antisymmetric && central, .energy = false};
}

TimeOrder euler_order(const Settings& settings) {
    const bool implicit = settings.word("viscous_step") == "implicit";
    return {
        1,
        implicit ? "backward Euler: viscosity of the new velocity, pressure constant over the step"
                 : "forward Euler: viscosity of the old velocity, pressure constant over the step (Xu 2009 "
                   "§2.2)",
        "the projection is approximate, its Laplacian is not div grad: a step takes off the share "
        "(div grad)/Laplacian of a mode's divergence, which is near 0 for the shortest waves; theirs adds "
        "up over the steps, and with it a pressure that is the larger the finer the step"};
}

template <int Dim>
void set_zero_on_surface(Simulation<Dim>& s, PressurePoisson<Dim>& poisson, int i) {
    const FreeSurface& surface = *s.free_surface;
    const Row<Dim> row = s.neighbours.row(i);
    const UniformVolume volume{s.particle_mass / s.density};
    const auto L = determined_renormalisation<Dim>(row, volume);
    if (surface.depth[i] == 0 || !L) {
        poisson.fix_at_zero(i);
        return;
    }
    Vector<Dim> n;
    for (int d = 0; d < Dim; ++d) {
        n[d] = surface.normal[d][i];
    }
    const Vector<Dim> L_n = *L * n;
    // Of the size of the equations of Poisson's problem.
    const double scale = poisson.diagonal(i);
    const double V = s.particle_mass / s.density;
    double* w = poisson.weights(i);
    std::fill(w, w + row.padded, 0.0);
    for (int k = 0; k < row.count; ++k) {
        double along = 0;
        for (int d = 0; d < Dim; ++d) {
            along += L_n[d] * row.separation[d][k];
        }
        w[k] = -scale * surface.depth[i] * V * row.slope[k] * along;
    }
    poisson.set_condition(i, scale);
}

namespace {

template <int Dim>
void set_surface_pressure(Simulation<Dim>& s, PressurePoisson<Dim>& poisson) {
    for (int i = 0; i < poisson.size(); ++i) {
        // One that has left all neighbours since the surface was found is a surface of its own.
        const bool alone = poisson.diagonal(i) == 0;
        if (s.free_surface->at_surface[i] == 0 && !alone) {
            continue;
        }
        if (s.free_surface->positions && !alone) {
            set_zero_on_surface(s, poisson, i);
        } else {
            poisson.fix_at_zero(i);
        }
    }
}

} // namespace

template <int Dim>
void solve_poisson(Simulation<Dim>& s, PressurePoisson<Dim>& poisson, Field& pressure) {
    if (s.free_surface) {
        set_surface_pressure(s, poisson);
    }
    if (!s.images.empty()) {
        poisson.set_image_differences(s.wall_pressure_differences());
    }
    book(s, poisson.solve(pressure[0]), "pressure");
}

template <int Dim>
void subtract_pressure_gradient(Simulation<Dim>& s, const Projection<Dim>& p, Field& pressure, double scale,
                                Field& target) {
    s.fill_walls_pressure(pressure);
    fill_density_images(s, p);
    const auto changed = arrays<Dim>(target);
    const double* rho = p.density != nullptr ? (*p.density)[0] : nullptr;
    with_volume(s, p, [&](const auto& volume) {
        for_each_row(s.neighbours, [&](int i, const Row<Dim>& row) {
            const Vector<Dim> gradient = pressure_gradient<Dim>(p, i, row, pressure[0], volume);
            const double factor = scale / (rho != nullptr ? rho[i] : s.density);
            for (int d = 0; d < Dim; ++d) {
                changed[d][i] -= factor * gradient[d];
            }
        });
    });
    s.count_sweeps(1 + renormalisation_sweeps(p, p.gradient == Gradient::normalised));
}

#define SPHVV_INSTANTIATE(Dim)                                                                               \
    template SharedProjection<Dim> make_projection(Simulation<Dim>&, Density);                               \
    template void choose_time_step(Simulation<Dim>&);                                                        \
    template void drift(Simulation<Dim>&);                                                                   \
    template void form_forced_velocity(Simulation<Dim>&, Projection<Dim>&, double, double);                  \
    template std::string forces_name(const Simulation<Dim>&);                                                \
    template void form_renormalisation(Simulation<Dim>&, Projection<Dim>&);                                  \
    template void add_forces_stages(Simulation<Dim>&, const SharedProjection<Dim>&);                         \
    template void sum_density(Simulation<Dim>&, Field&);                                                     \
    template double target_density(const Simulation<Dim>&, const Field&);                                    \
    template void write_divergence_equations(Simulation<Dim>&, Projection<Dim>&);                            \
    template void write_density_equations(Simulation<Dim>&, Projection<Dim>&, double);                       \
    template void set_zero_on_surface(Simulation<Dim>&, PressurePoisson<Dim>&, int);                         \
    template void solve_poisson(Simulation<Dim>&, PressurePoisson<Dim>&, Field&);                            \
    template void subtract_pressure_gradient(Simulation<Dim>&, const Projection<Dim>&, Field&, double,       \
                                             Field&);
SPHVV_INSTANTIATE(2)
SPHVV_INSTANTIATE(3)
#undef SPHVV_INSTANTIATE

} // namespace sphvv::solver::projection
