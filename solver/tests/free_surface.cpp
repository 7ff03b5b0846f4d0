// Detectors of the free surface: their formulas with all pairs, the values on lattices in print, and what
// each owes: the same answer however the fluid is turned and numbered and on any number of threads.
//   solver_free_surface --gtest_filter='*CoveredBall*'
#include "sphvv/solver/free_surface.hpp"

#include "sphvv/solver/free_surface/outward_normal.hpp"
#include "sphvv/solver/tests/scenes.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <omp.h>

#include <filesystem>
#include <numeric>

namespace sphvv::solver {
namespace {

using namespace scenes;

/// What a detector says of every particle.
template <int Dim>
struct Found {
    std::vector<std::uint8_t> surface;
    std::vector<double> indicator;
    std::array<std::vector<double>, Dim> normal;

    int marked() const { return std::accumulate(surface.begin(), surface.end(), 0); }
    Vector<Dim> normal_at(int i) const {
        Vector<Dim> n;
        for (int d = 0; d < Dim; ++d) {
            n[d] = normal[d][i];
        }
        return n;
    }
};

/// Points in an open box around them, with their list.
template <int Dim>
struct Cloud {
    Cloud(Points<Dim> where, double spacing, double h_over_dx = 1.3,
          const char* kernel_name = "quintic_spline", double skin = 0)
        : points(std::move(where)), dx(spacing), h(h_over_dx * spacing), kernel(&kernels::find(kernel_name)),
          volume(points[0].size(), std::pow(spacing, Dim)) {
        for (int d = 0; d < Dim; ++d) {
            const auto [low, high] = std::minmax_element(points[d].begin(), points[d].end());
            box.low[d] = *low - dx;
            box.high[d] = *high + dx;
        }
        list.build(box, *kernel, h, skin, pointers<Dim>(points), size<Dim>(points));
    }

    Found<Dim> detect(const Detector& detector) const {
        return detect(detector, detector.threshold(Dim, list.support_radius() / dx));
    }

    Found<Dim> detect(const Detector& detector, double threshold) const {
        const int count = size<Dim>(points);
        Found<Dim> found{std::vector<std::uint8_t>(count, 9), std::vector<double>(count), {}};
        SurfaceOutput<Dim> output{found.surface.data(), found.indicator.data(), {}};
        for (int d = 0; d < Dim; ++d) {
            found.normal[d].assign(count, 0);
            output.normal[d] = found.normal[d].data();
        }
        detector.detect<Dim>({&list, volume.data(), dx}, threshold, output);
        return found;
    }

