#pragma once

// Ways to hold a declared exact solution against its equations and its own claims. They see the declaration
// and the values of the fields only, never how these are computed, and choose points, times and parameters by
// seeded draws.

#include "sphvv/analytic/solution.hpp"

#include <gsl/gsl_integration.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sphvv::analytic::checks {

using std::numbers::pi;

/// Relative size of the smallest fault that the residual must show in every term of the equations.
inline constexpr double smallest_fault = 1e-4;

// Eighth-order differences of a wave of phase s per step are wrong by s^8/630 (first) and s^8/3150 (second
// derivative) of the derivative; round-off adds about 2 e/s and 7 e/s^2, with e = 4e-16 for the field and its
// argument. Here s = 2 pi/256 for a wave as long as the domain: truncation 2e-16, and 1e-11 for its fourth
// harmonic; round-off 3e-14 and 5e-12.
inline constexpr double steps_per_extent = 256;
inline constexpr double momentum_tolerance = 1e-9;
inline constexpr double continuity_tolerance = 1e-10;
/// Fields and means that are compared without differences: round-off of some 1e4 terms and of the argument.
inline constexpr double value_tolerance = 1e-12;
inline constexpr double rate_tolerance = 1e-9;
inline constexpr double maximum_tolerance = 1e-3;

/// Uniform numbers that are the same with every standard library.
class Random {
public:
    explicit Random(std::uint64_t seed) : engine(seed) {}
    double uniform(double low, double high) {
        return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
    }

private:
    std::mt19937_64 engine;
};

inline double length(const Vector& v) {
    return std::hypot(v[0], v[1], v[2]);
}

inline double dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline Vector offset(Vector x, int direction, double distance) {
    x[direction] += distance;
    return x;
}

/// Every parameter drawn within a factor 10 of its declared value, inside its interval (evenly in the
/// logarithm; evenly within 1 of it where the value is not positive).
inline Values random_values(const Solution& solution, Random& random) {
    Values values;
    for (const Parameter& p : solution.parameters) {
        const double draw =
            p.value > 0 ? p.value * std::pow(10, random.uniform(-1, 1)) : p.value + random.uniform(-1, 1);
        values.emplace(p.name, std::clamp(draw, p.low, p.high));
    }
    return values;
}

inline double extent(const Domain& domain, int direction) {
    return domain.high[direction] - domain.low[direction];
}

/// Point of the domain, apart from walls by the reach of the difference formulae.
inline Vector random_point(const Solution& solution, const Domain& domain, Random& random) {
    Vector x{};
    for (int d = 0; d < solution.dimension; ++d) {
        const double margin = domain.periodic[d] ? 0 : 4 * extent(domain, d) / steps_per_extent;
        x[d] = random.uniform(domain.low[d] + margin, domain.high[d] - margin);
    }
    return x;
}

inline bool fully_periodic(const Solution& solution, const Domain& domain) {
    return std::all_of(domain.periodic.begin(), domain.periodic.begin() + solution.dimension,
                       [](bool periodic) { return periodic; });
}

/// Rates (1/s) at which a wave as long as the domain is carried and damped.
struct Rates {
    double convective;
    double viscous;
};

inline Rates rates(const Solution& solution, const Domain& domain, const Medium& medium) {
    double smallest = extent(domain, 0);
    for (int d = 1; d < solution.dimension; ++d) {
        smallest = std::min(smallest, extent(domain, d));
    }
    const double k = 2 * pi / smallest;
    return {k * medium.maximum_speed, k * k * medium.kinematic_viscosity};
}

inline double time_step(const Rates& rates) {
    return 1 / (64 * (rates.convective + rates.viscous));
}

/// The longest time drawn: one damping time, or two turns of the slowest vortex where damping is slower.
inline double longest_time(const Rates& rates) {
    return std::min(1 / rates.viscous, 4 * pi / rates.convective);
}

inline double random_time(const Rates& rates, Random& random) {
    return random.uniform(4 * time_step(rates), longest_time(rates));
}

/// First and second derivative by central differences of order 8 (Fornberg 1988, table 1); along(s) is a
/// number.
template <class Along>
std::pair<double, double> derivatives(const Along& along, double step) {
    constexpr std::array first{4. / 5, -1. / 5, 4. / 105, -1. / 280};
    constexpr std::array second{8. / 5, -1. / 5, 8. / 315, -1. / 560};
    double d1 = 0;
    double d2 = -205. / 72 * along(0.0);
    for (int m = 1; m <= 4; ++m) {
        const double ahead = along(m * step);
        const double behind = along(-m * step);
        d1 += first[m - 1] * (ahead - behind);
        d2 += second[m - 1] * (ahead + behind);
    }
    return {d1 / step, d2 / (step * step)};
}

