#pragma once

#include <array>

namespace sphvv::solver {

/// Axis-aligned region of space (m), each direction periodic or open.
template <int Dim>
struct Box {
    std::array<double, Dim> low{};
    std::array<double, Dim> high{};
    std::array<bool, Dim> periodic{};

    double length(int d) const { return high[d] - low[d]; }

    double volume() const {
        double product = 1;
        for (int d = 0; d < Dim; ++d) {
            product *= length(d);
        }
        return product;
    }
};

} // namespace sphvv::solver
