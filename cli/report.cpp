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

/// Hands over to the report generator, which reads result files only. Its exit status is ours.
int report(const std::vector<std::string>& files, const std::string& out, bool quiet) {
    std::vector<std::string> words{SPHVV_PYTHON, "-B", "-m", "sphvv_report"};
    words.insert(words.end(), files.begin(), files.end());
    words.insert(words.end(), {"--out", out});
    if (quiet) {
        words.emplace_back("--quiet");
    }
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
    struct Options {
        Common common;
        std::vector<std::string> files;
        std::string out;
    };
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
    command->add_flag("--quiet", options->common.quiet, "no progress on standard error");
    command->footer("Example: sphvv report taylor_green.h5 --out report");
    command->callback([options, &act] {
        act = [options] { return report(options->files, options->out, options->common.quiet); };
    });
}

} // namespace sphvv::cli
