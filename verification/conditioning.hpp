#pragma once

#include "sphvv/verification/case.hpp"
#include "sphvv/verification/order.hpp"
#include "sphvv/verification/stability.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

/// Condition numbers of the discrete pressure equation (solver/linear/pressure_poisson.hpp) and iterations
/// of its solver against the number of particles, their disorder and the share of them at a free surface.
///
/// The matrix is A = D - W with weights w_ij of a Laplacian and D = diag(sum_j w_ij), in 2-D, with the
/// quintic spline at h = 1.3 dx and volumes dx^2. Its condition number is lambda_max/lambda_min on what is
/// left of the space without the null space (constants, where nothing is fixed); of a matrix that is not
/// symmetric, sigma_max/sigma_min of P A P, P the projection to zero mean.
namespace sphvv::verification {

enum class PressureBoundary {
    periodic, ///< in both directions
    closed,   ///< walls all around, with mirror images: pure Neumann
    surface   ///< periodic in x, a bed with mirror images below, p = 0 in the uppermost row
};
std::string_view to_string(PressureBoundary boundary);

/// `columns` by `rows` particles, dx = 1/columns (m).
struct PressureProblem {
    PressureBoundary boundary = PressureBoundary::periodic;
    int columns;
    int rows;
    double jitter = 0; ///< of dx
    std::uint64_t seed = 1;
    bool schwaiger = false;  ///< Schwaiger's Laplacian in place of Morris's
    bool coincident = false; ///< two of the particles at one place
    double mean = 0;         ///< of the right-hand side, whose rest is random in [-1, 1]
};

struct Extremes {
    double least;
    double greatest;
    double condition() const { return greatest / least; }
};

constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

/// What is measured of one matrix; NaN where something has no meaning.
struct Conditioning {
    PressureProblem problem;
    int unknowns = 0;
    double surface_share = 0;               ///< of the particles, with p = 0
    Extremes matrix{};                      ///< eigenvalues (singular values if not symmetric), 1/m2
    double condition_jacobi = not_measured; ///< of D^-1/2 A D^-1/2
    double greatest_jacobi = not_measured;  ///< its largest eigenvalue
    double diagonal_ratio = 0;              ///< max D/min D
    double asymmetry = 0;                   ///< max |w_ij - w_ji|/max w
    double negative_share = 0;              ///< of the weights
    double long_wave = not_measured; ///< least Rayleigh quotient of the four longest waves, 1/m2; periodic
    double least_of_field = not_measured; ///< of the field of values, x.A x/x.x, 1/m2; not symmetric only
    int iterations_jacobi = 0;
    int iterations_two_level = 0;
    bool converged = false;       ///< under both preconditioners
    double residual = 0;          ///< the larger of |b - A p|/|b|, of those that converged, formed anew
    double theory = not_measured; ///< condition number, where theory is exact
    double theory_jacobi = not_measured; ///< the same under Jacobi's scaling
};

constexpr double conditioning_tolerance = 1e-8; ///< of the solves
constexpr int conditioning_most_iterations = 5000;

Conditioning measure_conditioning(const PressureProblem& problem);

/// Extreme eigenvalues of the matrix of Morris's weights on the lattice, from the kernel alone (1/m2), and of
/// D^-1/2 A D^-1/2. Each wave along x is apart from every other. Where nothing is fixed, waves in y are
/// eigenvectors too: lambda(k) = sum_d w(d) (1 - cos k.d), w(d) = -2 dx^2 F(|d|), with k = 2 pi (a, b)/L
/// under periodicity and pi (a, b)/L between mirrors, whose images continue a solution evenly. Under a
/// surface a matrix over the rows is left for each wave along x.
struct LatticeTheory {
    Extremes matrix;
    Extremes jacobi;
};
LatticeTheory lattice_theory(PressureBoundary boundary, int columns, int rows);

/// Iterations of conjugate gradients under Jacobi's preconditioner until |r| <= tolerance |b|, at most:
///   ceil(sqrt(kappa)/2 ln(2 sqrt(kappa delta)/tolerance)),  kappa of D^-1/2 A D^-1/2, delta = max D/min D.
/// From |e_k|_A <= 2 ((sqrt(kappa) - 1)/(sqrt(kappa) + 1))^k |e_0|_A <= 2 exp(-2k/sqrt(kappa)) |e_0|_A (Saad,
/// Iterative Methods, 2nd ed., eq. 6.128). The residual of the scaled system is A^ e^, so |r^_k| <=
/// sqrt(lambda_max) |e_k|_A and |e_0|_A <= |r^_0|/sqrt(lambda_min): a factor sqrt(kappa). And r = D^1/2 r^:
/// a factor sqrt(delta).
int conjugate_gradient_bound(double condition_jacobi, double diagonal_ratio, double tolerance);

/// One statement with the band in which theory puts it.
struct ConditioningCheck {
    std::string subject; ///< which matrix, or which ladder
    std::string name;    ///< what is measured
    double value;
    double low;
    double high;
    std::string why;
    double tolerance = 0;  ///< difference of the value that a baseline allows, beyond 1 %
    std::string verdict{}; ///< PASS, FAIL or INCONCLUSIVE
    std::string reason{};
};

/// PASS inside [low, high]; FAIL outside, and for what is not finite. A check with a verdict keeps it.
void judge(ConditioningCheck& check);

struct ConditioningStudy {
    std::string name;
    Tier tier;
    std::string summary;
    double cost;                 ///< s: the budget, processor time
    std::vector<int> ladder;     ///< particles per side, of matrices against N
    std::vector<int> disordered; ///< the same, with 10 % jitter and five seeds
    int side;                    ///< of the sweep over disorder, and of closed boxes
    std::vector<int> depths;     ///< rows, that of the surface among them
};
std::span<const ConditioningStudy> conditioning_studies();

struct ConditioningResults {
    std::string study;
    std::vector<Conditioning> rows;
    std::vector<ConditioningCheck> checks;
    double seconds = 0;
};

/// Runs a study. What a matrix throws is a FAIL with that text; it keeps no other from being measured.
ConditioningResults run_conditioning(const ConditioningStudy& study, const StabilityProgress& progress = {});

std::string markdown(const ConditioningResults& results);
/// Adds `conditioning_rows` and `conditioning_checks` (reports/FORMAT.md).
void add_to_document(std::span<const ConditioningResults> results, nlohmann::ordered_json& document);
/// 1 if a check does not pass.
int exit_status(std::span<const ConditioningResults> results);

} // namespace sphvv::verification
