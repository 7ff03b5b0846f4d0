#pragma once

#include "sphvv/solver/operators/row.hpp"
#include "sphvv/solver/tests/scenes.hpp"

#include <Eigen/Dense>

namespace sphvv::solver::scenes {

/// The cited algorithms, with all pairs and dense matrices.
template <int Dim>
struct Reference {
    using Vectors = std::vector<Vector<Dim>>;

    explicit Reference(const Simulation<Dim>& scene)
        : box(scene.box), kernel(*scene.kernel), h(scene.smoothing_length), m(scene.particle_mass),
          rho0(scene.density), nu(scene.kinematic_viscosity), x(scene.particles.size()), u(x.size()),
          p(x.size()), rho(x.size(), rho0) {
        for (std::size_t k = 0; k < x.size(); ++k) {
            const int i = scene.particles.id[k];
            for (int d = 0; d < Dim; ++d) {
                x[i][d] = scene.particles.position[d][k];
                u[i][d] = scene.particles.velocity[d][k];
            }
            p[i] = (*scene.particles.find("pressure"))[0][k];
        }
    }

    /// Neighbours and gradients at some positions.
    std::vector<std::vector<Neighbour<Dim>>> pairs_at(const Vectors& at) const {
        Points<Dim> points;
        for (const auto& point : at) {
            std::array<double, Dim> coordinates;
            std::copy(point.begin(), point.end(), coordinates.begin());
            append<Dim>(points, coordinates);
        }
        return all_neighbours<Dim>(box, points, kernel, h);
    }

    static Vector<Dim> gradW(const Neighbour<Dim>& pair) {
        return Eigen::Map<const Vector<Dim>>(pair.gradW.data());
    }
    static Vector<Dim> separation(const Neighbour<Dim>& pair) {
        return Eigen::Map<const Vector<Dim>>(pair.r.data());
    }
    double V() const { return m / rho0; }

    Matrix<Dim> L(const std::vector<Neighbour<Dim>>& row) const {
        Matrix<Dim> moments = Matrix<Dim>::Zero();
        for (const auto& pair : row) {
            moments -= V() * separation(pair) * gradW(pair).transpose();
        }
        return moments.inverse();
    }

    /// Rows a_ij of the Laplacian, A_i at the diagonal.
    Eigen::MatrixXd laplacian(const std::vector<std::vector<Neighbour<Dim>>>& pairs, bool schwaiger,
                              double eta) const {
        const int count = static_cast<int>(pairs.size());
        Eigen::MatrixXd result = Eigen::MatrixXd::Zero(count, count);
        for (int i = 0; i < count; ++i) {
            const Matrix<Dim> Li = L(pairs[i]);
            Vector<Dim> S = Vector<Dim>::Zero();
            for (const auto& pair : pairs[i]) {
                S += V() * gradW(pair);
            }
            for (const auto& pair : pairs[i]) {
                const double r2 = pair.distance * pair.distance;
                const double F = separation(pair).dot(gradW(pair)) / (r2 + eta * eta);
                const double a = schwaiger ? Li.trace() / Dim * V() * (-2 * F - 2 * (Li * gradW(pair)).dot(S))
                                           : -2 * V() * F;
                result(i, pair.j) += a;
                result(i, i) -= a;
            }
        }
        return result;
    }

    /// What a projection scheme may be told.
    struct Choices {
        bool normalised;
        bool schwaiger;
        double eta;
        double C;       ///< of shifting, 0 for none
        double longest; ///< shift
        bool corrected; ///< after shifting
    };

