#pragma once

#include "sphvv/solver/boundaries/wall.hpp"

#include <utility>

namespace sphvv::solver::shapes {

/// The normal of any signed distance, grad distance by central differences over 2 `step` (m), of length 1.
/// With a step of 1e-6 of the size of the shape, truncation and rounding leave about 1e-10.
template <int Dim>
std::function<Vector<Dim>(const Vector<Dim>&)> gradient_of(std::function<double(const Vector<Dim>&)> distance,
                                                           double step) {
    return [distance = std::move(distance), step](const Vector<Dim>& x) {
        Vector<Dim> gradient;
        for (int d = 0; d < Dim; ++d) {
            const Vector<Dim> shift = step * Vector<Dim>::Unit(d);
            gradient[d] = distance(x + shift) - distance(x - shift);
        }
        return Vector<Dim>(gradient.normalized());
    };
}

} // namespace sphvv::solver::shapes
