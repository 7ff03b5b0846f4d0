#include "sphvv/verification/surface_shapes.hpp"

#include <cmath>
#include <numbers>

namespace sphvv::verification::surface_shapes {
namespace {

struct Geometry {
    /// The fluid is at x < tip, the same along z. The tip is off the lattice's points of symmetry, so that
    /// none lies on a side.
    static constexpr double tip = 0.25;
    static constexpr double length = 16;

    template <int Dim>
    static double depth(const std::array<double, Dim>& x, double size) {
        const double half = size / 2 * std::numbers::pi / 180;
        const double from_tip = tip - x[0];
        const double y = std::abs(x[1]);
        if (from_tip * std::cos(half) + y * std::sin(half) < 0) {
            return -std::hypot(from_tip, y); // nearest to the tip, which happens outside only
        }
        return from_tip * std::sin(half) - y * std::cos(half);
    }
    template <int Dim>
    static ShapeWindow<Dim> window(double size) {
        const double half_width = length * std::tan(size / 2 * std::numbers::pi / 180);
        ShapeWindow<Dim> window;
        window.low.fill(-half_width);
        window.high.fill(half_width);
        window.low[0] = tip - length;
        window.high[0] = tip;
        return window;
    }
};

} // namespace

const SurfaceShape& wedge() {
    static const SurfaceShape shape = with_geometry<Geometry>({
        .name = "wedge",
        .summary = "tip of a wedge, 16 dx long",
        .formula = "(tip - x) sin(a/2) - |y| cos(a/2) inside",
        .size = "a degrees",
        .sizes_2d = {15, 30, 60, 90},
    });
    return shape;
}

} // namespace sphvv::verification::surface_shapes
