#pragma once

// Ways to hold a declared exact solution against its equations and its own claims. They see the declaration
// and the values of the fields only, never how these are computed, and choose points, times and parameters by
// seeded draws.

#include "sphvv/analytic/solution.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
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
/// Second derivatives of 25 friction velocities by the short steps that a logarithm needs at a wall.
inline constexpr double turbulence_tolerance = 5e-9;
inline constexpr double continuity_tolerance = 1e-10;
/// Fields and means that are compared without differences: round-off of some 1e4 terms and of the argument.
inline constexpr double value_tolerance = 1e-12;
inline constexpr double rate_tolerance = 1e-9;
inline constexpr double maximum_tolerance = 1e-3;
/// One-sided differences of order 8 with steps of 1e-6 of the thickness: round-off of 5e-9 of the field.
inline constexpr double stress_tolerance = 1e-7;
/// Change of a field within 1e-9 of the time drawn first.
inline constexpr double start_tolerance = 1e-6;
/// A mean over a box with a logarithmic singularity in a corner.
inline constexpr double mean_tolerance = 2e-12;

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

/// Distance to the nearest boundary (m), infinite where there is none.
inline double wall_distance(const std::vector<Boundary>& walls, const Vector& x) {
    double distance = std::numeric_limits<double>::infinity();
    for (const Boundary& wall : walls) {
        distance = std::min(distance, wall.distance(x));
    }
    return distance;
}

/// A solution at given values, with all that its declaration says there.
struct Flow {
    const Solution& solution;
    Values values;
    Domain domain;
    Medium medium;
    std::vector<Boundary> walls;
    Evaluator fields;
    double thickness; ///< m: the smallest side of the box, of those across walls, or the gap between curved
                      ///< walls

    Flow(const Solution& of, const Values& at)
        : solution(of), values(at), domain(of.domain(at)), medium(of.medium(at)), walls(boundaries(of, at)),
          fields(of.bind(at)), thickness(std::numeric_limits<double>::infinity()) {
        for (int d = 0; d < dimension(); ++d) {
            if (!bounded() || !domain.periodic[d]) {
                thickness = std::min(thickness, extent(domain, d));
            }
        }
        if (curved()) {
            Random random(1);
            double farthest = 0;
            for (int draw = 0; draw < 5000; ++draw) {
                farthest = std::max(farthest, wall_distance(walls, point_of_box(random, 0)));
            }
            thickness = std::min(thickness, 2 * farthest);
        }
    }
    int dimension() const { return solution.dimension; }
    bool bounded() const { return !walls.empty(); }
    bool curved() const {
        return std::any_of(walls.begin(), walls.end(), [](const Boundary& wall) { return !wall.face; });
    }
    bool viscous() const { return medium.kinematic_viscosity > 0; }

    /// Point of the box, a margin away from the ends of directions that are not periodic.
    Vector point_of_box(Random& random, double margin) const {
        Vector x{};
        for (int d = 0; d < dimension(); ++d) {
            const double apart = domain.periodic[d] ? 0 : margin;
            x[d] = random.uniform(domain.low[d] + apart, domain.high[d] - apart);
        }
        return x;
    }
    bool fully_periodic() const {
        return std::all_of(domain.periodic.begin(), domain.periodic.begin() + dimension(),
                           [](bool periodic) { return periodic; });
    }
};

/// Point of the fluid, apart from its boundaries by the reach of the difference formulae.
inline Vector random_point(const Flow& flow, Random& random) {
    const double margin = 4 * flow.thickness / steps_per_extent;
    constexpr int most_draws = 100000;
    for (int draw = 0; draw < most_draws; ++draw) {
        const Vector x = flow.point_of_box(random, margin);
        if (wall_distance(flow.walls, x) >= margin) {
            return x;
        }
    }
    throw std::logic_error("the declared boundaries leave no fluid in the domain's box");
}

/// Rates (1/s) at which a wave as long as the thickness is carried and damped.
struct Rates {
    double convective;
    double viscous;
};

inline Rates rates(const Flow& flow) {
    const double k = 2 * pi / flow.thickness;
    const double speed = std::isfinite(flow.medium.maximum_speed) ? flow.medium.maximum_speed : 0;
    return {k * speed, k * k * flow.medium.kinematic_viscosity};
}

/// Time of interest where nothing changes with time.
inline constexpr double any_time = 1;

