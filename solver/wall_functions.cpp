#include "sphvv/solver/wall_functions.hpp"

#include "sphvv/solver/simulation.hpp"
#include "sphvv/solver/turbulence/wall_distance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sphvv::solver {

double LogLaw::velocity(double z, double u_star) const {
    return u_star > 0 ? std::max(0., u_star / kappa * std::log(z / zero(u_star))) : 0;
}

/// Newton's method for f(u*) = u* ln(z/z0(u*)) - kappa u. f is convex and rises where z > z0, and the start
/// is above the root, so that every step comes down towards it: at a smooth wall by f(kappa u + e nu'/z) >= 0
/// with z0 = nu'/u*, at a rough one f is linear.
double LogLaw::friction_velocity(double u, double z) const {
    if (!(z > rough)) {
        throw UserError("the velocity is sampled " + shortest(z) +
                        " m from the wall, within z0 = " + shortest(rough) + " m of the wall function");
    }
    if (u <= 0) {
        return 0;
    }
    if (viscous == 0) {
        return kappa * u / std::log(z / rough);
    }
    constexpr double tolerance = 1e-14;
    constexpr int most_steps = 50;
    double u_star = kappa * u + std::numbers::e * viscous / z;
    for (int step = 0; step < most_steps; ++step) {
        const double logarithm = std::log(z / zero(u_star));
        // d ln(1/z0)/d ln u*: 1 at a smooth wall
        const double share = viscous / (u_star * zero(u_star));
        const double change = (u_star * logarithm - kappa * u) / (logarithm + share);
        u_star -= change;
        if (std::abs(change) <= tolerance * u_star) {
            break;
        }
    }
    return u_star;
}

namespace {

/// Back through the periodic sides.
template <int Dim>
Vector<Dim> wrapped(const Box<Dim>& box, Vector<Dim> x) {
    for (int d = 0; d < Dim; ++d) {
        if (box.periodic[d]) {
            x[d] -= box.length(d) * std::floor((x[d] - box.low[d]) / box.length(d));
        }
    }
    return x;
}

/// The velocity at points, sum_j V_j u_j W_j (m/s), over fluid, wall particles and images alike; divided by
/// sum_j V_j W_j with `shepard`.
template <int Dim>
class Sampling {
public:
    Sampling(const Simulation<Dim>& simulation, const double* density, bool shepard_sum)
        : s(simulation), rho(density), shepard(shepard_sum) {}

    Vector<Dim> operator()(const Vector<Dim>& point) {
        const Vector<Dim> x = wrapped(s.box, point);
        const CellGrid<Dim>& grid = s.neighbours.grid();
        std::array<double, Dim> at;
        std::copy(x.begin(), x.end(), at.begin());
        grid.stretches_around(grid.cell_at(at), stretches);
        Vector<Dim> momentum = Vector<Dim>::Zero();
        double weight = 0;
        for (const auto& stretch : stretches) {
            for (int k = stretch.begin; k < stretch.end; ++k) {
                const int j = grid.order()[k];
                const double V_W = s.particle_mass / rho[j] * kernel_at(x, j, stretch.shift);
                momentum += V_W * vector_at<Dim>(s.particles.velocity, j);
                weight += V_W;
            }
        }
        return shepard && weight > 0 ? Vector<Dim>(momentum / weight) : momentum;
    }

private:
    double kernel_at(const Vector<Dim>& x, int j, const std::array<double, Dim>& shift) const {
        Vector<Dim> r = x - vector_at<Dim>(s.particles.position, j);
        for (int d = 0; d < Dim; ++d) {
            r[d] -= shift[d];
        }
        const double q = r.norm() / s.smoothing_length;
        return q < s.kernel->support ? s.kernel->value_scale(Dim, s.smoothing_length) * s.kernel->f(q) : 0;
    }

    const Simulation<Dim>& s;
    const double* rho;
    bool shepard;
    std::vector<typename CellGrid<Dim>::Stretch> stretches;
};

/// The velocity at the edge, relative to the wall, of a wall particle, from the velocity at M.
template <int Dim>
class EdgeVelocity {
public:
    explicit EdgeVelocity(const Simulation<Dim>& simulation)
        : s(simulation), friction(*s.wall_friction), law(friction.law(s.kinematic_viscosity)),
          edge(friction.edge()),
          distance(friction.settings.number("sampling_distance_over_h") * s.smoothing_length),
          imposed(friction.settings.word("edge_velocity") == "imposed"),
          imposed_u_star(friction.settings.number("friction_velocity")) {}

