#include "sphvv/verification/document.hpp"
#include "sphvv/verification/results.hpp"
#include "sphvv/verification/table.hpp"

#include "commands.hpp"
#include "output.hpp"
#include <algorithm>
#include <exception>
#include <functional>
#include <iostream>
#include <memory>

namespace sphvv::cli {
namespace {

using verification::LadderRequest;
using verification::LadderResult;
using verification::Study;

struct Options {
    Common common;
    std::vector<std::string> names;
    std::vector<std::string> schemes;
    std::string kernel;
    std::vector<int> ladder;
    std::vector<double> time_steps;
    std::vector<std::string> settings;
    std::string tier = "quick";
    std::string out;
    int threads = 0;

    bool on_command_line() const {
        return !schemes.empty() || !kernel.empty() || !ladder.empty() || !time_steps.empty() ||
               !settings.empty();
    }
};

LadderRequest request_of(const verification::Case& flow, const Study& study) {
    LadderRequest request{&flow,
                          {},
                          study.settings,
                          study.ladder,
                          std::string(to_string(study.tier)),
                          study.time_steps,
                          study.picture_at,
                          study.name,
                          {},
                          study.chaotic_round_off};
    for (const std::string& text : study.schemes) {
        request.schemes.push_back(verification::variant_of(text));
    }
    for (const std::string& text : study.chaotic) {
        request.chaotic.push_back(verification::variant_of(text).label());
    }
    return request;
}

/// A case's ladder as the command line has it; what it leaves out comes from the case's first study.
LadderRequest request_of(const verification::Case& flow, const Options& options) {
    LadderRequest request = request_of(flow, flow.studies.front());
    request.tier = "command";
    request.picture_at = 0;
    request.study.clear();
    if (!options.schemes.empty()) {
        request.schemes.clear();
        for (const std::string& text : options.schemes) {
            const verification::Variant variant = verification::variant_of(text);
            if (std::ranges::find(request.schemes, variant) != request.schemes.end()) {
                throw UserError("--scheme: '" + text + "' is given twice");
            }
            request.schemes.push_back(variant);
        }
    }
    if (!options.ladder.empty()) {
        request.ladder = options.ladder;
        std::sort(request.ladder.begin(), request.ladder.end());
        if (request.ladder.front() < 1 ||
            std::adjacent_find(request.ladder.begin(), request.ladder.end()) != request.ladder.end()) {
            throw UserError("--n: give different numbers of particle spacings, each at least 1");
        }
    }
    if (!options.time_steps.empty()) {
        request.time_steps = options.time_steps;
        std::ranges::sort(request.time_steps, std::greater());
        if (!(request.time_steps.back() > 0) ||
            std::ranges::adjacent_find(request.time_steps) != request.time_steps.end()) {
            throw UserError("--time-steps: give different positive numbers of seconds");
        }
    }
    for (const auto& [key, value] : parse_assignments(options.settings)) {
        request.settings[key] = value;
    }
    if (!options.kernel.empty()) {
        request.settings["kernel"] = options.kernel;
    }
    return request;
}

std::string study_names() {
    std::string names;
    for (const verification::Case* flow : verification::cases::all()) {
        for (const Study& study : flow->studies) {
            names += ", " + study.name;
        }
    }
    return names;
}

std::vector<LadderRequest> requests_of(const Options& options) {
    std::vector<LadderRequest> requests;
    std::vector<std::string> names = options.names;
    if (names.empty()) {
        if (options.on_command_line()) {
            throw UserError("--scheme, --kernel, --n, --time-steps and --set need a case; accepted: " +
                            solver::names_of(verification::cases::all()));
        }
        for (const verification::Case* flow : verification::cases::all()) {
            names.emplace_back(flow->name);
        }
    }
    for (const std::string& name : names) {
        bool found = false;
        for (const verification::Case* flow : verification::cases::all()) {
            if (flow->name == name && options.on_command_line()) {
                requests.push_back(request_of(*flow, options));
                found = true;
                continue;
            }
            for (const Study& study : flow->studies) {
                const bool by_case = flow->name == name && to_string(study.tier) == options.tier;
                if (by_case || study.name == name) {
                    requests.push_back(request_of(*flow, study));
                }
                found = found || flow->name == name || study.name == name;
            }
        }
        if (!found) {
            throw UserError("there is no case or study '" + name +
                            "'; accepted: " + solver::names_of(verification::cases::all()) + study_names());
        }
    }
    if (requests.empty()) {
        throw UserError("no study of the " + options.tier + " tier is among what was asked for");
    }
    return requests;
}

std::string progress_text(const std::string& group, const verification::RunRecord& run) {
    return group + "  " + run.scheme + "  n = " + std::to_string(run.n) +
           (run.prescribed_time_step > 0 ? "  dt = " + solver::shortest(run.prescribed_time_step) : "") +
           (run.seed == 1 ? "" : "  seed " + std::to_string(run.seed));
}

int verify(const Options& options, const std::string& command_line) {
    use_threads(options.threads);
    const std::vector<LadderRequest> requests = requests_of(options);
    for (const LadderRequest& request : requests) {
        plan(request); // whatever is wrong with any of them is said before the first one runs
    }
    check_writable(options.out, "--out");
    check_writable(options.common.json, "--json");
    remember_signals();
    const verification::Provenance provenance = verification::current_provenance();
    const auto begin = std::chrono::steady_clock::now();
    std::vector<LadderResult> results;
    int status = 0;
    std::exception_ptr ended; // early: the ladders that are complete are worth keeping
    {
        ProgressLine line(options.common.quiet);
        const auto progress = [&](const std::string& group, const verification::RunRecord& run,
                                  double fraction) {
            if (fraction < 1) {
                line.update(progress_text(group, run), fraction);
            } else {
                char text[64];
                std::snprintf(text, sizeof text, "  %.2f s", run.seconds);
                line.done(progress_text(group, run) + text +
                          (run.survived ? "" : "  ended early: " + run.diagnosis));
            }
            stop_if_signalled();
        };
        try {
            for (const LadderRequest& request : requests) {
                results.push_back(run_ladder(request, progress));
                status = std::max(status, exit_status(results.back()));
                if (options.common.json != "-") {
                    std::cout << markdown(results.back()) << std::flush;
                }
            }
        } catch (...) {
            ended = std::current_exception();
        }
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    auto document = result_document(command_line, provenance, seconds, results);
    if (ended) {
        document["provenance"]["interrupted"] = true;
    }
    if (!options.common.json.empty()) {
        write_text(options.common.json, document.dump(1) + "\n");
    }
    if (!options.out.empty()) {
        verification::write_results_hdf5(document, options.out);
    }
    if (ended) {
        std::rethrow_exception(ended);
    }
    return status;
}

} // namespace

solver::Assignments parse_assignments(const std::vector<std::string>& texts) {
    solver::Assignments assignments;
    for (const std::string& text : texts) {
        const std::size_t equals = text.find('=');
        if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
            throw UserError("--set: '" + text + "' is not of the form KEY=VALUE");
        }
        if (!assignments.emplace(text.substr(0, equals), text.substr(equals + 1)).second) {
            throw UserError("--set: the key '" + text.substr(0, equals) + "' is given twice");
        }
    }
    return assignments;
}

void add_verify(CLI::App& app, Act& act, const std::string& command_line) {
    const auto options = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("verify", "schemes against exact solutions: error tables, orders, verdicts");
    command->add_option("names", options->names, "cases or studies (see sphvv list); all cases if left out");
    command
        ->add_option("--scheme", options->schemes,
                     "schemes to compare, e.g. wcsph,isph_dfs, or variants of them with settings of their "
                     "own, e.g. isph_dfs,isph_dfs:shift_correction=none:h_over_dx=1.5")
        ->delimiter(',');
    command->add_option("--kernel", options->kernel, "smoothing kernel of every scheme");
    command
        ->add_option("--n", options->ladder,
                     "particle spacings along the reference length, e.g. 20,40,80,160")
        ->delimiter(',');
    command
        ->add_option(
            "--time-steps", options->time_steps,
            "seconds; a ladder in time, at the one --n, against a step 32 times finer than the finest")
        ->delimiter(',');
    command
        ->add_option("--set", options->settings, "KEY=VALUE of the case or of the schemes; may be repeated")
        ->expected(1)
        ->take_all();
    command
        ->add_option("--tier", options->tier,
                     "quick, nightly or full: which of the project's own studies to run")
        ->check(CLI::IsMember({"quick", "nightly", "full"}))
        ->capture_default_str();
    command->add_option("--threads", options->threads, "threads (default: all processors)");
    command->add_option("--out", options->out, "result file (HDF5) for sphvv report")->type_name("FILE.h5");
    add_common(*command, options->common);
    command->footer(
        "Example: sphvv verify taylor_green --scheme wcsph,isph_df,isph_dfs --set re=100 --n 20,40,80,160 "
        "--out taylor_green.h5\n"
        "Exit status: 0 all verdicts pass; 1 one failed or is inconclusive; 2 wrong use, nothing was run; 3 "
        "a run "
        "ended early unexpectedly.");
    command->callback([options, &act, &command_line] {
        act = [options, &command_line] { return verify(*options, command_line); };
    });
}

} // namespace sphvv::cli
