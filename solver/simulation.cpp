#include "sphvv/solver/simulation.hpp"

#include "sphvv/solver/free_surface/outward_normal.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

namespace sphvv::solver {
namespace {

template <int Dim>
std::string place(const Simulation<Dim>& simulation, int i) {
    std::string text = "particle " + std::to_string(simulation.particles.id[i]) + " at (";
    for (int d = 0; d < Dim; ++d) {
        char number[32];
        std::snprintf(number, sizeof number, "%s%.4g", d == 0 ? "" : ", ",
                      simulation.particles.position[d][i]);
        text += number;
    }
    return text + ")";
}

template <int Dim>
[[noreturn]] void diverge(const Simulation<Dim>& simulation, const std::string& what) {
    char when[80];
    std::snprintf(when, sizeof when, " at t = %.4g, step %lld", simulation.time,
                  static_cast<long long>(simulation.step));
    throw Diverged(what + when);
}

/// First particle for which the predicate holds, or -1.
template <class Predicate>
int first_particle(int count, Predicate&& predicate) {
    for (int i = 0; i < count; ++i) {
        if (predicate(i)) {
            return i;
        }
    }
    return -1;
}

/// First particle whose velocity is not finite, or -1.
template <int Dim>
int first_without_velocity(const Particles<Dim>& particles) {
    return first_particle(static_cast<int>(particles.size()), [&](int k) {
        for (int d = 0; d < Dim; ++d) {
            if (!std::isfinite(particles.velocity[d][k])) {
                return true;
            }
        }
        return false;
    });
}

template <int Dim>
int fastest_particle(const Particles<Dim>& particles) {
    int fastest = 0;
    double largest = -1;
    for (int i = 0; i < static_cast<int>(particles.size()); ++i) {
        double squared = 0;
        for (int d = 0; d < Dim; ++d) {
            squared += particles.velocity[d][i] * particles.velocity[d][i];
        }
        if (squared > largest) {
            largest = squared;
            fastest = i;
        }
    }
    return fastest;
}

/// A scene that starts with a velocity that is no number: told before the step spreads it to the neighbours,
/// or takes it for a limit of its own length.
template <int Dim>
void check_start(const Simulation<Dim>& simulation) {
    const int i = first_without_velocity(simulation.particles);
    if (i >= 0) {
        diverge(simulation, "velocity not finite: " + place(simulation, i));
    }
}

template <int Dim>
void check_survival(const Simulation<Dim>& simulation) {
    const Particles<Dim>& particles = simulation.particles;
    const double energy = kinetic_energy(simulation);
    if (!std::isfinite(energy)) {
        const int i = first_without_velocity(particles);
        diverge(simulation,
                "velocity not finite: " + (i < 0 ? "its square overflows" : place(simulation, i)));
    }
    char text[160];
    if (energy > simulation.survival.kinetic_energy) {
        std::snprintf(text, sizeof text, "kinetic energy %.4g above its bound %.4g (%s), fastest ", energy,
                      simulation.survival.kinetic_energy, simulation.survival.kinetic_energy_reason.c_str());
        diverge(simulation, text + place(simulation, fastest_particle(particles)));
    }
    const double spacing = simulation.neighbours.minimum_distance();
    if (spacing < simulation.survival.minimum_spacing) {
        std::snprintf(text, sizeof text, "minimum spacing %.3f dx below %.3f dx (%s), ",
                      spacing / simulation.particle_spacing,
                      simulation.survival.minimum_spacing / simulation.particle_spacing,
                      simulation.survival.minimum_spacing_reason.c_str());
        diverge(simulation, text + place(simulation, simulation.neighbours.closest_particle()));
    }
}

/// Back to where they belong, as they take part in every step like the others. A wall function may have let
/// them slide along the wall.
template <int Dim>
void hold_wall_particles(Simulation<Dim>& simulation) {
    Particles<Dim>& particles = simulation.particles;
    const std::size_t fluid = particles.fluid_size();
    const Field* moved = simulation.wall_friction ? particles.find("wall_displacement") : nullptr;
    for (std::size_t i = fluid; i < particles.size(); ++i) {
        const WallParticle<Dim>& particle = simulation.wall_particles[particles.id[i] - fluid];
        const auto& displacement = simulation.walls[particle.wall].displacement;
        Vector<Dim> x = particle.position;
        if (displacement) {
            x += displacement(simulation.positions_time);
        }
        for (int d = 0; d < Dim; ++d) {
            particles.position[d][i] = x[d];
        }
        for (int d = 0; d < Dim && moved != nullptr; ++d) {
            particles.position[d][i] += (*moved)[d][i];
        }
    }
    simulation.fill_walls(particles.velocity, Parity::velocity);
}

} // namespace

template <int Dim>
void advance(Simulation<Dim>& simulation) {
    using Clock = std::chrono::steady_clock;
    ++simulation.step;
    if (simulation.step == 1) {
        check_start(simulation);
    }
    simulation.positions_time = simulation.time;
    simulation.in_step = true;
    simulation.set_body_force(simulation.time);
    for (Stage<Dim>& stage : simulation.stages) {
        const auto begin = Clock::now();
        const std::int64_t pairs = simulation.work.pair_evaluations;
        stage.run(simulation);
        stage.pair_evaluations += simulation.work.pair_evaluations - pairs;
        stage.seconds += std::chrono::duration<double>(Clock::now() - begin).count();
    }
    simulation.time += simulation.time_step;
    if (simulation.end_time - simulation.time < 1e-9 * simulation.time_step) {
        simulation.time = simulation.end_time;
    }
    simulation.positions_time = simulation.time;
    simulation.in_step = false;
    hold_wall_particles(simulation);
    simulation.work.particle_steps += static_cast<std::int64_t>(simulation.particles.size());
    check_survival(simulation);
}

template <int Dim>
double even_step(const Simulation<Dim>& simulation, double limit) {
    if (!(limit > 0)) {
        diverge(simulation, "no positive time step is left (limit " + shortest(limit) + ")");
    }
    const double left = simulation.end_time - simulation.time;
    return left / std::max(1.0, std::ceil(left / limit * (1 - 1e-12)));
}

template <int Dim>
void wrap_positions(Simulation<Dim>& simulation) {
    const Box<Dim>& box = simulation.box;
    Particles<Dim>& particles = simulation.particles;
    const int count = static_cast<int>(particles.size());
    const int fluid = static_cast<int>(particles.fluid_size()); // wall particles may lie behind a side
    int lost = count;
#pragma omp parallel for schedule(static) reduction(min : lost)
    for (int i = 0; i < count; ++i) {
        for (int d = 0; d < Dim; ++d) {
            double& x = particles.position[d][i];
            if (x >= box.low[d] && x < box.high[d]) {
                continue;
            }
            if (box.periodic[d]) {
                x -= box.length(d) * std::floor((x - box.low[d]) / box.length(d));
                // Rounding may leave x on, or an ulp outside, the high side.
                x = x >= box.high[d] ? box.low[d] : x;
            }
            if (!(x >= box.low[d] && x <= box.high[d]) && i < fluid) {
                lost = std::min(lost, i);
            }
        }
    }
    if (lost < count) {
        diverge(simulation, "position not finite or outside the domain: " + place(simulation, lost));
    }
}

template <int Dim>
void Simulation<Dim>::fill_walls(Field& field, Parity parity) const {
    const std::size_t fluid = particles.fluid_size();
    const Field* edge = wall_friction ? particles.find("edge_velocity") : nullptr;
    for (std::size_t i = fluid; i < particles.size() && parity != Parity::even && parity != Parity::tensor;
         ++i) {
        const WallParticle<Dim>& particle = wall_particles[particles.id[i] - fluid];
        const Vector<Dim> value = parity == Parity::velocity
                                      ? walls[particle.wall].velocity(particle.position, wall_times().end)
                                      : Vector<Dim>(Vector<Dim>::Zero());
        for (int d = 0; d < Dim; ++d) {
            field[d][i] = value[d];
        }
        for (int d = 0; d < Dim && parity == Parity::velocity && edge != nullptr; ++d) {
            field[d][i] += (*edge)[d][i];
        }
    }
    images.fill(field, parity);
}

template <int Dim>
WallTimes Simulation<Dim>::wall_times() const {
    return {positions_time, time, in_step ? time + time_step : time};
}

template <int Dim>
bool Simulation<Dim>::walls_move() const {
    return std::ranges::any_of(walls,
                               [](const Wall<Dim>& wall) { return static_cast<bool>(wall.displacement); });
}

template <int Dim>
bool Simulation<Dim>::has_wall_pressure_gradient() const {
    return wall_pressure == WallPressure::inertial && !walls.empty() &&
           (body_force != std::array<double, Dim>{} || walls_move());
}

template <int Dim>
void Simulation<Dim>::fill_walls_forced(Field& field, double dt) const {
    fill_walls(field, Parity::velocity);
    if (!has_wall_pressure_gradient()) {
        return;
    }
    const Vector<Dim> share = dt * Eigen::Map<const Vector<Dim>>(body_force.data());
    // The pressure takes it off again, of wall particles as of the fluid.
    const std::size_t fluid = particles.fluid_size();
    for (std::size_t i = fluid; i < particles.size(); ++i) {
        const WallParticle<Dim>& particle = wall_particles[particles.id[i] - fluid];
        const Vector<Dim> own =
            share - dt * walls[particle.wall].acceleration(particle.position, wall_times());
        for (int d = 0; d < Dim; ++d) {
            field[d][i] += own[d];
        }
    }
    images.fill(field, Parity::velocity, share, dt);
}

template <int Dim>
std::vector<double> Simulation<Dim>::wall_pressure_differences() const {
    if (!has_wall_pressure_gradient()) {
        return std::vector<double>(images.size(), 0.0);
    }
    return images.differences(Eigen::Map<const Vector<Dim>>(body_force.data()), density, particles.position);
}

template <int Dim>
void Simulation<Dim>::fill_walls_pressure(Field& pressure) const {
    fill_walls(pressure, Parity::even);
    const std::vector<double> difference = wall_pressure_differences();
    for (std::size_t k = 0; k < difference.size(); ++k) {
        pressure[0][particles.size() + k] += difference[k];
    }
}

namespace {

/// The box, and where it has walls as much more of it as images need.
template <int Dim>
Box<Dim> box_with_images(const Simulation<Dim>& simulation, double radius) {
    Box<Dim> box = simulation.box;
    for (int d = 0; d < Dim; ++d) {
        if (!simulation.walls.empty() && !box.periodic[d]) {
            box.low[d] -= radius;
            box.high[d] += radius;
        }
    }
    return box;
}

template <int Dim>
void make_images_and_list(Simulation<Dim>& simulation, double skin) {
    Particles<Dim>& particles = simulation.particles;
    const double radius = simulation.kernel->support * simulation.smoothing_length * (1 + skin);
    if (!simulation.walls.empty() && simulation.wall_method == WallMethod::mirror) {
        simulation.images.mirror(simulation.walls, radius, simulation.wall_times(), particles);
    } else if (!simulation.walls.empty() && simulation.wall_method == WallMethod::dummy) {
        simulation.images.stack(simulation.walls, simulation.wall_particles, simulation.particle_spacing,
                                radius, simulation.wall_times(), particles);
    }
    simulation.neighbours.build(box_with_images(simulation, radius), *simulation.kernel,
                                simulation.smoothing_length, skin, constant_arrays<Dim>(particles.position),
                                static_cast<int>(particles.size()),
                                static_cast<int>(particles.with_images()));
}

} // namespace

template <int Dim>
void find_neighbours(Simulation<Dim>& simulation, double skin) {
    hold_wall_particles(simulation);
    wrap_positions(simulation);
    Particles<Dim>& particles = simulation.particles;
    const double radius = simulation.kernel->support * simulation.smoothing_length * (1 + skin);
    CellGrid<Dim> grid;
    grid.bin(box_with_images(simulation, radius), radius, constant_arrays<Dim>(particles.position),
             static_cast<int>(particles.size()));
    if (particles.fluid_size() == particles.size()) {
        particles.permute(grid.order());
    } else {
        std::vector<int> order(grid.order().begin(), grid.order().end());
        std::stable_partition(order.begin(), order.end(),
                              [&](int i) { return i < static_cast<int>(particles.fluid_size()); });
        particles.permute(order);
    }
    make_images_and_list(simulation, skin);
}

template <int Dim>
void renew_neighbours(Simulation<Dim>& simulation, double t) {
    simulation.positions_time = t;
    hold_wall_particles(simulation);
    wrap_positions(simulation);
    make_images_and_list(simulation, 0);
}

namespace {

bool lies_at_surface(const FreeSurface& surface, int particle) {
    return surface.at_surface[particle] != 0;
}

/// The particle that a neighbour is, or is an image of.
template <int Dim>
int particle_of(const Simulation<Dim>& s, int neighbour) {
    const int count = static_cast<int>(s.particles.size());
    return neighbour < count ? neighbour : s.images.particle(neighbour - count);
}

/// Height (m) above the particle of a row of the plane through the particles at the surface around it.
template <int Dim>
double height_of_surface_row(const Simulation<Dim>& s, const Row<Dim>& row, const Vector<Dim>& n) {
    using Coefficients = Eigen::Matrix<double, Dim + 1, 1>;
    using Moments = Eigen::Matrix<double, Dim + 1, Dim + 1>;
    const double R = s.neighbours.support_radius();
    Moments A = Moments::Zero();
    Coefficients b = Coefficients::Zero();
    A(0, 0) = 1; // i itself
    for (int k = 0; k < row.count; ++k) {
        if (!lies_at_surface(*s.free_surface, particle_of(s, row.index[k]))) {
            continue;
        }
        Vector<Dim> to;
        for (int d = 0; d < Dim; ++d) {
            to[d] = -row.separation[d][k];
        }
        const double cut = std::max(0., 1 - to.squaredNorm() / (R * R));
        const double height = to.dot(n);
        Coefficients place;
        place << 1, (to - height * n) / R;
        A += cut * cut * place * place.transpose();
        b += cut * cut * height * place;
    }
    // There is nothing along the normal, and too few neighbours may leave more open: a trace of all of it.
    A.diagonal().array() += 1e-9;
    return A.ldlt().solve(b)[0];
}

template <int Dim>
void find_surface_positions(Simulation<Dim>& s) {
    FreeSurface& surface = *s.free_surface;
    const int count = static_cast<int>(s.particles.size());
    surface.depth.assign(count, 0);
    for (int d = 0; d < Dim; ++d) {
        surface.normal[d].assign(count, 0);
    }
    for_each_row(s.neighbours, [&](int i, const Row<Dim>& row) {
        if (!lies_at_surface(surface, i)) {
            return;
        }
        const Vector<Dim> n = outward_normal<Dim>(row, UniformVolume{s.particle_mass / s.density});
        for (int d = 0; d < Dim; ++d) {
            surface.normal[d][i] = n[d];
        }
        const double half = 0.5 * std::pow(surface.volume[i], 1. / Dim);
        surface.depth[i] = n.isZero() ? 0 : std::max(0., half + height_of_surface_row<Dim>(s, row, n));
    });
    s.count_sweeps(1);
}

template <int Dim>
void find_surface_layer(Simulation<Dim>& s) {
    FreeSurface& surface = *s.free_surface;
    surface.near_surface.assign(s.particles.size(), 0);
    const double reach = 4 * s.particle_spacing * s.particle_spacing; // (2 dx)^2
    for_each_row(s.neighbours, [&](int i, const Row<Dim>& row) {
        bool near = lies_at_surface(surface, i);
        for (int k = 0; k < row.count && !near; ++k) {
            double squared = 0;
            for (int d = 0; d < Dim; ++d) {
                squared += row.separation[d][k] * row.separation[d][k];
            }
            near = squared <= reach && lies_at_surface(surface, particle_of(s, row.index[k]));
        }
        surface.near_surface[i] = near ? 1 : 0;
    });
    s.count_sweeps(1);
}

} // namespace

template <int Dim>
void add_surface_stage(Simulation<Dim>& simulation) {
    if (!simulation.free_surface) {
        return;
    }
    simulation.add_stage("free_surface", [](Simulation<Dim>& s) {
        FreeSurface& surface = *s.free_surface;
        surface.at_surface.resize(s.particles.size());
        surface.volume.assign(s.particles.with_images(), s.particle_mass / s.density);
        surface.detector->detect<Dim>({&s.neighbours, surface.volume.data(), s.particle_spacing},
                                      surface.threshold, {surface.at_surface.data()});
        s.count_sweeps(1);
        if (surface.positions) {
            find_surface_positions(s);
        }
        if (surface.layer) {
            find_surface_layer(s);
        }
    });
}

template <int Dim>
double maximum_speed(const Simulation<Dim>& simulation) {
    const Field& u = simulation.particles.velocity;
    const int count = static_cast<int>(simulation.particles.size());
    double largest = 0;
    bool sound = true;
#pragma omp parallel for schedule(static) reduction(max : largest) reduction(&& : sound)
    for (int i = 0; i < count; ++i) {
        double squared = 0;
        for (int d = 0; d < Dim; ++d) {
            squared += u[d][i] * u[d][i];
        }
        largest = std::max(largest, squared);
        sound = sound && !std::isnan(squared);
    }
    return sound ? std::sqrt(largest) : std::numeric_limits<double>::quiet_NaN();
}

template <int Dim>
double kinetic_energy(const Simulation<Dim>& simulation) {
    const Field& u = simulation.particles.velocity;
    return 0.5 * simulation.particle_mass *
           deterministic_sum(static_cast<int>(simulation.particles.fluid_size()), [&](int i) {
               double squared = 0;
               for (int d = 0; d < Dim; ++d) {
                   squared += u[d][i] * u[d][i];
               }
               return squared;
           });
}

template <int Dim>
std::array<double, Dim> momentum(const Simulation<Dim>& simulation) {
    std::array<double, Dim> result;
    for (int d = 0; d < Dim; ++d) {
        const double* u = simulation.particles.velocity[d];
        result[d] =
            simulation.particle_mass * deterministic_sum(static_cast<int>(simulation.particles.fluid_size()),
                                                         [&](int i) { return u[i]; });
    }
    return result;
}

#define SPHVV_INSTANTIATE(Dim)                                                                               \
    template void Simulation<Dim>::fill_walls(Field&, Parity) const;                                         \
    template void Simulation<Dim>::fill_walls_forced(Field&, double) const;                                  \
    template void Simulation<Dim>::fill_walls_pressure(Field&) const;                                        \
    template bool Simulation<Dim>::has_wall_pressure_gradient() const;                                       \
    template WallTimes Simulation<Dim>::wall_times() const;                                                  \
    template std::vector<double> Simulation<Dim>::wall_pressure_differences() const;                         \
    template void advance(Simulation<Dim>&);                                                                 \
    template double even_step(const Simulation<Dim>&, double);                                               \
    template void wrap_positions(Simulation<Dim>&);                                                          \
    template void find_neighbours(Simulation<Dim>&, double);                                                 \
    template void renew_neighbours(Simulation<Dim>&, double);                                                \
    template bool Simulation<Dim>::walls_move() const;                                                       \
    template void add_surface_stage(Simulation<Dim>&);                                                       \
    template double maximum_speed(const Simulation<Dim>&);                                                   \
    template double kinetic_energy(const Simulation<Dim>&);                                                  \
    template std::array<double, Dim> momentum<Dim>(const Simulation<Dim>&);
SPHVV_INSTANTIATE(2)
SPHVV_INSTANTIATE(3)
#undef SPHVV_INSTANTIATE

} // namespace sphvv::solver
