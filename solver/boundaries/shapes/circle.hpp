#pragma once

#include "sphvv/solver/boundaries/wall.hpp"

#include <utility>

namespace sphvv::solver::shapes {

/// Side of a circle on which the fluid is.
enum class Side { inside, outside };

/// The circle of radius R (m) about `centre` (m), turning with `rate` (rad/s, counter-clockwise); distance =
/// R - r with the fluid inside, r - R outside.
inline Wall<2> circle(std::string name, const Vector<2>& centre, double radius, Side side, Slip slip,
                      double rate = 0) {
    const double sign = side == Side::outside ? 1 : -1;
    return {.name = std::move(name),
            .slip = slip,
            .distance = [=](const Vector<2>& x) { return sign * ((x - centre).norm() - radius); },
            .normal = [=](const Vector<2>& x) { return Vector<2>(sign * (x - centre).normalized()); },
            .velocity =
                [=](const Vector<2>& x, double /*t*/) {
                    const Vector<2> r = x - centre;
                    return Vector<2>(-rate * r[1], rate * r[0]);
                }};
}

} // namespace sphvv::solver::shapes
