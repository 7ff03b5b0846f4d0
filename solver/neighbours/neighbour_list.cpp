#include "sphvv/solver/neighbours/neighbour_list.hpp"

#include "sphvv/solver/lanes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sphvv::solver {
namespace {
// Squared distance of a padding entry: beyond every support, and small enough for its square to be finite.
constexpr double far_away = 1e100;
} // namespace

template <int Dim>
void NeighbourList<Dim>::build(const Box<Dim>& box, const Kernel& kernel, double h, double skin,
                               std::array<const double*, Dim> position, int count, int with_images) {
    kernel_ = &kernel;
    h_ = h;
    count_ = count;
    with_images_ = with_images;
    position_ = position;
    support_radius_ = kernel.support * h;
    skin_width_ = skin * support_radius_;
    const double radius = support_radius_ + skin_width_;
    grid_.bin(box, radius, position, with_images);
    const auto order = grid_.order();
    for (int d = 0; d < Dim; ++d) {
        binned_[d].resize(with_images);
#pragma omp parallel for schedule(static)
        for (int k = 0; k < with_images; ++k) {
            binned_[d][k] = position[d][order[k]];
        }
    }
    const int blocks = block_count();
    blocks_.resize(blocks);
#pragma omp parallel for schedule(dynamic, 1)
    for (int b = 0; b < blocks; ++b) {
        const int begin = b * block_size;
        const int end = std::min(begin + block_size, count);
        fill(blocks_[b], begin, end, radius);
        evaluate(blocks_[b], begin, end);
    }
    summarise();
}

template <int Dim>
void NeighbourList<Dim>::fill(Block& block, int begin, int end, double radius) {
    const double squared_radius = radius * radius;
    std::vector<typename CellGrid<Dim>::Stretch> stretches;
    std::vector<double> squared;
    std::vector<int> accepted;
    int cell = -1;
    int at = 0;
    const auto order = grid_.order();
    for (int i = begin; i < end; ++i) {
        if (grid_.cell_of(i) != cell) {
            cell = grid_.cell_of(i);
            grid_.stretches_around(cell, stretches);
        }
        int candidates = 0;
        int longest = 0;
        for (const auto& stretch : stretches) {
            candidates += stretch.end - stretch.begin;
            longest = std::max(longest, stretch.end - stretch.begin);
        }
        const std::size_t needed = at + candidates + lane_count;
        if (block.index.size() < needed) {
            const std::size_t grown = needed + needed / 2;
            block.index.resize(grown);
            block.slope.resize(grown);
            block.squared_distance.resize(grown);
            for (auto& component : block.separation) {
                component.resize(grown);
            }
        }
        squared.resize(longest);
        accepted.resize(longest + 1);
        block.start[i - begin] = at;
        std::array<double, Dim> xi;
        for (int d = 0; d < Dim; ++d) {
            xi[d] = position_[d][i];
        }
        for (const auto& stretch : stretches) {
            const int length = stretch.end - stretch.begin;
            // (r_i - r_j) - shift is exactly antisymmetric in i and j, so both sides agree on every pair.
            const auto separation = [&](int d, int k) {
                return (xi[d] - binned_[d][stretch.begin + k]) - stretch.shift[d];
            };
#pragma omp simd
            for (int k = 0; k < length; ++k) {
                double r2 = 0;
                for (int d = 0; d < Dim; ++d) {
                    const double component = separation(d, k);
                    r2 += component * component;
                }
                squared[k] = r2;
            }
            int kept = 0;
            for (int k = 0; k < length; ++k) {
                accepted[kept] = k;
                kept += squared[k] < squared_radius ? 1 : 0;
            }
            for (int a = 0; a < kept; ++a) {
                const int k = accepted[a];
                block.index[at + a] = order[stretch.begin + k];
                block.squared_distance[at + a] = squared[k];
                for (int d = 0; d < Dim; ++d) {
                    block.separation[d][at + a] = separation(d, k);
                }
            }
            at += kept;
        }
        // The particle itself was accepted at distance zero; it is no pair. (Its periodic images would be.)
        for (int k = block.start[i - begin]; k < at; ++k) {
            if (block.index[k] == i && block.squared_distance[k] == 0) {
                --at;
                block.index[k] = block.index[at];
                block.squared_distance[k] = block.squared_distance[at];
                for (int d = 0; d < Dim; ++d) {
                    block.separation[d][k] = block.separation[d][at];
                }
                break;
            }
        }
        block.count[i - begin] = at - block.start[i - begin];
        for (; at % lane_count != 0; ++at) {
            block.index[at] = i;
            block.squared_distance[at] = far_away;
            for (int d = 0; d < Dim; ++d) {
                block.separation[d][at] = 0;
            }
        }
    }
    std::fill(block.start.begin() + (end - begin), block.start.end(), at);
}

