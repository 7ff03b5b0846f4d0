#pragma once

#include "sphvv/solver/kernels.hpp"
#include "sphvv/solver/neighbours/cell_grid.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace sphvv::solver {

/// All pairs within the support, seen from both sides, with what every sweep of a step needs of them: the
/// neighbour's index, r_ij = r_i - r_j and F_ij = W'(r)/r (so that the gradient of W_ij is F_ij r_ij).
///
/// Rows are kept in blocks of consecutive particles. A row is padded to whole lanes by entries that name the
/// particle itself with r_ij = 0 and F_ij = 0, which add nothing to any sum. The block is also the unit of
/// parallel work and of deterministic reductions.
template <int Dim>
class NeighbourList {
public:
    static constexpr int block_size = 256;

    struct Row {
        int count;  ///< pairs
        int padded; ///< entries, a multiple of lane_count
        const int* index;
        const double* slope;                       ///< F_ij
        std::array<const double*, Dim> separation; ///< r_ij
    };

    /// Finds all pairs closer than (1 + skin) times the support radius; positions must be finite and inside
    /// the box. The first `count` of `with_images` positions are the particles, which have rows; the others
    /// only occur as neighbours.
    void build(const Box<Dim>& box, const Kernel& kernel, double h, double skin,
               std::array<const double*, Dim> position, int count, int with_images);
    void build(const Box<Dim>& box, const Kernel& kernel, double h, double skin,
               std::array<const double*, Dim> position, int count) {
        build(box, kernel, h, skin, position, count, count);
    }

    /// Follows particles that moved since the list was built: r_ij += d_i - d_j, F_ij anew. Returns false,
    /// and leaves the list as it was, if some moved so far that pairs may be missing (2 max|d| > skin) or by
    /// NaN.
    bool follow(std::array<const double*, Dim> displacement);

    Row row(int i) const {
        const Block& block = blocks_[i / block_size];
        const int k = i % block_size;
        Row row{block.count[k],
                block.start[k + 1] - block.start[k],
                block.index.data() + block.start[k],
                block.slope.data() + block.start[k],
                {}};
        for (int d = 0; d < Dim; ++d) {
            row.separation[d] = block.separation[d].data() + block.start[k];
        }
        return row;
    }

    int size() const { return count_; }
    int block_count() const { return (count_ + block_size - 1) / block_size; }
    /// Position of particle i's row within arrays that hold one number per entry (see entries()).
    std::size_t row_start(int i) const {
        return block_start_[i / block_size] + blocks_[i / block_size].start[i % block_size];
    }
    /// Entries of all rows, padding included.
    std::size_t entries() const { return block_start_.back(); }
    /// Ordered pairs (i, j): the pair evaluations of one sweep.
    std::int64_t pairs() const { return pairs_; }
    double support_radius() const { return support_radius_; }
    /// Smallest distance of a pair (m), infinite if there is none, and one of its particles (-1 if none).
    double minimum_distance() const { return minimum_distance_; }
    int closest_particle() const { return closest_particle_; }
    const CellGrid<Dim>& grid() const { return grid_; }
    std::size_t bytes() const;

private:
    struct Block {
        std::array<int, block_size + 1> start{};
        std::array<int, block_size> count{};
        std::vector<int> index;
        std::vector<double> slope;
        std::array<std::vector<double>, Dim> separation;
        std::vector<double> squared_distance;
        double minimum_squared = 0;
        int closest = -1;
    };

    void fill(Block& block, int begin, int end, double radius);
    void evaluate(Block& block, int begin, int end);
    void summarise();

    CellGrid<Dim> grid_;
    std::array<std::vector<double>, Dim> binned_; // positions in the grid's order
    std::array<const double*, Dim> position_{};
    std::vector<Block> blocks_;
    std::vector<std::size_t> block_start_;
    const Kernel* kernel_ = nullptr;
    double h_ = 0;
    double skin_width_ = 0;
    double support_radius_ = 0;
    int count_ = 0;
    int with_images_ = 0;
    std::int64_t pairs_ = 0;
    double minimum_distance_ = 0;
    int closest_particle_ = -1;
};

} // namespace sphvv::solver
