// A column of fluid at rest under gravity: compressible by Tait's equation, or incompressible.
//   sphvv verify hydrostatic
//   sphvv verify hydrostatic --scheme wcsph,isph_dfs --set start=uniform --set damping=300 --n 20,40
#include "sphvv/analytic/solutions.hpp"
#include "sphvv/verification/cases.hpp"
#include "sphvv/verification/claims.hpp"
#include "sphvv/verification/tensile_instability.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <iterator>
#include <numbers>

namespace sphvv::verification::cases {
namespace {

using solver::Key;

/// m/s, taken for the sound speed of an incompressible fluid: its column is shorter by gH^2/(2 c^2), 1e-24 m.
constexpr double endless = 1e12;

/// sqrt(g H_i), the speed of a fall from half the depth.
double fall_speed(const analytic::Values& values) {
    return std::sqrt(values.at("gravity") * values.at("depth"));
}

void follow_scheme(const SceneRecord& scene, analytic::Values& values) {
    const solver::Settings& settings = scene.scheme_settings;
    values["sound_speed"] =
        scene.scheme->compressible ? settings.number("c0_over_u") * fall_speed(values) : endless;
    if (scene.scheme->compressible) {
        values["gamma"] = settings.number("gamma");
    }
}

void before_settling(const SceneRecord& /*scene*/, analytic::Values& values) {
    values["sound_speed"] = endless;
}

double depth_of(const analytic::Values& values) {
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
            // Nearer to the cut, a particle and its image would be a close pair; without it there is a gap.
            const double slack = dx / 4;
            if (x > -slack && x < width + slack && y < depth + slack) {
                points[0].push_back(std::clamp(x, dx / 2, width - dx / 2));
                points[1].push_back(std::min(y, depth - dx / 2));
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
        Key::word("arrangement", "lattice", {"lattice", "jittered", "polar", "unstructured"},
                  "particles at the start; jittered and unstructured (independent random positions, settled) "
                  "run five seeds per rung; polar: half rings about the middle of the bed"),
        Key::number("damping", 0, 0, 1e9, "1/s", "Gamma in du/dt = -Gamma u, which settles the column"),
        Key::number("damping_below", 1e6, 0, 1e6, "m", "only below this height")};
}

/// SCHEME:KEY=VALUE… with the keys in their order.
std::string variant(const char* scheme, const solver::Assignments& settings) {
    std::string text(scheme);
    for (const auto& [key, value] : settings) {
        text.append(":").append(key).append("=").append(value);
    }
    return text;
}

/// A form of wcsph by its continuity and pressure force.
std::string form(const char* continuity, const char* pressure_force) {
    return variant(
        "wcsph",
        {{"continuity", continuity}, {"kernel", "quintic_spline"}, {"pressure_force", pressure_force}});
}

const std::string lee = "isph_lee";
const std::string asai = "isph_asai";
const std::string lee_normalised = "isph_lee:gradient=normalised:laplacian=schwaiger";
const std::string dfs_schwaiger = "isph_dfs:laplacian=schwaiger";

/// Issa's column: S2 with P1, c0 = 50 m/s at H_i = 0.4 m, whatever its particles do.
std::string issa(const char* kernel, const char* h_over_dx, const solver::Assignments& more = {}) {
    solver::Assignments settings{{"c0_over_u", "25.241141"},   {"continuity", "sigma_2"},
                                 {"h_over_dx", h_over_dx},     {"kernel", kernel},
                                 {"maximum_energy", "100"},    {"minimum_spacing", "0"},
                                 {"pressure_force", "sigma_1"}};
    for (const auto& [key, value] : more) {
        settings[key] = value;
    }
    return variant("wcsph", settings);
}

const char* const cubic = "cubic_spline";
const char* const quartic = "quartic_spline";

std::string undamped() {
    return issa(cubic, "1.5");
}
std::string damped() {
    return issa(cubic, "1.5", {{"damping", "10000"}});
}
std::string damped_below() {
    return issa(cubic, "1.5", {{"damping", "10000"}, {"damping_below", "0.1"}});
}

/// Oger's column, c0 = 80 m/s at H_i = 0.4 m: h/dx = 1.3 on polar particles, 1.5 on unstructured ones.
std::string oger(const char* continuity, const char* pressure_force, const char* h_over_dx = "1.3") {
    return variant("wcsph", {{"c0_over_u", "40.385826"},
                             {"continuity", continuity},
                             {"h_over_dx", h_over_dx},
                             {"kernel", "cubic_spline"},
                             {"maximum_energy", "100"},
                             {"minimum_spacing", "0"},
                             {"pressure_force", pressure_force}});
}

using Runs = std::span<const RunRecord>;
using MaybeFinding = std::optional<Claim::Finding>;

const Norms* norms_of(const RunRecord& run, std::string_view field) {
    const auto found = std::ranges::find(run.errors, field, &FieldError::field);
    return found == run.errors.end() ? nullptr : &found->norms;
}

MaybeFinding settled_depth_of_issa(Runs runs) {
    const RunRecord* run = find_run(runs, damped(), 40);
    const Norms* error = run == nullptr ? nullptr : norms_of(*run, "settled_depth");
    if (error == nullptr) {
        return std::nullopt;
    }
    return Claim::Finding{"off by " + percent(error->l2) + " of H", error->l2 <= 5e-5};
}

MaybeFinding pressure_of_issa(Runs runs) {
    const RunRecord* run = find_run(runs, damped(), 40);
    const Norms* error = run == nullptr ? nullptr : norms_of(*run, "pressure");
    if (error == nullptr) {
        return std::nullopt;
    }
    return Claim::Finding{"largest error " + percent(error->linf) + " of rho g H, L2 " + percent(error->l2) +
                              " (the lattice sum of the cubic kernel at h/dx 1.5 is 0.67 % too large)",
                          error->linf < 0.02};
}

/// Errors of the damped column fall from rung to rung.
MaybeFinding finer_is_better(Runs runs) {
    std::string text = "largest error of p";
    double before = 1e300;
    bool falls = true;
    int rungs = 0;
    for (const int n : {40, 80, 160}) {
        const RunRecord* run = find_run(runs, damped(), n);
        const Norms* error = run == nullptr ? nullptr : norms_of(*run, "pressure");
        if (error != nullptr) {
            text += " " + percent(error->linf);
            falls = falls && error->linf < before;
            before = error->linf;
            ++rungs;
        }
    }
    return rungs < 2 ? std::nullopt : MaybeFinding(Claim::Finding{text, falls});
}

/// Closest pair of a whole run at which its lattice counts as lost, over dx.
constexpr double clumped = 0.5;

/// s, when two particles first were closer than that, to a fortieth of the run; nothing if they never were.
std::optional<double> clumping_time(const RunRecord& run) {
    for (const Deviation& at : run.history) {
        if (at.minimum_spacing < clumped) {
            return at.time;
        }
    }
    return std::nullopt;
}

std::string spacing_of_run(const RunRecord& run) {
    const auto when = clumping_time(run);
    return "closest pair " + number(run.minimum_spacing, "%.2f") + " dx" +
           (when ? ", below 0.5 dx by t = " + number(*when, "%.2f") + " s" : "") +
           (run.survived ? "" : ", leaks through the bed at t = " + number(run.time, "%.2f") + " s");
}

MaybeFinding cubic_clumps(Runs runs) {
    const RunRecord* run = find_run(runs, undamped(), 40);
    if (run == nullptr) {
        return std::nullopt;
    }
    const auto when = clumping_time(*run);
    return Claim::Finding{spacing_of_run(*run), when && *when <= 2};
}

MaybeFinding quartic_does_not(Runs runs) {
    const RunRecord* run = find_run(runs, issa(quartic, "1.5"), 40);
    if (run == nullptr) {
        return std::nullopt;
    }
    return Claim::Finding{spacing_of_run(*run), !clumping_time(*run)};
}

MaybeFinding damping_below_is_passed(Runs runs) {
    const RunRecord* run = find_run(runs, damped_below(), 40);
    if (run == nullptr) {
        return std::nullopt;
    }
    return Claim::Finding{spacing_of_run(*run), clumping_time(*run).has_value()};
}

struct Cure {
    const char* name;
    std::string label;
    const char* kernel;
    double h_over_dx;
    bool dynamic; ///< of the kernel alone: no damping, and WCSPH
};

/// Undamped cubic at h/dx = 1.5 first.
std::vector<Cure> cures() {
    return {{"none", undamped(), cubic, 1.5, true},
            {"h/dx = 1.2", issa(cubic, "1.2"), cubic, 1.2, true},
            {"quartic", issa(quartic, "1.5"), quartic, 1.5, true},
            {"quintic, h/dx = 1.3", issa("quintic_spline", "1.3"), "quintic_spline", 1.3, true},
            {"Wendland C2, h/dx = 2", issa("wendland_c2", "2"), "wendland_c2", 2, true},
            {"c0 = 100", issa(cubic, "1.5", {{"c0_over_u", "50.482282"}}), cubic, 1.5, true},
            {"damping", damped(), cubic, 1.5, false},
            {"damping below 0.1 m", damped_below(), cubic, 1.5, false},
            {"ISPH_DFS", dfs_schwaiger, cubic, 1.5, false}};
}

MaybeFinding ranked_cures(Runs runs) {
    std::vector<std::pair<const RunRecord*, const char*>> found;
    for (const Cure& cure : cures()) {
        if (const RunRecord* run = find_run(runs, cure.label, 40)) {
            found.emplace_back(run, cure.name);
        }
    }
    if (found.size() < 4) {
        return std::nullopt;
    }
    std::ranges::stable_sort(found, [](const auto& a, const auto& b) {
        return a.first->minimum_spacing > b.first->minimum_spacing;
    });
    std::string text = "closest pair over dx:";
    for (const auto& [run, name] : found) {
        text += std::string(text.back() == ':' ? " " : "; ") + name + " " +
                number(run->minimum_spacing, "%.2f") + (run->survived ? "" : " (lost)");
    }
    return Claim::Finding{text,
                          clumping_time(*find_run(runs, undamped(), 40)) && !clumping_time(*found[0].first)};
}

/// Whether what a kernel promises is what the lattice does, for every undamped run.
MaybeFinding foretold(Runs runs, const std::function<double(const solver::Kernel&, double)>& growth,
                      double threshold) {
    std::string text;
    bool right = true;
    int count = 0;
    for (const Cure& cure : cures()) {
        const RunRecord* run = find_run(runs, cure.label, 40);
        if (run == nullptr || !cure.dynamic) {
            continue;
        }
        const double value = growth(solver::kernels::find(cure.kernel), cure.h_over_dx);
        const bool clumps = clumping_time(*run).has_value();
        text += std::string(text.empty() ? "" : "; ") + cure.name + ": " + number(value, "%.2g") +
                (clumps ? ", clumps" : ", holds");
        right = right && (value > threshold) == clumps;
        ++count;
    }
    return count < 3 ? std::nullopt : MaybeFinding(Claim::Finding{text, right});
}

/// Round-off grows to a spacing: e^(sigma t) = 1e16.
MaybeFinding growth_from_round_off(Runs runs) {
    const RunRecord* run = find_run(runs, undamped(), 40);
    if (run == nullptr) {
        return std::nullopt;
    }
    const double sigma =
        std::sqrt(lattice_growth(solver::kernels::find(cubic), 1.5) * 9.81 * 0.4) / (0.4 / run->n);
    const double predicted = std::log(1e16) / sigma;
    const auto when = clumping_time(*run);
    return Claim::Finding{"at the bed sigma = " + number(sigma, "%.0f") +
                              "/s, so t = " + number(predicted, "%.2f") + " s; measured " +
                              (when ? number(*when, "%.2f") + " s" : "never"),
                          when && *when > predicted / 2 && *when < predicted * 2};
}

MaybeFinding larger_sound_speed(Runs runs) {
    const RunRecord* slow = find_run(runs, undamped(), 40);
    const RunRecord* fast = find_run(runs, issa(cubic, "1.5", {{"c0_over_u", "50.482282"}}), 40);
    if (slow == nullptr || fast == nullptr) {
        return std::nullopt;
    }
    return Claim::Finding{"c0 = 50: " + spacing_of_run(*slow) + "; c0 = 100: " + spacing_of_run(*fast) +
                              " (what grows keeps the density, whatever c0 is)",
                          !clumping_time(*fast)};
}

MaybeFinding oger_error(Runs runs, const std::string& label, double low, double high) {
    return largest_pressure_error(runs, label, 40, low, high);
}

/// A wall that repels, one that mirrors or one of fixed particles, under a column that is damped near
/// critically or not at all.
std::string on_wall(const char* wall, const char* kernel, bool damps, const char* points_per_dx = "1") {
    solver::Assignments settings{
        {"kernel", kernel}, {"maximum_energy", "100"}, {"minimum_spacing", "0"}, {"wall_method", wall}};
    if (damps) {
        settings["damping"] = "150"; // 2 c0 pi/(2H) = 156/s
    }
    if (std::string_view(points_per_dx) != "1") {
        settings["points_per_dx"] = points_per_dx;
    }
    return variant("wcsph", settings);
}

const char* const quintic = "quintic_spline";
const char* const wendland = "wendland_c2";

/// The particles within 1.5 dx of the bed at the end of a run.
struct LowestRow {
    /// Rms distance from the nearest of the columns that they start in, over dx: 1/sqrt(12) = 0.29 where they
    /// lie anywhere.
    double displacement;
    /// 1 - |<exp(2 pi i x/dx)>|: 0 for columns dx apart, wherever they are, 1 for particles that lie
    /// anywhere.
    double disorder;
};

/// Nothing without a picture.
std::optional<LowestRow> lowest_row(const RunRecord* run) {
    if (run == nullptr || !run->picture) {
        return std::nullopt;
    }
    double squared = 0;
    std::complex<double> phase;
    int count = 0;
    for (std::size_t k = 0; k < run->picture->x.size(); ++k) {
        if (run->picture->y[k] < 1.5 * run->dx) {
            const double column = run->picture->x[k] / run->dx - 0.5;
            squared += (column - std::round(column)) * (column - std::round(column));
            phase += std::polar(1., 2 * std::numbers::pi * column);
            ++count;
        }
    }
    return count > 0 ? std::optional(LowestRow{std::sqrt(squared / count), 1 - std::abs(phase) / count})
                     : std::nullopt;
}

/// A number of the runs with radial forces on one point to a spacing and on four, and with the normal force,
/// which has no part along the wall. Agrees if that of f1 passes the threshold with one point and not with
/// four; the constants of the Lennard-Jones force are not the published ones.
template <class Of>
MaybeFinding denser_points(Runs runs, const char* kernel, double threshold, const Of& of) {
    std::vector<double> values;
    for (const std::string& label :
         {on_wall("repulsive", kernel, false), on_wall("repulsive", kernel, false, "4"),
          on_wall("repulsive_lennard_jones", kernel, false),
          on_wall("repulsive_lennard_jones", kernel, false, "4"),
          on_wall("repulsive_normal", kernel, false)}) {
        const RunRecord* run = find_run(runs, label, 40);
        const auto row = lowest_row(run);
        if (!row) {
            return std::nullopt;
        }
        values.push_back(of(*run, *row));
    }
    const auto printed = [&](int k) { return number(values[k], "%.2f"); };
    return Claim::Finding{"1 and 4 points per dx: f1 " + printed(0) + ", " + printed(1) + "; Lennard-Jones " +
                              printed(2) + ", " + printed(3) + "; normal force " + printed(4),
                          values[0] > threshold && values[1] < threshold};
}

double displacement(const RunRecord& /*run*/, const LowestRow& row) {
    return row.displacement;
}

double lost_order(const RunRecord& /*run*/, const LowestRow& row) {
    return row.disorder;
}

double lost_spacing(const RunRecord& run, const LowestRow& /*row*/) {
    return 1 - run.minimum_spacing;
}

/// By how much the lowest row moves along the bed, and whether that disorders it.
std::vector<Claim> undulation() {
    std::vector<Claim> all;
    const auto add = [&](const char* id, const char* kernel, const char* text, double threshold, auto of) {
        all.push_back({std::string("WALL-UNDULATION, ") + id + ", " + kernel,
                       text,
                       "stated",
                       "Monaghan 1994; Issa 2005 §2.7",
                       {},
                       [=](Runs runs) { return denser_points(runs, kernel, threshold, of); }});
    };
    for (const char* kernel : {quintic, wendland}) {
        add("force", kernel,
            "the force of radial wall particles undulates along the wall, 4 times denser ones, with a "
            "quarter of "
            "the force, remove that: rms distance of the lowest row from its columns, over dx",
            0.5 / std::sqrt(12.), displacement);
        add("order", kernel,
            "radial wall particles disorder the layer at the wall, 4 times denser ones do not: lost order of "
            "the "
            "lowest row",
            0.5, lost_order);
        add("pairs", kernel,
            "radial wall particles disorder the layer at the wall, 4 times denser ones do not: 1 - closest "
            "pair of the whole run, over dx",
            1 - clumped, lost_spacing);
    }
    return all;
}

std::vector<Claim> claims() {
    const auto claim = [](const char* id, const char* text, const char* published, const char* source,
                          auto measure) { return Claim{id, text, published, source, {}, measure}; };
    std::vector<Claim> all{
        claim(
            "ISSA-STATIC, H",
            "settled depth of the damped column against 0.399687 m, which is that of c0 = 50 m/s, not of the "
            "printed 30",
            "2.8e-3 %; check 5e-3 %", "Issa 2005 §4.1", settled_depth_of_issa),
        claim("ISSA-STATIC, p", "the profile of p lies on theory; check 1 to 2 %", "figure", "Issa 2005 §4.1",
              pressure_of_issa),
        claim("ISSA-STATIC, N", "a finer lattice improves p", "stated, 40, 80, 160", "Issa 2005 §4.1",
              finer_is_better),
        claim("ISSA-STATIC, cubic", "undamped, the cubic kernel at h/dx 1.5 clumps from the wall upwards",
              "1.5 to 1.8 s", "Issa 2005 §4.1", cubic_clumps),
        claim("ISSA-STATIC, quartic", "undamped, the quartic kernel at h/dx 1.5 is stable", "stated",
              "Issa 2005 §4.1", quartic_does_not),
        claim("ISSA-STATIC, damped below 0.1 m", "the disorder passes through to the fluid above", "at 8.5 s",
              "Issa 2005 §4.1", damping_below_is_passed),
        claim("SWEGLE",
              "under pressure what is unstable has its neighbours inside the inflection: -f''(dx/h) > 0",
              "stated", "Swegle et al. 1995; Issa 2005 §2.8",
              [](Runs runs) {
                  return foretold(
                      runs,
                      [](const solver::Kernel& kernel, double ratio) {
                          return -swegle_number(kernel, ratio);
                      },
                      0);
              }),
        claim("TENSILE, lattice",
              "what clumps is what the dispersion of the lattice says: sigma^2 rho dx^2/p above 0.01",
              "derived", "this project: lattice_growth()",
              [](Runs runs) { return foretold(runs, lattice_growth, 0.01); }),
        claim("TENSILE, time",
              "the cubic lattice is lost when round-off has grown to a spacing, within a factor 2", "derived",
              "this project: lattice_growth()", growth_from_round_off),
        claim("TENSILE, cures", "a higher-order kernel reduces it, damping removes it", "stated",
              "Issa 2005 §2.8, §4.1, §4.4", ranked_cures),
        claim("TENSILE, c0", "a larger c0 removes it", "stated (voids behind a step)", "Issa 2005 §2.8, §4.4",
              larger_sound_speed),
        claim("OGER-HYDRO, standard", "error of standard SPH", "100 to 300 % (closed tank)", "Oger 2007",
              [](Runs runs) { return oger_error(runs, oger("sigma_1", "sigma_1"), 1, 3); }),
        claim("OGER-HYDRO, renormalised", "error of the non-coherent renormalised form", "50 to 100 %",
              "Oger 2007",
              [](Runs runs) { return oger_error(runs, oger("renormalised", "renormalised"), 0.5, 1); }),
        claim("OGER-HYDRO, coherent", "error of the coherent renormalised form", "50 to 100 %", "Oger 2007",
              [](Runs runs) {
                  return oger_error(runs, oger("renormalised", "renormalised_coherent"), 0.5, 1);
              }),
        claim("OGER-HYDRO, hybrid", "error of hybrid Taylor-SPH", "<= 10 %", "Oger 2007",
              [](Runs runs) { return oger_error(runs, oger("renormalised", "hybrid_taylor"), 0, 0.1); }),
        claim(
            "OGER-HYDRO, renormalised, unstructured", "the same on an unstructured set, h/dx = 1.5",
            "50 to 100 %", "Oger 2007",
            [](Runs runs) { return oger_error(runs, oger("renormalised", "renormalised", "1.5"), 0.5, 1); }),
        claim(
            "OGER-HYDRO, hybrid, unstructured", "the same on an unstructured set, h/dx = 1.5",
            "<= 50 % near the surface", "Oger 2007",
            [](Runs runs) { return oger_error(runs, oger("renormalised", "hybrid_taylor", "1.5"), 0, 0.5); }),
    };
    std::vector<Claim> of_walls = undulation();
    std::ranges::move(of_walls, std::back_inserter(all));
    return all;
}

std::vector<Condition> settled(const char* pressure_force) {
    return {{"damping", 1, 1e9},
            {"start", 0, 0, "exact"},
            {"arrangement", 0, 0, "lattice"},
            {"pressure_force", 0, 0, pressure_force}};
}

std::vector<Expectation> expectations() {
    std::vector<Expectation> all{
        {.scheme = "wcsph",
         .field = "",
         .where = {{"kernel", 0, 0, "cubic_spline"},
                   {"h_over_dx", 1.5, 1.5},
                   {"start", 0, 0, "uniform"},
                   {"wall_method", 0, 0, "mirror"},
                   {"damping", 0, 0},
                   {"end_time", 1, 12}},
         .order = {std::nullopt, std::nullopt, "Issa 2005 §4.1; derived: lattice_growth() = 0.18"},
         .text =
             "the lattice under pressure is unstable: round-off grows to a spacing, ln(1e16) = 37 times in "
             "1/sigma, 0.44 s at the bed at dx = 10 mm and in proportion to dx; pairs that have collapsed "
             "pass the bed",
         .ends_early = EarlyEnd{.spacing = 0.5, .not_before = 0.05}},
        {.scheme = "wcsph",
         .field = "",
         .where = {{"arrangement", 0, 0, "polar"}, {"pressure_force", 0, 0, "hybrid_taylor"}},
         .order = {0., std::nullopt, "Oger 2007: at most 10 % at t = 0.1 s"},
         .text = "rings of particles under a free surface",
         .waiver =
             "on our rings, of equal masses and cut by the period, particles pass the bed at t = 0.044 s "
             "(0.052 s with gaps at the cut): forces that are not antisymmetric do not keep pairs apart. "
             "Oger's masses, walls and cut are not printed"},
        {.scheme = "wcsph",
         .field = "",
         .where = {{"arrangement", 0, 0, "jittered"}, {"pressure_force", 0, 0, "hybrid_taylor"}},
         .order = {0., std::nullopt, "Oger 2007: at most 50 % on an unstructured set"},
         .text = "a jittered lattice under a free surface",
         .waiver =
             "at 40 rows one of five seeds loses a particle through the bed at t = 0.065 s: forces that "
             "are not antisymmetric do not keep pairs apart"},
        {.scheme = "wcsph",
         .field = "",
         .where = {{"arrangement", 0, 0, "unstructured"}, {"pressure_force", 0, 0, "hybrid_taylor"}},
         .order = {0., std::nullopt, "Oger 2007: at most 50 % at t = 0.1 s"},
         .text = "unstructured particles under a free surface",
         .waiver =
             "of five seeds, two lose a particle through the bed: next to it the form is the "
             "renormalised one, which pairs particles with their images as the cubic kernel at h/dx = 1.5 "
             "does under pressure. Oger's walls are not printed"}};
    for (const char* force : {"sigma_1", "renormalised"}) {
        all.push_back({.scheme = "wcsph",
                       .field = "",
                       .where = {{"arrangement", 0, 0, "unstructured"},
                                 {"pressure_force", 0, 0, force},
                                 {"kernel", 0, 0, "cubic_spline"},
                                 {"h_over_dx", 1.5, 1.5},
                                 {"wall_method", 0, 0, "mirror"},
                                 {"damping", 0, 0},
                                 {"end_time", 0.1, 12}},
                       .order = {std::nullopt, std::nullopt, "derived: lattice_growth() = 0.18"},
                       .text =
                           "the kernel is unstable under pressure: the disorder, a tenth of a spacing, "
                           "grows to one, ln(10) = 2.3 times in 1/sigma, 0.012 s at the bed at dx = 10 mm; "
                           "particles that have paired with their images pass the bed",
                       .ends_early = EarlyEnd{.spacing = 0.5, .not_before = 0.027}});
    }
    const auto on_points = [](const char* field, const char* wall, const Expected& order, const char* text) {
        return Expectation{.scheme = "wcsph",
                           .field = field,
                           .where = {{"damping", 1, 1e9},
                                     {"start", 0, 0, "exact"},
                                     {"arrangement", 0, 0, "lattice"},
                                     {"wall_method", 0, 0, wall}},
                           .order = order,
                           .text = text};
    };
    for (const char* wall : {"repulsive", "repulsive_lennard_jones", "repulsive_normal"}) {
        const char* const truncated =
            "nothing lies beyond the wall, and the force of its points reaches the first row alone: in the "
            "rows whose sums are truncated, a layer of O(h), p is wrong by O(1)";
        for (const char* field : {"pressure", "density"}) {
            all.push_back(
                on_points(field, wall, {0.3, 0.7, "derived: truncated sums at the wall"}, truncated));
        }
        all.push_back(
            on_points("bed_pressure", wall, {-0.2, 0.2, "derived: truncated sums at the wall"}, truncated));
    }
    all.push_back(on_points("settled_depth", "repulsive_normal", {0.8, 1.2, "derived: balance of forces"},
                            "the first row starts dx from the bed and rests where the force of the points "
                            "is the weight of the column: x dx with x^-5 - x^-3 = gH/D, whatever dx is"));
    for (const char* force : {"sigma_1", "sigma_2", "renormalised_coherent"}) {
        for (const char* field : {"pressure", "density"}) {
            all.push_back(
                {.scheme = "wcsph",
                 .field = field,
                 .where = settled(force),
                 .order = {1.3, 1.7, "derived: antisymmetric forces carry the weight above exactly"},
                 .text = "through every plane passes the weight above it, so the interior is wrong by "
                         "O(h^2); in the rows of the surface, a layer of O(h), the truncated sum is "
                         "wrong by O(1) and p by O(rho g h): order 2 in L1, 3/2 in L2, 1 in Linf, "
                         "down to the quadrature floor of the kernel"});
        }
    }
    all.push_back({.scheme = "wcsph",
                   .field = "settled_depth",
                   .where = settled("renormalised_coherent"),
                   .order = {1.7, 2.3, "derived: the integral of the pressure error"},
                   .text = "the column is shorter by the integral of p/(rho c^2): the error of p in L1"});
    for (const char* force : {"renormalised", "hybrid_taylor"}) {
        for (const char* field : {"pressure", "density", "settled_depth"}) {
            all.push_back({.scheme = "wcsph",
                           .field = field,
                           .where = settled(force),
                           .order = {0.8, 1.2, "derived: forces that are not antisymmetric lose weight"},
                           .text =
                               "the rows of the surface do not pass all of their weight on to those below: "
                               "p is off by O(rho g h) all the way down"});
        }
    }
    for (const char* scheme : {"isph_df", "isph_dfs"}) {
        for (const char* field : {"pressure", "bed_pressure"}) {
            all.push_back(
                {.scheme = scheme,
                 .field = field,
                 .where = {},
                 .order = {0.8, 1.2, "derived: p = 0 at the centres of the surface row"},
                 .text = "they lie half a spacing below the surface: p is low by rho g dx/2, sqrt(3)/(2n) "
                         "of it in L2 and 1/(2n) at the bed (a Laplacian exact for linear p shows "
                         "these digits)"});
        }
    }
    for (const char* scheme : {"isph_lee", "isph_asai"}) {
        all.push_back(
            {.scheme = scheme,
             .field = "",
             .where = {{"gradient", 0, 0, "symmetric"}, {"minimum_spacing", 0.25, 1}},
             .order = {std::nullopt, std::nullopt, "derived: truncated sums at the surface"},
             .text = "a row with p = 0 and no row above it is held up by part of its weight only, "
                     "sum V p_j gradW; it comes down to dx/4 above the next no sooner than in free fall, "
                     "sqrt(1.5 dx/g) (0.039 s at dx = 10 mm)",
             .ends_early = EarlyEnd{.spacing = 0.25, .not_before = 0.039}});
    }
    return all;
}

std::vector<std::string> cure_labels() {
    std::vector<std::string> labels;
    for (const Cure& cure : cures()) {
        labels.push_back(cure.label);
    }
    return labels;
}

std::map<std::string, std::string> variant_names() {
    std::map<std::string, std::string> names{{undamped(), "Issa's column"},
                                             {damped(), "Issa's column, damped"},
                                             {damped_below(), "Issa's column, damped at the bed"}};
    for (const char* wall : {"mirror", "fixed", "repulsive", "repulsive_lennard_jones", "repulsive_normal"}) {
        for (const char* kernel : {quintic, wendland}) {
            for (const bool damps : {true, false}) {
                for (const char* points : {"1", "4"}) {
                    std::string name = std::string("wcsph, ") + wall;
                    name += std::string_view(points) == "1" ? "" : ", 4 points per dx";
                    name += std::string_view(kernel) == quintic ? "" : ", wendland_c2";
                    names[on_wall(wall, kernel, damps, points)] = name + (damps ? ", damped" : "");
                }
            }
        }
    }
    return names;
}

/// On every wall that a compressible column may have.
std::vector<std::string> wall_labels(const char* kernel, bool damps) {
    std::vector<std::string> labels;
    for (const char* wall : {"mirror", "fixed", "repulsive", "repulsive_lennard_jones", "repulsive_normal"}) {
        labels.push_back(on_wall(wall, kernel, damps));
    }
    for (const char* wall : {"repulsive", "repulsive_lennard_jones"}) {
        labels.push_back(on_wall(wall, kernel, damps, "4"));
    }
    return labels;
}

std::vector<Study> studies() {
    const std::vector<std::string> forms{
        form("sigma_2", "sigma_2"),           form("sigma_1", "sigma_1"),
        form("sigma_2", "sigma_1"),           form("renormalised", "renormalised_coherent"),
        form("renormalised", "renormalised"), form("renormalised", "hybrid_taylor")};
    const std::vector<std::string> incompressible{"isph_df", "isph_dfs", dfs_schwaiger,
                                                  lee,       asai,       lee_normalised};
    std::vector<std::string> undamped_walls = wall_labels(quintic, false);
    const std::vector<std::string> with_wendland = wall_labels(wendland, false);
    undamped_walls.insert(undamped_walls.end(), with_wendland.begin(), with_wendland.end());
    std::vector<std::string> rest = forms;
    rest.insert(rest.end(), {"isph_dfs", dfs_schwaiger});
    const std::vector<std::string> of_oger{oger("sigma_1", "sigma_1"), oger("renormalised", "renormalised"),
                                           oger("renormalised", "renormalised_coherent"),
                                           oger("renormalised", "hybrid_taylor")};
    return {
        // Damped near critically: 2 c0 pi/(2H) = 156/s.
        {.name = "hydrostatic/settled",
         .tier = Tier::quick,
         .schemes = forms,
         .settings = {{"damping", "150"}, {"end_time", "0.4"}},
         .ladder = {10, 14, 20, 28, 40},
         .cost = 25,
         .picture_at = 40},
        {.name = "hydrostatic/incompressible",
         .tier = Tier::quick,
         .schemes = incompressible,
         .settings = {{"end_time", "1"}},
         .ladder = {10, 14, 20, 28, 40},
         .cost = 25,
         .picture_at = 40},
        // 100 H/c0 = 2.02 s.
        {.name = "hydrostatic/sound",
         .tier = Tier::quick,
         .schemes = rest,
         .settings = {{"end_time", "2.02"}},
         .ladder = {10, 14, 20},
         .cost = 30},
        {.name = "hydrostatic/issa",
         .tier = Tier::quick,
         .schemes = cure_labels(),
         .settings = {{"start", "uniform"}, {"end_time", "2"}},
         .ladder = {40},
         .cost = 60,
         .picture_at = 40},
        {.name = "hydrostatic/jittered",
         .tier = Tier::nightly,
         .schemes = rest,
         .settings = {{"arrangement", "jittered"}, {"jitter", "0.1"}, {"minimum_spacing", "0"}},
         .ladder = {20, 40},
         .cost = 40},
        {.name = "hydrostatic/oger",
         .tier = Tier::quick,
         .schemes = of_oger,
         .settings = {{"arrangement", "polar"}, {"columns", "40"}, {"end_time", "0.1"}},
         .ladder = {40},
         .cost = 8,
         .picture_at = 40},
        {.name = "hydrostatic/oger_unstructured",
         .tier = Tier::nightly,
         .schemes = {oger("sigma_1", "sigma_1", "1.5"), oger("renormalised", "renormalised", "1.5"),
                     oger("renormalised", "hybrid_taylor", "1.5")},
         .settings = {{"arrangement", "unstructured"}, {"columns", "40"}, {"end_time", "0.1"}},
         .ladder = {40},
         .cost = 25},
        {.name = "hydrostatic/repulsive",
         .tier = Tier::nightly,
         .schemes = wall_labels(quintic, true),
         .settings = {{"end_time", "0.4"}},
         .ladder = {9, 14, 20, 28, 40},
         .cost = 30,
         .picture_at = 40},
        {.name = "hydrostatic/repulsive_undamped",
         .tier = Tier::nightly,
         .schemes = undamped_walls,
         .settings = {{"end_time", "0.4"}},
         .ladder = {20, 40},
         .cost = 25,
         .picture_at = 40},
        {.name = "hydrostatic/sound_fine",
         .tier = Tier::nightly,
         .schemes = rest,
         .settings = {{"end_time", "2.02"}},
         .ladder = {10, 20, 40, 80},
         .cost = 210},
        {.name = "hydrostatic/issa_fine",
         .tier = Tier::nightly,
         .schemes = {damped()},
         .settings = {{"start", "uniform"}, {"end_time", "2"}},
         .ladder = {40, 80},
         .cost = 30},
        {.name = "hydrostatic/issa_finest",
         .tier = Tier::full,
         .schemes = {damped(), undamped(), issa(quartic, "1.5")},
         .settings = {{"start", "uniform"}, {"end_time", "12"}},
         .ladder = {40, 80, 160},
         .cost = 21600},
    };
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
        .expectations = expectations(),
        .claims = claims(),
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
        .variant_names = variant_names(),
    };
    return flow;
}

} // namespace sphvv::verification::cases
