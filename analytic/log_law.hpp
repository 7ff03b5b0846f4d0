#pragma once

#include "sphvv/analytic/solution.hpp"

#include <algorithm>
#include <cmath>

namespace sphvv::analytic {

/// Logarithmic law in a free-surface channel in wall units of its own: u = (u*/κ) ln(z/z0), with z0 = (ν/u*)
/// e^{−κB} over a smooth bed and z0 = ξ e^{−κD} over a fully rough one. With ν_T = κ u* z (1 − z/H) its
/// stress is τ/ρ = ν_T du/dz = u*² (1 − z/H), in equilibrium with the driving force F = u*²/H; the molecular
/// viscosity is left out of the balance (Issa 2005 §6.1–6.2, (6.24) without its misprint).
struct LogLaw {
    double friction_velocity; ///< m/s, u*
    double depth;             ///< m, H
    double kappa;
    double zero;    ///< m, z0, where u = 0
    double edge;    ///< m, the height at which the fluid begins
    double length;  ///< m, the period
    double density; ///< kg/m3
    double gravity; ///< m/s2

    double velocity(double z) const { return friction_velocity / kappa * std::log(z / zero); }
    double gradient(double z) const { return friction_velocity / (kappa * z); }
    double eddy_viscosity(double z) const { return kappa * friction_velocity * z * (1 - z / depth); }
    double shear_stress(double z) const {
        return density * friction_velocity * friction_velocity * (1 - z / depth);
    }
    double driving_force() const { return friction_velocity * friction_velocity / depth; }
    /// Mean of the law over all of 0 < z < H.
    double bulk_velocity() const { return friction_velocity / kappa * (std::log(depth / zero) - 1); }
    /// Mean of u²/2 over edge < z < H: ∫ ln²(z/z0) dz = z (l² − 2l + 2) with l = ln(z/z0).
    double kinetic_energy() const {
        const auto integral = [&](double z) {
            const double l = std::log(z / zero);
            return z * (l * l - 2 * l + 2);
        };
        const double scale = friction_velocity / kappa;
        return scale * scale / 2 * (integral(depth) - integral(edge)) / (depth - edge);
    }
};

/// What a channel with a logarithmic law declares, from the law at given values.
template <LogLaw (*law)(const Values&)>
struct LogLawChannel {
    static Domain domain(const Values& given) {
        const LogLaw l = law(given);
        return {{0, l.edge, 0}, {l.length, l.depth, 0}, {true, false, false}};
    }
    static Medium medium(const Values& given) {
        const LogLaw l = law(given);
        const double fastest = std::max(std::abs(l.velocity(l.edge)), std::abs(l.velocity(l.depth)));
        return {l.density, 0, fastest, {l.driving_force(), -l.gravity, 0}};
    }
    static Evaluator bind(const Values& given) {
        return [l = law(given)](const Vector& x, double) {
            return State{{l.velocity(x[1]), 0, 0}, l.density * l.gravity * (l.depth - x[1])};
        };
    }
    static double kinetic_energy(const Values& given, double) { return law(given).kinetic_energy(); }
    static std::vector<Boundary> boundaries(const Values& given) {
        const LogLaw l = law(given);
        const Domain box = domain(given);
        return {flat_boundary("edge", BoundaryKind::no_slip, box, {1, false}, {l.velocity(l.edge), 0, 0}),
                flat_boundary("surface", BoundaryKind::free_surface, box, {1, true})};
    }
    template <double (LogLaw::*of)(double) const>
    static Scalar field(const Values& given) {
        return [l = law(given)](const Vector& x, double) { return (l.*of)(x[1]); };
    }
    template <double (LogLaw::*of)() const>
    static Scalar number(const Values& given) {
        return [l = law(given)](const Vector&, double) { return (l.*of)(); };
    }
    static Scalar friction_velocity(const Values& given) {
        return [l = law(given)](const Vector&, double) { return l.friction_velocity; };
    }
    static Scalar wall_shear_stress(const Values& given) {
        return [l = law(given)](const Vector&, double) { return l.shear_stress(0); };
    }
    static Scalar edge_velocity(const Values& given) {
        return [l = law(given)](const Vector&, double) { return l.velocity(l.edge); };
    }
    static std::vector<Quantity> quantities() {
        return {
            {"eddy_viscosity", "m2/s", "ν_T = κu*z(1 − z/H) at x", field<&LogLaw::eddy_viscosity>},
            {"velocity_gradient", "1/s", "du/dz = u*/κz at x", field<&LogLaw::gradient>},
            {"shear_stress", "Pa", "τ = ρu*²(1 − z/H) at x", field<&LogLaw::shear_stress>},
            {"wall_shear_stress", "Pa", "ρu*²", wall_shear_stress},
            {"friction_velocity", "m/s", "u* = √(FH)", friction_velocity},
            {"driving_force", "m/s2", "F = u*²/H", number<&LogLaw::driving_force>},
            {"edge_velocity", "m/s", "u at z = δ", edge_velocity},
            {"bulk_velocity", "m/s", "(u*/κ)[ln(H/z0) − 1], the mean over 0 < z < H",
             number<&LogLaw::bulk_velocity>},
        };
    }
};

} // namespace sphvv::analytic