/// Derivatives of all fields at one point and time.
struct Derivatives {
    Vector velocity_rate{};                    ///< du_i/dt
    std::array<Vector, 3> velocity_gradient{}; ///< [i][j] = du_i/dx_j
    Vector velocity_laplacian{};
    Vector pressure_gradient{};
};

inline Derivatives derivatives_at(const Solution& solution, const Domain& domain, const Evaluator& fields,
                                  const Vector& x, double t, double dt) {
    Derivatives result;
    for (int i = 0; i < solution.dimension; ++i) {
        result.velocity_rate[i] =
            derivatives([&](double s) { return fields(x, t + s).velocity[i]; }, dt).first;
        const double step = extent(domain, i) / steps_per_extent;
        result.pressure_gradient[i] =
            derivatives([&](double s) { return fields(offset(x, i, s), t).pressure; }, step).first;
        for (int component = 0; component < solution.dimension; ++component) {
            const auto [d1, d2] =
                derivatives([&](double s) { return fields(offset(x, i, s), t).velocity[component]; }, step);
            result.velocity_gradient[component][i] = d1;
            result.velocity_laplacian[component] += d2;
        }
    }
    return result;
}

/// How far a solution is from the Navier–Stokes equations over some points at one time.
struct Residual {
    double momentum =
        0; ///< max |du/dt + (u·∇)u + ∇p/ρ − ν∇²u|, relative to the largest term at any of the points
    double continuity = 0; ///< max |∇·u|, relative to the largest |∇u|
    double power = 0;      ///< the smallest term that is not absent, relative to the largest
};

inline Residual residual(const Solution& solution, const Values& values, Random& random) {
    const Domain domain = solution.domain(values);
    const Medium medium = solution.medium(values);
    const Evaluator fields = solution.bind(values);
    const Rates scales = rates(solution, domain, medium);
    const double t = random_time(scales, random);

    Vector momentum{};
    std::array<double, 4> terms{};
    double divergence = 0;
    double gradient = 0;
    double momentum_error = 0;
    for (int point = 0; point < 50; ++point) {
        const Vector x = random_point(solution, domain, random);
        const Derivatives at = derivatives_at(solution, domain, fields, x, t, time_step(scales));
        const Vector velocity = fields(x, t).velocity;
        Vector convection{};
        Vector pressure{};
        Vector viscous{};
        double trace = 0;
        for (int i = 0; i < 3; ++i) {
            convection[i] = dot(velocity, at.velocity_gradient[i]);
            pressure[i] = at.pressure_gradient[i] / medium.density;
            viscous[i] = medium.kinematic_viscosity * at.velocity_laplacian[i];
            momentum[i] = at.velocity_rate[i] + convection[i] + pressure[i] - viscous[i];
            trace += at.velocity_gradient[i][i];
            gradient = std::max(gradient, length(at.velocity_gradient[i]));
        }
        const std::array here{length(at.velocity_rate), length(convection), length(pressure),
                              length(viscous)};
        std::ranges::transform(terms, here, terms.begin(), [](double a, double b) { return std::max(a, b); });
        momentum_error = std::max(momentum_error, length(momentum));
        divergence = std::max(divergence, std::abs(trace));
    }

    const double largest = std::ranges::max(terms);
    Residual result{momentum_error / largest, divergence / gradient, 1};
    for (const double term : terms) {
        if (term > momentum_tolerance * largest) {
            result.power = std::min(result.power, term / largest);
        }
    }
    return result;
}

/// Largest difference of a field across a period, relative to the largest value seen of that field.
inline double periodicity_error(const Solution& solution, const Values& values, Random& random) {
    const Domain domain = solution.domain(values);
    const Evaluator fields = solution.bind(values);
    const double t = random_time(rates(solution, domain, solution.medium(values)), random);
    State largest;
    State difference;
    for (int point = 0; point < 50; ++point) {
        const Vector x = random_point(solution, domain, random);
        const State here = fields(x, t);
        for (int i = 0; i < 3; ++i) {
            largest.velocity[0] = std::max(largest.velocity[0], std::abs(here.velocity[i]));
        }
        largest.pressure = std::max(largest.pressure, std::abs(here.pressure));
        for (int d = 0; d < solution.dimension; ++d) {
            if (!domain.periodic[d]) {
                continue;
            }
            const State there = fields(offset(x, d, extent(domain, d)), t);
            for (int i = 0; i < 3; ++i) {
                difference.velocity[0] =
                    std::max(difference.velocity[0], std::abs(there.velocity[i] - here.velocity[i]));
            }
            difference.pressure = std::max(difference.pressure, std::abs(there.pressure - here.pressure));
        }
    }
    const double velocity = difference.velocity[0] / largest.velocity[0];
    return largest.pressure > 0 ? std::max(velocity, difference.pressure / largest.pressure) : velocity;
}

