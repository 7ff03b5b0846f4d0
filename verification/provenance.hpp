#pragma once

#include <map>
#include <string>

namespace sphvv::verification {

/// Where a result comes from.
struct Provenance {
    std::string version;
    std::string revision; ///< of the source, "unknown" outside a checkout
    bool tree_clean;      ///< no uncommitted change when it was built
    std::string compiler;
    std::string flags;
    std::string build_type;
    std::string cpu;
    int threads;
    std::map<std::string, std::string> libraries;
    std::string started; ///< ISO 8601, UTC
};

/// The provenance of a result that starts now.
Provenance current_provenance();

} // namespace sphvv::verification
