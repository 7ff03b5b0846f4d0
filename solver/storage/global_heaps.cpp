#include "sphvv/solver/storage/global_heaps.hpp"

#include <algorithm>
#include <cstdint>
#include <fcntl.h>
#include <functional>
#include <set>
#include <span>
#include <string_view>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace sphvv::solver::storage {
namespace {

constexpr std::size_t header_bytes = 16; // of a collection and of an object in it
constexpr std::size_t size_offset = 8;   // in both headers
constexpr std::uint64_t smallest_collection = 4096;
constexpr std::string_view signature("GCOL\1", 5); // with the version

/// The bytes of a file; empty if it cannot be read.
class MappedFile {
public:
    explicit MappedFile(const std::filesystem::path& path) {
        const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
        struct stat status {};
        if (descriptor < 0) {
            return;
        }
        if (::fstat(descriptor, &status) == 0 && status.st_size > 0) {
            const auto size = static_cast<std::size_t>(status.st_size);
            void* data = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
            if (data != MAP_FAILED) {
                bytes_ = {static_cast<const char*>(data), size};
            }
        }
        ::close(descriptor);
    }
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;
    ~MappedFile() {
        if (!bytes_.empty()) {
            ::munmap(const_cast<char*>(bytes_.data()), bytes_.size());
        }
    }

    std::string_view bytes() const { return bytes_; }

private:
    std::string_view bytes_;
};

std::uint64_t little_endian(std::string_view bytes) {
    std::uint64_t value = 0;
    for (std::size_t k = bytes.size(); k > 0; --k) {
        value = value << 8 | static_cast<std::uint8_t>(bytes[k - 1]);
    }
    return value;
}

/// `objects` is a collection without its header.
bool is_sound(std::string_view objects) {
    std::set<std::uint64_t> seen;
    while (objects.size() >= header_bytes) {
        const std::uint64_t index = little_endian(objects.substr(0, 2));
        const std::uint64_t size = little_endian(objects.substr(size_offset, 8));
        if (size > objects.size()) {
            return false;
        }
        // Index 0 is the free rest; its size counts its header. The others are padded to whole eight bytes.
        const std::uint64_t extent = index == 0 ? size : header_bytes + (size + 7) / 8 * 8;
        if (extent < header_bytes || extent > objects.size() || !seen.insert(index).second) {
            return false;
        }
        objects.remove_prefix(extent);
    }
    return true;
}

} // namespace

bool are_global_heaps_sound(const std::filesystem::path& path) {
    const MappedFile file(path);
    std::string_view rest = file.bytes();
    const std::boyer_moore_horspool_searcher searcher(signature.begin(), signature.end());
    while (true) {
        const auto found = std::search(rest.begin(), rest.end(), searcher);
        rest.remove_prefix(static_cast<std::size_t>(found - rest.begin()));
        if (rest.size() < smallest_collection) {
            return true;
        }
        const std::uint64_t size = little_endian(rest.substr(size_offset, 8));
        // Another size is chance (the signature within numbers) or damage that the library itself notices.
        const bool plausible = size >= smallest_collection && size <= rest.size();
        if (plausible && !is_sound(rest.substr(header_bytes, size - header_bytes))) {
            return false;
        }
        rest.remove_prefix(plausible ? size : signature.size());
    }
}

} // namespace sphvv::solver::storage
