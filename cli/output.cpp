#include "output.hpp"

#include "sphvv/solver/error.hpp"
#include "sphvv/solver/storage/write_atomically.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <iostream>
#include <sys/stat.h>
#include <unistd.h>

namespace sphvv::cli {
namespace {

volatile std::sig_atomic_t pending_signal = 0;

extern "C" void remember(int number) {
    pending_signal = number;
}

} // namespace

void remember_signals() {
    struct sigaction action {};
    action.sa_handler = remember;
    action.sa_flags = SA_RESTART;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

void stop_if_signalled() {
    if (pending_signal != 0) {
        throw Interrupted(pending_signal);
    }
}

void check_writable(const std::string& path, std::string_view option) {
    if (path.empty() || path == "-") {
        return;
    }
    struct stat existing {};
    const bool exists = ::stat(path.c_str(), &existing) == 0;
    int problem = 0;
    if (exists && !S_ISREG(existing.st_mode)) {
        throw UserError(std::string(option) + ": '" + path + "' exists and is not a regular file");
    }
    // The result is renamed into place, so what has to be possible is a new file beside it.
    const std::string probe = path + ".probe";
    const int file = ::open(probe.c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0666);
    if (file < 0) {
        problem = errno;
    } else {
        ::close(file);
        ::unlink(probe.c_str());
    }
    if (problem != 0) {
        throw UserError(std::string(option) + ": cannot write '" + path + "': " + std::strerror(problem));
    }
}

void write_text(const std::string& path, const std::string& text) {
    if (path == "-") {
        std::cout << text << std::flush;
        if (!std::cout) {
            throw UserError("standard output cannot be written");
        }
        return;
    }
    solver::storage::write_atomically(path, text);
}

std::string on_one_line(std::string message) {
    for (char& c : message) {
        const auto code = static_cast<unsigned char>(c);
        c = code < 0x20 || code == 0x7F ? '?' : c;
    }
    return message;
}

ProgressLine::ProgressLine(bool quiet) : quiet_(quiet), terminal_(::isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
    clear();
}

void ProgressLine::clear() {
    if (drawn_) {
        std::fputs("\r\033[K", stderr);
        std::fflush(stderr);
        drawn_ = false;
    }
}

void ProgressLine::update(const std::string& what, double fraction) {
    const auto now = std::chrono::steady_clock::now();
    if (quiet_ || !terminal_ || now - last_ < std::chrono::milliseconds(100)) {
        return;
    }
    last_ = now;
    constexpr int width = 24;
    const int filled = static_cast<int>(fraction * width);
    const std::string bar = std::string(filled, '#') + std::string(width - filled, '.');
    std::fprintf(stderr, "\r\033[K[%s] %3.0f %%  %s", bar.c_str(), 100 * fraction, what.c_str());
    std::fflush(stderr);
    drawn_ = true;
}

void ProgressLine::done(const std::string& what) {
    if (quiet_) {
        return;
    }
    clear();
    std::fprintf(stderr, "%s\n", what.c_str());
}

} // namespace sphvv::cli
