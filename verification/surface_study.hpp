#pragma once

#include "sphvv/solver/free_surface.hpp"
#include "sphvv/solver/kernels.hpp"
#include "sphvv/verification/published_operators.hpp"
#include "sphvv/verification/surface_shapes.hpp"

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace sphvv::verification {

/// How the particles fill a shape.
enum class SurfaceArrangement {
    aligned,     ///< square (cubic) lattice whose cells have their faces on the flat surfaces
    rotated,     ///< the same turned at random
    jittered_5,  ///< aligned, each coordinate displaced uniformly by up to 5 % of dx
    jittered_10, ///< 10 %
    jittered_20, ///< 20 %
    settled,     ///< the settled tile of particle_sets.hpp, repeated
    placed,      ///< the shape's own particles
};
std::string_view to_string(SurfaceArrangement arrangement);

/// Where a particle is in truth. A lattice fills a shape with the cells whose middles lie in it, and a
/// displaced particle stays in its cell (20 % < 1/2), so it is judged by the depth of the cell's middle:
///
///   surface    depth < dx/sqrt(3): a nearest neighbour is missing. One of the directions to the 2 dim
///   nearest
///              neighbours makes an angle with the outward normal whose cosine is at least 1/sqrt(dim), so
///              that this neighbour would lie above a flat or convex surface; and in a round void of 4 dx
///              across in the plane (up to 0.578 dx; on convex surfaces there up to dx/sqrt(2)).
///   interior   depth > dx: none is missing, as the depth changes by dx at most from one to the next.
///   undecided  between: which of the two it is depends on how the lattice lies; not counted.
///
/// Particles of a settled arrangement have no lattice cells. They are judged by their own depth: no second
/// particle fits above one at a depth of less than dx/sqrt(3), the spacing being larger; and above one deeper
/// than the largest empty ball is wide (largest_settled_hole) there is always another. A placed particle is
/// at the surface. No number is tuned.
enum class Truth : std::uint8_t { surface, interior, undecided };

/// Radius (dx) of which no ball between the particles of a settled tile is empty. A square lattice has 0.71
/// in the plane and 0.87 in space; a tile in the plane keeps defects of up to 0.746.
template <int Dim>
inline constexpr double largest_settled_hole = Dim == 2 ? 0.75 : 0.8660254037844386;

/// A shape filled with particles, spacing dx, each of volume dx^dim.
template <int Dim>
struct SurfaceParticles {
    double dx;                                     ///< m
    std::array<std::vector<double>, Dim> points{}; ///< m
    std::vector<Truth> truth{};
    std::vector<double> depth{}; ///< dx; what the truth follows from
    std::vector<int> judged{};   ///< those in the shape's window: their supports end at true surfaces only
    solver::Box<Dim> box{};      ///< open, around all of them

    int size() const { return static_cast<int>(truth.size()); }
};

/// Fills a shape. The same seed gives the same particles; a shape that places its own takes no other
/// arrangement, nor any other shape that one: std::invalid_argument.
template <int Dim>
SurfaceParticles<Dim> surface_particles(const SurfaceShape& shape, double size,
                                        SurfaceArrangement arrangement, std::uint64_t seed);

/// A detector with a threshold of its own or (NaN) its default.
struct DetectorChoice {
    const solver::Detector* detector;
    double threshold = std::numeric_limits<double>::quiet_NaN();
};

/// Kernel and h/dx as a publication has them.
struct SurfaceSetting {
    const solver::Kernel* kernel;
    double h_over_dx;
    std::string_view source;
};

/// What is compared.
struct SurfacePlan {
    std::vector<const SurfaceShape*> shapes;
    std::vector<int> dimensions;
    std::vector<DetectorChoice> choices;
    std::vector<SurfaceSetting> settings_2d;
    std::vector<SurfaceSetting> settings_3d;
    int seeds;            ///< of random arrangements
    int settled_seeds_3d; ///< of the settled one in space, which takes a second to make
};

/// Xu 2009 (quintic spline, h/dx = 1.3), Lee 2008 (quartic, 1.3), Oger 2007 (cubic, 1.3), Asai 2012 (quintic,
/// 1.2); in three dimensions the first in the quick tier, and the first and third in the nightly one. Every
/// detector with its own threshold, and the eigenvalue also with 0.64, halfway between the first two rows of
/// a flat lattice surface (quintic spline, 1.3: 0.500 and 0.781). The quick tier takes under 20 s on two
/// cores. Throws std::invalid_argument for a tier that is neither "quick" nor "nightly".
SurfacePlan surface_plan(std::string_view tier);

/// One detector on one shape and arrangement; counts are sums over the seeds.
struct SurfaceRow {
    std::string shape; ///< with its size
    int dimension;
    SurfaceArrangement arrangement;
    std::string detector;
    double threshold;
    bool default_threshold;
    std::string kernel;
    double h_over_dx;
    int seeds;
    long surface = 0;            ///< judged particles that are at the surface
    long interior = 0;           ///< and that are not
    long undecided = 0;          ///< and that do not count
    long found = 0;              ///< surface particles that are marked
    long false_alarms = 0;       ///< interior particles that are marked
    double precision = 0;        ///< found / (found + false alarms), NaN if nothing is marked
    double recall = 0;           ///< found / surface
    double lowest_precision = 0; ///< over the seeds
    double lowest_recall = 0;
    double deepest_false_alarm =
        0; ///< depth (dx) of the deepest interior particle that is marked; 0: none is
    std::optional<double> expected_precision{}; ///< where theory gives it
    std::optional<double> expected_recall{};
    std::string why{};           ///< the theory
    std::string verdict{"NONE"}; ///< PASS, FAIL, or NONE where theory says nothing
};

/// Told what is done: a line of text and the share that is done.
using SurfaceProgress = std::function<void(const std::string& what, double fraction)>;

/// Runs a plan. Rows in the order dimension, setting, shape, arrangement, choice.
std::vector<SurfaceRow> run_surface_study(const SurfacePlan& plan, const SurfaceProgress& progress = {});

/// What theory says of precision and recall, else nothing: see `why` of the rows. Default thresholds only.
void expect(SurfaceRow& row, const SurfaceShape& shape, const solver::Detector& detector);

/// Every row, all columns.
std::string surface_table(const std::vector<SurfaceRow>& rows);

/// What a cell of the summary shows.
enum class SurfaceMeasure : std::uint8_t {
    pooled,  ///< precision / recall in per cent of all counts of a line
    worst,   ///< the lowest precision and the lowest recall of any of its rows
    deepest, ///< depth of the deepest false alarm, dx
};

/// A line for each shape (or, for `by_arrangement`, each arrangement), a column for each detector and
/// threshold.
std::string surface_summary(const std::vector<SurfaceRow>& rows, bool by_arrangement,
                            SurfaceMeasure measure = SurfaceMeasure::pooled);

/// The figures in print or on our sheets: div r of the first rows of a flat lattice surface (Xu sheet §1.10),
/// lattice counts (journal sheet §3) and what the printed counts mark.
std::vector<PublishedFigure> published_surface_figures();

} // namespace sphvv::verification