template <int Dim>
void NeighbourList<Dim>::evaluate(Block& block, int begin, int end) {
    const int entries = block.start[end - begin];
    kernel_->slopes({block.squared_distance.data(), static_cast<std::size_t>(entries)}, h_,
                    kernel_->slope_scale(Dim, h_), block.slope.data());
    Lanes smallest = far_away;
    for (int k = 0; k < entries; k += lane_count) {
        const Lanes r2 = load(&block.squared_distance[k]);
        smallest = select(r2 < smallest, r2, smallest);
    }
    block.minimum_squared = far_away;
    for (int l = 0; l < lane_count; ++l) {
        block.minimum_squared = std::min(block.minimum_squared, smallest[l]);
    }
    block.closest = -1;
    for (int i = begin; i < end && block.minimum_squared < far_away && block.closest < 0; ++i) {
        const double* row = &block.squared_distance[block.start[i - begin]];
        if (std::find(row, row + block.count[i - begin], block.minimum_squared) !=
            row + block.count[i - begin]) {
            block.closest = i;
        }
    }
}

template <int Dim>
void NeighbourList<Dim>::summarise() {
    pairs_ = 0;
    double smallest = std::numeric_limits<double>::infinity();
    closest_particle_ = -1;
    block_start_.assign(blocks_.size() + 1, 0);
    for (int b = 0; b < block_count(); ++b) {
        const Block& block = blocks_[b];
        const int rows = std::min(block_size, count_ - b * block_size);
        for (int k = 0; k < rows; ++k) {
            pairs_ += block.count[k];
        }
        block_start_[b + 1] = block_start_[b] + block.start[rows];
        if (block.closest >= 0 && block.minimum_squared < smallest) {
            smallest = block.minimum_squared;
            closest_particle_ = block.closest;
        }
    }
    minimum_distance_ = std::sqrt(smallest);
}

template <int Dim>
bool NeighbourList<Dim>::follow(std::array<const double*, Dim> displacement) {
    double farthest = 0;
    bool sound = true;
#pragma omp parallel for schedule(static) reduction(max : farthest) reduction(&& : sound)
    for (int i = 0; i < with_images_; ++i) {
        double squared = 0;
        for (int d = 0; d < Dim; ++d) {
            squared += displacement[d][i] * displacement[d][i];
        }
        farthest = std::max(farthest, squared);
        sound = sound && !std::isnan(squared);
    }
    if (!sound || 2 * std::sqrt(farthest) > skin_width_) {
        return false;
    }
#pragma omp parallel for schedule(dynamic, 1)
    for (int b = 0; b < block_count(); ++b) {
        Block& block = blocks_[b];
        const int begin = b * block_size;
        const int end = std::min(begin + block_size, count_);
        for (int i = begin; i < end; ++i) {
            const int last = block.start[i - begin + 1];
            for (int k = block.start[i - begin]; k < last; k += lane_count) {
                Lanes r2{};
                for (int d = 0; d < Dim; ++d) {
                    const Lanes moved = load(&block.separation[d][k]) +
                                        (displacement[d][i] - gather(displacement[d], &block.index[k]));
                    store(&block.separation[d][k], moved);
                    r2 += moved * moved;
                }
                store(&block.squared_distance[k], r2);
            }
            const int padding = block.start[i - begin] + block.count[i - begin];
            std::fill(&block.squared_distance[padding], &block.squared_distance[0] + last, far_away);
        }
        evaluate(block, begin, end);
    }
    summarise();
    return true;
}

template <int Dim>
std::size_t NeighbourList<Dim>::bytes() const {
    std::size_t total = 0;
    for (const Block& block : blocks_) {
        total += sizeof(Block) + block.index.capacity() * sizeof(int) +
                 (block.slope.capacity() + block.squared_distance.capacity()) * sizeof(double);
        for (const auto& component : block.separation) {
            total += component.capacity() * sizeof(double);
        }
    }
    return total;
}

template class NeighbourList<2>;
template class NeighbourList<3>;

} // namespace sphvv::solver
