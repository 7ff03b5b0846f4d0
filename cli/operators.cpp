#include "sphvv/verification/document.hpp"
#include "sphvv/verification/operator_results.hpp"
#include "sphvv/verification/results.hpp"

#include "commands.hpp"
#include "output.hpp"
#include <iostream>
#include <memory>

namespace sphvv::cli {
namespace {

struct Options {
    Common common;
    std::vector<std::string> names;
    std::string kernel = "quintic_spline";
    std::string tier = "quick";
    std::string out;
    int threads = 0;
};

int operators(const Options& options, const std::string& command_line) {
    use_threads(options.threads);
    std::vector<const solver::Operator*> wanted;
    for (const std::string& name : options.names) {
        wanted.push_back(&solver::operators::find(name));
    }
    const bool everything = wanted.empty();
    if (everything) {
        const auto all = solver::operators::all();
        wanted.assign(all.begin(), all.end());
    }
    const solver::Kernel& kernel = solver::kernels::find(options.kernel);
    check_writable(options.out, "--out");
    check_writable(options.common.json, "--json");
    remember_signals();
    const verification::Provenance provenance = verification::current_provenance();
    const auto begin = std::chrono::steady_clock::now();
    verification::OperatorResults results;
    {
        ProgressLine line(options.common.quiet);
        results = verification::run_operator_workbench(
            wanted, options.tier, kernel, everything,
            [&](const std::string& what, double fraction, bool ladder_done) {
                if (ladder_done) {
                    line.done(what);
                } else {
                    line.update(what, fraction);
                }
                stop_if_signalled();
            });
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    auto document = verification::result_document(command_line, provenance, seconds, {});
    add_to_document(results, document);
    if (options.common.json != "-") {
        std::cout << markdown(results, !everything) << std::flush;
    }
    if (!options.common.json.empty()) {
        write_text(options.common.json, document.dump(1) + "\n");
    }
    if (!options.out.empty()) {
        verification::write_results_hdf5(document, options.out);
    }
    return exit_status(results);
}

} // namespace

void add_operators(CLI::App& app, Act& act, const std::string& command_line) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "operators",
        "kernels and operators: orders on every arrangement, properties, cost, published figures");
    command->add_option(
        "names", options->names,
        "operators (see sphvv list operators), with full tables; all, and all kernels, if left out");
    command->add_option("--kernel", options->kernel, "smoothing kernel of the operators")
        ->capture_default_str();
    command->add_option("--tier", options->tier, "quick (2-D) or nightly (finer, and 3-D)")
        ->check(CLI::IsMember({"quick", "nightly"}))
        ->capture_default_str();
    command->add_option("--threads", options->threads, "threads (default: all processors)");
    command->add_option("--out", options->out, "result file (HDF5) for sphvv report and sphvv compare")
        ->type_name("FILE.h5");
    add_common(*command, options->common);
    command->footer(
        "Example: sphvv operators gradient_renormalised laplacian_morris\n"
        "Exit status: 0 everything is as declared; 1 a verdict, property, kernel or published figure is "
        "not; 2 wrong use, nothing was run.");
    command->callback([options, &act, &command_line] {
        act = [options, &command_line] { return operators(*options, command_line); };
    });
}

} // namespace sphvv::cli
