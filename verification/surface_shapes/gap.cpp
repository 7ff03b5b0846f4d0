#include "sphvv/verification/surface_shapes.hpp"

#include <algorithm>

namespace sphvv::verification::surface_shapes {
namespace {

struct Geometry {
    template <int Dim>
    static double depth(const std::array<double, Dim>& x, double size) {
        return std::max(-x[Dim - 1], x[Dim - 1] - size);
    }
    /// The arrangement is cut, and its upper half lifted.
    template <int Dim>
    static std::array<double, Dim> moved(const std::array<double, Dim>& x, double size) {
        std::array<double, Dim> at = x;
        at[Dim - 1] += x[Dim - 1] > 0 ? size : 0;
        return at;
    }
    template <int Dim>
    static ShapeWindow<Dim> window(double size) {
        ShapeWindow<Dim> window;
        window.low.fill(-12);
        window.high.fill(12);
        window.low[Dim - 1] = -5;
        window.high[Dim - 1] = size + 5;
        return window;
    }
};

} // namespace

const SurfaceShape& gap() {
    static const SurfaceShape shape = with_geometry<Geometry>({
        .name = "gap",
        .summary = "two flat surfaces that face each other; the particles nearest to the gap are g + 1 "
                   "spacings apart",
        .formula = "max(-y, y - g)",
        .size = "g dx",
        .sizes_2d = {1, 1.5, 2, 3},
    });
    return shape;
}

} // namespace sphvv::verification::surface_shapes
