#pragma once

#include "sphvv/solver/boundaries/wall.hpp"

#include <string>

namespace sphvv::solver::shapes {

/// The plane (line in 2-D) through `point` (m) with the unit vector `normal` into the fluid; distance =
/// normal . (x - point). `speed` is of its material, m/s.
template <int Dim>
Wall<Dim> plane(const std::string& name, const Vector<Dim>& point, const Vector<Dim>& normal, Slip slip,
                const Vector<Dim>& speed = Vector<Dim>::Zero()) {
    return {.name = name,
            .slip = slip,
            .distance = [point, normal](const Vector<Dim>& x) { return normal.dot(x - point); },
            .normal = [normal](const Vector<Dim>& /*x*/) { return normal; },
            .velocity = [speed](const Vector<Dim>& /*x*/, double /*t*/) { return speed; }};
}

} // namespace sphvv::solver::shapes
