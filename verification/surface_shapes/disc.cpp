#include "sphvv/verification/surface_shapes.hpp"

#include <cmath>

namespace sphvv::verification::surface_shapes {
namespace {

struct Geometry {
    template <int Dim>
    static double depth(const std::array<double, Dim>& x, double size) {
        double squared = 0;
        for (const double component : x) {
            squared += component * component;
        }
        return size - std::sqrt(squared);
    }
    template <int Dim>
    static ShapeWindow<Dim> window(double size) {
        ShapeWindow<Dim> window;
        window.low.fill(-size);
        window.high.fill(size);
        return window;
    }
};

} // namespace

const SurfaceShape& disc() {
    static const SurfaceShape shape = with_geometry<Geometry>({
        .name = "disc",
        .summary = "disc; in space a ball",
        .formula = "R - r",
        .size = "R dx",
        .sizes_2d = {12},
        .sizes_3d = {6},
    });
    return shape;
}

} // namespace sphvv::verification::surface_shapes
