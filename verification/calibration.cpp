#include "sphvv/verification/calibration.hpp"

#include "sphvv/verification/claims.hpp"
#include "sphvv/verification/markdown_table.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>

namespace sphvv::verification {
namespace {

SceneRecord scene_of(const CalibrationRequest& request, double dx, double dt, double alpha) {
    if (!std::ranges::any_of(request.scheme.scheme->keys,
                             [](const solver::Key& key) { return key.name == "relaxation"; })) {
        throw UserError("the scheme '" + std::string(request.scheme.scheme->name) +
                        "' has no key 'relaxation' to calibrate; accepted: isph_asai");
    }
    const double spacings = request.depth / dx;
    const int n = static_cast<int>(std::lround(spacings));
    if (!(dx > 0) || n < 1 || std::abs(spacings - n) > 1e-6 * spacings) {
        throw UserError("a depth of " + solver::shortest(request.depth) +
                        " m is no whole number of spacings " + solver::shortest(dx) +
                        " m; give another --dx or --depth");
    }
    solver::Assignments settings = request.settings;
    settings.insert({{"start", "uniform"},
                     {"arrangement", "jittered"},
                     {"minimum_spacing", "0"},
                     {"maximum_energy", "100"}});
    settings["depth"] = solver::shortest(request.depth);
    settings["end_time"] = solver::shortest(request.duration);
    settings["time_step"] = solver::shortest(dt);
    settings["relaxation"] = solver::shortest(alpha);
    SceneRecord scene = resolve_scene(cases::find("hydrostatic"), request.scheme, settings, n);
    check_scene(scene);
    return scene;
}

const Measure& bed_pressure() {
    const Case& flow = cases::find("hydrostatic");
    return *std::ranges::find(flow.measures, "bed_pressure", &Measure::name);
}

/// Of the bed's pressure, over rho g H.
struct Series {
    double sum = 0;
    double squares = 0;
    int count = 0;

