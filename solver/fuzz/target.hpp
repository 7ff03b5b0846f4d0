#pragma once

#include "sphvv/solver/error.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <system_error>
#include <unistd.h>

/// For -fsanitize=address: the HDF5 library (1.10.8) does not free all when it gives up on a damaged file.
extern "C" const char* lsan_default_suppressions() __asm__("__lsan_default_suppressions");
extern "C" const char* lsan_default_suppressions() {
    return "leak:libhdf5";
}

/// What a fuzz target, which includes this once, defines; libFuzzer and replay.cpp call it. It ends the
/// program if the property that it checks does not hold. What a reader does with bytes that it does not
/// accept: it throws UserError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace sphvv::fuzz {

/// Ends the program, which is how a fuzz target fails.
[[noreturn]] inline void fail(const std::string& what) {
    std::fprintf(stderr, "fuzz: %s\n", what.c_str());
    std::abort();
}

inline void require(bool holds, const std::string& what) {
    if (!holds) {
        fail(what);
    }
}

/// Whether `act` refuses its input, which it may do with a UserError only. Anything else that it throws ends
/// the program. (The command line prints the message on one line, whatever it quotes.)
template <class Act>
bool is_refused_in_words(Act&& act) {
    try {
        act();
        return false;
    } catch (const UserError& error) {
        require(!std::string_view(error.what()).empty(), "refused without a word");
        return true;
    }
}

/// The name of a file in a folder of its own, which goes with this object. In memory where the system has
/// such a place: writers wait for the disk.
class Scratch {
public:
    Scratch() {
        const std::filesystem::path memory = "/dev/shm";
        const std::filesystem::path place =
            ::access(memory.c_str(), W_OK) == 0 ? memory : std::filesystem::temp_directory_path();
        std::string pattern = (place / "sphvv-fuzz-XXXXXX").string();
        require(::mkdtemp(pattern.data()) != nullptr, "there is no folder for temporary files");
        folder_ = pattern;
    }
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;
    ~Scratch() {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }

    std::filesystem::path path() const { return folder_ / "file"; }
    /// The file with this content, for readers that want a name.
    std::filesystem::path with(std::string_view bytes) const {
        std::ofstream(path(), std::ios::binary) << bytes;
        return path();
    }

private:
    std::filesystem::path folder_;
};

} // namespace sphvv::fuzz
