#include "sphvv/verification/stability.hpp"

#include "sphvv/verification/conditioning.hpp"
#include "sphvv/verification/document.hpp"
#include "sphvv/verification/extreme.hpp"
#include "sphvv/verification/results.hpp"
#include "sphvv/verification/scene.hpp"

#include "commands.hpp"
#include "output.hpp"
#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>
#include <span>
#include <type_traits>

namespace sphvv::cli {
namespace {

using verification::ConditioningStudy;
using verification::ExtremeStudy;
using verification::StabilityStudy;

struct Options {
    Common common;
    std::vector<std::string> names;
    std::vector<std::string> schemes;
    std::string tier = "quick";
    std::string out;
    int threads = 1; // the lattices are too small to share
};

/// The studies that a command line asks for, by what they are made of.
struct Wanted {
    std::vector<const StabilityStudy*> stability;
    std::vector<const ExtremeStudy*> extreme;
    std::vector<const ConditioningStudy*> conditioning;

    bool empty() const { return stability.empty() && extreme.empty() && conditioning.empty(); }
};

/// Calls act(studies, those of them that are wanted) for each kind.
template <class Act>
void for_each_kind(Wanted& wanted, const Act& act) {
    act(verification::stability_studies(), wanted.stability);
    act(verification::extreme_studies(), wanted.extreme);
    act(verification::conditioning_studies(), wanted.conditioning);
}

[[noreturn]] void refuse_study(const std::string& name) {
    std::string names;
    Wanted none;
    for_each_kind(none, [&](const auto studies, const auto&) {
        for (const auto& study : studies) {
            names += (names.empty() ? "" : ", ") + study.name;
        }
    });
    throw UserError("there is no stability study '" + name + "'; accepted: " + names);
}

/// Those named, or those of the tier; with schemes in place of their own only such as have schemes.
Wanted studies_of(const Options& options) {
    Wanted wanted;
    for_each_kind(wanted, [&](const auto studies, auto& chosen) {
        const bool takes_schemes = std::is_same_v<decltype(studies), const std::span<const StabilityStudy>>;
        for (const auto& study : studies) {
            const bool of_tier = options.names.empty() && to_string(study.tier) == options.tier &&
                                 (takes_schemes || options.schemes.empty());
            if (of_tier || std::ranges::find(options.names, study.name) != options.names.end()) {
                chosen.push_back(&study);
            }
        }
    });
    for (const std::string& name : options.names) {
        bool known = false;
        Wanted none;
        for_each_kind(none, [&](const auto studies, const auto&) {
            known = known || std::ranges::any_of(studies, [&](const auto& s) { return s.name == name; });
        });
        if (!known) {
            refuse_study(name);
        }
    }
    if (wanted.empty()) {
        throw UserError("there is no stability study in the " + options.tier +
                        " tier; accepted: quick, nightly");
    }
    return wanted;
}

/// Runs the rows of its tier; what has run is in `results` even if a signal ends it.
void run_rows(const ExtremeStudy& study, ProgressLine& line,
              std::vector<verification::ExtremeResult>& results) {
    const auto rows = verification::extreme_rows();
    const auto all = std::ranges::count(rows, study.tier, &verification::ExtremeRow::tier);
    std::ptrdiff_t done = 0;
    for (const verification::ExtremeRow& row : rows) {
        if (row.tier == study.tier) {
            line.update(study.name + "  " + row.name + "  " + row.scheme,
                        static_cast<double>(done++) / static_cast<double>(all));
            results.push_back(run_extreme(row));
            stop_if_signalled();
        }
    }
    line.done(study.name);
}

int stability(const Options& options, const std::string& command_line) {
    use_threads(options.threads);
    const Wanted wanted = studies_of(options);
    for (const std::string& scheme : options.schemes) {
        for (const StabilityStudy* study : wanted.stability) {
            check_scheme(*study, scheme); // refused before anything runs
        }
    }
    check_writable(options.out, "--out");
    check_writable(options.common.json, "--json");
    remember_signals();
    const verification::Provenance provenance = verification::current_provenance();
    const auto begin = std::chrono::steady_clock::now();
    verification::StabilityResults results;
    std::vector<verification::ExtremeResult> scenes;
    std::vector<verification::ConditioningResults> conditioning;
    std::exception_ptr ended; // early: the studies that are complete are worth keeping
    {
        ProgressLine line(options.common.quiet);
        const verification::StabilityProgress progress = [&](const std::string& what, double fraction) {
            line.update(what, fraction);
            stop_if_signalled();
        };
        try {
            for (const StabilityStudy* study : wanted.stability) {
                auto found = run_stability(*study, options.schemes, progress);
                line.done(study->name);
                if (options.common.json != "-") {
                    std::cout << markdown(found) << std::flush;
                }
                std::ranges::move(found.limits, std::back_inserter(results.limits));
                std::ranges::move(found.maps, std::back_inserter(results.maps));
            }
            for (const ExtremeStudy* study : wanted.extreme) {
                run_rows(*study, line, scenes);
            }
            if (!scenes.empty() && options.common.json != "-") {
                std::cout << verification::markdown(scenes) << std::flush;
            }
            for (const ConditioningStudy* study : wanted.conditioning) {
                conditioning.push_back(run_conditioning(*study, progress));
                line.done(study->name);
                if (options.common.json != "-") {
                    std::cout << verification::markdown(conditioning.back()) << std::flush;
                }
            }
        } catch (...) {
            ended = std::current_exception();
        }
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    auto document = verification::result_document(command_line, provenance, seconds, {});
    document["kind"] = "stability";
    if (ended) {
        document["provenance"]["interrupted"] = true;
    }
    add_to_document(results, document);
    verification::add_to_document(scenes, document);
    verification::add_to_document(conditioning, document);
    if (!options.common.json.empty()) {
        write_text(options.common.json, document.dump(1) + "\n");
    }
    if (!options.out.empty()) {
        verification::write_results_hdf5(document, options.out);
    }
    if (ended) {
        std::rethrow_exception(ended);
    }
    return std::max(
        {exit_status(results), verification::exit_status(scenes), verification::exit_status(conditioning)});
}

} // namespace

void add_stability(CLI::App& app, Act& act, const std::string& command_line) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "stability", "largest stable time steps beside linear theory, and maps of stability");
    command->add_option("names", options->names,
                        "studies (see sphvv list studies); all of the tier if left out");
    command
        ->add_option(
            "--scheme", options->schemes,
            "schemes or variants in place of the study's own, e.g. wcsph:kernel=cubic_spline:h_over_dx=1.5")
        ->delimiter(',');
    command->add_option("--tier", options->tier, "quick, nightly or full")
        ->check(CLI::IsMember({"quick", "nightly", "full"}))
        ->capture_default_str();
    command->add_option("--threads", options->threads, "threads of a run")->capture_default_str();
    command->add_option("--out", options->out, "result file (HDF5) for sphvv report")->type_name("FILE.h5");
    add_common(*command, options->common);
    command->footer(
        "Example: sphvv stability stability/acoustic --scheme wcsph:kernel=cubic_spline\n"
        "Exit status: 0 all verdicts pass; 1 one failed; 2 wrong use, nothing was run; 3 a scene ended "
        "early that must not.");
    command->callback([options, &act, &command_line] {
        act = [options, &command_line] { return stability(*options, command_line); };
    });
}

} // namespace sphvv::cli
