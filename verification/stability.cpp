#include "sphvv/verification/stability.hpp"

#include "sphvv/solver/schemes.hpp"
#include "sphvv/verification/linearised_step.hpp"
#include "sphvv/verification/markdown_table.hpp"
#include "sphvv/verification/scene.hpp"
#include "sphvv/verification/strained_flow.hpp"
#include "sphvv/verification/tensile_instability.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <random>

namespace sphvv::verification {
namespace {

/// Growth per step that is unstable: by sqrt(2) in a part.
double unstable_growth_of(int part) {
    return std::pow(unstable_growth, static_cast<double>(steps_of_a_part) / part);
}

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double resolution = 1.005; // of the bisection
constexpr double agreement = 0.05;

using Tree = nlohmann::ordered_json;

std::string number(double value, const char* format) {
    if (std::isinf(value)) {
        return "none";
    }
    if (std::isnan(value)) { // the ratio of none to none
        return "–";
    }
    char text[32];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

bool is_pressed(const LatticeScene& scene) {
    const solver::Settings settings = settings_of(scene);
    return scene.pressure ||
           (settings.has("background_pressure") && settings.number("background_pressure") > 0);
}

using Spectrum = Eigen::MatrixXd;

/// Squares of the amplitudes of every wave vector, in units of dx and dt: |v(k)|^2 + c0^2 |s(k)|^2, which
/// sound keeps, of velocity and relative density at the lattice points where particles started; of an
/// incompressible scheme's lattice that moves, |x(k)|^2 of the displacements, too.
class Energies {
public:
    Energies(const LatticeScene& scene, double dt)
        : scene_(scene), displacements_(scene.moves() && !variant_of(scene.scheme).scheme->compressible),
          pressed_(is_pressed(scene)), sound_speed_(scene.sound_speed * dt / scene.dx()),
          waves_(Grid::NullaryExpr(scene.n, scene.n, [&](Eigen::Index a, Eigen::Index x) {
              return std::polar(1., -2 * std::numbers::pi * static_cast<double>(a * x % scene.n) / scene.n);
          })) {}

    /// Under pressure the energy of displacements is part of what sound keeps, which has no sign: then the
    /// mean over all wave vectors, in place of each.
    Spectrum operator()(const solver::Simulation<2>& s) const {
        Spectrum energy = Spectrum::Zero(scene_.n, scene_.n);
        for (int d = 0; d < 2; ++d) {
            add(s, s.particles.velocity.components[d], 1, energy);
            if (displacements_) {
                add(s, displacements(s, d), 1, energy);
            }
        }
        if (const solver::Field* density = s.particles.find("density"); density != nullptr) {
            add(s, density->components[0], sound_speed_, energy);
        }
        energy(0, 0) = 0; // the mean
        if (pressed_) {
            energy.setConstant(energy.mean());
        }
        return energy;
    }

private:
    using Grid = Eigen::MatrixXcd;

    void add(const solver::Simulation<2>& s, const std::vector<double>& values, double scale,
             Spectrum& energy) const {
        Grid grid(scene_.n, scene_.n);
        for (std::size_t k = 0; k < values.size(); ++k) {
            grid(s.particles.id[k] % scene_.n, s.particles.id[k] / scene_.n) = scale * values[k];
        }
        energy += (waves_ * grid * waves_.transpose()).cwiseAbs2();
    }

    /// From the lattice, but for the motion of the whole, which is that of the particle that is first here.
    std::vector<double> displacements(const solver::Simulation<2>& s, int d) const {
        const auto moved = [&](std::size_t k) {
            const int id = s.particles.id[k];
            return s.particles.position[d][k] - (d == 0 ? id % scene_.n : id / scene_.n);
        };
        const double first = moved(0);
        std::vector<double> all(s.particles.size());
        for (std::size_t k = 0; k < all.size(); ++k) {
            const double apart = moved(k) - first;
            all[k] = apart - scene_.n * std::round(apart / scene_.n);
        }
        return all;
    }

    LatticeScene scene_;
    bool displacements_;
    bool pressed_;
    double sound_speed_;
    Grid waves_;
};

/// Whether density errors are taken out by impulses: the rounding of the summed density, divided by dt, is
/// then a noise of 1e-8 dx/dt at any amplitude.
bool sums_density(const solver::Simulation<2>& s) {
    return s.particles.find("particle_density") != nullptr;
}

solver::Simulation<2> disturbed_lattice(const LatticeScene& scene, double dt) {
    solver::Simulation<2> s = lattice_simulation(scene, dt);
    // Of incompressible schemes more: their pressure solver takes less than a share of U for round-off.
    const bool compressible = variant_of(scene.scheme).scheme->compressible;
    const double share = compressible ? 1e-8 * scene.sound_speed : sums_density(s) ? 1e-4 : 1e-6;
    const double amplitude = share * dt / scene.dx();
    std::mt19937_64 engine(20261123);
    const auto disturb = [&](std::vector<double>& values, double by) {
        for (double& value : values) {
            value += by * (2 * static_cast<double>(engine() >> 11U) * 0x1p-53 - 1);
        }
    };
    const bool displaced = scene.moves() && !compressible;
    for (int d = 0; d < 2; ++d) {
        disturb(displaced ? s.particles.position.components[d] : s.particles.velocity.components[d],
                displaced ? 1e-6 : amplitude);
    }
    return s;
}

double published_step(Limit limit, const LatticeScene& scene, double h) {
    switch (limit) {
    case Limit::acoustic:
        return 0.4 * h / scene.sound_speed;
    case Limit::viscous:
        return 0.125 * h * h / scene.viscosity;
    case Limit::force:
        return 0.25 * std::sqrt(h / scene.body_force);
    case Limit::advective:
    case Limit::strained:
        break;
    }
    return 0.2 * h; // U = 1 m/s
}

/// So that the step is bound by what the study is about.
LatticeScene scene_for(const StabilityStudy& study, const std::string& scheme) {
    LatticeScene scene{.scheme = scheme, .n = study.n};
    if (study.limit == Limit::viscous) {
        scene.viscosity = 10 * scene.sound_speed * smoothing_length(scene);
    }
    scene.speed = study.limit == Limit::advective ? 1 : 0;
    scene.body_force = study.limit == Limit::force ? 1 : 0;
    return scene;
}

constexpr double least = 0.05; // times the published step: the shortest and
constexpr double most = 40;    // the longest that are tried

void find_theory(StabilityLimit& result, const LatticeScene& scene) {
    if (const auto state = lattice_state(scene)) {
        result.theory_by = "lattice sums";
        result.theory =
            stability_limit(*state, stepping_of(scene), 0.02 * result.published, scene.n) / result.published;
        return;
    }
    result.theory_by = "linearised step";
    const double shortest = least * result.published;
    result.theory = linearised_limit(scene, shortest, most * result.published) / result.published;
    if (result.theory == 0) {
        result.reason += ", which grows at any step: by " +
                         number(std::log(linearised_growth(scene, shortest)) / shortest, "%.2f") +
                         " per second at the shortest";
    }
}

StabilityLimit find_limit(const StabilityStudy& study, const std::string& scheme,
                          const StabilityProgress& progress, double done, double share) {
    const auto begin = std::chrono::steady_clock::now();
    const LatticeScene scene = scene_for(study, scheme);
    const solver::Settings settings = settings_of(scene);
    StabilityLimit result{.study = study.name,
                          .scheme = scheme,
                          .kernel = settings.word("kernel"),
                          .h_over_dx = settings.number("h_over_dx"),
                          .limit = std::string(to_string(study.limit)),
                          .published = published_step(study.limit, scene, smoothing_length(scene)),
                          .theory_by = "",
                          .theory = 0,
                          .measured = 0,
                          .low = 1 - agreement,
                          .high = 1 + agreement,
                          .verdict = "",
                          .reason = "theory is exact for a lattice and a small disturbance: within 5 %",
                          .runs = 0,
                          .seconds = 0};
    if (study.limit == Limit::force && variant_of(scheme).scheme->compressible) {
        // 0.4 h/(10 sqrt(f H)) over 0.25 sqrt(h/f), H = 1 m
        result.reason += "; sound binds first: as c0 = 10 sqrt(f H), its bound is 0.16 sqrt(h/H) = " +
                         number(0.16 * std::sqrt(smoothing_length(scene)), "%.3f") + " of that of the force";
    }
    std::function<bool(double)> fails = [&](double dt) { return disturb(scene, dt).grows; };
    if (study.limit == Limit::strained) {
        const StrainedFlow flow{scheme, scene.n};
        result.theory_by = "fold";
        result.theory = fold_step(flow) / result.published;
        result.low = 1 / result.theory;
        result.high = resolution; // the fold is a bound from above
        result.reason =
            "the arrangement is kept at the published step, and lost where the drift folds the fluid, n = " +
            std::to_string(flow.n);
        fails = [flow](double dt) { return !keeps_arrangement(flow, dt); };
    } else {
        find_theory(result, scene);
    }
    const auto grows = [&](double multiple) {
        ++result.runs;
        if (progress) {
            progress(study.name + "  " + scheme + "  dt = " + solver::shortest(multiple) + " x published",
                     done + share * std::min(1., result.runs / 16.));
        }
        return fails(multiple * result.published);
    };
    double low = least;
    if (!grows(low)) {
        double high = low;
        bool found = false;
        while (!found && high < most) {
            low = high;
            high = std::min(2 * low, most);
            found = grows(high);
        }
        while (found && high > resolution * low) {
            const double middle = std::sqrt(low * high);
            (grows(middle) ? high : low) = middle;
        }
        result.measured = found ? std::sqrt(low * high) : infinity;
    }
    judge(result);
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return result;
}

std::string with_h(const std::string& scheme, double h_over_dx) {
    return scheme + ":h_over_dx=" + solver::shortest(h_over_dx);
}

bool criterion_says_unstable(MapAxes axes, const LatticeScene& scene, double h_over_dx, double pressure) {
    const solver::Kernel& kernel = solver::kernels::find(settings_of(scene).word("kernel"));
    return axes == MapAxes::tensile ? swegle_number(kernel, h_over_dx) * pressure < 0
                                    : smallest_transform(kernel, h_over_dx) < 0;
}

StabilityMap find_map(const StabilityStudy& study, const std::string& scheme,
                      const StabilityProgress& progress, double done, double share) {
    const auto begin = std::chrono::steady_clock::now();
    const bool pressed = study.map != MapAxes::step;
    StabilityMap map{.study = study.name,
                     .scheme = scheme,
                     .x_name = "h/dx",
                     .x = {},
                     .y_name = pressed                          ? "p/(rho c0^2)"
                               : study.limit == Limit::acoustic ? "dt c0/(0.4 h)"
                                                                : "dt nu/(0.125 h^2)",
                     .y = {},
                     .theory = {},
                     .measured = {},
                     .grows = {},
                     .criterion = study.map == MapAxes::tensile   ? "w'' p < 0"
                                  : study.map == MapAxes::pairing ? "negative transform"
                                                                  : "",
                     .by_criterion = {},
                     .disagreements = 0,
                     .undecided = 0,
                     .verdict = "",
                     .reason = "",
                     .seconds = 0,
                     .part = study.part};
    if (study.map == MapAxes::pairing) {
        for (int k = 0; k <= 8; ++k) {
            map.x.push_back(1 + 0.25 * k);
        }
        // Growth is as the root of the pressure. At less it is too slow to be seen, the more so where short
        // waves of a smooth kernel drift freely: their displacements grow as t and hide what grows by 0.4 % a
        // step (Gaussian at 0.05, h/dx = 2 and 3).
        map.y = {0.1, 0.2, 0.4};
    } else {
        for (int k = 0; k <= 10; ++k) {
            map.x.push_back(1 + 0.1 * k);
            map.y.push_back(pressed ? 0.01 * (k - 5) : 3 + 0.25 * k);
        }
    }
    for (const double y : map.y) {
        for (const double x : map.x) {
            LatticeScene scene = scene_for(study, with_h(scheme, x));
            if (pressed) {
                scene.pressure = y * scene.sound_speed * scene.sound_speed;
            }
            const double published = published_step(study.limit, scene, x * scene.dx());
            const double dt = pressed ? 0.5 * published : y * published;
            const auto state = lattice_state(scene);
            map.theory.push_back(state ? growth_factor(*state, stepping_of(scene), dt, scene.n)
                                       : linearised_growth(scene, dt));
            const Disturbance found = disturb(scene, dt, study.part);
            map.grows.push_back(found.grows ? 1 : 0);
            map.measured.push_back(found.growth);
            if (pressed) {
                map.by_criterion.push_back(criterion_says_unstable(study.map, scene, x, y) ? 1 : 0);
            }
            if (progress) {
                const double all = static_cast<double>(map.x.size() * map.y.size());
                progress(study.name + "  " + scheme,
                         done + share * static_cast<double>(map.grows.size()) / all);
            }
        }
    }
    judge(map);
    map.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return map;
}

Tree finite_or_null(double value) {
    return std::isfinite(value) ? Tree(value) : Tree(nullptr);
}

} // namespace

std::string_view to_string(Limit limit) {
    switch (limit) {
    case Limit::acoustic:
        return "acoustic";
    case Limit::viscous:
        return "viscous";
    case Limit::advective:
        return "advective";
    case Limit::strained:
        return "strained";
    case Limit::force:
        break;
    }
    return "force";
}

Stepping stepping_of(const LatticeScene& scene) {
    if (!variant_of(scene.scheme).scheme->compressible) {
        return Stepping::projection;
    }
    const solver::Settings settings = settings_of(scene);
    const std::string& integrator = settings.word("integrator");
    return integrator == "explicit"              ? Stepping::explicit_euler
           : integrator == "predictor_corrector" ? Stepping::predictor_corrector
                                                 : Stepping::verlet;
}

std::optional<LatticeState> lattice_state(const LatticeScene& scene) {
    const solver::Scheme& scheme = *variant_of(scene.scheme).scheme;
    const solver::Settings settings = settings_of(scene);
    LatticeState state{.kernel = &solver::kernels::find(settings.word("kernel")),
                       .h_over_dx = settings.number("h_over_dx"),
                       .dx = scene.dx(),
                       .sound_speed = scheme.compressible ? scene.sound_speed : 0,
                       .viscosity = scene.viscosity};
    if (!scheme.compressible) {
        const bool projects =
            scheme.name == "isph_df" || scheme.name == "isph_dfs" || scheme.name == "isph_lee";
        if (scene.moves() || !projects || settings.word("laplacian") != "morris" ||
            settings.word("viscosity") != "laplacian") {
            return std::nullopt;
        }
        state.eta_over_h = settings.number("eta_over_h");
        return state;
    }
    for (const char* key : {"pressure_force", "continuity"}) {
        if (settings.word(key) != "sigma_1" && settings.word(key) != "sigma_2") {
            return std::nullopt;
        }
    }
    state.eta_over_h = settings.number("eta_over_h");
    state.monaghan_cleary = settings.word("viscosity") == "monaghan_cleary";
    state.pressure = scene.pressure.value_or(settings.number("background_pressure"));
    if (scene.pressure) {
        state.density = 1 + *scene.pressure / (scene.sound_speed * scene.sound_speed);
    }
    return state;
}

void check_scheme(const StabilityStudy& study, const std::string& scheme) {
    const LatticeScene scene = scene_for(study, scheme);
    const Variant variant = variant_of(scheme);
    settings_of(scene);
    if ((study.limit == Limit::acoustic || study.map != MapAxes::none) && !variant.scheme->compressible) {
        throw UserError(study.name + " takes schemes with a sound speed (wcsph), not '" + scheme + "'");
    }
    if ((study.limit == Limit::advective || study.limit == Limit::strained) && variant.scheme->compressible) {
        throw UserError(study.name + " takes incompressible schemes, not '" + scheme + "'");
    }
}

Disturbance disturb(const LatticeScene& scene, double dt, int part) {
    solver::Simulation<2> s = disturbed_lattice(scene, dt);
    const Energies energies(scene, dt);
    const double start = energies(s).mean();
    constexpr double linear = 1e8; // times the energy of the start: the amplitude is still small
    // Of the same; that of the density is 1e-11. What grows has had its share from the start, and never been
    // so small.
    const double round_off = sums_density(s) ? 1e-6 : 1e-9;
    std::array<Spectrum, 3> largest;
    largest.fill(Spectrum::Zero(scene.n, scene.n));
    try {
        for (int step = 0; step < 3 * part; ++step) {
            advance(s);
            const Spectrum energy = energies(s);
            largest[step / part] = largest[step / part].cwiseMax(energy);
            if (energy.maxCoeff() > linear * start) {
                return {true, std::pow(energy.maxCoeff() / start, 0.5 / (step + 1)), ""};
            }
        }
    } catch (const solver::Diverged& end) {
        return {true, infinity, end.what()};
    }
    double ratio = 0;
    for (Eigen::Index k = 0; k < largest[2].size(); ++k) {
        if (largest[2](k) > round_off * start) {
            ratio = std::max(ratio, largest[2](k) / largest[1](k));
        }
    }
    const double growth = std::pow(ratio, 0.5 / part);
    return {growth > unstable_growth_of(part), growth, ""};
}

std::span<const StabilityStudy> stability_studies() {
    static const std::vector<StabilityStudy> all = [] {
        const auto variants = [](std::string scheme, const std::vector<std::string>& kernels,
                                 const std::vector<double>& widths) {
            std::vector<std::string> result;
            scheme += ":kernel=";
            for (const std::string& kernel : kernels) {
                for (const double width : widths) {
                    result.push_back(with_h(scheme + kernel, width));
                }
            }
            return result;
        };
        const auto joined = [](std::vector<std::string> a, const std::vector<std::string>& b) {
            a.insert(a.end(), b.begin(), b.end());
            return a;
        };
        const std::vector<std::string> common{"cubic_spline", "quintic_spline", "wendland_c2"};
        const std::vector<std::string> every{"cubic_spline",   "gaussian",    "quartic_spline",
                                             "quintic_spline", "wendland_c2", "wendland_c4",
                                             "wendland_c6"};
        const std::string plain = "wcsph:background_pressure=0";
        const std::string monaghan = plain + ":viscosity=monaghan_cleary";
        const std::string source = "linear theory of the lattice (von_neumann.hpp)";
        std::vector<std::string> incompressible;
        for (const char* scheme : {"isph_df", "isph_dfs", "isph_di", "isph_dfdi", "isph_lee", "isph_asai"}) {
            // The quadratic kernel is not among them: its slope jumps at the edge of the support.
            incompressible = joined(incompressible, variants(scheme, every, {1.3}));
        }
        incompressible = joined(incompressible, variants("isph_mls", every, {1.8}));
        // Density invariance moves particles again after the drift (isph_dfdi), and its impulses feed the
        // energy the more the shorter the step (isph_di): no bound of the drift is one of theirs.
        const std::vector<std::string> strained{"isph_df", "isph_dfs", "isph_lee", "isph_asai", "isph_mls"};
        return std::vector<StabilityStudy>{
            {.name = "stability/acoustic",
             .tier = Tier::quick,
             .summary = "largest dt of sound, in 0.4 h/c0",
             .source = source,
             .cost = 15,
             .limit = Limit::acoustic,
             .schemes = joined(variants(plain, common, {1.3, 2}),
                               {plain + ":integrator=predictor_corrector", plain + ":integrator=verlet",
                                "wcsph:kernel=quintic_spline:background_pressure=20",
                                plain + ":pressure_force=taylor:continuity=renormalised"})},
            {.name = "stability/viscous",
             .tier = Tier::quick,
             .summary = "largest dt of explicit viscosity, in 0.125 h^2/nu",
             .source = source,
             .cost = 50,
             .limit = Limit::viscous,
             .schemes =
                 joined(joined(variants(plain, common, {1.3}), variants(monaghan, common, {1.3})),
                        {plain + ":integrator=predictor_corrector", plain + ":integrator=verlet", "isph_df",
                         "isph_dfs", "isph_lee", "isph_di", "isph_dfdi", "isph_asai", "isph_mls"})},
            {.name = "stability/advective",
             .tier = Tier::quick,
             .summary =
                 "largest dt in a uniform stream, in 0.2 h/U: none of a scheme that follows the fluid, but "
                 "for shifts and the damping of isph_mls",
             .source = "Galilean invariance; " + source,
             .cost = 8,
             .limit = Limit::advective,
             .schemes = {"isph_df", "isph_dfs", "isph_di", "isph_mls:shift_disorder=0"}},
            {.name = "stability/strained",
             .tier = Tier::quick,
             .summary = "largest dt in Taylor-Green vortices, in 0.2 h/U: the drift squeezes particles, and "
                        "folds the fluid",
             .source = "derived in strained_flow.hpp",
             .cost = 4,
             .limit = Limit::strained,
             .schemes = strained,
             .n = 20},
            {.name = "stability/force",
             .tier = Tier::quick,
             .summary = "largest dt in free fall, in 0.25 sqrt(h/f): none but that of sound",
             .source = "equivalence of free fall and rest; " + source,
             .cost = 3,
             .limit = Limit::force,
             .schemes = {plain, "isph_df"}},
            {.name = "stability/acoustic_map",
             .tier = Tier::quick,
             .summary = "growth over h/dx and dt",
             .source = source,
             .cost = 7,
             .limit = Limit::acoustic,
             .schemes = {plain + ":kernel=wendland_c2"},
             .map = MapAxes::step},
            {.name = "stability/tensile_map",
             .tier = Tier::quick,
             .summary =
                 "growth over h/dx and the pressure: clumping in tension, or under pressure inside the "
                 "inflection of the kernel",
             .source = "Swegle et al. 1995; Issa 2005 §2.8, appendix B; " + source,
             .cost = 20,
             .limit = Limit::acoustic,
             .schemes = {"wcsph:kernel=cubic_spline", "wcsph:kernel=wendland_c2"},
             .map = MapAxes::tensile},
            {.name = "stability/pairing_map",
             .tier = Tier::quick,
             .summary = "growth over h/dx from 1 to 3 and positive pressures: pairing",
             .source = "Dehnen & Aly 2012; " + source,
             .cost = 15,
             .limit = Limit::acoustic,
             .schemes = {"wcsph:kernel=cubic_spline", "wcsph:kernel=wendland_c2"},
             .map = MapAxes::pairing,
             .n = 20}, // two supports of the widest kernel
            {.name = "stability/acoustic_every_kernel",
             .tier = Tier::nightly,
             .summary = "largest dt of sound, in 0.4 h/c0",
             .source = source,
             .cost = 55,
             .limit = Limit::acoustic,
             .schemes = variants(plain, every, {1.2, 1.5, 1.8, 2})},
            {.name = "stability/viscous_every_kernel",
             .tier = Tier::nightly,
             .summary = "largest dt of explicit viscosity, in 0.125 h^2/nu",
             .source = source,
             .cost = 70,
             .limit = Limit::viscous,
             .schemes =
                 joined(variants(plain, every, {1.2, 1.5, 2}), variants(monaghan, every, {1.2, 1.5, 2}))},
            {.name = "stability/tensile_every_kernel",
             .tier = Tier::nightly,
             .summary = "growth over h/dx and the pressure",
             .source = "Swegle et al. 1995; Issa 2005 §2.8, appendix B; " + source,
             .cost = 70,
             .limit = Limit::acoustic,
             .schemes = {"wcsph:kernel=gaussian", "wcsph:kernel=quartic_spline",
                         "wcsph:kernel=quintic_spline", "wcsph:kernel=wendland_c4",
                         "wcsph:kernel=wendland_c6"},
             .map = MapAxes::tensile},
            {.name = "stability/pairing_every_kernel",
             .tier = Tier::nightly,
             .summary = "growth over h/dx from 1 to 3 and positive pressures: pairing",
             .source = "Dehnen & Aly 2012; " + source,
             .cost = 150,
             .limit = Limit::acoustic,
             .schemes = {"wcsph:kernel=gaussian", "wcsph:kernel=quartic_spline",
                         "wcsph:kernel=quintic_spline", "wcsph:kernel=wendland_c4",
                         "wcsph:kernel=wendland_c6"},
             .map = MapAxes::pairing,
             .n = 20,
             .part = 800}, // smooth kernels pair slowly
            {.name = "stability/viscous_every_scheme",
             .tier = Tier::nightly,
             .summary = "largest dt of explicit viscosity of the incompressible schemes, kernel by kernel",
             .source = source,
             .cost = 250,
             .limit = Limit::viscous,
             .schemes = incompressible},
            {.name = "stability/advective_every_scheme",
             .tier = Tier::nightly,
             .summary = "largest dt in a uniform stream, in 0.2 h/U",
             .source = "Galilean invariance; " + source,
             .cost = 20,
             .limit = Limit::advective,
             .schemes = {"isph_lee", "isph_dfdi", "isph_asai",
                         "isph_dfdi:density_tolerance=1e-09:density_iterations=1"}},
            {.name = "stability/strained_fine",
             .tier = Tier::nightly,
             .summary = "largest dt in Taylor-Green vortices, in 0.2 h/U, on twice as many particles a side",
             .source = "derived in strained_flow.hpp",
             .cost = 30,
             .limit = Limit::strained,
             .schemes = strained,
             .n = 40},
            {.name = "stability/force_every_scheme",
             .tier = Tier::nightly,
             .summary = "largest dt in free fall, in 0.25 sqrt(h/f)",
             .source = "equivalence of free fall and rest; " + source,
             .cost = 15,
             .limit = Limit::force,
             .schemes = {"isph_lee", "isph_di", "isph_dfdi", "isph_asai"}},
        };
    }();
    return all;
}

StabilityResults run_stability(const StabilityStudy& study, std::span<const std::string> schemes,
                               const StabilityProgress& progress) {
    const std::vector<std::string> wanted =
        schemes.empty() ? study.schemes : std::vector<std::string>(schemes.begin(), schemes.end());
    StabilityResults results;
    const double share = 1. / static_cast<double>(wanted.size());
    for (std::size_t k = 0; k < wanted.size(); ++k) {
        const double done = static_cast<double>(k) * share;
        if (study.map != MapAxes::none) {
            results.maps.push_back(find_map(study, wanted[k], progress, done, share));
        } else {
            results.limits.push_back(find_limit(study, wanted[k], progress, done, share));
        }
    }
    return results;
}

void judge(StabilityLimit& limit) {
    const double ratio = limit.measured / limit.theory;
    const bool agrees = std::isinf(limit.theory) ? std::isinf(limit.measured)
                        : limit.theory == 0      ? limit.measured == 0
                                                 : ratio >= limit.low && ratio <= limit.high;
    limit.verdict = agrees ? "PASS" : "FAIL";
}

void judge(StabilityMap& map) {
    // Half of what a wave vector's velocity has at the start is in the wave that grows. That one of 255,
    // among others that keep their energy, is seen once it has 32 times its amplitude, two parts on.
    const double seen = std::pow(32., 0.5 / map.part);
    map.disagreements = 0;
    map.undecided = 0;
    for (std::size_t k = 0; k < map.grows.size(); ++k) {
        const bool slow = map.theory[k] > 1 + 1e-4 && map.theory[k] < seen;
        map.undecided += slow ? 1 : 0;
        map.disagreements += !slow && (map.grows[k] != 0) != (map.theory[k] >= seen) ? 1 : 0;
    }
    const bool mostly_undecided = 2 * map.undecided > static_cast<int>(map.grows.size());
    map.verdict = map.disagreements > 0 ? "FAIL" : mostly_undecided ? "INCONCLUSIVE" : "PASS";
    map.reason =
        std::to_string(map.disagreements) + " of " + std::to_string(map.grows.size()) +
        " points are stable where theory says they grow, or grow where it says they are stable; on " +
        std::to_string(map.undecided) + " more they grow by less than " + number(100 * (seen - 1), "%.1f") +
        " % a step, too slowly for " + std::to_string(3 * map.part) + " steps to tell";
}

std::string markdown(const StabilityResults& results) {
    std::string text;
    if (!results.limits.empty()) {
        text += "\n### largest stable time steps, as multiples of the published bound\n\n";
        MarkdownTable table({"study", "scheme", "kernel", "h/dx", "bound", "theory", "by", "measured",
                             "ratio", "verdict", "runs", "seconds"});
        for (const StabilityLimit& limit : results.limits) {
            table.add({limit.study, limit.scheme, limit.kernel, number(limit.h_over_dx, "%.2f"), limit.limit,
                       number(limit.theory, "%.3f"), limit.theory_by, number(limit.measured, "%.3f"),
                       number(limit.measured / limit.theory, "%.3f"), limit.verdict,
                       std::to_string(limit.runs), number(limit.seconds, "%.2f")});
        }
        text += table.text();
    }
    for (const StabilityMap& map : results.maps) {
        text += "\n### " + map.study + ": " + map.scheme + "\n\n";
        std::vector<std::string> header{map.y_name + " \\ " + map.x_name};
        for (const double x : map.x) {
            header.push_back(number(x, "%.1f"));
        }
        MarkdownTable table(header);
        for (std::size_t r = map.y.size(); r-- > 0;) {
            std::vector<std::string> row{number(map.y[r], "%.2f")};
            for (std::size_t c = 0; c < map.x.size(); ++c) {
                const std::size_t k = r * map.x.size() + c;
                const bool unstable = map.theory[k] > unstable_growth_of(map.part);
                row.push_back(std::string(map.grows[k] != 0 ? "grows" : "·") +
                              ((map.grows[k] != 0) == unstable ? "" : " (!)"));
            }
            table.add(row);
        }
        text += table.text() + "\n(!): theory says otherwise, or growth is too slow to tell. " + map.reason +
                ": " + map.verdict + "\n";
    }
    return text;
}

void add_to_document(const StabilityResults& results, Tree& document) {
    Tree& limits = document["stability_limits"] = Tree::array();
    for (const StabilityLimit& limit : results.limits) {
        limits.push_back({{"study", limit.study},
                          {"scheme", limit.scheme},
                          {"kernel", limit.kernel},
                          {"h_over_dx", limit.h_over_dx},
                          {"limit", limit.limit},
                          {"published", limit.published},
                          {"theory", finite_or_null(limit.theory)},
                          {"theory_by", limit.theory_by},
                          {"low", limit.low},
                          {"high", limit.high},
                          {"measured", finite_or_null(limit.measured)},
                          {"verdict", limit.verdict},
                          {"passes", limit.verdict == "PASS"},
                          {"reason", limit.reason},
                          {"runs", limit.runs},
                          {"seconds", limit.seconds}});
    }
    Tree& maps = document["stability_maps"] = Tree::array();
    for (const StabilityMap& map : results.maps) {
        Tree measured = Tree::array();
        for (const double growth : map.measured) {
            measured.push_back(finite_or_null(growth));
        }
        const auto flags = [](const std::vector<std::uint8_t>& values) {
            Tree numbers = Tree::array();
            for (const std::uint8_t flag : values) {
                numbers.push_back(static_cast<double>(flag));
            }
            return numbers;
        };
        maps.push_back({{"study", map.study},
                        {"scheme", map.scheme},
                        {"x_name", map.x_name},
                        {"x", map.x},
                        {"y_name", map.y_name},
                        {"y", map.y},
                        {"theory", map.theory},
                        {"measured", measured},
                        {"grows", flags(map.grows)},
                        {"criterion", map.criterion},
                        {"by_criterion", flags(map.by_criterion)},
                        {"unstable", unstable_growth_of(map.part)},
                        {"disagreements", map.disagreements},
                        {"undecided", map.undecided},
                        {"verdict", map.verdict},
                        {"passes", map.verdict == "PASS"},
                        {"reason", map.reason},
                        {"seconds", map.seconds}});
    }
}

int exit_status(const StabilityResults& results) {
    const auto failed = [](const auto& row) { return row.verdict != "PASS"; };
    return std::ranges::any_of(results.limits, failed) || std::ranges::any_of(results.maps, failed) ? 1 : 0;
}

} // namespace sphvv::verification
