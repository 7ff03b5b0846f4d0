// A column of fluid at rest under gravity: compressible by Tait's equation, or incompressible.
//   sphvv verify hydrostatic
//   sphvv verify hydrostatic --scheme wcsph,isph_dfs --set start=uniform --set damping=300 --n 20,40
#include "sphvv/analytic/solutions.hpp"
#include "sphvv/verification/cases.hpp"
#include "sphvv/verification/claims.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace sphvv::verification::cases {
namespace {

using solver::Key;

/// m/s, taken for the sound speed of an incompressible fluid: its column is shorter by gH^2/(2 c^2), 1e-24 m.
constexpr double incompressible = 1e12;

/// sqrt(g H_i), the speed of a fall from half the depth.
double fall_speed(const analytic::Values& values) {
    return std::sqrt(values.at("gravity") * values.at("depth"));
}

void follow_scheme(const SceneRecord& scene, analytic::Values& values) {
    const solver::Settings& settings = scene.scheme_settings;
    values["sound_speed"] =
        scene.scheme->compressible ? settings.number("c0_over_u") * fall_speed(values) : incompressible;
    if (scene.scheme->compressible) {
        values["gamma"] = settings.number("gamma");
    }
}

void before_settling(const SceneRecord& /*scene*/, analytic::Values& values) {
    values["sound_speed"] = incompressible;
}

double depth_of(analytic::Values values) {
    const analytic::Solution& solution = analytic::solutions::find("hydrostatic");
    return analytic::quantity(solution, "settled_depth", values)({}, 0);
}

/// Half rings around the middle of the bed, a spacing apart and of particles as far apart, cut where the
/// period ends; by symmetry the cut is that of a smooth wall.
std::array<std::vector<double>, 2> half_rings(double width, double depth, double dx) {
    std::array<std::vector<double>, 2> points;
    const double reach = std::hypot(width / 2, depth);
    for (int k = 0; (k + 0.5) * dx < reach; ++k) {
        const double radius = (k + 0.5) * dx;
        const long count = std::lround(std::numbers::pi * (k + 0.5));
        for (long j = 0; j < count; ++j) {
            const double angle =
                std::numbers::pi * (static_cast<double>(j) + 0.5) / static_cast<double>(count);
            const double x = width / 2 + radius * std::cos(angle);
            const double y = radius * std::sin(angle);
            // Nearer to the cut, a particle and its image would be a close pair.
            const double margin = dx / 4;
            if (x > margin && x < width - margin && y < depth - margin) {
                points[0].push_back(x);
                points[1].push_back(y);
            }
        }
    }
    return points;
}

/// Where the fluid of the height y lies in the settled column: as much weighs on it.
double settled_height(double y, const analytic::Values& values) {
    analytic::Values above = values;
    above["depth"] = values.at("depth") - y;
    return depth_of(values) - (above["depth"] > 0 ? depth_of(above) : above["depth"]);
}

void arrange(const SceneRecord& scene, std::array<std::vector<double>, 2>& points) {
    const analytic::Values values = solution_values(scene);
    if (scene.case_settings.word("arrangement") == "polar") {
        points = half_rings(values.at("length"), values.at("depth"), spacing_of(scene));
    }
    if (scene.case_settings.word("start") == "exact" && scene.scheme->compressible) {
        for (double& y : points[1]) {
            y = settled_height(y, values);
        }
    }
}

void prepare(const SceneRecord& scene, solver::Simulation<2>& s) {
    const analytic::Values values = solution_values(scene);
    const double mass = values.at("density") * values.at("length") * values.at("depth");
    if (scene.case_settings.word("arrangement") == "polar") {
        s.particle_mass = mass / static_cast<double>(s.particles.fluid_size());
    }
    if (scene.case_settings.word("start") == "uniform") {
        std::ranges::fill(s.particles.field("pressure", 1, solver::Lifetime::state, "scene").components[0],
                          0.);
    }
}

/// u/(1 + Gamma dt), the implicit step of du/dt = -Gamma u. Source: Issa 2005 §3 (explicit there).
void damp(solver::Simulation<2>& s, double rate, double below) {
    const double factor = 1 / (1 + rate * s.time_step);
    const double* y = s.particles.position[1];
    for (std::size_t i = 0; i < s.particles.fluid_size(); ++i) {
        if (y[i] < below) {
            s.particles.velocity[0][i] *= factor;
            s.particles.velocity[1][i] *= factor;
        }
    }
}

void add_damping(const SceneRecord& scene, solver::Simulation<2>& s) {
    const double rate = scene.case_settings.number("damping");
    const double below = scene.case_settings.number("damping_below");
    if (rate > 0) {
        s.add_stage("damping", [rate, below](solver::Simulation<2>& sim) { damp(sim, rate, below); });
    }
}

/// Mean over columns one spacing wide of the highest particle in each, plus half a spacing.
double measured_depth(const SceneRecord& /*scene*/, const solver::Simulation<2>& s) {
    const double width = s.box.high[0] - s.box.low[0];
    std::vector<double> top(static_cast<std::size_t>(std::lround(width / s.particle_spacing)), 0.);
    for (std::size_t i = 0; i < s.particles.fluid_size(); ++i) {
        const double column =
            (s.particles.position[0][i] - s.box.low[0]) / width * static_cast<double>(top.size());
        double& highest = top[std::min(top.size() - 1, static_cast<std::size_t>(std::max(column, 0.)))];
        highest = std::max(highest, s.particles.position[1][i]);
    }
    double total = 0;
    for (const double y : top) {
        total += y;
    }
    return total / static_cast<double>(top.size()) + s.particle_spacing / 2;
}

/// Mean over the particles within a spacing and a quarter of the bed of p + rho0 g y, their pressure carried
/// down to the bed.
double measured_bed_pressure(const SceneRecord& /*scene*/, const solver::Simulation<2>& s) {
    const double* y = s.particles.position[1];
    const double* p = (*s.particles.find("pressure"))[0];
    double total = 0;
    int count = 0;
    for (std::size_t i = 0; i < s.particles.fluid_size(); ++i) {
        if (y[i] < 1.25 * s.particle_spacing) {
            total += p[i] - s.density * s.body_force[1] * y[i];
            ++count;
        }
    }
    return count > 0 ? total / count : 0;
}

/// Kinetic energy over M g H.
double measured_motion(const SceneRecord& scene, const solver::Simulation<2>& s) {
    const double mass = s.particle_mass * static_cast<double>(s.particles.fluid_size());
    return kinetic_energy(s) / (mass * -s.body_force[1] * scene.case_settings.number("depth"));
}

std::vector<Key> keys() {
    return {
        Key::word("start", "exact", {"exact", "uniform"},
                  "exact: particles of equal mass where they lie in the settled column, with its pressure; "
                  "uniform: density rho0 over the depth H_i and no pressure, from which it settles"),
        Key::word("arrangement", "lattice", {"lattice", "jittered", "polar"},
                  "particles at the start; jittered runs five seeds per rung; polar: half rings about the "
                  "middle of the bed"),
        Key::number("damping", 0, 0, 1e9, "1/s", "Gamma in du/dt = -Gamma u, which settles the column"),
        Key::number("damping_below", 1e6, 0, 1e6, "m", "only below this height")};
}

std::vector<Study> studies() {
    return {{.name = "hydrostatic/rest",
             .tier = Tier::quick,
             .schemes = {"wcsph:kernel=quintic_spline", "isph_dfs"},
             .settings = {},
             .ladder = {10, 14, 20, 28, 40},
             .cost = "10 s"}};
}

} // namespace