    /// Xu 2009 §2.2, ISPH_DF, and §2.3, ISPH_DFS, for C > 0.
    void isph_step(double dt, const Choices& choices) {
        const int count = static_cast<int>(x.size());
        Vectors star(count);
        for (int i = 0; i < count; ++i) {
            star[i] = x[i] + dt * u[i];
        }
        const auto pairs = pairs_at(star);
        const Eigen::MatrixXd lap = laplacian(pairs, choices.schwaiger, choices.eta);
        const auto L_or_identity = [&](const std::vector<Neighbour<Dim>>& row) -> Matrix<Dim> {
            return choices.normalised ? L(row) : Matrix<Dim>::Identity();
        };
        Vectors u_star = u;
        for (int i = 0; i < count; ++i) {
            for (int j = 0; j < count; ++j) {
                u_star[i] += dt * nu * lap(i, j) * u[j];
            }
        }
        Eigen::VectorXd b(count);
        for (int i = 0; i < count; ++i) {
            const Matrix<Dim> Li = L_or_identity(pairs[i]);
            double divergence = 0;
            for (const auto& pair : pairs[i]) {
                divergence += V() * (u_star[pair.j] - u_star[i]).dot(Li * gradW(pair));
            }
            b[i] = rho0 / dt * divergence;
        }
        // Equations up to a constant, and the one more that the mean of p vanish.
        Eigen::MatrixXd A = lap;
        A.rowwise() -= A.colwise().mean().eval();
        b.array() -= b.mean();
        A.array() += A.norm() / count;
        const Eigen::VectorXd solution = A.partialPivLu().solve(b);
        Vectors u_next = u_star;
        for (int i = 0; i < count; ++i) {
            const Matrix<Dim> Li = L_or_identity(pairs[i]);
            for (const auto& pair : pairs[i]) {
                u_next[i] -= dt / rho0 * V() * (solution[pair.j] - solution[i]) * (Li * gradW(pair));
            }
            p[i] = solution[i];
        }
        for (int i = 0; i < count; ++i) {
            x[i] += dt / 2 * (u[i] + u_next[i]);
        }
        u = u_next;
        if (choices.C > 0) {
            shift(choices.C * dt, choices.longest, choices.corrected);
        }
    }

    void shift(double C_dt, double longest, bool corrected) {
        const int count = static_cast<int>(x.size());
        const auto pairs = pairs_at(x);
        double u_max = 0;
        for (const auto& ui : u) {
            u_max = std::max(u_max, ui.norm());
        }
        Vectors dx(count);
        Vectors u_new = u;
        std::vector<double> p_new = p;
        for (int i = 0; i < count; ++i) {
            double mean_distance = 0;
            for (const auto& pair : pairs[i]) {
                mean_distance += pair.distance / static_cast<double>(pairs[i].size());
            }
            Vector<Dim> R = Vector<Dim>::Zero();
            for (const auto& pair : pairs[i]) {
                R += std::pow(mean_distance / pair.distance, Dim) * separation(pair) / pair.distance;
            }
            dx[i] = C_dt * u_max * shifting_factor<Dim> * R;
            if (dx[i].norm() > longest) {
                dx[i] *= longest / dx[i].norm();
            }
            const Matrix<Dim> Li = L(pairs[i]);
            for (const auto& pair : pairs[i]) {
                const double along = V() * (Li * gradW(pair)).dot(dx[i]);
                u_new[i] += along * (u[pair.j] - u[i]);
                p_new[i] += along * (p[pair.j] - p[i]);
            }
        }
        for (int i = 0; i < count; ++i) {
            x[i] += dx[i];
        }
        if (corrected) {
            u = u_new;
            p = p_new;
        }
    }

    // Weakly compressible; p = B [(rho/rho0)^gamma - 1] + background.
    double B = 0;
    double gamma = 7;
    double background = 0;

    void set_tait(double c0, double exponent, double added) {
        gamma = exponent;
        B = rho0 * c0 * c0 / gamma;
        background = added;
        for (std::size_t i = 0; i < x.size(); ++i) {
            rho[i] = rho0 * std::pow(p[i] / B + 1, 1 / gamma);
        }
        update_pressure();
    }
    void update_pressure() {
        for (std::size_t i = 0; i < x.size(); ++i) {
            p[i] = B * (std::pow(rho[i] / rho0, gamma) - 1) + background;
        }
    }
    // Words of the settings of these names.
    std::string continuity = "sigma_2";
    std::string pressure_force = "sigma_2";
    std::string viscosity = "morris";

