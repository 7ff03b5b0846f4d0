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

/// Impulse and velocity are those of the first instant; elevations are of later ones.
bool first_instant(const SceneRecord& scene) {
    return scene.case_settings.number("end_time") * scene.case_settings.number("speed") <=
           1e-3 * scene.case_settings.number("depth");
}

bool compares(const SceneRecord& scene, std::string_view name) {
    const bool of_later = name == "displaced_volume" || name.starts_with("elevation");
    return of_later != first_instant(scene);
}

const std::string with_ls = "isph_dfs:laplacian=schwaiger:viscosity=morris";
const std::string improved = with_ls + ":surface_pressure=true_position";
const std::string published = with_ls + ":wall_pressure=even";

std::string damped(const std::string& scheme, const char* peclet) {
    return scheme + ":surface_peclet=" + peclet;
}

std::map<std::string, std::string> variant_names() {
    std::map<std::string, std::string> names{
        {with_ls, "isph_dfs, p = 0 at the particles"},
        {improved, "isph_dfs, p = 0 at the surface"},
        {published, "isph_dfs, even pressure at walls"},
        {damped(improved, "30"), "isph_dfs, p = 0 at the surface, Pe 30"}};
    for (const char* peclet : {"7", "30", "150"}) {
        names[damped(with_ls, peclet)] = std::string("isph_dfs, p = 0 at the particles, Pe ") + peclet;
    }
    return names;
}

/// Largest relative error of the elevations at 0.2, 0.3 and 0.5 m from the plate at a time.
double elevation_error(const Deviation& at) {
    double largest = 0;
    for (const char* name : {"elevation_0.2", "elevation_0.3", "elevation_0.5"}) {
        const Norms* norms = at.find(name);
        largest = std::max(largest, norms == nullptr ? std::nan("") : norms->l2);
    }
    return largest;
}

/// The mark of a history nearest to the time.
const Deviation& mark_at(const RunRecord& run, double time) {
    return *std::ranges::min_element(run.history, {},
                                     [&](const Deviation& d) { return std::abs(d.time - time); });
}

/// Elevations at the four instants Ut/d = 0.08, 0.16, 0.24, 0.32 of one speed.
MaybeFinding elevations(Runs runs, const std::string& scheme, int n) {
    const RunRecord* run = find_run(runs, variant_of(scheme).label(), n);
    if (run == nullptr) {
        return std::nullopt;
    }
    if (!run->survived) {
        return Claim::Finding{fate(*run, ""), false};
    }
    std::string text = "largest error of the elevation 0.4 to 1 d from the plate:";
    bool agrees = true;
    for (int k = 1; k <= 4; ++k) {
        const double ut = 0.08 * k;
        const double error = elevation_error(mark_at(*run, run->time * k / 4));
        text += (k == 1 ? " " : ", ") + percent(error);
        agrees = agrees && error <= ut;
    }
    return Claim::Finding{text + " at Ut/d = 0.08, 0.16, 0.24, 0.32; first order in time can judge to Ut/d",
                          agrees};
}

MaybeFinding better_when_finer(Runs runs, const std::string& scheme) {
    const RunRecord* coarse = find_run(runs, variant_of(scheme).label(), 40);
    const RunRecord* fine = find_run(runs, variant_of(scheme).label(), 80);
    if (coarse == nullptr || fine == nullptr || !coarse->survived || !fine->survived) {
        return std::nullopt;
    }
    // At the first instant, where the solution's own error is least.
    const double of_coarse = elevation_error(mark_at(*coarse, coarse->time / 4));
    const double of_fine = elevation_error(mark_at(*fine, fine->time / 4));
    return Claim::Finding{"at Ut/d = 0.08: dx = d/40 " + percent(of_coarse) + ", d/80 " + percent(of_fine),
                          of_fine < of_coarse};
}

/// What the plate and the bed give in the first step.
MaybeFinding impulse(Runs runs, const std::string& scheme, const char* measure, double bound) {
    const RunRecord* run = find_run(runs, variant_of(scheme).label(), 32);
    if (run == nullptr || !run->survived || run->history.back().find(measure) == nullptr) {
        return std::nullopt;
    }
    const double error = run->history.back().find(measure)->l2;
    return Claim::Finding{"error at dx = d/32: " + percent(error), error <= bound};
}

std::vector<Claim> claims() {
    const auto claim = [](const char* id, const std::string& text, const char* value, const char* source,
                          auto measure) {
        return Claim{
            .id = id, .text = text, .published = value, .source = source, .where = {}, .measure = measure};
    };
    const char* peregrine = "Peregrine 1972; Xu 2009 §6.4 (sheet)";
    return {
        claim("PLATE, impulse",
              "impulse on the plate, dummy-free walls with the wall's acceleration, p = 0 on the "
              "surface",
              "0.54275 rho U d^2", peregrine,
              [](Runs runs) { return impulse(runs, improved, "plate_impulse", 0.01); }),
        claim("PLATE, impulse", "the same with p = 0 at the particles and even images, as published",
              "0.54275 rho U d^2", peregrine,
              [](Runs runs) { return impulse(runs, published, "plate_impulse", 0.01); }),
        claim("PLATE, impulse", "impulse on the bed", "0.5 rho U d^2", peregrine,
              [](Runs runs) { return impulse(runs, improved, "bed_impulse", 0.01); }),
        claim("XU-PADDLE", "elevation at four instants, Pe = 30, dx = d/40", "good agreement", "Xu 2009 §6.4",
              [](Runs runs) { return elevations(runs, damped(with_ls, "30"), 40); }),
        claim("XU-PADDLE", "the same, dx = d/80", "good agreement", "Xu 2009 §6.4",
              [](Runs runs) { return elevations(runs, damped(with_ls, "30"), 80); }),
        claim("XU-PADDLE", "the same with p = 0 on the surface, dx = d/80", "good agreement", "Xu 2009 §6.4",
              [](Runs runs) { return elevations(runs, damped(improved, "30"), 80); }),
        claim("XU-PADDLE", "Pe = 7, dx = d/40", "usable", "Xu 2009 §6.3",
              [](Runs runs) { return elevations(runs, damped(with_ls, "7"), 40); }),
        claim("XU-PADDLE", "Pe = 150, dx = d/40", "usable", "Xu 2009 §6.3",
              [](Runs runs) { return elevations(runs, damped(with_ls, "150"), 40); }),
        claim("XU-PADDLE", "better at the finer spacing", "better", "Xu 2009 §6.4",
              [](Runs runs) { return better_when_finer(runs, damped(with_ls, "30")); }),
    };
}

