#pragma once

#include <array>
#include <span>
#include <string_view>

namespace sphvv::solver {

/// Declaration of a smoothing kernel W(r) = C_dim / h^dim f(q), q = r/h. One file in solver/kernels/ defines
/// one.
struct Kernel {
    std::string_view name;
    std::string_view summary;
    std::string_view formula; ///< f(q)
    std::string_view source;
    double support;                      ///< q beyond which f vanishes
    std::array<double, 4> normalisation; ///< C_dim, dim = 1, 2, 3 (entry 0 unused)
    /// Number of continuous derivatives of W in space, the least of those at r = 0, inside and at the edge of
    /// the support; -1 for a value that jumps. An odd power |r|^k has only k - 1 of them at r = 0, however
    /// smooth f(q) is: a cone (f'(0) < 0) has smoothness 0.
    int smoothness;
    /// Whether the Fourier transform of W is nowhere negative, dim = 1, 2, 3 (entry 0 unused): what
    /// Dehnen & Aly 2012 demand lest particles pair. It depends on the dimension.
    std::array<bool, 4> nonnegative_transform;
    double (*f)(double q);
    double (*derivative)(double q); ///< f'(q); at q = 0 the limit from q > 0
    /// slope[k] = scale f'(q)/q with q = sqrt(squared_distance[k])/h; finite at r = 0 (0 where f'(q)/q has no
    /// limit) and zero outside the support.
    void (*slopes)(std::span<const double> squared_distance, double h, double scale, double* slope);
    /// value[k] = scale f(q) with q = sqrt(squared_distance[k])/h.
    void (*values)(std::span<const double> squared_distance, double h, double scale, double* value);

    /// W(r) in `dim` dimensions, 1/m^dim.
    double value(int dim, double r, double h) const;
    /// F(r) = W'(r)/r, so that the gradient of W(r_ij) with respect to r_i is F r_ij; 1/m^(dim+2).
    double slope(int dim, double r, double h) const;
    /// The factor in front of f(q) in W: C_dim / h^dim.
    double value_scale(int dim, double h) const;
    /// The factor in front of f'(q)/q in F: C_dim / h^(dim+2).
    double slope_scale(int dim, double h) const;
};

/// Makes a Kernel's batch functions from a type with static members f, derivative and derivative_over_q. The
/// loops have no branch and no call left after inlining (but for the Gaussian's f), so that they vectorise.
template <class Profile>
void kernel_slopes(std::span<const double> squared_distance, double h, double scale, double* slope) {
    const double inverse_h = 1 / h;
    const std::size_t count = squared_distance.size();
    const double* r2 = squared_distance.data();
#pragma omp simd
    for (std::size_t k = 0; k < count; ++k) {
        slope[k] = scale * Profile::derivative_over_q(__builtin_sqrt(r2[k]) * inverse_h);
    }
}

template <class Profile>
void kernel_values(std::span<const double> squared_distance, double h, double scale, double* value) {
    const double inverse_h = 1 / h;
    const std::size_t count = squared_distance.size();
    const double* r2 = squared_distance.data();
#pragma omp simd
    for (std::size_t k = 0; k < count; ++k) {
        value[k] = scale * Profile::f(__builtin_sqrt(r2[k]) * inverse_h);
    }
}

namespace kernels {
/// Every kernel in solver/kernels/, in the order of the file names.
std::span<const Kernel* const> all();
/// The kernel of that name. Throws UserError naming the accepted ones.
const Kernel& find(std::string_view name);
} // namespace kernels

} // namespace sphvv::solver
