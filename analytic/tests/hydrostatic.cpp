// Published digits, limits and the equation of state of the compressible column.
#include "sphvv/analytic/solutions.hpp"
#include "sphvv/analytic/tests/checks.hpp"

#include <gtest/gtest.h>

namespace sphvv::analytic {
namespace {

using namespace checks;

const Solution& column() {
    return solutions::find("hydrostatic");
}

double depth(const Values& values) {
    return quantity(column(), "settled_depth", values)({}, 0);
}

TEST(Hydrostatic, SettlesToIssasDepths) { // §4.1: 0.399687 is that of c0 = 50
    EXPECT_NEAR(depth({}), 0.399687, 5e-7);
    EXPECT_NEAR(depth({{"sound_speed", 30}}), 0.399138, 5e-7);
    EXPECT_NEAR(depth({{"sound_speed", 20}}), 0.398088, 5e-7);
    const Evaluator fields = column().bind({});
    EXPECT_NEAR(*fields({}, 0).density / 1000 - 1, 0.0016, 5e-5);
    EXPECT_NEAR(*column().bind({{"sound_speed", 30}})({}, 0).density / 1000 - 1, 0.0043, 5e-5);
    EXPECT_NEAR(fields({}, 0).pressure, 3924, 1e-9);
}

TEST(Hydrostatic, CarriesTheWeightOfItsStart) {
    Random random(3);
    for (int draw = 0; draw < 20; ++draw) {
        const Values values = random_values(column(), random);
        const Flow flow(column(), values);
        const double pressure = quantity(column(), "bed_pressure", values)({}, 0);
        EXPECT_NEAR(flow.fields({}, 0).pressure / pressure, 1, 1e-14);
        const double mass = depth(values) * volume_mean(flow.domain, 2, [&](const Vector& x) {
                                return *flow.fields(x, 0).density;
                            });
        EXPECT_NEAR(mass / (values.at("density") * values.at("depth")), 1, 1e-12);
    }
}

TEST(Hydrostatic, ObeysTaitsEquation) {
    Random random(4);
    for (int draw = 0; draw < 20; ++draw) {
        const Values values = random_values(column(), random);
        const Flow flow(column(), values);
        const State state = flow.fields(random_point(flow, random), 0);
        const double gamma = values.at("gamma");
        const double rho0 = values.at("density");
        const double c0 = values.at("sound_speed");
        const double tait = rho0 * c0 * c0 / gamma * (std::pow(*state.density / rho0, gamma) - 1);
        EXPECT_NEAR(tait / state.pressure, 1, 1e-9);
    }
}

TEST(Hydrostatic, IsExponentialForGammaOne) {
    const Values values{{"gamma", 1}, {"sound_speed", 5}};
    const double g = 9.81;
    EXPECT_NEAR(depth(values), 25 / g * std::log(1 + g * 0.4 / 25), 1e-15);
    const double y = 0.1;
    const double s = g * (depth(values) - y) / 25;
    const State state = column().bind(values)({0, y, 0}, 0);
    EXPECT_NEAR(*state.density, 1000 * std::exp(s), 1e-11);
    EXPECT_NEAR(state.pressure, 25 * (*state.density - 1000), 1e-9);
    Values near = values;
    double before = 1;
    for (const double excess : {1e-4, 1e-8, 1e-12}) {
        near["gamma"] = 1 + excess;
        const State approaching = column().bind(near)({0, y, 0}, 0);
        const double difference = std::abs(approaching.pressure / state.pressure - 1);
        EXPECT_LE(difference, std::max(excess, 2e-15));
        EXPECT_LT(difference, before);
        before = difference;
        EXPECT_NEAR(depth(near) / depth(values), 1, std::max(excess, 2e-15));
    }
}

TEST(Hydrostatic, BecomesIncompressible) {
    for (const double c0 : {1e3, 1e5, 1e7, 1e12}) {
        const Values values{{"sound_speed", c0}};
        const State state = column().bind(values)({0, 0.1, 0}, 0);
        const double H = depth(values);
        const double s = 9.81 * 0.3 / (c0 * c0);
        EXPECT_NEAR(state.pressure / (1000 * 9.81 * (H - 0.1)), 1, s + 2e-15);
        EXPECT_NEAR(*state.density / 1000, 1, 1.01 * s + 2e-15);
        EXPECT_NEAR(H, 0.4 - 9.81 * 0.16 / (2 * c0 * c0), 0.4 * s * s * 10 + 1e-16)
            << "to first order in 1/c0²";
    }
}

TEST(Hydrostatic, HasOgersFormsButForTheExponentInPrint) {
    const double c0 = 80;
    const double g = 9.81;
    const double gamma = 7;
    const Values values{{"sound_speed", c0}, {"depth", 1}};
    const double y = -0.5; // from the surface
    const auto base = [&](double at) { return 1 - (gamma - 1) * g * at / (c0 * c0); };
    const State state = column().bind(values)({0, depth(values) + y, 0}, 0);
    EXPECT_NEAR(*state.density, 1000 * std::pow(base(y), 1 / (gamma - 1)), 1e-10);
    const auto pressure = [&](double at, double exponent) {
        return 1000 * c0 * c0 / gamma * (std::pow(base(at), exponent) - 1);
    };
    EXPECT_NEAR(state.pressure, pressure(y, gamma / (gamma - 1)), 1e-7);
    const auto slope = [&](double exponent) {
        return derivatives([&](double s) { return pressure(y + s, exponent); }, 0.01).first;
    };
    EXPECT_NEAR(slope(gamma / (gamma - 1)), -*state.density * g, 1e-5);
    EXPECT_NEAR(slope(1 / (gamma - 1)) / (-*state.density * g), 1 / gamma, 2e-3)
        << "the exponent of the print";
}

} // namespace
} // namespace sphvv::analytic
