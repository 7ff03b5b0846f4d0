// Every registered exact solution against its equations and its own claims.
//   analytic_solutions --gtest_filter='*taylor_green*'
#include "sphvv/analytic/solutions.hpp"

#include "sphvv/analytic/tests/checks.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <stdexcept>

namespace sphvv::analytic {
namespace {

using namespace checks;

constexpr int draws = 10;

TEST(Solutions, AreTheFilesOfTheFolder) {
    std::vector<std::string> stems;
    for (const auto& entry : std::filesystem::directory_iterator(SPHVV_SOLUTION_FILES)) {
        if (entry.path().extension() == ".cpp") {
            stems.push_back(entry.path().stem().string());
        }
    }
    std::ranges::sort(stems);
    std::vector<std::string> names;
    for (const Solution* solution : solutions::all()) {
        names.emplace_back(solution->name);
    }
    EXPECT_FALSE(names.empty());
    EXPECT_EQ(names, stems);
}

class EverySolution : public testing::TestWithParam<const Solution*> {
protected:
    const Solution& solution = *GetParam();
    Random random{20240607};

    /// Runs the check with the declared values, then with drawn ones.
    template <class Check>
    void for_parameter_sets(const Check& check) {
        for (int draw = 0; draw <= draws; ++draw) {
            const Values values = draw == 0 ? resolve(solution, {}) : random_values(solution, random);
            std::string text;
            for (const auto& [name, value] : values) {
                text += name + " = " + std::to_string(value) + " ";
            }
            SCOPED_TRACE(text);
            check(values);
        }
    }
};

INSTANTIATE_TEST_SUITE_P(All, EverySolution,
                         testing::ValuesIn(solutions::all().begin(), solutions::all().end()),
                         [](const auto& test) { return std::string(test.param->name); });

TEST_P(EverySolution, IsFoundByItsName) {
    EXPECT_EQ(&solutions::find(solution.name), &solution);
}

TEST_P(EverySolution, IsDeclaredInFull) {
    EXPECT_FALSE(solution.name.empty());
    EXPECT_FALSE(solution.summary.empty());
    EXPECT_FALSE(solution.formula.empty());
    EXPECT_FALSE(solution.source.empty());
    EXPECT_TRUE(solution.dimension == 1 || solution.dimension == 2 || solution.dimension == 3);
    EXPECT_NE(solution.domain, nullptr);
    EXPECT_NE(solution.medium, nullptr);
    EXPECT_NE(solution.bind, nullptr);
    EXPECT_NE(solution.kinetic_energy, nullptr);
    std::set<std::string_view> names;
    for (const Parameter& parameter : solution.parameters) {
        SCOPED_TRACE(parameter.name);
        EXPECT_TRUE(names.insert(parameter.name).second) << "declared twice";
        EXPECT_FALSE(parameter.name.empty());
        EXPECT_FALSE(parameter.unit.empty());
        EXPECT_FALSE(parameter.summary.empty());
        EXPECT_LT(parameter.low, parameter.high);
        EXPECT_LE(parameter.low, parameter.value);
        EXPECT_LE(parameter.value, parameter.high);
    }
}

TEST_P(EverySolution, HasADomainOfItsDimension) {
    for_parameter_sets([&](const Values& values) {
        const Domain domain = solution.domain(values);
        for (int d = 0; d < 3; ++d) {
            if (d < solution.dimension) {
                EXPECT_LT(domain.low[d], domain.high[d]);
            } else {
                EXPECT_EQ(domain.low[d], 0);
                EXPECT_EQ(domain.high[d], 0);
                EXPECT_FALSE(domain.periodic[d]);
            }
        }
    });
}

TEST_P(EverySolution, HasNoVelocityBeyondItsDimension) {
    for_parameter_sets([&](const Values& values) {
        const Domain domain = solution.domain(values);
        const double t = random_time(rates(solution, domain, solution.medium(values)), random);
        const State state = solution.bind(values)(random_point(solution, domain, random), t);
        for (int d = solution.dimension; d < 3; ++d) {
            EXPECT_EQ(state.velocity[d], 0);
        }
    });
}

TEST_P(EverySolution, TakesPartialValuesAndRejectsUnknownOnes) {
    const Values all = resolve(solution, {});
    const Vector x = random_point(solution, solution.domain(all), random);
    EXPECT_TRUE(same_domain(solution.domain({}), solution.domain(all)));
    EXPECT_EQ(solution.medium({}).maximum_speed, solution.medium(all).maximum_speed);
    EXPECT_EQ(solution.bind({})(x, 0.25).velocity, solution.bind(all)(x, 0.25).velocity);
    EXPECT_EQ(solution.kinetic_energy({}, 0.25), solution.kinetic_energy(all, 0.25));

    const Values unknown{{"no such key", 1}};
    EXPECT_THROW(solution.domain(unknown), std::invalid_argument);
    EXPECT_THROW(solution.medium(unknown), std::invalid_argument);
    EXPECT_THROW(solution.bind(unknown), std::invalid_argument);
    EXPECT_THROW(solution.kinetic_energy(unknown, 0), std::invalid_argument);
}

TEST_P(EverySolution, IsFiniteAtTheEndsOfItsIntervals) {
    for (const Parameter& parameter : solution.parameters) {
        for (const double end : {parameter.low, parameter.high}) {
            SCOPED_TRACE(std::string(parameter.name) + " = " + std::to_string(end));
            const Values values = resolve(solution, {{std::string(parameter.name), end}});
            const Medium medium = solution.medium(values);
            EXPECT_TRUE(std::isfinite(medium.density) && medium.density > 0);
            EXPECT_TRUE(std::isfinite(medium.kinematic_viscosity) && medium.kinematic_viscosity >= 0);
            EXPECT_TRUE(std::isfinite(medium.maximum_speed) && medium.maximum_speed >= 0);
            const Vector x = random_point(solution, solution.domain(values), random);
            for (const double t : {0.0, 1.0, 1e6}) {
                const State state = solution.bind(values)(x, t);
                EXPECT_TRUE(std::isfinite(length(state.velocity)));
                EXPECT_TRUE(std::isfinite(state.pressure));
                EXPECT_TRUE(std::isfinite(solution.kinetic_energy(values, t)));
            }
        }
    }
}

TEST_P(EverySolution, SatisfiesTheNavierStokesEquations) {
    for_parameter_sets([&](const Values& values) {
        for (int time = 0; time < 3; ++time) {
            const Residual error = residual(solution, values, random);
            EXPECT_LT(error.momentum, momentum_tolerance);
            EXPECT_LT(error.continuity, continuity_tolerance);
            EXPECT_GT(error.power * smallest_fault, 10 * momentum_tolerance)
                << "a fault in the smallest term would not be seen at these parameters";
        }
    });
}

TEST_P(EverySolution, IsPeriodicWhereDeclared) {
    for_parameter_sets([&](const Values& values) {
        EXPECT_LT(periodicity_error(solution, values, random), value_tolerance);
    });
}

TEST_P(EverySolution, HasNoMeanPressureWithoutBoundaries) {
    for_parameter_sets([&](const Values& values) {
        if (fully_periodic(solution, solution.domain(values))) {
            EXPECT_LT(mean_pressure_error(solution, values, random), value_tolerance);
        }
    });
}

TEST_P(EverySolution, HasTheDeclaredKineticEnergy) {
    for_parameter_sets([&](const Values& values) {
        EXPECT_LT(kinetic_energy_error(solution, values, random), value_tolerance);
    });
}

TEST_P(EverySolution, LosesEnergyByViscosityOnlyWithoutBoundaries) {
    for_parameter_sets([&](const Values& values) {
        if (fully_periodic(solution, solution.domain(values))) {
            EXPECT_LT(dissipation_error(solution, values, random), rate_tolerance);
        }
    });
}

TEST_P(EverySolution, UsesEveryParameter) {
    for (int draw = 0; draw < draws; ++draw) {
        EXPECT_EQ(ignored_parameters(solution, random), std::vector<std::string>{});
    }
}

TEST_P(EverySolution, ReachesButNeverExceedsItsMaximumSpeed) {
    for_parameter_sets([&](const Values& values) {
        const double ratio = speed_ratio(solution, values);
        EXPECT_LE(ratio, 1 + value_tolerance);
        EXPECT_GE(ratio, 1 - maximum_tolerance);
    });
}

} // namespace
} // namespace sphvv::analytic