/// Derived in analytic/solutions/impulsive_plate.cpp; the logarithms there make a ladder of finite length
/// read a little less than the order.
std::vector<Expectation> expectations() {
    const char* derived =
        "derived at the corner, where the velocity goes as ln r (impulsive_plate.cpp, analytic)";
    const auto at_first = [&](const char* field, const char* surface, const char* wall, Expected order,
                              std::string text) {
        return Expectation{.scheme = "isph_dfs",
                           .field = field,
                           .where = {{"laplacian", 0, 0, "schwaiger"},
                                     {"surface_pressure", 0, 0, surface},
                                     {"wall_pressure", 0, 0, wall},
                                     {"length", 4, 100},
                                     {"end_time", 0, 1e-5}},
                           .order = std::move(order),
                           .text = std::move(text)};
    };
    return {
        at_first("impulse", "true_position", "inertial", {1.7, 2.1, derived},
                 "second order everywhere but at the corner: dx^2 ln(1/dx) in L1 and L2, dx in Linf"),
        at_first("velocity", "true_position", "inertial", {0.9, 1.1, derived},
                 "wrong by O(U) in the cells at the corner, dx^2/r^2 further off: dx in L2, dx^2 ln(1/dx) in "
                 "L1, and "
                 "no convergence in Linf"),
        at_first("plate_impulse", "true_position", "inertial", {1.5, 2.1, derived},
                 "the sum of the velocities is as wrong as their L1"),
        at_first("bed_impulse", "true_position", "inertial", {1.8, 2.2, derived}, "far from the corner"),
        at_first("impulse", "at_particle", "inertial",
                 {0.85, 1.15, "derived: p = 0 half a spacing below the surface"},
                 "a domain that is too shallow by dx/2"),
        at_first("impulse", "at_particle", "even",
                 {0.85, 1.15, "derived: p = 0 half a spacing below the surface"},
                 "a domain that is too shallow by dx/2"),
        at_first("velocity", "at_particle", "even",
                 {0.4, 0.6, "derived: even images halve the pressure gradient in the row at the plate"},
                 "wrong by O(U) in a layer one spacing thick: dx^(1/2) in L2"),
    };
}

std::vector<Study> studies() {
    const std::vector<std::string> treatments{improved, with_ls, published};
    const std::vector<std::string> damping{damped(with_ls, "30"), damped(improved, "30"),
                                           damped(with_ls, "7"), damped(with_ls, "150")};
    // The end wall changes the field by e^(-pi L/2d): 3e-6 with L = 8 d. Spacings are the published d/40 and
    // d/80. A jet one particle thin keeps no minimum spacing.
    const solver::Assignments first{{"speed", "1"}, {"length", "4"}};
    const auto later = [](const char* speed, const char* end_time) {
        return solver::Assignments{{"speed", speed}, {"end_time", end_time}, {"minimum_spacing", "0"}};
    };
    return {{.name = "impulsive_plate/first_step",
             .tier = Tier::quick,
             .schemes = treatments,
             .settings = first,
             .ladder = {8, 12, 16, 24, 32},
             .cost = 2,
             .picture_at = 32},
            {.name = "impulsive_plate/elevation",
             .tier = Tier::quick,
             .schemes = {damped(with_ls, "30"), damped(improved, "30")},
             .settings = later("1", "0.16"),
             .ladder = {20, 40},
             .cost = 15,
             .picture_at = 40},
            {.name = "impulsive_plate/first_step_fine",
             .tier = Tier::nightly,
             .schemes = treatments,
             .settings = first,
             .ladder = {16, 24, 32, 48, 64, 96},
             .cost = 8},
            {.name = "impulsive_plate/elevation_1",
             .tier = Tier::nightly,
             .schemes = damping,
             .settings = later("1", "0.16"),
             .ladder = {40, 80},
             .cost = 280,
             .picture_at = 80},
            {.name = "impulsive_plate/elevation_0.2",
             .tier = Tier::full,
             .schemes = damping,
             .settings = later("0.2", "0.8"),
             .ladder = {40, 80},
             .cost = 340},
            {.name = "impulsive_plate/elevation_finest",
             .tier = Tier::full,
             .schemes = {damped(with_ls, "30"), damped(improved, "30")},
             .settings = later("1", "0.16"),
             .ladder = {40, 80, 160},
             .cost = 600,
             .picture_at = 160}};
}

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
        .expectations = expectations(),
        .claims = claims(),
        .studies = studies(),
        .fields = {"impulse", "velocity"},
        .measures = measures(),
        .closed = {{0, true}},
        .starts_at_rest = true,
        .hooks = {.reference_speed = [](const SceneRecord& /*scene*/,
                                        const analytic::Values& values) { return values.at("speed"); },
                  .compares = compares,
                  .complete = add_impulse},
        .variant_names = variant_names(),
    };
    return flow;
}

} // namespace sphvv::verification::cases