inline double time_step(const Rates& rates) {
    const double fastest = rates.convective + rates.viscous;
    return fastest > 0 ? 1 / (64 * fastest) : any_time / 64;
}

/// A walled flow starts with layers that are as thick as it is old: its time step is short against its age.
inline double time_step(const Flow& flow, double t) {
    const double step = time_step(rates(flow));
    return flow.bounded() ? std::min(step, t / 64) : step;
}

/// The longest time drawn: one damping time, or two turns of the slowest vortex where damping is slower.
inline double longest_time(const Rates& rates) {
    const double turns = rates.convective > 0 ? 4 * pi / rates.convective : any_time;
    return rates.viscous > 0 ? std::min(1 / rates.viscous, turns) : turns;
}

/// Between walls: evenly in the logarithm while layers of √(νt) fill a twentieth to a half of the thickness.
inline double random_time(const Flow& flow, Random& random) {
    const Rates scales = rates(flow);
    if (flow.bounded()) {
        return scales.viscous > 0 ? std::pow(10, random.uniform(-1, 1)) / scales.viscous
                                  : random.uniform(0, any_time);
    }
    return random.uniform(4 * time_step(scales), longest_time(scales));
}

/// Step of differences in a direction: a 256th of the thickness, a 16th of a starting layer's √(νt), and a
/// 64th of the distance to the wall where a field may be singular behind it (a 32nd for second derivatives,
/// against round-off: for a logarithm the truncation is 1e-10).
inline double space_step(const Flow& flow, int direction, const Vector& x, double t) {
    if (flow.domain
            .periodic[direction]) { // not shorter than across walls: fields that do not vary have round-off
        const double across = flow.bounded() ? flow.thickness : 0;
        return std::max(extent(flow.domain, direction), across) / steps_per_extent;
    }
    double step = flow.thickness / steps_per_extent;
    if (flow.solution.equations != Equations::navier_stokes) {
        const bool second = flow.solution.equations == Equations::reynolds_averaged;
        step = std::min(step, wall_distance(flow.walls, x) / (second ? 32 : 64));
    } else if (flow.bounded()) {
        step = std::min(step, std::sqrt(flow.medium.kinematic_viscosity * t) / 16);
    }
    return step;
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

/// Gradient of a function of the point.
template <class Function>
Vector gradient_of(const Flow& flow, const Function& function, const Vector& x, double t) {
    Vector gradient{};
    for (int d = 0; d < flow.dimension(); ++d) {
        gradient[d] =
            derivatives([&](double s) { return function(offset(x, d, s)); }, space_step(flow, d, x, t)).first;
    }
    return gradient;
}

/// Derivatives of all fields at one point and time.
struct Derivatives {
    Vector velocity_rate{};                    ///< du_i/dt
    std::array<Vector, 3> velocity_gradient{}; ///< [i][j] = du_i/dx_j
    Vector velocity_laplacian{};
    Vector pressure_gradient{};
};

/// Those in space; the rate is left zero.
inline Derivatives space_derivatives(const Flow& flow, const Vector& x, double t) {
    Derivatives result;
    result.pressure_gradient = gradient_of(
        flow, [&](const Vector& y) { return flow.fields(y, t).pressure; }, x, t);
    for (int i = 0; i < flow.dimension(); ++i) {
        for (int component = 0; component < flow.dimension(); ++component) {
            const auto [d1, d2] =
                derivatives([&](double s) { return flow.fields(offset(x, i, s), t).velocity[component]; },
                            space_step(flow, i, x, t));
            result.velocity_gradient[component][i] = d1;
            result.velocity_laplacian[component] += d2;
        }
    }
    return result;
}

/// Those of several points, time by time, since a solution may prepare each time anew.
inline std::vector<Derivatives> derivatives_at(const Flow& flow, const std::vector<Vector>& points,
                                               double t) {
    const double step = time_step(flow, t);
    std::array<std::vector<Vector>, 9> velocity;
    for (int m = -4; m <= 4; ++m) {
        for (const Vector& x : points) {
            velocity[m + 4].push_back(flow.fields(x, t + m * step).velocity);
        }
    }
    std::vector<Derivatives> result;
    for (std::size_t i = 0; i < points.size(); ++i) {
        result.push_back(space_derivatives(flow, points[i], t));
        for (int d = 0; d < flow.dimension(); ++d) {
            const auto at = [&](double s) {
                return velocity[static_cast<int>(std::lround(s / step)) + 4][i][d];
            };
            result.back().velocity_rate[d] = derivatives(at, step).first;
        }
    }
    return result;
}

/// How far a solution is from its equations over some points at one time.
struct Residual {
    double momentum = 0; ///< max |residual of the momentum equation|, relative to its largest term at any of
                         ///< the points, in the worst direction
    double continuity = 0; ///< max |∇·u|, relative to the largest |∇u|
    double power = 1;      ///< the smallest term that is not absent, relative to the largest in its direction
};

/// A ratio of an error to its scale; nothing over nothing is no error.
inline double relative(double error, double scale) {
    return error == 0 ? 0 : error / scale;
}

/// ∇·[(ν + ν_T)(∇u + ∇uᵀ)] of a flow without divergence.
inline Vector viscous_term(const Flow& flow, const Derivatives& at, const Vector& x, double t) {
    Vector term{};
    double viscosity = flow.medium.kinematic_viscosity;
    Vector gradient{};
    if (flow.solution.equations == Equations::reynolds_averaged) {
        const Scalar eddy = quantity(flow.solution, "eddy_viscosity", flow.values);
        viscosity += eddy(x, t);
        gradient = gradient_of(
            flow, [&](const Vector& y) { return eddy(y, t); }, x, t);
    }
    for (int i = 0; i < flow.dimension(); ++i) {
        term[i] = viscosity * at.velocity_laplacian[i];
        for (int j = 0; j < flow.dimension(); ++j) {
            term[i] += gradient[j] * (at.velocity_gradient[i][j] + at.velocity_gradient[j][i]);
        }
    }
    return term;
}

inline std::vector<Vector> random_points(const Flow& flow, Random& random, int count) {
    std::vector<Vector> points;
    for (int point = 0; point < count; ++point) {
        points.push_back(random_point(flow, random));
    }
    return points;
}

/// The momentum balance, term by term and direction by direction: gravity may be large where the flow is
/// slow.
inline Residual balance(const Flow& flow, Random& random) {
    const double t = random_time(flow, random);
    const std::vector<Vector> points = random_points(flow, random, 50);
    const std::vector<Derivatives> derivatives = derivatives_at(flow, points, t);
    std::array<std::array<double, 5>, 3> terms{}; // [direction][term]
    const Vector force = body_force(flow.solution, flow.values, t);
    Vector error{};
    double divergence = 0;
    double gradient = 0;
    for (std::size_t point = 0; point < points.size(); ++point) {
        const Derivatives& at = derivatives[point];
        const State state = flow.fields(points[point], t);
        const Vector viscous = viscous_term(flow, at, points[point], t);
        double trace = 0;
        for (int i = 0; i < flow.dimension(); ++i) {
            const std::array here{at.velocity_rate[i], dot(state.velocity, at.velocity_gradient[i]),
                                  at.pressure_gradient[i] / density(state, flow.medium), -viscous[i],
                                  -force[i]};
            double sum = 0;
            for (std::size_t term = 0; term < here.size(); ++term) {
                terms[i][term] = std::max(terms[i][term], std::abs(here[term]));
                sum += here[term];
            }
            error[i] = std::max(error[i], std::abs(sum));
            trace += at.velocity_gradient[i][i];
            gradient = std::max(gradient, length(at.velocity_gradient[i]));
        }
        divergence = std::max(divergence, std::abs(trace));
    }
    Residual result{0, relative(divergence, gradient), 1};
    for (int i = 0; i < flow.dimension(); ++i) {
        const double largest = std::ranges::max(terms[i]);
        result.momentum = std::max(result.momentum, relative(error[i], largest));
        for (const double term : terms[i]) {
            if (term > momentum_tolerance * largest) {
                result.power = std::min(result.power, term / largest);
            }
        }
    }
    return result;
}

/// u = ∇φ, ∇·u = 0 and ∫p dt = −ρφ. Both of the latter count as momentum.
inline Residual impulse_residual(const Flow& flow, Random& random) {
    const Scalar potential = quantity(flow.solution, "potential", flow.values);
    const Scalar impulse = quantity(flow.solution, "impulse", flow.values);
    double speed = 0;
    double speed_error = 0;
    double largest = 0;
    double impulse_error = 0;
    double gradient = 0;
    double divergence = 0;
    for (const Vector& x : random_points(flow, random, 50)) {
        const Vector u = flow.fields(x, 0).velocity;
        const Vector slope = gradient_of(
            flow, [&](const Vector& y) { return potential(y, 0); }, x, 0);
        double trace = 0;
        for (int d = 0; d < flow.dimension(); ++d) {
            const Vector g = gradient_of(
                flow, [&](const Vector& y) { return flow.fields(y, 0).velocity[d]; }, x, 0);
            trace += g[d];
            gradient = std::max(gradient, length(g));
            speed_error = std::max(speed_error, std::abs(u[d] - slope[d]));
        }
        speed = std::max(speed, length(u));
        divergence = std::max(divergence, std::abs(trace));
        largest = std::max(largest, std::abs(impulse(x, 0)));
        impulse_error =
            std::max(impulse_error, std::abs(impulse(x, 0) + flow.medium.density * potential(x, 0)));
    }
    return {std::max(relative(speed_error, speed), relative(impulse_error, largest)),
            relative(divergence, gradient), 1};
}

inline double residual_tolerance(const Flow& flow) {
    return flow.solution.equations == Equations::reynolds_averaged ? turbulence_tolerance
                                                                   : momentum_tolerance;
}

inline Residual residual(const Flow& flow, Random& random) {
    return flow.solution.equations == Equations::impulsive ? impulse_residual(flow, random)
                                                           : balance(flow, random);
}

/// The foot of a point on a boundary, and the normal there.
struct Foot {
    Vector x{};
    Vector normal{};
};

inline Foot foot_of(const Flow& flow, const Boundary& wall, Vector x) {
    Foot foot;
    for (int d = 0; d < flow.dimension(); ++d) {
        foot.normal[d] = derivatives([&](double s) { return wall.distance(offset(x, d, s)); },
                                     flow.thickness / steps_per_extent)
                             .first;
    }
    for (int step = 0; step < 2; ++step) { // the second takes out the round-off of the normal
        const double distance = wall.distance(x);
        for (int d = 0; d < flow.dimension(); ++d) {
            x[d] -= distance * foot.normal[d];
        }
    }
    if (wall.face) {
        x[wall.face->direction] =
            wall.face->high ? flow.domain.high[wall.face->direction] : flow.domain.low[wall.face->direction];
    }
    foot.x = x;
    return foot;
}

/// Scale of the velocities of a flow (m/s): the largest at 50 points.
inline double sampled_speed(const Flow& flow, double t, Random& random) {
    double speed = 0;
    for (const Vector& x : random_points(flow, random, 50)) {
        speed = std::max(speed, length(flow.fields(x, t).velocity));
    }
    return speed;
}

/// What the conditions on the boundaries miss.
struct BoundaryErrors {
    double velocity = 0; ///< of no-slip and impermeable walls, relative to the largest speed
    double pressure = 0; ///< of surfaces, pressure or impulse relative to the largest inside
    double stress = 0;   ///< of surfaces, shear stress relative to the largest inside
    double geometry = 0; ///< | |∇distance| − 1 |
};

/// Shear stress over density along a surface with the normal n (m2/s2), by one-sided differences into the
/// fluid: h f′(0) = Σ (−1)^{k+1} C(8, k)/k [f(kh) − f(0)].
inline double surface_stress(const Flow& flow, const Foot& foot, double t) {
    const double step = 1e-6 * flow.thickness;
    double viscosity = flow.medium.kinematic_viscosity;
    if (flow.solution.equations == Equations::reynolds_averaged) {
        viscosity += quantity(flow.solution, "eddy_viscosity", flow.values)(foot.x, t);
    }
    constexpr std::array binomial{8., 28., 56., 70., 56., 28., 8., 1.};
    const auto velocity_at = [&](double distance) {
        Vector x = foot.x;
        for (int d = 0; d < flow.dimension(); ++d) {
            x[d] += distance * foot.normal[d];
        }
        return flow.fields(x, t).velocity;
    };
    const Vector start = velocity_at(0);
    Vector slope{};
    for (int k = 1; k <= 8; ++k) {
        const Vector ahead = velocity_at(k * step);
        for (int d = 0; d < 3; ++d) {
            slope[d] += (k % 2 == 1 ? 1 : -1) * binomial[k - 1] / k * (ahead[d] - start[d]) / step;
        }
    }
    const double normal_part = dot(slope, foot.normal);
    for (int d = 0; d < 3; ++d) {
        slope[d] -= normal_part * foot.normal[d];
    }
    return viscosity * length(slope);
}

inline BoundaryErrors boundary_errors(const Flow& flow, Random& random) {
    BoundaryErrors errors;
    const double t = random_time(flow, random);
    const bool impulsive = flow.solution.equations == Equations::impulsive;
    const Scalar impulse = impulsive ? quantity(flow.solution, "impulse", flow.values) : Scalar{};
    const auto pressure = [&](const Vector& x) {
        return impulsive ? impulse(x, t) : flow.fields(x, t).pressure;
    };
    const double speed = sampled_speed(flow, t, random);
    double largest_pressure = 0;
    for (const Vector& x : random_points(flow, random, 50)) {
        largest_pressure = std::max(largest_pressure, std::abs(pressure(x)));
    }
    // ν U/H is the scale of laminar stresses, F H that of turbulent ones.
    const double stress = flow.medium.kinematic_viscosity * speed / flow.thickness +
                          std::abs(flow.medium.body_force[0]) * flow.thickness;
    for (const Boundary& wall : flow.walls) {
        for (int point = 0; point < 20; ++point) {
            const Foot foot = foot_of(flow, wall, random_point(flow, random));
            errors.geometry = std::max(errors.geometry, std::abs(length(foot.normal) - 1));
            if (wall.kind == BoundaryKind::free_surface) {
                errors.pressure =
                    std::max(errors.pressure, relative(std::abs(pressure(foot.x)), largest_pressure));
                if (!impulsive) {
                    errors.stress = std::max(errors.stress, relative(surface_stress(flow, foot, t), stress));
                }
                continue;
            }
            const Vector of_wall = wall.velocity(foot.x, t);
            Vector slip = flow.fields(foot.x, t).velocity;
            for (int d = 0; d < 3; ++d) {
                slip[d] -= of_wall[d];
            }
            const double error =
                wall.kind == BoundaryKind::no_slip ? length(slip) : std::abs(dot(slip, foot.normal));
            errors.velocity = std::max(errors.velocity, relative(error, std::max(speed, length(of_wall))));
        }
    }
    return errors;
}

/// Largest change of the velocity in the fluid just after t = 0, relative to the largest speed later.
inline double start_error(const Flow& flow, Random& random) {
    const double later = random_time(flow, random);
    const double speed = sampled_speed(flow, later, random);
    double change = 0;
    for (const Vector& x : random_points(flow, random, 50)) {
        const Vector before = flow.fields(x, 0).velocity;
        const Vector after = flow.fields(x, 1e-9 * later).velocity;
        for (int d = 0; d < 3; ++d) {
            change = std::max(change, std::abs(after[d] - before[d]));
        }
    }
    return relative(change, speed);
}

/// Largest difference of a field across a period, relative to the largest value seen of that field.
inline double periodicity_error(const Flow& flow, Random& random) {
    const double t = random_time(flow, random);
    double speed = 0;
    double speed_change = 0;
    double pressure = 0;
    double pressure_change = 0;
    for (const Vector& x : random_points(flow, random, 50)) {
        const State here = flow.fields(x, t);
        speed = std::max(speed, length(here.velocity));
        pressure = std::max(pressure, std::abs(here.pressure));
        for (int d = 0; d < flow.dimension(); ++d) {
            if (!flow.domain.periodic[d]) {
                continue;
            }
            const State there = flow.fields(offset(x, d, extent(flow.domain, d)), t);
            for (int i = 0; i < 3; ++i) {
                speed_change = std::max(speed_change, std::abs(there.velocity[i] - here.velocity[i]));
            }
            pressure_change = std::max(pressure_change, std::abs(there.pressure - here.pressure));
        }
    }
    return std::max(relative(speed_change, speed), relative(pressure_change, pressure));
}

/// Nodes and weights (of sum 1) in one direction: equal spacing where periodic, which is exact for the
/// harmonics below the number of nodes, else the tanh–sinh rule (Takahasi & Mori 1974), which bears layers
/// and logarithmic singularities at the ends.
inline std::vector<std::pair<double, double>> quadrature(const Domain& domain, int direction) {
    std::vector<std::pair<double, double>> rule;
    const double low = domain.low[direction];
    const double size = extent(domain, direction);
    if (domain.periodic[direction]) {
        constexpr int nodes = 24;
        for (int i = 0; i < nodes; ++i) {
            rule.emplace_back(low + size * (i + 0.5) / nodes, 1. / nodes);
        }
        return rule;
    }
    constexpr double step = 1. / 32;
    constexpr int half = 104; // the last nodes lie 1e-17 of the size from the ends
    const double middle = low + size / 2;
    double sum = 0;
    for (int i = -half; i <= half; ++i) { // in either half of the side, mirrored
        const double s = pi / 2 * std::sinh(i * step);
        const double share = 1 / (1 + std::exp(-2 * s)); // exact next to the end
        const double weight = std::cosh(i * step) / (std::cosh(s) * std::cosh(s));
        rule.emplace_back(i < 0 ? low + size / 2 * share : middle - size / 2 / (1 + std::exp(2 * s)), weight);
        rule.emplace_back(domain.high[direction] - (rule.back().first - low), weight);
        sum += 2 * weight;
    }
    for (auto& [x, weight] : rule) {
        weight /= sum;
    }
    return rule;
}

/// Volume mean over the domain's box of a function of the point.
template <class Function>
double volume_mean(const Domain& domain, int dimension, const Function& function) {
    std::array<std::vector<std::pair<double, double>>, 3> rule;
    for (int d = 0; d < 3; ++d) {
        rule[d] = d < dimension ? quadrature(domain, d) : std::vector{std::pair{domain.low[d], 1.0}};
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
inline double mean_pressure_error(const Flow& flow, Random& random) {
    const double t = random_time(flow, random);
    const auto mean = [&](double (*of)(double)) {
        return volume_mean(flow.domain, flow.dimension(),
                           [&](const Vector& x) { return of(flow.fields(x, t).pressure); });
    };
    return relative(std::abs(mean([](double p) { return p; })), mean([](double p) { return std::abs(p); }));
}

/// Relative difference between the declared kinetic energy and the quadrature of |u|^2/2 over the box.
inline double kinetic_energy_error(const Flow& flow, Random& random) {
    const double t = random_time(flow, random);
    const double exact = volume_mean(flow.domain, flow.dimension(), [&](const Vector& x) {
        const Vector u = flow.fields(x, t).velocity;
        return dot(u, u) / 2;
    });
    return relative(std::abs(flow.solution.kinetic_energy(flow.values, t) - exact), exact);
}

/// Relative difference between dE/dt of the declared kinetic energy and −ν times the mean of |∇u|^2 (no
/// boundaries).
inline double dissipation_error(const Flow& flow, Random& random) {
    const Rates scales = rates(flow);
    const double t = random_time(flow, random);
    const double squared_gradient = volume_mean(flow.domain, flow.dimension(), [&](const Vector& x) {
        double sum = 0;
        for (int i = 0; i < flow.dimension(); ++i) {
            const Vector gradient = gradient_of(
                flow, [&](const Vector& y) { return flow.fields(y, t).velocity[i]; }, x, t);
            sum += dot(gradient, gradient);
        }
        return sum;
    });
    const double exact = -flow.medium.kinematic_viscosity * squared_gradient;
    // The energy is smooth on the damping time; a shorter step would only lose digits.
    const double step = std::min(t / 4, 1 / (64 * scales.viscous));
    const double rate =
        derivatives([&](double s) { return flow.solution.kinetic_energy(flow.values, t + s); }, step).first;
    return std::abs(rate - exact) / std::abs(exact);
}

/// Largest speed in the closed fluid at one time: the best point of a lattice, then moved by a shrinking
/// compass.
inline double sampled_maximum_speed(const Flow& flow, double t) {
    constexpr std::array points{1, 1000, 98, 34};
    const int n = points[flow.dimension()];
    const Domain& domain = flow.domain;
    Vector step{};
    for (int d = 0; d < flow.dimension(); ++d) {
        step[d] = extent(domain, d) / (n - 1);
    }
    double best = -1;
    Vector where = domain.low;
    const auto better = [&](const Vector& x) {
        if (flow.curved() && wall_distance(flow.walls, x) < 0) {
            return false;
        }
        const double speed = length(flow.fields(x, t).velocity);
        if (!(speed > best)) {
            return false;
        }
        best = speed;
        where = x;
        return true;
    };
    for (int k = 0; k < (flow.dimension() > 2 ? n : 1); ++k) {
        for (int j = 0; j < (flow.dimension() > 1 ? n : 1); ++j) {
            for (int i = 0; i < n; ++i) {
                better(
                    {domain.low[0] + i * step[0], domain.low[1] + j * step[1], domain.low[2] + k * step[2]});
            }
        }
    }
    for (int halving = 0; halving < 40; ++halving) {
        // Along a curved wall the compass could creep for ever; a hundred moves are enough for any shorter
        // step.
        bool moved = true;
        for (int move = 0; moved && move < 100; ++move) {
            moved = false;
            for (int d = 0; d < flow.dimension(); ++d) {
                for (const double sign : {-1.0, 1.0}) {
                    Vector x = offset(where, d, sign * step[d]);
                    x[d] = std::clamp(x[d], domain.low[d], domain.high[d]);
                    moved = better(x) || moved;
                }
            }
        }
        std::ranges::transform(step, step.begin(), [](double s) { return s / 2; });
    }
    return best;
}

/// Largest speed sampled at t = 0, at times up to ten damping times, and at rest between walls, over the
/// declared maximum; 1 where both are none.
inline double speed_ratio(const Flow& flow) {
    const Rates scales = rates(flow);
    const double T = longest_time(scales);
    std::vector<double> times{0.0, T / 100, T / 10, T, 10 * T};
    if (flow.bounded() && scales.viscous > 0) {
        times.push_back(1000 / scales.viscous);
    }
    double largest = 0;
    for (const double t : times) {
        largest = std::max(largest, sampled_maximum_speed(flow, t));
    }
    return largest == flow.medium.maximum_speed ? 1 : largest / flow.medium.maximum_speed;
}

inline bool same_domain(const Domain& a, const Domain& b) {
    return a.low == b.low && a.high == b.high && a.periodic == b.periodic;
}

/// Largest relative change of the velocity, pressure, density or a quantity between two parameter sets with
/// the same domain.
inline double field_change(const Flow& flow, const Flow& changed, Random& random) {
    const std::size_t quantities = flow.solution.quantities.size();
    std::vector<std::array<Scalar, 2>> bound;
    for (const Quantity& declared : flow.solution.quantities) {
        bound.push_back({declared.bind(flow.values), declared.bind(changed.values)});
    }
    std::vector<double> largest(3 + quantities, std::numeric_limits<double>::min());
    std::vector<double> change(3 + quantities, 0);
    const auto note = [&](std::size_t what, double a, double b) {
        if (std::isfinite(a) && std::isfinite(b)) {
            largest[what] = std::max(largest[what], std::abs(a));
            change[what] = std::max(change[what], std::abs(b - a));
        }
    };
    double t = 0;
    for (int point = 0; point < 50; ++point) {
        t = point % 10 == 0 ? random_time(flow, random) : t; // a solution may prepare each time anew
        const Vector x = random_point(flow, random);
        const State a = flow.fields(x, t);
        const State b = changed.fields(x, t);
        for (int i = 0; i < 3; ++i) {
            note(0, a.velocity[i], b.velocity[i]);
        }
        note(1, a.pressure, b.pressure);
        note(2, a.density.value_or(0), b.density.value_or(0));
        for (std::size_t q = 0; q < quantities; ++q) {
            note(3 + q, bound[q][0](x, t), bound[q][1](x, t));
        }
    }
    double worst = 0;
    for (std::size_t i = 0; i < change.size(); ++i) {
        worst = std::max(worst, change[i] / largest[i]);
    }
    return worst;
}

/// The declared parameters of which a change by a tenth changes neither the domain nor any field or quantity.
inline std::vector<std::string> ignored_parameters(const Solution& solution, Random& random) {
    const Values values = random_values(solution, random);
    const Flow flow(solution, values);
    std::vector<std::string> ignored;
    for (const Parameter& p : solution.parameters) {
        const double value = values.find(p.name)->second;
        const double change = value != 0 ? 0.1 * value : 0.1 * (p.high - p.low);
        Values others = values;
        others.find(p.name)->second =
            p.low <= value + change && value + change <= p.high ? value + change : value - change;
        if (same_domain(flow.domain, solution.domain(others)) &&
            field_change(flow, Flow(solution, others), random) < 1e-6) {
            ignored.emplace_back(p.name);
        }
    }
    return ignored;
}

} // namespace sphvv::analytic::checks