const Case& hydrostatic() {
    static const Case flow{
        .name = "hydrostatic",
        .summary = "column of fluid at rest on a bed, under a free surface",
        .equations = "rest of a weakly compressible (Tait) or incompressible fluid under gravity, 2-D",
        .source = "Issa 2005 §4.1 (ISSA-STATIC); Oger et al. 2007 (OGER-HYDRO); Asai 2012 §3 (ASAI-HYDRO)",
        .solution = "hydrostatic",
        .reference_length = "depth",
        .leading_key = "start",
        .end_time = 0.1,
        .expectations = {},
        .claims = {},
        .studies = studies(),
        .fields = {"pressure", "density", "velocity"},
        .measures = {{"settled_depth", measured_depth},
                     {"bed_pressure", measured_bed_pressure},
                     {"motion", measured_motion}},
        .keys = keys(),
        .columns = 16,
        .derived = {"sound_speed", "gamma"},
        .profile_direction = 1,
        .hooks = {.values = follow_scheme,
                  .lattice_values = before_settling,
                  .reference_speed = [](const SceneRecord& /*scene*/,
                                        const analytic::Values& values) { return fall_speed(values); },
                  .arrange = arrange,
                  .prepare = prepare,
                  .complete = add_damping},
    };
    return flow;
}

} // namespace sphvv::verification::cases
