#include "sphvv/verification/compare.hpp"

#include "commands.hpp"
#include "output.hpp"
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>

namespace sphvv::cli {
namespace {

using verification::Comparison;
using verification::ResultTree;

/// A result file (HDF5 or its JSON twin) or a baseline. Throws UserError in one sentence for anything else.
ResultTree read_results(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    if (!stream || (stream >> std::ws).peek() != '{') {
        ResultTree tree = verification::read_results_hdf5(path);
        verification::check_result_file(tree, path);
        return tree;
    }
    ResultTree tree = ResultTree::parse(stream, nullptr, false);
    const auto is = [&](const char* name, const ResultTree& value) {
        return tree.is_object() && tree.contains(name) && tree.at(name) == value;
    };
    if (is("format", "sphvv-results")) {
        verification::check_result_file(tree, path);
        return tree;
    }
    if (!is("format", "sphvv-baseline") || !is("format_version", 1)) {
        throw UserError("'" + path + "' is neither a result file of sphvv (HDF5 or JSON) nor a baseline");
    }
    return tree;
}

ResultTree tree_of(const Comparison& comparison) {
    ResultTree rows = ResultTree::array();
    for (const verification::Difference& d : comparison.differences) {
        rows.push_back({{"change", to_string(d.change)},
                        {"subject", d.subject},
                        {"where", d.where},
                        {"what", d.what},
                        {"baseline", d.baseline},
                        {"current", d.current},
                        {"factor", d.factor}});
    }
    return {{"compared", comparison.compared},
            {"bitwise_equal", comparison.bitwise},
            {"fails", comparison.fails()},
            {"differences", rows}};
}

int compare_files(const std::string& baseline, const std::string& current, const Common& common) {
    const Comparison comparison = verification::compare(read_results(baseline), read_results(current));
    if (common.json != "-") {
        std::cout << markdown(comparison);
    }
    if (!common.json.empty()) {
        write_text(common.json, tree_of(comparison).dump(1) + "\n");
    }
    return comparison.fails() ? 1 : 0;
}

int bless(const std::string& current, const std::string& baseline, const Common& common) {
    const ResultTree results = read_results(current);
    ResultTree reduced;
    try {
        reduced = verification::reduced_for_baseline(results);
    } catch (const UserError& error) {
        std::cerr << "sphvv: " << error.what() << '\n';
        return 1;
    }
    if (std::filesystem::exists(baseline)) {
        const Comparison comparison = verification::compare(read_results(baseline), reduced);
        std::cout << "against the old baseline:\n" << markdown(comparison);
        if (!common.json.empty()) {
            write_text(common.json, tree_of(comparison).dump(1) + "\n");
        }
    }
    write_text(baseline, verification::baseline_text(reduced));
    return 0;
}

} // namespace

void add_compare(CLI::App& app, Act& act) {
    struct Options {
        Common common;
        std::string baseline;
        std::string current;
    };
    const auto options = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("compare", "regression gate: results against a baseline or other results");
    command->add_option("baseline", options->baseline, "baseline (JSON) or result file")->required();
    command->add_option("current", options->current, "result file")->required();
    add_common(*command, options->common);
    command->footer(
        "Example: sphvv operators --out now.h5; sphvv compare verification/baselines/operators.json now.h5\n"
        "Exit status: 0 equal, or equal to round-off; 1 an error level, order, verdict or work count "
        "changed, "
        "or something is missing; 2 wrong use.");
    command->callback([options, &act] {
        act = [options] { return compare_files(options->baseline, options->current, options->common); };
    });
}

void add_bless(CLI::App& app, Act& act) {
    struct Options {
        Common common;
        std::string baseline;
        std::string current;
    };
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("bless", "makes a result the new baseline, if all of it passes");
    command->add_option("current", options->current, "result file")->required();
    command->add_option("--baseline", options->baseline, "baseline to write")
        ->required()
        ->type_name("FILE.json");
    add_common(*command, options->common);
    command->footer(
        "Example: sphvv bless now.h5 --baseline verification/baselines/operators.json\n"
        "Prints what changed. Exit status: 0 written; 1 a verdict does not pass, nothing was written; 2 "
        "wrong use.");
    command->callback([options, &act] {
        act = [options] { return bless(options->current, options->baseline, options->common); };
    });
}

} // namespace sphvv::cli
