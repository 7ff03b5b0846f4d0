#include "sphvv/verification/cases.hpp"
#include "sphvv/verification/wall_orders.hpp"

namespace sphvv::verification::cases {

const Case& couette() {
    static const Case flow{
        .name = "couette",
        .summary = "plane channel whose upper wall is set going at t = 0",
        .equations = "incompressible Navier-Stokes in 2-D",
        .source =
            "Schlichting 1979 ch. V; Carslaw & Jaeger 1959 ch. III, XII; as a test of SPH: Morris et al. "
            "1997",
        .solution = "couette",
        .reference_length = "width",
        .leading_key = "re",
        .end_time = 1,
        .expectations = wall_orders::expectations(wall_orders::MorrisFloor::reached),
        .claims = {},
        .studies = wall_orders::studies("couette"),
        .fields = {"velocity"},
        .columns = 16,
        .profile_direction = 1,
    };
    return flow;
}

} // namespace sphvv::verification::cases
