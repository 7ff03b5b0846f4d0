#pragma once

#include "sphvv/solver/error.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>
#include <string_view>

/// What tests of files and of refusals share. For a test program with one source file: it defines a function.

/// For -fsanitize=address: the HDF5 library (1.10.8) does not free all when it gives up on a damaged file.
extern "C" const char* lsan_default_suppressions() __asm__("__lsan_default_suppressions");
extern "C" const char* lsan_default_suppressions() {
    return "leak:libhdf5";
}

namespace sphvv::tests {

/// A folder that goes with the test.
class TemporaryFolder : public testing::Test {
protected:
    TemporaryFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "sphvv-test-XXXXXX").string();
        folder = ::mkdtemp(pattern.data());
    }
    ~TemporaryFolder() override { std::filesystem::remove_all(folder); }

    std::filesystem::path folder;
};

inline std::string content(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

inline void put(const std::filesystem::path& file, std::string_view bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

/// The message of the Error that `act` ends with.
template <class Error = UserError, class Act>
std::string refusal(Act&& act) {
    try {
        act();
    } catch (const Error& error) {
        return error.what();
    }
    ADD_FAILURE() << "not refused";
    return {};
}

inline void expect_mentions(const std::string& message, std::initializer_list<std::string_view> parts) {
    for (const std::string_view part : parts) {
        EXPECT_NE(message.find(part), std::string::npos) << '"' << message << "\" does not mention " << part;
    }
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

} // namespace sphvv::tests
