#pragma once

#include "sphvv/solver/settings.hpp"

#include <string>
#include <string_view>

namespace sphvv::cli {

/// A scene as it is described before its keys are resolved.
struct SceneDescription {
    std::string flow; ///< the case; empty if not given
    std::string scheme;
    int n = 0; ///< 0 if not given
    int seed = 1;
    solver::Assignments settings;

    bool operator==(const SceneDescription&) const = default;
};

/// Reads TOML: case, scheme, n, seed and a table [set] of numbers and texts. Throws UserError that names the
/// file `path` and the line or key. Whether there is such a case is not asked here.
SceneDescription parse_scene(std::string_view text, const std::string& path);

/// Throws as parse_scene, and if the file cannot be read.
SceneDescription read_scene_file(const std::string& path);

} // namespace sphvv::cli
