#include "sphvv/verification/calibration.hpp"
#include "sphvv/verification/document.hpp"

#include "commands.hpp"
#include "output.hpp"
#include <iostream>
#include <memory>

namespace sphvv::cli {
namespace {

using verification::Calibration;
using verification::CalibrationRequest;

struct Options {
    Common common;
    std::vector<double> dx{0.01};
    std::vector<double> dt{1e-3};
    std::string scheme = "isph_asai";
    std::vector<std::string> settings;
    double depth = 0.2;
    double duration = 1;
    int threads = 0;
};

nlohmann::ordered_json as_json(const std::optional<double>& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json as_json(const CalibrationRequest& request, const Calibration& result) {
    nlohmann::ordered_json tree{{"scheme", request.scheme.label()},
                                {"depth", request.depth},
                                {"duration", request.duration},
                                {"dx", result.dx},
                                {"dt", result.dt},
                                {"usable", as_json(result.usable)},
                                {"lowest", as_json(result.lowest)},
                                {"recommended", as_json(result.recommended)},
                                {"passes", result.usable.has_value()}};
    for (const verification::CalibrationRun& run : result.runs) {
        tree["runs"].push_back({{"alpha", run.alpha},
                                {"mean", run.mean},
                                {"fluctuation", run.fluctuation},
                                {"closest", run.closest},
                                {"steady", run.steady},
                                {"diagnosis", run.diagnosis}});
    }
    return tree;
}

nlohmann::ordered_json document_of(const std::string& command_line, double seconds,
                                   const CalibrationRequest& request,
                                   const std::vector<Calibration>& results) {
    auto document = result_document(command_line, verification::current_provenance(), seconds, {});
    document["kind"] = "calibration";
    for (const Calibration& result : results) {
        document["calibration"]["results"].push_back(as_json(request, result));
    }
    if (const auto law = calibration_law(results)) {
        document["calibration"]["law"] = {{"constant", std::exp(law->log_constant)},
                                          {"dx", as_json(law->of_dx)},
                                          {"dt", as_json(law->of_dt)}};
    }
    for (const auto& range : verification::published_relaxations()) {
        document["calibration"]["published"].push_back(
            {{"dx", range.dx}, {"low", range.low}, {"high", range.high}, {"used", range.used}});
    }
    return document;
}

CalibrationRequest request_of(const Options& options) {
    CalibrationRequest request{.scheme = verification::variant_of(options.scheme)};
    request.settings = parse_assignments(options.settings);
    request.depth = options.depth;
    request.duration = options.duration;
    for (const char* key : {"depth", "end_time", "time_step", "relaxation"}) {
        if (request.settings.contains(key) || request.scheme.settings.contains(key)) {
            throw UserError("--set: the calibration sets the key '" + std::string(key) +
                            "' itself; accepted: --depth, --duration, --dt");
        }
    }
    return request;
}

int calibrate(const Options& options, const std::string& command_line) {
    use_threads(options.threads);
    const CalibrationRequest request = request_of(options);
    for (const double dx : options.dx) {
        for (const double dt : options.dt) {
            check_calibration(request, dx, dt);
        }
    }
    check_writable(options.common.json, "--json");
    remember_signals();
    const auto begin = std::chrono::steady_clock::now();
    std::vector<Calibration> results;
    bool all_usable = true;
    {
        ProgressLine line(options.common.quiet);
        for (const double dx : options.dx) {
            for (const double dt : options.dt) {
                const std::string where = "dx = " + solver::shortest(dx) + "  dt = " + solver::shortest(dt);
                results.push_back(
                    verification::calibrate(request, dx, dt, [&](double alpha, double fraction) {
                        line.update(where + "  alpha = " + solver::shortest(alpha), fraction);
                        stop_if_signalled();
                    }));
                all_usable = all_usable && results.back().usable;
                line.done(where + "  " + std::to_string(results.back().runs.size()) + " runs");
            }
        }
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (options.common.json != "-") {
        std::cout << markdown(request, results) << std::flush;
    }
    if (!options.common.json.empty()) {
        write_text(options.common.json, document_of(command_line, seconds, request, results).dump(1) + "\n");
    }
    return all_usable ? 0 : 1;
}

} // namespace

void add_calibrate(CLI::App& app, Act& act, const std::string& command_line) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "calibrate", "the largest relaxation of the density for which a column of water keeps its pressure");
    command->add_option("--dx", options->dx, "particle spacings, m, e.g. 0.01,0.005,0.0025")
        ->delimiter(',')
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command->add_option("--dt", options->dt, "time steps, s, e.g. 0.001,0.0005")
        ->delimiter(',')
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command->add_option("--scheme", options->scheme, "scheme or variant with the key relaxation")
        ->capture_default_str();
    command->add_option("--depth", options->depth, "H, m")->check(CLI::PositiveNumber)->capture_default_str();
    command->add_option("--duration", options->duration, "of every run, s; the last half counts")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command->add_option("--set", options->settings, "KEY=VALUE of the column or the scheme; may be repeated")
        ->expected(1)
        ->take_all();
    command->add_option("--threads", options->threads, "threads (default: all processors)");
    add_common(*command, options->common);
    command->footer("Example: sphvv calibrate --dx 0.01,0.005,0.0025 --dt 0.001 --scheme isph_asai\n"
                    "Exit status: 0 a usable value was found for every dx and dt; 1 for one there is none; 2 "
                    "wrong use, nothing was run.");
    command->callback([options, &act, &command_line] {
        act = [options, &command_line] { return calibrate(*options, command_line); };
    });
}

} // namespace sphvv::cli
