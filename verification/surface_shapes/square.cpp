#include "sphvv/verification/surface_shapes.hpp"

#include <algorithm>
#include <cmath>

namespace sphvv::verification::surface_shapes {
namespace {

struct Geometry {
    template <int Dim>
    static double depth(const std::array<double, Dim>& x, double size) {
        double inside = size;
        double outside_squared = 0;
        for (const double component : x) {
            const double from_side = size / 2 - std::abs(component);
            inside = std::min(inside, from_side);
            outside_squared += from_side < 0 ? from_side * from_side : 0;
        }
        return inside >= 0 ? inside : -std::sqrt(outside_squared);
    }
    template <int Dim>
    static ShapeWindow<Dim> window(double size) {
        ShapeWindow<Dim> window;
        window.low.fill(-size / 2);
        window.high.fill(size / 2);
        return window;
    }
};

} // namespace

const SurfaceShape& square() {
    static const SurfaceShape shape = with_geometry<Geometry>({
        .name = "square",
        .summary = "square, in space a cube: corners and edges",
        .formula = "min_d (a/2 - |x_d|) inside",
        .size = "a dx",
        .sizes_2d = {20},
        .sizes_3d = {10},
    });
    return shape;
}

} // namespace sphvv::verification::surface_shapes
