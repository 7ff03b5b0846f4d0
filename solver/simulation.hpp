#pragma once

#include "sphvv/solver/boundaries/images.hpp"
#include "sphvv/solver/boundaries/repulsion.hpp"
#include "sphvv/solver/box.hpp"
#include "sphvv/solver/flow_driver.hpp"
#include "sphvv/solver/free_surface.hpp"
#include "sphvv/solver/neighbours/neighbour_list.hpp"
#include "sphvv/solver/particles.hpp"
#include "sphvv/solver/settings.hpp"
#include "sphvv/solver/turbulence.hpp"
#include "sphvv/solver/wall_functions.hpp"

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace sphvv::solver {

template <int Dim>
struct Simulation;

/// One act of a time step. A scene's stages run in the order in which its scheme put them together.
template <int Dim>
struct Stage {
    std::string name;
    std::function<void(Simulation<Dim>&)> run;
    double seconds = 0;
    std::int64_t pair_evaluations = 0;
};

/// Deterministic measures of what a run did; they do not depend on the machine.
struct Work {
    std::int64_t pair_evaluations = 0;  ///< ordered pairs visited, summed over all sweeps
    std::int64_t solver_iterations = 0; ///< of the linear solver
    std::int64_t matrix_entries = 0;    ///< matrix entries multiplied, summed over iterations
    std::int64_t particle_steps = 0;
};

/// The first condition of survival that a run violated. Ends the run; nothing else does.
struct Diverged : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// What a surviving run must keep to; checked at the end of every step.
struct SurvivalBounds {
    double kinetic_energy = std::numeric_limits<double>::infinity(); ///< J (per metre of depth in 2-D)
    double minimum_spacing = 0;                                      ///< m, between any two particles
    std::string kinetic_energy_reason;
    std::string minimum_spacing_reason;
};

/// The free surface of a scene that has one: which particles lie at it. Found anew in every step. What no
/// scheme asks for is not formed.
struct FreeSurface {
    const Detector* detector;
    double threshold;
    bool positions = false;                      ///< asked for: normal and depth
    bool layer = false;                          ///< asked for: near_surface
    std::vector<std::uint8_t> at_surface{};      ///< 1 or 0, particle by particle
    std::vector<double> volume{};                ///< m^dim
    std::array<std::vector<double>, 3> normal{}; ///< out of the fluid, of particles at the surface
    std::vector<double> depth{};              ///< m, of particles at the surface: how far below it they lie
    std::vector<std::uint8_t> near_surface{}; ///< at the surface, or within 2 dx of a particle that is
};

/// A scene in motion: particles, their neighbours, the stages that advance them, and what has been counted.
template <int Dim>
struct Simulation {
    Simulation(Box<Dim> domain, std::size_t particle_count, std::size_t wall_count = 0)
        : box(domain), particles(particle_count, wall_count) {}

    Box<Dim> box;
    Particles<Dim> particles;
    NeighbourList<Dim> neighbours;
    std::vector<Wall<Dim>> walls;
    /// What the wall particles are, in the order of their identities.
    std::vector<WallParticle<Dim>> wall_particles;
    WallMethod wall_method = WallMethod::mirror;
    WallPressure wall_pressure = WallPressure::inertial;
    Images<Dim> images;                      ///< of particles near walls, made with the neighbour list
    std::optional<Repulsion<Dim>> repulsion; ///< from walls, with WallMethod::repulsive
    Settings settings;                       ///< of the scheme
    const Kernel* kernel = nullptr;

    std::optional<FreeSurface> free_surface;   ///< where the pressure is 0
    std::optional<Turbulence> turbulence;      ///< that adds nu_T to nu
    std::optional<WallFriction> wall_friction; ///< at walls without slip, in place of u = 0
    std::optional<FlowDriver> flow_driver;     ///< that sets a component of body_force

    double particle_spacing = 0;          ///< dx, m
    double smoothing_length = 0;          ///< h, m
    double density = 0;                   ///< reference density rho_0, kg/m3
    double kinematic_viscosity = 0;       ///< nu, m2/s
    double reference_speed = 0;           ///< U, m/s: the largest speed that the scene expects
    std::array<double, Dim> body_force{}; ///< m/s2, the same everywhere
    /// m/s2 at a time (s), of a body force that changes with time; body_force is then its value at the level
    /// in progress.
    std::function<std::array<double, Dim>(double)> body_force_at;
    double particle_mass = 0; ///< kg (per metre of depth in 2-D)

    double time = 0;                 ///< s, at the start of the step in progress
    double positions_time = 0;       ///< s, to which the positions belong: where walls that move are
    bool in_step = false;            ///< a time step has been chosen, and its end not been reached
    double end_time = 0;             ///< s
    double time_step = 0;            ///< s, of the step in progress
    double maximum_acceleration = 0; ///< m/s2, of the last step
    std::int64_t step = 0;
    SurvivalBounds survival;

    std::vector<Stage<Dim>> stages;
    Work work;

    /// What a scheme offers for the budgets of a run; empty where it has no such thing. They may form scratch
    /// fields anew, and leave all else alone.
    std::function<double(const Simulation&)> elastic_energy; ///< of the fluid, J (per metre in 2-D)
    /// |1/2 sum_ij r_ij x f_ij| over the pairs of the last neighbour list, N m (per metre in 2-D): the rate
    /// at which forces between particles change their angular momentum
    std::function<double(const Simulation&)> internal_torque;
    /// Bytes of what a scheme keeps for every pair beside the neighbour list, as the equations of a pressure;
    /// empty where it keeps no such thing.
    std::function<std::size_t()> pair_bytes;

    /// Adds a stage; the pair evaluations that it counts through `count_sweeps` are booked to it.
    void add_stage(std::string name, std::function<void(Simulation&)> run) {
        stages.push_back({std::move(name), std::move(run)});
    }
    /// Brings a body force that changes with time to the time t (s). A step starts with that of its start; a
    /// scheme whose sums are of another level asks for that.
    void set_body_force(double t) {
        if (body_force_at) {
            body_force = body_force_at(t);
        }
    }
    /// Values of a field at wall particles that do not evolve there, and at images: to be called before every
    /// sweep that reads the field at neighbours.
    void fill_walls(Field& field, Parity parity) const;
    /// The same for the velocity u* (m/s), which has the body force's share of the time dt (s) in it.
    void fill_walls_forced(Field& field, double dt) const;
    /// The same for the pressure, Pa.
    void fill_walls_pressure(Field& pressure) const;
    /// By how much the pressure of every image differs from that of its particle, Pa.
    std::vector<double> wall_pressure_differences() const;
    bool walls_move() const; ///< other than along themselves
    /// Whether walls change the pressure from a particle to its images at all.
    bool has_wall_pressure_gradient() const;
    WallTimes wall_times() const;
    /// Books `sweeps` visits of every pair in the neighbour list.
    void count_sweeps(int sweeps) { work.pair_evaluations += sweeps * neighbours.pairs(); }
};

/// Advances one step: every stage in turn, then the conditions of survival. Throws Diverged.
template <int Dim>
void advance(Simulation<Dim>& simulation);

/// Chooses the step so that the end time is met exactly and the last steps are even: with `limit` the largest
/// stable step and T the time left, T / ceil(T / limit).
template <int Dim>
double even_step(const Simulation<Dim>& simulation, double limit);

/// Puts particles that left through a periodic side back in through the opposite one. Throws Diverged if a
/// position is not finite or left through an open side.
template <int Dim>
void wrap_positions(Simulation<Dim>& simulation);

/// Wraps, sorts the particles by cell, makes their images beyond walls, and builds the neighbour list.
template <int Dim>
void find_neighbours(Simulation<Dim>& simulation, double skin);

/// Wraps and makes images and neighbour list anew within a step, of positions that belong to the time t (s),
/// where walls that move are then: the particles keep their order, so that fields formed earlier in the step
/// stay theirs.
template <int Dim>
void renew_neighbours(Simulation<Dim>& simulation, double t);

/// Adds the stage that finds the particles at the free surface, if the scene has one. The surface lies half a
/// particle, V^(1/dim)/2, beyond the plane that fits the outermost particles best: of the particles at the
/// surface within a support of i, weighted with (1 - r^2/R^2)^2, the heights above i along its normal are
/// fitted by a linear function of their places in the tangent plane, which takes the disorder of single
/// particles out.
template <int Dim>
void add_surface_stage(Simulation<Dim>& simulation);

/// Largest |u| over the particles, m/s. NaN if any component is not a number.
template <int Dim>
double maximum_speed(const Simulation<Dim>& simulation);

/// Sum of m |u|^2 / 2 over the fluid in a fixed order, J (per metre of depth in 2-D).
template <int Dim>
double kinetic_energy(const Simulation<Dim>& simulation);

/// Sum of m u over the fluid in a fixed order, kg m/s (per metre of depth in 2-D).
template <int Dim>
std::array<double, Dim> momentum(const Simulation<Dim>& simulation);

/// Components of a vector field as the arrays that sweeps read.
template <int Dim>
std::array<double*, Dim> arrays(Field& field) {
    std::array<double*, Dim> result;
    for (int d = 0; d < Dim; ++d) {
        result[d] = field[d];
    }
    return result;
}

template <int Dim>
std::array<const double*, Dim> constant_arrays(const Field& field) {
    std::array<const double*, Dim> result;
    for (int d = 0; d < Dim; ++d) {
        result[d] = field[d];
    }
    return result;
}

/// Calls body(i, row) for every particle, blocks of particles in parallel. The body may write to particle i
/// only, so the result does not depend on the number of threads.
template <int Dim, class Body>
void for_each_row(const NeighbourList<Dim>& neighbours, Body&& body) {
    constexpr int block = NeighbourList<Dim>::block_size;
#pragma omp parallel for schedule(dynamic, 1)
    for (int b = 0; b < neighbours.block_count(); ++b) {
        const int end = std::min((b + 1) * block, neighbours.size());
        for (int i = b * block; i < end; ++i) {
            body(i, neighbours.row(i));
        }
    }
}

/// Sum of term(i) over 0 <= i < count, formed block by block in a fixed order: the same bits on any number of
/// threads.
template <class Term>
double deterministic_sum(int count, Term&& term) {
    constexpr int block = 1024;
    const int blocks = (count + block - 1) / block;
    std::vector<double> partial(blocks, 0.0);
#pragma omp parallel for schedule(static)
    for (int b = 0; b < blocks; ++b) {
        const int end = std::min((b + 1) * block, count);
        double total = 0;
        for (int i = b * block; i < end; ++i) {
            total += term(i);
        }
        partial[b] = total;
    }
    double total = 0;
    for (const double p : partial) {
        total += p;
    }
    return total;
}

} // namespace sphvv::solver
