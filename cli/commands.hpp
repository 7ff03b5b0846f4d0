#pragma once

#include "sphvv/solver/settings.hpp"

#include <CLI/CLI.hpp>

#include <functional>
#include <string>

namespace sphvv::cli {

/// The options that every subcommand has.
struct Common {
    std::string json; ///< file for the machine-readable result, "-" for standard output, empty for none
    bool quiet = false;
};
void add_common(CLI::App& command, Common& common);

/// Adds a subcommand. When the command line is parsed and this subcommand was given, `act` holds what it
/// does; it returns the exit status.
using Act = std::function<int()>;
void add_list(CLI::App& app, Act& act);
void add_run(CLI::App& app, Act& act);
void add_operators(CLI::App& app, Act& act, const std::string& command_line);
void add_verify(CLI::App& app, Act& act, const std::string& command_line);
void add_calibrate(CLI::App& app, Act& act, const std::string& command_line);
void add_stability(CLI::App& app, Act& act, const std::string& command_line);
void add_report(CLI::App& app, Act& act);
void add_compare(CLI::App& app, Act& act);
void add_bless(CLI::App& app, Act& act);

/// KEY=VALUE texts as assignments. Throws UserError for other forms and for a key given twice.
solver::Assignments parse_assignments(const std::vector<std::string>& texts);

/// Sets the number of OpenMP threads; 0 leaves it at the number of processors.
void use_threads(int threads);

} // namespace sphvv::cli
