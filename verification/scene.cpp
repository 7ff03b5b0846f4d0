#include "sphvv/verification/scene.hpp"

#include "sphvv/analytic/solutions.hpp"
#include "sphvv/solver/arrangements.hpp"
#include "sphvv/verification/particle_sets.hpp"

#include <algorithm>
#include <cmath>

namespace sphvv::verification {
namespace {

using solver::Key;
using solver::shortest;

bool declares(std::span<const Key> keys, std::string_view name) {
    return std::any_of(keys.begin(), keys.end(), [&](const Key& key) { return key.name == name; });
}

std::string key_names(std::span<const Key> keys) {
    std::string names;
    for (const Key& key : keys) {
        names += (names.empty() ? "" : ", ") + key.name;
    }
    return names;
}

constexpr double largest_particle_count = 2e7; // about 20 GB with the neighbour lists of a 3-D scene

template <int Dim>
solver::Box<Dim> box_of(const analytic::Domain& domain) {
    solver::Box<Dim> box;
    for (int d = 0; d < Dim; ++d) {
        box.low[d] = domain.low[d];
        box.high[d] = domain.high[d];
        box.periodic[d] = domain.periodic[d];
    }
    return box;
}

int tile_of(int dimension) {
    return dimension == 2 ? settled_tile<2> : settled_tile<3>;
}

/// A settled tile is repeated in a cube.
void check_settled(const SceneRecord& scene, const analytic::Domain& domain, int dimension,
                   const std::string& where) {
    const double length = scene.case_settings.number(scene.flow->reference_length);
    for (int d = 0; d < dimension; ++d) {
        if (std::abs(domain.high[d] - domain.low[d] - length) > 1e-9 * length) {
            throw UserError(where + ": a settled start needs a box whose sides are all the reference length; "
                                    "accepted: arrangement=lattice, arrangement=jittered");
        }
    }
    if (scene.n % tile_of(dimension) != 0) {
        throw UserError(where + ": a settled start repeats a tile of " + std::to_string(tile_of(dimension)) +
                        " spacings; give a multiple of it");
    }
}

template <int Dim>
std::array<std::vector<double>, Dim> settled_points(const solver::Box<Dim>& box, const SceneRecord& scene) {
    auto points = particle_set<Dim>(Arrangement::settled, scene.n, 0, scene.seed).points;
    for (int d = 0; d < Dim; ++d) {
        for (double& x : points[d]) {
            x = box.low[d] + (box.high[d] - box.low[d]) * x;
        }
    }
    return points;
}

} // namespace

analytic::Values solution_values(const SceneRecord& scene) {
    analytic::Values values;
    for (const analytic::Parameter& p : analytic::solutions::find(scene.flow->solution).parameters) {
        values.emplace(p.name, scene.case_settings.number(p.name));
    }
    return values;
}

int dimension(const SceneRecord& scene) {
    return analytic::solutions::find(scene.flow->solution).dimension;
}

std::string Variant::label() const {
    std::string text(scheme->name);
    for (const auto& [key, value] : settings) {
        text.append(":").append(key).append("=").append(value);
    }
    return text;
}

Variant variant_of(std::string_view text) {
    const std::size_t colon = std::min(text.find(':'), text.size());
    Variant variant(&solver::schemes::find(text.substr(0, colon)));
    for (std::size_t at = colon; at < text.size();) {
        const std::size_t next = std::min(text.find(':', at + 1), text.size());
        const std::string_view assignment = text.substr(at + 1, next - at - 1);
        const std::size_t equals = assignment.find('=');
        if (equals == std::string_view::npos || equals == 0 || equals + 1 == assignment.size()) {
            throw UserError("scheme '" + std::string(text) + "': '" + std::string(assignment) +
                            "' is not of the form KEY=VALUE; accepted: SCHEME[:KEY=VALUE…]");
        }
        const auto [key, value] = std::pair{assignment.substr(0, equals), assignment.substr(equals + 1)};
        if (!variant.settings.emplace(std::string(key), std::string(value)).second) {
            throw UserError("scheme '" + std::string(text) + "': the key '" + std::string(key) +
                            "' is given twice");
        }
        at = next;
    }
    return variant;
}

SceneRecord resolve_scene(const Case& flow, const Variant& variant, const solver::Assignments& given, int n,
                          std::span<const Key> also_known) {
    const solver::Scheme& scheme = *variant.scheme;
    const std::vector<Key> of_case = case_keys(flow);
    solver::Assignments to_case;
    solver::Assignments to_scheme;
    solver::Assignments all = variant.settings;
    all.insert(given.begin(), given.end());
    for (const auto& [key, value] : all) {
        if (declares(of_case, key)) {
            to_case[key] = value;
        } else if (declares(scheme.keys, key)) {
            to_scheme[key] = value;
        } else if (variant.settings.contains(key) || !declares(also_known, key)) {
            throw UserError("there is no key '" + key + "'; the case " + std::string(flow.name) + " takes " +
                            key_names(of_case) + "; the scheme " + std::string(scheme.name) + " takes " +
                            key_names(scheme.keys));
        }
    }
    return {.flow = &flow,
            .scheme = &scheme,
            .label = variant.label(),
            .case_settings = solver::Settings(of_case, to_case),
            .scheme_settings = solver::Settings(scheme.keys, to_scheme),
            .n = n};
}

void check_scene(const SceneRecord& scene) {
    const analytic::Solution& solution = analytic::solutions::find(scene.flow->solution);
    const analytic::Domain domain = solution.domain(solution_values(scene));
    const double length = scene.case_settings.number(scene.flow->reference_length);
    const double dx = length / scene.n;
    const solver::Kernel& kernel = solver::kernels::find(scene.scheme_settings.word("kernel"));
    const double support = kernel.support * scene.scheme_settings.number("h_over_dx") * dx;
    const std::string where = "n = " + std::to_string(scene.n) + " for " + std::string(scene.scheme->name) +
                              " on " + std::string(scene.flow->name);
    double particles = 1;
    for (int d = 0; d < solution.dimension; ++d) {
        const double side = domain.high[d] - domain.low[d];
        particles *= side / dx;
        if (side < 2 * support * (1 - 1e-12)) {
            throw UserError(
                where + ": a periodic box must hold two kernel supports of " + shortest(support / dx) +
                " dx each; give n >= " + shortest(std::ceil(2 * support / side * scene.n - 1e-9)));
        }
    }
    if (scene.case_settings.word("arrangement") == "settled") {
        check_settled(scene, domain, solution.dimension, where);
    }
    if (particles > largest_particle_count) {
        throw UserError(where + " makes " + shortest(std::round(particles)) + " particles; at most " +
                        shortest(largest_particle_count) + " are accepted");
    }
}

template <int Dim>
solver::Simulation<Dim> build_scene(const SceneRecord& scene) {
    const analytic::Solution& solution = analytic::solutions::find(scene.flow->solution);
    const analytic::Values values = solution_values(scene);
    const analytic::Medium medium = solution.medium(values);
    const analytic::Evaluator exact = solution.bind(values);
    const solver::Box<Dim> box = box_of<Dim>(solution.domain(values));
    const double dx = scene.case_settings.number(scene.flow->reference_length) / scene.n;
    const double h = scene.scheme_settings.number("h_over_dx") * dx;
    const solver::Kernel& kernel = solver::kernels::find(scene.scheme_settings.word("kernel"));
    check_scene(scene);

    const std::string& arrangement = scene.case_settings.word("arrangement");
    auto points = arrangement == "settled" ? settled_points<Dim>(box, scene) : solver::lattice<Dim>(box, dx);
    if (arrangement == "jittered") {
        solver::jitter<Dim>(points, scene.case_settings.number("jitter") * dx, scene.seed);
    }
    solver::Simulation<Dim> simulation(box, points[0].size());
    simulation.settings = scene.scheme_settings;
    simulation.kernel = &kernel;
    simulation.particle_spacing = dx;
    simulation.smoothing_length = h;
    simulation.density = medium.density;
    simulation.kinematic_viscosity = medium.kinematic_viscosity;
    simulation.reference_speed = medium.maximum_speed;
    simulation.particle_mass = medium.density * box.volume() / static_cast<double>(points[0].size());
    simulation.end_time = scene.case_settings.number("end_time");
    simulation.survival = {
        .kinetic_energy = scene.case_settings.number("maximum_energy") * medium.density * box.volume() *
                          solution.kinetic_energy(values, 0),
        .minimum_spacing = scene.case_settings.number("minimum_spacing") * dx,
        .kinetic_energy_reason =
            scene.case_settings.text("maximum_energy") + " times its start value in an undriven flow",
        .minimum_spacing_reason = "arrangement lost",
    };
    solver::Particles<Dim>& particles = simulation.particles;
    solver::Field& pressure = particles.field("pressure", 1, solver::Lifetime::state, "scene");
    for (int d = 0; d < Dim; ++d) {
        particles.position.components[d] = points[d];
    }
    solver::wrap_positions(simulation); // a jittered particle may have left the box
    for (std::size_t i = 0; i < particles.size(); ++i) {
        analytic::Vector x{};
        for (int d = 0; d < Dim; ++d) {
            x[d] = particles.position[d][i];
        }
        const analytic::State state = exact(x, 0);
        for (int d = 0; d < Dim; ++d) {
            particles.velocity[d][i] = state.velocity[d];
        }
        pressure[0][i] = state.pressure;
    }
    scene.scheme->assemble(simulation);
    return simulation;
}

template solver::Simulation<2> build_scene<2>(const SceneRecord&);
template solver::Simulation<3> build_scene<3>(const SceneRecord&);

} // namespace sphvv::verification
