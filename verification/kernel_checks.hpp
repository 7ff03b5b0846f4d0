#pragma once

#include "sphvv/solver/kernels.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sphvv::verification {

/// One property of a smoothing kernel W(r) = C_dim / h^dim f(q), q = r/h, measured. All numbers are pure.
struct KernelCheck {
    std::string kernel;
    int dimension;     ///< 1, 2, 3; 0 for a property of f, the same in every dimension
    std::string check; ///< what is measured, one of the names that check_kernel lists
    double value;
    double expected;
    double tolerance; ///< of the value
    bool passes;      ///< |value - expected| <= tolerance, but for the inequalities that check_kernel names
    std::string why;  ///< where the expectation comes from, and what the number means in a simulation
};

/// Every property that a kernel owes or declares:
///
///   unit integral             int W dV = 1
///   gradient of a linear field  int F r^2 dV = -dim, with F = W'/r, by parts; a value that jumps to zero at
///                             the edge adds the surface term S_dim C_dim s^dim f(s), s = support
///   second moment             int W r^2 dV / h^2, against -int F r^4 dV / ((dim + 2) h^2) by parts
///   transform                 least Fourier transform over 0 < kh <= 30; >= 0 if so declared, else < 0
///   derivative                f' against central differences of f
///   slopes                    slopes() against f'(q)/q, in one batch, and finite at r = 0
///   positivity                number of samples inside the support with f <= 0
///   monotonicity              largest rise of f, and of f' above zero
///   value at the edge         f/f(0) just inside the support; a declared jump must be there
///   slope at the edge         f'/f(0) just inside the support
///   slope at the origin       f'(0)/f(0)
///   beyond the support        largest of |f|, |f'|, |F|
///   smoothness                continuous derivatives in space, from the rate at which differences fall
///   steepest                  q where -f' is largest, against the inflection of f by differences
///
/// The first four for dim = 1, 2, 3. The first moment, int W r_vec dV = 0, needs no check: W depends on the
/// distance alone. A property that cannot be evaluated (NaN) fails. The derivative is measured away from the
/// multiples of h/4, where the pieces of a spline may meet; more than 6 derivatives cannot be told apart.
///
/// Sources: Xu 2009 §2.1.4 (steepest), Dehnen & Aly 2012 (transform), Fornberg 1988 (differences).
std::vector<KernelCheck> check_kernel(const solver::Kernel& kernel);

/// The unit integral of a kernel in `dimension` dimensions.
KernelCheck unit_integral(const solver::Kernel& kernel, int dimension);

/// A normalisation that is in print or in use and wrong for the kernel's profile f(q).
struct KnownError {
    std::string_view name;
    std::string_view printed; ///< as it stands there
    std::string_view source;
    std::string_view kernel;
    int dimension;
    double constant; ///< what it makes of C_dim
};

std::span<const KnownError> known_errors();

/// The unit integral with the printed constant. Passes if that check refuses it; `value` is the integral.
KernelCheck check_known_error(const KnownError& error);

} // namespace sphvv::verification
