#include "sphvv/verification/surface_shapes.hpp"

#include <algorithm>

namespace sphvv::verification::surface_shapes {
namespace {

struct Geometry {
    template <int Dim>
    static double depth(const std::array<double, Dim>& x, double size) {
        return std::min(x[Dim - 1], size - x[Dim - 1]);
    }
    template <int Dim>
    static ShapeWindow<Dim> window(double size) {
        ShapeWindow<Dim> window;
        window.low.fill(Dim == 2 ? -16 : -5);
        window.high.fill(Dim == 2 ? 16 : 5);
        window.low[Dim - 1] = 0;
        window.high[Dim - 1] = size;
        return window;
    }
};

} // namespace

const SurfaceShape& sheet() {
    static const SurfaceShape shape = with_geometry<Geometry>({
        .name = "sheet",
        .summary = "thin plane jet; in space a sheet",
        .formula = "min(y, w - y)",
        .size = "w dx",
        .sizes_2d = {1, 2, 3, 4},
        .sizes_3d = {1, 2},
    });
    return shape;
}

} // namespace sphvv::verification::surface_shapes
