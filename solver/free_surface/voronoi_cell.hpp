#pragma once

#include "sphvv/solver/operators/row.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace sphvv::solver {

/// A convex polygon that half-planes are cut off.
class ConvexPolygon {
public:
    /// The square of that half side about the origin.
    void start(double half_side) {
        corners_.assign({{-half_side, -half_side},
                         {half_side, -half_side},
                         {half_side, half_side},
                         {-half_side, half_side}});
    }

    /// Leaves the part with a . x <= c. Returns whether something was cut off.
    bool cut(double a0, double a1, double c) {
        const auto beyond = [&](const Point& x) { return a0 * x[0] + a1 * x[1] - c; };
        if (std::none_of(corners_.begin(), corners_.end(), [&](const Point& x) { return beyond(x) > 0; })) {
            return false;
        }
        kept_.clear();
        for (std::size_t k = 0; k < corners_.size(); ++k) {
            const Point& from = corners_[k];
            const Point& to = corners_[k + 1 == corners_.size() ? 0 : k + 1];
            const double at_from = beyond(from);
            const double at_to = beyond(to);
            if (at_from <= 0) {
                kept_.push_back(from);
            }
            if ((at_from <= 0) != (at_to <= 0)) {
                const double share = at_from / (at_from - at_to);
                kept_.push_back({from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])});
            }
        }
        corners_.swap(kept_);
        return true;
    }

    bool empty() const { return corners_.empty(); }

    /// Largest squared distance of a corner from the origin, 0 for the empty polygon.
    double farthest() const {
        double largest = 0;
        for (const Point& x : corners_) {
            largest = std::max(largest, x[0] * x[0] + x[1] * x[1]);
        }
        return largest;
    }

private:
    using Point = std::array<double, 2>;
    std::vector<Point> corners_;
    std::vector<Point> kept_;
};

/// Voronoi cells, one after the other; owns the scratch space.
template <int Dim>
class VoronoiCell {
public:
    /// Distance (m) from a particle to the farthest point of its Voronoi cell, the points nearer to it than
    /// to any neighbour, or `cap` if that is less. Reads the neighbours nearer than 2 cap, the only ones
    /// whose half-way plane comes nearer than cap. A neighbour at distance zero shares the cell.
    ///
    /// In the plane the cell is cut out of a square by the neighbours' half-way lines. In space its faces are
    /// taken one by one: the half-way plane of neighbour j, cut by those of the others. The farthest point is
    /// a corner, and a corner belongs to a face. (A cell that goes beyond the cap has boundary points on both
    /// sides of it, the nearest half-way point being one, so that some face crosses it.) Nearest neighbours
    /// come first: those farther than twice the farthest corner left cut nothing.
    double reach(const Row<Dim>& row, double cap) {
        gather_sites(row, 4 * cap * cap);
        const double squared_cap = cap * cap;
        double farthest = sites_.empty() ? squared_cap : 0;
        if constexpr (Dim == 2) {
            polygon_.start(cap);
            farthest = cut(sites_.size(), {0, 0}, {1, 0}, {0, 1});
        } else {
            for (std::size_t face = 0; face < sites_.size() && farthest < squared_cap; ++face) {
                farthest = std::max(farthest, farthest_of_face(face, cap));
            }
        }
        return std::sqrt(std::min(farthest, squared_cap));
    }

private:
    using Point = std::array<double, Dim>;

    struct Site {
        double squared_distance;
        Point r; // from the particle
    };

    static double dot(const Point& a, const Point& b) {
        double sum = 0;
        for (int d = 0; d < Dim; ++d) {
            sum += a[d] * b[d];
        }
        return sum;
    }

    /// In an order that depends on where the neighbours are, not on how they are numbered.
    void gather_sites(const Row<Dim>& row, double squared_radius) {
        sites_.clear();
        for (int k = 0; k < row.count; ++k) {
            Site site;
            for (int d = 0; d < Dim; ++d) {
                site.r[d] = -row.separation[d][k];
            }
            site.squared_distance = dot(site.r, site.r);
            if (site.squared_distance > 0 && site.squared_distance < squared_radius) {
                sites_.push_back(site);
            }
        }
        std::sort(sites_.begin(), sites_.end(), [](const Site& a, const Site& b) {
            return a.squared_distance != b.squared_distance ? a.squared_distance < b.squared_distance
                                                            : a.r < b.r;
        });
    }

    /// Cuts the polygon in the plane origin + x e0 + y e1 by the half-way planes of all sites but `own`.
    /// Returns the largest squared distance of what is left from the particle.
    double cut(std::size_t own, const Point& origin, const Point& e0, const Point& e1) {
        const double height = dot(origin, origin);
        double farthest = height + polygon_.farthest();
        for (std::size_t k = 0; k < sites_.size() && sites_[k].squared_distance < 4 * farthest; ++k) {
            const Point& r = sites_[k].r;
            if (k != own &&
                polygon_.cut(dot(e0, r), dot(e1, r), sites_[k].squared_distance / 2 - dot(origin, r))) {
                if (polygon_.empty()) {
                    return 0;
                }
                farthest = height + polygon_.farthest();
            }
        }
        return farthest;
    }

    double farthest_of_face(std::size_t face, double cap) {
        const Point& r = sites_[face].r;
        const double distance = std::sqrt(sites_[face].squared_distance);
        Point origin;
        Point normal;
        int smallest = 0;
        for (int d = 0; d < Dim; ++d) {
            origin[d] = r[d] / 2;
            normal[d] = r[d] / distance;
            smallest = std::abs(normal[d]) < std::abs(normal[smallest]) ? d : smallest;
        }
        Point e0{};
        e0[smallest] = 1;
        const double along = normal[smallest];
        const double length = std::sqrt(1 - along * along);
        for (int d = 0; d < Dim; ++d) {
            e0[d] = (e0[d] - along * normal[d]) / length;
        }
        const Point e1{normal[1] * e0[2] - normal[2] * e0[1], normal[2] * e0[0] - normal[0] * e0[2],
                       normal[0] * e0[1] - normal[1] * e0[0]};
        polygon_.start(cap);
        return cut(face, origin, e0, e1);
    }

    std::vector<Site> sites_;
    ConvexPolygon polygon_;
};

} // namespace sphvv::solver
