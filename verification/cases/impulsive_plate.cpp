#include "sphvv/verification/cases.hpp"
#include "sphvv/verification/claims.hpp"
#include "sphvv/verification/scene.hpp"

#include <algorithm>
#include <cmath>

namespace sphvv::verification::cases {
namespace {

using Runs = std::span<const RunRecord>;
using MaybeFinding = std::optional<Claim::Finding>;
using solver::Simulation;

double plate_position(const SceneRecord& scene, const Simulation<2>& s) {
    return scene.case_settings.number("speed") * s.time;
}

/// Height of the uppermost particle within dx of the distance x (m) from the plate, and half a particle,
/// above the depth at the start; -depth where there is none.
double elevation_at(const SceneRecord& scene, const Simulation<2>& s, double x) {
    double top = 0;
    const double place = plate_position(scene, s) + x;
    for (std::size_t i = 0; i < s.particles.fluid_size(); ++i) {
        if (std::abs(s.particles.position[0][i] - place) <= s.particle_spacing) {
            top = std::max(top, s.particles.position[1][i] + s.particle_spacing / 2);
        }
    }
    return top - scene.case_settings.number("depth");
}

/// Integral of the elevation from the plate to the end of the box (m2), by the midpoint rule over strips as
/// wide as a particle.
double raised_volume(const SceneRecord& scene, const Simulation<2>& s) {
    const double length = scene.case_settings.number("length") - plate_position(scene, s);
    const int strips = static_cast<int>(std::lround(length / s.particle_spacing));
    double total = 0;
    for (int k = 0; k < strips; ++k) {
        total += elevation_at(scene, s, (k + 0.5) * length / strips) * length / strips;
    }
    return total;
}

/// Momentum of the fluid (kg m/s per metre): what the plate, and the bed, have given it.
double momentum(const Simulation<2>& s, int direction) {
    return solver::momentum(s)[direction];
}

std::vector<Measure> measures() {
    std::vector<Measure> all{
        {.name = "plate_impulse",
         .ours = [](const SceneRecord&, const Simulation<2>& s) { return momentum(s, 0); }},
        {.name = "bed_impulse",
         .ours = [](const SceneRecord&, const Simulation<2>& s) { return momentum(s, 1); }},
        {.name = "displaced_volume", .ours = raised_volume},
    };
    for (const double x : {0.1, 0.2, 0.3, 0.5}) {
        all.push_back({.name = "elevation_" + number(x, "%.1f"),
                       .ours = [x](const SceneRecord& scene,
                                   const Simulation<2>& s) { return elevation_at(scene, s, x); },
                       .quantity = "elevation",
                       .at = {x, 0, 0}});
    }
    return all;
}

/// int p dt, particle by particle.
void add_impulse(const SceneRecord& /*scene*/, Simulation<2>& simulation) {
    solver::Field& impulse = simulation.particles.field("impulse", 1, solver::Lifetime::state, "impulse");
    simulation.add_stage("impulse", [&impulse](Simulation<2>& s) {
        solver::add_scaled<1>(impulse, s.time_step, *s.particles.find("pressure"));
    });
}

constexpr const char* published = "isph_dfs:laplacian=schwaiger:viscosity=morris";
constexpr const char* improved =
    "isph_dfs:laplacian=schwaiger:viscosity=morris:surface_pressure=true_position";

} // namespace

const Case& impulsive_plate() {
    static const Case flow{
        .name = "impulsive_plate",
        .summary = "plate that is set going into still water, without gravity: impulse and first elevation",
        .equations = "Euler equations in 2-D with a free surface",
        .source = "Peregrine 1972; Xu 2009 §6.4 (XU-PADDLE)",
        .solution = "impulsive_plate",
        .reference_length = "depth",
        .leading_key = "speed",
        .end_time = 1e-6,
        .expectations = {},
        .claims = {},
        .studies = {{.name = "impulsive_plate/first_step",
                     .tier = Tier::quick,
                     .schemes = {published, improved},
                     .settings = {{"speed", "1"}},
                     .ladder = {10, 14, 20, 28, 40},
                     .cost = "10 s",
                     .picture_at = 40}},
        .fields = {"impulse", "velocity"},
        .measures = measures(),
        .closed = {{0, true}},
        .starts_at_rest = true,
        .hooks = {.reference_speed = [](const SceneRecord& /*scene*/,
                                        const analytic::Values& values) { return values.at("speed"); },
                  .complete = add_impulse},
    };
    return flow;
}

} // namespace sphvv::verification::cases
