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
    names.clear();
    for (const Quantity& declared : solution.quantities) {
        SCOPED_TRACE(declared.name);
        EXPECT_TRUE(names.insert(declared.name).second) << "declared twice";
        EXPECT_FALSE(declared.name.empty());
        EXPECT_FALSE(declared.unit.empty());
        EXPECT_FALSE(declared.summary.empty());
        EXPECT_NE(declared.bind, nullptr);
    }
    EXPECT_FALSE(to_string(solution.equations).empty());
}

TEST_P(EverySolution, HasTheQuantitiesOfItsEquations) {
    EXPECT_EQ(has_quantity(solution, "eddy_viscosity"), solution.equations == Equations::reynolds_averaged);
    EXPECT_EQ(has_quantity(solution, "impulse"), solution.equations == Equations::impulsive);
    EXPECT_EQ(has_quantity(solution, "potential"), solution.equations == Equations::impulsive);
    const Flow flow(solution, resolve(solution, {}));
    const State state = flow.fields(random_point(flow, random), 0.1);
    EXPECT_EQ(state.density.has_value(), solution.equations == Equations::hydrostatic);
    EXPECT_EQ(std::isnan(state.pressure), solution.equations == Equations::impulsive);
}

TEST_P(EverySolution, HasBoundariesWhereItIsNotPeriodic) {
    for_parameter_sets([&](const Values& values) {
        const Flow flow(solution, values);
        EXPECT_EQ(flow.bounded(), !flow.fully_periodic());
        for (const Boundary& wall : flow.walls) {
            EXPECT_FALSE(wall.name.empty());
            if (wall.face) {
                EXPECT_LT(wall.face->direction, solution.dimension);
                EXPECT_FALSE(flow.domain.periodic[wall.face->direction]);
            }
        }
    });
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
        const Flow flow(solution, values);
        const double t = random_time(flow, random);
        const State state = flow.fields(random_point(flow, random), t);
        for (int d = solution.dimension; d < 3; ++d) {
            EXPECT_EQ(state.velocity[d], 0);
        }
    });
}

TEST_P(EverySolution, TakesPartialValuesAndRejectsUnknownOnes) {
    const Values all = resolve(solution, {});
    const Vector x = random_point(Flow(solution, all), random);
    EXPECT_TRUE(same_domain(solution.domain({}), solution.domain(all)));
    EXPECT_EQ(solution.medium({}).maximum_speed, solution.medium(all).maximum_speed);
    EXPECT_EQ(solution.bind({})(x, 0.25).velocity, solution.bind(all)(x, 0.25).velocity);
    if (solution.kinetic_energy != nullptr) {
        EXPECT_EQ(solution.kinetic_energy({}, 0.25), solution.kinetic_energy(all, 0.25));
    }
    EXPECT_EQ(body_force(solution, {}, 0.25), body_force(solution, all, 0.25));
    for (const Quantity& declared : solution.quantities) {
        EXPECT_EQ(declared.bind({})(x, 0.25), declared.bind(all)(x, 0.25)) << declared.name;
    }

    const Values unknown{{"no such key", 1}};
    EXPECT_THROW(solution.domain(unknown), std::invalid_argument);
    EXPECT_THROW(solution.medium(unknown), std::invalid_argument);
    EXPECT_THROW(solution.bind(unknown), std::invalid_argument);
    EXPECT_THROW(body_force(solution, unknown, 0), std::invalid_argument);
    if (solution.kinetic_energy != nullptr) {
        EXPECT_THROW(solution.kinetic_energy(unknown, 0), std::invalid_argument);
    }
    if (solution.boundaries != nullptr) {
        EXPECT_THROW(solution.boundaries(unknown), std::invalid_argument);
    }
    for (const Quantity& declared : solution.quantities) {
        EXPECT_THROW(declared.bind(unknown), std::invalid_argument) << declared.name;
    }
}

