// The checks must fail on wrong solutions: every fault below is one small edit of a right one.
#include "sphvv/analytic/tests/checks.hpp"

#include "sphvv/analytic/solutions.hpp"

#include <gtest/gtest.h>

#include <set>

namespace sphvv::analytic {
namespace {

using namespace checks;

constexpr double off = 1 + smallest_fault;

const Solution& taylor_green() {
    return solutions::find("taylor_green");
}
const Solution& abc_flow() {
    return solutions::find("abc_flow");
}
const Solution& poiseuille() {
    return solutions::find("poiseuille");
}
const Solution& poiseuille_free_surface() {
    return solutions::find("poiseuille_free_surface");
}
const Solution& couette() {
    return solutions::find("couette");
}
const Solution& taylor_couette() {
    return solutions::find("taylor_couette");
}
const Solution& hydrostatic() {
    return solutions::find("hydrostatic");
}
const Solution& impulsive_plate() {
    return solutions::find("impulsive_plate");
}
const Solution& log_law_channel() {
    return solutions::find("log_law_channel");
}
const Solution& log_law_channel_rough() {
    return solutions::find("log_law_channel_rough");
}
const Solution& mixing_length_channel() {
    return solutions::find("mixing_length_channel");
}

/// A solution whose fields at (x, t) are edit(right fields, x, t).
template <auto base, auto edit>
Solution with_fields() {
    Solution solution = base();
    solution.bind = [](const Values& values) -> Evaluator {
        return [right = base().bind(values)](const Vector& x, double t) { return edit(right, x, t); };
    };
    return solution;
}

/// A solution whose fields at (x, t) are the right ones after edit(state).
template <auto base, auto edit>
Solution with_state() {
    return with_fields<base, [](const Evaluator& right, const Vector& x, double t) {
        State state = right(x, t);
        edit(state);
        return state;
    }>();
}

template <auto base, auto edit>
Solution with_medium() {
    Solution solution = base();
    solution.medium = [](const Values& values) {
        Medium medium = base().medium(values);
        edit(medium);
        return medium;
    };
    return solution;
}

template <auto base, auto edit>
Solution with_domain() {
    Solution solution = base();
    solution.domain = [](const Values& values) {
        Domain domain = base().domain(values);
        edit(domain);
        return domain;
    };
    return solution;
}

template <auto base, auto energy>
Solution with_energy() {
    Solution solution = base();
    solution.kinetic_energy = energy;
    return solution;
}

/// Names of the checks that a solution fails with its declared values.
std::set<std::string> failures(const Solution& solution) {
    Random random(7);
    const Flow flow(solution, resolve(solution, {}));
    std::set<std::string> failed;
    const auto note = [&](const char* name, bool passed) {
        if (!passed) {
            failed.insert(name);
        }
    };
    const Residual error = residual(flow, random);
    note("momentum", error.momentum < residual_tolerance(flow));
    note("continuity", error.continuity < continuity_tolerance);
    note("periodicity", periodicity_error(flow, random) < value_tolerance);
    const BoundaryErrors at_walls = boundary_errors(flow, random);
    note("wall velocity", at_walls.velocity < value_tolerance);
    note("surface pressure", at_walls.pressure < value_tolerance);
    note("surface stress", at_walls.stress < stress_tolerance);
    note("geometry", at_walls.geometry < continuity_tolerance);
    note("start", start_error(flow, random) < start_tolerance);
    if (flow.fully_periodic()) {
        note("mean pressure", mean_pressure_error(flow, random) < value_tolerance);
        note("dissipation", dissipation_error(flow, random) < rate_tolerance);
    }
    if (solution.kinetic_energy != nullptr && !flow.curved()) {
        note("energy",
             kinetic_energy_error(flow, random) < (flow.bounded() ? mean_tolerance : value_tolerance));
    }
    if (std::isfinite(flow.medium.maximum_speed)) {
        const double ratio = speed_ratio(flow);
        note("speed above maximum", ratio <= 1 + value_tolerance);
        note("speed below maximum", ratio >= 1 - maximum_tolerance);
    }
    note("parameters", ignored_parameters(solution, random).empty());
    return failed;
}

bool caught(const Solution& solution, const std::string& check) {
    return failures(solution).contains(check);
}

/// Faults of the fields, the medium and the energy that every flow can have in which all terms of the
/// equations of motion are present.
template <auto base>
void catch_every_fault() {
    EXPECT_EQ(failures(base()), std::set<std::string>{});

    EXPECT_TRUE(caught(with_state<base, [](State& s) { s.pressure *= off; }>(), "momentum"));
    EXPECT_TRUE(caught(with_state<base, [](State& s) { s.pressure = -s.pressure; }>(), "momentum"));
    EXPECT_TRUE(caught(with_state<base, [](State& s) { s.velocity[0] *= off; }>(), "momentum"));
    EXPECT_TRUE(caught(with_state<base, [](State& s) { s.velocity[1] = -s.velocity[1]; }>(), "momentum"));
    EXPECT_TRUE(caught(with_state<base, [](State& s) { s.velocity[0] += smallest_fault * s.velocity[1]; }>(),
                       "continuity"));
    EXPECT_TRUE(
        caught(with_state<base, [](State& s) { std::swap(s.velocity[0], s.velocity[1]); }>(), "momentum"));
    EXPECT_TRUE(caught(with_state<base,
                                  [](State& s) {
                                      for (double& u : s.velocity) {
                                          u *= off;
                                      }
                                  }>(),
                       "momentum"));
    EXPECT_TRUE(caught(with_fields<base, [](const Evaluator& right, const Vector& x,
                                            double t) { return right(x, off * t); }>(),
                       "momentum"));
    EXPECT_TRUE(caught(with_medium<base, [](Medium& m) { m.kinematic_viscosity *= off; }>(), "momentum"));
    EXPECT_TRUE(caught(with_medium<base, [](Medium& m) { m.density *= off; }>(), "momentum"));
    EXPECT_TRUE(caught(with_medium<base, [](Medium& m) { m.body_force[1] += 1; }>(), "momentum"));
    EXPECT_TRUE(
        caught(with_medium<base, [](Medium& m) { m.maximum_speed /= off; }>(), "speed above maximum"));
    EXPECT_TRUE(
        caught(with_medium<base, [](Medium& m) { m.maximum_speed *= 1.002; }>(), "speed below maximum"));
}

/// Faults that only a flow without boundaries can have.
template <auto base>
void catch_every_fault_without_boundaries() {
    catch_every_fault<base>();
    EXPECT_TRUE(caught(with_fields<base,
                                   [](const Evaluator& right, const Vector& x, double t) {
                                       State state = right(x, t);
                                       state.velocity[0] *= (t > 0) ? 1 : off;
                                       return state;
                                   }>(),
                       "start"));
    EXPECT_TRUE(caught(with_fields<base,
                                   [](const Evaluator& right, const Vector& x, double t) {
                                       return right({off * x[0], x[1], x[2]}, t);
                                   }>(),
                       "periodicity"));
    EXPECT_TRUE(caught(with_medium<base, [](Medium& m) { m.kinematic_viscosity *= off; }>(), "dissipation"));
    EXPECT_TRUE(caught(with_state<base, [](State& s) { s.pressure += 0.001; }>(), "mean pressure"));
    EXPECT_TRUE(caught(with_domain<base, [](Domain& d) { d.high[0] *= off; }>(), "periodicity"));
    EXPECT_TRUE(caught(with_energy<base, [](const Values& values,
                                            double t) { return off * base().kinetic_energy(values, t); }>(),
                       "energy"));
    EXPECT_TRUE(caught(with_energy<base, [](const Values& values,
                                            double t) { return base().kinetic_energy(values, off * t); }>(),
                       "dissipation"));
}

TEST(Checks, CatchEveryFaultOfTaylorGreen) {
    catch_every_fault_without_boundaries<taylor_green>();
}
TEST(Checks, CatchEveryFaultOfAbcFlow) {
    catch_every_fault_without_boundaries<abc_flow>();
}
TEST(Checks, CatchEveryFaultOfTaylorCouette) {
    catch_every_fault<taylor_couette>();
}

template <auto base, auto edit>
Solution with_walls() {
    Solution solution = base();
    solution.boundaries = [](const Values& values) {
        std::vector<Boundary> walls = base().boundaries(values);
        edit(walls);
        return walls;
    };
    return solution;
}

/// A solution of which the quantity of that name is multiplied.
template <auto base, std::size_t index>
Solution with_quantity() {
    Solution solution = base();
    solution.quantities[index].bind = [](const Values& values) -> Scalar {
        return [right = base().quantities[index].bind(values)](const Vector& x, double t) {
            return off * right(x, t);
        };
    };
    return solution;
}

/// Faults of a flow along parallel walls: its walls, its viscosity and force, its profile and its energy.
template <auto base>
void catch_faults_between_walls() {
    EXPECT_EQ(failures(base()), std::set<std::string>{});
    EXPECT_TRUE(caught(with_state<base, [](State& s) { s.velocity[0] += 1e-4; }>(), "wall velocity"));
    EXPECT_TRUE(caught(with_state<base, [](State& s) { s.velocity[1] += 1e-4; }>(), "wall velocity"));
    EXPECT_TRUE(caught(with_medium<base, [](Medium& m) { m.body_force[0] += 1e-4; }>(), "momentum"));
    EXPECT_TRUE(caught(with_fields<base,
                                   [](const Evaluator& right, const Vector& x, double t) {
                                       State state = right(x, t);
                                       state.velocity[0] *= 1 + smallest_fault * x[0];
                                       return state;
                                   }>(),
                       "continuity"));
    EXPECT_TRUE(caught(with_fields<base,
                                   [](const Evaluator& right, const Vector& x, double t) {
                                       State state = right(x, t);
                                       state.velocity[0] *= 1 + smallest_fault * x[0];
                                       return state;
                                   }>(),
                       "periodicity"));
    EXPECT_TRUE(caught(with_fields<base,
                                   [](const Evaluator& right, const Vector& x, double t) {
                                       return right({x[0], off * x[1], 0}, t);
                                   }>(),
                       "momentum"));
    EXPECT_TRUE(caught(with_walls<base,
                                  [](std::vector<Boundary>& walls) {
                                      walls[0].velocity = [](const Vector&, double) {
                                          return Vector{1e-4, 0, 0};
                                      };
                                  }>(),
                       "wall velocity"));
    EXPECT_TRUE(caught(with_walls<base,
                                  [](std::vector<Boundary>& walls) {
                                      walls[0].distance = [right = walls[0].distance](const Vector& x) {
                                          return off * right(x);
                                      };
                                  }>(),
                       "geometry"));
    EXPECT_TRUE(caught(with_energy<base, [](const Values& values,
                                            double t) { return off * base().kinetic_energy(values, t); }>(),
                       "energy"));
    EXPECT_TRUE(
        caught(with_medium<base, [](Medium& m) { m.maximum_speed /= off; }>(), "speed above maximum"));
    EXPECT_TRUE(
        caught(with_medium<base, [](Medium& m) { m.maximum_speed *= 1.002; }>(), "speed below maximum"));
}

/// Faults of a flow that starts.
template <auto base>
void catch_faults_of_a_start() {
    EXPECT_TRUE(caught(with_fields<base, [](const Evaluator& right, const Vector& x,
                                            double t) { return right(x, off * t); }>(),
                       "momentum"));
    EXPECT_TRUE(caught(with_fields<base, [](const Evaluator& right, const Vector& x,
                                            double t) { return right(x, (t > 0) ? t : 1e9); }>(),
                       "start"));
    EXPECT_TRUE(caught(with_medium<base, [](Medium& m) { m.kinematic_viscosity *= off; }>(), "momentum"));
    EXPECT_TRUE(caught(with_energy<base, [](const Values& values,
                                            double t) { return base().kinetic_energy(values, off * t); }>(),
                       "energy"));
}

/// Faults of a flat free surface under gravity.
template <auto base>
void catch_faults_of_a_surface() {
    EXPECT_TRUE(caught(with_state<base, [](State& s) { s.pressure += 1e-4; }>(), "surface pressure"));
    EXPECT_TRUE(caught(with_state<base, [](State& s) { s.pressure *= off; }>(), "momentum"));
    EXPECT_TRUE(caught(with_medium<base, [](Medium& m) { m.body_force[1] *= off; }>(), "momentum"));
    EXPECT_TRUE(caught(with_domain<base, [](Domain& d) { d.high[1] *= off; }>(), "surface pressure"));
}

TEST(Checks, CatchEveryFaultOfPoiseuille) {
    catch_faults_between_walls<poiseuille>();
    catch_faults_of_a_start<poiseuille>();
}
TEST(Checks, CatchEveryFaultOfPoiseuilleWithAFreeSurface) {
    catch_faults_between_walls<poiseuille_free_surface>();
    catch_faults_of_a_start<poiseuille_free_surface>();
    catch_faults_of_a_surface<poiseuille_free_surface>();
    EXPECT_TRUE(caught(with_fields<poiseuille_free_surface,
                                   [](const Evaluator& right, const Vector& x, double t) {
                                       State state = right(x, t);
                                       state.velocity[0] += smallest_fault * x[1];
                                       return state;
                                   }>(),
                       "surface stress"));
}
TEST(Checks, CatchEveryFaultOfCouette) {
    catch_faults_between_walls<couette>();
    catch_faults_of_a_start<couette>();
}

template <auto base>
void catch_faults_of_turbulence() {
    catch_faults_between_walls<base>();
    catch_faults_of_a_surface<base>();
    EXPECT_EQ(base().quantities[0].name, "eddy_viscosity");
    EXPECT_TRUE(caught(with_quantity<base, 0>(), "momentum"));
    EXPECT_TRUE(caught(with_state<base, [](State& s) { s.velocity[0] *= off; }>(), "momentum"));
}

TEST(Checks, CatchEveryFaultOfLogLawChannel) {
    catch_faults_of_turbulence<log_law_channel>();
}
TEST(Checks, CatchEveryFaultOfRoughLogLawChannel) {
    catch_faults_of_turbulence<log_law_channel_rough>();
}
TEST(Checks, CatchEveryFaultOfMixingLengthChannel) {
    catch_faults_of_turbulence<mixing_length_channel>();
}

TEST(Checks, CatchEveryFaultOfHydrostatic) {
    EXPECT_EQ(failures(hydrostatic()), std::set<std::string>{});
    catch_faults_of_a_surface<hydrostatic>();
    EXPECT_TRUE(caught(with_state<hydrostatic, [](State& s) { *s.density *= off; }>(), "momentum"));
    EXPECT_TRUE(caught(with_state<hydrostatic, [](State& s) { s.density = 1000; }>(), "momentum"));
    EXPECT_TRUE(
        caught(with_state<hydrostatic, [](State& s) { s.velocity[0] = 1e-12; }>(), "speed above maximum"));
    EXPECT_TRUE(caught(with_state<hydrostatic, [](State& s) { s.velocity[1] = 1e-12; }>(), "wall velocity"));
    EXPECT_TRUE(
        caught(with_medium<hydrostatic, [](Medium& m) { m.maximum_speed = 1e-3; }>(), "speed below maximum"));
}

TEST(Checks, CatchEveryFaultOfImpulsivePlate) {
    EXPECT_EQ(failures(impulsive_plate()), std::set<std::string>{});
    EXPECT_EQ(impulsive_plate().quantities[0].name, "potential");
    EXPECT_EQ(impulsive_plate().quantities[1].name, "impulse");
    EXPECT_TRUE(caught(with_quantity<impulsive_plate, 0>(), "momentum"));
    EXPECT_TRUE(caught(with_quantity<impulsive_plate, 1>(), "momentum"));
    EXPECT_TRUE(caught(with_state<impulsive_plate, [](State& s) { s.velocity[0] *= off; }>(), "momentum"));
    EXPECT_TRUE(caught(with_state<impulsive_plate, [](State& s) { s.velocity[0] *= off; }>(), "continuity"));
    EXPECT_TRUE(
        caught(with_state<impulsive_plate, [](State& s) { s.velocity[0] *= off; }>(), "wall velocity"));
    EXPECT_TRUE(
        caught(with_state<impulsive_plate, [](State& s) { s.velocity[1] += 1e-4; }>(), "wall velocity"));
    EXPECT_TRUE(caught(with_medium<impulsive_plate, [](Medium& m) { m.density *= off; }>(), "momentum"));
    EXPECT_TRUE(caught(with_energy<impulsive_plate,
                                   [](const Values& values, double t) {
                                       return off * impulsive_plate().kinetic_energy(values, t);
                                   }>(),
                       "energy"));
    Solution shifted = impulsive_plate();
    shifted.quantities[1].bind = [](const Values& values) -> Scalar {
        return [right = impulsive_plate().quantities[1].bind(values)](const Vector& x, double t) {
            return right(x, t) + 1e-4;
        };
    };
    EXPECT_TRUE(caught(shifted, "surface pressure"));
}

TEST(Checks, CatchEveryFaultOfCurvedWalls) {
    EXPECT_TRUE(caught(with_walls<taylor_couette,
                                  [](std::vector<Boundary>& walls) {
                                      walls[1].velocity = [](const Vector& x, double) {
                                          return Vector{-1e-4 * x[1], 1e-4 * x[0], 0};
                                      };
                                  }>(),
                       "wall velocity"));
    EXPECT_TRUE(caught(with_walls<taylor_couette,
                                  [](std::vector<Boundary>& walls) {
                                      walls[1].distance = [right = walls[1].distance](const Vector& x) {
                                          return right(x) + 1e-4;
                                      };
                                  }>(),
                       "wall velocity"));
    EXPECT_TRUE(caught(with_walls<taylor_couette,
                                  [](std::vector<Boundary>& walls) {
                                      walls[0].distance = [right = walls[0].distance](const Vector& x) {
                                          return off * right(x);
                                      };
                                  }>(),
                       "geometry"));
    EXPECT_TRUE(caught(with_fields<taylor_couette, [](const Evaluator& right, const Vector& x,
                                                      double t) { return right(x, (t > 0) ? t : 1e9); }>(),
                       "start"));
}

/// The right solution with the given key at its declared value whatever the caller says.
Values without(const Values& values, std::string_view key) {
    Values others = values;
    if (const auto found = others.find(key); found != others.end()) {
        others.erase(found);
    }
    return others;
}

TEST(Checks, CatchAParameterThatIsIgnored) {
    Random random(8);
    Solution solution = taylor_green();
    solution.bind = [](const Values& values) { return taylor_green().bind(without(values, "density")); };
    EXPECT_EQ(ignored_parameters(solution, random), std::vector<std::string>{"density"});

    solution.bind = [](const Values& values) { return taylor_green().bind(without(values, "re")); };
    EXPECT_EQ(ignored_parameters(solution, random), std::vector<std::string>{"re"})
        << "a viscosity that only the medium knows of is no use of the parameter";
}

TEST(Checks, CatchAParameterThatOnlyTheDeclarationKnows) {
    Random random(9);
    Solution solution = taylor_green();
    solution.parameters.push_back({"decoration", "1", "changes nothing", 0, -1, 1});
    solution.domain = [](const Values& values) {
        return taylor_green().domain(without(values, "decoration"));
    };
    solution.medium = [](const Values& values) {
        return taylor_green().medium(without(values, "decoration"));
    };
    solution.bind = [](const Values& values) { return taylor_green().bind(without(values, "decoration")); };
    EXPECT_EQ(ignored_parameters(solution, random), std::vector<std::string>{"decoration"});
}

TEST(Checks, DifferencesAreOfEighthOrder) {
    const auto errors = [](double step) {
        const auto [d1, d2] = derivatives([](double s) { return std::sin(1 + s); }, step);
        return std::pair{std::abs(d1 - std::cos(1)), std::abs(d2 + std::sin(1))};
    };
    const auto [coarse1, coarse2] = errors(0.4);
    const auto [fine1, fine2] = errors(0.2);
    EXPECT_NEAR(std::log2(coarse1 / fine1), 8, 0.1);
    EXPECT_NEAR(std::log2(coarse2 / fine2), 8, 0.1);
}

TEST(Checks, QuadratureIsExactWithAndWithoutWalls) {
    const Domain domain{{0, -1, 0}, {2 * pi, 3, 0}, {true, false, false}};
    const double mean = volume_mean(
        domain, 2, [](const Vector& x) { return std::pow(std::sin(3 * x[0]), 2) * std::pow(x[1], 6); });
    EXPECT_NEAR(mean, 0.5 * (std::pow(3., 7) + 1) / 7 / 4, 1e-12);
}

} // namespace
} // namespace sphvv::analytic
