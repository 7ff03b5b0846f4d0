// The study of free-surface detectors: shapes, truth, counting, expectations.
#include "sphvv/verification/surface_study.hpp"

#include "sphvv/solver/error.hpp"
#include "sphvv/solver/free_surface/voronoi_cell.hpp"
#include "sphvv/verification/particle_sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <set>
#include <stdexcept>

namespace sphvv::verification {
namespace {

using enum SurfaceArrangement;
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;

template <class Dimension>
class SurfaceShapes : public testing::Test {};
TYPED_TEST_SUITE(SurfaceShapes, Dimensions);

template <int Dim, class Each>
void for_each_shape(const Each& each) {
    int shapes = 0;
    for (const SurfaceShape* shape : surface_shapes::all()) {
        for (const double size : shape->sizes<Dim>()) {
            SCOPED_TRACE(shape->title(size));
            each(*shape, size);
            ++shapes;
        }
    }
    EXPECT_GT(shapes, Dim == 2 ? 15 : 8);
}

template <int Dim>
solver::NeighbourList<Dim> list_of(const SurfaceParticles<Dim>& particles, double h_over_dx = 1.3) {
    solver::NeighbourList<Dim> list;
    std::array<const double*, Dim> position;
    for (int d = 0; d < Dim; ++d) {
        position[d] = particles.points[d].data();
    }
    list.build(particles.box, solver::kernels::find("quintic_spline"), h_over_dx * particles.dx, 0, position,
               particles.size());
    return list;
}

TEST(SurfaceShapes, AreTheFilesOfTheFolderDeclaredInFull) {
    std::vector<std::string> stems;
    for (const auto& entry : std::filesystem::directory_iterator(SPHVV_SURFACE_SHAPES)) {
        stems.push_back(entry.path().stem().string());
    }
    std::ranges::sort(stems);
    std::vector<std::string> names;
    for (const SurfaceShape* shape : surface_shapes::all()) {
        names.emplace_back(shape->name);
        EXPECT_FALSE(shape->summary.empty());
        EXPECT_FALSE(shape->formula.empty());
        EXPECT_FALSE(shape->sizes_2d.empty() && shape->sizes_3d.empty());
        EXPECT_NE(shape->depth2 == nullptr, shape->placed2 == nullptr) << shape->name;
        EXPECT_EQ(&surface_shapes::find(shape->name), shape);
    }
    EXPECT_EQ(names, stems);
    EXPECT_THROW(surface_shapes::find("torus"), UserError);
    EXPECT_EQ(surface_shapes::find("wedge").title(15), "wedge 15 degrees");
    EXPECT_EQ(surface_shapes::find("gap").title(1.5), "gap 1.5 dx");
    EXPECT_EQ(surface_shapes::find("flat").title(0), "flat");
}

// A function that nowhere changes by more than the distance, and that vanishes as far along its gradient as
// it says, is the distance.
TYPED_TEST(SurfaceShapes, HaveExactSignedDistances) {
    constexpr int dim = TypeParam::value;
    for_each_shape<dim>([](const SurfaceShape& shape, double size) {
        if (shape.is_placed()) {
            return;
        }
        const ShapeWindow<dim> window = shape.window<dim>(size);
        std::mt19937_64 generator(5);
        const auto place = [&] {
            std::array<double, dim> x;
            for (int d = 0; d < dim; ++d) {
                const double uniform = static_cast<double>(generator() >> 11U) * 0x1.0p-53;
                x[d] = window.low[d] - 1 + (window.high[d] - window.low[d] + 2) * uniform;
            }
            return x;
        };
        int inside = 0;
        for (int trial = 0; trial < 2000; ++trial) {
            const auto x = place();
            const auto y = place();
            double squared = 0;
            for (int d = 0; d < dim; ++d) {
                squared += (x[d] - y[d]) * (x[d] - y[d]);
            }
            const double depth = shape.depth<dim>(x, size);
            ASSERT_LE(std::abs(depth - shape.depth<dim>(y, size)), std::sqrt(squared) * (1 + 1e-12));
            if (depth <= 0) {
                continue;
            }
            ++inside;
            constexpr double step = 1e-6;
            auto foot = x;
            double length = 0;
            for (int d = 0; d < dim; ++d) {
                auto ahead = x;
                auto behind = x;
                ahead[d] += step;
                behind[d] -= step;
                const double slope =
                    (shape.depth<dim>(ahead, size) - shape.depth<dim>(behind, size)) / (2 * step);
                foot[d] -= depth * slope;
                length += slope * slope;
            }
            if (std::abs(length - 1) < 1e-6) { // not on a ridge, where two surfaces are equally near
                ASSERT_NEAR(shape.depth<dim>(foot, size), 0, 1e-4);
            }
        }
        EXPECT_GT(inside, 100);
    });
}

// The definition of the truth, held against the lattice itself.
TYPED_TEST(SurfaceShapes, TruthOfALatticeIsWhetherANearestNeighbourIsMissing) {
    constexpr int dim = TypeParam::value;
    for_each_shape<dim>([](const SurfaceShape& shape, double size) {
        if (shape.is_placed()) {
            return;
        }
        long surface = 0;
        for (const SurfaceArrangement arrangement : {aligned, rotated}) {
            for (std::uint64_t seed = 1; seed <= (arrangement == aligned ? 1U : 5U); ++seed) {
                const auto particles = surface_particles<dim>(shape, size, arrangement, seed);
                const auto list = list_of<dim>(particles);
                ASSERT_EQ(particles.judged.empty(), false);
                for (const int i : particles.judged) {
                    const auto row = list.row(i);
                    int nearest = 0;
                    for (int k = 0; k < row.count; ++k) {
                        double squared = 0;
                        for (int d = 0; d < dim; ++d) {
                            squared += row.separation[d][k] * row.separation[d][k];
                        }
                        nearest += squared < std::pow(1.0001 * particles.dx, 2) ? 1 : 0;
                    }
                    const bool missing = nearest < 2 * dim;
                    ASSERT_TRUE(particles.truth[i] != Truth::surface || missing) << particles.depth[i];
                    ASSERT_TRUE(particles.truth[i] != Truth::interior || !missing) << particles.depth[i];
                    surface += particles.truth[i] == Truth::surface ? 1 : 0;
                }
            }
        }
        EXPECT_GT(surface, 5);
    });
}

// What the truth of a settled arrangement rests on.
TYPED_TEST(SurfaceShapes, SettledParticlesKeepTheSpacingAndTheCoverOfTheTruth) {
    constexpr int dim = TypeParam::value;
    for (std::uint64_t seed = 1; seed <= (dim == 2 ? 20U : 1U); ++seed) {
        const ParticleSet<dim> set = particle_set<dim>(Arrangement::settled, settled_tile<dim>, 0, seed);
        solver::NeighbourList<dim> list;
        std::array<const double*, dim> position;
        for (int d = 0; d < dim; ++d) {
            position[d] = set.points[d].data();
        }
        list.build(set.box, solver::kernels::find("quintic_spline"), 1.3 * set.dx, 0, position, set.size());
        EXPECT_GT(list.minimum_distance(), set.dx / std::sqrt(3.0));
        solver::VoronoiCell<dim> cell;
        for (int i = 0; i < set.size(); ++i) {
            ASSERT_LT(cell.reach(list.row(i), 1.9 * set.dx), largest_settled_hole<dim> * set.dx) << seed;
        }
    }
}

TYPED_TEST(SurfaceShapes, AreFilledTheSameWayFromTheSameSeedOnly) {
    constexpr int dim = TypeParam::value;
    const SurfaceShape& shape = surface_shapes::find("disc");
    const double size = shape.sizes<dim>()[0];
    for (const SurfaceArrangement arrangement : {aligned, rotated, jittered_20}) {
        const auto one = surface_particles<dim>(shape, size, arrangement, 1);
        EXPECT_EQ(one.points, surface_particles<dim>(shape, size, arrangement, 1).points);
        EXPECT_EQ(one.points == surface_particles<dim>(shape, size, arrangement, 2).points,
                  arrangement == aligned);
        // Cells have the volume that they should.
        const double volume = dim == 2 ? 3.14159 * size * size : 4.18879 * size * size * size;
        EXPECT_NEAR(one.size(), volume, 0.03 * volume);
    }
    EXPECT_THROW(surface_particles<dim>(shape, size, placed, 1), std::invalid_argument);
    EXPECT_THROW(surface_particles<dim>(surface_shapes::find("spray"), 0, aligned, 1), std::invalid_argument);
}

/// A detector that marks everything whose indicator, 0 or 1, is below the threshold.
solver::Detector always(const char* name, double threshold) {
    solver::Detector detector = solver::free_surface::find("neighbour_count");
    detector.name = name;
    detector.threshold = threshold > 0 ? [](int, double) { return 1e9; } : [](int, double) { return 0.; };
    return detector;
}

SurfacePlan small_plan(std::vector<const SurfaceShape*> shapes, std::vector<DetectorChoice> choices) {
    SurfacePlan plan = surface_plan("quick");
    plan.shapes = std::move(shapes);
    plan.choices = std::move(choices);
    plan.settings_2d = {plan.settings_2d[0]};
    plan.seeds = 2;
    return plan;
}

TEST(SurfaceStudy, CountsMarksAgainstTheTruth) {
    const solver::Detector everything = always("everything", 1);
    const solver::Detector nothing = always("nothing", 0);
    SurfacePlan plan = small_plan({&surface_shapes::find("flat")}, {{&everything}, {&nothing}});
    plan.dimensions = {2};
    const auto rows = run_surface_study(plan);
    ASSERT_EQ(rows.size(), 12U);
    for (const SurfaceRow& row : rows) {
        SCOPED_TRACE(to_string(row.arrangement));
        EXPECT_GT(row.surface, 0);
        EXPECT_GT(row.interior, 6 * row.surface);
        const bool all = row.detector == "everything";
        EXPECT_EQ(row.found, all ? row.surface : 0);
        EXPECT_EQ(row.false_alarms, all ? row.interior : 0);
        EXPECT_EQ(row.recall, all ? 1 : 0);
        EXPECT_EQ(row.lowest_recall, row.recall);
        EXPECT_EQ(std::isnan(row.precision), !all);
        if (all) {
            const auto counted = static_cast<double>(row.surface + row.interior);
            EXPECT_DOUBLE_EQ(row.precision, static_cast<double>(row.surface) / counted);
            EXPECT_NEAR(row.deepest_false_alarm, 7.5, 0.5);
        }
        if (row.arrangement == aligned) { // theory expects both to part the rows, and finds them out
            EXPECT_EQ(row.surface, 24);
            EXPECT_EQ(row.interior, 7 * 24);
            EXPECT_EQ(row.undecided, 0);
            EXPECT_EQ(row.verdict, "FAIL");
        }
    }
}

TEST(SurfaceStudy, FindsWhatTheoryExpectsOnEveryShape) {
    SurfacePlan plan = surface_plan("quick");
    plan.seeds = 2;
    plan.settings_2d = {plan.settings_2d[0], plan.settings_2d[2]};
    std::erase_if(plan.shapes, [](const SurfaceShape* shape) { return shape->name == "spray"; });
    std::set<std::string> judged;
    int told = 0;
    double last = 0;
    const auto rows = run_surface_study(plan, [&](const std::string& what, double fraction) {
        told += what.empty() ? 0 : 1;
        last = fraction;
    });
    EXPECT_GT(told, 20);
    EXPECT_EQ(last, 1);
    for (const SurfaceRow& row : rows) {
        ASSERT_NE(row.verdict, "FAIL")
            << row.dimension << "-D " << row.shape << ", " << to_string(row.arrangement) << ", "
            << row.detector << ": " << row.precision << " / " << row.recall;
        EXPECT_EQ(row.verdict == "NONE", row.why.empty());
        EXPECT_GT(row.surface, 0);
        if (row.verdict == "PASS") {
            judged.insert(row.detector);
        }
        // The reason for the fourth detector: where the others see both sides at once.
        if (row.detector == "covered_ball") {
            EXPECT_GT(row.recall, 0.95) << row.shape;
            EXPECT_GT(row.precision, 0.95) << row.shape;
        }
    }
    EXPECT_EQ(judged.size(), 4U);
}

TEST(SurfaceStudy, AThresholdOfItsOwnHasNoExpectation) {
    const solver::Detector& ball = solver::free_surface::find("covered_ball");
    SurfacePlan plan = small_plan({&surface_shapes::find("square")}, {{&ball}, {&ball, 1.2}});
    plan.dimensions = {2};
    bool narrower = false;
    for (const SurfaceRow& row : run_surface_study(plan)) {
        if (row.default_threshold) {
            EXPECT_DOUBLE_EQ(row.threshold, 1 / (0.7 * std::sqrt(2.0)));
        } else {
            EXPECT_EQ(row.threshold, 1.2);
            EXPECT_EQ(row.verdict, "NONE");
            narrower = narrower || row.false_alarms > 0;
        }
    }
    EXPECT_TRUE(narrower) << "a ball of 0.83 dx falls between particles displaced by 20 %";
}

TEST(SurfaceStudy, TablesShowCountsAsTheyAre) {
    const SurfaceRow row{.shape = "disc 12 dx",
                         .dimension = 2,
                         .arrangement = rotated,
                         .detector = "covered_ball",
                         .threshold = 1.01,
                         .default_threshold = true,
                         .kernel = "quintic_spline",
                         .h_over_dx = 1.3,
                         .seeds = 5,
                         .surface = 10000,
                         .interior = 50000,
                         .found = 9999,
                         .false_alarms = 0,
                         .precision = 1,
                         .recall = 0.9999};
    SurfaceRow other = row;
    other.arrangement = settled;
    other.found = 0;
    other.precision = std::nan("");
    other.recall = 0;
    other.deepest_false_alarm = 1.234;
    SurfaceRow variant = row;
    variant.default_threshold = false;
    const std::string full = surface_table({row, other});
    EXPECT_NE(full.find("99.9 "), std::string::npos) << full; // 99.99 is not all
    EXPECT_NE(full.find("1.23"), std::string::npos) << full;
    const std::string pooled = surface_summary({row, other, variant}, false);
    EXPECT_NE(pooled.find("100 / 49.9"), std::string::npos) << pooled;
    EXPECT_NE(pooled.find("covered_ball < 1.01"), std::string::npos) << pooled;
    const std::string worst = surface_summary({row, other}, false, SurfaceMeasure::worst);
    EXPECT_NE(worst.find("100 / 0 "), std::string::npos) << worst;
    const std::string by_arrangement = surface_summary({row, other}, true);
    EXPECT_NE(by_arrangement.find("2-D settled"), std::string::npos) << by_arrangement;
    EXPECT_NE(by_arrangement.find("– / 0"), std::string::npos) << by_arrangement;
    EXPECT_NE(surface_summary({row, other}, false, SurfaceMeasure::deepest).find("1.23"), std::string::npos);
}

TEST(SurfaceStudy, FiguresInPrintAreOurs) {
    const auto figures = published_surface_figures();
    EXPECT_EQ(figures.size(), 9U);
    for (const PublishedFigure& figure : figures) {
        EXPECT_TRUE(figure.agrees) << figure.id << ": " << figure.published << ", ours " << figure.ours;
    }
}

TEST(SurfaceStudy, HasTwoTiers) {
    EXPECT_GE(surface_plan("quick").seeds, 5);
    EXPECT_GT(surface_plan("nightly").seeds, surface_plan("quick").seeds);
    EXPECT_THROW(surface_plan("full"), std::invalid_argument);
}

} // namespace
} // namespace sphvv::verification
