#pragma once

#include "sphvv/solver/operators/row.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <vector>

namespace sphvv::solver {

/// A convex polygon around the origin that half-planes are cut off.
class ConvexPolygon {
public:
    using Point = std::array<double, 2>;

    /// The square of that half side about the origin.
    void start(double half_side) {
        const double a = half_side;
        corners_.assign({{-a, -a}, {a, -a}, {a, a}, {-a, a}});
    }

    /// Leaves the part with a . x <= c. Returns whether something was cut off.
    bool cut(const Point& a, double c) {
        const auto beyond = [&](const Point& x) { return a[0] * x[0] + a[1] * x[1] - c; };
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

    /// Largest squared distance of a corner from the origin.
    double farthest() const {
        double largest = 0;
        for (const Point& x : corners_) {
            largest = std::max(largest, x[0] * x[0] + x[1] * x[1]);
        }
        return largest;
    }

private:
    std::vector<Point> corners_;
    std::vector<Point> kept_;
};

/// A convex polyhedron around the origin that half-spaces are cut off, as a set of edges that know the two
/// faces which they part. A plane that goes through a face crosses two of its edges, and the line between
/// those points is an edge of what is left: neither corners nor faces need be put in order. Where a plane
/// goes through a corner an edge of length zero may come out, which does no harm.
class ConvexPolyhedron {
public:
    using Point = std::array<double, 3>;

    /// The cube of that half side about the origin.
    void start(double half_side) {
        const double a = half_side;
        edges_.clear();
        for (int d = 0; d < 3; ++d) { // the edges along direction d; face 2 d + (0, 1) is at x_d = -a, a
            const int e = (d + 1) % 3;
            const int f = (d + 2) % 3;
            for (const int at_e : {0, 1}) {
                for (const int at_f : {0, 1}) {
                    Edge edge;
                    edge.p[d] = -a;
                    edge.q[d] = a;
                    edge.p[e] = edge.q[e] = at_e == 1 ? a : -a;
                    edge.p[f] = edge.q[f] = at_f == 1 ? a : -a;
                    edge.left = 2 * e + at_e;
                    edge.right = 2 * f + at_f;
                    edges_.push_back(edge);
                }
            }
        }
        crossings_.assign(6, {});
    }

    /// Leaves the part with a . x <= c. Returns whether something was cut off.
    bool cut(const Point& a, double c) {
        const auto beyond = [&](const Point& x) { return a[0] * x[0] + a[1] * x[1] + a[2] * x[2] - c; };
        if (std::none_of(edges_.begin(), edges_.end(),
                         [&](const Edge& edge) { return beyond(edge.p) > 0 || beyond(edge.q) > 0; })) {
            return false;
        }
        const int face = static_cast<int>(crossings_.size());
        crossings_.push_back({});
        kept_.clear();
        for (Edge edge : edges_) {
            const double at_p = beyond(edge.p);
            const double at_q = beyond(edge.q);
            if (at_p > 0 && at_q > 0) {
                continue;
            }
            const bool crossed = at_p > 0 || at_q > 0;
            if (crossed) {
                const double share = at_p / (at_p - at_q);
                Point at;
                for (int d = 0; d < 3; ++d) {
                    at[d] = edge.p[d] + share * (edge.q[d] - edge.p[d]);
                }
                (at_p > 0 ? edge.p : edge.q) = at;
                cross(edge.left, at, face);
                cross(edge.right, at, face);
            }
            kept_.push_back(edge);
        }
        edges_.swap(kept_);
        return true;
    }

    /// Largest squared distance of a corner from the origin.
    double farthest() const {
        const auto squared = [](const Point& x) { return x[0] * x[0] + x[1] * x[1] + x[2] * x[2]; };
        double largest = 0;
        for (const Edge& edge : edges_) {
            largest = std::max({largest, squared(edge.p), squared(edge.q)});
        }
        return largest;
    }

private:
    struct Edge {
        Point p, q;
        int left, right; ///< faces
    };
    /// Where the plane of the last cut first met a face.
    struct Crossing {
        int by = -1;
        Point at{};
    };

    void cross(int old_face, const Point& at, int new_face) {
        Crossing& first = crossings_[old_face];
        if (first.by == new_face) {
            kept_.push_back({first.at, at, old_face, new_face});
        } else {
            first = {new_face, at};
        }
    }

    std::vector<Edge> edges_;
    std::vector<Edge> kept_;
    std::vector<Crossing> crossings_; // by face
};

/// Voronoi cells, one after the other; owns the scratch space.
template <int Dim>
class VoronoiCell {
public:
    /// Distance (m) from a particle to the farthest point of its Voronoi cell, the points nearer to it than
    /// to any neighbour, or `cap` if that is less. Reads the neighbours nearer than 2 cap, the only ones
    /// whose half-way plane comes nearer than cap. A neighbour at distance zero shares the cell.
    ///
    /// The cell is cut out of a square (cube) by the half-way planes, the nearest first: a neighbour farther
    /// than twice the farthest corner left cuts nothing, nor do those after it.
    double reach(const Row<Dim>& row, double cap) {
        gather_sites(row, 4 * cap * cap);
        cell_.start(cap);
        double farthest = cell_.farthest();
        // A heap, as most of the sites are never asked for inside the fluid.
        for (auto end = sites_.end(); end != sites_.begin(); --end) {
            std::pop_heap(sites_.begin(), end, farther);
            const Site& nearest = *(end - 1);
            if (nearest.squared_distance >= 4 * farthest) {
                break;
            }
            if (cell_.cut(nearest.r, nearest.squared_distance / 2)) {
                farthest = cell_.farthest();
            }
        }
        return std::min(std::sqrt(farthest), cap);
    }

private:
    using Point = std::array<double, Dim>;

    struct Site {
        double squared_distance;
        Point r; // from the particle
    };

    /// An order that depends on where the neighbours are, not on how they are numbered.
    static bool farther(const Site& a, const Site& b) {
        return a.squared_distance != b.squared_distance ? a.squared_distance > b.squared_distance : a.r > b.r;
    }

    void gather_sites(const Row<Dim>& row, double squared_radius) {
        sites_.clear();
        for (int k = 0; k < row.count; ++k) {
            Site site{0, {}};
            for (int d = 0; d < Dim; ++d) {
                site.r[d] = -row.separation[d][k];
                site.squared_distance += site.r[d] * site.r[d];
            }
            if (site.squared_distance > 0 && site.squared_distance < squared_radius) {
                sites_.push_back(site);
            }
        }
        std::make_heap(sites_.begin(), sites_.end(), farther);
    }

    std::vector<Site> sites_;
    std::conditional_t<Dim == 2, ConvexPolygon, ConvexPolyhedron> cell_;
};

} // namespace sphvv::solver
