// Walls of points that push particles away.
//   solver_repulsion --gtest_filter='Repulsion.*'
#include "sphvv/solver/boundaries/repulsion.hpp"

#include "sphvv/solver/boundaries/shapes/plane.hpp"
#include "sphvv/solver/tests/scenes.hpp"

#include <gtest/gtest.h>
#include <omp.h>

namespace sphvv::solver {
namespace {

using namespace scenes;

constexpr double D = 3;    // m2/s2
constexpr double r0 = 0.1; // m
constexpr double rc = lennard_jones_cut * r0;

/// D [r0^4/(4 r^4) - r0^2/(2 r^2) + 1/4], which is 0 from r0 on: that of f1.
double power_law_potential(double r) {
    const double q = std::min(r / r0, 1.);
    return D * (1 / (4 * std::pow(q, 4)) - 1 / (2 * q * q) + 0.25);
}

/// The same of the Lennard-Jones force: A s^3/3 + B s^2/2, s = r0 - r, down to r_c, from where it goes on
/// with D [(r0/r)^11/11 - (r0/r)^5/5].
double lennard_jones_potential(double r) {
    const double q = lennard_jones_cut;
    const RepulsionTail tail =
        RepulsionTail::after(D / r0 * (std::pow(q, -12) - std::pow(q, -6)),
                             D / r0 / r0 * (6 * std::pow(q, -7) - 12 * std::pow(q, -13)), r0 - rc);
    const auto of_tail = [&](double s) { return tail.square * s * s * s / 3 + tail.linear * s * s / 2; };
    const auto beneath = [](double x) { return D * (std::pow(x, -11) / 11 - std::pow(x, -5) / 5); };
    return r >= r0 ? 0 : r >= rc ? of_tail(r0 - r) : of_tail(r0 - rc) + beneath(r / r0) - beneath(q);
}

using Force = double (*)(double r, double strength, double range);
using Potential = double (*)(double r);

struct Radial {
    RepulsiveForm form;
    Force force;
    Potential potential;
};
const std::array<Radial, 2> radial_forms{
    Radial{RepulsiveForm::radial, power_law_repulsion, power_law_potential},
    Radial{RepulsiveForm::lennard_jones, lennard_jones_repulsion, lennard_jones_potential}};

TEST(Forces, AreMinusTheGradientsOfTheirPotentials) {
    for (const Radial& radial : radial_forms) {
        for (const double q : {0.5, 0.6, 0.8, 0.9, 0.94, 0.96, 0.98, 0.999, 1.001, 1.5}) {
            const double step = 1e-6 * r0;
            const double gradient =
                (radial.potential(q * r0 + step) - radial.potential(q * r0 - step)) / (2 * step);
            const double force = radial.force(q * r0, D, r0);
            EXPECT_NEAR(force, -gradient, 1e-6 * (D / r0 + force)) << q;
        }
    }
}

TEST(Forces, AreContinuousAndEndAtTheRange) {
    for (const Radial& radial : radial_forms) {
        EXPECT_NEAR(radial.force(r0 * (1 - 1e-12), D, r0), 0, 1e-9 * D / r0);
        EXPECT_EQ(radial.force(r0, D, r0), 0);
        EXPECT_EQ(radial.force(2 * r0, D, r0), 0);
        for (int k = 30; k < 100; ++k) {
            EXPECT_GT(radial.force(0.01 * k * r0, D, r0), radial.force(0.01 * (k + 1) * r0, D, r0))
                << "never attracts";
        }
    }
    const double step = 1e-7 * r0;
    const auto force = [](double r) { return lennard_jones_repulsion(r, D, r0); };
    EXPECT_NEAR(force(rc + 1e-12 * r0), force(rc - 1e-12 * r0), 1e-9 * D / r0);
    const double above = (force(rc + 2 * step) - force(rc + step)) / step;
    const double below = (force(rc - step) - force(rc - 2 * step)) / step;
    EXPECT_NEAR(above, below, 1e-4 * D / r0 / r0);
}

TEST(Tail, HasTheValueAndTheSlopeItGoesOnFrom) {
    const double length = 0.3;
    const RepulsionTail tail = RepulsionTail::after(1.7, -20, length);
    EXPECT_NEAR(tail.square * length * length + tail.linear * length, 1.7, 1e-13);
    EXPECT_NEAR(-2 * tail.square * length - tail.linear, -20, 1e-12);
}

/// A bed y = 0 in a strip ten r0 wide, periodic along x (and z), with points from which x = (k + 1/2)
/// r0/per_dx.
template <int Dim>
struct Bed {
    Bed(RepulsiveForm form, int per_dx, double speed = 0)
        : box(cube<Dim>(10 * r0, true)), walls{shapes::plane<Dim>("bed", Vector<Dim>::Zero(),
                                                                  Vector<Dim>::Unit(1), Slip::free_slip)},
          repulsion({form, D, r0, per_dx}, points(per_dx), open(box)) {
        if (speed != 0) {
            walls[0].displacement = [speed](double t) {
                return Vector<Dim>(t * speed * Vector<Dim>::Unit(1));
            };
        }
    }
    static Box<Dim> open(Box<Dim>& box) {
        box.periodic[1] = false;
        return box;
    }
    static std::vector<WallParticle<Dim>> points(int per_dx) {
        std::vector<WallParticle<Dim>> all;
        const int count = 10 * per_dx;
        for (int i = 0; i < (Dim == 2 ? count : count * count); ++i) {
            Vector<Dim> x = Vector<Dim>::Zero();
            x[0] = (i % count + 0.5) * r0 / per_dx;
            if constexpr (Dim == 3) {
                x[2] = (i / count + 0.5) * r0 / per_dx;
            }
            all.push_back({0, x});
        }
        return all;
    }
    Vector<Dim> at(const Vector<Dim>& x, double t = 0) const { return repulsion.acceleration(walls, x, t); }

