#pragma once

#include "sphvv/solver/simulation.hpp"

#include <optional>
#include <string>

namespace sphvv::verification {

/// A square lattice and how it is stepped: a periodic box of a unit square, density 1, speed scale U = 1 m/s.
struct LatticeScene {
    std::string scheme;      ///< a variant, as variant_of() reads it
    double sound_speed = 10; ///< m/s, of a compressible scheme
    double viscosity = 0;    ///< m2/s
    std::optional<double>
        pressure{};        ///< Pa, of the undisturbed state; none: the scheme's background pressure
    double speed = 0;      ///< m/s, of the whole lattice, along (0.8, 0.6): no direction of its own
    double body_force = 0; ///< m/s2, in which it falls
    int n = 16;            ///< particles along a side

    double dx() const { return 1. / n; }
    bool moves() const { return speed > 0 || body_force > 0; }
};

/// The settings of its scheme, steps of one unit. Throws UserError for a scheme or a key that there is not.
solver::Settings settings_of(const LatticeScene& scene);

/// h (m).
double smoothing_length(const LatticeScene& scene);

/// The undisturbed lattice, assembled, in units of dx, dt and rho dx^2: then every field that a step hands to
/// the next is of order one, and one size of disturbance fits all. Steps are of length dt (s).
solver::Simulation<2> lattice_simulation(const LatticeScene& scene, double dt);

} // namespace sphvv::verification
