#pragma once

#include <span>
#include <vector>

namespace sphvv::verification {

/// Error of one field. Absolute norms are in the field's unit and obey l1_abs <= l2_abs <= linf_abs; the
/// relative ones (nondimensional by the same norm of the reference) have different denominators and need not
/// be ordered.
struct Norms {
    double l1, l2, linf;             ///< relative if `relative`, else equal to the absolute ones
    double l1_abs, l2_abs, linf_abs; ///< in the field's unit
    bool relative;                   ///< false where the reference vanishes (one of its norms below 1e-300)
};

/// Volume-weighted error norms of a scalar field against its reference at the same points:
///   L1 = sum V|e| / sum V,  L2 = sqrt(sum V e^2 / sum V),  Linf = max|e|,  e = value - reference,
/// relative forms divided by the same norm of the reference. The weight stands outside the p-th power, so
/// that a constant error has the same norms at any resolution. One entry a particle in all three arrays;
/// `volume` in m^d (only ratios matter). A NaN anywhere in value or reference gives NaN norms, never a norm
/// of the remaining particles. Throws std::invalid_argument for empty arrays, different lengths, and volumes
/// that are not positive and finite.
Norms scalar_norms(std::span<const double> value, std::span<const double> reference,
                   std::span<const double> volume);

/// Error norms of a vector field; |e| is the Euclidean length of the error vector, so a wrong direction
/// counts as much as a wrong magnitude. One span a component (1, 2 or 3, or more), in the same order for
/// value and reference. Shapes, NaN and exceptions as scalar_norms.
Norms vector_norms(std::span<const std::span<const double>> value_components,
                   std::span<const std::span<const double>> reference_components,
                   std::span<const double> volume);

/// The field minus its volume mean, value - sum V value / sum V. Same unit; exceptions as scalar_norms.
std::vector<double> mean_removed(std::span<const double> value, std::span<const double> volume);

/// scalar_norms of a field that is defined only up to a constant (pressure without free surface or Dirichlet
/// point): the volume mean is first removed from both sides. A reference constant to round-off has nothing
/// left to divide by, and its norms are absolute.
Norms scalar_norms_up_to_a_constant(std::span<const double> value, std::span<const double> reference,
                                    std::span<const double> volume);

} // namespace sphvv::verification
