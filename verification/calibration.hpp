#pragma once

#include "sphvv/verification/scene.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

/// Calibration of the relaxation of the density in a pressure equation by a column of water at rest. Source:
/// Asai 2012 (the pre-analysis): the largest alpha for which the pressure at the bed stays steady at rho g H.
namespace sphvv::verification {

/// What is calibrated. The column starts from a lattice with a jitter, as a flow leaves it: on a lattice
/// every alpha is steady, because the density has no noise that its relaxation could turn into pressure.
struct CalibrationRequest {
    Variant scheme; ///< has the key "relaxation"
    solver::Assignments settings{};
    double depth = 0.2;     ///< H, m
    double duration = 1;    ///< s
    double smallest = 1e-6; ///< alpha from here
    double largest = 1;     ///< to here
    int bisections = 4;     ///< of a decade, in log alpha: the edges are known to 10^(1/16), 15 %
};

/// The bed's pressure over the last half of one run, over rho g H.
struct CalibrationRun {
    double alpha = 0;
    double mean = 0;
    double fluctuation = 0;  ///< root mean square about the mean
    double closest = 0;      ///< smallest pair distance / dx
    std::string diagnosis{}; ///< of a run that ended early
    bool steady = false;
};

/// Steady: |mean - 1| <= 5 % + dx/(2H) and a fluctuation of at most 5 %. The second term is what p = 0 at the
/// centres of the surface row, half a spacing below the surface, takes from the pressure.
constexpr double steady_share = 0.05;

struct Calibration {
    double dx = 0;                      ///< m
    double gravity = 0;                 ///< m/s2
    double dt = 0;                      ///< s
    std::vector<CalibrationRun> runs{}; ///< in the order in which they were made; the first has alpha = 0
    std::optional<double> usable{};     ///< the largest alpha that is steady, none if no decade is
    std::optional<double> lowest{}; ///< the smallest of the steady decades next to it, 0 if all are and 0 is
    std::optional<double>
        recommended{}; ///< half of the largest: a factor 2 from where the pressure stops being steady
};

/// alpha = constant dx^a dt^b by least squares, each exponent only if more than one dx or dt was usable.
struct CalibrationLaw {
    double log_constant = 0;
    std::optional<double> of_dx;
    std::optional<double> of_dt;
};

/// A range that is published for one spacing, with a time step that is not stated in our copy.
struct PublishedRelaxation {
    double dx; ///< m
    double low;
    double high;
    double used;
};
std::span<const PublishedRelaxation> published_relaxations();

/// Throws UserError for a scheme without the key, or a depth that is no whole number of dx.
Calibration calibrate(const CalibrationRequest& request, double dx, double dt,
                      const std::function<void(double alpha, double fraction)>& progress);

/// Throws as calibrate(), before anything runs.
void check_calibration(const CalibrationRequest& request, double dx, double dt);

/// None with fewer than two usable results.
std::optional<CalibrationLaw> calibration_law(std::span<const Calibration> results);

/// Tables, the law and what theory says of it.
std::string markdown(const CalibrationRequest& request, std::span<const Calibration> results);

} // namespace sphvv::verification