    void take_forms(const Settings& settings) {
        continuity = settings.word("continuity");
        pressure_force = settings.word("pressure_force");
        viscosity = settings.word("viscosity");
    }
    /// L_i^-1 with the volumes m/rho_j.
    std::vector<Matrix<Dim>> moments(const std::vector<std::vector<Neighbour<Dim>>>& pairs) const {
        std::vector<Matrix<Dim>> result(x.size(), Matrix<Dim>::Zero());
        for (std::size_t i = 0; i < x.size(); ++i) {
            for (const auto& pair : pairs[i]) {
                result[i] -= m / rho[pair.j] * separation(pair) * gradW(pair).transpose();
            }
        }
        return result;
    }
    /// Particles whose L^-1 has an eigenvalue below 0.97, and all that interact with one (Oger 2007).
    std::vector<bool> near_surface(const std::vector<std::vector<Neighbour<Dim>>>& pairs) const {
        std::vector<bool> surface;
        for (const Matrix<Dim>& M : moments(pairs)) {
            surface.push_back(Eigen::SelfAdjointEigenSolver<Matrix<Dim>>(M).eigenvalues().minCoeff() < 0.97);
        }
        std::vector<bool> result = surface;
        for (std::size_t i = 0; i < x.size(); ++i) {
            for (const auto& pair : pairs[i]) {
                result[i] = result[i] || surface[pair.j];
            }
        }
        return result;
    }
    /// What the pair adds to grad p/rho, divided by m: Issa P1, P2; Oger 2007.
    Vector<Dim> pressure_term(int i, const Neighbour<Dim>& pair, const Matrix<Dim>& Li, const Matrix<Dim>& Lj,
                              bool near) const {
        const int j = pair.j;
        const Vector<Dim> g = gradW(pair);
        const double product = rho[i] * rho[j];
        if (pressure_force == "sigma_2") {
            return (p[i] / (rho[i] * rho[i]) + p[j] / (rho[j] * rho[j])) * g;
        }
        if (pressure_force == "sigma_1") {
            return (p[i] + p[j]) / product * g;
        }
        if (pressure_force == "plain") {
            return p[j] / product * g;
        }
        if (pressure_force == "difference") {
            return (p[j] - p[i]) / product * g;
        }
        if (pressure_force == "renormalised_coherent") {
            return (p[i] * Li + p[j] * Lj) * g / product;
        }
        if (pressure_force == "renormalised" || (pressure_force == "hybrid_taylor" && near)) {
            return (p[i] + p[j]) / product * Li * g;
        }
        return (p[j] - p[i]) / product * Li * g; // taylor
    }
    /// The viscous acceleration of i by the pair, divided by m.
    Vector<Dim> viscous_term(int i, const Neighbour<Dim>& pair, double eta) const {
        const double r2 = pair.distance * pair.distance + eta * eta;
        const double over_densities = rho0 * nu / (rho[i] * rho[pair.j]);
        const Vector<Dim> r = separation(pair);
        const Vector<Dim> apart = u[i] - u[pair.j];
        if (viscosity == "morris") {
            return 2 * over_densities * r.dot(gradW(pair)) / r2 * apart;
        }
        return 2 * (Dim + 2) * over_densities * apart.dot(r) / r2 * gradW(pair);
    }
    Vectors acceleration(const std::vector<std::vector<Neighbour<Dim>>>& pairs, double eta) const {
        const std::vector<Matrix<Dim>> M = moments(pairs);
        const std::vector<bool> near = near_surface(pairs);
        Vectors a(x.size(), Vector<Dim>::Zero());
        for (int i = 0; i < static_cast<int>(x.size()); ++i) {
            for (const auto& pair : pairs[i]) {
                a[i] -= m * pressure_term(i, pair, M[i].inverse(), M[pair.j].inverse(), near[i]);
                a[i] += m * viscous_term(i, pair, eta);
            }
        }
        return a;
    }
    std::vector<double> density_rate(const std::vector<std::vector<Neighbour<Dim>>>& pairs) const {
        const std::vector<Matrix<Dim>> M = moments(pairs);
        std::vector<double> rate(x.size(), 0.0);
        for (std::size_t i = 0; i < x.size(); ++i) {
            for (const auto& pair : pairs[i]) {
                const Vector<Dim> apart = u[i] - u[pair.j];
                const double V_j = m / rho[pair.j];
                if (continuity == "sigma_2") {
                    rate[i] += m * apart.dot(gradW(pair));
                } else if (continuity == "sigma_1") {
                    rate[i] += rho[i] * V_j * apart.dot(gradW(pair));
                } else {
                    rate[i] += rho[i] * V_j * apart.dot(M[i].inverse() * gradW(pair));
                }
            }
        }
        return rate;
    }
    /// Lee 2008 §1.1.
    void explicit_step(double dt, double eta) {
        const auto pairs = pairs_at(x);
        const Vectors a = acceleration(pairs, eta);
        for (std::size_t i = 0; i < x.size(); ++i) {
            u[i] += dt * a[i];
        }
        const auto rate = density_rate(pairs);
        for (std::size_t i = 0; i < x.size(); ++i) {
            rho[i] += dt * rate[i];
            x[i] += dt * u[i];
        }
        update_pressure();
    }
    /// Issa 2005 §3.
    void predictor_corrector_step(double dt, double eta) {
        const Reference start = *this;
        double step = dt / 2;
        for (int pass = 0; pass < 2; ++pass) {
            const auto pairs = pairs_at(x);
            const Vectors a = acceleration(pairs, eta);
            const auto rate = density_rate(pairs);
            for (std::size_t i = 0; i < x.size(); ++i) {
                x[i] = start.x[i] + step * u[i];
                u[i] = start.u[i] + step * a[i];
                rho[i] = start.rho[i] + step * rate[i];
            }
            update_pressure();
            step = dt;
        }
    }

