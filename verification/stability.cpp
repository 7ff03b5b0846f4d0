#include "sphvv/verification/stability.hpp"

#include "sphvv/solver/arrangements.hpp"
#include "sphvv/solver/schemes.hpp"
#include "sphvv/verification/markdown_table.hpp"
#include "sphvv/verification/scene.hpp"

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

constexpr std::size_t particles_per_side = 16;
constexpr int part = 200; // steps; a run has three parts
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double resolution = 1.005; // of the bisection
constexpr double agreement = 0.05;

using Tree = nlohmann::ordered_json;

solver::Settings settings_of(const LatticeScene& scene, double dt) {
    const Variant variant = variant_of(scene.scheme);
    solver::Assignments given = variant.settings;
    given.insert_or_assign("time_step", solver::shortest(dt));
    if (variant.scheme->compressible) {
        given.insert_or_assign("c0_over_u", solver::shortest(scene.sound_speed)); // U = 1 m/s
        if (scene.pressure) {
            given.insert_or_assign("gamma", "1"); // the sound speed is that of every density
            given.insert_or_assign("background_pressure", "0");
        }
    } else {
        given.insert_or_assign("pressure_tolerance", "1e-10");
    }
    return {variant.scheme->keys, given};
}

void refuse(const LatticeScene& scene, const std::string& why) {
    throw UserError("scheme '" + scene.scheme + "': the linear theory covers " + why);
}

using Spectrum = Eigen::Matrix<double, particles_per_side, particles_per_side>;

/// |v(k)|^2 + c0^2 |s(k)|^2 of every wave vector 2 pi (a, b), which sound keeps; v and the relative density s
/// taken at the lattice points where particles started. Under pressure the energy of displacements is part of
/// it, which has no sign: then the mean over all wave vectors, in place of each.
Spectrum spectrum(const solver::Simulation<2>& s, const LatticeScene& scene) {
    constexpr int n = particles_per_side;
    using Grid = Eigen::Matrix<std::complex<double>, n, n>;
    static const Grid waves = Grid::NullaryExpr([](Eigen::Index a, Eigen::Index x) {
        return std::polar(1., -2 * std::numbers::pi * static_cast<double>(a * x % n) / n);
    });
    Spectrum energy = Spectrum::Zero();
    const auto add = [&](const std::vector<double>& values, double scale) {
        Grid grid;
        for (int k = 0; k < n * n; ++k) {
            grid(s.particles.id[k] % n, s.particles.id[k] / n) = scale * values[k];
        }
        energy += (waves * grid * waves.transpose()).cwiseAbs2();
    };
    for (int d = 0; d < 2; ++d) {
        add(s.particles.velocity.components[d], 1);
    }
    if (const solver::Field* density = s.particles.find("density"); density != nullptr) {
        add(density->components[0], scene.sound_speed);
    }
    energy(0, 0) = 0; // the mean
    if (scene.pressure) {
        energy.setConstant(energy.mean());
    }
    return energy;
}

solver::Simulation<2> build(const LatticeScene& scene, double dt) {
    const solver::Scheme& scheme = *variant_of(scene.scheme).scheme;
    solver::Box<2> box;
    box.low.fill(0);
    box.high.fill(1);
    box.periodic.fill(true);
    constexpr double dx = 1. / particles_per_side;
    const LatticeState state = lattice_state(scene);
    solver::Simulation<2> s(box, particles_per_side * particles_per_side);
    s.settings = settings_of(scene, dt);
    s.kernel = state.kernel;
    s.particle_spacing = dx;
    s.smoothing_length = state.h_over_dx * dx;
    s.density = 1;
    s.kinematic_viscosity = scene.viscosity;
    s.reference_speed = 1;
    s.particle_mass = state.density * dx * dx;
    s.end_time = 1e12 * dt;
    solver::Field& p = s.particles.field("pressure", 1, solver::Lifetime::state, "scene");
    std::ranges::fill(p.components[0], scene.pressure.value_or(0));
    const auto points = solver::lattice<2>(box, dx);
    // Of incompressible schemes more: their pressure solver takes less than a share of U for round-off.
    const double amplitude = scheme.compressible ? 1e-8 * scene.sound_speed : 1e-6;
    std::mt19937_64 engine(20261123);
    for (int d = 0; d < 2; ++d) {
        s.particles.position.components[d] = points[d];
        for (double& u : s.particles.velocity.components[d]) {
            u = amplitude * (2 * static_cast<double>(engine() >> 11U) * 0x1p-53 - 1);
        }
    }
    scheme.assemble(s);
    return s;
}

