// Time scales far apart: viscosity alone, no viscosity, sound; few neighbours and very many; steps too long.
#include "sphvv/verification/extreme_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

namespace sphvv::verification::extreme_scenes {
namespace {

using std::numbers::pi;

constexpr double sound_duration = 0.02; // s
constexpr int sound_n = 24;
constexpr double k = 2 * pi; // 1/m

struct SoundRun {
    ExtremeOutcome outcome;
    double velocity_error = 0; ///< relative, L2
    double density_change = 0; ///< largest |rho - mean rho|/rho0, over all steps
    double mean_change = 0;    ///< largest |mean rho - rho0|/rho0, over all steps
};

/// Taylor-Green vortices, density 1, U = 1, Re = 100, in the unit square.
PointScene vortices() {
    PointScene scene{.places = block(sound_n, sound_n, 1. / sound_n, {0, 0}),
                     .velocities = {},
                     .box = {{0, 0}, {1, 1}, {true, true}},
                     .free_surface = false,
                     .dx = 1. / sound_n,
                     .density = 1,
                     .viscosity = 0.01,
                     .time_step = 0};
    for (const auto& [x, y] : scene.places) {
        scene.velocities.push_back({-std::cos(k * x) * std::sin(k * y), std::sin(k * x) * std::cos(k * y)});
        scene.pressures.push_back(-(std::cos(2 * k * x) + std::cos(2 * k * y)) / 4);
    }
    return scene;
}

/// To the end time with the steps of the acoustic limit.
SoundRun with_sound(const std::string& scheme) {
    Simulation s = simulate(scheme, vortices());
    s.end_time = sound_duration;
    const double dt = 0.4 * s.smoothing_length / s.settings.number("c0_over_u");
    const auto steps = static_cast<std::int64_t>(std::ceil(sound_duration / dt));
    SoundRun run;
    double largest = 0;
    try {
        while (s.time < s.end_time && run.outcome.steps < 2 * steps) {
            advance(s);
            ++run.outcome.steps;
            const std::span<const double> density((*s.particles.find("density"))[0], s.particles.size());
            const double mean =
                std::accumulate(density.begin(), density.end(), 0.) / static_cast<double>(density.size());
            run.mean_change = std::max(run.mean_change, std::abs(mean - s.density));
            for (const double rho : density) {
                largest = std::max(largest, std::abs(rho - mean));
            }
        }
    } catch (const solver::Diverged& end) {
        run.outcome.diagnosis = end.what();
        return run;
    }
    run.outcome.survived = true;
    run.density_change = largest;
    double error = 0;
    double exact = 0;
    const double decay = std::exp(-2 * 0.01 * k * k * s.time);
    for (std::size_t i = 0; i < s.particles.size(); ++i) {
        const double x = s.particles.position[0][i];
        const double y = s.particles.position[1][i];
        const double u = -decay * std::cos(k * x) * std::sin(k * y);
        const double v = decay * std::sin(k * x) * std::cos(k * y);
        error += std::pow(s.particles.velocity[0][i] - u, 2) + std::pow(s.particles.velocity[1][i] - v, 2);
        exact += u * u + v * v;
    }
    run.velocity_error = std::sqrt(error / exact);
    return run;
}

/// A kernel at h/dx = 1.3, and its second moment <x^2>_W over h^2 in two dimensions, int q^3 W dq / (2 int q
/// W dq). Of the quintic spline it is a sum over (a - q)^5, whose integrals with q^m are a^(m+6) m!
/// 5!/(m+6)!; of wendland_c2 the integrals are beta functions.
struct SmoothedBy {
    const char* settings;
    double moment;
};
constexpr SmoothedBy quintic{":kernel=quintic_spline", 2771. / 5736};
constexpr SmoothedBy wendland{"", 5. / 18}; // the default

const std::string mean_drifts =
    "the sum of the continuity equation on a deformed lattice, M : grad u with M = -sum V r (x) gradW, has "
    "no "
    "mean of 0. Lattice sums along the exact paths of the vortices give a mean density of 7.8e-4 rho0 at t = "
    "0.02 with wendland_c2, 7.3e-5 at h/dx = 2 and 2.7e-5 with quintic_spline; measured are 7.4e-4, 7.1e-5 "
    "and "
    "2.5e-5 at c0/U = 300, where Ma^2 is 1.1e-5";
const std::string mean_pressure_acts =
    mean_drifts + ". Its pressure, c0^2 times it, cannot leave a periodic box, and acts on the deformed "
                  "lattice: with the mean taken off after each step the velocity is off by 0.8 % in place of "
                  "5.2 % at c0/U = 300, and of 50 % at 1000";
const std::string not_established =
    "cause not established: 2.2 with the mean density taken off after each step; within the bound with "
    "quintic_spline";

void add_sound_of(std::vector<ExtremeRow>& all, const SmoothedBy& kernel, double ratio) {
    const bool is_default = kernel.moment == wendland.moment;
    const std::string scheme = "wcsph:c0_over_u=" + solver::shortest(ratio) + kernel.settings;
    const double h = 1.3 / sound_n;
    const double steps = std::ceil(sound_duration / (0.4 * h / ratio));
    const auto add = [&](const char* name, const std::string& must, const std::string& why, double bound,
                         auto&& error, const std::string& waiver = "") {
        all.push_back({.name = std::string("stiff sound: ") + name,
                       .scheme = scheme,
                       .must = must,
                       .why = why,
                       .fate = Fate::bounded,
                       .bound = bound,
                       .run =
                           [error](const std::string& of) {
                               SoundRun run = with_sound(of);
                               run.outcome.error = error(run);
                               return run.outcome;
                           },
                       .waiver = waiver});
    };
    add("steps", "takes " + solver::shortest(steps) + " steps; error: share that differs",
        "dt = 0.4 h/c0 rules: T/dt in even steps, in proportion to c0", 0, [steps](const SoundRun& run) {
            return std::abs(static_cast<double>(run.outcome.steps) / steps - 1);
        });
    add(
        "density", "the density varies with Ma^2; error: max|rho - mean rho|/(rho0 Ma^2)",
        "p = -(rho0 U^2/4)(cos 2kx + cos 2ky) is within rho0 U^2/2: Ma^2/2 in density. Of what the start "
        "misses of "
        "that, all at most, a wave makes p (1 - cos wt): 1",
        1, [ratio](const SoundRun& run) { return run.density_change * ratio * ratio; },
        is_default && ratio > 300 ? not_established : "");
    add(
        "mean density", "the box keeps its mass; error: |mean rho - rho0|/(rho0 Ma^2)",
        "particles of mass m fill the box, sum m/rho = V: the mean of rho is off by the square of its "
        "variation, Ma^4 or so; 1 is a pressure as large as that of the flow",
        1, [ratio](const SoundRun& run) { return run.mean_change * ratio * ratio; },
        ratio > (is_default ? 30 : 100) ? mean_drifts : "");
    // Of the root mean square velocity 1/sqrt(2): the acceleration by pressure has U^2 k/2.
    const double smoothing =
        sound_duration * (k / 2) * std::sqrt(2.) * (4 * k * k) * kernel.moment * h * h / 2;
    add(
        "velocity", "the vortices turn as they must; error: velocity, L2",
        "smoothing takes (2k)^2 <x^2>_W/2 of the pressure gradient, rms U^2 k/2, over T; sound has u <= "
        "p/(rho "
        "c0) = U Ma (of 1/sqrt(2) U)",
        smoothing + std::sqrt(2.) / ratio, [](const SoundRun& run) { return run.velocity_error; },
        is_default && ratio > 100 ? mean_pressure_acts : "");
}

void add_sound(std::vector<ExtremeRow>& all) {
    for (const SmoothedBy& kernel : {quintic, wendland}) {
        for (const double ratio : {10., 30., 100., 300., 1000.}) {
            add_sound_of(all, kernel, ratio);
        }
    }
}

void add_too_long_steps(std::vector<ExtremeRow>& all) {
    const std::string must = "ends with a diagnosis of energy, place, spacing or the pressure solver";
    add_for_all(all, [&](const std::string& scheme) {
        return ExtremeRow{.name = "a step 100 times too long",
                          .scheme = scheme,
                          .must = must,
                          .why = "beyond every limit: growth by orders of magnitude in a step",
                          .fate = Fate::ends,
                          .diagnoses = blown_up,
                          .run = [](const std::string& of) {
                              return run_case("taylor_green", of,
                                              {{"re", "1"}, {"end_time", "100"}, {"time_step", "0.1"}}, 32);
                          }};
    });
    add_for_all(all, [&](const std::string& scheme) {
        return ExtremeRow{.name = "a step 100 times too long between walls",
                          .scheme = scheme,
                          .must = must,
                          .why = "nu dt/dx^2 = 20, where explicit viscosity is stable to 1/4 or so",
                          .fate = Fate::ends,
                          .diagnoses = blown_up,
                          .run = [](const std::string& of) {
                              return run_case("poiseuille", of,
                                              {{"re", "1"}, {"end_time", "100"}, {"time_step", "0.08"}}, 16);
                          }};
    });
    all.push_back(
        {.name = "sound over its limit",
         .scheme = "wcsph",
         .must = must,
         .why = "dt = 10 (0.4 h/c0), where linear theory has the limit below 6 of them (stability/acoustic)",
         .fate = Fate::ends,
         .diagnoses = blown_up,
         .run = [](const std::string& of) {
             return run_case("taylor_green", of, {{"re", "100"}, {"end_time", "10"}, {"time_step", "0.0163"}},
                             32);
         }});
    all.push_back({.name = "sound over its limit under a free surface",
                   .scheme = "wcsph",
                   .must = must,
                   .why = "dt = 10 (0.4 h/c0), as in the bulk",
                   .fate = Fate::ends,
                   .diagnoses = blown_up,
                   .run = [](const std::string& of) {
                       return run_case("hydrostatic", of, {{"end_time", "100"}, {"time_step", "0.0052"}}, 20);
                   }});
}

std::vector<ExtremeRow> rows() {
    std::vector<ExtremeRow> all;
    add_for_all(all, [](const std::string& scheme) {
        return ExtremeRow{
            .name = "viscosity rules: Re = 1e-3",
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
            }};
    });
    add_for_all(all, [](const std::string& scheme) {
        return ExtremeRow{.name = "no viscosity to speak of: Re = 1e6",
                          .scheme = scheme,
                          .must = "survives t = 0.2; error: velocity, L2",
                          .why = "nothing is claimed beyond it",
                          .fate = Fate::survives,
                          .run = [](const std::string& of) {
                              return run_case("taylor_green", of, {{"re", "1e6"}, {"end_time", "0.2"}}, 32);
                          }};
    });
    for (const char* width : {"0.8", "5"}) {
        add_for_all(all, [width](const std::string& scheme) {
            return ExtremeRow{.name = std::string("h/dx = ") + width,
                              .scheme = scheme,
                              .must = "survives t = 0.05; error: velocity, L2",
                              .why = "few neighbours, or very many: nothing is claimed of the error",
                              .fate = Fate::survives,
                              .run = [width](const std::string& of) {
                                  return run_case("taylor_green", of,
                                                  {{"re", "100"}, {"end_time", "0.05"}, {"h_over_dx", width}},
                                                  40);
                              }};
        });
    }
    add_sound(all);
    add_too_long_steps(all);
    return all;
}

} // namespace

const ExtremeScenes& stiffness() {
    static const ExtremeScenes scenes{"stiffness", "time scales far apart, and steps too long for them",
                                      rows};
    return scenes;
}

} // namespace sphvv::verification::extreme_scenes
