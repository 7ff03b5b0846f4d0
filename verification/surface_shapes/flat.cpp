#include "sphvv/verification/surface_shapes.hpp"

#include <array>

namespace sphvv::verification::surface_shapes {
namespace {

struct Geometry {
    template <int Dim>
    static double depth(const std::array<double, Dim>& x, double /*size*/) {
        return -x[Dim - 1];
    }
    template <int Dim>
    static ShapeWindow<Dim> window(double /*size*/) {
        ShapeWindow<Dim> window;
        window.low.fill(Dim == 2 ? -12 : -4);
        window.high.fill(Dim == 2 ? 12 : 4);
        window.low[Dim - 1] = Dim == 2 ? -8 : -5;
        window.high[Dim - 1] = 1;
        return window;
    }
};

} // namespace

const SurfaceShape& flat() {
    static const SurfaceShape shape = with_geometry<Geometry>({
        .name = "flat",
        .summary = "half-space under a flat surface",
        .formula = "-y",
        .size = "",
        .sizes_2d = {0},
        .sizes_3d = {0},
    });
    return shape;
}

} // namespace sphvv::verification::surface_shapes
