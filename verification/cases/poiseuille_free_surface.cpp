#include "sphvv/verification/cases.hpp"
#include "sphvv/verification/claims.hpp"

#include <cmath>

namespace sphvv::verification::cases {

const Case& poiseuille_free_surface() {
    static const Case flow{
        .name = "poiseuille_free_surface",
        .summary = "laminar channel with a free surface, driven by a constant body force",
        .equations = "Navier-Stokes in 2-D with gravity and a body force along the bed",
        .source = "Issa 2005 §4.2 (ISSA-LAM-CHANNEL)",
        .solution = "poiseuille_free_surface",
        .reference_length = "depth",
        .leading_key = "re",
        .end_time = 1,
        .expectations = {},
        .claims = {},
        .studies = {{.name = "poiseuille_free_surface/coarse",
                     .tier = Tier::quick,
                     .schemes = {"wcsph"},
                     .settings = {{"re", "10"}},
                     .ladder = {10, 14, 20, 28, 40},
                     .cost = "10 s",
                     .picture_at = 40}},
        .fields = {"velocity", "pressure"},
        .columns = 16,
        .profile_direction = 1,
        .hooks = {.reference_speed =
                      [](const SceneRecord& /*scene*/, const analytic::Values& values) {
                          return 1.5 * values.at("speed") +
                                 std::sqrt(values.at("gravity") * values.at("depth"));
                      }},
    };
    return flow;
}

} // namespace sphvv::verification::cases
