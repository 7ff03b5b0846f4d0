// The neighbour list against all pairs of particles and periodic images.
//   solver_neighbours --gtest_filter='*Follow*'
#include "sphvv/solver/lanes.hpp"
#include "sphvv/solver/neighbours/neighbour_list.hpp"
#include "sphvv/solver/tests/scenes.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

namespace sphvv::solver {
namespace {

using namespace scenes;

template <int Dim>
struct Pair {
    int j;
    std::array<double, Dim> r;
    double distance;
};

template <int Dim>
double length(const std::array<double, Dim>& r) {
    double squared = 0;
    for (const double component : r) {
        squared += component * component;
    }
    return std::sqrt(squared);
}

/// Some error of a separation: a few roundings of the coordinates.
template <int Dim>
double round_off(const Box<Dim>& box) {
    double largest = 0;
    for (int d = 0; d < Dim; ++d) {
        largest = std::max({largest, std::abs(box.low[d]), std::abs(box.high[d])});
    }
    return 8 * std::numeric_limits<double>::epsilon() * largest;
}

/// Every pair closer than the radius, from both sides, among particles and all periodic images that could be
/// so close.
template <int Dim>
std::vector<std::vector<Pair<Dim>>> all_pairs(const Box<Dim>& box, const Points<Dim>& points, double radius) {
    std::vector<std::array<double, Dim>> shifts{{}};
    for (int d = 0; d < Dim; ++d) {
        const int images = box.periodic[d] ? 1 + static_cast<int>(std::ceil(radius / box.length(d))) : 0;
        std::vector<std::array<double, Dim>> more;
        for (const auto& shift : shifts) {
            for (int image = -images; image <= images; ++image) {
                more.push_back(shift);
                more.back()[d] = image * box.length(d);
            }
        }
        shifts = more;
    }
    const int count = size<Dim>(points);
    std::vector<std::vector<Pair<Dim>>> result(count);
    for (int i = 0; i < count; ++i) {
        for (int j = 0; j < count; ++j) {
            for (const auto& shift : shifts) {
                Pair<Dim> pair{j, {}, 0};
                for (int d = 0; d < Dim; ++d) {
                    pair.r[d] = points[d][i] - points[d][j] - shift[d];
                }
                pair.distance = length<Dim>(pair.r);
                const bool itself = i == j && length<Dim>(shift) == 0;
                if (!itself && pair.distance < radius) {
                    result[i].push_back(pair);
                }
            }
        }
    }
    return result;
}

/// Takes the pair out of the row that matches it, or says that there is none.
template <int Dim>
bool take(std::vector<Pair<Dim>>& row, const Pair<Dim>& wanted, double tolerance) {
    const auto found = std::find_if(row.begin(), row.end(), [&](const Pair<Dim>& pair) {
        bool same = pair.j == wanted.j;
        for (int d = 0; d < Dim; ++d) {
            same = same && std::abs(pair.r[d] - wanted.r[d]) <= tolerance;
        }
        return same;
    });
    if (found == row.end()) {
        return false;
    }
    *found = row.back();
    row.pop_back();
    return true;
}

template <int Dim>
std::vector<Pair<Dim>> listed(const NeighbourList<Dim>& list, int i) {
    const auto row = list.row(i);
    std::vector<Pair<Dim>> pairs;
    for (int k = 0; k < row.count; ++k) {
        Pair<Dim> pair{row.index[k], {}, 0};
        for (int d = 0; d < Dim; ++d) {
            pair.r[d] = row.separation[d][k];
        }
        pair.distance = length<Dim>(pair.r);
        pairs.push_back(pair);
    }
    return pairs;
}

/// The list holds the pairs that it should within `radius`, and nothing beyond.
template <int Dim>
void expect_pairs(const NeighbourList<Dim>& list, const Box<Dim>& box, const Points<Dim>& points,
                  double radius) {
    const double tolerance = round_off(box);
    auto expected = all_pairs<Dim>(box, points, radius);
    ASSERT_EQ(list.size(), size<Dim>(points));
    for (int i = 0; i < list.size(); ++i) {
        for (const Pair<Dim>& pair : listed(list, i)) {
            if (!take(expected[i], pair, tolerance)) {
                EXPECT_NEAR(pair.distance, radius, tolerance)
                    << i << " and " << pair.j << " are listed but no pair";
            }
        }
        for (const Pair<Dim>& pair : expected[i]) {
            EXPECT_NEAR(pair.distance, radius, tolerance)
                << i << " and " << pair.j << " are a pair but not listed";
        }
    }
}

/// What every list owes whatever the arrangement: symmetry to the bit, the slope of each pair, harmless
/// padding, and totals that fit the rows.
template <int Dim>
void expect_sound(const NeighbourList<Dim>& list, const Kernel& kernel, double h) {
    std::int64_t pairs = 0;
    std::size_t entries = 0;
    double closest = infinity;
    std::set<int> closest_particles;
    std::vector<std::vector<std::pair<Pair<Dim>, double>>> seen(list.size());
    for (int i = 0; i < list.size(); ++i) {
        const auto row = list.row(i);
        EXPECT_EQ(list.row_start(i), entries);
        EXPECT_EQ(row.padded % lane_count, 0);
        EXPECT_GE(row.padded, row.count);
        EXPECT_LT(row.padded, row.count + lane_count);
        pairs += row.count;
        entries += row.padded;
        const auto of_row = listed(list, i);
        for (int k = 0; k < row.count; ++k) {
            const double distance = of_row[k].distance;
            if (distance <= closest) {
                closest_particles = distance < closest ? std::set<int>{} : closest_particles;
                closest = distance;
                closest_particles.insert(i);
            }
            const double scale = std::abs(kernel.slope(Dim, 0, h));
            EXPECT_NEAR(row.slope[k], kernel.slope(Dim, distance, h), 1e-13 * scale);
            seen[i].emplace_back(of_row[k], row.slope[k]);
        }
        for (int k = row.count; k < row.padded; ++k) {
            EXPECT_EQ(row.index[k], i);
            EXPECT_EQ(row.slope[k], 0);
            for (int d = 0; d < Dim; ++d) {
                EXPECT_EQ(row.separation[d][k], 0);
            }
        }
    }
    for (int i = 0; i < list.size(); ++i) {
        for (const auto& entry : seen[i]) {
            const Pair<Dim>& pair = entry.first;
            const auto& others = seen[pair.j];
            const auto mirrored = std::count_if(others.begin(), others.end(), [&](const auto& other) {
                bool same = other.first.j == i && other.second == entry.second;
                for (int d = 0; d < Dim; ++d) {
                    same = same && other.first.r[d] == -pair.r[d];
                }
                return same;
            });
            EXPECT_GE(mirrored, 1) << i << " sees " << pair.j << " but not the other way round";
        }
    }
    EXPECT_EQ(list.pairs(), pairs);
    if (list.size() > 0) {
        EXPECT_EQ(list.entries(), entries);
    }
    if (pairs == 0) {
        EXPECT_EQ(list.minimum_distance(), infinity);
        EXPECT_EQ(list.closest_particle(), -1);
    } else {
        EXPECT_NEAR(list.minimum_distance(), closest, 1e-15 * closest);
        EXPECT_TRUE(closest_particles.contains(list.closest_particle())) << list.closest_particle();
    }
}

template <class Dimension>
class Neighbours : public testing::Test {
protected:
    static constexpr int dims = Dimension::value;

