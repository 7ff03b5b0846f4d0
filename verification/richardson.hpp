#pragma once

#include <optional>
#include <span>
#include <string>

namespace sphvv::verification {

/// A quantity computed at one resolution.
struct Resolved {
    double h;     ///< particle spacing or smoothing length, m
    double value; ///< any unit
};

/// How three values of a quantity follow each other from coarse to fine.
enum class Approach {
    monotone,    ///< towards a limit: an order and a limit exist
    oscillatory, ///< the two changes have opposite signs
    divergent,   ///< the changes do not shrink: the order would be zero or negative
    undetermined ///< a change is lost in round-off, a value is not finite, or the order would exceed 30
};

/// What three resolutions say without an exact solution. Everything optional is present for a monotone
/// approach only; nothing is invented for the others.
struct Richardson {
    Approach approach;
    std::string reason;                 ///< one clause with the numbers that decided
    std::optional<double> order;        ///< observed order p
    std::optional<double> extrapolated; ///< the limit h -> 0, in the unit of the values
    std::optional<double> gci_fine;     ///< grid convergence index of the fine and middle rungs
    std::optional<double> gci_coarse;   ///< grid convergence index of the middle and coarse rungs
    bool gci_relative; ///< false where the fine or middle value is zero: in the unit of the values
    std::optional<double> asymptotic_ratio; ///< gci_coarse / (r^p gci_fine)
    bool in_asymptotic_range;               ///< asymptotic_ratio within 10 % of one
};

/// Richardson extrapolation and grid convergence index (GCI) from exactly three rungs, f1 fine, f2, f3
/// coarse, under f = f0 + C h^p, with r21 = h2/h1 and r32 = h3/h2:
///
///   (f3 - f2)/(f2 - f1) = r21^p (r32^p - 1)/(r21^p - 1),  solved for p by Brent's method
///   f0 = f1 + (f1 - f2)/(r21^p - 1)
///   GCI_fine = 1.25 |(f2 - f1)/f1|/(r21^p - 1)
///   GCI_coarse = 1.25 |(f3 - f2)/f2|/(r32^p - 1)
///
/// (Roache, J. Fluids Eng. 116 (1994) 405, with the factor 1.25 of his later work on three grids; unequal
/// ratios as Celik et al., J. Fluids Eng. 130 (2008) 078001).
///
/// The check of the asymptotic range is GCI_coarse/(r21^p GCI_fine) = 1. With the observed p it reduces to
/// |f1/f2|, since three values cannot contradict three unknowns, and rejects only rungs that differ grossly;
/// with the `formal_order` of the scheme in its place it is a real check.
///
/// The rungs may come in any order. Throws std::invalid_argument for another number of rungs, an h that is
/// repeated or not positive, and a formal order that is not positive.
Richardson richardson(std::span<const Resolved> rungs, std::optional<double> formal_order = std::nullopt);

} // namespace sphvv::verification
