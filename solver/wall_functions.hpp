#pragma once

#include "sphvv/solver/settings.hpp"

#include <span>
#include <string_view>
#include <vector>

namespace sphvv::solver {

template <int Dim>
struct Simulation;

/// u(z) = (u*/kappa) ln(z/z0) with z0 = rough + viscous/u*: the velocity along a wall (m/s, relative to it)
/// at the distance z (m) where the friction velocity is u* (m/s). Source: Issa 2005 §5.3.
struct LogLaw {
    double kappa;   ///< von Karman's constant
    double rough;   ///< m, the part of z0 that the roughness makes
    double viscous; ///< m2/s, z0 u* of a smooth wall

    double zero(double u_star) const { return rough + viscous / u_star; }
    /// u(z), not below 0, which the law itself is below z0.
    double velocity(double z, double u_star) const;
    /// du/dz = u*/(kappa z), 1/s.
    double gradient(double z, double u_star) const { return u_star / (kappa * z); }
    /// The u* of which the law has the velocity u >= 0 at z: to a relative step of 1e-14 of Newton's method;
    /// 0 for u = 0. Throws UserError where z lies below the roughness.
    double friction_velocity(double u, double z) const;
};

/// Declaration of a wall function: what stands for the layer between a wall and the fluid's edge, which is
/// not resolved. One file in solver/wall_functions/ defines one.
struct WallFunction {
    std::string_view name;
    std::string_view summary;
    std::string_view formula;
    std::string_view source;
    std::vector<Key> keys; ///< beside those of wall_functions::keys()
    LogLaw (*law)(const Settings&, double kinematic_viscosity);
};

/// The wall function of a scene: it holds at every wall without slip, in place of u = 0.
struct WallFriction {
    const WallFunction* function;
    Settings settings; ///< of wall_functions::keys(*function)

    /// Height over the wall at which the fluid begins, m. The wall particles stand for the fluid there,
    /// although they lie on the wall.
    double edge() const { return settings.number("edge"); }
    LogLaw law(double kinematic_viscosity) const { return function->law(settings, kinematic_viscosity); }
};

/// Adds the stage that gives wall particles, and with them all that lies behind the wall, the velocity of the
/// law at the edge, along the velocity at a point M over the wall (state field `edge_velocity`, m/s, relative
/// to the wall). Issa 2005 §5.3. Does nothing in a scene without a wall function. Throws UserError where the
/// wall method leaves nothing to carry the velocity.
template <int Dim>
void add_wall_function_stage(Simulation<Dim>& simulation);

/// Adds the stage that lets wall particles slide along the wall at the velocity of the edge (state field
/// `wall_displacement`, m), to come last in a step: Issa's are transported. Wall particles that stay where
/// they are, while the sums take them for moving, are obstacles: their pressure drags at the rows above. For
/// flat walls; does nothing with edge_motion = none.
template <int Dim>
void add_wall_transport_stage(Simulation<Dim>& simulation);

namespace wall_functions {
/// Every wall function in solver/wall_functions/, in the order of the file names.
std::span<const WallFunction* const> all();
/// The wall function of that name. Throws UserError naming the accepted ones.
const WallFunction& find(std::string_view name);
/// The keys of a scene with that wall function.
std::vector<Key> keys(const WallFunction& function);
} // namespace wall_functions

} // namespace sphvv::solver
