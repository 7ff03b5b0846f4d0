#include "sphvv/analytic/solutions.hpp"
#include "sphvv/solver/boundaries/wall_methods.hpp"
#include "sphvv/verification/cases.hpp"

#include <algorithm>
#include <cmath>

namespace sphvv::verification {

using solver::Key;

std::string duration_text(double seconds) {
    const bool hours = seconds >= 3600;
    const bool minutes = !hours && seconds >= 120;
    const double value = seconds / (hours ? 3600 : minutes ? 60 : 1);
    const char* unit = hours ? " h" : minutes ? " min" : " s";
    return solver::shortest(std::round(10 * value) / 10) + unit;
}

std::string_view to_string(Tier tier) {
    switch (tier) {
    case Tier::quick:
        return "quick";
    case Tier::nightly:
        return "nightly";
    case Tier::full:
        break;
    }
    return "full";
}

std::vector<std::string> compared_names(const Case& c) {
    std::vector<std::string> names = c.fields;
    for (const Measure& measure : c.measures) {
        names.push_back(measure.name);
    }
    return names;
}

namespace {

std::vector<std::string> free_surface_detectors() {
    std::vector<std::string> names;
    for (const solver::Detector* detector : solver::free_surface::all()) {
        names.emplace_back(detector->name);
    }
    return names;
}

std::vector<std::string> wall_method_names() {
    std::vector<std::string> names;
    for (const solver::WallMethodEntry* method : solver::wall_methods::all()) {
        names.emplace_back(method->name);
    }
    return names;
}

std::string wall_method_summaries() {
    std::string text;
    for (const solver::WallMethodEntry* method : solver::wall_methods::all()) {
        text.append(text.empty() ? "" : "; ").append(method->name).append(", ").append(method->summary);
    }
    return text;
}

bool has_key(const std::vector<Key>& keys, std::string_view name) {
    return std::any_of(keys.begin(), keys.end(), [&](const Key& key) { return key.name == name; });
}

/// Of the solution with its declared parameters.
bool has_boundary(const Case& c, bool surface) {
    const analytic::Solution& solution = analytic::solutions::find(c.solution);
    const auto all = analytic::boundaries(solution, analytic::resolve(solution, {}));
    return std::any_of(all.begin(), all.end(), [&](const analytic::Boundary& boundary) {
        return (boundary.kind == analytic::BoundaryKind::free_surface) == surface;
    });
}

void add_boundary_keys(const Case& c, std::vector<Key>& keys) {
    if (has_walls(c) && !has_key(keys, "wall_method")) {
        keys.push_back(Key::word("wall_method", "mirror", wall_method_names(),
                                 "what lies beyond a wall: " + wall_method_summaries()));
        // Near r0 the stiffness of the forces is up to 6 D/r0^2. With D = (10 U)^2 = c0^2 an acoustic step of
        // 0.4 h/c0, h = 1.3 dx, is 1.3 over its frequency, where 2 is the limit of an explicit one. Closer to
        // a point it is at most 13 F/r, which the force limit 0.25 sqrt(h/F) sees: 1.2 at r = 0.75 dx.
        keys.push_back(
            Key::number("repulsion", 1, 1e-6, 100, "1",
                        "wall_method=repulsive…: D over U^2, U the largest speed that is expected; "
                        "in a column U^2 = gH, and D = gH as published"));
        keys.push_back(Key::integer("points_per_dx", 1, 1, 64,
                                    "wall_method=repulsive…: points on the wall to a particle spacing along "
                                    "it, with as much less of the force each"));
    }
    if (has_walls(c)) {
        keys.push_back(Key::word("wall_pressure", "inertial", {"inertial", "even"},
                                 "pressure gradient normal to a wall: inertial, rho (f - a).n with the body "
                                 "force f and the wall's acceleration a; even, 0, as published"));
    }
    if (has_free_surface(c)) {
        keys.push_back(Key::word("surface_detector", "covered_ball", free_surface_detectors(),
                                 "what tells the particles at the free surface, where a scheme asks"));
        keys.push_back(Key::word("surface_row", "below", {"below", "on"},
                                 "the uppermost row of particles: below, half a spacing, so that the "
                                 "particles fill the domain; on, on the surface, as depths are counted in "
                                 "Issa's thesis"));
    }
}

} // namespace

bool has_walls(const Case& c) {
    return has_boundary(c, false);
}

bool has_free_surface(const Case& c) {
    return has_boundary(c, true);
}

std::vector<Key> case_keys(const Case& c) {
    const analytic::Solution& solution = analytic::solutions::find(c.solution);
    std::vector<Key> keys = c.keys;
    for (const analytic::Parameter& p : solution.parameters) {
        if (std::ranges::find(c.derived, p.name) == c.derived.end()) {
            keys.push_back(Key::number(std::string(p.name), p.value, p.low, p.high, std::string(p.unit),
                                       std::string(p.summary)));
        }
    }
    keys.push_back(Key::number("end_time", c.end_time, 1e-9, 1e9, "s", "time at which errors are taken"));
    const bool bounded = has_walls(c) || has_free_surface(c);
    if (!has_key(keys, "arrangement")) {
        keys.push_back(
            bounded ? Key::word("arrangement", "lattice", {"lattice", "jittered"},
                                "particles at the start; jittered runs five seeds per rung")
                    : Key::word("arrangement", "lattice", {"lattice", "jittered", "settled"},
                                "particles at the start; jittered and settled (a jittered tile relaxed by "
                                "shifts, repeated) run five seeds per rung"));
    }
    if (bounded) {
        add_boundary_keys(c, keys);
    }
    if (c.columns > 0) {
        keys.push_back(Key::integer("columns", c.columns, 1, 1000000,
                                    "width of the periodic box in particles: nothing varies along it"));
    }
    keys.push_back(
        Key::number("jitter", 0.1, 0, 0.5, "1", "largest displacement of a jittered start over dx"));
    keys.push_back(
        Key::number("maximum_energy", 1.1, 1, 1e9, "1",
                    "a run whose kinetic energy exceeds its start value by this factor has gained "
                    "energy that nothing supplies: the flow is not driven, and elastic energy is of "
                    "the order (U/c0)^2 = 1 %. In a driven flow, the factor on rho U^2/2 everywhere, U the "
                    "largest speed that is expected"));
    keys.push_back(Key::number(
        "minimum_spacing", 0.25, 0, 1, "1",
        "a run in which two particles come closer than this times dx has lost its arrangement: a strain "
        "that squeezes the lattice to dx/4 stretches it to 4 dx, the reach of the kernels (3.9 dx for the "
        "quintic spline), where a particle sees no neighbour that way"));
    return keys;
}

bool applies(std::span<const Condition> conditions, const solver::Settings& of_case,
             const solver::Settings& of_scheme) {
    return std::all_of(conditions.begin(), conditions.end(), [&](const Condition& condition) {
        const solver::Settings& settings = of_scheme.has(condition.key) ? of_scheme : of_case;
        if (!condition.word.empty()) {
            return settings.word(condition.key) == condition.word;
        }
        const double value = settings.number(condition.key);
        return value >= condition.low && value <= condition.high;
    });
}

const Expectation* find_expectation(const Case& c, std::string_view scheme, std::string_view field,
                                    const solver::Settings& of_case, const solver::Settings& of_scheme) {
    for (const Expectation& expectation : c.expectations) {
        if (expectation.scheme == scheme && (expectation.field.empty() || expectation.field == field) &&
            applies(expectation.where, of_case, of_scheme)) {
            return &expectation;
        }
    }
    return nullptr;
}

namespace cases {
const Case& find(std::string_view name) {
    return solver::find_by_name(all(), name, "case");
}
} // namespace cases

} // namespace sphvv::verification
