// Turbulent free-surface channel over a smooth bed by a mixing length, at every height from wall to surface.
//
// The momentum balance (ν + ν_T) du/dz = u*² (1 − z/H) with ν_T = L² |du/dz| is a quadratic equation for the
// gradient,
//   du/dz = 2T/(ν + √(ν² + 4L²T)),  T = u*² (1 − z/H),
// so that the ordinary differential equation for u is a quadrature. L = κz √(1 − z/H) [1 − e^{−z⁺/A⁺}]:
// Issa's length (as for the logarithmic law) with van Driest's damping. For A⁺ = 26 and κ = 0.41 the law far
// from the wall has B = 5.2771 (quantity log_law_constant; tests/turbulent_channel.cpp). Within a few wall
// units of the surface, where ν_T falls below ν, the gradient leaves u*/κz for zero.
#include "sphvv/analytic/solutions.hpp"

#include <gsl/gsl_integration.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace sphvv::analytic::solutions {

const Solution& mixing_length_channel();

namespace {

struct Constants {
    double u;       ///< m/s, friction velocity
    double reach;   ///< H+
    double H;       ///< m
    double L;       ///< m, the period
    double rho;     ///< kg/m3
    double g;       ///< m/s2
    double kappa;   ///< von Karman's constant
    double damping; ///< A+

    double nu() const { return u * H / reach; }
};

Constants constants(const Values& given) {
    const Values values = resolve(mixing_length_channel(), given);
    return {
        values.at("friction_velocity"), values.at("friction_re"), values.at("depth"), values.at("length"),
        values.at("density"),           values.at("gravity"),     values.at("kappa"), values.at("damping")};
}

/// L²/(1 − z/H) in wall units at the height z in wall units.
double squared_length(const Constants& c, double z) {
    const double damped = -c.kappa * z * std::expm1(-z / c.damping);
    return damped * damped;
}

/// du/dz in wall units; of the layer without a surface for share = 1, else share = 1 − z/H.
double gradient(const Constants& c, double z, double share) {
    return 2 * share / (1 + std::sqrt(1 + 4 * squared_length(c, z) * share * share));
}

/// Integral by a Gauss–Legendre rule of 16 points.
template <class Function>
double integral(double low, double high, const Function& function) {
    static const std::unique_ptr<gsl_integration_glfixed_table, decltype(&gsl_integration_glfixed_table_free)>
        rule{gsl_integration_glfixed_table_alloc(16), gsl_integration_glfixed_table_free};
    double sum = 0;
    for (std::size_t i = 0; i < 16; ++i) {
        double x = 0;
        double weight = 0;
        gsl_integration_glfixed_point(low, high, i, &x, &weight, rule.get());
        sum += weight * function(x);
    }
    return sum;
}

/// Velocity in wall units at panel ends that lie evenly in ln(1 + distance) from wall and surface, a quarter
/// apart, so that 16 points per panel leave an error of some 1e-15 of the velocity
/// (tests/turbulent_channel.cpp: 1e-12 against a Runge–Kutta method of order 8).
class Profile {
public:
    explicit Profile(const Constants& constants) : c(constants) {
        const int steps = static_cast<int>(std::ceil(4 * std::log1p(c.reach / 2)));
        for (int i = 0; i <= steps; ++i) {
            ends.push_back(std::expm1(std::log1p(c.reach / 2) * i / steps));
        }
        for (auto i = static_cast<std::ptrdiff_t>(ends.size()) - 2; i >= 0; --i) {
            ends.push_back(c.reach - ends[i]);
        }
        for (std::size_t i = 0; i < ends.size(); ++i) {
            at_ends.push_back(i == 0 ? 0 : at_ends[i - 1] + rise(ends[i - 1], ends[i]));
        }
    }
    double operator()(double z) const {
        const auto next = std::upper_bound(ends.begin() + 1, ends.end() - 1, z);
        const auto panel = next - ends.begin() - 1;
        return at_ends[panel] + rise(ends[panel], z);
    }
    /// Mean of function(u) over the depth.
    template <class Function>
    double mean(const Function& function) const {
        double sum = 0;
        for (std::size_t i = 1; i < ends.size(); ++i) {
            sum += integral(ends[i - 1], ends[i], [&](double z) { return function((*this)(z)); });
        }
        return sum / c.reach;
    }

private:
    double rise(double low, double high) const {
        return integral(low, high, [&](double z) { return gradient(c, z, 1 - z / c.reach); });
    }
    Constants c;
    std::vector<double> ends;
    std::vector<double> at_ends;
};

/// A height of the domain in wall units.
double wall_units(const Constants& c, double z) {
    return z / c.H * c.reach;
}

Domain domain(const Values& given) {
    const Constants c = constants(given);
    return {{0, 0, 0}, {c.L, c.H, 0}, {true, false, false}};
}

Medium medium(const Values& given) {
    const Constants c = constants(given);
    return {c.rho, c.nu(), c.u * Profile(c)(c.reach), {c.u * c.u / c.H, -c.g, 0}};
}

Evaluator bind(const Values& given) {
    const Constants c = constants(given);
    return [c, profile = Profile(c)](const Vector& x, double) {
        return State{{c.u * profile(wall_units(c, x[1])), 0, 0}, c.rho * c.g * (c.H - x[1])};
    };
}

double kinetic_energy(const Values& given, double) {
    const Constants c = constants(given);
    return c.u * c.u / 2 * Profile(c).mean([](double u) { return u * u; });
}

std::vector<Boundary> bed_and_surface(const Values& given) {
    const Domain box = domain(given);
    return {flat_boundary("bed", BoundaryKind::no_slip, box, {1, false}),
            flat_boundary("surface", BoundaryKind::free_surface, box, {1, true})};
}

Scalar velocity_gradient(const Values& given) {
    return [c = constants(given)](const Vector& x, double) {
        const double z = wall_units(c, x[1]);
        return c.u * c.u / c.nu() * gradient(c, z, 1 - z / c.reach);
    };
}

Scalar eddy_viscosity(const Values& given) {
    return [c = constants(given)](const Vector& x, double) {
        const double z = wall_units(c, x[1]);
        const double share = 1 - z / c.reach;
        return c.nu() * squared_length(c, z) * share * gradient(c, z, share);
    };
}

Scalar mixing_length(const Values& given) {
    return [c = constants(given)](const Vector& x, double) {
        const double z = wall_units(c, x[1]);
        return c.nu() / c.u * std::sqrt(squared_length(c, z) * std::max(0., 1 - z / c.reach));
    };
}

Scalar shear_stress(const Values& given) {
    return [c = constants(given)](const Vector& x, double) { return c.rho * c.u * c.u * (1 - x[1] / c.H); };
}

Scalar wall_shear_stress(const Values& given) {
    return [c = constants(given)](const Vector&, double) { return c.rho * c.u * c.u; };
}

Scalar friction_velocity(const Values& given) {
    return [c = constants(given)](const Vector&, double) { return c.u; };
}

Scalar driving_force(const Values& given) {
    return [c = constants(given)](const Vector&, double) { return c.u * c.u / c.H; };
}

Scalar bulk_velocity(const Values& given) {
    const Constants c = constants(given);
    const double U = c.u * Profile(c).mean([](double u) { return u; });
    return [U](const Vector&, double) { return U; };
}

/// lim (u+ − ln z+/κ) without a surface. Beyond z+ = e^25 the damping is gone and the integrand is
/// 1/κz − 1/2κ²z² + …, which leaves less than 1e-10.
Scalar log_law_constant(const Values& given) {
    const Constants c = constants(given);
    double velocity = 0;
    constexpr int panels = 100;
    constexpr double width = 0.25;
    for (int i = 0; i < panels; ++i) {
        velocity += integral(std::expm1(width * i), std::expm1(width * (i + 1)),
                             [&](double z) { return gradient(c, z, 1); });
    }
    const double B = velocity - std::log(std::expm1(panels * width)) / c.kappa;
    return [B](const Vector&, double) { return B; };
}

} // namespace

