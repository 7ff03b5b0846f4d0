#pragma once

#include "sphvv/verification/run.hpp"

#include <cstdio>

namespace sphvv::verification {

/// The first run of that scheme and rung, or nullptr.
inline const RunRecord* find_run(std::span<const RunRecord> runs, std::string_view scheme, int n) {
    for (const RunRecord& run : runs) {
        if (run.scheme == scheme && run.n == n) {
            return &run;
        }
    }
    return nullptr;
}

/// A number as printf writes it.
inline std::string number(double value, const char* format) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

} // namespace sphvv::verification