    Vectors u_before;
    std::vector<double> rho_before;
    /// Verlet 1967, as in SPHysics: a leap over two steps, or an Euler step.
    void verlet_step(double dt, double eta, bool leap) {
        const auto pairs = pairs_at(x);
        const Vectors a = acceleration(pairs, eta);
        const auto rate = density_rate(pairs);
        const Vectors u_now = u;
        const std::vector<double> rho_now = rho;
        for (std::size_t i = 0; i < x.size(); ++i) {
            x[i] += dt * u[i] + dt * dt / 2 * a[i];
            u[i] = leap ? u_before[i] + 2 * dt * a[i] : u[i] + dt * a[i];
            rho[i] = leap ? rho_before[i] + 2 * dt * rate[i] : rho[i] + dt * rate[i];
        }
        u_before = u_now;
        rho_before = rho_now;
        update_pressure();
    }

    void expect_equals(const Simulation<Dim>& scene, double tolerance) const {
        const Field& pressure = *scene.particles.find("pressure");
        const Field* density = scene.particles.find("density");
        double largest = 0;
        for (const double value : p) {
            largest = std::max(largest, std::abs(value));
        }
        for (std::size_t k = 0; k < x.size(); ++k) {
            const int i = scene.particles.id[k];
            for (int d = 0; d < Dim; ++d) {
                const double apart = scene.particles.position[d][k] - x[i][d];
                ASSERT_NEAR(apart, std::round(apart), tolerance * h) << "position of " << i;
                ASSERT_NEAR(scene.particles.velocity[d][k], u[i][d], tolerance) << "velocity of " << i;
            }
            ASSERT_NEAR(pressure[0][k], p[i], 10 * tolerance * largest) << "pressure of " << i;
            if (density) {
                ASSERT_NEAR((*density)[0][k], rho[i], tolerance * rho0) << "density of " << i;
            }
        }
    }

    Box<Dim> box;
    const Kernel& kernel;
    double h, m, rho0, nu;
    Vectors x, u;
    std::vector<double> p, rho;
};

/// A scene whose constants are all unlike one, so that a factor left out shows.
template <int Dim>
Simulation<Dim> general_scene(const Scheme& scheme, const Assignments& given, int n = Dim == 2 ? 10 : 8) {
    Simulation<Dim> scene = flowing_scene<Dim>(scheme, given, n, 0.15);
    scene.density = 3;
    scene.particle_mass *= 3;
    scene.kinematic_viscosity = 0.05;
    scene.reference_speed = 1.5;
    for (double& p : scene.particles.field("pressure", 1, Lifetime::state, "scene").components[0]) {
        p *= 3;
    }
    return scene;
}

/// What the settings of a projection scheme ask for.
template <int Dim>
typename Reference<Dim>::Choices choices(const Simulation<Dim>& scene) {
    const Settings& settings = scene.settings;
    const bool shifts = settings.has("shift_coefficient");
    return {.normalised = settings.word("gradient") == "normalised",
            .schwaiger = settings.word("laplacian") == "schwaiger",
            .eta = settings.number("eta_over_h") * scene.smoothing_length,
            .C = shifts ? settings.number("shift_coefficient") : 0,
            .longest = shifts ? settings.number("shift_limit") * scene.particle_spacing : 0,
            .corrected = shifts && settings.word("shift_correction") == "first"};
}

} // namespace sphvv::solver::scenes
