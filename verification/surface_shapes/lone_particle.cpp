#include "sphvv/verification/surface_shapes.hpp"

#include <array>

namespace sphvv::verification::surface_shapes {
namespace {

struct Geometry {
    template <int Dim>
    static std::vector<std::array<double, Dim>> placed(double /*size*/, std::uint64_t /*seed*/) {
        return {std::array<double, Dim>{}};
    }
};

} // namespace

const SurfaceShape& lone_particle() {
    static const SurfaceShape shape = with_particles<Geometry>({
        .name = "lone_particle",
        .summary = "one particle",
        .formula = "1/2 at it",
        .size = "",
        .sizes_2d = {0},
        .sizes_3d = {0},
    });
    return shape;
}

} // namespace sphvv::verification::surface_shapes
