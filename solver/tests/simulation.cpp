// What every scene has whatever its scheme: stepping, survival, wrapping, and sums that do not depend on
// threads.
#include "sphvv/solver/simulation.hpp"

#include "sphvv/solver/tests/scenes.hpp"

#include <gtest/gtest.h>
#include <omp.h>

namespace sphvv::solver {
namespace {

using namespace scenes;

/// The diagnosis that the action ends with, or "" if the run survives it.
template <class Action>
std::string diagnosis(const Action& action) {
    try {
        action();
    } catch (const Diverged& reason) {
        return reason.what();
    }
    return "";
}

void expect_mentions(const std::string& text, const std::vector<std::string>& words) {
    for (const std::string& word : words) {
        EXPECT_NE(text.find(word), std::string::npos) << '"' << word << "\" is not in: " << text;
    }
}

/// Particles without a scheme, in the unit box; their ids are 100, 101, ….
template <int Dim>
Simulation<Dim> scene_of(const Points<Dim>& points, bool periodic = true) {
    Simulation<Dim> scene(cube<Dim>(1, periodic), points[0].size());
    for (int d = 0; d < Dim; ++d) {
        scene.particles.position.components[d] = points[d];
    }
    for (int& id : scene.particles.id) {
        id += 100;
    }
    scene.kernel = &kernels::find("quintic_spline");
    scene.smoothing_length = 0.1;
    scene.particle_spacing = 0.1;
    scene.particle_mass = 0.5;
    scene.end_time = 1;
    return scene;
}

template <class Dimension>
class SimulationTest : public testing::Test {};

TYPED_TEST_SUITE(SimulationTest, Dimensions);

// Stepping.

TYPED_TEST(SimulationTest, RunsItsStagesInOrderAndBooksTheirWork) {
    constexpr int Dim = TypeParam::value;
    Random random(31);
    Points<Dim> points;
    for (int d = 0; d < Dim; ++d) {
        points[d] = random.values(60, 0, 1);
    }
    Simulation<Dim> scene = scene_of<Dim>(points);
    std::string order;
    scene.add_stage("first", [&](Simulation<Dim>& s) {
        order += "1";
        s.time_step = 0.25;
        find_neighbours(s, 0);
        s.count_sweeps(2);
    });
    scene.add_stage("second", [&](Simulation<Dim>& s) {
        order += "2";
        s.count_sweeps(3);
    });
    for (int step = 1; step <= 4; ++step) {
        advance(scene);
        EXPECT_EQ(scene.step, step);
        EXPECT_DOUBLE_EQ(scene.time, 0.25 * step);
    }
    EXPECT_EQ(order, "12121212");
    const std::int64_t pairs = scene.neighbours.pairs();
    EXPECT_GT(pairs, 0);
    EXPECT_EQ(scene.stages[0].pair_evaluations, 8 * pairs);
    EXPECT_EQ(scene.stages[1].pair_evaluations, 12 * pairs);
    EXPECT_EQ(scene.work.pair_evaluations, 20 * pairs);
    EXPECT_EQ(scene.work.particle_steps, 4 * 60);
}

TYPED_TEST(SimulationTest, TakesEvenStepsToTheEndTime) {
    constexpr int Dim = TypeParam::value;
    Simulation<Dim> scene = scene_of<Dim>({});
    EXPECT_EQ(even_step(scene, 2), 1) << "no longer than what is left";
    EXPECT_EQ(even_step(scene, infinity), 1);
    EXPECT_EQ(even_step(scene, 1), 1);
    EXPECT_EQ(even_step(scene, 0.99), 0.5);
    EXPECT_EQ(even_step(scene, 0.3), 0.25);
    EXPECT_EQ(even_step(scene, 0.1), 0.1) << "ten steps: 1/0.1 may round up";
    EXPECT_EQ(even_step(scene, 0.1 * (1 - 1e-14)), 0.1) << "no eleventh step for round-off";
    scene.time = 0.5;
    EXPECT_EQ(even_step(scene, 0.3), 0.25);
    scene.time = 1;
    EXPECT_EQ(even_step(scene, 0.3), 0);
}

TYPED_TEST(SimulationTest, MeetsTheEndTimeExactlyWhateverTheLimit) {
    constexpr int Dim = TypeParam::value;
    Random random(32);
    for (int draw = 0; draw < 40; ++draw) {
        Simulation<Dim> scene = scene_of<Dim>({});
        scene.end_time = std::pow(10, random.uniform(-6, 6));
        const double limit = scene.end_time / random.uniform(1, 300);
        scene.add_stage("time_step", [&](Simulation<Dim>& s) { s.time_step = even_step(s, limit); });
        const auto expected = static_cast<std::int64_t>(std::ceil(scene.end_time / limit * (1 - 1e-12)));
        while (scene.time < scene.end_time && scene.step <= expected) {
            advance(scene);
            EXPECT_LE(scene.time_step, limit * (1 + 1e-11));
        }
        EXPECT_EQ(scene.time, scene.end_time);
        EXPECT_EQ(scene.step, expected);
    }
}

TYPED_TEST(SimulationTest, TakesTheSumOfItsStepsForTheEndTimeUpToRoundOff) {
    constexpr int Dim = TypeParam::value;
    Simulation<Dim> scene = scene_of<Dim>({});
    scene.add_stage("time_step", [&](Simulation<Dim>& s) { s.time_step = 0.1; });
    for (int step = 1; step <= 9; ++step) {
        advance(scene);
        EXPECT_NEAR(scene.time, 0.1 * step, 1e-15);
    }
    advance(scene);
    EXPECT_EQ(scene.time, 1) << "ten times 0.1, one after the other, is 1 - 1e-16";
}

TYPED_TEST(SimulationTest, DivergesWithoutAPositiveTimeStep) {
    constexpr int Dim = TypeParam::value;
    Simulation<Dim> scene = scene_of<Dim>({});
    scene.time = 0.125;
    scene.step = 7;
    for (const double limit : {0.0, -0.1, not_a_number}) {
        expect_mentions(diagnosis([&] { even_step(scene, limit); }),
                        {"no positive time step", shortest(limit), "t = 0.125", "step 7"});
    }
}

// Wrapping.

TYPED_TEST(SimulationTest, WrapsParticlesIntoPeriodicBoxes) {
    constexpr int Dim = TypeParam::value;
    struct Wrapped {
        double before;
        double after;
    };
    const double below = std::nextafter(1., 0.);
    for (int d = 0; d < Dim; ++d) {
        for (const Wrapped& x :
             {Wrapped{0, 0}, Wrapped{1, 0}, Wrapped{below, below}, Wrapped{0.3, 0.3},
              Wrapped{std::nextafter(1., 2.), 0x1p-52}, Wrapped{-0.25, 0.75}, Wrapped{1.25, 0.25},
              Wrapped{-1, 0}, Wrapped{2, 0}, Wrapped{1000.25, 0.25}, Wrapped{-1000.25, 0.75},
              // too small to be told from 1 after the wrap
              Wrapped{-1e-20, 0}, Wrapped{-5e-324, 0}}) {
            Points<Dim> points;
            std::array<double, Dim> point;
            point.fill(0.5);
            point[d] = x.before;
            append<Dim>(points, point);
            Simulation<Dim> scene = scene_of<Dim>(points);
            wrap_positions(scene);
            for (int other = 0; other < Dim; ++other) {
                EXPECT_EQ(scene.particles.position[other][0], other == d ? x.after : 0.5) << x.before;
            }
        }
    }
}

TYPED_TEST(SimulationTest, WrapsIntoBoxesAwayFromTheOrigin) {
    constexpr int Dim = TypeParam::value;
    Random random(33);
    Points<Dim> points;
    for (int d = 0; d < Dim; ++d) {
        points[d] = random.values(1000, -20, 20);
    }
    Simulation<Dim> scene = scene_of<Dim>(points);
    for (int d = 0; d < Dim; ++d) {
        scene.box.low[d] = -0.7 - d;
        scene.box.high[d] = scene.box.low[d] + 0.3;
    }
    wrap_positions(scene);
    for (int d = 0; d < Dim; ++d) {
        for (std::size_t i = 0; i < 1000; ++i) {
            const double x = scene.particles.position[d][i];
            EXPECT_GE(x, scene.box.low[d]);
            EXPECT_LT(x, scene.box.high[d]);
            const double boxes = (x - points[d][i]) / scene.box.length(d);
            EXPECT_NEAR(boxes, std::round(boxes), 1e-12);
        }
    }
}

TYPED_TEST(SimulationTest, LeavesTheFacesOfOpenBoxesToTheirParticles) {
    constexpr int Dim = TypeParam::value;
    for (const double face : {0.0, 1.0}) {
        Points<Dim> points;
        std::array<double, Dim> corner;
        corner.fill(face);
        append<Dim>(points, corner);
        Simulation<Dim> scene = scene_of<Dim>(points, false);
        EXPECT_EQ(diagnosis([&] { find_neighbours(scene, 0); }), "");
        for (int d = 0; d < Dim; ++d) {
            EXPECT_EQ(scene.particles.position[d][0], face);
        }
    }
}

TYPED_TEST(SimulationTest, NamesTheFirstParticleThatIsLost) {
    constexpr int Dim = TypeParam::value;
    struct Lost {
        bool periodic;
        double x;
    };
    for (int d = 0; d < Dim; ++d) {
        for (const Lost& lost : {Lost{true, not_a_number}, Lost{true, infinity}, Lost{true, -infinity},
                                 Lost{false, not_a_number}, Lost{false, infinity}, Lost{false, 1.0001},
                                 Lost{false, -1e-300}, Lost{false, 7e30}}) {
            Points<Dim> points;
            for (int i = 0; i < 40; ++i) {
                std::array<double, Dim> point;
                point.fill(0.25);
                point[d] = i == 17 || i == 30 ? lost.x : 0.5;
                append<Dim>(points, point);
            }
            Simulation<Dim> scene = scene_of<Dim>(points, lost.periodic);
            scene.time = 0.125;
            scene.step = 7;
            expect_mentions(diagnosis([&] { find_neighbours(scene, 0); }),
                            {"position not finite or outside the domain", "particle 117 at (", "0.25",
                             "t = 0.125", "step 7"});
        }
    }
}

TYPED_TEST(SimulationTest, NeverLeavesAParticleOutsideHoweverFarItWent) {
    constexpr int Dim = TypeParam::value;
    for (const double x : {1e15, -1e15, 1e17, -1e17, 1e30, -1e30, 1e300, -1e300}) {
        Points<Dim> points;
        std::array<double, Dim> point;
        point.fill(x);
        append<Dim>(points, point);
        Simulation<Dim> scene = scene_of<Dim>(points);
        scene.box.high.fill(0.3);
        if (diagnosis([&] { wrap_positions(scene); }).empty()) {
            EXPECT_GE(scene.particles.position[0][0], 0);
            EXPECT_LT(scene.particles.position[0][0], 0.3);
        }
    }
}

// Survival.

/// A scene of two particles that finds its neighbours and then suffers the change.
template <int Dim>
std::string fate(double apart, const std::function<void(Simulation<Dim>&)>& change) {
    Points<Dim> points;
    std::array<double, Dim> point;
    point.fill(0.25);
    append<Dim>(points, point);
    point[0] += apart;
    append<Dim>(points, point);
    Simulation<Dim> scene = scene_of<Dim>(points);
    scene.time = 0.125;
    scene.survival.kinetic_energy = 2;
    scene.survival.kinetic_energy_reason = "twice the start";
    scene.survival.minimum_spacing = 0.02;
    scene.survival.minimum_spacing_reason = "0.2 dx";
    scene.add_stage("neighbours", [&](Simulation<Dim>& s) {
        s.time_step = 0.125;
        find_neighbours(s, 0);
    });
    scene.add_stage("change", change);
    return diagnosis([&] { advance(scene); });
}

TYPED_TEST(SimulationTest, SurvivesWithinItsBounds) {
    constexpr int Dim = TypeParam::value;
    EXPECT_EQ(fate<Dim>(0.0201, [](Simulation<Dim>& s) { s.particles.velocity[Dim - 1][0] = 2.8; }), "");
    EXPECT_EQ(fate<Dim>(0.5, [](Simulation<Dim>&) {}), "") << "no pairs at all";
}

TYPED_TEST(SimulationTest, DiesOfAVelocityThatIsNotANumber) {
    constexpr int Dim = TypeParam::value;
    for (const double value : {not_a_number, infinity, -infinity}) {
        for (int d = 0; d < Dim; ++d) {
            expect_mentions(fate<Dim>(0.1, [&](Simulation<Dim>& s) { s.particles.velocity[d][1] = value; }),
                            {"velocity not finite", "particle 101 at (0.35, 0.25", "t = 0.25, step 1"});
        }
    }
    expect_mentions(fate<Dim>(0.1, [&](Simulation<Dim>& s) { s.particles.velocity[0][1] = 1e200; }),
                    {"velocity not finite", "square overflows", "t = 0.25, step 1"});
}

TYPED_TEST(SimulationTest, DiesOfTooMuchKineticEnergy) {
    constexpr int Dim = TypeParam::value;
    // mass 0.5: energy 2 at |u|^2 = 8
    expect_mentions(fate<Dim>(0.1, [](Simulation<Dim>& s) { s.particles.velocity[Dim - 1][1] = -3; }),
                    {"kinetic energy 2.25 above its bound 2 (twice the start)", "particle 101 at (0.35, 0.25",
                     "t = 0.25, step 1"});
}

// Before a stage spreads it, or takes it for a limit of the step.
TYPED_TEST(SimulationTest, DoesNotStartWithAVelocityThatIsNotANumber) {
    constexpr int Dim = TypeParam::value;
    for (const double value : {not_a_number, infinity}) {
        Points<Dim> points;
        std::array<double, Dim> point;
        point.fill(0.25);
        append<Dim>(points, point);
        append<Dim>(points, point);
        Simulation<Dim> scene = scene_of<Dim>(points);
        scene.particles.velocity[Dim - 1][1] = value;
        bool ran = false;
        scene.add_stage("first", [&](Simulation<Dim>&) { ran = true; });
        expect_mentions(diagnosis([&] { advance(scene); }),
                        {"velocity not finite", "particle 101 at (0.25, 0.25", "t = 0, step 1"});
        EXPECT_FALSE(ran);
    }
}

TYPED_TEST(SimulationTest, DiesOfParticlesThatMeet) {
    constexpr int Dim = TypeParam::value;
    expect_mentions(fate<Dim>(0.015, [](Simulation<Dim>&) {}),
                    {"minimum spacing 0.150 dx below 0.200 dx (0.2 dx), particle 10", "t = 0.25, step 1"});
    expect_mentions(fate<Dim>(0, [](Simulation<Dim>&) {}), {"minimum spacing 0.000 dx"});
    // across a periodic side as well
    expect_mentions(fate<Dim>(0.99, [](Simulation<Dim>&) {}), {"minimum spacing 0.100 dx"});
}

TYPED_TEST(SimulationTest, NamesTheFirstConditionThatIsViolated) {
    constexpr int Dim = TypeParam::value;
    expect_mentions(fate<Dim>(0.015, [](Simulation<Dim>& s) { s.particles.velocity[0][0] = not_a_number; }),
                    {"velocity not finite"});
    expect_mentions(fate<Dim>(0.015, [](Simulation<Dim>& s) { s.particles.velocity[0][0] = 10; }),
                    {"kinetic energy"});
}

// Sums.

TYPED_TEST(SimulationTest, SumsAndMaximaAreThoseOfTheDefinition) {
    constexpr int Dim = TypeParam::value;
    Random random(34);
    const int threads = omp_get_max_threads();
    for (const int count : {1, 255, 1024, 1025, 5000}) {
        Points<Dim> points;
        for (int d = 0; d < Dim; ++d) {
            points[d] = random.values(count, 0, 1);
        }
        Simulation<Dim> scene = scene_of<Dim>(points);
        long double squares = 0;
        double largest = 0;
        for (int i = 0; i < count; ++i) {
            double squared = 0;
            for (int d = 0; d < Dim; ++d) {
                scene.particles.velocity[d][i] = random.uniform(-1, 1);
                squared += scene.particles.velocity[d][i] * scene.particles.velocity[d][i];
            }
            squares += squared;
            largest = std::max(largest, std::sqrt(squared));
        }
        EXPECT_NEAR(kinetic_energy(scene), static_cast<double>(squares) * 0.25,
                    1e-14 * static_cast<double>(squares));
        EXPECT_DOUBLE_EQ(maximum_speed(scene), largest);
        omp_set_num_threads(1);
        const double alone = kinetic_energy(scene);
        omp_set_num_threads(3);
        EXPECT_EQ(kinetic_energy(scene), alone);
        omp_set_num_threads(threads);
        scene.particles.velocity[Dim - 1][count / 2] = not_a_number;
        EXPECT_TRUE(std::isnan(maximum_speed(scene)));
        EXPECT_TRUE(std::isnan(kinetic_energy(scene)));
    }
    EXPECT_EQ(deterministic_sum(0, [](int) { return 1.; }), 0);
}

// A fluid that nothing holds, under a force that grows like t: n steps give it dt^2 times the sum of the
// levels at which the force is taken, n(n - 1)/2 at the starts of steps, n(n + 1)/2 at their ends, n^2/2 in
// the middle.
TEST(ABodyForceThatChanges, IsTakenAtTheLevelOfTheScheme) {
    constexpr int n = 5;
    constexpr double dt = 1e-3;
    const auto speed = [](const char* name, Assignments given) {
        given["time_step"] = "1e-3";
        const Scheme& scheme = schemes::find(name);
        auto scene = still_scene<2>(scheme, given, 16);
        scene.end_time = n * dt;
        scene.body_force_at = [](double t) { return std::array{0., t}; };
        scheme.assemble(scene);
        for (int step = 0; step < n; ++step) {
            advance(scene);
        }
        EXPECT_EQ(scene.particles.velocity[0][7], 0);
        return scene.particles.velocity[1][7] / (dt * dt);
    };
    EXPECT_NEAR(speed("wcsph", {}), n * (n - 1) / 2, 1e-8);
    EXPECT_NEAR(speed("wcsph", {{"integrator", "predictor_corrector"}}), n * n / 2., 1e-8);
    EXPECT_NEAR(speed("isph_df", {}), n * (n + 1) / 2, 1e-8);
    EXPECT_NEAR(speed("isph_lee", {}), n * (n + 1) / 2, 1e-8);
    EXPECT_NEAR(speed("isph_mls", {}), n * n / 2., 1e-8);
}

} // namespace
} // namespace sphvv::solver