double published_step(Limit limit, const LatticeScene& scene, double h) {
    return limit == Limit::acoustic ? 0.4 * h / scene.sound_speed : 0.125 * h * h / scene.viscosity;
}

/// So that the step is bound by what the study is about.
LatticeScene scene_for(const StabilityStudy& study, const std::string& scheme) {
    LatticeScene scene{.scheme = scheme};
    if (study.limit == Limit::viscous) {
        const double h = lattice_state(scene).h_over_dx / particles_per_side;
        scene.viscosity = 10 * scene.sound_speed * h;
    }
    return scene;
}

StabilityLimit find_limit(const StabilityStudy& study, const std::string& scheme,
                          const StabilityProgress& progress, double done, double share) {
    const auto begin = std::chrono::steady_clock::now();
    const LatticeScene scene = scene_for(study, scheme);
    const LatticeState state = lattice_state(scene);
    const double h = state.h_over_dx * state.dx;
    StabilityLimit result{.study = study.name,
                          .scheme = scheme,
                          .kernel = std::string(state.kernel->name),
                          .h_over_dx = state.h_over_dx,
                          .limit = std::string(to_string(study.limit)),
                          .published = published_step(study.limit, scene, h),
                          .theory = 0,
                          .measured = 0,
                          .verdict = "",
                          .reason = "",
                          .runs = 0,
                          .seconds = 0};
    result.theory = stability_limit(state, stepping_of(scene), 0.02 * result.published, particles_per_side) /
                    result.published;
    const auto grows = [&](double multiple) {
        ++result.runs;
        if (progress) {
            progress(study.name + "  " + scheme + "  dt = " + solver::shortest(multiple) + " x published",
                     done + share * std::min(1., result.runs / 16.));
        }
        return disturb(scene, multiple * result.published).grows;
    };
    constexpr double least = 0.05;
    constexpr double most = 40;
    double low = least;
    if (!grows(low)) {
        double high = 2 * low;
        for (; high < most && !grows(high); high *= 2) {
            low = high;
        }
        while (high > resolution * low && high < most) {
            const double middle = std::sqrt(low * high);
            (grows(middle) ? high : low) = middle;
        }
        result.measured = high < most ? std::sqrt(low * high) : infinity;
    }
    judge(result);
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return result;
}

std::string with_h(const std::string& scheme, double h_over_dx) {
    return scheme + ":h_over_dx=" + solver::shortest(h_over_dx);
}

