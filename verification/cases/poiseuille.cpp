#include "sphvv/verification/cases.hpp"

namespace sphvv::verification::cases {

const Case& poiseuille() {
    static const Case flow{
        .name = "poiseuille",
        .summary = "plane channel between two walls at rest, driven by a body force from rest",
        .equations = "incompressible Navier-Stokes in 2-D with a body force",
        .source = "Schlichting 1979 ch. V; transients after Carslaw & Jaeger 1959; Morris et al. 1997",
        .solution = "poiseuille",
        .reference_length = "width",
        .leading_key = "re",
        .end_time = 1,
        .expectations = {},
        .claims = {},
        .studies = {{.name = "poiseuille/walls",
                     .tier = Tier::quick,
                     .schemes = {"wcsph", "isph_dfs", "isph_mls"},
                     .settings = {{"re", "10"}},
                     .ladder = {10, 14, 20, 28, 40},
                     .cost = "10 s",
                     .picture_at = 40}},
        .fields = {"velocity"},
        .columns = 16,
        .profile_direction = 1,
    };
    return flow;
}

} // namespace sphvv::verification::cases
