#include "sphvv/verification/surface_shapes.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace sphvv::verification::surface_shapes {
namespace {

struct Geometry {
    static constexpr int droplets = 60;
    static constexpr double side = 24;      // of the region they are spread over
    static constexpr double distance = 3.7; // of their middles: particles of different ones are 2.5 apart

    template <int Dim>
    static std::vector<std::array<double, Dim>> placed(double /*size*/, std::uint64_t seed) {
        std::mt19937_64 generator(seed);
        const auto uniform = [&] { return static_cast<double>(generator() >> 11U) * 0x1.0p-53; };
        std::vector<std::array<double, Dim>> middles;
        std::vector<std::array<double, Dim>> particles;
        for (int trial = 0; trial < droplets; ++trial) {
            std::array<double, Dim> middle;
            for (double& x : middle) {
                x = side * uniform();
            }
            const double angle = 2 * std::numbers::pi * uniform();
            const int members = 1 + trial % 3;
            bool free = true;
            for (const auto& other : middles) {
                double squared = 0;
                for (int d = 0; d < Dim; ++d) {
                    squared += (middle[d] - other[d]) * (middle[d] - other[d]);
                }
                free = free && squared > distance * distance;
            }
            if (!free) {
                continue;
            }
            middles.push_back(middle);
            // Alone, a pair, an equilateral triangle; one spacing between its particles.
            const double radius = members == 1 ? 0 : members == 2 ? 0.5 : 1 / std::sqrt(3.0);
            for (int m = 0; m < members; ++m) {
                std::array<double, Dim> at = middle;
                at[0] += radius * std::cos(angle + 2 * std::numbers::pi * m / members);
                at[1] += radius * std::sin(angle + 2 * std::numbers::pi * m / members);
                particles.push_back(at);
            }
        }
        return particles;
    }
};

} // namespace

const SurfaceShape& spray() {
    static const SurfaceShape shape = with_particles<Geometry>({
        .name = "spray",
        .summary = "droplets of one, two and three particles, at least 2.5 dx apart",
        .formula = "1/2 at every particle",
        .size = "",
        .sizes_2d = {0},
        .sizes_3d = {0},
    });
    return shape;
}

} // namespace sphvv::verification::surface_shapes