StabilityMap find_map(const StabilityStudy& study, const std::string& scheme,
                      const StabilityProgress& progress, double done, double share) {
    const auto begin = std::chrono::steady_clock::now();
    StabilityMap map{.study = study.name,
                     .scheme = scheme,
                     .x_name = "h/dx",
                     .x = {},
                     .y_name = study.tensile                    ? "p/(rho c0^2)"
                               : study.limit == Limit::acoustic ? "dt c0/(0.4 h)"
                                                                : "dt nu/(0.125 h^2)",
                     .y = {},
                     .theory = {},
                     .measured = {},
                     .grows = {},
                     .disagreements = 0,
                     .undecided = 0,
                     .verdict = "",
                     .reason = "",
                     .seconds = 0};
    for (int k = 0; k <= 10; ++k) {
        map.x.push_back(1 + 0.1 * k);
    }
    for (int k = 0; k <= 10; ++k) {
        map.y.push_back(study.tensile ? 0.01 * (k - 5) : 3 + 0.25 * k);
    }
    for (const double y : map.y) {
        for (const double x : map.x) {
            LatticeScene scene = scene_for(study, with_h(scheme, x));
            if (study.tensile) {
                scene.pressure = y * scene.sound_speed * scene.sound_speed;
            }
            const LatticeState state = lattice_state(scene);
            const double published = published_step(study.limit, scene, x * state.dx);
            const double dt = study.tensile ? 0.5 * published : y * published;
            map.theory.push_back(growth_factor(state, stepping_of(scene), dt, particles_per_side));
            const Disturbance found = disturb(scene, dt);
            map.grows.push_back(found.grows ? 1 : 0);
            map.measured.push_back(found.growth);
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

std::string number(double value, const char* format) {
    if (std::isinf(value)) {
        return "none";
    }
    char text[32];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

Tree finite_or_null(double value) {
    return std::isfinite(value) ? Tree(value) : Tree(nullptr);
}

} // namespace

std::string_view to_string(Limit limit) {
    return limit == Limit::acoustic ? "acoustic" : "viscous";
}

Stepping stepping_of(const LatticeScene& scene) {
    const Variant variant = variant_of(scene.scheme);
    if (!variant.scheme->compressible) {
        return Stepping::projection;
    }
    const solver::Settings settings = settings_of(scene, 1);
    const std::string& integrator = settings.word("integrator");
    return integrator == "explicit"              ? Stepping::explicit_euler
           : integrator == "predictor_corrector" ? Stepping::predictor_corrector
                                                 : Stepping::verlet;
}

LatticeState lattice_state(const LatticeScene& scene) {
    const Variant variant = variant_of(scene.scheme);
    const bool compressible = variant.scheme->compressible;
    const auto name = variant.scheme->name;
    if (!compressible && name != "isph_df" && name != "isph_dfs" && name != "isph_lee") {
        refuse(scene, "wcsph, isph_df, isph_dfs and isph_lee");
    }
    const solver::Settings settings = settings_of(scene, 1);
    LatticeState state{.kernel = &solver::kernels::find(settings.word("kernel")),
                       .h_over_dx = settings.number("h_over_dx"),
                       .dx = 1. / particles_per_side,
                       .sound_speed = compressible ? scene.sound_speed : 0,
                       .viscosity = scene.viscosity,
                       .eta_over_h = settings.number("eta_over_h")};
    if (!compressible) {
        if (settings.word("laplacian") != "morris" || settings.word("viscosity") != "laplacian") {
            refuse(scene, "laplacian=morris with viscosity=laplacian");
        }
        return state;
    }
    for (const char* key : {"pressure_force", "continuity"}) {
        if (settings.word(key) != "sigma_1" && settings.word(key) != "sigma_2") {
            refuse(scene, std::string(key) + "=sigma_1 or sigma_2");
        }
    }
    state.monaghan_cleary = settings.word("viscosity") == "monaghan_cleary";
    state.pressure = scene.pressure.value_or(settings.number("background_pressure"));
    if (scene.pressure) {
        state.density = 1 + *scene.pressure / (scene.sound_speed * scene.sound_speed);
    }
    return state;
}

Disturbance disturb(const LatticeScene& scene, double dt) {
    solver::Simulation<2> s = build(scene, dt);
    const double start = spectrum(s, scene).mean();
    constexpr double linear = 1e8;     // times the energy of the start: the amplitude is still small
    constexpr double round_off = 1e-9; // of the same; that of the density is 1e-11
    std::array<Spectrum, 3> largest;
    largest.fill(Spectrum::Zero());
    try {
        for (int step = 0; step < 3 * part; ++step) {
            advance(s);
            const Spectrum energy = spectrum(s, scene);
            largest[step / part] = largest[step / part].cwiseMax(energy);
            if (energy.maxCoeff() > linear * start) {
                return {true, std::pow(energy.maxCoeff() / start, 0.5 / (step + 1)), ""};
            }
        }
    } catch (const solver::Diverged& end) {
        return {true, infinity, end.what()};
    }
    double ratio = 0;
    for (int k = 0; k < static_cast<int>(largest[2].size()); ++k) {
        if (largest[2](k) > round_off * start) {
            ratio = std::max(ratio, largest[2](k) / largest[1](k));
        }
    }
    const double growth = std::pow(ratio, 0.5 / part);
    return {growth > unstable_growth, growth, ""};
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
        return std::vector<StabilityStudy>{
            {.name = "stability/acoustic",
             .tier = Tier::quick,
             .summary = "largest dt of sound, in 0.4 h/c0",
             .source = source,
             .cost = "15 s",
             .limit = Limit::acoustic,
             .schemes = joined(variants(plain, common, {1.3, 2}),
                               {plain + ":integrator=predictor_corrector", plain + ":integrator=verlet"})},
            {.name = "stability/viscous",
             .tier = Tier::quick,
             .summary = "largest dt of explicit viscosity, in 0.125 h^2/nu",
             .source = source,
             .cost = "15 s",
             .limit = Limit::viscous,
             .schemes = joined(joined(variants(plain, common, {1.3}), variants(monaghan, common, {1.3})),
                               {plain + ":integrator=predictor_corrector", plain + ":integrator=verlet",
                                "isph_df", "isph_dfs", "isph_lee"})},
            {.name = "stability/acoustic_map",
             .tier = Tier::quick,
             .summary = "growth over h/dx and dt",
             .source = source,
             .cost = "10 s",
             .limit = Limit::acoustic,
             .schemes = {plain + ":kernel=wendland_c2"},
             .map = true},
            {.name = "stability/tensile_map",
             .tier = Tier::quick,
             .summary =
                 "growth over h/dx and the pressure: clumping in tension, or under pressure inside the "
                 "inflection of the kernel",
             .source = "Swegle et al. 1995; Issa 2005 §2.8, appendix B; " + source,
             .cost = "20 s",
             .limit = Limit::acoustic,
             .schemes = {"wcsph:kernel=cubic_spline", "wcsph:kernel=wendland_c2"},
             .map = true,
             .tensile = true},
            {.name = "stability/acoustic_every_kernel",
             .tier = Tier::nightly,
             .summary = "largest dt of sound, in 0.4 h/c0",
             .source = source,
             .cost = "1 min",
             .limit = Limit::acoustic,
             .schemes = variants(plain, every, {1.2, 1.5, 1.8, 2})},
            {.name = "stability/viscous_every_kernel",
             .tier = Tier::nightly,
             .summary = "largest dt of explicit viscosity, in 0.125 h^2/nu",
             .source = source,
             .cost = "1 min",
             .limit = Limit::viscous,
             .schemes =
                 joined(variants(plain, every, {1.2, 1.5, 2}), variants(monaghan, every, {1.2, 1.5, 2}))},
            {.name = "stability/tensile_every_kernel",
             .tier = Tier::nightly,
             .summary = "growth over h/dx and the pressure",
             .source = "Swegle et al. 1995; Issa 2005 §2.8, appendix B; " + source,
             .cost = "1 min",
             .limit = Limit::acoustic,
             .schemes = {"wcsph:kernel=gaussian", "wcsph:kernel=quartic_spline",
                         "wcsph:kernel=quintic_spline", "wcsph:kernel=wendland_c4",
                         "wcsph:kernel=wendland_c6"},
             .map = true,
             .tensile = true},
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
        if (study.map) {
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
                                                 : std::abs(ratio - 1) <= agreement;
    limit.verdict = agrees ? "PASS" : "FAIL";
    limit.reason = "theory is exact for a lattice and a small disturbance: within 5 %";
}

void judge(StabilityMap& map) {
    // One wave vector of 255 among others that keep their energy is seen once it has 16 times its amplitude
    // of the start, 400 steps on.
    constexpr double seen = 1.007;
    map.disagreements = 0;
    map.undecided = 0;
    for (std::size_t k = 0; k < map.grows.size(); ++k) {
        const bool slow = map.theory[k] > 1 + 1e-4 && map.theory[k] < seen;
        map.undecided += slow ? 1 : 0;
        map.disagreements += !slow && (map.grows[k] != 0) != (map.theory[k] >= seen) ? 1 : 0;
    }
    map.verdict = map.disagreements == 0 ? "PASS" : "FAIL";
    map.reason =
        std::to_string(map.disagreements) + " of " + std::to_string(map.grows.size()) +
        " points are stable where theory says they grow, or grow where it says they are stable; on " +
        std::to_string(map.undecided) +
        " more they grow by less than 0.7 % a step, too slowly for 600 steps to tell";
}

std::string markdown(const StabilityResults& results) {
    std::string text;
    if (!results.limits.empty()) {
        text += "\n### largest stable time steps, as multiples of the published bound\n\n";
        MarkdownTable table({"study", "scheme", "kernel", "h/dx", "bound", "theory", "measured", "ratio",
                             "verdict", "runs", "seconds"});
        for (const StabilityLimit& limit : results.limits) {
            table.add({limit.study, limit.scheme, limit.kernel, number(limit.h_over_dx, "%.2f"), limit.limit,
                       number(limit.theory, "%.3f"), number(limit.measured, "%.3f"),
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
                const bool unstable = map.theory[k] > unstable_growth;
                row.push_back(std::string(map.grows[k] != 0 ? "grows" : "·") +
                              ((map.grows[k] != 0) == unstable ? "" : " (!)"));
            }
            table.add(row);
        }
        text += table.text() + "\n(!): theory says otherwise. " + map.reason + ": " + map.verdict + "\n";
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
        Tree grows = Tree::array();
        for (const std::uint8_t flag : map.grows) {
            grows.push_back(static_cast<double>(flag));
        }
        maps.push_back({{"study", map.study},
                        {"scheme", map.scheme},
                        {"x_name", map.x_name},
                        {"x", map.x},
                        {"y_name", map.y_name},
                        {"y", map.y},
                        {"theory", map.theory},
                        {"measured", measured},
                        {"grows", grows},
                        {"unstable", unstable_growth},
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
