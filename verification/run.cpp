#include "sphvv/verification/run.hpp"

#include "sphvv/analytic/solutions.hpp"

#include <omp.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <limits>
#include <stdexcept>

namespace sphvv::verification {
namespace {

using WallClock = std::chrono::steady_clock;

double seconds_since(WallClock::time_point begin) {
    return std::chrono::duration<double>(WallClock::now() - begin).count();
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// For its lifetime, no more threads than the scene has work for. A step of a few thousand particles takes
/// less than waking a thread does on a busy machine. The bits do not depend on it.
class ThreadsFor {
public:
    explicit ThreadsFor(std::size_t particles) : allowed_(omp_get_max_threads()) {
        constexpr std::size_t particles_per_thread = 2000;
        omp_set_num_threads(std::min(allowed_, 1 + static_cast<int>(particles / particles_per_thread)));
    }
    ~ThreadsFor() { omp_set_num_threads(allowed_); }
    ThreadsFor(const ThreadsFor&) = delete;
    ThreadsFor& operator=(const ThreadsFor&) = delete;

private:
    int allowed_;
};

/// Momentum and energies at one time.
template <int Dim>
struct Stock {
    explicit Stock(const solver::Simulation<Dim>& simulation)
        : momentum(solver::momentum(simulation)), kinetic(kinetic_energy(simulation)) {
        if (simulation.elastic_energy) {
            elastic = simulation.elastic_energy(simulation);
        }
    }

    std::array<double, Dim> momentum;
    double kinetic;
    std::optional<double> elastic;
};

/// Says what is claimed, and what of it was lost. Round-off grows with the number of steps: a hundred
/// thousand of them, each wrong by 1e-16 of the momentum that it moves about, stay below 1e-10.
void hold_to(const solver::Conserves& claims, Budget& budget) {
    constexpr double round_off = 1e-10;
    const auto add = [](std::string& list, const char* word) {
        list.append(list.empty() ? "" : ", ").append(word);
    };
    if (claims.momentum) {
        add(budget.claims, "momentum");
        if (!(budget.momentum_drift <= round_off)) {
            add(budget.lost, "momentum");
        }
    }
    if (claims.angular_momentum) {
        add(budget.claims, "angular momentum");
        if (budget.internal_torque && !(*budget.internal_torque <= round_off)) {
            add(budget.lost, "angular momentum");
        }
    }
    if (claims.energy) {
        add(budget.claims, "energy");
    }
    if (budget.claims.empty()) {
        budget.claims = "nothing";
    }
}

template <int Dim>
Budget budget_since(const Stock<Dim>& start, const solver::Simulation<Dim>& simulation,
                    const solver::Scheme& scheme) {
    const Stock<Dim> end(simulation);
    double squared = 0;
    for (int d = 0; d < Dim; ++d) {
        squared += (end.momentum[d] - start.momentum[d]) * (end.momentum[d] - start.momentum[d]);
    }
    const double mass = simulation.particle_mass * static_cast<double>(simulation.particles.fluid_size());
    Budget budget{.momentum_drift = std::sqrt(squared) / (mass * simulation.reference_speed),
                  .kinetic_energy_start = start.kinetic,
                  .kinetic_energy_end = end.kinetic,
                  .elastic_energy_start = start.elastic,
                  .elastic_energy_end = end.elastic,
                  .energy_drift =
                      (end.kinetic + end.elastic.value_or(0) - start.kinetic - start.elastic.value_or(0)) /
                      start.kinetic,
                  .internal_torque = {}};
    if (simulation.internal_torque) {
        budget.internal_torque = simulation.internal_torque(simulation) / start.kinetic;
    }
    // Walls and forces from outside change what an isolated fluid keeps.
    const bool isolated = simulation.walls.empty() && simulation.body_force == std::array<double, Dim>{};
    hold_to(isolated ? scheme.conserves(simulation.settings) : solver::Conserves{false, false, false},
            budget);
    return budget;
}

/// The exact solution of a scene at its fluid particles and its time.
template <int Dim>
struct Exact {
    Exact(const SceneRecord& scene, const solver::Simulation<Dim>& simulation)
        : solution(analytic::solutions::find(scene.flow->solution)), values(solution_values(scene)) {
        const analytic::Evaluator state = solution.bind(values);
        const std::size_t count = simulation.particles.fluid_size();
        states.reserve(count);
        points.reserve(count);
        for (std::size_t i = 0; i < count; ++i) {
            analytic::Vector x{};
            for (int d = 0; d < Dim; ++d) {
                x[d] = simulation.particles.position[d][i];
            }
            points.push_back(x);
            states.push_back(state(x, simulation.time));
        }
    }

    template <class Of>
    std::vector<double> list(const Of& of) const {
        std::vector<double> result(states.size());
        std::ranges::transform(states, result.begin(), of);
        return result;
    }
    std::vector<double> quantity(const std::string& name, double time) const {
        const analytic::Scalar at = analytic::quantity(solution, name, values);
        std::vector<double> result;
        for (const analytic::Vector& x : points) {
            result.push_back(at(x, time));
        }
        return result;
    }

    const analytic::Solution& solution;
    analytic::Values values;
    std::vector<analytic::Vector> points;
    std::vector<analytic::State> states;
};

template <int Dim>
std::vector<double> volumes(const solver::Simulation<Dim>& simulation) {
    std::vector<double> volume(simulation.particles.fluid_size(),
                               simulation.particle_mass / simulation.density);
    if (const solver::Field* density = simulation.particles.find("density")) {
        for (std::size_t i = 0; i < volume.size(); ++i) {
            const double rho = (*density)[0][i];
            // Of a run that has ended early the density may be anything, and the norms need a volume.
            volume[i] = rho > 0 && std::isfinite(rho) ? simulation.particle_mass / rho : volume[i];
        }
    }
    return volume;
}

/// Exact values of a scalar that a case compares.
/// Of a mean over time that a scene forms, the exact values are those of what it is the mean of.
template <int Dim>
std::vector<double> exact_scalar(const std::string& name, const Exact<Dim>& exact, double time) {
    constexpr std::string_view mean = "mean_";
    if (name.starts_with(mean)) {
        return exact_scalar(name.substr(mean.size()), exact, time);
    }
    if (name == "velocity_x") {
        return exact.list([](const analytic::State& state) { return state.velocity[0]; });
    }
    if (name == "pressure") {
        return exact.list([](const analytic::State& state) { return state.pressure; });
    }
    if (name == "density" && exact.states.front().density) {
        return exact.list([](const analytic::State& state) { return *state.density; });
    }
    return exact.quantity(name, time);
}

bool is_meant(const SceneRecord& scene, std::string_view name) {
    const auto& compares = scene.flow->hooks.compares;
    return !compares || compares(scene, name);
}

template <int Dim>
std::vector<FieldError> field_errors(const SceneRecord& scene, const solver::Simulation<Dim>& simulation,
                                     const Exact<Dim>& exact) {
    const auto& particles = simulation.particles;
    const std::size_t count = particles.fluid_size();
    const std::vector<double> volume = volumes(simulation);
    std::vector<FieldError> errors;
    for (const std::string& name : scene.flow->fields) {
        const solver::Field* field = particles.find(name);
        if (!is_meant(scene, name)) {
            continue;
        }
        if (name == "velocity") {
            std::array<std::vector<double>, Dim> velocity;
            std::vector<std::span<const double>> ours;
            std::vector<std::span<const double>> theirs;
            for (int d = 0; d < Dim; ++d) {
                velocity[d] = exact.list([d](const analytic::State& state) { return state.velocity[d]; });
                ours.emplace_back((*field)[d], count);
                theirs.emplace_back(velocity[d]);
            }
            errors.push_back({name, vector_norms(ours, theirs, volume)});
        } else if (field != nullptr) { // an incompressible scheme has no density to compare
            const std::vector<double> theirs = exact_scalar(name, exact, simulation.time);
            const std::span<const double> ours((*field)[0], count);
            errors.push_back({name, name == "pressure" && !simulation.free_surface
                                        ? scalar_norms_up_to_a_constant(ours, theirs, volume)
                                        : scalar_norms(ours, theirs, volume)});
        }
    }
    return errors;
}

Norms norms_of_a_number(double ours, double exact) {
    const double error = std::abs(ours - exact);
    const bool relative = std::abs(exact) > 1e-300;
    const double share = relative ? error / std::abs(exact) : error;
    return {share, share, share, error, error, error, relative};
}

/// Holds the particles at their current positions against the exact solution at the current time.
template <int Dim>
Deviation compare(const SceneRecord& scene, const solver::Simulation<Dim>& simulation) {
    const Exact<Dim> exact(scene, simulation);
    Deviation deviation{.time = simulation.time,
                        .errors = field_errors(scene, simulation, exact),
                        .maximum_speed = maximum_speed(simulation),
                        .energy_error = std::numeric_limits<double>::quiet_NaN()};
    if constexpr (Dim == 2) {
        for (const Measure& measure : scene.flow->measures) {
            if (!is_meant(scene, measure.name)) {
                continue;
            }
            const double theirs =
                analytic::quantity(exact.solution, measure.quantity.empty() ? measure.name : measure.quantity,
                                   exact.values)(measure.at, simulation.time);
            deviation.errors.push_back(
                {measure.name, norms_of_a_number(measure.ours(scene, simulation), theirs)});
        }
    }
    for (const analytic::State& state : exact.states) {
        double squared = 0;
        for (int d = 0; d < Dim; ++d) {
            squared += state.velocity[d] * state.velocity[d];
        }
        deviation.maximum_speed_exact = std::max(deviation.maximum_speed_exact, std::sqrt(squared));
    }
    if (exact.solution.kinetic_energy != nullptr) {
        const double mass = simulation.particle_mass * static_cast<double>(simulation.particles.fluid_size());
        deviation.energy_error = kinetic_energy(simulation) /
                                     (mass * exact.solution.kinetic_energy(exact.values, simulation.time)) -
                                 1;
    }
    return deviation;
}

std::vector<Profile> profiles_of(const SceneRecord& scene, const solver::Simulation<2>& simulation) {
    const Exact<2> exact(scene, simulation);
    const std::size_t count = simulation.particles.fluid_size();
    const int direction = scene.flow->profile_direction;
    const double* coordinate = simulation.particles.position[direction];
    std::vector<Profile> profiles;
    for (const std::string& name : scene.flow->fields) {
        const solver::Field* field = simulation.particles.find(name);
        if (field == nullptr) {
            continue;
        }
        Profile profile{
            name == "velocity" ? "velocity_x" : name, std::vector<double>(coordinate, coordinate + count),
            std::vector<double>((*field)[0], (*field)[0] + count),
            name == "velocity" ? exact.list([](const analytic::State& state) { return state.velocity[0]; })
                               : exact_scalar(name, exact, simulation.time)};
        profiles.push_back(std::move(profile));
    }
    return profiles;
}

Picture picture_of(const solver::Simulation<2>& simulation) {
    const auto& particles = simulation.particles;
    const auto copy = [&](const double* values) {
        return std::vector<double>(values, values + particles.fluid_size());
    };
    Picture picture{.time = simulation.time,
                    .x = copy(particles.position[0]),
                    .y = copy(particles.position[1]),
                    .speed = copy(particles.velocity[0]),
                    .pressure = copy((*particles.find("pressure"))[0]),
                    .box = {simulation.box.low[0], simulation.box.high[0], simulation.box.low[1],
                            simulation.box.high[1]}};
    for (std::size_t i = 0; i < particles.fluid_size(); ++i) {
        picture.speed[i] = std::hypot(particles.velocity[0][i], particles.velocity[1][i]);
    }
    // What the box has above a free surface is room, not domain.
    for (int d = 0; d < 2; ++d) {
        if (simulation.free_surface && !simulation.box.periodic[d]) {
            const std::vector<double>& x = d == 0 ? picture.x : picture.y;
            picture.box[2 * d + 1] =
                std::min(simulation.box.high[d], *std::ranges::max_element(x) + simulation.particle_spacing);
        }
    }
    return picture;
}

template <int Dim>
void describe(const solver::Simulation<Dim>& simulation, RunRecord& record) {
    for (const auto& stage : simulation.stages) {
        record.stages.push_back({stage.name, stage.seconds, stage.pair_evaluations});
    }
    for (const solver::Field& field : simulation.particles.fields()) {
        std::string asked_by;
        for (const std::string& who : field.asked_by) {
            asked_by += (asked_by.empty() ? "" : ", ") + who;
        }
        record.fields.push_back({field.name, static_cast<double>(field.bytes_per_particle()), asked_by});
    }
    record.bytes_per_particle = static_cast<double>(simulation.particles.bytes_per_particle());
    const auto share = [&](std::size_t bytes) {
        return static_cast<double>(bytes) / static_cast<double>(simulation.particles.size());
    };
    record.neighbour_bytes_per_particle = share(simulation.neighbours.bytes());
    record.pair_bytes_per_particle = simulation.pair_bytes ? share(simulation.pair_bytes()) : 0;
}

template <int Dim>
EndState end_of(const solver::Simulation<Dim>& simulation) {
    const auto& particles = simulation.particles;
    const solver::Field& pressure = *particles.find("pressure");
    EndState end{std::vector(Dim, std::vector<double>(particles.fluid_size())),
                 std::vector<double>(particles.fluid_size())};
    for (std::size_t k = 0; k < particles.fluid_size(); ++k) {
        const int i = particles.id[k];
        for (int d = 0; d < Dim; ++d) {
            end.velocity[d][i] = particles.velocity[d][k];
        }
        end.pressure[i] = pressure[0][k];
    }
    return end;
}

template <int Dim>
RunRecord run_once(const SceneRecord& scene, const Progress& progress, EndState* end) {
    const auto begin = WallClock::now();
    solver::Simulation<Dim> simulation = build_scene<Dim>(scene);
    const double setup_seconds = seconds_since(begin);
    RunRecord record = step_to_end(simulation, scene, progress);
    record.setup_seconds = setup_seconds;
    if (end != nullptr) {
        *end = end_of(simulation);
    }
    return record;
}

RunRecord run_once(const SceneRecord& scene, const Progress& progress, EndState* end = nullptr) {
    return dimension(scene) == 2 ? run_once<2>(scene, progress, end) : run_once<3>(scene, progress, end);
}

bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

void check_repeat(const RunRecord& first, const RunRecord& again) {
    bool same = first.steps == again.steps && first.errors.size() == again.errors.size() &&
                first.diagnosis == again.diagnosis;
    for (std::size_t k = 0; same && k < first.errors.size(); ++k) {
        const Norms& a = first.errors[k].norms;
        const Norms& b = again.errors[k].norms;
        same = same_bits(a.l1_abs, b.l1_abs) && same_bits(a.l2_abs, b.l2_abs) &&
               same_bits(a.linf_abs, b.linf_abs);
    }
    if (!same) {
        throw std::logic_error("two runs of " + first.scheme + " at n = " + std::to_string(first.n) +
                               " differ: the solver is not repeatable");
    }
}

} // namespace

const Norms* Deviation::find(std::string_view name) const {
    const auto found = std::ranges::find(errors, name, &FieldError::field);
    return found == errors.end() ? nullptr : &found->norms;
}

template <int Dim>
RunRecord step_to_end(solver::Simulation<Dim>& simulation, const SceneRecord& scene,
                      const Progress& progress) {
    RunRecord record;
    const ThreadsFor threads(simulation.particles.size());
    record.scheme = scene.label;
    record.n = scene.n;
    record.seed = scene.seed;
    record.h = simulation.smoothing_length;
    record.dx = simulation.particle_spacing;
    record.particles = simulation.particles.fluid_size();
    record.minimum_spacing = std::numeric_limits<double>::infinity();
    std::vector<double> time_steps;
    const Stock<Dim> start(simulation);
    record.survived = true;
    constexpr int marks = 40;
    int next_mark = 1;
    while (record.survived && simulation.time < simulation.end_time) {
        const auto step = WallClock::now();
        const std::clock_t cpu = std::clock();
        try {
            advance(simulation);
            time_steps.push_back(simulation.time_step);
        } catch (const solver::Diverged& diverged) {
            record.survived = false;
            record.diagnosis = diverged.what();
        }
        record.seconds += seconds_since(step);
        record.cpu_seconds += static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
        record.minimum_spacing =
            std::min(record.minimum_spacing, simulation.neighbours.minimum_distance() / record.dx);
        if (record.survived && simulation.time >= next_mark * simulation.end_time / marks) {
            record.history.push_back(compare(scene, simulation));
            record.history.back().minimum_spacing = record.minimum_spacing;
            next_mark = static_cast<int>(simulation.time / simulation.end_time * marks) + 1;
        }
        if (record.survived && progress) {
            progress(simulation.time / simulation.end_time);
        }
    }
    record.time = simulation.time;
    record.steps = simulation.step;
    record.time_step = time_steps.empty() ? simulation.time_step : median(time_steps);
    record.prescribed_time_step = scene.scheme_settings.number("time_step");
    record.work = simulation.work;
    record.budget = budget_since(start, simulation, *scene.scheme);
    if (record.history.empty() || record.history.back().time < simulation.time) {
        record.history.push_back(compare(scene, simulation));
        record.history.back().minimum_spacing = record.minimum_spacing;
    }
    const Deviation& end = record.history.back();
    record.maximum_speed_error = end.maximum_speed / end.maximum_speed_exact - 1;
    record.energy_error = end.energy_error;
    if (record.survived) {
        record.errors = end.errors;
    }
    if constexpr (Dim == 2) {
        if (scene.picture) {
            record.picture = picture_of(simulation);
            if (scene.flow->profile_direction >= 0) {
                record.profiles = profiles_of(scene, simulation);
            }
        }
    }
    describe(simulation, record);
    for (const solver::Settings* settings : {&scene.case_settings, &scene.scheme_settings}) {
        for (const solver::Key& key : settings->keys()) {
            record.settings.emplace_back(key.name, key.value);
        }
    }
    return record;
}

template RunRecord step_to_end(solver::Simulation<2>&, const SceneRecord&, const Progress&);
template RunRecord step_to_end(solver::Simulation<3>&, const SceneRecord&, const Progress&);

std::vector<FieldError> differences(const EndState& end, const EndState& reference) {
    const std::vector<double> volume(end.pressure.size(), 1);
    const std::vector<std::span<const double>> ours(end.velocity.begin(), end.velocity.end());
    const std::vector<std::span<const double>> theirs(reference.velocity.begin(), reference.velocity.end());
    return {{"velocity", vector_norms(ours, theirs, volume)},
            {"pressure", scalar_norms_up_to_a_constant(end.pressure, reference.pressure, volume)}};
}

RunRecord run_scene_once(const SceneRecord& scene, EndState& end, const Progress& progress) {
    return run_once(scene, progress, &end);
}

RunRecord run_scene(const SceneRecord& scene, const Progress& progress) {
    std::vector<RunRecord> runs{run_once(scene, progress)};
    constexpr double repeat_below = 0.5; // seconds
    if (runs[0].seconds < repeat_below) {
        for (int repeat = 0; repeat < 2; ++repeat) {
            runs.push_back(run_once(scene, progress));
            check_repeat(runs[0], runs.back());
        }
    }
    std::sort(runs.begin(), runs.end(),
              [](const RunRecord& a, const RunRecord& b) { return a.seconds < b.seconds; });
    RunRecord result = runs[runs.size() / 2];
    result.repeats = static_cast<int>(runs.size());
    result.seconds_spread = runs.back().seconds / runs.front().seconds - 1;
    return result;
}

} // namespace sphvv::verification