    /// Builds a list over the points and holds it against all pairs.
    void check(const Box<dims>& box, const Points<dims>& points, double radius, double skin = 0) {
        const double h = radius / kernel.support;
        NeighbourList<dims> list;
        list.build(box, kernel, h, skin, pointers<dims>(points), size<dims>(points));
        EXPECT_DOUBLE_EQ(list.support_radius(), radius);
        expect_pairs<dims>(list, box, points, radius * (1 + skin));
        expect_sound(list, kernel, h);
    }

    Points<dims> scattered(const Box<dims>& box, int count) {
        Points<dims> points;
        for (int d = 0; d < dims; ++d) {
            points[d] = random.values(count, box.low[d], box.high[d]);
        }
        return points;
    }

    /// The box periodic in the directions whose bit is set.
    static Box<dims> mixed(double side, unsigned periodic) {
        Box<dims> box = cube<dims>(side, false);
        for (int d = 0; d < dims; ++d) {
            box.periodic[d] = (periodic >> d & 1U) != 0;
        }
        return box;
    }

    const Kernel& kernel = kernels::find("quintic_spline");
    const int few = dims == 2 ? 400 : 300;
    Random random{20240608};
};

TYPED_TEST_SUITE(Neighbours, Dimensions);

TYPED_TEST(Neighbours, OfScatteredParticlesWithAnyPeriodicity) {
    constexpr int Dim = TypeParam::value;
    for (unsigned periodic = 0; periodic < 1U << Dim; ++periodic) {
        SCOPED_TRACE(periodic);
        const Box<Dim> box = this->mixed(1, periodic);
        this->check(box, this->scattered(box, this->few), 0.16);
        this->check(box, this->scattered(box, this->few), 0.16, 0.1);
    }
}

TYPED_TEST(Neighbours, OfBoxesOfAnyNumberOfCells) {
    constexpr int Dim = TypeParam::value;
    // 1, 1, 2, 2, 3, 3, 4, 7 cells to a side; exactly and not quite
    for (const double radius : {1.0, 0.51, 0.5, 0.4, 1. / 3, 0.26, 0.25, 0.14}) {
        SCOPED_TRACE(radius);
        for (const unsigned periodic : {0U, (1U << Dim) - 1}) {
            const Box<Dim> box = this->mixed(1, periodic);
            this->check(box, this->scattered(box, Dim == 2 ? 150 : 100), radius);
        }
    }
}

TYPED_TEST(Neighbours, OfOpenBoxesNarrowerThanTheSearch) {
    constexpr int Dim = TypeParam::value;
    const Box<Dim> box = this->mixed(1, 0);
    this->check(box, this->scattered(box, 40), 1.3);
    this->check(box, this->scattered(box, 40), 100);
}

TYPED_TEST(Neighbours, RefusePeriodicBoxesNarrowerThanTheSearch) {
    constexpr int Dim = TypeParam::value;
    for (int d = 0; d < Dim; ++d) {
        Box<Dim> box = this->mixed(1, 1U << d);
        const Points<Dim> points = this->scattered(box, 10);
        NeighbourList<Dim> list;
        const double h = 1 / this->kernel.support;
        EXPECT_NO_THROW(list.build(box, this->kernel, h, 0, pointers<Dim>(points), 10));
        EXPECT_THROW(list.build(box, this->kernel, h, 0.01, pointers<Dim>(points), 10), UserError)
            << "second images would be missing";
    }
}

TYPED_TEST(Neighbours, OfLatticesAndJitteredLattices) {
    constexpr int Dim = TypeParam::value;
    const int n = Dim == 2 ? 22 : 9;
    for (const bool periodic : {false, true}) {
        const Box<Dim> box = cube<Dim>(1, periodic);
        Points<Dim> points = lattice<Dim>(box, 1. / n);
        // 3.9 and 4.017 spacings as in the schemes; 3 spacings, where lattice neighbours lie on the very edge
        this->check(box, points, 3.9 / n);
        this->check(box, points, 3.9 / n, 0.03);
        this->check(box, points, 3. / n);
        jitter<Dim>(points, 0.1 / n, 5);
        wrap<Dim>(box, points);
        this->check(box, points, 3.9 / n);
    }
}

TYPED_TEST(Neighbours, OfClusters) {
    constexpr int Dim = TypeParam::value;
    const Box<Dim> box = this->mixed(1, 1);
    Points<Dim> points = this->scattered(box, 30);
    for (int member = 0; member < 200; ++member) {
        std::array<double, Dim> point;
        for (int d = 0; d < Dim; ++d) {
            point[d] = (member % 3 == 0 ? 0.01 : 0.99) + this->random.uniform(-1e-3, 1e-3);
        }
        append<Dim>(points, point);
    }
    this->check(box, points, 0.15);
}

TYPED_TEST(Neighbours, OfCoincidentParticles) {
    constexpr int Dim = TypeParam::value;
    const Box<Dim> box = this->mixed(1, 1);
    Points<Dim> points = this->scattered(box, 20);
    for (int copy = 0; copy < 10; ++copy) {
        std::array<double, Dim> point;
        for (int d = 0; d < Dim; ++d) {
            point[d] = points[d][copy % 3];
        }
        append<Dim>(points, point);
    }
    this->check(box, points, 0.3);
    NeighbourList<Dim> list;
    list.build(box, this->kernel, 0.1, 0, pointers<Dim>(points), 30);
    EXPECT_EQ(list.minimum_distance(), 0);
}

TYPED_TEST(Neighbours, OfParticlesOnFacesAndCellBorders) {
    constexpr int Dim = TypeParam::value;
    // cells of edge 1/4; multiples of 1/8 with their neighbouring floating-point numbers
    std::vector<double> coordinates;
    for (int eighths = 0; eighths < 8; ++eighths) {
        const double x = 0.125 * eighths;
        coordinates.insert(coordinates.end(), {x, std::nextafter(x, 2.)});
        if (x > 0) {
            coordinates.push_back(std::nextafter(x, -1.));
        }
    }
    coordinates.push_back(std::nextafter(1., 0.));
    for (const bool periodic : {false, true}) {
        Points<Dim> points;
        for (int draw = 0; draw < this->few; ++draw) {
            std::array<double, Dim> point;
            for (double& x : point) {
                x = coordinates[static_cast<std::size_t>(
                    this->random.uniform(0, static_cast<double>(coordinates.size())))];
            }
            append<Dim>(points, point);
        }
        if (!periodic) {
            std::array<double, Dim> corner;
            corner.fill(1); // the high face belongs to an open box
            append<Dim>(points, corner);
        }
        this->check(cube<Dim>(1, periodic), points, 0.25);
        this->check(cube<Dim>(1, periodic), points, 0.24);
    }
}

TYPED_TEST(Neighbours, OfOneAndOfTwoParticles) {
    constexpr int Dim = TypeParam::value;
    for (const bool periodic : {false, true}) {
        const Box<Dim> box = cube<Dim>(1, periodic);
        Points<Dim> points = this->scattered(box, 1);
        this->check(box, points, 0.3);
        this->check(box, points, 1); // its own images are exactly at the edge, so no pairs
        std::array<double, Dim> other;
        for (int d = 0; d < Dim; ++d) {
            other[d] = points[d][0] < 0.5 ? points[d][0] + 0.45 : points[d][0] - 0.45;
        }
        append<Dim>(points, other);
        this->check(box, points, 0.3);
        this->check(box, points, 1); // in the periodic box the two meet through several images
    }
}

TYPED_TEST(Neighbours, OfNoParticles) {
    constexpr int Dim = TypeParam::value;
    this->check(cube<Dim>(1, true), Points<Dim>{}, 0.3);
}

TYPED_TEST(Neighbours, OfElongatedBoxes) {
    constexpr int Dim = TypeParam::value;
    for (int along = 0; along < Dim; ++along) {
        Box<Dim> box = this->mixed(1, (1U << Dim) - 1);
        box.high[along] = 1000;
        Points<Dim> points = this->scattered(box, 250);
        for (int k = 0; k < 60; ++k) { // some near neighbours, at the ends and in the middle
            std::array<double, Dim> point;
            for (int d = 0; d < Dim; ++d) {
                point[d] = this->random.uniform(0, 1);
            }
            point[along] = std::array{0.0, 499.0, 999.0}[k % 3] + this->random.uniform(0, 1);
            append<Dim>(points, point);
        }
        this->check(box, points, 0.7);
        this->check(box, points, 0.3);
    }
}

TYPED_TEST(Neighbours, FarFromTheOrigin) {
    constexpr int Dim = TypeParam::value;
    for (const double offset : {1e6, -1e6, -0.5}) {
        for (const bool periodic : {false, true}) {
            Box<Dim> box = cube<Dim>(1, periodic);
            for (int d = 0; d < Dim; ++d) {
                box.low[d] = offset * (1 + d);
                box.high[d] = box.low[d] + 1;
            }
            this->check(box, this->scattered(box, this->few), 0.17);
        }
    }
}

TYPED_TEST(Neighbours, OfMoreThanOneBlockOfParticles) {
    constexpr int Dim = TypeParam::value;
    const Box<Dim> box = this->mixed(1, 2);
    for (const int count : {255, 256, 257, 700}) {
        this->check(box, this->scattered(box, count), 0.1);
    }
}

TYPED_TEST(Neighbours, AreTheSameOnAnyNumberOfCallsToBuild) {
    constexpr int Dim = TypeParam::value;
    const Box<Dim> box = this->mixed(1, (1U << Dim) - 1);
    const Points<Dim> many = this->scattered(box, 700);
    const Points<Dim> fewer = this->scattered(box, 40);
    NeighbourList<Dim> list;
    list.build(box, this->kernel, 0.08, 0.2, pointers<Dim>(many), 700);
    list.build(box, this->kernel, 0.05, 0, pointers<Dim>(fewer), 40); // nothing of the first is left
    expect_pairs<Dim>(list, box, fewer, 0.15);
    expect_sound(list, this->kernel, 0.05);
}

/// Displacements of length `farthest` for one particle in four, shorter for the others.
template <int Dim>
Points<Dim> displacements(Random& random, int count, double farthest) {
    Points<Dim> result;
    for (int i = 0; i < count; ++i) {
        std::array<double, Dim> direction;
        for (double& component : direction) {
            component = random.uniform(-1, 1);
        }
        const double scale = farthest * (i % 4 == 0 ? 1 : random.uniform(0, 1)) / length<Dim>(direction);
        for (double& component : direction) {
            component *= scale;
        }
        append<Dim>(result, direction);
    }
    return result;
}

TYPED_TEST(Neighbours, FollowParticlesAsIfBuiltAfresh) {
    constexpr int Dim = TypeParam::value;
    constexpr double radius = 0.2;
    constexpr double skin = 0.25;
    const double h = radius / this->kernel.support;
    for (unsigned periodic = 0; periodic < 1U << Dim; ++periodic) {
        const Box<Dim> box = this->mixed(1, periodic);
        Points<Dim> points = this->scattered(box, this->few);
        NeighbourList<Dim> list;
        list.build(box, this->kernel, h, skin, pointers<Dim>(points), size<Dim>(points));
        const Points<Dim> moves = displacements<Dim>(this->random, size<Dim>(points), 0.4999 * skin * radius);
        ASSERT_TRUE(list.follow(pointers<Dim>(moves)));
        for (int d = 0; d < Dim; ++d) {
            for (int i = 0; i < size<Dim>(points); ++i) {
                points[d][i] += moves[d][i];
            }
        }
        expect_sound(list, this->kernel, h);
        // Within the support the list is what a fresh one would be; beyond it pairs come and go, with no
        // slope.
        auto expected = all_pairs<Dim>(box, points, radius);
        for (int i = 0; i < list.size(); ++i) {
            const auto row = list.row(i);
            const auto pairs = listed(list, i);
            for (int k = 0; k < row.count; ++k) {
                const bool found = take(expected[i], pairs[k], round_off(box));
                EXPECT_TRUE(found || row.slope[k] == 0) << i << " and " << pairs[k].j;
            }
            EXPECT_TRUE(expected[i].empty()) << "a neighbour of " << i << " is missing";
        }
    }
}

TYPED_TEST(Neighbours, FollowTwoStepsAsWellAsOne) {
    constexpr int Dim = TypeParam::value;
    const Box<Dim> box = this->mixed(1, (1U << Dim) - 1);
    const Points<Dim> points = this->scattered(box, 100);
    NeighbourList<Dim> twice;
    NeighbourList<Dim> once;
    twice.build(box, this->kernel, 0.1, 0.2, pointers<Dim>(points), 100);
    once.build(box, this->kernel, 0.1, 0.2, pointers<Dim>(points), 100);
    const Points<Dim> half = displacements<Dim>(this->random, 100, 0.01);
    Points<Dim> whole = half;
    for (auto& component : whole) {
        std::ranges::transform(component, component.begin(), [](double x) { return 2 * x; });
    }
    ASSERT_TRUE(twice.follow(pointers<Dim>(half)));
    ASSERT_TRUE(twice.follow(pointers<Dim>(half)));
    ASSERT_TRUE(once.follow(pointers<Dim>(whole)));
    for (int i = 0; i < 100; ++i) {
        for (int k = 0; k < once.row(i).count; ++k) {
            for (int d = 0; d < Dim; ++d) {
                EXPECT_NEAR(twice.row(i).separation[d][k], once.row(i).separation[d][k], 1e-15);
            }
        }
    }
}

/// Every bit of a list that a sweep reads.
template <int Dim>
std::vector<double> contents(const NeighbourList<Dim>& list) {
    std::vector<double> all;
    for (int i = 0; i < list.size(); ++i) {
        const auto row = list.row(i);
        all.push_back(row.count);
        all.insert(all.end(), row.index, row.index + row.padded);
        all.insert(all.end(), row.slope, row.slope + row.padded);
        for (int d = 0; d < Dim; ++d) {
            all.insert(all.end(), row.separation[d], row.separation[d] + row.padded);
        }
    }
    all.push_back(list.minimum_distance());
    all.push_back(list.closest_particle());
    return all;
}

TYPED_TEST(Neighbours, RefuseToFollowFartherThanTheSkin) {
    constexpr int Dim = TypeParam::value;
    constexpr double radius = 0.2;
    const double h = radius / this->kernel.support;
    const Box<Dim> box = this->mixed(1, (1U << Dim) - 1);
    const Points<Dim> points = this->scattered(box, this->few);
    for (const double skin : {0.0, 0.1}) {
        NeighbourList<Dim> list;
        list.build(box, this->kernel, h, skin, pointers<Dim>(points), this->few);
        const auto before = contents(list);
        for (const double farthest : {0.5001 * skin * radius + 1e-12, 1.0, infinity, not_a_number}) {
            Points<Dim> moves;
            for (int d = 0; d < Dim; ++d) {
                moves[d].assign(this->few, 0);
            }
            moves[Dim - 1][this->few / 2] = farthest; // one particle is enough
            EXPECT_FALSE(list.follow(pointers<Dim>(moves))) << farthest;
            EXPECT_TRUE(contents(list) == before) << farthest;
        }
    }
}

TYPED_TEST(Neighbours, FollowNoMovementWithoutAChange) {
    constexpr int Dim = TypeParam::value;
    const Box<Dim> box = this->mixed(1, (1U << Dim) - 1);
    const Points<Dim> points = this->scattered(box, this->few);
    NeighbourList<Dim> list;
    list.build(box, this->kernel, 0.07, 0, pointers<Dim>(points), this->few);
    const auto before = contents(list);
    Points<Dim> moves;
    for (int d = 0; d < Dim; ++d) {
        moves[d].assign(this->few, 0);
    }
    EXPECT_TRUE(list.follow(pointers<Dim>(moves)));
    const auto after = contents(list);
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t k = 0; k < after.size(); ++k) {
        EXPECT_NEAR(after[k], before[k], 1e-13 * std::abs(before[k]));
    }
}

TYPED_TEST(Neighbours, SortingKeepsFieldsWithTheirParticles) {
    constexpr int Dim = TypeParam::value;
    constexpr int count = 700;
    const Box<Dim> box = this->mixed(1, (1U << Dim) - 1);
    const Points<Dim> points = this->scattered(box, count);
    Simulation<Dim> scene(box, count);
    scene.kernel = &this->kernel;
    scene.smoothing_length = 0.05;
    Field& tag = scene.particles.field("tag", 2, Lifetime::state, "test");
    Field& scratch = scene.particles.field("scratch", 1, Lifetime::scratch, "test");
    for (int i = 0; i < count; ++i) {
        for (int d = 0; d < Dim; ++d) {
            // some particles lie one box away from their place
            scene.particles.position[d][i] = points[d][i] + (i % 5 == 0 ? 1 : 0) - (i % 7 == 0 ? 1 : 0);
            scene.particles.velocity[d][i] = 10 * i + d;
        }
        tag[0][i] = i;
        tag[1][i] = -i;
        scratch[0][i] = i;
    }
    for (int time = 0; time < 2; ++time) {
        find_neighbours(scene, 0.1);
        std::vector<int> ids = scene.particles.id;
        for (int k = 0; k < count; ++k) {
            const int id = ids[k];
            EXPECT_EQ(tag[0][k], id);
            EXPECT_EQ(tag[1][k], -id);
            EXPECT_EQ(scratch[0][k], k) << "scratch is not sorted";
            for (int d = 0; d < Dim; ++d) {
                EXPECT_EQ(scene.particles.velocity[d][k], 10 * id + d);
                EXPECT_NEAR(scene.particles.position[d][k], points[d][id], 1e-15);
            }
        }
        std::ranges::sort(ids);
        for (int k = 0; k < count; ++k) {
            ASSERT_EQ(ids[k], k);
        }
        for (int k = 1; k < count; ++k) {
            EXPECT_LE(scene.neighbours.grid().cell_of(k - 1), scene.neighbours.grid().cell_of(k));
        }
        Points<Dim> sorted;
        for (int d = 0; d < Dim; ++d) {
            sorted[d] = scene.particles.position.components[d];
        }
        expect_pairs<Dim>(scene.neighbours, box, sorted, 0.15 * 1.1);
        expect_sound(scene.neighbours, this->kernel, 0.05);
    }
}

TYPED_TEST(Neighbours, CellsAreAsWideAsTheSearchAndHoldTheirParticles) {
    constexpr int Dim = TypeParam::value;
    Box<Dim> box = this->mixed(1, 0);
    box.high[1] = 2;
    const Points<Dim> points = this->scattered(box, 500);
    CellGrid<Dim> grid;
    grid.bin(box, 0.3, pointers<Dim>(points), 500);
    EXPECT_EQ(grid.cells()[0], 3);
    EXPECT_EQ(grid.cells()[1], 6);
    EXPECT_EQ(grid.cell_count(), Dim == 2 ? 18 : 54);
    std::vector<int> order(grid.order().begin(), grid.order().end());
    for (std::size_t k = 1; k < order.size(); ++k) {
        const bool later_cell = grid.cell_of(order[k - 1]) < grid.cell_of(order[k]);
        const bool same_cell = grid.cell_of(order[k - 1]) == grid.cell_of(order[k]);
        EXPECT_TRUE(later_cell || (same_cell && order[k - 1] < order[k]));
    }
    for (int i = 0; i < 500; ++i) {
        int cell = 0;
        for (int d = Dim - 1; d >= 0; --d) {
            cell = cell * grid.cells()[d] +
                   static_cast<int>((points[d][i] - box.low[d]) / box.length(d) * grid.cells()[d]);
        }
        EXPECT_EQ(grid.cell_of(i), cell);
    }
    std::ranges::sort(order);
    for (int k = 0; k < 500; ++k) {
        EXPECT_EQ(order[k], k);
    }
}

TYPED_TEST(Neighbours, NeedNoMoreCellsThanParticlesInAHugeBox) {
    constexpr int Dim = TypeParam::value;
    const Box<Dim> box = this->mixed(1e6, (1U << Dim) - 1);
    const Points<Dim> points = this->scattered(box, 100);
    CellGrid<Dim> grid;
    grid.bin(box, 1e-3, pointers<Dim>(points), 100);
    EXPECT_LE(grid.cell_count(), 100 * 5 * 5 * 5);
}

} // namespace
} // namespace sphvv::solver
