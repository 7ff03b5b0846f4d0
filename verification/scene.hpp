#pragma once

#include "sphvv/analytic/solution.hpp"
#include "sphvv/solver/schemes.hpp"
#include "sphvv/solver/simulation.hpp"
#include "sphvv/verification/cases.hpp"

#include <cstdint>
#include <string>
#include <utility>

namespace sphvv::verification {

/// A scheme with settings of its own, next to others on one ladder.
struct Variant {
    // Not explicit: a scheme is the variant of itself that has no settings of its own.
    Variant(const solver::Scheme* of, solver::Assignments own = {}) : scheme(of), settings(std::move(own)) {}

    const solver::Scheme* scheme;
    solver::Assignments settings; ///< of the case or of the scheme

    /// The text that variant_of() reads, e.g. "isph_dfs" or "isph_dfs:shift_correction=none".
    std::string label() const;
    bool operator==(const Variant&) const = default;
};

/// Reads SCHEME[:KEY=VALUE…]. Throws UserError for another form or an unknown scheme.
Variant variant_of(std::string_view text);

/// Everything that determines one simulation.
struct SceneRecord {
    const Case* flow;
    const solver::Scheme* scheme;
    std::string label; ///< under which its runs go: that of the variant
    solver::Settings case_settings;
    solver::Settings scheme_settings;
    int n;                  ///< particle spacings along the case's reference length
    std::uint64_t seed = 1; ///< of a jittered, settled or unstructured start
    bool picture = false;   ///< the run keeps its particles at the end
};

/// Sorts assignments, and those of the variant, which win, to the case's and the scheme's keys. A key that
/// neither has throws UserError naming both lists; `also_known` are keys to pass over, because another scheme
/// of the same command takes them.
SceneRecord resolve_scene(const Case& flow, const Variant& variant, const solver::Assignments& given, int n,
                          std::span<const solver::Key> also_known = {});

/// The parameters of the scene's exact solution.
analytic::Values solution_values(const SceneRecord& scene);

/// dx (m): the reference length over n. Where rows lie differently at two opposite sides, so that n spacings
/// do not fit, over n + 1/2 (a row of wall particles at one of them) or n - 1/2 (a row on the free surface).
double spacing_of(const SceneRecord& scene);

/// 2 or 3.
int dimension(const SceneRecord& scene);

/// Throws UserError if n is too small for a periodic box (which must hold two kernel supports, so that no
/// particle meets two images of another) or between walls (one support), if the rows do not fill the domain,
/// or if n is too large for this program.
void check_scene(const SceneRecord& scene);

/// The scene's particles at t = 0 with velocity and pressure of the exact solution, its walls and free
/// surface, and the scheme's stages. Fluid particles are half a spacing from a surface and from a wall
/// without wall particles.
/// Throws as check_scene.
template <int Dim>
solver::Simulation<Dim> build_scene(const SceneRecord& scene);

} // namespace sphvv::verification
