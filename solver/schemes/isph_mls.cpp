#include "sphvv/solver/operators/laplacian_morris.hpp"
#include "sphvv/solver/operators/moving_least_squares.hpp"
#include "sphvv/solver/operators/renormalisation.hpp"
#include "sphvv/solver/projection/projection.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>

namespace sphvv::solver::schemes {
namespace {

// No projection: the pressure that keeps a flow free of divergence is a function of positions and velocities,
// so that r' = w(r, u), u' = a(r, u) is a system of ordinary differential equations, and any Runge-Kutta
// method keeps its order. Following a particle, the divergence of the momentum equation is
//
//   D(div u)/Dt = -tr(grad u grad u) - Lap p/rho + nu Lap div u,
//
// so with Lap p = rho [lambda div u + s - tr(grad u grad u)], Ds/Dt = kappa div u, the divergence obeys
//
//   D2(div u)/Dt2 + lambda D(div u)/Dt + kappa div u = De/Dt + viscous terms,
//
// where e = O(h^2) is what the discrete operators leave of the identity. Zero stays zero, and what e makes of
// it is De/Dt / kappa = O(h^4), as kappa is proportional to (U/h)^2; without s it were e/lambda = O(h^3).
// That is on even particles: on disordered ones the Laplacians are wrong by O(h), and so is e, up to nu O(1)
// of the viscous term; O(h^3) + nu O(h^2) is left of the divergence. (s moves with the particles, shifts
// included: its convection by du_s, which is small as s itself is, is left out.)
//
// Particles move with u + du_s, and du/dt along that path has the term (du_s.grad) u: shifting without a
// correction to be made afterwards. Particles repel each other with strengths that differ a little. Alike,
// they would keep the symmetry of a lattice: a particle that starts on a saddle point of the flow
// (Taylor-Green vortices with n = 4m + 2, also of isph_dfs) stays on it, its neighbours in line, until they
// touch.

/// An explicit Runge-Kutta method whose stage k starts from stage k-1 alone: y_k = y + a_k dt f(y_{k-1}),
/// y' = y + dt sum b_k f(y_k).
struct RungeKutta {
    std::string_view name;
    double order;
    std::string_view source;
    std::vector<double> a; ///< of the stages after the first
    std::vector<double> b;
};

const std::vector<RungeKutta>& methods() {
    static const std::vector<RungeKutta> all{
        {"euler", 1, "forward Euler", {}, {1}},
        {"heun2", 2, "Heun 1900, two stages", {1}, {1. / 2, 1. / 2}},
        {"heun3", 3, "Heun 1900, three stages", {1. / 3, 2. / 3}, {1. / 4, 0, 3. / 4}},
        {"rk4", 4, "Kutta 1901", {1. / 2, 1. / 2, 1}, {1. / 6, 1. / 3, 1. / 3, 1. / 6}},
    };
    return all;
}

std::vector<std::string> method_names() {
    std::vector<std::string> names;
    for (const RungeKutta& method : methods()) {
        names.emplace_back(method.name);
    }
    return names;
}

const RungeKutta& method_of(const Settings& settings) {
    return *std::ranges::find(methods(), settings.word("integrator"), &RungeKutta::name);
}

TimeOrder time_order(const Settings& settings) {
    const RungeKutta& method = method_of(settings);
    return {method.order, std::string(method.source) + "; the rates do not depend on dt"};
}

template <int Dim>
struct Fields {
    Field& pressure;
    Field& divergence_integral; ///< s, 1/s2
    Field& strength;            ///< with which a particle repels others
    Field& drift_velocity;      ///< dr/dt = u + du_s
    Field& acceleration;        ///< du/dt along that path
    Field& divergence_rate;     ///< ds/dt
    Field& start;               ///< r, u and s at the start of the step
    Field& increment;           ///< sum of b_k f_k
    PressurePoisson<Dim> poisson;
    std::array<std::vector<double>, Dim> gradient; ///< weights, entry by entry of the neighbour list
    const RungeKutta& method;
    double lambda;   ///< 1/s
    double kappa;    ///< 1/s2
    double mobility; ///< du_s = mobility * root mean square of u * repulsion()
    bool quadratic;  ///< moving least squares; else renormalised gradient and Morris Laplacian
    UniformVolume volume;
};

/// Sum over one row of w_j (A_j - A_i).
template <int Dim>
double weighted_differences(const Row<Dim>& row, int i, const double* weights, const double* A) {
    Lanes total{};
    for (int k = 0; k < row.padded; k += lane_count) {
        total += load(weights + k) * (gather(A, row.index + k) - A[i]);
    }
    return sum(total);
}

/// The same for the weights of all derivatives.
template <int Dim>
Vector<Dim> gradient_of(const Row<Dim>& row, int i, const std::array<double*, Dim>& weights,
                        const double* A) {
    std::array<Lanes, Dim> total{};
    for (int k = 0; k < row.padded; k += lane_count) {
        const Lanes difference = gather(A, row.index + k) - A[i];
        for (int d = 0; d < Dim; ++d) {
            total[d] += load(weights[d] + k) * difference;
        }
    }
    return lane_sums<Dim>(total);
}

/// (dx/r)^dim (1 - r^2/radius^2)^2: what a neighbour at the distance r pushes with (pure number).
template <int Dim>
double push(double r, double dx, double radius) {
    const double cut = std::max(0.0, 1 - r * r / (radius * radius));
    return std::pow(dx / r, Dim) * cut * cut;
}

/// Sum over the neighbours of strength_j push(r_ij) r_ij/|r_ij| (pure number): the shifting vector of Xu 2009
/// §2.3 with a weight that vanishes smoothly at the edge of the support. The original's steps there would
/// make the rates discontinuous, and every integrator first order.
template <int Dim>
Vector<Dim> repulsion(const Row<Dim>& row, const double* strength, double dx, double radius) {
    std::array<Lanes, Dim> total{};
    for (int k = 0; k < row.padded; k += lane_count) {
        const Lanes r2 = squared_separation<Dim>(row, k);
        const auto inside = (r2 > 0) & (r2 < radius * radius);
        const Lanes safe = select(inside, r2, 1);
        const Lanes r = sqrt(safe);
        const Lanes cut = 1 - safe / (radius * radius);
        const Lanes power = Dim == 2 ? dx * dx / safe : dx * dx * dx / (safe * r);
        const Lanes pushed = gather(strength, row.index + k) * power * cut * cut / r;
        const Lanes weight = select(inside, pushed, 0);
        for (int d = 0; d < Dim; ++d) {
            total[d] += weight * load(row.separation[d] + k);
        }
    }
    return lane_sums<Dim>(total);
}

/// How fast repulsion() grows as one particle is displaced from a square lattice (1/m): with g the push,
/// -(1/dim) sum_j [g'(r_j) + (dim - 1) g(r_j)/r_j].
template <int Dim>
double stiffness(double dx, double radius) {
    const int reach = static_cast<int>(radius / dx) + 1;
    const int depth = Dim == 3 ? reach : 0;
    const double step = 1e-5 * dx;
    double total = 0;
    for (int x = -reach; x <= reach; ++x) {
        for (int y = -reach; y <= reach; ++y) {
            for (int z = -depth; z <= depth; ++z) {
                const double r = dx * std::sqrt(x * x + y * y + z * z);
                if (r > 0 && r < radius) {
                    const double slope =
                        (push<Dim>(r + step, dx, radius) - push<Dim>(r - step, dx, radius)) / (2 * step);
                    total -= slope + (Dim - 1) * push<Dim>(r, dx, radius) / r;
                }
            }
        }
    }
    return total / Dim;
}

/// A number in [-1, 1) that looks random, the same for a particle in every run (SplitMix64: Steele, Lea &
/// Flood 2014).
double scattered(int id) {
    std::uint64_t z = (static_cast<std::uint64_t>(id) + 1) * 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111eb;
    return static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1p-52 - 1;
}

template <int Dim>
std::array<double*, Dim> gradient_weights(Fields<Dim>& f, const NeighbourList<Dim>& list, int i) {
    std::array<double*, Dim> weights;
    for (int d = 0; d < Dim; ++d) {
        weights[d] = f.gradient[d].data() + list.row_start(i);
    }
    return weights;
}

/// The renormalised gradient G- and the Morris Laplacian as weights of A_j - A_i; returns the sum of the
/// latter.
template <int Dim>
double renormalised_weights(const Row<Dim>& row, const UniformVolume& volume,
                            const std::array<double*, Dim>& gradient, double* laplacian) {
    const Matrix<Dim> L = renormalisation<Dim>(row, volume);
    for (int k = 0; k < row.padded; k += lane_count) {
        // grad W_ij = F_ij (r_i - r_j), and G- sums V_j (A_j - A_i) grad W_ij.
        const Lanes weight = volume(row.index + k) * load(row.slope + k);
        for (int d = 0; d < Dim; ++d) {
            Lanes component{};
            for (int c = 0; c < Dim; ++c) {
                component += L(d, c) * load(row.separation[c] + k);
            }
            store(gradient[d] + k, weight * component);
        }
    }
    return laplacian_morris_weights<Dim>(row, volume, 0, laplacian);
}

/// Root of the mean square velocity, m/s. Shifts are scaled with it, so that they end with the flow; the
/// largest speed of Xu 2009 would do, too, but its derivative jumps when another particle becomes the
/// fastest.
template <int Dim>
double typical_speed(const Simulation<Dim>& s) {
    const int count = static_cast<int>(s.particles.size());
    const auto u = constant_arrays<Dim>(s.particles.velocity);
    const double squares = deterministic_sum(count, [&](int i) {
        double squared = 0;
        for (int d = 0; d < Dim; ++d) {
            squared += u[d][i] * u[d][i];
        }
        return squared;
    });
    return std::sqrt(squares / count);
}

/// value = min(value, candidate): the same from any number of threads.
void lower(std::atomic<int>& value, int candidate) {
    int seen = value;
    while (candidate < seen && !value.compare_exchange_weak(seen, candidate)) {
    }
}

/// Weights of gradient and Laplacian, and every rate but for the pressure gradient.
template <int Dim>
void evaluate_without_pressure(Simulation<Dim>& s, Fields<Dim>& f) {
    const NeighbourList<Dim>& list = s.neighbours;
    f.poisson.reset(list, s.images);
    s.fill_walls(s.particles.velocity, Parity::velocity);
    s.fill_walls(f.strength, Parity::even);
    for (auto& weights : f.gradient) {
        weights.resize(list.entries());
    }
    const auto u = constant_arrays<Dim>(s.particles.velocity);
    const auto w = arrays<Dim>(f.drift_velocity);
    const auto a = arrays<Dim>(f.acceleration);
    const double mobility = f.mobility * typical_speed(s);
    std::atomic<int> undetermined{list.size()};
    for_each_row(list, [&](int i, const Row<Dim>& row) {
        const auto weights = gradient_weights(f, list, i);
        const auto total =
            f.quadratic
                ? taylor_weights<Dim, 2>(row, s.smoothing_length, weights, f.poisson.weights(i))
                : std::optional(renormalised_weights<Dim>(row, f.volume, weights, f.poisson.weights(i)));
        if (!total) {
            lower(undetermined, i);
            return;
        }
        f.poisson.diagonal(i) = *total;
        const Vector<Dim> shift =
            mobility * repulsion<Dim>(row, f.strength[0], s.particle_spacing, list.support_radius());
        Matrix<Dim> G;
        Vector<Dim> laplacian;
        for (int d = 0; d < Dim; ++d) {
            G.row(d) = gradient_of<Dim>(row, i, weights, u[d]).transpose();
            laplacian[d] = weighted_differences<Dim>(row, i, f.poisson.weights(i), u[d]);
        }
        const Vector<Dim> rate = s.kinematic_viscosity * laplacian + G * shift;
        for (int d = 0; d < Dim; ++d) {
            w[d][i] = u[d][i] + shift[d];
            a[d][i] = rate[d] + s.body_force[d];
        }
        f.divergence_rate[0][i] = f.kappa * G.trace();
        f.poisson.source(i) =
            s.density * ((G * G).trace() - f.lambda * G.trace() - f.divergence_integral[0][i]);
    });
    if (undetermined < list.size()) {
        throw Diverged("the neighbours of particle " + std::to_string(s.particles.id[undetermined]) +
                       " do not determine a quadratic polynomial at t = " + shortest(s.time) + ", step " +
                       std::to_string(s.step));
    }
    s.count_sweeps(5); // normal (or renormalisation) matrix, weights, gradient, Laplacian, repulsion
}

/// w(r, u), a(r, u) and the pressure, on the current neighbour list.
template <int Dim>
void evaluate(Simulation<Dim>& s, Fields<Dim>& f) {
    evaluate_without_pressure(s, f);
    projection::solve_poisson(s, f.poisson, f.pressure);
    s.fill_walls_pressure(f.pressure);
    const auto a = arrays<Dim>(f.acceleration);
    for_each_row(s.neighbours, [&](int i, const Row<Dim>& row) {
        const Vector<Dim> gradient =
            gradient_of<Dim>(row, i, gradient_weights(f, s.neighbours, i), f.pressure[0]);
        for (int d = 0; d < Dim; ++d) {
            a[d][i] -= gradient[d] / s.density;
        }
    });
    s.count_sweeps(1);
}

/// r, u and s from the start of a step to its end, where their rates are still those of the last stage.
template <int Dim>
void integrate(Simulation<Dim>& s, Fields<Dim>& f) {
    constexpr int components = 2 * Dim + 1;
    const int count = static_cast<int>(s.particles.size());
    const std::size_t stages = f.method.b.size();
    const std::array<Field*, 3> state{&s.particles.position, &s.particles.velocity, &f.divergence_integral};
    const std::array<Field*, 3> rate{&f.drift_velocity, &f.acceleration, &f.divergence_rate};
    for (int c = 0; c < components; ++c) {
        f.start.components[c] = state[c / Dim]->components[c % Dim];
        std::fill(f.increment.components[c].begin(), f.increment.components[c].end(), 0.0);
    }
    for (std::size_t k = 0; k < stages; ++k) {
        if (k > 0) {
            const double level = s.time + f.method.a[k - 1] * s.time_step;
            s.set_body_force(level);
            renew_neighbours(s, level);
            evaluate(s, f);
        }
        const bool last = k + 1 == stages;
        for (int c = 0; c < components; ++c) {
            const double* y = f.start[c];
            const double* dy = (*rate[c / Dim])[c % Dim];
            double* total = f.increment[c];
            double* to = (*state[c / Dim])[c % Dim];
            const double b = f.method.b[k];
            const double a = last ? 0 : f.method.a[k];
#pragma omp parallel for simd schedule(static)
            for (int i = 0; i < count; ++i) {
                total[i] += b * dy[i];
                to[i] = y[i] + s.time_step * (last ? total[i] : a * dy[i]);
            }
        }
    }
}

template <int Dim>
void assemble(Simulation<Dim>& s) {
    using Poisson = PressurePoisson<Dim>;
    typename Poisson::Options options;
    options.tolerance = s.settings.number("pressure_tolerance");
    options.symmetric = false;
    Particles<Dim>& particles = s.particles;
    const double rate = s.reference_speed / s.smoothing_length;
    const double radius = s.kernel->support * s.smoothing_length;
    auto fields = std::make_shared<Fields<Dim>>(
        Fields<Dim>{particles.field("pressure", 1, Lifetime::state, "rates"),
                    particles.field("divergence_integral", 1, Lifetime::state, "rates"),
                    particles.field("repulsion_strength", 1, Lifetime::state, "rates"),
                    // State, because a step ends with the rates that the next one starts with.
                    particles.field("drift_velocity", Dim, Lifetime::state, "rates"),
                    particles.field("acceleration", Dim, Lifetime::state, "rates"),
                    particles.field("divergence_rate", 1, Lifetime::state, "rates"),
                    particles.field("step_start", 2 * Dim + 1, Lifetime::scratch, "runge_kutta"),
                    particles.field("step_increment", 2 * Dim + 1, Lifetime::scratch, "runge_kutta"),
                    Poisson(options),
                    {},
                    method_of(s.settings),
                    s.settings.number("divergence_damping") * rate,
                    s.settings.number("divergence_stiffness") * rate * rate,
                    s.settings.number("shift_coefficient") / s.smoothing_length /
                        stiffness<Dim>(s.particle_spacing, radius),
                    s.settings.word("operators") == "quadratic",
                    UniformVolume{s.particle_mass / s.density}});
    for (std::size_t i = 0; i < particles.size(); ++i) {
        fields->strength[0][i] = 1 + s.settings.number("shift_disorder") * scattered(particles.id[i]);
    }
    s.pair_bytes = [fields] {
        std::size_t bytes = fields->poisson.bytes();
        for (const auto& weights : fields->gradient) {
            bytes += weights.capacity() * sizeof(double);
        }
        return bytes;
    };
    s.add_stage("time_step", projection::choose_time_step<Dim>);
    s.add_stage("rates_at_start", [fields](Simulation<Dim>& sim) {
        if (sim.step == 1) {
            find_neighbours(sim, 0);
            evaluate(sim, *fields);
        }
    });
    s.add_stage("runge_kutta", [fields](Simulation<Dim>& sim) { integrate(sim, *fields); });
    s.add_stage("neighbours", [](Simulation<Dim>& sim) {
        sim.positions_time = sim.time + sim.time_step;
        find_neighbours(sim, 0);
    });
    s.add_stage("rates", [fields](Simulation<Dim>& sim) {
        sim.set_body_force(sim.time + sim.time_step);
        evaluate(sim, *fields);
    });
}

} // namespace

const Scheme& isph_mls() {
    static const Scheme scheme{
        .name = "isph_mls",
        .summary =
            "incompressible SPH without projection: quadratic moving least squares, a pressure that keeps "
            "the divergence at zero, Runge-Kutta",
        .formula = "dr/dt = u + du_s; du/dt = -grad p/rho + nu Lap u + (du_s.grad) u; "
                   "Lap p = rho [lambda div u + s - tr(grad u grad u)]; ds/dt = kappa div u; "
                   "du_s = K sum_j b_j (dx/r)^dim (1 - r^2/R^2)^2 r_ij/r",
        .source =
            "this project; pressure equation: Shirokoff & Rosales 2011; moving least squares: Dilts 1999; "
            "shifting: Xu 2009 §2.3",
        .compressible = false,
        .keys = joined(
            common_keys("wendland_c6", 1.8),
            {Key::word("integrator", "heun2", method_names(), "Runge-Kutta method"),
             Key::word(
                 "operators", "quadratic", {"quadratic", "renormalised"},
                 "gradient and Laplacian: quadratic moving least squares, or renormalised G- and Morris"),
             Key::number("divergence_damping", 5, 0, 1e3, "1",
                         "lambda h/U; stable below 2 h/(U dt) with heun2"),
             Key::number(
                 "divergence_stiffness", 6, 0, 1e6, "1",
                 "kappa (h/U)^2; 0 leaves a divergence of O(h^3); critical at a quarter of the damping "
                 "squared"),
             Key::number("shift_coefficient", 1.5, 0, 1e3, "1",
                         "C: a particle displaced by d from a lattice drifts back with C d/h times the root "
                         "mean square velocity"),
             Key::number("shift_disorder", 0.1, 0, 1, "1", "strengths of repulsion lie within 1 -/+ this"),
             Key::number("advective_limit", 0.2, 1e-4, 2, "1", "dt <= this h/u_max"),
             Key::number("viscous_limit", 0.2, 1e-4, 2, "1", "dt <= this h^2/nu"),
             Key::number("pressure_tolerance", 1e-6, 1e-14, 0.1, "1",
                         "relative residual of the pressure solve")}),
        .time_order = time_order,
        .conserves =
            [](const Settings& /*settings*/) {
                return Conserves{false, false, false};
            },
        .assemble_2d = assemble<2>,
        .assemble_3d = assemble<3>,
    };
    return scheme;
}

} // namespace sphvv::solver::schemes
