#include "sphvv/solver/error.hpp"

#include "commands.hpp"
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <unistd.h>

namespace sphvv::cli {
namespace {

/// Where the report's Python package is: beside an installed program, or in the source tree.
std::string package_folder() {
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe");
    const std::filesystem::path installed = program.parent_path().parent_path() / "share" / "sphvv";
    return std::filesystem::exists(installed / "sphvv_report") ? installed.string() : SPHVV_REPORTS;
}

struct Options {
    Common common;
    std::vector<std::string> files;
    std::string out;
    std::vector<std::string> changes;
    std::string history;
};

/// Hands over to the report generator, which reads result files only. Its exit status is ours.
int report(const Options& options) {
    std::vector<std::string> words{SPHVV_PYTHON, "-B", "-m", "sphvv_report"};
    const auto add = [&words](const char* option, const std::string& value) {
        if (!value.empty()) {
            words.push_back(option + ("=" + value)); // one word, so that a value may begin with a dash
        }
    };
    add("--out", options.out);
    for (const std::string& path : options.changes) {
        add("--changes", path);
    }
    add("--history", options.history);
    add("--json", options.common.json);
    if (options.common.quiet) {
        words.emplace_back("--quiet");
    }
    words.emplace_back("--");
    words.insert(words.end(), options.files.begin(), options.files.end());
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (std::string& word : words) {
        arguments.push_back(word.data());
    }
    arguments.push_back(nullptr);
    ::setenv("PYTHONPATH", package_folder().c_str(), 1);
    ::execv(SPHVV_PYTHON, arguments.data());
    throw UserError(std::string("cannot start ") + SPHVV_PYTHON + ": " + std::strerror(errno));
}

} // namespace

void add_report(CLI::App& app, Act& act) {
    const auto options = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("report", "result files in, one self-contained page with tables and pictures out");
    command
        ->add_option(
            "files", options->files,
            "result files of sphvv verify and operators (HDF5 or JSON), and of scripts/seeded_faults")
        ->required()
        ->type_name("FILE");
    command->add_option("--out", options->out, "folder for index.html, tables/ and figures/")
        ->required()
        ->type_name("DIR");
    command
        ->add_option("--changes", options->changes,
                     "what changed since a baseline: output of sphvv compare BASELINE FILE --json FILE.json")
        ->allow_extra_args(false)
        ->type_name("FILE.json");
    command
        ->add_option("--history", options->history,
                     "nights to draw trends of: the history of scripts/nightly")
        ->type_name("FILE.jsonl");
    add_common(*command, options->common);
    command->footer("Example: sphvv report taylor_green.h5 --out report\n"
                    "         sphvv compare verification/baselines/operators.json now.h5 --json "
                    "changes.json; sphvv report "
                    "now.h5 --changes changes.json --out report\n"
                    "Exit status: 0 the report is written, whatever its verdicts say; 2 a file is no such "
                    "file or damaged, "
                    "and nothing is written.");
    command->callback([options, &act] { act = [options] { return report(*options); }; });
}

} // namespace sphvv::cli
