#include "sphvv/solver/neighbours/cell_grid.hpp"

#include "sphvv/solver/settings.hpp"

#include <algorithm>
#include <cmath>

namespace sphvv::solver {

template <int Dim>
void CellGrid<Dim>::bin(const Box<Dim>& box, double radius, std::array<const double*, Dim> position,
                        int count) {
    box_ = box;
    int total = 1;
    for (int d = 0; d < Dim; ++d) {
        if (box.periodic[d] && box.length(d) < radius * (1 - 1e-12)) {
            throw UserError("the periodic box is " + shortest(box.length(d)) +
                            " m wide, narrower than the neighbour search of " + shortest(radius) +
                            " m; use more particles to a side or a smaller h_over_dx");
        }
        // The cap keeps the grid no larger than the particles need when the box is huge beside the radius.
        const double fitting = std::floor(box.length(d) / radius);
        cells_[d] = static_cast<int>(
            std::clamp(fitting, 1.0, std::max(1.0, std::ceil(4 * std::pow(count, 1.0 / Dim)))));
        total *= cells_[d];
    }
    cell_of_.resize(count);
    std::array<double, Dim> per_length;
    for (int d = 0; d < Dim; ++d) {
        per_length[d] = cells_[d] / box.length(d);
    }
#pragma omp parallel for schedule(static)
    for (int i = 0; i < count; ++i) {
        int cell = 0;
        for (int d = Dim - 1; d >= 0; --d) {
            const int along = static_cast<int>((position[d][i] - box.low[d]) * per_length[d]);
            cell = cell * cells_[d] + std::min(along, cells_[d] - 1);
        }
        cell_of_[i] = cell;
    }
    start_.assign(total + 1, 0);
    for (int i = 0; i < count; ++i) {
        ++start_[cell_of_[i] + 1];
    }
    for (int c = 0; c < total; ++c) {
        start_[c + 1] += start_[c];
    }
    order_.resize(count);
    std::vector<int> next(start_.begin(), start_.end() - 1);
    for (int i = 0; i < count; ++i) {
        order_[next[cell_of_[i]]++] = i;
    }
}

template <int Dim>
int CellGrid<Dim>::cell_at(const std::array<double, Dim>& x) const {
    int cell = 0;
    for (int d = Dim - 1; d >= 0; --d) {
        const double along = std::floor((x[d] - box_.low[d]) * (cells_[d] / box_.length(d)));
        cell = cell * cells_[d] + static_cast<int>(std::clamp(along, 0., cells_[d] - 1.));
    }
    return cell;
}

template <int Dim>
void CellGrid<Dim>::stretches_around(int cell, std::vector<Stretch>& stretches) const {
    stretches.clear();
    std::array<int, Dim> at;
    for (int d = 0, rest = cell; d < Dim; ++d) {
        at[d] = rest % cells_[d];
        rest /= cells_[d];
    }
    // One row of three cells along direction 0 for every combination of offsets in the other directions.
    constexpr int rows = Dim == 2 ? 3 : 9;
    for (int row = 0; row < rows; ++row) {
        Stretch stretch{};
        int base = 0;
        bool inside = true;
        for (int d = Dim - 1; d >= 1; --d) {
            int along = at[d] + (d == 1 ? row % 3 : row / 3) - 1;
            if (along < 0 || along >= cells_[d]) {
                inside = inside && box_.periodic[d];
                // r_i - r_j points across the border: an image of j beyond the low side lies one length
                // lower.
                stretch.shift[d] = along < 0 ? -box_.length(d) : box_.length(d);
                along += along < 0 ? cells_[d] : -cells_[d];
            }
            base = (base + along) * cells_[d - 1];
        }
        if (!inside) {
            continue;
        }
        const int first = std::max(at[0] - 1, 0);
        const int last = std::min(at[0] + 1, cells_[0] - 1);
        const auto add = [&](int from, int to, double shift) {
            stretch.shift[0] = shift;
            stretch.begin = start_[base + from];
            stretch.end = start_[base + to + 1];
            if (stretch.begin < stretch.end) {
                stretches.push_back(stretch);
            }
        };
        if (at[0] == 0 && box_.periodic[0]) {
            add(cells_[0] - 1, cells_[0] - 1, -box_.length(0));
        }
        add(first, last, 0);
        if (at[0] == cells_[0] - 1 && box_.periodic[0]) {
            add(0, 0, box_.length(0));
        }
    }
}

template class CellGrid<2>;
template class CellGrid<3>;

} // namespace sphvv::solver
