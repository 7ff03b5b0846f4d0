#include "sphvv/verification/extreme_scenes.hpp"

#include "sphvv/verification/cases.hpp"
#include "sphvv/verification/run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace sphvv::verification::extreme_scenes {
namespace {

bool has_key(const solver::Scheme& scheme, std::string_view name) {
    return std::ranges::any_of(scheme.keys, [&](const solver::Key& key) { return key.name == name; });
}

std::vector<Point> by_identity(const Simulation& s, const solver::Field& field) {
    std::vector<Point> values(s.particles.fluid_size());
    for (std::size_t k = 0; k < values.size(); ++k) {
        values[s.particles.id[k]] = {field[0][k], field[1][k]};
    }
    return values;
}

} // namespace

Simulation simulate(const std::string& scheme, const PointScene& scene) {
    const Variant variant = variant_of(scheme);
    Simulation s(scene.box, scene.places.size());
    solver::Assignments given = variant.settings;
    given.insert_or_assign("time_step", solver::shortest(scene.time_step));
    for (const auto& [key, value] : scene.settings) {
        if (has_key(*variant.scheme, key)) {
            given.insert_or_assign(key, value);
        }
    }
    s.settings = solver::Settings(variant.scheme->keys, given);
    s.kernel = &solver::kernels::find(s.settings.word("kernel"));
    s.particle_spacing = scene.dx;
    s.smoothing_length = s.settings.number("h_over_dx") * scene.dx;
    s.density = scene.density;
    s.kinematic_viscosity = scene.viscosity;
    s.reference_speed = scene.speed;
    s.particle_mass = scene.density * scene.dx * scene.dx;
    s.body_force = scene.body_force;
    s.end_time = 0x1p20 * scene.time_step; // never reached: rows count steps
    s.walls = scene.walls;
    solver::Field& pressure = s.particles.field("pressure", 1, solver::Lifetime::state, "scene");
    for (std::size_t i = 0; i < scene.places.size(); ++i) {
        for (int d = 0; d < 2; ++d) {
            s.particles.position[d][i] = scene.places[i][d];
            s.particles.velocity[d][i] = scene.velocities[i][d];
        }
        pressure[0][i] = scene.pressures.empty() ? 0 : scene.pressures[i];
    }
    if (scene.free_surface) {
        const solver::Detector& detector = solver::free_surface::find("covered_ball");
        s.free_surface = solver::FreeSurface{
            &detector, detector.threshold(2, s.kernel->support * s.settings.number("h_over_dx"))};
    }
    variant.scheme->assemble(s);
    return s;
}

solver::Assignments exact_settings() {
    return {{"pressure_tolerance", "1e-12"}, {"shift_disorder", "0"}};
}

ExtremeOutcome advance_and_measure(Simulation& s, int steps,
                                   const std::function<double(const Simulation&)>& measure) {
    ExtremeOutcome outcome;
    try {
        for (; outcome.steps < steps; ++outcome.steps) {
            advance(s);
        }
    } catch (const solver::Diverged& end) {
        outcome.diagnosis = end.what();
        return outcome;
    }
    outcome.survived = true;
    outcome.error = measure(s);
    return outcome;
}

std::vector<Point> places_of(const Simulation& s) {
    return by_identity(s, s.particles.position);
}

std::vector<Point> velocities_of(const Simulation& s) {
    return by_identity(s, s.particles.velocity);
}

std::vector<double> pressures_of(const Simulation& s) {
    const solver::Field& pressure = *s.particles.find("pressure");
    std::vector<double> values(s.particles.fluid_size());
    for (std::size_t k = 0; k < values.size(); ++k) {
        values[s.particles.id[k]] = pressure[0][k];
    }
    return values;
}

double largest_difference(const std::vector<Point>& a, const std::vector<Point>& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double off = std::hypot(a[i][0] - b[i][0], a[i][1] - b[i][1]);
        if (!std::isfinite(off)) {
            return std::numeric_limits<double>::quiet_NaN();
        }
        largest = std::max(largest, off);
    }
    return largest;
}

/// Source: Steele, Lea & Flood 2014 (SplitMix64).
double Uniform::operator()() {
    state_ += 0x9e3779b97f4a7c15;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111eb;
    return static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1p-52 - 1;
}

std::vector<Point> block(int columns, int rows, double dx, const Point& corner) {
    std::vector<Point> places;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            places.push_back({corner[0] + (column + 0.5) * dx, corner[1] + (row + 0.5) * dx});
        }
    }
    return places;
}

ExtremeOutcome run_case(const char* flow, const std::string& scheme, const solver::Assignments& settings,
                        int n) {
    constexpr int most_steps = 20000;
    int steps = 0;
    EndState end;
    const RunRecord run = run_scene_once(
        resolve_scene(cases::find(flow), variant_of(scheme), settings, n), end, [&](double /*fraction*/) {
            if (++steps > most_steps) {
                throw std::runtime_error("still running after " + std::to_string(most_steps) + " steps");
            }
        });
    ExtremeOutcome outcome{run.survived, run.diagnosis, 0, run.steps};
    if (run.survived) {
        outcome.error = run.errors.at(0).norms.l2;
    }
    return outcome;
}

std::vector<std::string> scheme_names() {
    std::vector<std::string> names;
    for (const solver::Scheme* scheme : solver::schemes::all()) {
        names.emplace_back(scheme->name);
    }
    return names;
}

bool conserves_momentum(const std::string& scheme) {
    const Variant variant = variant_of(scheme);
    return variant.scheme->conserves(solver::Settings(variant.scheme->keys, variant.settings)).momentum;
}

bool moves_with_new_velocity(const std::string& scheme) {
    return scheme == "wcsph" || scheme == "isph_lee" || scheme == "isph_asai";
}

bool needs_polynomial(const std::string& scheme) {
    return scheme == "isph_mls";
}

bool has_free_surface(const std::string& scheme) {
    return !needs_polynomial(scheme);
}

const std::string cut_density =
    "density invariance sums rho over a support that the surface cuts: it starts "
    "between 0.49 and 0.72 of rho0 there, and the pressure squeezes the rows below "
    "until that is made up. Held to the density of its start in place of rho0, ";

const std::vector<std::string> blown_up{
    "kinetic energy",          "velocity not finite",
    "minimum spacing",         "position not finite or outside the domain",
    "pressure solver stopped", "pressure source not finite"};

void must_be_refused(ExtremeRow& row) {
    row.must = "is refused";
    row.why = "the scheme has no condition p = 0 at a surface";
    row.fate = Fate::ends;
    row.diagnoses = {"the scheme " + row.scheme + " has no free surface"};
}

} // namespace sphvv::verification::extreme_scenes