/// Nodes and weights (of sum 1) in one direction: equal spacing where periodic, which is exact for the
/// harmonics below the number of nodes, else Gauss–Legendre.
inline std::vector<std::pair<double, double>> quadrature(const Domain& domain, int direction) {
    constexpr int nodes = 24;
    std::vector<std::pair<double, double>> rule;
    const double low = domain.low[direction];
    const double size = extent(domain, direction);
    gsl_integration_glfixed_table* table = gsl_integration_glfixed_table_alloc(nodes);
    for (int i = 0; i < nodes; ++i) {
        double x = low + size * (i + 0.5) / nodes;
        double weight = size / nodes;
        if (!domain.periodic[direction]) {
            gsl_integration_glfixed_point(low, low + size, static_cast<std::size_t>(i), &x, &weight, table);
        }
        rule.emplace_back(x, weight / size);
    }
    gsl_integration_glfixed_table_free(table);
    return rule;
}

/// Volume mean over the domain of a function of the point.
template <class Function>
double volume_mean(const Solution& solution, const Domain& domain, const Function& function) {
    std::array<std::vector<std::pair<double, double>>, 3> rule;
    for (int d = 0; d < 3; ++d) {
        rule[d] = d < solution.dimension ? quadrature(domain, d) : std::vector{std::pair{domain.low[d], 1.0}};
    }
    double mean = 0;
    for (const auto& [z, wz] : rule[2]) {
        for (const auto& [y, wy] : rule[1]) {
            for (const auto& [x, wx] : rule[0]) {
                mean += wx * wy * wz * function(Vector{x, y, z});
            }
        }
    }
    return mean;
}

/// Volume mean of the pressure relative to the mean of its magnitude.
inline double mean_pressure_error(const Solution& solution, const Values& values, Random& random) {
    const Domain domain = solution.domain(values);
    const Evaluator fields = solution.bind(values);
    const double t = random_time(rates(solution, domain, solution.medium(values)), random);
    const double mean = volume_mean(solution, domain, [&](const Vector& x) { return fields(x, t).pressure; });
    const double magnitude =
        volume_mean(solution, domain, [&](const Vector& x) { return std::abs(fields(x, t).pressure); });
    return magnitude > 0 ? std::abs(mean) / magnitude : 0;
}

/// Relative difference between the declared kinetic energy and the quadrature of |u|^2/2.
inline double kinetic_energy_error(const Solution& solution, const Values& values, Random& random) {
    const Domain domain = solution.domain(values);
    const Evaluator fields = solution.bind(values);
    const double t = random_time(rates(solution, domain, solution.medium(values)), random);
    const double exact = volume_mean(solution, domain, [&](const Vector& x) {
        const Vector u = fields(x, t).velocity;
        return dot(u, u) / 2;
    });
    return std::abs(solution.kinetic_energy(values, t) - exact) / exact;
}

/// Relative difference between dE/dt of the declared kinetic energy and −ν times the mean of |∇u|^2 (no
/// boundaries).
inline double dissipation_error(const Solution& solution, const Values& values, Random& random) {
    const Domain domain = solution.domain(values);
    const Medium medium = solution.medium(values);
    const Evaluator fields = solution.bind(values);
    const Rates scales = rates(solution, domain, medium);
    const double t = random_time(scales, random);
    const double squared_gradient = volume_mean(solution, domain, [&](const Vector& x) {
        double sum = 0;
        for (int i = 0; i < solution.dimension; ++i) {
            for (int j = 0; j < solution.dimension; ++j) {
                const double gradient =
                    derivatives([&](double s) { return fields(offset(x, j, s), t).velocity[i]; },
                                extent(domain, j) / steps_per_extent)
                        .first;
                sum += gradient * gradient;
            }
        }
        return sum;
    });
    const double exact = -medium.kinematic_viscosity * squared_gradient;
    // The energy is smooth on the damping time; a shorter step would only lose digits.
    const double step = std::min(t / 4, 1 / (64 * scales.viscous));
    const double rate =
        derivatives([&](double s) { return solution.kinetic_energy(values, t + s); }, step).first;
    return std::abs(rate - exact) / std::abs(exact);
}

