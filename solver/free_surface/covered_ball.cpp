#include "sphvv/solver/free_surface.hpp"
#include "sphvv/solver/free_surface/voronoi_cell.hpp"

namespace sphvv::solver::free_surface {
namespace {

/// A particle is at the surface if a ball of radius r can touch it without holding another particle: in other
/// words, if the sphere of radius r about it is not covered by the balls of radius r about the others (Dilts
/// 2000; Haque & Dilts 2007; Barecasco, Terissa & Naa 2013), or if it is a corner of the alpha shape with
/// alpha = r (Edelsbrunner & Mucke 1994).
///
/// A point u at distance r from the particle lies in none of those balls if |u - r_ij| >= r = |u| for all j,
/// that is u . r_ij <= |r_ij|^2/2: if it belongs to the particle's Voronoi cell. A cell is convex and holds
/// its particle, so the sphere is covered exactly if the cell ends before r. No support is averaged over:
/// the answer is the same in a jet of one particle as at the edge of a sea, for any kernel.
struct Formula {
    template <int Dim>
    struct Indicator {
        explicit Indicator(const SurfaceInput<Dim>& input)
            : particle_spacing(input.particle_spacing), cap(input.neighbours->support_radius() / 2) {}
        double operator()(const Row<Dim>& row, int /*i*/) { return particle_spacing / cell.reach(row, cap); }
        double particle_spacing;
        double cap; // what is farther than the support is not in the list
        VoronoiCell<Dim> cell;
    };

    template <int Dim>
    static void check(const SurfaceInput<Dim>& input, double threshold) {
        const double needed = 2 * input.particle_spacing / threshold;
        const double support = input.neighbours->support_radius();
        if (!(support > needed)) {
            throw UserError("covered_ball needs the neighbours within " + shortest(needed) +
                            " m, the support ends at " + shortest(support) +
                            " m; use a larger h_over_dx, a wider kernel or a larger "
                            "surface_spacing_over_reach");
        }
    }
};

/// r = sqrt(dim) (1/2 + p) dx with p = 0.2. The largest ball between the points of a square (cubic) lattice
/// has the radius sqrt(dim) dx/2; where every coordinate is displaced by less than p dx, no ball of radius r
/// is empty, and no particle inside is marked. On the undisplaced square lattice exactly those particles are
/// marked that miss one of their four nearest neighbours: with four the cell is a square and ends at 0.707
/// dx, and where one is missing, a ball of r = 0.99 dx < dx in its place touches no other.
double threshold(int dim, double /*radius*/) {
    return 1 / (0.7 * std::sqrt(dim));
}

} // namespace

const Detector& covered_ball() {
    static const Detector detector = with_indicator<Formula>({
        .name = "covered_ball",
        .summary = "a ball of radius r around the particle is not covered by those around the others",
        .formula = "dx / (farthest point of the Voronoi cell) < dx/r, r = 0.7 sqrt(dim) dx",
        .source =
            "exact form of Dilts 2000 (Int. J. Numer. Meth. Eng. 48, 1503), Haque & Dilts 2007 (J. Comput. "
            "Phys. 226, 1710) and Barecasco, Terissa & Naa 2013 (arXiv:1309.4290); radius: covered_ball.cpp",
        .key = "surface_spacing_over_reach",
        .key_summary = "particle spacing over the reach of the Voronoi cell below which a particle is at the "
                       "free surface; 1.41 (2-D) and 1.15 (3-D) in a lattice",
        .highest_threshold = 2,
        .default_value = "no particle inside is marked if every coordinate is displaced by less than 0.2 dx",
        .published = {},
        .threshold = threshold,
    });
    return detector;
}

} // namespace sphvv::solver::free_surface
