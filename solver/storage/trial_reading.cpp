#include "sphvv/solver/storage/trial_reading.hpp"

#include "sphvv/solver/error.hpp"
#include "sphvv/solver/storage/hdf5.hpp"

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <exception>
#include <fcntl.h>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

namespace sphvv::solver::storage {
namespace {

constexpr int deepest = 64;
/// Processor time (s) of a trial, beside that for a share of the file. A file of small groups and attributes
/// is the slowest: 4 MB/s measured. Ten times that is left to slow machines, as only a reading that never
/// ends must be found.
constexpr rlim_t least_seconds = 10;
constexpr std::uintmax_t bytes_per_second = 400'000;

/// Whatever is refused in words will be refused again by who reads for good.
template <class Act>
void passing_over_refusals(Act&& act) {
    try {
        act();
    } catch (const UserError&) {
        return;
    }
}

/// Every way in which a value of that kind can be asked for.
template <class Read>
void read_as(Kind kind, Read&& read) {
    if (kind == Kind::text) {
        passing_over_refusals([&] { read(std::string()); });
    } else if (kind != Kind::other) {
        passing_over_refusals([&] { read(double()); });
        passing_over_refusals([&] { read(std::int64_t()); });
        passing_over_refusals([&] { read(std::uint8_t()); });
    }
}

void read_all(const Group& group, int depth) {
    passing_over_refusals([&] {
        for (const std::string& name : group.attribute_names()) {
            passing_over_refusals([&] {
                read_as(group.attribute_kind(name),
                        [&]<class T>(const T&) { group.attribute_array<T>(name); });
            });
        }
    });
    passing_over_refusals([&] {
        for (const std::string& name : group.member_names()) {
            passing_over_refusals([&] {
                if (!group.is_group(name)) {
                    read_as(group.extent(name).kind, [&]<class T>(const T&) { group.dataset<T>(name); });
                } else if (depth < deepest) {
                    read_all(group.group(name), depth + 1);
                }
            });
        }
    });
}

/// The child: it ends by a signal, or with 0. Nobody hears what the library, the C library or a sanitizer
/// says about it.
[[noreturn]] void try_to_read(const std::filesystem::path& path) {
    for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGABRT, SIGILL, SIGXCPU}) {
        std::signal(signal, SIG_DFL);
    }
    const rlimit no_core{0, 0};
    ::setrlimit(RLIMIT_CORE, &no_core);
    std::error_code ignored;
    const rlim_t seconds = least_seconds + std::filesystem::file_size(path, ignored) / bytes_per_second;
    const rlimit time{seconds, seconds + 1};
    ::setrlimit(RLIMIT_CPU, &time);
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    ::dup2(nowhere, STDERR_FILENO);
    try {
        read_all(open_hdf5(path), 0);
    } catch (const std::exception&) {
        ::_exit(0); // in words, or for want of memory: it will happen again
    }
    ::_exit(0);
}

} // namespace

void read_in_trial(const std::filesystem::path& path) {
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
    // Under the sanitizers a process costs a hundred readings. What breaks down for want of the trial is told
    // from a find by replaying it, with the trial.
    static_cast<void>(try_to_read);
    static_cast<void>(path);
    return;
#endif
    const pid_t child = ::fork();
    if (child == 0) {
        try_to_read(path);
    }
    int status = 0;
    while (child > 0 && ::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    // Without a child (no memory for one) the file is read for good at once, as it would be after the trial.
    if (status != 0) {
        const bool endless = WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU;
        throw UserError(path.string() + ": the file is damaged (the HDF5 library " +
                        (endless ? "comes to no end with it)" : "breaks down at it)"));
    }
}

} // namespace sphvv::solver::storage