    Points<Dim> points;
    double dx;
    double h;
    const Kernel* kernel;
    std::vector<double> volume;
    Box<Dim> box;
    NeighbourList<Dim> list;
};

/// Lattice of that many points along each direction, the first in the middle of the first cell, displaced.
template <int Dim>
Points<Dim> block(const std::array<int, Dim>& along, double dx, double disorder = 0, std::uint64_t seed = 1) {
    Box<Dim> box;
    for (int d = 0; d < Dim; ++d) {
        box.high[d] = along[d] * dx;
    }
    Points<Dim> points = lattice<Dim>(box, dx);
    jitter<Dim>(points, disorder * dx, seed);
    return points;
}

template <int Dim>
std::array<int, Dim> cube_of(int n) {
    std::array<int, Dim> along;
    along.fill(n);
    return along;
}

/// Half-space of lattice rows under the plane through the last one; returns the middle of row `rows` below.
template <int Dim>
int under_flat_surface(const Cloud<Dim>& cloud, int n, int rows) {
    int index = 0;
    for (int d = Dim - 1; d >= 0; --d) {
        index = index * n + (d == Dim - 1 ? n - 1 - rows : n / 2);
    }
    EXPECT_LT(index, size<Dim>(cloud.points));
    return index;
}

template <class Dimension>
class FreeSurface : public testing::Test {};
TYPED_TEST_SUITE(FreeSurface, Dimensions);

TEST(Detectors, AreTheFilesOfTheFolder) {
    std::vector<std::string> stems;
    for (const auto& entry : std::filesystem::directory_iterator(SPHVV_SOLVER_FOLDER "/free_surface")) {
        if (entry.path().extension() == ".cpp") {
            stems.push_back(entry.path().stem().string());
        }
    }
    std::ranges::sort(stems);
    std::vector<std::string> names;
    for (const Detector* detector : free_surface::all()) {
        names.emplace_back(detector->name);
        EXPECT_EQ(&free_surface::find(detector->name), detector);
    }
    EXPECT_EQ(names, stems);
    EXPECT_THROW(free_surface::find("umbrella"), UserError);
}

TEST(Detectors, AreDeclaredInFull) {
    for (const Detector* detector : free_surface::all()) {
        SCOPED_TRACE(detector->name);
        for (const std::string_view text : {detector->summary, detector->formula, detector->source,
                                            detector->key, detector->key_summary, detector->default_value}) {
            EXPECT_FALSE(text.empty());
        }
        ASSERT_NE(detector->threshold, nullptr);
        EXPECT_NE(detector->detect2, nullptr);
        EXPECT_NE(detector->detect3, nullptr);
        EXPECT_EQ(detector->gives_normal, detector->name == "lowest_eigenvalue");
        for (const int dim : {2, 3}) {
            const double threshold = detector->threshold(dim, 3.6);
            const Key key = detector->threshold_key(dim, 3.6);
            EXPECT_GT(threshold, 0);
            EXPECT_DOUBLE_EQ(parse_number(key.value, key.name), threshold);
            EXPECT_EQ(key.name, detector->key);
            EXPECT_EQ(key.low, 0);
            EXPECT_GT(key.high, threshold);
            for (const PublishedThreshold& print : detector->published) {
                const std::string said = "published: " + shortest(print.value);
                EXPECT_TRUE(print.dimension != dim || key.summary.find(said) != std::string::npos)
                    << key.summary;
            }
        }
    }
}

// h = 1.2 dx and 1.3 dx, quintic spline (journal sheet §3; Oger 2007 for the cubic spline's 20).
TEST(Detectors, CountLatticeNeighboursAsThePublicationsDo) {
    const int deep = 9;
    EXPECT_EQ(lattice_neighbours(2, 3.6, deep), 36);
    EXPECT_EQ(lattice_neighbours(2, 3.6, 0), 21);
    EXPECT_EQ(lattice_neighbours(2, 3.6, 1), 28);
    EXPECT_EQ(lattice_neighbours(3, 3.6, deep), 178);
    EXPECT_EQ(lattice_neighbours(3, 3.6, 0), 107);
    EXPECT_EQ(lattice_neighbours(3, 3.6, 1), 144);
    EXPECT_EQ(lattice_neighbours(2, 2.6, deep), 20);
    EXPECT_EQ(lattice_neighbours(2, 6, deep), 108);
    EXPECT_EQ(free_surface::find("neighbour_count").threshold(2, 3.6), 28);
    EXPECT_EQ(free_surface::find("neighbour_count").threshold(3, 3.6), 144);
}

/// Farthest corner of the Voronoi cell, by all corners of all planes that no other plane cuts off; a cube of
/// ten caps closes open cells.
template <int Dim>
double reach_by_all_corners(const std::vector<Neighbour<Dim>>& row, double cap) {
    std::vector<Vector<Dim>> a;
    std::vector<double> c;
    for (const Neighbour<Dim>& pair : row) {
        if (pair.distance < 2 * cap) {
            a.push_back(-Eigen::Map<const Vector<Dim>>(pair.r.data()));
            c.push_back(pair.distance * pair.distance / 2);
        }
    }
    for (int d = 0; d < Dim; ++d) {
        for (const double sign : {-1., 1.}) {
            a.push_back(sign * Vector<Dim>::Unit(d));
            c.push_back(10 * cap);
        }
    }
    double reach = 0;
    const int planes = static_cast<int>(a.size());
    const auto try_corner = [&](const std::array<int, Dim>& of) {
        Matrix<Dim> A;
        Vector<Dim> b;
        for (int d = 0; d < Dim; ++d) {
            A.row(d) = a[of[d]].normalized();
            b[d] = c[of[d]] / a[of[d]].norm();
        }
        if (std::abs(A.determinant()) < 1e-9) {
            return;
        }
        const Vector<Dim> corner = A.inverse() * b;
        for (int k = 0; k < planes; ++k) {
            if (a[k].dot(corner) > c[k] + 1e-9 * cap * a[k].norm()) {
                return;
            }
        }
        reach = std::max(reach, corner.norm());
    };
    for (int k = 0; k < planes; ++k) {
        for (int l = 0; l < k; ++l) {
            if constexpr (Dim == 2) {
                try_corner({k, l});
            } else {
                for (int m = 0; m < l; ++m) {
                    try_corner({k, l, m});
                }
            }
        }
    }
    return std::min(reach, cap);
}

TYPED_TEST(FreeSurface, IsFoundByTheFormulasWithAllPairs) {
    constexpr int dim = TypeParam::value;
    const Cloud<dim> cloud(block<dim>(cube_of<dim>(dim == 2 ? 11 : 6), 0.1, 0.2), 0.1);
    const auto rows = all_neighbours<dim>(cloud.box, cloud.points, *cloud.kernel, cloud.h);
    const Found<dim> divergence = cloud.detect(free_surface::find("position_divergence"));
    const Found<dim> eigenvalue = cloud.detect(free_surface::find("lowest_eigenvalue"));
    const Found<dim> neighbours = cloud.detect(free_surface::find("neighbour_count"));
    const Found<dim> ball = cloud.detect(free_surface::find("covered_ball"));
    const double cap = cloud.list.support_radius() / 2;
    for (int i = 0; i < size<dim>(cloud.points); ++i) {
        SCOPED_TRACE(i);
        Matrix<dim> M = Matrix<dim>::Zero();
        Vector<dim> S = Vector<dim>::Zero();
        for (const auto& pair : rows[i]) {
            const Vector<dim> r = Eigen::Map<const Vector<dim>>(pair.r.data());
            const Vector<dim> gradW = Eigen::Map<const Vector<dim>>(pair.gradW.data());
            M -= cloud.volume[pair.j] * r * gradW.transpose();
            S += cloud.volume[pair.j] * gradW;
        }
        const Eigen::SelfAdjointEigenSolver<Matrix<dim>> spectrum(M);
        const Vector<dim> out = -M.inverse() * S;
        ASSERT_NEAR(divergence.indicator[i], M.trace(), 1e-12);
        ASSERT_NEAR(eigenvalue.indicator[i], spectrum.eigenvalues()[0], 1e-7);
        ASSERT_NEAR((eigenvalue.normal_at(i) - out.normalized()).norm(), 0, 1e-9);
        ASSERT_EQ(neighbours.indicator[i], rows[i].size());
        if (dim == 2 || i % 7 == 0) {
            ASSERT_NEAR(ball.indicator[i], cloud.dx / reach_by_all_corners<dim>(rows[i], cap), 1e-9);
        }
        ASSERT_EQ(divergence.surface[i], M.trace() < (dim == 2 ? 1.5 : 2.33));
        ASSERT_EQ(eigenvalue.surface[i], spectrum.eigenvalues()[0] < 0.97);
        ASSERT_EQ(neighbours.surface[i], rows[i].size() < (dim == 2 ? 32U : 192U));
    }
}

// The definition of Dilts 2000 with points of the sphere in place of its exact cover.
TYPED_TEST(FreeSurface, BallsCoverTheSphereExactlyWhereTheCellEndsBefore) {
    constexpr int dim = TypeParam::value;
    const Cloud<dim> cloud(block<dim>(cube_of<dim>(dim == 2 ? 11 : 6), 0.1, 0.3, 5), 0.1);
    const Found<dim> found = cloud.detect(free_surface::find("covered_ball"));
    const double r = 0.7 * std::sqrt(dim) * cloud.dx;
    Random random(8);
    int uncovered = 0;
    for (int i = 0; i < size<dim>(cloud.points); ++i) {
        const auto row = cloud.list.row(i);
        bool open = false;
        for (int direction = 0; direction < 2000; ++direction) {
            Vector<dim> u;
            do {
                for (int d = 0; d < dim; ++d) {
                    u[d] = random.uniform(-1, 1);
                }
            } while (u.norm() > 1 || u.norm() < 0.1);
            u *= r / u.norm();
            bool covered = false;
            for (int k = 0; k < row.count && !covered; ++k) {
                double squared = 0;
                for (int d = 0; d < dim; ++d) {
                    squared += std::pow(u[d] + row.separation[d][k], 2);
                }
                covered = squared < r * r;
            }
            open = open || !covered;
        }
        uncovered += open ? 1 : 0;
        ASSERT_FALSE(open && !found.surface[i]) << i;
    }
    // Openings too small for the 2000 directions are few.
    EXPECT_LE(found.marked() - uncovered, dim == 2 ? 2 : 6);
    EXPECT_GT(uncovered, 20);
}

// Xu sheet §1.10 for the plane; the sums in space and of the eigenvalue were made by a program of their own.
TYPED_TEST(FreeSurface, HasTheSheetsValuesOnAFlatLatticeSurface) {
    constexpr int dim = TypeParam::value;
    constexpr int n = 13;
    const Cloud<dim> cloud(block<dim>(cube_of<dim>(n), 0.02), 0.02);
    const std::array<double, 3> divergence =
        dim == 2 ? std::array{1.2161, 1.7422, 1.9867} : std::array{1.9377, 2.7164, 2.9875};
    const std::array<double, 3> eigenvalue =
        dim == 2 ? std::array{0.5003, 0.7815, 0.9869} : std::array{0.4999, 0.7903, 0.9890};
    const std::array<int, 3> neighbours = dim == 2 ? std::array{25, 32, 39} : std::array{147, 192, 229};
    const auto value = [&](const char* name, int i) {
        return cloud.detect(free_surface::find(name)).indicator[i];
    };
    for (int row = 0; row < 3; ++row) {
        SCOPED_TRACE(row);
        const int i = under_flat_surface(cloud, n, row);
        EXPECT_NEAR(value("position_divergence", i), divergence[row], 6e-5);
        EXPECT_NEAR(value("lowest_eigenvalue", i), eigenvalue[row], 6e-5);
        EXPECT_EQ(value("neighbour_count", i), neighbours[row]);
        EXPECT_EQ(lattice_neighbours(dim, 3.9, row), neighbours[row]);
        // An open cell reaches as far as the list tells, 1.95 dx.
        EXPECT_NEAR(value("covered_ball", i), row == 0 ? 1 / 1.95 : 2 / std::sqrt(dim), 1e-12);
        for (const Detector* detector : free_surface::all()) {
            // The eigenvalue in print takes the second row, too.
            const bool marked = row == 0 || (row == 1 && detector->name == "lowest_eigenvalue");
            EXPECT_EQ(cloud.detect(*detector).surface[i], marked) << detector->name;
        }
    }
    const Found<dim> eigen = cloud.detect(free_surface::find("lowest_eigenvalue"));
    const int top = under_flat_surface(cloud, n, 0);
    EXPECT_NEAR((eigen.normal_at(top) - Vector<dim>::Unit(dim - 1)).norm(), 0, 1e-12);
    EXPECT_NEAR((outward_normal<dim>(cloud.list.row(top), VolumeField{cloud.volume.data()}) -
                 Vector<dim>::Unit(dim - 1))
                    .norm(),
                0, 1e-12);
}

// The publication's count in space, printed for h = 1.2 dx, is above that of the bulk.
TEST(FreeSurface, NeighbourCountOf190MarksEverythingInSpace) {
    const Sample<3> bulk(9, 0, 1, true, 1, 1.2);
    const std::vector<double> V(bulk.count(), bulk.volume());
    std::vector<std::uint8_t> surface(bulk.count());
    const Detector& detector = free_surface::find("neighbour_count");
    detector.detect<3>({&bulk.list, V.data(), bulk.dx}, 190, {surface.data()});
    EXPECT_EQ(std::accumulate(surface.begin(), surface.end(), 0), bulk.count());
    detector.detect<3>({&bulk.list, V.data(), bulk.dx}, {surface.data()});
    EXPECT_EQ(std::accumulate(surface.begin(), surface.end(), 0), 0);
}

// Whether rows come from periodic images or from particles behind a wall makes no difference to a list.
TYPED_TEST(FreeSurface, IsNotFoundWhereSupportsAreFull) {
    constexpr int dim = TypeParam::value;
    for (const double disorder : {0., 0.15}) {
        const Sample<dim> bulk(dim == 2 ? 24 : 10, disorder, 3, true);
        const std::vector<double> V(bulk.count(), bulk.volume());
        for (const Detector* detector : free_surface::all()) {
            if (disorder > 0 && detector->name == "lowest_eigenvalue") {
                continue; // 0.97 marks the inside of disordered particles; the surface study says how often
            }
            std::vector<std::uint8_t> surface(bulk.count());
            detector->detect<dim>({&bulk.list, V.data(), bulk.dx}, {surface.data()});
            EXPECT_EQ(std::accumulate(surface.begin(), surface.end(), 0), 0) << detector->name;
        }
    }
}

// The table in lowest_eigenvalue.cpp.
TEST(FreeSurface, TheEigenvalueInPrintMarksTheInsideOfDisorderedParticles) {
    struct Case {
        const char* kernel;
        double h_over_dx;
        double displacement;
        double share;
    };
    for (const Case& expected : {Case{"quintic_spline", 1.3, 0.02, 0}, Case{"quintic_spline", 1.3, 0.1, 0.31},
                                 Case{"quintic_spline", 1.3, 0.2, 0.68}, Case{"cubic_spline", 1.3, 0.1, 0.38},
                                 Case{"cubic_spline", 3, 0.1, 0}, Case{"wendland_c2", 1.3, 0.02, 0.68}}) {
        const Sample<2> bulk(60, expected.displacement, 1, true, 1, expected.h_over_dx,
                             kernels::find(expected.kernel));
        const std::vector<double> V(bulk.count(), bulk.volume());
        std::vector<std::uint8_t> surface(bulk.count());
        free_surface::find("lowest_eigenvalue").detect<2>({&bulk.list, V.data(), bulk.dx}, {surface.data()});
        const double marked = std::accumulate(surface.begin(), surface.end(), 0);
        EXPECT_NEAR(marked / bulk.count(), expected.share, 0.04) << expected.kernel << expected.displacement;
    }
}

TYPED_TEST(FreeSurface, MovesAndTurnsWithTheFluidAndIsIndifferentToNumbers) {
    constexpr int dim = TypeParam::value;
    const Points<dim> points = block<dim>(cube_of<dim>(dim == 2 ? 14 : 8), 0.05, 0.2, 7);
    const int count = size<dim>(points);
    Random random(4);
    Matrix<dim> any;
    for (int a = 0; a < dim; ++a) {
        for (int b = 0; b < dim; ++b) {
            any(a, b) = random.uniform(-1, 1);
        }
    }
    const Matrix<dim> Q = Eigen::HouseholderQR<Matrix<dim>>(any).householderQ();
    std::vector<int> from(count);
    std::iota(from.begin(), from.end(), 0);
    for (int k = count - 1; k > 0; --k) {
        std::swap(from[k], from[static_cast<int>(random.uniform(0, k + 1))]);
    }
    Points<dim> turned;
    Points<dim> renumbered;
    for (int i = 0; i < count; ++i) {
        Vector<dim> x;
        for (int d = 0; d < dim; ++d) {
            x[d] = points[d][i];
            renumbered[d].push_back(points[d][from[i]]);
        }
        const Vector<dim> y = Q * x + Vector<dim>::Constant(0.7);
        for (int d = 0; d < dim; ++d) {
            turned[d].push_back(y[d]);
        }
    }
    const Cloud<dim> first(points, 0.05);
    const Cloud<dim> second(turned, 0.05);
    const Cloud<dim> third(renumbered, 0.05);
    for (const Detector* detector : free_surface::all()) {
        SCOPED_TRACE(detector->name);
        const Found<dim> a = first.detect(*detector);
        const Found<dim> b = second.detect(*detector);
        const Found<dim> c = third.detect(*detector);
        EXPECT_GT(a.marked(), 0);
        EXPECT_EQ(a.surface, b.surface);
        for (int i = 0; i < count; ++i) {
            ASSERT_NEAR(a.indicator[i], b.indicator[i], 1e-7);
            ASSERT_NEAR((Q * a.normal_at(i) - b.normal_at(i)).norm(), 0, 1e-9);
            ASSERT_NEAR(a.indicator[from[i]], c.indicator[i], 1e-7);
            ASSERT_EQ(a.surface[from[i]], c.surface[i]);
            if (detector->name == "covered_ball") { // to the bit: cuts go by distance
                ASSERT_EQ(a.indicator[from[i]], c.indicator[i]);
            }
        }
    }
}

TYPED_TEST(FreeSurface, TakesALoneParticleAPairAndALine) {
    constexpr int dim = TypeParam::value;
    std::array<int, dim> line;
    line.fill(1);
    line[0] = 12;
    std::array<int, dim> pair = line;
    pair[0] = 2;
    for (const auto& along : {cube_of<dim>(1), pair, line}) {
        const Cloud<dim> cloud(block<dim>(along, 0.1), 0.1);
        for (const Detector* detector : free_surface::all()) {
            const Found<dim> found = cloud.detect(*detector);
            EXPECT_EQ(found.marked(), size<dim>(cloud.points)) << detector->name << ' ' << along[0];
            for (int i = 0; i < found.marked(); ++i) {
                EXPECT_TRUE(std::isfinite(found.indicator[i]));
                EXPECT_TRUE(std::isfinite(found.normal_at(i).norm()));
            }
        }
    }
}

// In a jet of w rows all particles of the first and last are at the surface, those between are not.
TYPED_TEST(FreeSurface, CoveredBallHoldsInThinJets) {
    constexpr int dim = TypeParam::value;
    constexpr int n = dim == 2 ? 20 : 9;
    for (int width = 1; width <= 5; ++width) {
        std::array<int, dim> along = cube_of<dim>(n);
        along[dim - 1] = width;
        const Cloud<dim> cloud(block<dim>(along, 0.1), 0.1);
        const Found<dim> found = cloud.detect(free_surface::find("covered_ball"));
        for (int i = 0; i < size<dim>(cloud.points); ++i) {
            bool rim = false;
            for (int d = 0; d < dim; ++d) {
                const double x = cloud.points[d][i] / 0.1;
                rim = rim || x < 1 || x > along[d] - 1;
            }
            ASSERT_EQ(found.surface[i], rim) << "width " << width << ", particle " << i;
        }
    }
}

// Exact by construction on a square lattice of any shape: marked if and only if a nearest neighbour is
// missing.
TEST(FreeSurface, CoveredBallMarksWhereANearestNeighbourOfASquareLatticeIsMissing) {
    Random random(21);
    constexpr int n = 24;
    std::array<std::array<bool, n>, n> filled{};
    Points<2> points;
    std::vector<std::array<int, 2>> cell;
    for (int x = 1; x < n - 1; ++x) {
        for (int y = 1; y < n - 1; ++y) {
            if (random.uniform(0, 1) < 0.85) {
                filled[x][y] = true;
                append<2>(points, {0.1 * x, 0.1 * y});
                cell.push_back({x, y});
            }
        }
    }
    const Cloud<2> cloud(points, 0.1);
    const Found<2> found = cloud.detect(free_surface::find("covered_ball"));
    for (int i = 0; i < size<2>(points); ++i) {
        const auto [x, y] = cell[i];
        const bool missing = !filled[x - 1][y] || !filled[x + 1][y] || !filled[x][y - 1] || !filled[x][y + 1];
        ASSERT_EQ(found.surface[i], missing) << i;
    }
    EXPECT_GT(found.marked(), 100);
    EXPECT_LT(found.marked(), size<2>(points) - 100);
}

// The bound of the threshold's derivation: displacements just below 0.2 dx, the worst ones at that.
TYPED_TEST(FreeSurface, CoveredBallMarksNothingInsideUpToTheDisorderItIsMadeFor) {
    constexpr int dim = TypeParam::value;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        Sample<dim> bulk(dim == 2 ? 24 : 8, 0, seed, true);
        Random random(seed);
        for (int d = 0; d < dim; ++d) {
            for (double& x : bulk.points[d]) {
                x += (random.uniform(0, 1) < 0.5 ? -0.1999 : 0.1999) * bulk.dx;
            }
        }
        wrap<dim>(bulk.box, bulk.points);
        bulk.build();
        const std::vector<double> V(bulk.count(), bulk.volume());
        std::vector<std::uint8_t> surface(bulk.count());
        free_surface::find("covered_ball").detect<dim>({&bulk.list, V.data(), bulk.dx}, {surface.data()});
        EXPECT_EQ(std::accumulate(surface.begin(), surface.end(), 0), 0);
    }
}

TYPED_TEST(FreeSurface, CoincidentParticlesShareTheirCell) {
    constexpr int dim = TypeParam::value;
    Points<dim> points = block<dim>(cube_of<dim>(7), 0.1);
    const int centre = size<dim>(points) / 2;
    for (int d = 0; d < dim; ++d) {
        points[d].push_back(points[d][centre]);
    }
    const Cloud<dim> cloud(points, 0.1);
    const Found<dim> found = cloud.detect(free_surface::find("covered_ball"));
    EXPECT_NEAR(found.indicator[centre], 2 / std::sqrt(dim), 1e-12);
    EXPECT_EQ(found.indicator.back(), found.indicator[centre]);
    const Found<dim> counted = cloud.detect(free_surface::find("neighbour_count"));
    const Found<dim> without =
        Cloud<dim>(block<dim>(cube_of<dim>(7), 0.1), 0.1).detect(free_surface::find("neighbour_count"));
    EXPECT_EQ(counted.indicator[centre], without.indicator[centre] + 1);
}

// Pairs between the support and the list's radius are nobody's neighbours.
TYPED_TEST(FreeSurface, IsTheSameFromAListWithASkin) {
    constexpr int dim = TypeParam::value;
    const Points<dim> points = block<dim>(cube_of<dim>(dim == 2 ? 14 : 8), 0.1, 0.2, 3);
    const Cloud<dim> bare(points, 0.1);
    const Cloud<dim> skinned(points, 0.1, 1.3, "quintic_spline", 0.2);
    ASSERT_GT(skinned.list.pairs(), bare.list.pairs());
    for (const Detector* detector : free_surface::all()) {
        const Found<dim> a = bare.detect(*detector);
        const Found<dim> b = skinned.detect(*detector);
        EXPECT_EQ(a.surface, b.surface) << detector->name;
        for (std::size_t i = 0; i < a.indicator.size(); ++i) {
            ASSERT_NEAR(a.indicator[i], b.indicator[i], 1e-7) << detector->name;
        }
    }
}

TYPED_TEST(FreeSurface, HasTheSameBitsOnAnyNumberOfThreads) {
    constexpr int dim = TypeParam::value;
    const Cloud<dim> cloud(block<dim>(cube_of<dim>(dim == 2 ? 40 : 12), 0.1, 0.2), 0.1);
    ASSERT_GT(cloud.list.block_count(), 4);
    const int threads = omp_get_max_threads();
    for (const Detector* detector : free_surface::all()) {
        omp_set_num_threads(1);
        const Found<dim> one = cloud.detect(*detector);
        omp_set_num_threads(2);
        const Found<dim> two = cloud.detect(*detector);
        EXPECT_EQ(one.surface, two.surface) << detector->name;
        EXPECT_EQ(one.indicator, two.indicator) << detector->name;
        EXPECT_EQ(one.normal, two.normal) << detector->name;
    }
    omp_set_num_threads(threads);
}

TEST(FreeSurface, CoveredBallRefusesASupportThatIsTooSmall) {
    const Cloud<3> cloud(block<3>({4, 4, 4}, 0.1), 0.1, 1.2, "cubic_spline");
    const Detector& detector = free_surface::find("covered_ball");
    try {
        cloud.detect(detector);
        ADD_FAILURE() << "accepted a support of 2.4 dx";
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find(detector.key), std::string::npos) << error.what();
    }
    EXPECT_NO_THROW(cloud.detect(detector, 0.84));
}

// Where the neighbours lie evenly there is no way out.
TYPED_TEST(FreeSurface, HasNoNormalInsideALatticeAndAtALoneParticle) {
    constexpr int dim = TypeParam::value;
    const Cloud<dim> deep(block<dim>(cube_of<dim>(9), 0.1), 0.1);
    const Cloud<dim> lone(block<dim>(cube_of<dim>(1), 0.1), 0.1);
    const Detector& detector = free_surface::find("lowest_eigenvalue");
    EXPECT_EQ(deep.detect(detector).normal_at(size<dim>(deep.points) / 2).norm(), 0);
    EXPECT_EQ(lone.detect(detector).normal_at(0).norm(), 0);
    EXPECT_NEAR(deep.detect(detector).normal_at(0).norm(), 1, 1e-12);
}

} // namespace
} // namespace sphvv::solver