/// Largest speed in the closed domain at one time: the best point of a lattice, then moved by a shrinking
/// compass.
inline double sampled_maximum_speed(const Solution& solution, const Domain& domain, const Evaluator& fields,
                                    double t) {
    constexpr std::array points{1, 1000, 98, 34};
    const int n = points[solution.dimension];
    Vector step{};
    for (int d = 0; d < solution.dimension; ++d) {
        step[d] = extent(domain, d) / (n - 1);
    }
    double best = -1;
    Vector where = domain.low;
    for (int k = 0; k < (solution.dimension > 2 ? n : 1); ++k) {
        for (int j = 0; j < (solution.dimension > 1 ? n : 1); ++j) {
            for (int i = 0; i < n; ++i) {
                const Vector x{domain.low[0] + i * step[0], domain.low[1] + j * step[1],
                               domain.low[2] + k * step[2]};
                const double speed = length(fields(x, t).velocity);
                if (speed > best) {
                    best = speed;
                    where = x;
                }
            }
        }
    }
    for (int halving = 0; halving < 40;) {
        bool moved = false;
        for (int d = 0; d < solution.dimension; ++d) {
            for (const double sign : {-1.0, 1.0}) {
                Vector x = offset(where, d, sign * step[d]);
                x[d] = std::clamp(x[d], domain.low[d], domain.high[d]);
                const double speed = length(fields(x, t).velocity);
                if (speed > best) {
                    best = speed;
                    where = x;
                    moved = true;
                }
            }
        }
        if (!moved) {
            ++halving;
            std::ranges::transform(step, step.begin(), [](double s) { return s / 2; });
        }
    }
    return best;
}

/// Largest speed sampled at t = 0 and at times up to ten damping times, over the declared maximum.
inline double speed_ratio(const Solution& solution, const Values& values) {
    const Domain domain = solution.domain(values);
    const Medium medium = solution.medium(values);
    const Evaluator fields = solution.bind(values);
    const double T = longest_time(rates(solution, domain, medium));
    double largest = 0;
    for (const double t : {0.0, T / 100, T / 10, T, 10 * T}) {
        largest = std::max(largest, sampled_maximum_speed(solution, domain, fields, t));
    }
    return largest / medium.maximum_speed;
}

inline bool same_domain(const Domain& a, const Domain& b) {
    return a.low == b.low && a.high == b.high && a.periodic == b.periodic;
}

/// Largest relative change of velocity or pressure between two parameter sets with the same domain.
inline double field_change(const Solution& solution, const Values& values, const Values& others,
                           Random& random) {
    const Domain domain = solution.domain(values);
    const Evaluator fields = solution.bind(values);
    const Evaluator changed = solution.bind(others);
    const Rates scales = rates(solution, domain, solution.medium(values));
    double speed = 0;
    double speed_change = 0;
    double pressure = 0;
    double pressure_change = 0;
    for (int point = 0; point < 50; ++point) {
        const Vector x = random_point(solution, domain, random);
        const double t = random_time(scales, random);
        const State a = fields(x, t);
        const State b = changed(x, t);
        for (int i = 0; i < 3; ++i) {
            speed = std::max(speed, std::abs(a.velocity[i]));
            speed_change = std::max(speed_change, std::abs(b.velocity[i] - a.velocity[i]));
        }
        pressure = std::max(pressure, std::abs(a.pressure));
        pressure_change = std::max(pressure_change, std::abs(b.pressure - a.pressure));
    }
    const double velocity = speed_change / std::max(speed, std::numeric_limits<double>::min());
    return std::max(velocity, pressure_change / std::max(pressure, std::numeric_limits<double>::min()));
}

/// The declared parameters of which a change by a tenth changes neither the domain nor any field.
inline std::vector<std::string> ignored_parameters(const Solution& solution, Random& random) {
    const Values values = random_values(solution, random);
    std::vector<std::string> ignored;
    for (const Parameter& p : solution.parameters) {
        const double value = values.find(p.name)->second;
        const double change = value != 0 ? 0.1 * value : 0.1 * (p.high - p.low);
        Values others = values;
        others.find(p.name)->second =
            p.low <= value + change && value + change <= p.high ? value + change : value - change;
        if (same_domain(solution.domain(values), solution.domain(others)) &&
            field_change(solution, values, others, random) < 1e-6) {
            ignored.emplace_back(p.name);
        }
    }
    return ignored;
}

} // namespace sphvv::analytic::checks
