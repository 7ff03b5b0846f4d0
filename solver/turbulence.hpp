#pragma once

#include "sphvv/solver/particles.hpp"
#include "sphvv/solver/settings.hpp"

#include <functional>
#include <span>
#include <string_view>
#include <vector>

namespace sphvv::solver {

template <int Dim>
struct Simulation;

/// Writes nu_T (m2/s) at every particle (not at images) from the present state and the velocity gradient
/// du_a/dx_b (1/s), component a dim + b.
template <int Dim>
using EddyViscosity = std::function<void(Simulation<Dim>&, const Field& velocity_gradient, Field& nu_T)>;

/// Declaration of an eddy-viscosity model: R_ij = 2/3 k delta_ij - 2 nu_T s_ij, with 2/3 rho k part of the
/// pressure. One file in solver/turbulence/ defines one.
struct TurbulenceModel {
    std::string_view name;
    std::string_view summary;
    std::string_view formula;
    std::string_view source;
    bool reads_wall_distance; ///< the field `wall_distance`, m: from the wall on, not from the edge
    std::vector<Key> keys;    ///< beside those of turbulence::keys()
    /// What forms nu_T in a simulation whose constants are set. A model that transports quantities (k,
    /// epsilon) asks for its state fields here.
    EddyViscosity<2> (*assemble_2d)(Simulation<2>&, const Settings&);
    EddyViscosity<3> (*assemble_3d)(Simulation<3>&, const Settings&);

    EddyViscosity<2> assemble(Simulation<2>& s, const Settings& settings) const {
        return assemble_2d(s, settings);
    }
    EddyViscosity<3> assemble(Simulation<3>& s, const Settings& settings) const {
        return assemble_3d(s, settings);
    }
};

/// The turbulence of a scene that models it.
struct Turbulence {
    const TurbulenceModel* model;
    Settings settings; ///< of turbulence::keys(*model)
};

/// Adds the stages that form the fields `velocity_gradient` and `eddy_viscosity` (at images too) on the
/// current neighbour list, and before them, where they are read, `wall_distance`. Does nothing in a scene
/// without turbulence.
template <int Dim>
void add_turbulence_stages(Simulation<Dim>& simulation);

/// nu + the largest nu_T, m2/s: of the scene alone where there is no turbulence.
template <int Dim>
double largest_viscosity(const Simulation<Dim>& simulation);

namespace turbulence {
/// Every model in solver/turbulence/, in the order of the file names.
std::span<const TurbulenceModel* const> all();
/// The model of that name. Throws UserError naming the accepted ones.
const TurbulenceModel& find(std::string_view name);
/// The keys of a scene with that model.
std::vector<Key> keys(const TurbulenceModel& model);
} // namespace turbulence

} // namespace sphvv::solver
