#pragma once

#include <nlohmann/json.hpp>

#include <chrono>
#include <stdexcept>
#include <string>
#include <string_view>

namespace sphvv::cli {

/// A signal asked the program to stop; raised at the end of the step in progress.
struct Interrupted : std::runtime_error {
    explicit Interrupted(int number) : std::runtime_error("interrupted"), signal(number) {}
    int signal;
};

/// From now on SIGINT and SIGTERM are remembered instead of ending the program.
void remember_signals();
/// Throws Interrupted if one has come.
void stop_if_signalled();

/// Throws UserError unless a file of that name can be created ("-" is standard output). Leaves nothing
/// behind.
void check_writable(const std::string& path, std::string_view option);

/// Writes text to a file, or to standard output for "-". Throws UserError if it cannot be written whole.
void write_text(const std::string& path, const std::string& text);

/// A message for standard error: control characters, which it may quote from a file, become '?', so that it
/// is one line.
std::string on_one_line(std::string message);

/// Progress on standard error: a bar on a terminal, otherwise one line when something has finished.
class ProgressLine {
public:
    explicit ProgressLine(bool quiet);
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    /// Redraws the bar, at most ten times a second.
    void update(const std::string& what, double fraction);
    /// A finished piece of work.
    void done(const std::string& what);

private:
    void clear();

    bool quiet_;
    bool terminal_;
    std::chrono::steady_clock::time_point last_{};
    bool drawn_ = false;
};

} // namespace sphvv::cli
