#include "sphvv/verification/extreme.hpp"

#include "sphvv/solver/arrangements.hpp"
#include "sphvv/solver/schemes.hpp"
#include "sphvv/verification/cases.hpp"
#include "sphvv/verification/markdown_table.hpp"
#include "sphvv/verification/run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

namespace sphvv::verification {
namespace {

using solver::Simulation;
using Tree = nlohmann::ordered_json;
using Point = std::array<double, 2>;

constexpr double dx = 0.02;
constexpr double gravity = 10;

/// Particles of spacing dx and density 1000 in an open box of 1000 m, at these places with these velocities,
/// stepped by dt (s); the speed scale is 1 m/s.
Simulation<2> open_scene(const std::string& variant_text, const std::vector<Point>& places,
                         const std::vector<Point>& velocities, double dt, double body_force) {
    const Variant variant = variant_of(variant_text);
    solver::Box<2> box;
    box.low.fill(-500);
    box.high.fill(500);
    box.periodic.fill(false);
    Simulation<2> s(box, places.size());
    solver::Assignments given = variant.settings;
    given.insert_or_assign("time_step", solver::shortest(dt));
    s.settings = solver::Settings(variant.scheme->keys, given);
    s.kernel = &solver::kernels::find(s.settings.word("kernel"));
    s.particle_spacing = dx;
    s.smoothing_length = s.settings.number("h_over_dx") * dx;
    s.density = 1000;
    s.kinematic_viscosity = 1e-3;
    s.reference_speed = 1;
    s.particle_mass = 1000 * dx * dx;
    s.body_force = {0, -body_force};
    s.end_time = 1e6 * dt;
    s.particles.field("pressure", 1, solver::Lifetime::state, "scene");
    for (std::size_t i = 0; i < places.size(); ++i) {
        for (int d = 0; d < 2; ++d) {
            s.particles.position[d][i] = places[i][d];
            s.particles.velocity[d][i] = velocities[i][d];
        }
    }
    const solver::Detector& detector = solver::free_surface::find("covered_ball");
    s.free_surface = solver::FreeSurface{
        &detector, detector.threshold(2, s.kernel->support * s.settings.number("h_over_dx"))};
    variant.scheme->assemble(s);
    return s;
}

/// Steps it so often; the error is that of the positions, in m, against the parabolas from these starts.
ExtremeOutcome fly(Simulation<2>& s, int steps, const std::vector<Point>& places,
                   const std::vector<Point>& velocities, double body_force) {
    ExtremeOutcome outcome;
    try {
        for (; outcome.steps < steps; ++outcome.steps) {
            advance(s);
        }
        outcome.survived = true;
    } catch (const solver::Diverged& end) {
        outcome.diagnosis = end.what();
        return outcome;
    }
    for (std::size_t k = 0; k < places.size(); ++k) {
        const auto id = static_cast<std::size_t>(s.particles.id[k]);
        const double x = places[id][0] + velocities[id][0] * s.time;
        const double y = places[id][1] + velocities[id][1] * s.time - body_force / 2 * s.time * s.time;
        const double off = std::hypot(s.particles.position[0][k] - x, s.particles.position[1][k] - y);
        outcome.error = std::isfinite(off) ? std::max(outcome.error, off) : off;
    }
    return outcome;
}

ExtremeOutcome flight(const std::string& scheme, const std::vector<Point>& places,
                      const std::vector<Point>& velocities, double body_force) {
    constexpr int steps = 200;
    constexpr double dt = 1e-3;
    Simulation<2> s = open_scene(scheme, places, velocities, dt, body_force);
    return fly(s, steps, places, velocities, body_force);
}

/// From -1 to 1, the same with every standard library.
double uniform(std::mt19937_64& engine) {
    return 2 * static_cast<double>(engine() >> 11U) * 0x1p-53 - 1;
}

/// Drops that fly apart from one another, each farther than any kernel reaches from the next.
std::pair<std::vector<Point>, std::vector<Point>> spray() {
    std::mt19937_64 engine(20261123);
    std::vector<Point> places;
    std::vector<Point> velocities;
    for (int a = 0; a < 6; ++a) {
        for (int b = 0; b < 6; ++b) {
            places.push_back({0.5 * a, 0.5 * b});
            velocities.push_back({0.3 * uniform(engine), 0.3 * uniform(engine)});
        }
    }
    return {places, velocities};
}

/// A case of the harness; the error is the relative L2 one of the velocity.
ExtremeOutcome run_case(const char* flow, const std::string& scheme, const solver::Assignments& settings,
                        int n) {
    const RunRecord run = run_scene(resolve_scene(cases::find(flow), variant_of(scheme), settings, n));
    ExtremeOutcome outcome{run.survived, run.diagnosis, 0, run.steps};
    if (run.survived) {
        outcome.error = run.errors.at(0).norms.l2;
    }
    return outcome;
}

/// |P(t) - P(0)| / (M U) of a block of particles on a lattice, one of them moved on top of, or next to, its
/// neighbour.
ExtremeOutcome coincide(const std::string& scheme, double distance) {
    constexpr int n = 10;
    std::vector<Point> places;
    for (int a = 0; a < n; ++a) {
        for (int b = 0; b < n; ++b) {
            places.push_back({a * dx, b * dx});
        }
    }
    places[n * n / 2 + n / 2] = places[n * n / 2 + n / 2 - 1];
    places[n * n / 2 + n / 2][0] += distance;
    std::mt19937_64 engine(20261123);
    std::vector<Point> velocities(places.size());
    for (Point& u : velocities) {
        u = {0.1 * uniform(engine), 0.1 * uniform(engine)};
    }
    Simulation<2> s = open_scene(scheme, places, velocities, 1e-4, 0);
    const auto before = momentum(s);
    ExtremeOutcome outcome;
    try {
        for (; outcome.steps < 50; ++outcome.steps) {
            advance(s);
        }
        outcome.survived = true;
    } catch (const solver::Diverged& end) {
        outcome.diagnosis = end.what();
        return outcome;
    }
    const auto after = momentum(s);
    outcome.error = std::hypot(after[0] - before[0], after[1] - before[1]) /
                    (s.particle_mass * static_cast<double>(places.size()));
    return outcome;
}

std::vector<ExtremeRow> make_rows() {
    std::vector<ExtremeRow> rows;
    constexpr double duration = 0.2; // s, of flight()
    constexpr double step = 1e-3;
    constexpr double round_off = 1e-12;
    const std::vector<std::string> schemes{"wcsph", "isph_df", "isph_dfs", "isph_lee"};
    for (const std::string& scheme : schemes) {
        // wcsph and isph_lee move with the new velocity.
        const bool euler = scheme == "wcsph" || scheme == "isph_lee";
        const double parabola = (euler ? gravity * duration * step / 2 * (1 + 1e-9) : 0) + round_off;
        const std::string order =
            euler ? "constant acceleration, moved with the new velocity: off by g t dt/2"
                  : "constant acceleration, moved with the mean of old and new velocity: exact";
        rows.push_back({.name = "a single particle",
                        .scheme = scheme,
                        .must = "goes straight on; error: place, m",
                        .why = "no neighbour, no force",
                        .fate = Fate::bounded,
                        .bound = round_off,
                        .run = [](const std::string& of) {
                            return flight(of, {{0, 0}}, {{0.3, -0.2}}, 0);
                        }});
        rows.push_back({.name = "a single particle falls",
                        .scheme = scheme,
                        .must = "follows its parabola; error: place, m",
                        .why = order,
                        .fate = Fate::bounded,
                        .bound = parabola,
                        .run = [](const std::string& of) {
                            return flight(of, {{0, 0}}, {{0.3, 2}}, gravity);
                        }});
        rows.push_back({.name = "a spray in free flight",
                        .scheme = scheme,
                        .must = "every drop follows its parabola; error: place, m",
                        .why = order,
                        .fate = Fate::bounded,
                        .bound = parabola,
                        .run = [](const std::string& of) {
                            const auto [places, velocities] = spray();
                            return flight(of, places, velocities, gravity);
                        }});
        rows.push_back({.name = "1000 g",
                        .scheme = scheme,
                        .must = "a particle follows its parabola; error: place, m",
                        .why = order,
                        .fate = Fate::bounded,
                        .bound = 1000 * parabola,
                        .run = [](const std::string& of) {
                            return flight(of, {{0, 0}}, {{0, 0}}, 1000 * gravity);
                        }});
        for (const double distance : {0., 1e-8 * dx}) {
            rows.push_back(
                {.name = distance == 0 ? "two particles at one place" : "two particles 1e-8 dx apart",
                 .scheme = scheme,
                 .must = "forces stay finite; error: |P - P0|/(M U)",
                 .why = "gradW(0) = 0: no direction, no force; antisymmetric forces keep the momentum",
                 .fate = scheme == "wcsph" || scheme == "isph_lee" ? Fate::bounded : Fate::survives,
                 .bound = 1e-12,
                 .run = [distance](const std::string& of) { return coincide(of, distance); }});
        }
        rows.push_back(
            {.name = "viscosity rules: Re = 1e-3",
             .scheme = scheme,
             .must = "the vortices decay as they must; error: velocity, L2",
             .why = "over 1/(8 pi^2 nu): k^2 <r^2>_W/8 < 2.5 % by the Laplacian, half of a step, 1/15, by "
                    "Euler's "
                    "decay",
             .fate = Fate::bounded,
             .bound = 0.06,
             .run = [](const std::string& of) {
                 // lambda = 8 pi^2 nu/L^2 with nu = U L/Re = 1000 m2/s: e^-1 after 1.3e-5 s
                 return run_case("taylor_green", of, {{"re", "0.001"}, {"end_time", "1.26651e-05"}}, 20);
             }});
        rows.push_back({.name = "no viscosity to speak of: Re = 1e6",
                        .scheme = scheme,
                        .must = "survives t = 0.2; error: velocity, L2",
                        .why = "nothing is claimed beyond it",
                        .fate = Fate::survives,
                        .run = [](const std::string& of) {
                            return run_case("taylor_green", of, {{"re", "1e6"}, {"end_time", "0.2"}}, 32);
                        }});
        rows.push_back({.name = "a step 100 times too long",
                        .scheme = scheme,
                        .must = "ends with a diagnosis of energy, place or the pressure solver",
                        .why = "beyond every limit: growth by orders of magnitude in a step",
                        .fate = Fate::ends,
                        .diagnosis = " at t = ",
                        .run = [](const std::string& of) {
                            return run_case("taylor_green", of,
                                            {{"re", "1"}, {"end_time", "100"}, {"time_step", "0.1"}}, 32);
                        }});
        for (const char* width : {"0.8", "5"}) {
            rows.push_back({.name = std::string("h/dx = ") + width,
                            .scheme = scheme,
                            .must = "survives t = 0.05; error: velocity, L2",
                            .why = "few neighbours, or very many: nothing is claimed of the error",
                            .fate = Fate::survives,
                            .run = [width](const std::string& of) {
                                return run_case("taylor_green", of,
                                                {{"re", "100"}, {"end_time", "0.05"}, {"h_over_dx", width}},
                                                40);
                            }});
        }
    }
    rows.push_back({.name = "a single particle",
                    .scheme = "isph_mls",
                    .must = "ends: a polynomial is not determined",
                    .why = "moving least squares needs six points that lie on no conic",
                    .fate = Fate::ends,
                    .diagnosis = "do not determine",
                    .run = [](const std::string& of) {
                        return flight(of, {{0, 0}}, {{0.3, -0.2}}, 0);
                    }});
    return rows;
}

} // namespace

std::string_view to_string(Fate fate) {
    return fate == Fate::bounded ? "bounded" : fate == Fate::survives ? "survives" : "ends";
}

std::span<const ExtremeRow> extreme_rows() {
    static const std::vector<ExtremeRow> rows = make_rows();
    return rows;
}

void judge(ExtremeResult& result) {
    const ExtremeRow& row = result.row;
    const ExtremeOutcome& outcome = result.outcome;
    const auto fail = [&](const std::string& reason) {
        result.verdict = "FAIL";
        result.reason = reason;
    };
    result.verdict = "PASS";
    result.reason = row.why;
    if (row.fate == Fate::ends) {
        if (outcome.survived) {
            fail("survived, but must end");
        } else if (row.diagnosis.empty() || outcome.diagnosis.find(row.diagnosis) == std::string::npos) {
            fail("ended with another diagnosis: " + outcome.diagnosis);
        }
    } else if (!outcome.survived) {
        fail("ended: " + outcome.diagnosis);
    } else if (!std::isfinite(outcome.error)) {
        fail("the error is not finite");
    } else if (row.fate == Fate::bounded && outcome.error > row.bound) {
        fail("the error is above its bound");
    }
}

ExtremeResult run_extreme(const ExtremeRow& row) {
    const auto begin = std::chrono::steady_clock::now();
    ExtremeResult result{row, {}, "", "", 0};
    try {
        result.outcome = row.run(row.scheme);
        judge(result);
    } catch (const std::exception& error) {
        result.verdict = "FAIL";
        result.reason = std::string("thrown: ") + error.what();
    }
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return result;
}

std::string markdown(std::span<const ExtremeResult> results) {
    MarkdownTable table(
        {"scene", "scheme", "fate", "bound", "error", "steps", "seconds", "verdict", "what happened"});
    const auto number = [](double value, const char* format) {
        char text[32];
        std::snprintf(text, sizeof text, format, value);
        return std::string(text);
    };
    for (const ExtremeResult& result : results) {
        const bool measured = result.outcome.survived && std::isfinite(result.outcome.error);
        table.add(
            {result.row.name, result.row.scheme, std::string(to_string(result.row.fate)),
             result.row.fate == Fate::bounded ? number(result.row.bound, "%.2g") : "–",
             measured ? number(result.outcome.error, "%.2g") : "–", std::to_string(result.outcome.steps),
             number(result.seconds, "%.2f"), result.verdict + (result.row.waiver.empty() ? "" : " (waived)"),
             result.outcome.diagnosis.empty() ? (result.verdict == "PASS" ? "to the end" : result.reason)
                                              : result.outcome.diagnosis});
    }
    return "\n### extreme scenes\n\n" + table.text();
}

void add_to_document(std::span<const ExtremeResult> results, Tree& document) {
    Tree& rows = document["extreme_rows"] = Tree::array();
    for (const ExtremeResult& result : results) {
        const bool measured = result.outcome.survived && std::isfinite(result.outcome.error);
        rows.push_back({{"name", result.row.name},
                        {"scheme", result.row.scheme},
                        {"must", result.row.must},
                        {"why", result.row.why},
                        {"fate", to_string(result.row.fate)},
                        {"bound", result.row.fate == Fate::bounded ? Tree(result.row.bound) : Tree(nullptr)},
                        {"survived", result.outcome.survived},
                        {"diagnosis", result.outcome.diagnosis},
                        {"error", measured ? Tree(result.outcome.error) : Tree(nullptr)},
                        {"steps", result.outcome.steps},
                        {"seconds", result.seconds},
                        {"verdict", result.verdict},
                        {"passes", result.verdict == "PASS"},
                        {"waiver", result.row.waiver},
                        {"reason", result.reason}});
    }
}

int exit_status(std::span<const ExtremeResult> results) {
    return std::ranges::any_of(results, [](const ExtremeResult& result) {
        return result.verdict != "PASS" && result.row.waiver.empty();
    });
}

} // namespace sphvv::verification
