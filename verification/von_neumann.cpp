#include "sphvv/verification/von_neumann.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace sphvv::verification {
namespace {

using Complex = std::complex<double>;
using Vector = Eigen::Vector2d;
using Matrix = Eigen::Matrix2d;
constexpr Complex i_unit{0, 1};
constexpr int verlet_cycle = 50; // the key restart_interval of wcsph

/// V gradW, V grad gradW and V (d.gradW)/(d^2 + eta^2) of a neighbour at d.
struct Neighbour {
    Vector d;
    Vector slope;
    Matrix curvature;
    double morris;
    Matrix monaghan_cleary;
};

std::vector<Neighbour> neighbours_of(const LatticeState& state) {
    const double h = state.h_over_dx * state.dx;
    const double volume = state.dx * state.dx;
    const double radius = state.kernel->support * h;
    const double eta = state.eta_over_h * h;
    const int reach = static_cast<int>(radius / state.dx);
    const double step = 1e-5 * h;
    std::vector<Neighbour> neighbours;
    for (int a = -reach; a <= reach; ++a) {
        for (int b = -reach; b <= reach; ++b) {
            const Vector d(a * state.dx, b * state.dx);
            const double r = d.norm();
            if (r == 0 || r >= radius) {
                continue;
            }
            const auto slope = [&](double at) { return volume * at * state.kernel->slope(2, at, h); };
            const Vector e = d / r;
            const double along = (slope(r + step) - slope(r - step)) / (2 * step);
            const Matrix ee = e * e.transpose();
            const double over = r / (r * r + eta * eta);
            neighbours.push_back({d, slope(r) * e, along * ee + slope(r) / r * (Matrix::Identity() - ee),
                                  slope(r) * over, slope(r) * over * ee});
        }
    }
    return neighbours;
}

/// The sums of the equations at one wave vector.
struct Symbols {
    Vector g = Vector::Zero();
    Matrix K = Matrix::Zero();
    Matrix N = Matrix::Zero();
    double l = 0;     ///< minus Morris's Laplacian
    double alpha = 0; ///< of grad x: what the normalised operators divide by
};

Symbols symbols(const LatticeState& state, const std::vector<Neighbour>& neighbours, const Vector& k) {
    Symbols sums;
    for (const Neighbour& j : neighbours) {
        const double even = 1 - std::cos(k.dot(j.d));
        sums.g += std::sin(k.dot(j.d)) * j.slope;
        sums.K += 2 * even * j.curvature;
        sums.N += state.viscosity * even *
                  (state.monaghan_cleary ? Matrix(8 * j.monaghan_cleary)
                                         : Matrix(2 * j.morris * Matrix::Identity()));
        sums.l -= 2 * even * j.morris;
        sums.alpha -= 0.5 * j.d.dot(j.slope);
    }
    return sums;
}

/// Rates of (xi, v, s).
Eigen::MatrixXcd rates(const LatticeState& state, const Symbols& of) {
    const double specific = state.pressure / state.density;
    const double elastic = state.sound_speed * state.sound_speed - 2 * specific;
    Eigen::MatrixXcd R = Eigen::MatrixXcd::Zero(5, 5);
    R.block<2, 2>(0, 2).setIdentity();
    R.block<2, 2>(2, 0) = (-specific * of.K).cast<Complex>();
    R.block<2, 2>(2, 2) = of.N.cast<Complex>();
    R.block<2, 1>(2, 4) = i_unit * elastic * of.g.cast<Complex>();
    R.block<1, 2>(4, 2) = i_unit * of.g.transpose().cast<Complex>();
    return R;
}

/// v with the old rates, then xi and s with the new v.
Eigen::MatrixXcd explicit_step(const Eigen::MatrixXcd& R, double dt) {
    Eigen::MatrixXcd kick = Eigen::MatrixXcd::Identity(5, 5);
    Eigen::MatrixXcd drift = Eigen::MatrixXcd::Identity(5, 5);
    kick.block(2, 0, 2, 5) += dt * R.block(2, 0, 2, 5);
    drift.block(0, 2, 2, 2) += dt * R.block(0, 2, 2, 2);
    drift.block(4, 2, 1, 2) += dt * R.block(4, 2, 1, 2);
    return drift * kick;
}

/// (xi, v, s, v before, s before): v and s from those before and twice the rates, or from their own and the
/// rates; xi += dt v + dt^2/2 dv/dt.
Eigen::MatrixXcd verlet_step(const Eigen::MatrixXcd& R, double dt, bool leap) {
    Eigen::MatrixXcd A = Eigen::MatrixXcd::Zero(8, 8);
    A.block(0, 0, 2, 5) = dt * R.block(0, 0, 2, 5) + dt * dt / 2 * R.block(2, 0, 2, 5);
    A.block(0, 0, 2, 2) += Eigen::Matrix2cd::Identity();
    A.block(2, 0, 3, 5) = (leap ? 2 * dt : dt) * R.block(2, 0, 3, 5);
    A.block(2, leap ? 5 : 2, 3, 3) += Eigen::Matrix3cd::Identity();
    A.block(5, 2, 3, 3).setIdentity();
    return A;
}

double spectral_radius(const Eigen::MatrixXcd& A) {
    const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> solver(A, false);
    return solver.eigenvalues().cwiseAbs().maxCoeff();
}

double growth_of(const LatticeState& state, Stepping stepping, const Symbols& of, double dt) {
    switch (stepping) {
    case Stepping::explicit_euler:
        return spectral_radius(explicit_step(rates(state, of), dt));
    case Stepping::predictor_corrector: {
        const Eigen::MatrixXcd R = dt * rates(state, of);
        return spectral_radius(Eigen::MatrixXcd::Identity(5, 5) + R + 0.5 * R * R);
    }
    case Stepping::verlet: {
        const Eigen::MatrixXcd R = rates(state, of);
        const Eigen::MatrixXcd leap = verlet_step(R, dt, true);
        Eigen::MatrixXcd cycle = verlet_step(R, dt, false);
        for (int k = 1; k < verlet_cycle; ++k) {
            cycle = leap * cycle;
        }
        return std::pow(spectral_radius(cycle), 1. / verlet_cycle);
    }
    case Stepping::projection:
        break;
    }
    const Vector g = of.g / of.alpha;
    const Matrix projection = Matrix::Identity() - g * g.transpose() / of.l;
    const Matrix A = projection * (Matrix::Identity() + dt * of.N);
    return spectral_radius(A.cast<Complex>());
}

std::vector<Symbols> modes(const LatticeState& state, int n) {
    const std::vector<Neighbour> neighbours = neighbours_of(state);
    const double unit = 2 * std::numbers::pi / (n * state.dx);
    std::vector<Symbols> all;
    for (int a = 1; a <= n / 2; ++a) {
        for (int b = 0; b <= a; ++b) { // the others are mirror images
            all.push_back(symbols(state, neighbours, {a * unit, b * unit}));
        }
    }
    return all;
}

double growth_of(const LatticeState& state, Stepping stepping, const std::vector<Symbols>& modes, double dt) {
    double largest = 0;
    for (const Symbols& mode : modes) {
        largest = std::max(largest, growth_of(state, stepping, mode, dt));
    }
    return largest;
}

} // namespace

std::string_view to_string(Stepping stepping) {
    switch (stepping) {
    case Stepping::explicit_euler:
        return "explicit";
    case Stepping::predictor_corrector:
        return "predictor_corrector";
    case Stepping::verlet:
        return "verlet";
    case Stepping::projection:
        break;
    }
    return "projection";
}

double growth_factor(const LatticeState& state, Stepping stepping, double dt, int n) {
    return growth_of(state, stepping, modes(state, n), dt);
}

double stability_limit(const LatticeState& state, Stepping stepping, double from, int n) {
    const std::vector<Symbols> all = modes(state, n);
    const auto grows = [&](double dt) { return growth_of(state, stepping, all, dt) > unstable_growth; };
    if (grows(from)) {
        return 0;
    }
    double low = from;
    double high = 1.05 * from; // in small steps: a window of stability may follow the first instability
    for (; !grows(high); low = high, high *= 1.05) {
        if (high > 1e4 * from) {
            return std::numeric_limits<double>::infinity();
        }
    }
    while (high > (1 + 1e-6) * low) {
        const double middle = std::sqrt(low * high);
        (grows(middle) ? high : low) = middle;
    }
    return low;
}

} // namespace sphvv::verification