const Solution& mixing_length_channel() {
    static const Solution solution{
        .name = "mixing_length_channel",
        .summary =
            "Turbulent free-surface channel over a smooth bed by a damped mixing length, valid at every z⁺",
        .formula =
            "(ν + L²|du/dz|) du/dz = u*²(1 − z/H), L = κz √(1 − z/H) [1 − e^{−z⁺/A⁺}], u(0) = 0, F = u*²/H, "
            "ν = u*H/H⁺, p = ρg(H − z); z from the bed. Error 1e-12 of u",
        .source =
            "mixing length: R. Issa, PhD thesis, UMIST, 2005, §5.1; damping, A⁺ = 26: E. R. van Driest, J. "
            "Aeronaut. Sci. 23 (1956) 1007–1011",
        .dimension = 2,
        .parameters =
            {
                {"friction_velocity", "m/s", "u*", 0.05, 1e-6, 1e6},
                {"friction_re", "1", "H⁺ = u*H/ν", 20000, 100, 1e8},
                {"depth", "m", "H", 0.4, 1e-6, 1e6},
                {"length", "m", "period along the channel", 0.4, 1e-6, 1e6},
                {"density", "kg/m3", "ρ", 1000, 1e-6, 1e6},
                {"gravity", "m/s2", "g, downwards", 9.81, 0, 1e3},
                {"kappa", "1", "κ, von Kármán's constant", 0.41, 0.3, 0.5},
                {"damping", "1", "A⁺, van Driest's constant", 26, 5, 100},
            },
        .domain = domain,
        .medium = medium,
        .bind = bind,
        .kinetic_energy = kinetic_energy,
        .equations = Equations::reynolds_averaged,
        .boundaries = bed_and_surface,
        .quantities =
            {
                {"eddy_viscosity", "m2/s", "ν_T = L² du/dz at x", eddy_viscosity},
                {"velocity_gradient", "1/s", "du/dz at x", velocity_gradient},
                {"mixing_length", "m", "L at x", mixing_length},
                {"shear_stress", "Pa", "τ = ρu*²(1 − z/H) at x, viscous and turbulent", shear_stress},
                {"wall_shear_stress", "Pa", "ρu*²", wall_shear_stress},
                {"friction_velocity", "m/s", "u* = √(FH)", friction_velocity},
                {"driving_force", "m/s2", "F = u*²/H", driving_force},
                {"bulk_velocity", "m/s", "mean of u over the depth", bulk_velocity},
                {"log_law_constant", "1", "B that κ and A⁺ imply far from wall and surface",
                 log_law_constant},
            },
    };
    return solution;
}

} // namespace sphvv::analytic::solutions
