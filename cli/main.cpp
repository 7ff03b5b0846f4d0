// sphvv: the one executable. It parses the command line and opens the door to the rooms; no logic of its own.
#include "sphvv/solver/error.hpp"

#include <omp.h>

#include "commands.hpp"
#include "output.hpp"
#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <new>
#include <stdexcept>
#include <unistd.h>

namespace sphvv::cli {

void add_common(CLI::App& command, Common& common) {
    command.add_option("--json", common.json, "write the result as JSON to FILE (- for standard output)")
        ->type_name("FILE");
    command.add_flag("--quiet", common.quiet, "no progress on standard error");
}

void use_threads(int threads) {
    if (threads < 0 || threads > 1024) {
        throw UserError("--threads: " + std::to_string(threads) +
                        " is not accepted; give a number from 1 to 1024");
    }
    if (threads > 0) {
        omp_set_num_threads(threads);
    }
}

} // namespace sphvv::cli

namespace {

/// Threads that wait by spinning take the processor from the one they wait for as soon as anything else runs
/// on the machine (three to four times the run time beside one busy process). OpenMP reads its policy when
/// the program is loaded, so the program starts itself again with the policy set, unless the user has chosen
/// one.
void wait_without_spinning(char** argv) {
    if (std::getenv("OMP_WAIT_POLICY") == nullptr) {
        ::setenv("OMP_WAIT_POLICY", "passive", 0);
        ::execv("/proc/self/exe", argv); // on failure we go on as we are
    }
}

std::string subcommand_names(const CLI::App& app) {
    std::string names;
    for (const CLI::App* command : app.get_subcommands({})) {
        names += (names.empty() ? "" : ", ") + command->get_name();
    }
    return names;
}
int answer(int argc, char** argv) {
    using namespace sphvv;
    constexpr int wrong_use = 2;
    constexpr int not_finished = 3;
    std::string command_line = "sphvv";
    for (int k = 1; k < argc; ++k) {
        command_line += std::string(" ") + argv[k];
    }
    CLI::App app{"Verification and validation of smoothed particle hydrodynamics"};
    app.set_version_flag("--version", SPHVV_VERSION_TEXT);
    app.require_subcommand(1);
    app.footer("Start with: sphvv list; sphvv verify taylor_green --out results.h5; sphvv report results.h5 "
               "--out report");
    cli::Act act;
    cli::add_list(app, act);
    cli::add_run(app, act);
    cli::add_operators(app, act, command_line);
    cli::add_verify(app, act, command_line);
    cli::add_calibrate(app, act, command_line);
    cli::add_stability(app, act, command_line);
    cli::add_report(app, act);
    cli::add_compare(app, act);
    cli::add_bless(app, act);
    const auto commands = app.get_subcommands({});
    if (argc > 1 && argv[1][0] != '-' &&
        std::none_of(commands.begin(), commands.end(),
                     [&](const CLI::App* c) { return c->get_name() == argv[1]; })) {
        std::cerr << "sphvv: there is no command '" << argv[1] << "'; accepted: " << subcommand_names(app)
                  << "\n";
        return wrong_use;
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) {
        return app.exit(success); // --help, --version
    } catch (const CLI::ParseError& error) {
        std::cerr << "sphvv: " << cli::on_one_line(error.what()) << " (see sphvv --help)\n";
        return wrong_use;
    }
    try {
        return act();
    } catch (const UserError& error) {
        std::cerr << "sphvv: " << cli::on_one_line(error.what()) << '\n';
        return wrong_use;
    } catch (const std::invalid_argument& error) {
        std::cerr << "sphvv: " << cli::on_one_line(error.what()) << '\n';
        return wrong_use;
    } catch (const cli::Interrupted& interrupted) {
        std::cerr << "sphvv: interrupted\n";
        return 128 + interrupted.signal;
    } catch (const std::bad_alloc&) {
        std::cerr << "sphvv: not enough memory for this scene\n";
        return not_finished;
    } catch (const std::exception& error) {
        std::cerr << "sphvv: internal error: " << cli::on_one_line(error.what()) << '\n';
        return not_finished;
    }
}

} // namespace

int main(int argc, char** argv) {
    wait_without_spinning(argv);
    try {
        return answer(argc, argv);
    } catch (...) { // only memory for the message itself can be missing here
        return 3;
    }
}
