#include "sphvv/verification/cases.hpp"

namespace sphvv::verification::cases {

const Case& abc_flow() {
    static const Case flow{
        .name = "abc_flow",
        .summary = "decaying Arnold-Beltrami-Childress flow in a triply periodic cube",
        .equations = "incompressible Navier-Stokes in 3-D",
        .source =
            "Arnold 1965; Childress 1970; Beltrami flow, so (u.grad)u is a gradient and the decay is exact",
        .solution = "abc_flow",
        .reference_length = "length",
        .leading_key = "re",
        .end_time = 0.2,
        .expectations =
            {
                {.scheme = "isph_dfs",
                 .field = "velocity",
                 .where = {{"re", 50, 1e4}},
                 .order = {0.9, 2.0,
                           "forward Euler with dt proportional to h; Xu 2009 §4.3.2 (2-D): about 1, "
                           "criterion >= 0.9"},
                 .text = "the forward Euler velocity step leaves an error of O(dt), and dt = 0.2 h/U; the "
                         "smoothing error of a "
                         "coarse 3-D ladder falls faster, so the order comes down to 1 from above",
                 .waiver = "on 8 to 32^3 the order falls from 3.5 to 1: not asymptotic, finer rungs are not "
                           "run yet"},
            },
        .claims = {},
        .studies =
            {
                {.name = "abc_flow/coarse",
                 .tier = Tier::quick,
                 .schemes = {"wcsph", "isph_dfs"},
                 .settings = {{"re", "100"}},
                 .ladder = {8, 11, 16, 23, 32},
                 .cost = "20 s"},
                {.name = "abc_flow/fine",
                 .tier = Tier::nightly,
                 .schemes = {"wcsph", "isph_dfs"},
                 .settings = {{"re", "100"}},
                 .ladder = {16, 23, 32, 45, 64},
                 .cost = "3 min"},
            },
    };
    return flow;
}

} // namespace sphvv::verification::cases
