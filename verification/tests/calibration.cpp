// The law of a calibration, from results made up of powers.
#include "sphvv/verification/calibration.hpp"

#include "sphvv/solver/error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sphvv::verification {
namespace {

Calibration at(double dx, double dt, std::optional<double> usable) {
    Calibration result;
    result.dx = dx;
    result.dt = dt;
    result.usable = usable;
    return result;
}

TEST(Law, RecoversItsPowers) {
    std::vector<Calibration> results;
    for (const double dx : {0.01, 0.005, 0.0025}) {
        for (const double dt : {1e-3, 5e-4}) {
            results.push_back(at(dx, dt, 3 * std::pow(dx, 5) * std::pow(dt, -2)));
        }
    }
    results.push_back(at(0.1, 1, std::nullopt)); // of no use
    const auto law = calibration_law(results);
    ASSERT_TRUE(law && law->of_dx && law->of_dt);
    EXPECT_NEAR(*law->of_dx, 5, 1e-9);
    EXPECT_NEAR(*law->of_dt, -2, 1e-9);
    EXPECT_NEAR(std::exp(law->log_constant), 3, 1e-6);
}

TEST(Law, HasNoExponentOfWhatDoesNotVary) {
    const std::vector results{at(0.01, 1e-3, 0.1), at(0.005, 1e-3, 0.025)};
    const auto law = calibration_law(results);
    ASSERT_TRUE(law && law->of_dx);
    EXPECT_FALSE(law->of_dt);
    EXPECT_NEAR(*law->of_dx, 2, 1e-9);
    EXPECT_FALSE(calibration_law(std::span(results).first(1)));
}

TEST(Calibration, RefusesWhatItCannotRun) {
    EXPECT_THROW(check_calibration({.scheme = variant_of("isph_dfs")}, 0.01, 1e-3), UserError);
    EXPECT_THROW(check_calibration({.scheme = variant_of("isph_asai")}, 0.03, 1e-3), UserError);
    EXPECT_NO_THROW(check_calibration({.scheme = variant_of("isph_asai")}, 0.01, 1e-3));
}

} // namespace
} // namespace sphvv::verification
