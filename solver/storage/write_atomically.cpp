#include "sphvv/solver/storage/write_atomically.hpp"

#include "sphvv/solver/error.hpp"

#include <cerrno>
#include <fcntl.h>
#include <string>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace sphvv::solver::storage {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
    throw UserError(path.string() + ": cannot be written: " + why);
}

[[noreturn]] void refuse(const std::filesystem::path& path, int cause) {
    refuse(path, std::generic_category().message(cause));
}

/// A file that is removed again unless it gets its final name.
class TemporaryFile {
public:
    TemporaryFile(const std::filesystem::path& folder, const std::filesystem::path& asked) : asked_(asked) {
        // Another run may write to the same folder, and one that was killed may have left its file behind.
        for (int attempt = 0; descriptor_ < 0; ++attempt) {
            path_ = folder / (".sphvv-part-" + std::to_string(::getpid()) + "-" + std::to_string(attempt));
            descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (descriptor_ < 0 && (errno != EEXIST || attempt == 10000)) {
                refuse(asked_, errno);
            }
        }
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile() {
        if (descriptor_ >= 0) {
            ::close(descriptor_);
        }
        if (!path_.empty()) {
            ::unlink(path_.c_str());
        }
    }

    void take_permissions(mode_t mode) { check(::fchmod(descriptor_, mode & 07777)); }

    void write(std::string_view content) {
        while (!content.empty()) {
            const ssize_t written = ::write(descriptor_, content.data(), content.size());
            if (written < 0 && errno == EINTR) {
                continue;
            }
            check(written < 0 ? -1 : 0);
            content.remove_prefix(static_cast<std::size_t>(written));
        }
    }

    /// Some file systems report a full disk or an exceeded quota only here.
    void finish() {
        check(::fsync(descriptor_));
        const int descriptor = descriptor_;
        descriptor_ = -1;
        check(::close(descriptor));
    }

    void rename_to(const std::filesystem::path& target) {
        check(::rename(path_.c_str(), target.c_str()));
        path_.clear();
    }

private:
    void check(int status) const {
        if (status != 0) {
            refuse(asked_, errno);
        }
    }

    const std::filesystem::path& asked_;
    std::filesystem::path path_;
    int descriptor_ = -1;
};

/// Makes the new name last through a power failure. Best effort: the file is complete, and not every file
/// system can do this.
void sync_folder(const std::filesystem::path& folder) {
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor >= 0) {
        ::fsync(descriptor);
        ::close(descriptor);
    }
}

} // namespace

void write_atomically(const std::filesystem::path& path, std::string_view content) {
    std::error_code ignored;
    const std::filesystem::path target =
        std::filesystem::is_symlink(path, ignored) ? std::filesystem::weakly_canonical(path, ignored) : path;
    const std::filesystem::path folder = target.has_parent_path() ? target.parent_path() : ".";
    struct stat existing {};
    const bool exists = ::stat(target.c_str(), &existing) == 0;
    if (exists && S_ISDIR(existing.st_mode)) {
        refuse(path, "it is a folder");
    }
    if (exists && !S_ISREG(existing.st_mode)) {
        refuse(path, "it is not a regular file");
    }
    if (exists && ::faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0) {
        refuse(path, errno);
    }
    if (!target.has_filename()) {
        refuse(path, "no file is named");
    }
    if (!std::filesystem::is_directory(folder, ignored)) {
        refuse(path, "there is no folder " + folder.string());
    }
    TemporaryFile file(folder, path);
    if (exists) {
        file.take_permissions(existing.st_mode);
    }
    file.write(content);
    file.finish();
    file.rename_to(target);
    sync_folder(folder);
}

} // namespace sphvv::solver::storage
