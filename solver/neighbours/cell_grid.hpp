#pragma once

#include "sphvv/solver/box.hpp"

#include <array>
#include <span>
#include <vector>

namespace sphvv::solver {

/// Particles binned into a grid of cells whose edge is at least the search radius, so that all neighbours of
/// a particle lie in its own and the adjacent cells.
template <int Dim>
class CellGrid {
public:
    /// Stretch of consecutive entries of order() that a particle of some cell has to look at; `shift` is to
    /// be subtracted from r_i - r_j to get the separation from the periodic image (0 or ± the box length).
    struct Stretch {
        int begin;
        int end;
        std::array<double, Dim> shift;
    };

    /// Bins positions. They must be finite and inside the box. Cells are numbered with direction 0 fastest;
    /// within a cell the particles keep their order. Throws UserError if a periodic direction is shorter than
    /// the radius: a pair could then meet through images two lengths apart, which are not looked for.
    void bin(const Box<Dim>& box, double radius, std::array<const double*, Dim> position, int count);

    int cell_count() const { return static_cast<int>(start_.size()) - 1; }
    std::array<int, Dim> cells() const { return cells_; }
    int cell_of(int particle) const { return cell_of_[particle]; }
    /// The cell of a point of the box; of one outside, the nearest.
    int cell_at(const std::array<double, Dim>& x) const;
    /// Particles cell by cell.
    std::span<const int> order() const { return order_; }
    /// The stretches that hold every neighbour of a particle in `cell`; appended to an emptied `stretches`.
    void stretches_around(int cell, std::vector<Stretch>& stretches) const;

private:
    Box<Dim> box_{};
    std::array<int, Dim> cells_{};
    std::vector<int> cell_of_;
    std::vector<int> start_;
    std::vector<int> order_;
};

} // namespace sphvv::solver
