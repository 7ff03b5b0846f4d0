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
    const Values values = resolve(solution, {});
    std::set<std::string> failed;
    const auto note = [&](const char* name, bool passed) {
        if (!passed) {
            failed.insert(name);
        }
    };
    const Residual error = residual(solution, values, random);
    note("momentum", error.momentum < momentum_tolerance);
    note("continuity", error.continuity < continuity_tolerance);
    note("periodicity", periodicity_error(solution, values, random) < value_tolerance);
    note("mean pressure", mean_pressure_error(solution, values, random) < value_tolerance);
    note("energy", kinetic_energy_error(solution, values, random) < value_tolerance);
    note("dissipation", dissipation_error(solution, values, random) < rate_tolerance);
    const double ratio = speed_ratio(solution, values);
    note("speed above maximum", ratio <= 1 + value_tolerance);
    note("speed below maximum", ratio >= 1 - maximum_tolerance);
    note("parameters", ignored_parameters(solution, random).empty());
    return failed;
}

template <auto base>
void catch_every_fault() {
    EXPECT_EQ(failures(base()), std::set<std::string>{});

    const auto caught = [](const Solution& solution, const std::string& check) {
        return failures(solution).contains(check);
    };
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
    EXPECT_TRUE(caught(with_fields<base,
                                   [](const Evaluator& right, const Vector& x, double t) {
                                       return right({off * x[0], x[1], x[2]}, t);
                                   }>(),
                       "periodicity"));
    EXPECT_TRUE(caught(with_medium<base, [](Medium& m) { m.kinematic_viscosity *= off; }>(), "momentum"));
    EXPECT_TRUE(caught(with_medium<base, [](Medium& m) { m.kinematic_viscosity *= off; }>(), "dissipation"));
    EXPECT_TRUE(caught(with_medium<base, [](Medium& m) { m.density *= off; }>(), "momentum"));
    EXPECT_TRUE(caught(with_state<base, [](State& s) { s.pressure += 0.001; }>(), "mean pressure"));
    EXPECT_TRUE(caught(with_domain<base, [](Domain& d) { d.high[0] *= off; }>(), "periodicity"));
    EXPECT_TRUE(caught(with_energy<base, [](const Values& values,
                                            double t) { return off * base().kinetic_energy(values, t); }>(),
                       "energy"));
    EXPECT_TRUE(caught(with_energy<base, [](const Values& values,
                                            double t) { return base().kinetic_energy(values, off * t); }>(),
                       "dissipation"));
    EXPECT_TRUE(
        caught(with_medium<base, [](Medium& m) { m.maximum_speed /= off; }>(), "speed above maximum"));
    EXPECT_TRUE(
        caught(with_medium<base, [](Medium& m) { m.maximum_speed *= 1.002; }>(), "speed below maximum"));
}

TEST(Checks, CatchEveryFaultOfTaylorGreen) {
    catch_every_fault<taylor_green>();
}
TEST(Checks, CatchEveryFaultOfAbcFlow) {
    catch_every_fault<abc_flow>();
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
    const double mean = volume_mean(taylor_green(), domain, [](const Vector& x) {
        return std::pow(std::sin(3 * x[0]), 2) * std::pow(x[1], 6);
    });
    EXPECT_NEAR(mean, 0.5 * (std::pow(3., 7) + 1) / 7 / 4, 1e-12);
}

} // namespace
} // namespace sphvv::analytic
