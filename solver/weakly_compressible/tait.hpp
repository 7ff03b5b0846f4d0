#pragma once

#include <cmath>

namespace sphvv::solver::weakly_compressible {

/// Tait's equation of state, p = (rho0 c0^2/gamma) [(rho/rho0)^gamma - 1] + p_b (Pa).
struct Tait {
    double density;     ///< rho0, kg/m3
    double sound_speed; ///< c0 = sqrt(dp/drho) at rho0, m/s
    double gamma;
    double background; ///< p_b, Pa

    double stiffness() const { return density * sound_speed * sound_speed / gamma; }
    double pressure(double rho) const {
        return stiffness() * (std::pow(rho / density, gamma) - 1) + background;
    }
    double density_at(double p) const {
        return density * std::pow(1 + (p - background) / stiffness(), 1 / gamma);
    }

    /// Density of a fluid at rest where the potential of the body force is lower by `work` (m2/s2) than where
    /// it is rho: dp/rho = dw integrates to (rho/rho0)^(gamma-1) + (gamma - 1) w/c0^2, and for gamma = 1 to
    /// rho exp(w/c0^2).
    double density_below(double rho, double work) const {
        const double s = work / (sound_speed * sound_speed);
        return gamma == 1 ? rho * std::exp(s)
                          : density * std::pow(std::pow(rho / density, gamma - 1) + (gamma - 1) * s,
                                               1 / (gamma - 1));
    }

    /// Elastic energy e per mass (J/kg), zero at rho0. By the first law a parcel that keeps its entropy has
    /// de = -p d(1/rho) = (p/rho^2) drho. With x = rho/rho0, B the stiffness and p = B (x^gamma - 1) + p_b,
    ///   rho0 e = integral from 1 to x of (B s^(gamma-2) + (p_b - B) s^-2) ds
    ///          = B (x^(gamma-1) - 1)/(gamma - 1) + (p_b - B) (1 - 1/x),
    /// whose first term is B ln x for gamma = 1. It is written with q = ln x, so that the differences of
    /// numbers near one keep their digits: near rho0 the terms in B are two of first order in x - 1 whose sum
    /// is of second order.
    double elastic_energy(double rho) const {
        const double q = std::log(rho / density);
        const double power = gamma - 1;
        const double compression = power == 0 ? q : std::expm1(power * q) / power;
        return (stiffness() * compression - (background - stiffness()) * std::expm1(-q)) / density;
    }
};

} // namespace sphvv::solver::weakly_compressible