    Vector<Dim> operator()(const Wall<Dim>& wall, const Vector<Dim>& at, Sampling<Dim>& sampled) const {
        const Vector<Dim> n = wall.normal(at);
        const Vector<Dim> foot = at - wall.distance(at) * n;
        const Vector<Dim> u = sampled(foot + distance * n) - wall.velocity(foot, s.time);
        Vector<Dim> along = u - u.dot(n) * n;
        const double speed = along.norm();
        if (speed == 0) {
            return along;
        }
        const double u_star = imposed ? imposed_u_star : law.friction_velocity(speed, edge + distance);
        return law.velocity(edge, u_star) / speed * along;
    }

private:
    const Simulation<Dim>& s;
    const WallFriction& friction;
    LogLaw law;
    double edge;     // m, delta
    double distance; // m, of M from the particle that stands for the edge
    bool imposed;
    double imposed_u_star;
};

template <int Dim>
void update_edge_velocity(Simulation<Dim>& s, Field& density, Field& edge_velocity) {
    s.fill_walls(s.particles.velocity, Parity::velocity);
    s.fill_walls(density, Parity::even);
    const EdgeVelocity<Dim> at_edge(s);
    const bool shepard = s.wall_friction->settings.word("sampling") == "shepard";
    const int fluid = static_cast<int>(s.particles.fluid_size());
    const int count = static_cast<int>(s.particles.size());
#pragma omp parallel
    {
        Sampling<Dim> sampled(s, density[0], shepard);
#pragma omp for schedule(static)
        for (int i = fluid; i < count; ++i) {
            const Wall<Dim>& wall = s.walls[s.wall_particles[s.particles.id[i] - fluid].wall];
            if (wall.slip == Slip::no_slip) {
                const Vector<Dim> u = at_edge(wall, vector_at<Dim>(s.particles.position, i), sampled);
                for (int d = 0; d < Dim; ++d) {
                    edge_velocity[d][i] = u[d];
                }
            }
        }
    }
    s.fill_walls(s.particles.velocity, Parity::velocity);
}

} // namespace

template <int Dim>
void add_wall_function_stage(Simulation<Dim>& s) {
    if (!s.wall_friction) {
        return;
    }
    if (s.wall_method == WallMethod::mirror || s.particles.size() == s.particles.fluid_size()) {
        throw UserError(
            "a wall function needs wall particles with layers behind them; accepted wall methods: "
            "dummy, fixed");
    }
    Field& density = s.particles.field("density", 1, Lifetime::state, "wall_function");
    Field& edge = s.particles.field("edge_velocity", Dim, Lifetime::state, "wall_function");
    s.add_stage("wall_function",
                [&density, &edge](Simulation<Dim>& sim) { update_edge_velocity(sim, density, edge); });
}

template <int Dim>
void add_wall_transport_stage(Simulation<Dim>& s) {
    if (!s.wall_friction || s.wall_friction->settings.word("edge_motion") == "none") {
        return;
    }
    Field& velocity = s.particles.field("edge_velocity", Dim, Lifetime::state, "wall_function");
    Field& moved = s.particles.field("wall_displacement", Dim, Lifetime::state, "wall_function");
    s.add_stage("wall_transport", [&velocity, &moved](Simulation<Dim>& sim) {
        add_scaled<Dim>(moved, sim.time_step, velocity);
    });
}

template void add_wall_function_stage(Simulation<2>&);
template void add_wall_function_stage(Simulation<3>&);
template void add_wall_transport_stage(Simulation<2>&);
template void add_wall_transport_stage(Simulation<3>&);

namespace wall_functions {
const WallFunction& find(std::string_view name) {
    return find_by_name(all(), name, "wall function");
}

std::vector<Key> keys(const WallFunction& function) {
    std::vector<Key> result{
        Key::number("kappa", 0.41, 0.3, 0.5, "1", "von Kármán's constant"),
        Key::number("edge", 1e-3, 1e-12, 1e6, "m",
                    "delta, height over the wall at which the fluid begins; wall particles stand for it"),
        Key::word("edge_velocity", "computed", {"computed", "imposed"},
                  "computed: the law at delta with the u* that it has at M; imposed: with friction_velocity"),
        Key::number("friction_velocity", 0.05, 1e-12, 1e6, "m/s", "u* where something is imposed"),
        Key::number("sampling_distance_over_h", 2, 0, 100, "1",
                    "Delta/h, of M from the wall particle along the normal; none is published"),
        Key::word("edge_motion", "transported", {"transported", "none"},
                  "of wall particles: transported, along flat walls at the velocity of the edge; none"),
        Key::word("sampling", "shepard", {"shepard", "plain"},
                  "velocity at M: plain, sum V u W; shepard, divided by sum V W")};
    result.insert(result.end(), function.keys.begin(), function.keys.end());
    return result;
}
} // namespace wall_functions

} // namespace sphvv::solver