TEST_P(EverySolution, IsFiniteAtTheEndsOfItsIntervals) {
    for (const Parameter& parameter : solution.parameters) {
        for (const double end : {parameter.low, parameter.high}) {
            SCOPED_TRACE(std::string(parameter.name) + " = " + std::to_string(end));
            const Values values = resolve(solution, {{std::string(parameter.name), end}});
            const Medium medium = solution.medium(values);
            EXPECT_TRUE(std::isfinite(medium.density) && medium.density > 0);
            EXPECT_TRUE(std::isfinite(medium.kinematic_viscosity) && medium.kinematic_viscosity >= 0);
            const bool impulsive = solution.equations == Equations::impulsive;
            EXPECT_TRUE((impulsive || std::isfinite(medium.maximum_speed)) && medium.maximum_speed >= 0);
            EXPECT_EQ(body_force(solution, values, 0), medium.body_force);
            EXPECT_TRUE(std::isfinite(length(body_force(solution, values, 1e6))));
            const Flow flow(solution, values);
            const Vector x = random_point(flow, random);
            for (const double t : {0.0, 1.0, 1e6}) {
                const State state = flow.fields(x, t);
                EXPECT_TRUE(std::isfinite(length(state.velocity)));
                EXPECT_TRUE(impulsive || std::isfinite(state.pressure));
                EXPECT_GT(density(state, medium), 0);
                EXPECT_TRUE(solution.kinetic_energy == nullptr ||
                            std::isfinite(solution.kinetic_energy(values, t)));
                for (const Quantity& declared : solution.quantities) {
                    EXPECT_TRUE(std::isfinite(declared.bind(values)(x, t))) << declared.name;
                }
            }
        }
    }
}

TEST_P(EverySolution, SatisfiesItsEquations) {
    for_parameter_sets([&](const Values& values) {
        const Flow flow(solution, values);
        for (int time = 0; time < 3; ++time) {
            const Residual error = residual(flow, random);
            EXPECT_LT(error.momentum, residual_tolerance(flow));
            EXPECT_LT(error.continuity, continuity_tolerance);
            EXPECT_GT(error.power * smallest_fault, 10 * residual_tolerance(flow))
                << "a fault in the smallest term would not be seen at these parameters";
        }
    });
}

TEST_P(EverySolution, IsPeriodicWhereDeclared) {
    for_parameter_sets([&](const Values& values) {
        EXPECT_LT(periodicity_error(Flow(solution, values), random), value_tolerance);
    });
}

TEST_P(EverySolution, MeetsTheConditionsOnItsBoundaries) {
    for_parameter_sets([&](const Values& values) {
        const BoundaryErrors errors = boundary_errors(Flow(solution, values), random);
        EXPECT_LT(errors.velocity, value_tolerance);
        EXPECT_LT(errors.pressure, value_tolerance);
        EXPECT_LT(errors.stress, stress_tolerance);
        EXPECT_LT(errors.geometry, continuity_tolerance);
    });
}

TEST_P(EverySolution, StartsFromItsFieldsAtTimeZero) {
    for_parameter_sets([&](const Values& values) {
        EXPECT_LT(start_error(Flow(solution, values), random), start_tolerance);
    });
}

TEST_P(EverySolution, HasNoMeanPressureWithoutBoundaries) {
    for_parameter_sets([&](const Values& values) {
        if (const Flow flow(solution, values); flow.fully_periodic()) {
            EXPECT_LT(mean_pressure_error(flow, random), value_tolerance);
        }
    });
}

TEST_P(EverySolution, HasTheDeclaredKineticEnergy) {
    if (solution.kinetic_energy == nullptr) {
        return;
    }
    for_parameter_sets([&](const Values& values) {
        const Flow flow(solution, values);
        if (flow.curved()) { // no mean over a box; in the tests of the solution
            return;
        }
        EXPECT_LT(kinetic_energy_error(flow, random), flow.bounded() ? mean_tolerance : value_tolerance);
    });
}

TEST_P(EverySolution, LosesEnergyByViscosityOnlyWithoutBoundaries) {
    for_parameter_sets([&](const Values& values) {
        if (const Flow flow(solution, values); flow.fully_periodic()) {
            EXPECT_LT(dissipation_error(flow, random), rate_tolerance);
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
        const Flow flow(solution, values);
        if (!std::isfinite(flow.medium.maximum_speed)) {
            return;
        }
        const double ratio = speed_ratio(flow);
        EXPECT_LE(ratio, 1 + value_tolerance);
        EXPECT_GE(ratio, 1 - maximum_tolerance);
    });
}

} // namespace
} // namespace sphvv::analytic
