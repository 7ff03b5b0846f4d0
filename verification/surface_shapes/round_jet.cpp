#include "sphvv/verification/surface_shapes.hpp"

#include <cmath>

namespace sphvv::verification::surface_shapes {
namespace {

struct Geometry {
    /// The axis is that of a row of cells (odd widths) or an edge between four of them.
    template <int Dim>
    static double depth(const std::array<double, Dim>& x, double size) {
        double squared = 0;
        for (int d = 1; d < Dim; ++d) {
            squared += (x[d] - size / 2) * (x[d] - size / 2);
        }
        return size / 2 - std::sqrt(squared);
    }
    template <int Dim>
    static ShapeWindow<Dim> window(double size) {
        ShapeWindow<Dim> window;
        window.low.fill(0);
        window.high.fill(size);
        window.low[0] = -10;
        window.high[0] = 10;
        return window;
    }
};

} // namespace

const SurfaceShape& round_jet() {
    static const SurfaceShape shape = with_geometry<Geometry>({
        .name = "round_jet",
        .summary = "thin round jet",
        .formula = "D/2 - distance from the axis",
        .size = "D dx",
        .sizes_3d = {1, 2, 4},
    });
    return shape;
}

} // namespace sphvv::verification::surface_shapes
