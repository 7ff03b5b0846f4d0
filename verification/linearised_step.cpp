#include "sphvv/verification/linearised_step.hpp"

#include "sphvv/verification/von_neumann.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace sphvv::verification {
namespace {

using Complex = std::complex<double>;

constexpr double size_of_disturbance = 1e-5; // in units of dx, dt and rho dx^2
constexpr double no_dependence = 1e-7;       // of a column, above what the pressure solver leaves

/// Every component of the state of a particle, position first.
std::vector<std::vector<double>*> state_of(solver::Particles<2>& particles) {
    std::vector<std::vector<double>*> state;
    for (solver::Field& field : particles.fields()) {
        if (field.lifetime == solver::Lifetime::state) {
            for (std::vector<double>& component : field.components) {
                state.push_back(&component);
            }
        }
    }
    return state;
}

/// The states, component by component and particle by particle in the order of their lattice points, after a
/// step that starts with component `disturbed` of particle 0 off by `by`.
Eigen::MatrixXd stepped(const LatticeScene& scene, double dt, int step, int disturbed, double by) {
    solver::Simulation<2> s = lattice_simulation(scene, dt);
    const auto before = state_of(s.particles);
    (*before[disturbed])[0] += by;
    s.step = step - 1;
    s.time_step = 1; // that of the step before
    advance(s);
    const auto after = state_of(s.particles);
    Eigen::MatrixXd states(static_cast<Eigen::Index>(after.size()), s.particles.size());
    for (std::size_t c = 0; c < after.size(); ++c) {
        for (std::size_t k = 0; k < s.particles.size(); ++k) {
            states(static_cast<Eigen::Index>(c), s.particles.id[k]) = (*after[c])[k];
        }
    }
    return states;
}

/// Rows: components of the state of every particle, after a step; one matrix for each component of particle 0
/// before it.
std::vector<Eigen::MatrixXd> responses(const LatticeScene& scene, double dt, int step) {
    solver::Simulation<2> undisturbed = lattice_simulation(scene, dt);
    const int components = static_cast<int>(state_of(undisturbed.particles).size());
    std::vector<Eigen::MatrixXd> result;
    for (int c = 0; c < components; ++c) {
        Eigen::MatrixXd difference = stepped(scene, dt, step, c, size_of_disturbance) -
                                     stepped(scene, dt, step, c, -size_of_disturbance);
        // A particle may have left through a side in one of the two.
        difference.topRows<2>() = difference.topRows<2>().unaryExpr(
            [&](double moved) { return moved - scene.n * std::round(moved / scene.n); });
        result.push_back(difference / (2 * size_of_disturbance));
    }
    return result;
}

/// Leaves out components on which nothing depends: they add eigenvalues of 0.
void keep_what_matters(std::vector<Eigen::MatrixXcd>& modes) {
    std::vector<Eigen::Index> kept;
    for (Eigen::Index c = 0; c < modes.front().cols(); ++c) {
        if (std::ranges::any_of(modes, [&](const Eigen::MatrixXcd& M) {
                return M.col(c).cwiseAbs().maxCoeff() > no_dependence;
            })) {
            kept.push_back(c);
        }
    }
    for (Eigen::MatrixXcd& M : modes) {
        M = Eigen::MatrixXcd(M(kept, kept));
    }
}

double spectral_radius(const Eigen::MatrixXcd& A) {
    return Eigen::ComplexEigenSolver<Eigen::MatrixXcd>(A, false).eigenvalues().cwiseAbs().maxCoeff();
}

} // namespace

std::vector<Eigen::MatrixXcd> linearised_step(const LatticeScene& scene, double dt, int step) {
    const int n = scene.n;
    const std::vector<Eigen::MatrixXd> all = responses(scene, dt, step);
    const auto size = static_cast<Eigen::Index>(all.size());
    std::vector<Eigen::MatrixXcd> modes;
    for (int a = 0; a <= n / 2; ++a) {
        for (int b = 0; b < n; ++b) {
            const bool mean = a == 0 && b == 0;
            const bool twice = (a == 0 || 2 * a == n) && 2 * b > n; // -k stands in the list
            if (mean || twice) {
                continue;
            }
            const Eigen::VectorXcd wave =
                Eigen::VectorXcd::NullaryExpr(Eigen::Index{n} * n, [&](Eigen::Index R) {
                    const Eigen::Index column = R % n;
                    const Eigen::Index row = R / n;
                    return std::polar(1.,
                                      -2 * std::numbers::pi / n * static_cast<double>(a * column + b * row));
                });
            Eigen::MatrixXcd M(size, size);
            for (Eigen::Index column = 0; column < size; ++column) {
                for (Eigen::Index row = 0; row < size; ++row) {
                    M(row, column) = all[column].row(row).cast<Complex>() * wave;
                }
            }
            modes.push_back(M);
        }
    }
    return modes;
}

double linearised_growth(const LatticeScene& scene, double dt) {
    const solver::Settings settings = settings_of(scene);
    std::vector<Eigen::MatrixXcd> modes = linearised_step(scene, dt, 1);
    int steps = 1;
    if (settings.has("restart_interval") && settings.word("integrator") == "verlet") {
        const std::vector<Eigen::MatrixXcd> leaps = linearised_step(scene, dt, 2);
        steps = settings.integer("restart_interval");
        for (std::size_t k = 0; k < modes.size(); ++k) {
            for (int leap = 1; leap < steps; ++leap) {
                modes[k] = leaps[k] * modes[k];
            }
        }
    }
    keep_what_matters(modes);
    double largest = 0;
    for (const Eigen::MatrixXcd& M : modes) {
        largest = std::max(largest, spectral_radius(M));
    }
    return std::pow(largest, 1. / steps);
}

double linearised_limit(const LatticeScene& scene, double from, double most) {
    const auto grows = [&](double dt) { return linearised_growth(scene, dt) > unstable_growth; };
    if (grows(from)) {
        return 0;
    }
    double low = from;
    double high = low;
    do {
        low = high;
        if (low >= most) {
            return std::numeric_limits<double>::infinity();
        }
        high = std::min(1.25 * low, most);
    } while (!grows(high));
    while (high > 1.001 * low) {
        const double middle = std::sqrt(low * high);
        (grows(middle) ? high : low) = middle;
    }
    return low;
}

} // namespace sphvv::verification
