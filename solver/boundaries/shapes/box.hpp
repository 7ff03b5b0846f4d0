#pragma once

#include "sphvv/solver/boundaries/wall.hpp"
#include "sphvv/solver/box.hpp"

#include <utility>

namespace sphvv::solver::shapes {

/// The box (rectangle in 2-D) with the fluid outside of it. With q = |x - centre| - half of its sides:
/// distance = |max(q, 0)| + min(max q_d, 0); the normal is that of the nearest face, in a tie of the first.
template <int Dim>
Wall<Dim> box(std::string name, const Box<Dim>& sides, Slip slip) {
    Vector<Dim> centre;
    Vector<Dim> half;
    for (int d = 0; d < Dim; ++d) {
        centre[d] = (sides.low[d] + sides.high[d]) / 2;
        half[d] = (sides.high[d] - sides.low[d]) / 2;
    }
    return {.name = std::move(name),
            .slip = slip,
            .distance =
                [centre, half](const Vector<Dim>& x) {
                    const Vector<Dim> q = (x - centre).cwiseAbs() - half;
                    return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.);
                },
            .normal =
                [centre, half](const Vector<Dim>& x) {
                    const Vector<Dim> r = x - centre;
                    const Vector<Dim> q = r.cwiseAbs() - half;
                    int nearest = 0;
                    q.maxCoeff(&nearest);
                    // A point on a corner, but for round-off, is inside.
                    const bool inside = q[nearest] <= 1e-12 * half.maxCoeff();
                    const Vector<Dim> away = inside ? Vector<Dim>(Vector<Dim>::Unit(nearest))
                                                    : Vector<Dim>(q.cwiseMax(0).normalized());
                    return Vector<Dim>(r.array().sign() * away.array());
                },
            .velocity = at_rest<Dim>};
}

} // namespace sphvv::solver::shapes
