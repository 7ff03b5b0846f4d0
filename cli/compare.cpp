#include "sphvv/verification/compare.hpp"

#include "commands.hpp"
#include "output.hpp"
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

namespace sphvv::cli {
namespace {

using verification::Comparison;
using verification::ResultTree;

/// Which of the two files it was, as far as the file tells: a report must not show the changes of another
/// run.
ResultTree side(const std::string& path, const ResultTree& tree) {
    const ResultTree provenance = tree.value("provenance", ResultTree::object());
    return {{"file", std::filesystem::path(path).filename().string()},
            {"revision", provenance.value("revision", "")},
            {"started", provenance.value("started", "")}};
}

ResultTree tree_of(const Comparison& comparison, const ResultTree& baseline, const ResultTree& current) {
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
    return {{"format", "sphvv-comparison"},
            {"format_version", 1},
            {"baseline", baseline},
            {"current", current},
            {"compared", comparison.compared},
            {"bitwise_equal", comparison.bitwise},
            {"fails", comparison.fails()},
            {"differences", rows}};
}

bool is_baseline(const ResultTree& tree) {
    return tree.at("format") == "sphvv-baseline";
}

/// Several result files of one build as one. Throws UserError, in one sentence, for a baseline among them:
/// then the arguments were swapped.
ResultTree read_current(const std::vector<std::string>& paths) {
    std::vector<ResultTree> trees;
    for (const std::string& path : paths) {
        trees.push_back(verification::read_comparable(path));
        if (is_baseline(trees.back())) {
            throw UserError("'" + path +
                            "' is a baseline and stands where a result file is expected; the baseline comes "
                            "first");
        }
    }
    return verification::merged(trees);
}

struct CompareOptions {
    Common common;
    std::string baseline;
    std::vector<std::string> current;
    std::string summary;
};

int compare_files(const CompareOptions& options) {
    check_writable(options.summary, "--summary");
    check_writable(options.common.json, "--json");
    const ResultTree baseline = verification::read_comparable(options.baseline);
    const ResultTree current = read_current(options.current);
    const Comparison comparison = verification::compare(baseline, current);
    if (options.common.json != "-" && options.summary != "-") {
        std::cout << markdown(comparison);
    }
    if (!options.summary.empty()) {
        write_text(options.summary, summary(comparison, baseline, current));
    }
    if (!options.common.json.empty()) {
        write_text(options.common.json, tree_of(comparison, side(options.baseline, baseline),
                                                side(options.current.front(), current))
                                                .dump(1) +
                                            "\n");
    }
    return comparison.fails() ? 1 : 0;
}

struct BlessOptions {
    Common common;
    std::vector<std::string> current;
    std::string baseline;
    bool allow_missing = false;
    bool allow_dirty = false;
};

/// The baseline that is to be replaced, if there is one. Throws UserError for a result file: overwriting it
/// would lose hours of runs to a slip of the hand.
std::optional<ResultTree> old_baseline(const std::string& path) {
    if (!std::filesystem::exists(path)) {
        return {};
    }
    ResultTree tree = verification::read_comparable(path);
    if (!is_baseline(tree)) {
        throw UserError("--baseline '" + path +
                        "' is a result file and not a baseline, so it is not overwritten");
    }
    return tree;
}

/// What the old baseline has and the new one would not check ever again; empty if there is nothing.
std::string missing_entries(const Comparison& comparison) {
    const auto missing = [](const verification::Difference& d) {
        return d.change == verification::Change::missing;
    };
    const auto first = std::ranges::find_if(comparison.differences, missing);
    return first == comparison.differences.end()
               ? std::string()
               : "the result lacks " +
                     std::to_string(std::ranges::count_if(comparison.differences, missing)) +
                     " entries of the old baseline, the first of them " + first->subject + " (" +
                     first->where + "); --allow-missing drops them";
}

int refuse_to_bless(const std::string& why) {
    std::cerr << "sphvv: " << why << '\n';
    return 1;
}

int bless(const BlessOptions& options) {
    check_writable(options.common.json, "--json");
    const ResultTree results = read_current(options.current);
    const std::optional<ResultTree> old = old_baseline(options.baseline);
    if (!old && !options.common.json.empty()) {
        throw UserError("--json tells what changes against the old baseline, and there is none in '" +
                        options.baseline + "'");
    }
    ResultTree reduced;
    try {
        reduced = verification::reduced_for_baseline(results, options.allow_dirty);
    } catch (const UserError& error) {
        return refuse_to_bless(error.what());
    }
    if (old) {
        const Comparison comparison = verification::compare(*old, reduced);
        if (options.common.json != "-") {
            std::cout << "against the old baseline:\n" << markdown(comparison);
        }
        if (!options.common.json.empty()) {
            write_text(options.common.json, tree_of(comparison, side(options.baseline, *old),
                                                    side(options.current.front(), results))
                                                    .dump(1) +
                                                "\n");
        }
        const std::string missing = missing_entries(comparison);
        if (!missing.empty() && !options.allow_missing) {
            return refuse_to_bless(missing);
        }
    }
    write_text(options.baseline, verification::baseline_text(reduced));
    return 0;
}

} // namespace

void add_compare(CLI::App& app, Act& act) {
    const auto options = std::make_shared<CompareOptions>();
    CLI::App* command =
        app.add_subcommand("compare", "regression gate: results against a baseline or other results");
    command->add_option("baseline", options->baseline, "baseline (JSON) or result file")->required();
    command->add_option("current", options->current, "result files of one build, taken together")
        ->required()
        ->type_name("FILE");
    command
        ->add_option("--summary", options->summary,
                     "Markdown of at most 40 lines for a pull request, in place of the table with -")
        ->type_name("FILE.md");
    add_common(*command, options->common);
    command->footer(
        "Example: sphvv operators --out now.h5; sphvv compare verification/baselines/operators.json now.h5\n"
        "Exit status: 0 equal, or equal to round-off; 1 an error level, order, demand, verdict or work count "
        "changed, or something is missing; 2 wrong use.");
    command->callback([options, &act] { act = [options] { return compare_files(*options); }; });
}

void add_bless(CLI::App& app, Act& act) {
    const auto options = std::make_shared<BlessOptions>();
    CLI::App* command = app.add_subcommand("bless", "makes a result the new baseline, if all of it passes");
    command->add_option("current", options->current, "result files of one build, taken together")
        ->required()
        ->type_name("FILE");
    command->add_option("--baseline", options->baseline, "baseline to write")
        ->required()
        ->type_name("FILE.json");
    command->add_flag("--allow-missing", options->allow_missing,
                      "drop what the old baseline has and the result has not");
    command->add_flag("--allow-dirty", options->allow_dirty,
                      "take a result whose source was not committed when it was built");
    add_common(*command, options->common);
    command->footer(
        "Example: sphvv bless now.h5 --baseline verification/baselines/operators.json\n"
        "Prints what changed. Exit status: 0 written; 1 nothing was written, since a verdict does "
        "not pass, entries of the old baseline are missing or the source was not committed; 2 "
        "wrong use, such as a result file in the place of the baseline.");
    command->callback([options, &act] { act = [options] { return bless(*options); }; });
}

} // namespace sphvv::cli