    void add(double value) {
        sum += value;
        squares += value * value;
        ++count;
    }
    double mean() const { return sum / count; }
    double fluctuation() const { return std::sqrt(std::max(0., squares / count - mean() * mean())); }
};

CalibrationRun run_at(const SceneRecord& scene, double alpha, const std::function<void(double)>& progress) {
    solver::Simulation<2> s = build_scene<2>(scene);
    const double weight = -s.density * s.body_force[1] * scene.case_settings.number("depth");
    CalibrationRun run;
    run.alpha = alpha;
    run.closest = 1e300;
    Series late;
    try {
        while (s.time < s.end_time) {
            advance(s);
            run.closest = std::min(run.closest, s.neighbours.minimum_distance() / s.particle_spacing);
            if (s.time > s.end_time / 2) {
                late.add(bed_pressure().ours(scene, s) / weight);
            }
            progress(s.time / s.end_time);
        }
    } catch (const solver::Diverged& diverged) {
        run.diagnosis = diverged.what();
        return run;
    }
    run.mean = late.mean();
    run.fluctuation = late.fluctuation();
    const double row = 0.5 * s.particle_spacing / scene.case_settings.number("depth");
    run.steady = std::abs(run.mean - 1) <= steady_share + row && run.fluctuation <= steady_share;
    return run;
}

std::string range_text(const PublishedRelaxation& range) {
    return number(range.low, "%g") + " to " + number(range.high, "%g");
}

std::string published_at(double dx) {
    for (const PublishedRelaxation& range : published_relaxations()) {
        if (std::abs(dx / range.dx - 1) < 1e-6) {
            return range_text(range);
        }
    }
    return "–";
}

const CalibrationRun* run_with(const Calibration& result, double alpha) {
    const auto found = std::ranges::find(result.runs, alpha, &CalibrationRun::alpha);
    return found == result.runs.end() ? nullptr : &*found;
}

std::string bed_text(const CalibrationRun* run) {
    if (run == nullptr) {
        return "–";
    }
    return run->diagnosis.empty() ? number(run->mean, "%.3f") + " ± " + number(run->fluctuation, "%.3f")
                                  : "ended early";
}

std::string alpha_text(const std::optional<double>& alpha) {
    return alpha ? number(*alpha, "%.2g") : "none";
}

} // namespace

std::span<const PublishedRelaxation> published_relaxations() {
    static constexpr std::array ranges{PublishedRelaxation{0.01, 0.1, 0.2, 0.15},
                                       PublishedRelaxation{0.005, 5e-4, 2e-3, 1e-3},
                                       PublishedRelaxation{0.0025, 5e-5, 2e-4, 6e-5}};
    return ranges;
}

void check_calibration(const CalibrationRequest& request, double dx, double dt) {
    scene_of(request, dx, dt, request.largest);
}

Calibration calibrate(const CalibrationRequest& request, double dx, double dt,
                      const std::function<void(double, double)>& progress) {
    Calibration result;
    result.dx = dx;
    result.dt = dt;
    result.gravity = scene_of(request, dx, dt, 0).case_settings.number("gravity");
    const auto steady = [&](double alpha) {
        result.runs.push_back(run_at(scene_of(request, dx, dt, alpha), alpha,
                                     [&](double fraction) { progress(alpha, fraction); }));
        return result.runs.back().steady;
    };
    /// Between a steady and an unsteady alpha: the steady end of the last interval.
    const auto edge = [&](double good, double bad) {
        for (int k = 0; k < request.bisections; ++k) {
            const double middle = std::sqrt(good * bad);
            (steady(middle) ? good : bad) = middle;
        }
        return good;
    };
    steady(0);
    std::vector<double> tried;
    std::vector<bool> held;
    const int decades = static_cast<int>(std::floor(std::log10(request.largest / request.smallest) + 1e-3));
    for (int k = 0; k <= decades; ++k) {
        const double alpha = request.largest / std::pow(10., k);
        tried.push_back(alpha);
        held.push_back(steady(alpha));
    }
    const auto top = static_cast<std::size_t>(std::ranges::find(held, true) - held.begin());
    if (top == held.size()) {
        return result;
    }
    std::size_t bottom = top;
    while (bottom + 1 < held.size() && held[bottom + 1]) {
        ++bottom;
    }
    result.usable = top == 0 ? tried[0] : edge(tried[top], tried[top - 1]);
    const bool to_the_end = bottom + 1 == held.size();
    result.lowest =
        to_the_end ? (result.runs[0].steady ? 0 : tried[bottom]) : edge(tried[bottom], tried[bottom + 1]);
    result.recommended = std::max(*result.usable / 2, *result.lowest);
    return result;
}

std::optional<CalibrationLaw> calibration_law(std::span<const Calibration> results) {
    std::vector<const Calibration*> usable;
    for (const Calibration& result : results) {
        if (result.usable) {
            usable.push_back(&result);
        }
    }
    const auto varies = [&](double Calibration::*of) {
        return std::ranges::any_of(usable, [&](const Calibration* c) { return c->*of != usable[0]->*of; });
    };
    if (usable.size() < 2) {
        return std::nullopt;
    }
    const bool in_dx = varies(&Calibration::dx);
    const bool in_dt = varies(&Calibration::dt);
    const auto rows = static_cast<Eigen::Index>(usable.size());
    Eigen::MatrixXd columns = Eigen::MatrixXd::Ones(rows, 1 + (in_dx ? 1 : 0) + (in_dt ? 1 : 0));
    Eigen::VectorXd logarithms(rows);
    for (Eigen::Index k = 0; k < rows; ++k) {
        const Calibration& result = *usable[static_cast<std::size_t>(k)];
        logarithms[k] = std::log(*result.usable);
        if (in_dx) {
            columns(k, 1) = std::log(result.dx);
        }
        if (in_dt) {
            columns(k, columns.cols() - 1) = std::log(result.dt);
        }
    }
    const Eigen::VectorXd fit = columns.completeOrthogonalDecomposition().solve(logarithms);
    CalibrationLaw law{.log_constant = fit[0], .of_dx = {}, .of_dt = {}};
    if (in_dx) {
        law.of_dx = fit[1];
    }
    if (in_dt) {
        law.of_dt = fit[fit.size() - 1];
    }
    return law;
}

std::string markdown(const CalibrationRequest& request, std::span<const Calibration> results) {
    std::string text = "## calibration of " + request.scheme.label() + ", depth " +
                       solver::shortest(request.depth) + " m, " + solver::shortest(request.duration) +
                       " s\n\n";
    MarkdownTable table({"dx", "Δt", "p/ρgH at α = 0", "lowest steady α", "largest steady α", "p/ρgH there",
                         "recommended", "published", "αdx²/(gHΔt²)"});
    for (const Calibration& result : results) {
        const auto share = [&](double alpha) {
            return alpha * result.dx * result.dx / (result.gravity * request.depth * result.dt * result.dt);
        };
        table.add({number(result.dx, "%g"), number(result.dt, "%g"), bed_text(run_with(result, 0)),
                   alpha_text(result.lowest), alpha_text(result.usable),
                   result.usable ? bed_text(run_with(result, *result.usable)) : "–",
                   alpha_text(result.recommended), published_at(result.dx),
                   result.usable ? number(share(*result.usable), "%.2g") : "–"});
    }
    text += table.text() + "\n";
    text += "steady: mean within 5 % + dx/(2H) of rho g H and fluctuation at most 5 %, over the last half; "
            "alpha from " +
            number(request.smallest, "%g") + " to " + number(request.largest, "%g") + " was tried\n";
    if (const auto law = calibration_law(results)) {
        text +=
            "law: alpha = " + number(std::exp(law->log_constant), "%.3g") +
            (law->of_dx ? " dx^" + number(*law->of_dx, "%.2f") : "") +
            (law->of_dt ? " dt^" + number(*law->of_dt, "%.2f") : "") +
            "; published at one unstated step: dx^5.6; derived: dx^-2 dt^2, as a deficit delta of the summed "
            "density over a row makes the pressure alpha rho0 delta (dx/dt)^2\n";
    }
    return text;
}

} // namespace sphvv::verification
