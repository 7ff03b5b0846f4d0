#include "sphvv/verification/cases.hpp"
#include "sphvv/verification/scene.hpp"

#include <cmath>
#include <numbers>

namespace sphvv::verification::cases {
namespace {

struct Annulus {
    double inner;
    double outer;
};

Annulus annulus(const SceneRecord& scene) {
    const double inner = scene.case_settings.number("inner_radius");
    return {inner, inner / scene.case_settings.number("radius_ratio")};
}

int ring_count(const SceneRecord& scene) {
    const auto [inner, outer] = annulus(scene);
    return static_cast<int>(std::lround((outer - inner) / spacing_of(scene)));
}

/// Rings about the axis, dr apart and the outermost dr/2 from the walls, with as many particles as make their
/// distance along the ring nearest to dr; every ring begins at another angle.
void arrange_in_rings(const SceneRecord& scene, std::array<std::vector<double>, 2>& points) {
    using std::numbers::pi;
    const auto [inner, outer] = annulus(scene);
    const int rings = ring_count(scene);
    const double dr = (outer - inner) / rings;
    points = {};
    for (int k = 0; k < rings; ++k) {
        const double r = inner + (k + 0.5) * dr;
        const auto count = static_cast<int>(std::lround(2 * pi * r / dr));
        const double start = pi * (std::sqrt(5.) - 1) * k; // the golden angle: no two rings alike
        for (int j = 0; j < count; ++j) {
            const double angle = start + 2 * pi * j / count;
            points[0].push_back(r * std::cos(angle));
            points[1].push_back(r * std::sin(angle));
        }
    }
}

/// The particles share the area of the annulus.
void set_mass(const SceneRecord& scene, solver::Simulation<2>& simulation) {
    const auto [inner, outer] = annulus(scene);
    simulation.particle_mass = simulation.density * std::numbers::pi * (outer * outer - inner * inner) /
                               static_cast<double>(simulation.particles.fluid_size());
}

} // namespace

const Case& taylor_couette() {
    static const Case flow{
        .name = "taylor_couette",
        .summary = "flow between cylinders, the inner one turning from t = 0: curved walls",
        .equations = "incompressible Navier-Stokes in 2-D",
        .source = "Schlichting 1979 ch. V; transients by Bessel functions: Carslaw & Jaeger 1959 ch. XIII",
        .solution = "taylor_couette",
        .reference_length = "inner_radius",
        .leading_key = "re",
        .end_time = 1,
        .expectations =
            {{.scheme = "isph_mls",
              .field = "velocity",
              .where = {{"re", 1, 20}, {"operators", 0, 0, "quadratic"}},
              .order =
                  {1.0, 2.4,
                   "derived: as at a plane wall, but a curved mirror changes the volume of an image by the "
                   "factor 1 + O(h/R), and particles on rings are no lattice (laplacian_mls_quadratic: "
                   "between 2 and 1)"},
              .text = "a Laplacian wrong by O(1) next to the walls, and by O(h) to O(h^2) elsewhere"}},
        .claims = {},
        .studies = {{.name = "taylor_couette/rings",
                     .tier = Tier::quick,
                     .schemes = {"isph_mls", "isph_dfs:laplacian=schwaiger", "wcsph:kernel=quintic_spline"},
                     .settings = {{"re", "10"}, {"end_time", "0.5"}},
                     .ladder = {8, 11, 16, 22, 32},
                     .cost = 40,
                     .picture_at = 16},
                    {.name = "taylor_couette/fine",
                     .tier = Tier::nightly,
                     .schemes = {"isph_mls", "isph_dfs:laplacian=schwaiger", "wcsph:kernel=quintic_spline"},
                     .settings = {{"re", "10"}, {"end_time", "0.5"}},
                     .ladder = {16, 22, 32, 45, 64},
                     .cost = 320,
                     .picture_at = 32}},
        .fields = {"velocity"},
        .hooks = {.arrange = arrange_in_rings, .prepare = set_mass},
    };
    return flow;
}

} // namespace sphvv::verification::cases
