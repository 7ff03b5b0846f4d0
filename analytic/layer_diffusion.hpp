#pragma once

// Diffusion of momentum across a layer between parallel planes, 0 <= zeta <= 1, at the time tau = nu t/H^2
// (H the thickness). All functions are nondimensional solutions of df/dtau = d2f/dzeta2 + force.
//
// Each has two series that hold at every tau > 0: eigenfunctions, which decay as exp(-lambda^2 tau), and
// images of the solution in a half-space, which fall off as exp(-m^2/tau). The functions without suffix take
// the images below tau = switch_time and the eigenfunctions above; there eigenfunction_terms and image_terms
// leave out less than 1e-17. H. S. Carslaw & J. C. Jaeger, Conduction of Heat in Solids (2nd ed. 1959), ch.
// III (eigenfunctions), ch. XII (small times) and appendix II (repeated integrals of erfc).

namespace sphvv::analytic::layer {

inline constexpr double switch_time = 0.1;
inline constexpr int eigenfunction_terms = 8; ///< (8.5 pi)^2 · 0.1 = 71
inline constexpr int image_terms = 4;         ///< 4/sqrt(0.1) = 12.6; erfc(12.6) = 1e-70

/// A function of zeta at one time, with its derivative and its mean over the layer.
struct Profile {
    double value;
    double gradient;
    double mean;
};

/// From rest under a uniform force of 2, f(0) = 0, f'(1) = 0:
/// f = 2ζ − ζ² − Σ (4/λ³) sin(λζ) e^{−λ²τ}, λ = (n + ½)π;
/// f = 2τ {1 − Σ (−1)^m 4 [i²erfc((2m + ζ)/2√τ) + i²erfc((2m + 2 − ζ)/2√τ)]}.
Profile forced(double zeta, double tau);
Profile forced_by_eigenfunctions(double zeta, double tau, int terms = eigenfunction_terms);
Profile forced_by_images(double zeta, double tau, int terms = image_terms);
/// Its limit for late times, 2ζ − ζ².
Profile forced_steady(double zeta);

/// From f(ζ, 0) = ζ without force, f(0) = 0, f'(1) = 0 for τ > 0:
/// f = Σ (−1)^n (2/λ²) sin(λζ) e^{−λ²τ};
/// f = ζ − 2√τ Σ (−1)^m [ierfc((2m + 1 − ζ)/2√τ) − ierfc((2m + 1 + ζ)/2√τ)].
Profile released(double zeta, double tau);
Profile released_by_eigenfunctions(double zeta, double tau, int terms = eigenfunction_terms);
Profile released_by_images(double zeta, double tau, int terms = image_terms);

/// From rest without force, f(0) = 0, f(1) = 1 for τ > 0:
/// f = ζ + Σ (−1)^n (2/nπ) sin(nπζ) e^{−n²π²τ}, n = 1, 2, …;
/// f = Σ [erfc((2m + 1 − ζ)/2√τ) − erfc((2m + 1 + ζ)/2√τ)].
Profile dragged(double zeta, double tau);
Profile dragged_by_eigenfunctions(double zeta, double tau, int terms = eigenfunction_terms);
Profile dragged_by_images(double zeta, double tau, int terms = image_terms);

/// Mean of f² over the layer for f = (1 − s) forced + s forced_steady + a released, by Parseval's equation.
/// The sum runs until e^{−λ²τ} < 1e-17, at most over 1e5 terms, the rest by the Hurwitz zeta function.
double forced_square_mean(double s, double a, double tau);

/// Mean of f² over the layer for f = (1 − s) dragged + s ζ, likewise.
double dragged_square_mean(double s, double tau);

/// n-fold repeated integral of the complementary error function, 0 <= n: i⁰erfc = erfc,
/// iⁿerfc(x) = ∫_x^∞ iⁿ⁻¹erfc; by the recursion 2n iⁿ = iⁿ⁻² − 2x iⁿ⁻¹. Absolute error about 1e-16.
double repeated_erfc(int n, double x);

} // namespace sphvv::analytic::layer