    Box<Dim> box;
    std::vector<Wall<Dim>> walls;
    Repulsion<Dim> repulsion;
};

/// By its definition, over points from -infinity to infinity.
Vector<2> sum_over_points(Force force, int per_dx, const Vector<2>& x) {
    Vector<2> total = Vector<2>::Zero();
    for (int k = -20 * per_dx; k < 20 * per_dx; ++k) {
        const Vector<2> s = x - Vector<2>((k + 0.5) * r0 / per_dx, 0);
        total += force(s.norm(), D, r0) / per_dx * s.normalized();
    }
    return total;
}

TEST(Repulsion, IsTheSumOverThePoints) {
    Random random(7);
    for (const Radial& radial : radial_forms) {
        for (const int per_dx : {1, 4}) {
            const Bed<2> bed(radial.form, per_dx);
            for (int trial = 0; trial < 200; ++trial) {
                const Vector<2> x(random.uniform(-r0, 11 * r0), random.uniform(0.3 * r0, 1.2 * r0));
                const Vector<2> expected = sum_over_points(radial.force, per_dx, x);
                EXPECT_NEAR((bed.at(x) - expected).norm(), 0, 1e-10 * (D / r0 + expected.norm())) << x[0];
            }
        }
    }
}

// The shares P of the points add up to one.
TEST(Repulsion, AlongTheNormalIsThatOfASmoothWall) {
    Random random(8);
    in_2d_and_3d([&](auto dimension) {
        constexpr int Dim = dimension;
        for (const int per_dx : {1, 3}) {
            const Bed<Dim> bed(RepulsiveForm::normal, per_dx);
            for (int trial = 0; trial < 50; ++trial) {
                Vector<Dim> x = Vector<Dim>::Zero();
                for (int d = 0; d < Dim; ++d) {
                    x[d] = random.uniform(0, 10 * r0);
                }
                x[1] = random.uniform(0.4 * r0, 1.1 * r0);
                const double expected = power_law_repulsion(x[1], D, r0);
                const Vector<Dim> force = bed.at(x);
                EXPECT_NEAR(force[1], expected, 1e-11 * (D / r0 + expected));
                for (int d = 0; d < Dim; ++d) {
                    EXPECT_TRUE(d == 1 || force[d] == 0) << force[d];
                }
            }
        }
    });
}

// Whatever the wall's direction: points 45 degrees to the axes are as far as sqrt(2) r0 from a particle.
TEST(Repulsion, AlongTheNormalOfASlopeIsThatOfASmoothWall) {
    const Vector<2> n = Vector<2>(1, 1).normalized();
    const Vector<2> t(n[1], -n[0]);
    const std::vector<Wall<2>> walls{shapes::plane<2>("slope", Vector<2>::Zero(), n, Slip::free_slip)};
    std::vector<WallParticle<2>> points;
    for (int k = -20; k <= 20; ++k) {
        points.push_back({0, k * r0 * t});
    }
    const Repulsion<2> repulsion({RepulsiveForm::normal, D, r0}, points, cube<2>(1, false));
    Random random(10);
    for (int trial = 0; trial < 2000; ++trial) {
        const double y = random.uniform(0.4 * r0, r0);
        const Vector<2> x = random.uniform(-10 * r0, 10 * r0) * t + y * n;
        const Vector<2> expected = power_law_repulsion(y, D, r0) * n;
        EXPECT_NEAR((repulsion.acceleration(walls, x, 0) - expected).norm(), 0,
                    1e-11 * (D / r0 + expected.norm()));
    }
}

/// Largest less smallest normal force along the wall, and the largest along it, over the mean normal force.
std::array<double, 2> ripple(RepulsiveForm form, int per_dx, double y) {
    constexpr int samples = 400;
    const Bed<2> bed(form, per_dx);
    double low = infinity;
    double high = -infinity;
    double mean = 0;
    double along = 0;
    for (int k = 0; k < samples; ++k) {
        const Vector<2> force = bed.at({(3 + static_cast<double>(k) / samples / per_dx) * r0, y});
        low = std::min(low, force[1]);
        high = std::max(high, force[1]);
        mean += force[1] / samples;
        along = std::max(along, std::abs(force[0]));
    }
    return {(high - low) / mean, along / mean};
}

// Along the wall the force of a point, as a function of its place, ends at ±a with kinks of the slope J =
// |F'(r0)| (a/r0) (y/r0). By Poisson's summation, points r0/k apart leave the transform of that function at w
// = 2 pi k/r0 as a ripple, to which the kinks give 2 J cos(w a)/w^2: 16 times less with 4 times the points.
// The smooth rest falls faster.
TEST(Repulsion, UndulatesSixteenTimesLessWithFourTimesThePoints) {
    for (const Radial& radial : radial_forms) {
        for (const double y : {0.7 * r0, 0.8 * r0, 0.9 * r0}) {
            const auto [normal, along] = ripple(radial.form, 1, y);
            const auto [denser_normal, denser_along] = ripple(radial.form, 4, y);
            EXPECT_GT(normal, 1) << "one point to a spacing: all of the force";
            EXPECT_GT(along, 0.25);
            EXPECT_LT(denser_normal, normal / 16);
            EXPECT_LT(denser_along, along / 16);
        }
    }
    const auto [normal, along] = ripple(RepulsiveForm::normal, 1, 0.8 * r0);
    EXPECT_LT(normal, 1e-12);
    EXPECT_EQ(along, 0);
}

TEST(Repulsion, MovesWithItsWall) {
    for (const auto form : {RepulsiveForm::radial, RepulsiveForm::lennard_jones, RepulsiveForm::normal}) {
        const Bed<2> at_rest(form, 1);
        const Bed<2> rising(form, 1, 0.5);
        const Vector<2> x(0.37, 0.7 * r0);
        const double t = 0.3;
        EXPECT_GT(at_rest.at(x).norm(), 0);
        EXPECT_NEAR((rising.at(x + Vector<2>(0, 0.5 * t), t) - at_rest.at(x)).norm(), 0, 1e-10 * D / r0);
        EXPECT_EQ(at_rest.at({0.37, 1.001 * r0}).norm(), 0);
    }
}

/// A particle in flight: u and then r by half a force, a step, and half a force (velocity Verlet, 2nd order).
struct Flight {
    Vector<2> x;
    Vector<2> u;

