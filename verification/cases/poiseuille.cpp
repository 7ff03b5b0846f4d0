#include "sphvv/verification/cases.hpp"
#include "sphvv/verification/wall_orders.hpp"

namespace sphvv::verification::cases {

const Case& poiseuille() {
    static const Case flow{
        .name = "poiseuille",
        .summary = "plane channel between two walls at rest, driven by a body force from rest",
        .equations = "incompressible Navier-Stokes in 2-D with a body force",
        .source =
            "Schlichting 1979 ch. V; transients: Carslaw & Jaeger 1959 ch. III; as a test of SPH: Morris "
            "et al. 1997",
        .solution = "poiseuille",
        .reference_length = "width",
        .leading_key = "re",
        .end_time = 1,
        .expectations = wall_orders::expectations(wall_orders::MorrisFloor::below),
        .claims = {},
        .studies = wall_orders::studies("poiseuille"),
        .fields = {"velocity"},
        .columns = 16,
        .profile_direction = 1,
    };
    return flow;
}

} // namespace sphvv::verification::cases
