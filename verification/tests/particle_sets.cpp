// The arrangements on which operators are studied.
#include "sphvv/verification/operator_fields.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>

namespace sphvv::verification {
namespace {

using std::numbers::pi;

template <int Dim>
double total_volume(const ParticleSet<Dim>& set) {
    return std::accumulate(set.volume.begin(), set.volume.end(), 0.0);
}

template <int Dim>
OperatorScene<Dim> scene_of(ParticleSet<Dim> set, double h_over_dx = 1.3) {
    const double h = h_over_dx * set.dx;
    return {std::move(set), solver::kernels::find("quintic_spline"), h};
}

/// Over dx.
template <int Dim>
double minimum_spacing(const ParticleSet<Dim>& set) {
    return scene_of<Dim>(set).neighbours.minimum_distance() / set.dx;
}

/// Settled sets take a second in three dimensions: one for all tests.
template <int Dim>
const ParticleSet<Dim>& first_set(Arrangement arrangement) {
    static std::map<Arrangement, ParticleSet<Dim>> sets;
    const auto found = sets.find(arrangement);
    return found != sets.end()
               ? found->second
               : sets.emplace(arrangement, particle_set<Dim>(arrangement, settled_tile<Dim>, 0, 1))
                     .first->second;
}

template <class Dimension>
class ParticleSets : public testing::Test {
protected:
    /// A multiple of the tile of a settled arrangement.
    static constexpr int n = settled_tile<Dimension::value>;
    static int power(int base) { return static_cast<int>(std::lround(std::pow(base, Dimension::value))); }
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(ParticleSets, Dimensions);

TYPED_TEST(ParticleSets, PeriodicOnesShareTheBoxEvenlyAndAreJudgedEverywhere) {
    constexpr int dim = TypeParam::value;
    for (const Arrangement arrangement :
         {Arrangement::square, Arrangement::hexagonal, Arrangement::jittered_5, Arrangement::jittered_10,
          Arrangement::jittered_20, Arrangement::settled, Arrangement::random}) {
        SCOPED_TRACE(to_string(arrangement));
        const ParticleSet<dim>& set = first_set<dim>(arrangement);
        EXPECT_DOUBLE_EQ(set.dx, 1.0 / this->n);
        if (arrangement != Arrangement::hexagonal) {
            EXPECT_EQ(set.size(), this->power(this->n));
            EXPECT_DOUBLE_EQ(set.box.volume(), 1);
        }
        EXPECT_NEAR(total_volume(set), set.box.volume(), 1e-12);
        // the closest whole number of cells, the longest of which is sqrt(3) 1.0746 dx or 4^(1/3) dx
        for (int d = 0; d < dim; ++d) {
            EXPECT_TRUE(set.box.periodic[d]);
            EXPECT_NEAR(set.box.length(d), 1, 0.94 * set.dx);
        }
        for (const double V : set.volume) {
            EXPECT_NEAR(V, std::pow(set.dx, dim), 1e-12 * V);
        }
        std::vector<int> everywhere(set.size());
        std::iota(everywhere.begin(), everywhere.end(), 0);
        EXPECT_EQ(set.judged, everywhere);
        for (int d = 0; d < dim; ++d) {
            ASSERT_EQ(set.points[d].size(), set.volume.size());
            const auto [low, high] = std::minmax_element(set.points[d].begin(), set.points[d].end());
            EXPECT_GE(*low, set.box.low[d]);
            EXPECT_LT(*high, set.box.high[d]);
        }
    }
}

TYPED_TEST(ParticleSets, LatticesAreTheirOwnMirrorImage) {
    constexpr int dim = TypeParam::value;
    for (const Arrangement arrangement : all_arrangements()) {
        if (is_truncated(arrangement)) {
            continue;
        }
        SCOPED_TRACE(to_string(arrangement));
        const OperatorScene<dim> scene = scene_of<dim>(first_set<dim>(arrangement));
        int unmatched = 0;
        for (int i = 0; i < scene.set.size(); i += 7) {
            const auto row = scene.neighbours.row(i);
            for (int k = 0; k < row.count; ++k) {
                bool found = false;
                for (int m = 0; m < row.count && !found; ++m) {
                    double squared = 0;
                    for (int d = 0; d < dim; ++d) {
                        squared += std::pow(row.separation[d][k] + row.separation[d][m], 2);
                    }
                    found = std::sqrt(squared) < 1e-9 * scene.set.dx;
                }
                unmatched += found ? 0 : 1;
            }
        }
        EXPECT_EQ(unmatched == 0, is_lattice(arrangement));
    }
}

// Two supports from the surface: the supports of the judged ones are full, and so are those of their
// neighbours.
TYPED_TEST(ParticleSets, ABlockIsJudgedWhereSupportsAreThoseOfTheWholeArrangement) {
    constexpr int dim = TypeParam::value;
    constexpr int spacings = 64;
    const double margin = 2 * 3 * 1.3 / spacings;
    for (const Arrangement arrangement : {Arrangement::square, Arrangement::jittered_20, Arrangement::settled,
                                          Arrangement::random, Arrangement::polar}) {
        SCOPED_TRACE(to_string(arrangement));
        if (dim == 2 && arrangement == Arrangement::polar) {
            continue; // a set of rings is its own slice
        }
        const OperatorScene<dim> scene = scene_of<dim>(particle_block<dim>(arrangement, spacings, margin, 1));
        const ParticleSet<dim>& set = scene.set;
        EXPECT_DOUBLE_EQ(set.dx, 1.0 / spacings);
        const bool rings = arrangement == Arrangement::polar;
        const double expected = rings ? 3 * std::numbers::pi * 23.5 * 23.5 : this->power(dim == 2 ? 8 : 12);
        if (arrangement == Arrangement::square) {
            EXPECT_EQ(set.judged.size(), static_cast<std::size_t>(this->power(dim == 2 ? 8 : 12)));
        } else if (arrangement != Arrangement::settled) { // whose blocks are whole tiles
            EXPECT_NEAR(static_cast<double>(set.judged.size()), expected,
                        rings ? 0.02 * expected : 0.5 * expected);
        }
        std::vector<char> reached(set.size(), 0);
        double sum = 0;
        for (const int i : set.judged) {
            const auto row = scene.neighbours.row(i);
            reached[i] = 1;
            for (int k = 0; k < row.count; ++k) {
                reached[row.index[k]] = 1;
            }
            for (int d = 0; d < dim; ++d) {
                sum += set.points[d][i] / static_cast<double>(set.judged.size());
            }
        }
        if (!rings) {
            EXPECT_NEAR(std::sin(2 * std::numbers::pi * sum + 0.3),
                        std::cos(2 * std::numbers::pi * sum + 0.3), 0.2);
        }
        // A shell of the support's width lies outside of everything that is read at first hand.
        for (int d = 0; d < dim; ++d) {
            const auto [low, high] = std::minmax_element(set.points[d].begin(), set.points[d].end());
            for (int i = 0; i < set.size(); ++i) {
                if (reached[i]) {
                    EXPECT_GT(set.points[d][i] - *low, margin / 2 - 1.3 * set.dx);
                    EXPECT_GT(*high - set.points[d][i], margin / 2 - 1.3 * set.dx);
                }
            }
            EXPECT_DOUBLE_EQ(set.box.length(d), 1);
            EXPECT_GE(*low, set.box.low[d]);
            EXPECT_LE(*high, set.box.high[d]);
        }
    }
    EXPECT_THROW(particle_block<dim>(Arrangement::edge, spacings, margin, 1), std::invalid_argument);
    EXPECT_THROW(particle_block<dim>(Arrangement::hexagonal, spacings, margin, 1), std::invalid_argument);
    EXPECT_THROW(particle_block<dim>(Arrangement::jittered_20, 20, 7.8 / 20, 1), std::invalid_argument);
}

// Nearest neighbours of the triangular and of the face-centred cubic lattice; six and twelve of them.
TYPED_TEST(ParticleSets, TheHexagonalLatticeIsTheClosestPacking) {
    constexpr int dim = TypeParam::value;
    const OperatorScene<dim> scene = scene_of<dim>(particle_set<dim>(Arrangement::hexagonal, this->n, 0, 0));
    const double spacing = (dim == 2 ? std::sqrt(2 / std::sqrt(3.0)) : std::pow(2.0, 1.0 / 6)) * scene.set.dx;
    EXPECT_NEAR(scene.neighbours.minimum_distance(), spacing, 1e-12);
    for (int i = 0; i < scene.set.size(); ++i) {
        const auto row = scene.neighbours.row(i);
        int nearest = 0;
        for (int k = 0; k < row.count; ++k) {
            double squared = 0;
            for (int d = 0; d < dim; ++d) {
                squared += std::pow(row.separation[d][k], 2);
            }
            nearest += std::sqrt(squared) < 1.001 * spacing ? 1 : 0;
        }
        ASSERT_EQ(nearest, dim == 2 ? 6 : 12) << i;
    }
}

TYPED_TEST(ParticleSets, JitterIsOfTheStatedSize) {
    constexpr int dim = TypeParam::value;
    const ParticleSet<dim> lattice = particle_set<dim>(Arrangement::square, this->n, 0, 0);
    for (const auto& [arrangement, share] :
         {std::pair{Arrangement::jittered_5, 0.05}, std::pair{Arrangement::jittered_10, 0.1},
          std::pair{Arrangement::jittered_20, 0.2}}) {
        const ParticleSet<dim> set = particle_set<dim>(arrangement, this->n, 0, 11);
        double largest = 0;
        double sum = 0;
        for (int d = 0; d < dim; ++d) {
            for (int i = 0; i < set.size(); ++i) {
                const double moved = (set.points[d][i] - lattice.points[d][i]) / set.dx;
                largest = std::max(largest, std::abs(moved));
                sum += moved;
            }
        }
        EXPECT_LE(largest, share * (1 + 1e-12));
        EXPECT_GT(largest, 0.98 * share);
        EXPECT_LT(std::abs(sum) / (dim * set.size()), 0.1 * share) << "displaced as a whole";
    }
}

TYPED_TEST(ParticleSets, SettledOnesHaveNoClosePairsAndAreSelfSimilar) {
    constexpr int dim = TypeParam::value;
    const ParticleSet<dim>& one = first_set<dim>(Arrangement::settled);
    const ParticleSet<dim> two = particle_set<dim>(Arrangement::settled, 2 * this->n, 0, 1);
    const double spacing = minimum_spacing<dim>(one);
    EXPECT_GT(spacing, 1.1 * minimum_spacing<dim>(first_set<dim>(Arrangement::jittered_20)));
    EXPECT_LT(spacing, 1.1) << "the closest packing has 1.07 (2-D), 1.12 (3-D)";
    EXPECT_NEAR(minimum_spacing<dim>(two), spacing, 1e-9);
    // Every tile is the same.
    ASSERT_EQ(two.size(), this->power(2) * one.size());
    for (int d = 0; d < dim; ++d) {
        for (int i = 0; i < two.size(); ++i) {
            const double in_tile = 2 * two.points[d][i];
            ASSERT_NEAR(in_tile - std::floor(in_tile), one.points[d][i % one.size()], 1e-12);
        }
    }
    EXPECT_THROW((particle_set<dim>(Arrangement::settled, this->n + 1, 0, 1)), std::invalid_argument);
}

TYPED_TEST(ParticleSets, PolarRingsFillADisc) {
    constexpr int dim = TypeParam::value;
    for (const int spacings : {this->n, 2 * this->n}) {
        const double dx = 1.0 / spacings;
        const double margin = 3.9 * dx;
        const ParticleSet<dim> set = particle_set<dim>(Arrangement::polar, spacings, margin, 2);
        const double radius = 0.5 - 0.5 * dx; // half a spacing beyond the last ring
        EXPECT_NEAR(total_volume(set), pi * radius * radius, 1e-12);
        std::set<int> judged(set.judged.begin(), set.judged.end());
        EXPECT_EQ(judged.size(), set.judged.size());
        EXPECT_FALSE(judged.empty());
        for (int i = 0; i < set.size(); ++i) {
            const double r = std::hypot(set.points[0][i] - 0.5, set.points[1][i] - 0.5);
            const double ring = r / dx;
            ASSERT_NEAR(ring, std::round(ring), 1e-9);
            ASSERT_LT(r, radius);
            ASSERT_EQ(judged.contains(i), radius - std::round(ring) * dx > margin) << "ring " << ring;
        }
        EXPECT_FALSE(set.box.periodic[0]);
        EXPECT_FALSE(set.box.periodic[1]);
        EXPECT_EQ(set.box.periodic[dim - 1], dim == 3);
    }
}

TYPED_TEST(ParticleSets, TruncatedOnesAreJudgedAtOneParticleInTheSamePlace) {
    constexpr int dim = TypeParam::value;
    for (const Arrangement arrangement : {Arrangement::edge, Arrangement::corner}) {
        SCOPED_TRACE(to_string(arrangement));
        std::array<double, dim> place{};
        for (const int spacings : {160, 640}) {
            const ParticleSet<dim> set = particle_set<dim>(arrangement, spacings, 0, 0);
            ASSERT_EQ(set.judged.size(), 1U);
            const int i = set.judged[0];
            // The other particles lie to one side in the first direction (in all, in a corner), and reach
            // further than a support of 3 * 1.8 dx.
            for (int d = 0; d < dim; ++d) {
                const auto [low, high] = std::minmax_element(set.points[d].begin(), set.points[d].end());
                EXPECT_GE(*low, set.box.low[d]);
                EXPECT_LE(*high, set.box.high[d]);
                const double here = set.points[d][i];
                if (d == 0 || arrangement == Arrangement::corner) {
                    EXPECT_EQ(*low, here);
                } else {
                    EXPECT_GT(here - *low, 5.4 * set.dx);
                }
                EXPECT_GT(*high - here, 5.4 * set.dx);
                if (spacings == 160) {
                    place[d] = here;
                }
                EXPECT_EQ(here, place[d]);
                EXPECT_FALSE(set.box.periodic[d]);
            }
            for (const double V : set.volume) {
                ASSERT_DOUBLE_EQ(V, std::pow(set.dx, dim));
            }
        }
    }
}

TYPED_TEST(ParticleSets, DependOnTheSeedExactlyIfTheyAreRandom) {
    constexpr int dim = TypeParam::value;
    for (const Arrangement arrangement : all_arrangements()) {
        SCOPED_TRACE(to_string(arrangement));
        const int spacings = is_truncated(arrangement) ? 160 : static_cast<int>(this->n);
        const ParticleSet<dim> first = is_truncated(arrangement)
                                           ? particle_set<dim>(arrangement, spacings, 0, 1)
                                           : first_set<dim>(arrangement);
        const ParticleSet<dim> again = particle_set<dim>(arrangement, spacings, 0, 1);
        const ParticleSet<dim> other = particle_set<dim>(arrangement, spacings, 0, 2);
        EXPECT_EQ(first.points, again.points);
        EXPECT_EQ(first.volume, again.volume);
        EXPECT_EQ(first.judged, again.judged);
        EXPECT_EQ(first.points != other.points, is_random(arrangement));
    }
}

TEST(Arrangements, HaveNamesOfTheirOwn) {
    std::set<std::string_view> names;
    for (const Arrangement arrangement : all_arrangements()) {
        EXPECT_FALSE(to_string(arrangement).empty());
        EXPECT_TRUE(names.insert(to_string(arrangement)).second) << to_string(arrangement);
    }
    EXPECT_EQ(names.size(), 10U);
    EXPECT_EQ(to_string(Arrangement::corner), "corner");
    EXPECT_EQ(to_string(Arrangement::jittered_20), "jittered 20 %");
}

} // namespace
} // namespace sphvv::verification
