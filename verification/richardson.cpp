#include "sphvv/verification/richardson.hpp"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_roots.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <sstream>
#include <stdexcept>

namespace sphvv::verification {
namespace {

constexpr double safety_factor = 1.25;
constexpr double lowest_order = 1e-6;
constexpr double highest_order = 30; // beyond it the finer change is an accident, not a convergence
constexpr double asymptotic_tolerance = 0.1;
constexpr double lost_in_round_off = 8 * std::numeric_limits<double>::epsilon();

/// Three rungs from fine to coarse, as the literature numbers them.
struct Triplet {
    Resolved fine, middle, coarse;

    double r21() const { return middle.h / fine.h; }
    double r32() const { return coarse.h / middle.h; }
    double change21() const { return middle.value - fine.value; }
    double change32() const { return coarse.value - middle.value; }
};

std::string number(double x) {
    std::ostringstream text;
    text.precision(4);
    text << x;
    return text.str();
}

Triplet fine_to_coarse(std::span<const Resolved> rungs) {
    if (rungs.size() != 3) {
        throw std::invalid_argument("Richardson extrapolation takes 3 rungs; it was given " +
                                    std::to_string(rungs.size()));
    }
    std::array<Resolved, 3> sorted{rungs[0], rungs[1], rungs[2]};
    for (const Resolved& rung : sorted) {
        if (!(rung.h > 0) || !std::isfinite(rung.h)) {
            throw std::invalid_argument(
                "Richardson extrapolation needs positive finite h; one rung has h = " + number(rung.h));
        }
    }
    std::sort(sorted.begin(), sorted.end(), [](const Resolved& a, const Resolved& b) { return a.h < b.h; });
    if (sorted[0].h == sorted[1].h || sorted[1].h == sorted[2].h) {
        throw std::invalid_argument(
            "Richardson extrapolation needs three different h; h = " + number(sorted[1].h) + " is repeated");
    }
    return {sorted[0], sorted[1], sorted[2]};
}

/// log of change32/change21 as order p makes it; grows with p.
double log_change_ratio(const Triplet& rungs, double p) {
    const double log_r21 = std::log(rungs.r21());
    const double log_r32 = std::log(rungs.r32());
    return p * log_r21 + std::log(std::expm1(p * log_r32) / std::expm1(p * log_r21));
}

/// The p between the two bounds at which log_change_ratio has the observed value.
double solve_order(const Triplet& rungs) {
    struct Equation {
        const Triplet* rungs;
        double observed;
    } equation{&rungs, std::log(rungs.change32() / rungs.change21())};
    gsl_function mismatch{[](double p, void* parameters) {
                              const auto& e = *static_cast<const Equation*>(parameters);
                              return log_change_ratio(*e.rungs, p) - e.observed;
                          },
                          &equation};
    const std::unique_ptr<gsl_root_fsolver, void (*)(gsl_root_fsolver*)> solver(
        gsl_root_fsolver_alloc(gsl_root_fsolver_brent), &gsl_root_fsolver_free);
    gsl_root_fsolver_set(solver.get(), &mismatch, lowest_order, highest_order);
    for (int step = 0; step < 200; ++step) {
        gsl_root_fsolver_iterate(solver.get());
        const double low = gsl_root_fsolver_x_lower(solver.get());
        const double high = gsl_root_fsolver_x_upper(solver.get());
        if (gsl_root_test_interval(low, high, 0, 1e-14) == GSL_SUCCESS) {
            break;
        }
    }
    return gsl_root_fsolver_root(solver.get());
}

Richardson without_order(Approach approach, const std::string& reason) {
    return {approach,     reason, std::nullopt, std::nullopt, std::nullopt,
            std::nullopt, false,  std::nullopt, false};
}

double change_over_power(double change, double ratio, double p) {
    return std::abs(change) / std::expm1(p * std::log(ratio));
}

/// (f2 - f1)/(r21^p - 1) and (f3 - f2)/(r32^p - 1) are the errors of f1 and f2, whose ratio is to be r21^p.
double asymptotic_ratio(const Triplet& rungs, double p, double fine_scale, double middle_scale) {
    const double fine = change_over_power(rungs.change21(), rungs.r21(), p) / fine_scale;
    const double middle = change_over_power(rungs.change32(), rungs.r32(), p) / middle_scale;
    return middle / (std::pow(rungs.r21(), p) * fine);
}

Richardson with_order(const Triplet& rungs, double p, double checked_order) {
    const bool relative = rungs.fine.value != 0 && rungs.middle.value != 0;
    const double fine_scale = relative ? std::abs(rungs.fine.value) : 1;
    const double middle_scale = relative ? std::abs(rungs.middle.value) : 1;
    const double ratio = asymptotic_ratio(rungs, checked_order, fine_scale, middle_scale);
    const double correction = rungs.change21() / std::expm1(p * std::log(rungs.r21()));
    return {Approach::monotone,
            "observed order " + number(p) + ", asymptotic ratio " + number(ratio),
            p,
            rungs.fine.value - correction,
            safety_factor * change_over_power(rungs.change21(), rungs.r21(), p) / fine_scale,
            safety_factor * change_over_power(rungs.change32(), rungs.r32(), p) / middle_scale,
            relative,
            ratio,
            std::abs(ratio - 1) <= asymptotic_tolerance};
}

} // namespace

Richardson richardson(std::span<const Resolved> rungs, std::optional<double> formal_order) {
    if (formal_order && !(*formal_order > 0)) {
        throw std::invalid_argument("the formal order of the asymptotic check must be positive; it is " +
                                    number(*formal_order));
    }
    const Triplet triplet = fine_to_coarse(rungs);
    const auto [fine, middle, coarse] = triplet;
    for (const Resolved& rung : {fine, middle, coarse}) {
        if (!std::isfinite(rung.value)) {
            return without_order(Approach::undetermined,
                                 "the value at h = " + number(rung.h) + " is " + number(rung.value));
        }
    }
    const double change21 = triplet.change21();
    const double change32 = triplet.change32();
    const std::string changes = "changes " + number(change32) + " then " + number(change21);
    const double rounding =
        lost_in_round_off * std::max({std::abs(fine.value), std::abs(middle.value), std::abs(coarse.value)});
    if (std::abs(change21) <= rounding || std::abs(change32) <= rounding) {
        return without_order(Approach::undetermined, changes + " are lost in round-off");
    }
    if ((change21 < 0) != (change32 < 0)) {
        return without_order(Approach::oscillatory, changes + " have opposite signs");
    }
    const double observed = std::log(change32 / change21);
    if (observed <= log_change_ratio(triplet, lowest_order)) {
        return without_order(Approach::divergent, changes + " do not shrink with h");
    }
    if (observed >= log_change_ratio(triplet, highest_order)) {
        return without_order(Approach::undetermined,
                             changes + " would need an order above " + number(highest_order));
    }
    const double order = solve_order(triplet);
    return with_order(triplet, order, formal_order.value_or(order));
}

} // namespace sphvv::verification
