#include "sphvv/verification/surface_shapes.hpp"

#include <algorithm>
#include <cmath>

namespace sphvv::verification::surface_shapes {
namespace {

struct Geometry {
    static constexpr double outer = 10;

    template <int Dim>
    static double depth(const std::array<double, Dim>& x, double size) {
        double squared = 0;
        for (const double component : x) {
            squared += component * component;
        }
        const double r = std::sqrt(squared);
        return std::min(outer - r, r - size / 2);
    }
    template <int Dim>
    static ShapeWindow<Dim> window(double /*size*/) {
        ShapeWindow<Dim> window;
        window.low.fill(-outer);
        window.high.fill(outer);
        return window;
    }
};

} // namespace

const SurfaceShape& annulus() {
    static const SurfaceShape shape = with_geometry<Geometry>({
        .name = "annulus",
        .summary = "disc of 10 dx with a void in the middle",
        .formula = "min(10 - r, r - D/2)",
        .size = "D dx",
        .sizes_2d = {4},
    });
    return shape;
}

} // namespace sphvv::verification::surface_shapes
