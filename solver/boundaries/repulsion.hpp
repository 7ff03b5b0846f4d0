#pragma once

#include "sphvv/solver/boundaries/wall.hpp"
#include "sphvv/solver/neighbours/cell_grid.hpp"
#include "sphvv/solver/particles.hpp"

#include <span>
#include <vector>

namespace sphvv::solver {

/// D [(r0/r)^4 - (r0/r)^2]/r for 0 < r < r0, and 0 beyond: the acceleration (m/s2) away from a point at the
/// distance r (m), with D (m2/s2) and the range r0 (m). Source: Monaghan 1994, as f1 in Issa 2005 §2.7, which
/// names the exponents (4, 2) before (12, 6).
double power_law_repulsion(double r, double strength, double range);

/// A s^2 + B s, s = R - r: what leads a force to 0 at r = R.
struct RepulsionTail {
    double square; ///< A
    double linear; ///< B

    /// The tail of the length s_c = R - r_c that has this value F and slope dF/dr at r_c: from A s_c^2 + B
    /// s_c = F and -2 A s_c - B = dF/dr, A = -(dF/dr + F/s_c)/s_c and B = 2 F/s_c + dF/dr.
    static constexpr RepulsionTail after(double value, double slope, double length) {
        return {-(slope + value / length) / length, 2 * value / length + slope};
    }
};

/// (D/r0) [(r0/r)^12 - (r0/r)^6] for 0 < r < r_c, A (r0 - r)^2 + B (r0 - r) for r_c < r < r0, 0 beyond, in
/// m/s2, A and B by continuity of value and slope at r_c. Source: Issa 2005 §2.7, read as a force, for as a
/// potential it would let the force jump at the end of the tail. No constants are given: with l and the end R
/// of the tail at r0 and r_c = 0.95 r0, A and B are positive, and nothing is drawn to the wall.
double lennard_jones_repulsion(double r, double strength, double range);
inline constexpr double lennard_jones_cut = 0.95; ///< r_c/r0

/// A force of that form and size between a particle and the points of walls.
struct RepulsiveLaw {
    RepulsiveForm form;
    double strength;       ///< D, m2/s2
    double range;          ///< r0, m, dx of the fluid
    int points_per_dx = 1; ///< along the wall: each has 1/points_per_dx^(dim-1) of the force
};

/// Points on walls, at rest on them, that push particles of the fluid away and take part in no sum.
template <int Dim>
class Repulsion {
public:
    /// The points lie in the box as the particles do: a periodic direction of it is one of theirs. Those of
    /// the normal form lie on a grid along the axes of the box where the wall is a plane in space.
    Repulsion(const RepulsiveLaw& law, std::span<const WallParticle<Dim>> points, const Box<Dim>& box);

    /// Acceleration (m/s2) of a particle at x (m) by all points of the walls at the time t (s), with e = (x -
    /// x_p)/|x - x_p| and F the force of the law,
    ///
    ///   radial, lennard_jones  sum_p F(|x - x_p|) e
    ///   normal                 sum_p F(n.(x - x_p)) P(t.(x - x_p)) n,  P(q) = 1 - |q|/r0 for |q| < r0, else
    ///                          0; in space P P for the two tangents,
    ///
    /// over points_per_dx^(dim-1). Source: Issa 2005 §2.7, f1 and f3.
    Vector<Dim> acceleration(std::span<const Wall<Dim>> walls, const Vector<Dim>& x, double t) const;

    /// Adds it to the acceleration of the fluid particles; looks further at those within r0 of a wall only.
    void add_to(Field& acceleration, std::span<const Wall<Dim>> walls, const Particles<Dim>& particles,
                double t) const;

private:
    using Stretches = std::vector<typename CellGrid<Dim>::Stretch>;

    /// The points of one wall, at t = 0, cell by cell. A wall that moves is looked at from where it was.
    struct Row {
        CellGrid<Dim> grid;
        std::vector<Vector<Dim>> points;
    };
    Row row_of(const std::vector<Vector<Dim>>& points) const;
    Vector<Dim> along_normal(const Vector<Dim>& separation, const Vector<Dim>& normal) const;
    Vector<Dim> of_wall(const Row& row, const Wall<Dim>& wall, const Vector<Dim>& x,
                        Stretches& stretches) const;
    Vector<Dim> of_walls(std::span<const Wall<Dim>> walls, const Vector<Dim>& x, double t,
                         Stretches& stretches) const;
    Vector<Dim> wrapped(Vector<Dim> x) const;

    RepulsiveLaw law_;
    double share_; ///< of a point in the force of one that stands alone
    Box<Dim> box_;
    std::vector<Row> rows_; ///< wall by wall
};

} // namespace sphvv::solver