    void step(const Bed<2>& bed, double dt, const Vector<2>& gravity = Vector<2>::Zero()) {
        u += dt / 2 * (bed.at(x) + gravity);
        x += dt * u;
        u += dt / 2 * (bed.at(x) + gravity);
    }
};

/// Thrown from r0 above the bed, until it is back there or through.
Flight thrown(const Bed<2>& bed, const Vector<2>& from, const Vector<2>& speed, double dt) {
    Flight flight{from, speed};
    do {
        flight.step(bed, dt);
    } while (flight.x[1] > 0 && flight.x[1] < from[1]);
    return flight;
}

// Between two points the barrier is lowest: 2 V(r0/2), as the next are 3/2 r0 away.
TEST(Repulsion, TurnsBackWhatHasLessEnergyThanItsBarrier) {
    for (const Radial& radial : radial_forms) {
        const Bed<2> bed(radial.form, 1);
        const double barrier = 2 * radial.potential(r0 / 2);
        const Vector<2> between(5 * r0, 1.01 * r0);
        const double dt = 1e-5 * r0;
        const auto falls_with = [&](double energy) {
            return thrown(bed, between, {0, -std::sqrt(2 * energy)}, dt / std::sqrt(barrier));
        };
        EXPECT_GT(falls_with(0.98 * barrier).x[1], 0);
        EXPECT_LT(falls_with(1.02 * barrier).x[1], 0) << "what has more goes through";
    }
}

TEST(Repulsion, ConservesEnergyToTheOrderOfTheIntegrator) {
    for (const Radial& radial : radial_forms) {
        const Bed<2> bed(radial.form, 1);
        const auto energy = [&](const Flight& f) {
            double total = f.u.squaredNorm() / 2;
            for (int k = -3; k < 13; ++k) {
                total += radial.potential((f.x - Vector<2>((k + 0.5) * r0, 0)).norm());
            }
            return total;
        };
        // On the way: the integrator is symmetric in time, and once the particle is back the error is too
        // small to show its order.
        const auto gain = [&](double dt, int steps) {
            Flight flight{{5.2 * r0, 1.01 * r0}, {0.3, -1.5}};
            const double start = energy(flight);
            for (int k = 0; k < steps; ++k) {
                flight.step(bed, dt);
            }
            EXPECT_LT(flight.x[1], r0);
            return std::abs(energy(flight) - start);
        };
        const double coarse = gain(4e-4, 50);
        EXPECT_NEAR(std::log2(coarse / gain(2e-4, 100)), 2, 0.15);
        const Flight back = thrown(bed, {5.2 * r0, 1.01 * r0}, {0.3, -1.5}, 1e-5);
        EXPECT_GT(back.x[1], r0);
        EXPECT_NEAR(energy(back), (0.3 * 0.3 + 1.5 * 1.5) / 2, 1e-4);
    }
    const Flight back = thrown(Bed<2>(RepulsiveForm::normal, 1), {5.2 * r0, 1.01 * r0}, {0.3, -1.5}, 1e-5);
    EXPECT_EQ(back.u[0], 0.3) << "a smooth wall";
    EXPECT_NEAR(back.u[1], 1.5, 1e-4);
}

// Above a point, and along the normal anywhere, the weight is held where F(y) = g.
TEST(Repulsion, HoldsAParticleWhereItsForceIsTheWeight) {
    const double g = 12;
    const auto height = [&](Force force) {
        double low = 0.1 * r0;
        double high = r0;
        while (high - low > 1e-13) {
            (force((low + high) / 2, D, r0) > g ? low : high) = (low + high) / 2;
        }
        return low;
    };
    const auto rests_at = [&](RepulsiveForm form, double x) {
        const Bed<2> bed(form, 1);
        Flight flight{{x, r0}, {0, 0}};
        for (int k = 0; k < 20000; ++k) {
            flight.step(bed, 1e-4, {0, -g});
            flight.u *= 0.99;
        }
        return flight.x[1];
    };
    EXPECT_NEAR(rests_at(RepulsiveForm::radial, 4.5 * r0), height(power_law_repulsion), 1e-9);
    EXPECT_NEAR(rests_at(RepulsiveForm::lennard_jones, 4.5 * r0), height(lennard_jones_repulsion), 1e-9);
    EXPECT_NEAR(rests_at(RepulsiveForm::normal, 4.2 * r0), height(power_law_repulsion), 1e-9);
}

TEST(Repulsion, IsTheSameOnAnyNumberOfThreads) {
    const int before = omp_get_max_threads();
    const Bed<3> bed(RepulsiveForm::radial, 2);
    Random random(9);
    Particles<3> particles(5000);
    Field& a = particles.field("acceleration", 3, Lifetime::scratch, "test");
    for (int d = 0; d < 3; ++d) {
        particles.position.components[d] = random.values(5000, 0, d == 1 ? 2 * r0 : 10 * r0);
    }
    omp_set_num_threads(1);
    bed.repulsion.add_to(a, bed.walls, particles, 0);
    const auto alone = a.components;
    EXPECT_GT(largest_norm<3>(a), 0);
    for (auto& component : a.components) {
        std::ranges::fill(component, 0.);
    }
    omp_set_num_threads(2);
    bed.repulsion.add_to(a, bed.walls, particles, 0);
    omp_set_num_threads(before);
    EXPECT_EQ(alone, a.components);
}

} // namespace
} // namespace sphvv::solver
