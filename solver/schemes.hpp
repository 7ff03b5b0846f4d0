#pragma once

#include "sphvv/solver/settings.hpp"
#include "sphvv/solver/simulation.hpp"

#include <span>
#include <string_view>
#include <vector>

namespace sphvv::solver {

/// Order of a time marching as its step goes to zero on particles and h that stay, with its derivation or
/// citation.
struct TimeOrder {
    double order;
    std::string source;
    std::string waiver{}; ///< reason for which the scheme is known not to show it
};

/// What the sums over pairs of a scheme keep to round-off on any arrangement of particles.
struct Conserves {
    bool momentum;
    bool angular_momentum; ///< the forces between particles have no torque
    bool energy;           ///< without viscosity, in the limit of a small time step
};

/// Declaration of a scheme: the algorithm as a list of stages. One file in solver/schemes/ defines one.
struct Scheme {
    std::string_view name;
    std::string_view summary;
    std::string_view formula;
    std::string_view source;
    bool compressible;     ///< needs a density that matches its pressure at the start
    std::vector<Key> keys; ///< "kernel", "h_over_dx" and "time_step" among them
    TimeOrder (*time_order)(const Settings&);
    Conserves (*conserves)(const Settings&);
    /// Adds the stages to a simulation whose settings, constants, particles, velocity and, where the scheme
    /// has the field as state, pressure are set.
    void (*assemble_2d)(Simulation<2>&);
    void (*assemble_3d)(Simulation<3>&);

    /// Throws UserError if the scene has physics for which the scheme has no stage.
    void assemble(Simulation<2>& simulation) const;
    void assemble(Simulation<3>& simulation) const;
};

/// The keys that every scheme has.
std::vector<Key> common_keys(std::string_view kernel, double h_over_dx);

/// `keys` and `more`, one list.
std::vector<Key> joined(std::vector<Key> keys, const std::vector<Key>& more);

namespace schemes {
/// Every scheme in solver/schemes/, in the order of the file names.
std::span<const Scheme* const> all();
/// The scheme of that name. Throws UserError naming the accepted ones.
const Scheme& find(std::string_view name);
} // namespace schemes

} // namespace sphvv::solver
