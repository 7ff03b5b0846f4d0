#pragma once

#include "sphvv/solver/operators/divergence_difference.hpp"
#include "sphvv/solver/operators/gradient_difference.hpp"
#include "sphvv/solver/operators/momentum_weakly_compressible.hpp"
#include "sphvv/solver/operators/renormalisation.hpp"
#include "sphvv/solver/simulation.hpp"
#include "sphvv/solver/weakly_compressible/tait.hpp"

#include <Eigen/Eigenvalues>

#include <cmath>
#include <map>
#include <string_view>

/// du/dt and drho/dt of a weakly compressible fluid at the present state, in the forms that the settings
/// `continuity`, `pressure_force` and `viscosity` name.
namespace sphvv::solver::weakly_compressible {

/// Volumes V_j = m/rho_j (m^dim) where 1/rho_j is at hand.
struct MassTimesSpecificVolume {
    double m;
    const double* specific_volume;
    Lanes operator()(const int* j) const { return m * gather(specific_volume, j); }
};

template <int Dim>
struct Rates;

/// What the choice of a pressure and a viscous force comes down to.
template <int Dim>
struct Forces {
    /// acceleration(velocity, pressure, …) on the current neighbour list.
    void (*accelerate)(Simulation<Dim>&, Rates<Dim>&);
    /// Torque of all pairs (N m), |1/2 sum_ij r_ij x f_ij|.
    double (*torque)(const Simulation<Dim>&, Rates<Dim>&);
};

enum class Continuity { sigma_2, sigma_1, renormalised };

/// The state beside position and velocity, its rates, and what forms them. A field that no chosen form reads
/// does not exist.
template <int Dim>
struct Rates {
    Field& density;                       ///< kg/m3
    Field& pressure;                      ///< Pa
    Field* pressure_over_squared_density; ///< of pressure_force = sigma_2
    Field& specific_volume;               ///< 1/rho at the last accelerate(), m3/kg
    Field& acceleration;                  ///< m/s2
    Field& density_rate;                  ///< kg/(m3 s)
    Field* renormalisation;               ///< L_i at the last accelerate(), upper triangle
    Field* lowest_eigenvalue;             ///< of L_i^-1; of pressure_force = hybrid_taylor
    Tait tait;
    double eta_squared; ///< of the viscous force, m2
    Continuity form;
    Forces<Dim> forces;
    int force_sweeps;            ///< visits of every pair in forces.accelerate
    const Field* eddy_viscosity; ///< nu_T, m2/s; of a scene with turbulence
};

template <int Dim>
MomentumFields<Dim> momentum_fields(const Simulation<Dim>& s, const Rates<Dim>& f) {
    MomentumFields<Dim> fields{constant_arrays<Dim>(s.particles.velocity), nullptr, f.specific_volume[0],
                               f.pressure[0]};
    if (f.pressure_over_squared_density != nullptr) {
        fields.pressure_over_squared_density = (*f.pressure_over_squared_density)[0];
    }
    if (f.renormalisation != nullptr) {
        fields.renormalisation = constant_arrays<symmetric_components<Dim>>(*f.renormalisation);
    }
    if (f.lowest_eigenvalue != nullptr) {
        fields.lowest_eigenvalue = (*f.lowest_eigenvalue)[0];
    }
    if (f.eddy_viscosity != nullptr) {
        fields.eddy_viscosity = (*f.eddy_viscosity)[0];
    }
    return fields;
}

template <int Dim, class PressureForce, class ViscousForce>
void sweep_acceleration(Simulation<Dim>& s, Rates<Dim>& f) {
    const MomentumFields<Dim> fields = momentum_fields(s, f);
    const double mu = s.density * s.kinematic_viscosity;
    const auto a = arrays<Dim>(f.acceleration);
    for_each_row(s.neighbours, [&](int i, const Row<Dim>& row) {
        const Vector<Dim> total = momentum_weakly_compressible<Dim, PressureForce, ViscousForce>(
            row, i, fields, s.particle_mass, mu, f.eta_squared);
        for (int d = 0; d < Dim; ++d) {
            a[d][i] = total[d] + s.body_force[d];
        }
    });
}

template <int Dim, class PressureForce, class ViscousForce>
double sweep_torque(const Simulation<Dim>& s, Rates<Dim>& f) {
    const MomentumFields<Dim> fields = momentum_fields(s, f);
    const double mu = s.density * s.kinematic_viscosity;
    std::array<std::vector<double>, torque_components<Dim>> torques;
    torques.fill(std::vector<double>(s.particles.size()));
    for_each_row(s.neighbours, [&](int i, const Row<Dim>& row) {
        const auto torque = torque_weakly_compressible<Dim, PressureForce, ViscousForce>(
            row, i, fields, s.particle_mass, mu, f.eta_squared);
        for (int c = 0; c < torque_components<Dim>; ++c) {
            torques[c][i] = torque[c];
        }
    });
    double squared = 0;
    for (const std::vector<double>& component : torques) {
        const double total =
            deterministic_sum(static_cast<int>(component.size()), [&](int i) { return component[i]; });
        squared += total * total;
    }
    return s.particle_mass / 2 * std::sqrt(squared);
}

template <int Dim, class PressureForce, class ViscousForce>
constexpr Forces<Dim> forces{sweep_acceleration<Dim, PressureForce, ViscousForce>,
                             sweep_torque<Dim, PressureForce, ViscousForce>};

template <int Dim, class ViscousForce>
Forces<Dim> forces_with(std::string_view pressure_force) {
    using namespace pressure_forces;
    static const std::map<std::string_view, Forces<Dim>> of{
        {"sigma_2", forces<Dim, Sigma2, ViscousForce>},
        {"sigma_1", forces<Dim, Sigma1, ViscousForce>},
        {"plain", forces<Dim, Plain, ViscousForce>},
        {"difference", forces<Dim, Difference, ViscousForce>},
        {"renormalised_coherent", forces<Dim, RenormalisedCoherent, ViscousForce>},
        {"renormalised", forces<Dim, Renormalised, ViscousForce>},
        {"taylor", forces<Dim, Taylor, ViscousForce>},
        {"hybrid_taylor", forces<Dim, HybridTaylor, ViscousForce>}};
    return of.at(pressure_force);
}

template <int Dim, class Mean>
Forces<Dim> forces_with_eddies(std::string_view pressure_force, std::string_view viscosity) {
    using namespace viscous_forces;
    return viscosity == "morris" ? forces_with<Dim, MorrisEddy<Mean>>(pressure_force)
                                 : forces_with<Dim, MonaghanClearyEddy<Mean>>(pressure_force);
}

template <int Dim>
Forces<Dim> forces_of(const Simulation<Dim>& s) {
    using namespace viscous_forces;
    const std::string& pressure_force = s.settings.word("pressure_force");
    const std::string& viscosity = s.settings.word("viscosity");
    if (s.turbulence) {
        return s.settings.word("eddy_mean") == "logarithmic"
                   ? forces_with_eddies<Dim, LogarithmicMean>(pressure_force, viscosity)
                   : forces_with_eddies<Dim, ArithmeticMean>(pressure_force, viscosity);
    }
    if (s.kinematic_viscosity == 0) {
        return forces_with<Dim, None>(pressure_force);
    }
    return viscosity == "morris" ? forces_with<Dim, Morris>(pressure_force)
                                 : forces_with<Dim, MonaghanCleary>(pressure_force);
}

/// The rates that the settings of a simulation ask for, with their fields.
template <int Dim>
Rates<Dim> rates(Simulation<Dim>& s, const Tait& tait) {
    Particles<Dim>& particles = s.particles;
    const std::string& pressure_force = s.settings.word("pressure_force");
    const std::string& continuity = s.settings.word("continuity");
    const double eta = s.settings.number("eta_over_h") * s.smoothing_length;
    const bool renormalised = continuity == "renormalised" || pressure_force.starts_with("renormalised") ||
                              pressure_force.ends_with("taylor");
    const bool hybrid = pressure_force == "hybrid_taylor";
    const bool predicts = s.settings.word("integrator") == "predictor_corrector";
    const char* const momentum = predicts ? "predictor" : "momentum"; // the stages that form the rates
    const char* const continuity_stage = predicts ? "predictor" : "continuity";
    const auto scratch = [&](const char* name, int components, const char* asked_by) -> Field& {
        return particles.field(name, components, Lifetime::scratch, asked_by);
    };
    return {particles.field("density", 1, Lifetime::state, continuity_stage),
            particles.field("pressure", 1, Lifetime::state, "equation_of_state"),
            pressure_force == "sigma_2" ? &scratch("pressure_over_squared_density", 1, momentum) : nullptr,
            scratch("specific_volume", 1, momentum),
            scratch("acceleration", Dim, momentum),
            scratch("density_rate", 1, continuity_stage),
            renormalised ? &scratch("renormalisation", symmetric_components<Dim>, momentum) : nullptr,
            hybrid ? &scratch("lowest_eigenvalue", 1, momentum) : nullptr,
            tait,
            eta * eta,
            continuity == "sigma_2"   ? Continuity::sigma_2
            : continuity == "sigma_1" ? Continuity::sigma_1
                                      : Continuity::renormalised,
            forces_of<Dim>(s),
            hybrid ? 2 : 1,
            s.turbulence ? &scratch("eddy_viscosity", 1, momentum) : nullptr};
}

/// Density and pressure of images: those of the particle, and where the walls hold the fluid up against the
/// body force f, those of a fluid at rest that goes on from the particle to the image.
template <int Dim>
void fill_walls_state(const Simulation<Dim>& s, Rates<Dim>& f) {
    s.fill_walls(f.density, Parity::even);
    s.fill_walls(f.pressure, Parity::even);
    if (s.images.empty() || !s.has_wall_pressure_gradient()) {
        return;
    }
    const std::vector<double> difference = s.wall_pressure_differences();
    for (std::size_t k = 0; k < difference.size(); ++k) {
        if (difference[k] != 0) { // not along the wall
            const std::size_t image = s.particles.size() + k;
            f.density[0][image] = f.tait.density_below(f.density[0][image], difference[k] / s.density);
            f.pressure[0][image] = f.tait.pressure(f.density[0][image]);
        }
    }
}

/// 1/rho and, where it is read, p/rho^2.
template <int Dim>
void update_volumes(const Simulation<Dim>& s, Rates<Dim>& f) {
    fill_walls_state(s, f);
    const int count = static_cast<int>(s.particles.with_images());
    const double* rho = f.density[0];
    double* volume = f.specific_volume[0];
    if (f.pressure_over_squared_density == nullptr) {
#pragma omp parallel for simd schedule(static)
        for (int i = 0; i < count; ++i) {
            volume[i] = 1 / rho[i];
        }
        return;
    }
    const double* p = f.pressure[0];
    double* P = (*f.pressure_over_squared_density)[0];
#pragma omp parallel for simd schedule(static)
    for (int i = 0; i < count; ++i) {
        volume[i] = 1 / rho[i];
        P[i] = p[i] * volume[i] * volume[i];
    }
}

/// L_i with V_j = m/rho_j, the identity for a stray particle, and the lowest eigenvalue of L_i^-1, zero for a
/// stray particle: it is all surface.
template <int Dim>
void update_renormalisation(const Simulation<Dim>& s, Rates<Dim>& f) {
    const MassTimesSpecificVolume volume{s.particle_mass, f.specific_volume[0]};
    const auto stored = arrays<symmetric_components<Dim>>(*f.renormalisation);
    double* eigenvalue = f.lowest_eigenvalue == nullptr ? nullptr : (*f.lowest_eigenvalue)[0];
    for_each_row(s.neighbours, [&](int i, const Row<Dim>& row) {
        const auto L = determined_renormalisation<Dim>(row, volume);
        write_symmetric<Dim>(stored, i, L.value_or(Matrix<Dim>::Identity()));
        if (eigenvalue != nullptr) {
            const Eigen::SelfAdjointEigenSolver<Matrix<Dim>> of(L.value_or(Matrix<Dim>::Identity()),
                                                                Eigen::EigenvaluesOnly);
            eigenvalue[i] = L ? 1 / of.eigenvalues().maxCoeff() : 0;
        }
    });
    s.fill_walls(*f.renormalisation, Parity::tensor);
    if (f.lowest_eigenvalue != nullptr) {
        s.fill_walls(*f.lowest_eigenvalue, Parity::even);
    }
}

/// acceleration(density, pressure, velocity) on the current neighbour list, and that by walls that repel.
template <int Dim>
void accelerate(Simulation<Dim>& s, Rates<Dim>& f) {
    s.fill_walls(s.particles.velocity, Parity::velocity);
    update_volumes(s, f);
    if (f.renormalisation != nullptr) {
        update_renormalisation(s, f);
        s.count_sweeps(1);
    }
    f.forces.accelerate(s, f);
    s.count_sweeps(f.force_sweeps);
    if (s.repulsion) {
        s.repulsion->add_to(f.acceleration, s.walls, s.particles, s.positions_time);
    }
}

/// density_rate(density, velocity) on the neighbour list and with the density of the last accelerate():
///   sigma_2       sum_j m (u_i - u_j).gradW_ij              Issa S2; Lee 2008 §1.3; Oger 2007, sigma = 2
///   sigma_1       rho_i sum_j V_j (u_i - u_j).gradW_ij      Oger 2007, sigma = 1
///   renormalised  rho_i sum_j V_j (u_i - u_j).L_i gradW_ij  Oger 2007
template <int Dim>
void continuity(Simulation<Dim>& s, Rates<Dim>& f) {
    s.fill_walls(s.particles.velocity, Parity::velocity);
    const auto u = constant_arrays<Dim>(s.particles.velocity);
    const UniformVolume mass{s.particle_mass};
    const MassTimesSpecificVolume volume{s.particle_mass, f.specific_volume[0]};
    const double* rho = f.density[0];
    double* rate = f.density_rate[0];
    switch (f.form) {
    case Continuity::sigma_2:
        for_each_row(s.neighbours, [&](int i, const Row<Dim>& row) {
            rate[i] = -divergence_difference<Dim>(row, i, u, mass);
        });
        break;
    case Continuity::sigma_1:
        for_each_row(s.neighbours, [&](int i, const Row<Dim>& row) {
            rate[i] = -rho[i] * divergence_difference<Dim>(row, i, u, volume);
        });
        break;
    case Continuity::renormalised: {
        const auto L = constant_arrays<symmetric_components<Dim>>(*f.renormalisation);
        for_each_row(s.neighbours, [&](int i, const Row<Dim>& row) {
            rate[i] =
                -rho[i] *
                (vector_gradient_difference<Dim>(row, i, u, volume) * read_symmetric<Dim>(L, i)).trace();
        });
        break;
    }
    }
    s.count_sweeps(1);
}

template <int Dim>
void update_pressure(const Simulation<Dim>& s, Rates<Dim>& f) {
    const int count = static_cast<int>(s.particles.size());
    const double* rho = f.density[0];
    double* p = f.pressure[0];
#pragma omp parallel for schedule(static)
    for (int i = 0; i < count; ++i) {
        p[i] = f.tait.pressure(rho[i]);
    }
}

/// Elastic energy of the fluid, sum_i m e(rho_i), in J (per metre of depth in 2-D).
template <int Dim>
double elastic_energy(const Simulation<Dim>& s, const Rates<Dim>& f) {
    const double* rho = f.density[0];
    return s.particle_mass * deterministic_sum(static_cast<int>(s.particles.size()),
                                               [&](int i) { return f.tait.elastic_energy(rho[i]); });
}

/// Torque of all pairs (N m) by the present density, pressure and velocity, on the pairs of the last
/// neighbour list. Forms the scratch fields anew.
template <int Dim>
double internal_torque(const Simulation<Dim>& s, Rates<Dim>& f) {
    update_volumes(s, f);
    if (f.renormalisation != nullptr) {
        update_renormalisation(s, f);
    }
    return f.forces.torque(s, f);
}

} // namespace sphvv::solver::weakly_compressible
