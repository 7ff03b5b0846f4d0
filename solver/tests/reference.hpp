#pragma once

#include "sphvv/solver/operators/row.hpp"
#include "sphvv/solver/tests/scenes.hpp"

#include <Eigen/Dense>

#include <map>

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

    /// What a projection scheme may be told.
    struct Choices {
        std::string gradient; ///< normalised, plain or symmetric
        bool schwaiger;
        bool monaghan_cleary;
        bool implicit; ///< viscosity of the velocity to come
        double eta;
        double C;          ///< of shifting, 0 for none
        double longest;    ///< shift
        int shift_order;   ///< of the Taylor correction
        double relaxation; ///< of the density, 0 for none
        double density_tolerance;
        int density_iterations;
    };

    using Pairs = std::vector<std::vector<Neighbour<Dim>>>;
    using Densities = std::vector<double>;
    Densities constant_density() const { return Densities(x.size(), rho0); }

    Densities summed_density(const Pairs& pairs) const {
        Densities result(x.size(), m * kernel.value(Dim, 0, h));
        for (std::size_t i = 0; i < x.size(); ++i) {
            for (const auto& pair : pairs[i]) {
                result[i] += m * kernel.value(Dim, pair.distance, h);
            }
        }
        return result;
    }

    /// L_i with volumes V_j = m/rho_j.
    Matrix<Dim> L(const std::vector<Neighbour<Dim>>& row, const Densities& density) const {
        Matrix<Dim> moments = Matrix<Dim>::Zero();
        for (const auto& pair : row) {
            moments -= m / density[pair.j] * separation(pair) * gradW(pair).transpose();
        }
        return moments.inverse();
    }

    /// Rows of div(grad A/rho), A_i at the diagonal: LM with 8 m/(rho_i + rho_j)^2, or LS with lambda = 1/rho
    /// as the Xu sheet §1.4 has it, term by term.
    Eigen::MatrixXd diffusion(const Pairs& pairs, const Densities& density, const Choices& choices) const {
        const int count = static_cast<int>(pairs.size());
        Eigen::MatrixXd result = Eigen::MatrixXd::Zero(count, count);
        for (int i = 0; i < count; ++i) {
            const Matrix<Dim> Li = L(pairs[i], density);
            const double lambda_i = 1 / density[i];
            Vector<Dim> S = Vector<Dim>::Zero();
            Vector<Dim> grad_lambda = Vector<Dim>::Zero();
            for (const auto& pair : pairs[i]) {
                const double V = m / density[pair.j];
                S += V * gradW(pair);
                grad_lambda += V * (1 / density[pair.j] - lambda_i) * (Li * gradW(pair));
            }
            for (const auto& pair : pairs[i]) {
                const int j = pair.j;
                const double r2 = pair.distance * pair.distance;
                const double F = separation(pair).dot(gradW(pair)) / (r2 + choices.eta * choices.eta);
                if (!choices.schwaiger) {
                    const double a = -8 * m / std::pow(density[i] + density[j], 2) * F;
                    result(i, j) += a;
                    result(i, i) -= a;
                    continue;
                }
                const double V = m / density[j];
                const double scale = Li.trace() / Dim * V;
                const double lambda_j = 1 / density[j];
                const double along = (Li * gradW(pair)).dot(S);
                result(i, i) += scale * (lambda_i + lambda_j) * pair.F;
                result(i, j) -= scale * (lambda_i + lambda_j) * pair.F;
                // -grad(lambda A).S, -lambda_i grad A.S
                result(i, j) -= scale * (lambda_j + lambda_i) * along;
                result(i, i) += scale * 2 * lambda_i * along;
            }
            if (choices.schwaiger) {
                result(i, i) += Li.trace() / Dim * grad_lambda.dot(S); // +A_i grad lambda.S
            }
        }
        return result;
    }

    /// grad A at i.
    Vector<Dim> gradient(int i, const Pairs& pairs, const Densities& density, const Choices& choices,
                         const Eigen::VectorXd& A) const {
        Vector<Dim> result = Vector<Dim>::Zero();
        for (const auto& pair : pairs[i]) {
            const int j = pair.j;
            result += choices.gradient == "symmetric"
                          ? Vector<Dim>(density[i] * m *
                                        (A[i] / std::pow(density[i], 2) + A[j] / std::pow(density[j], 2)) *
                                        gradW(pair))
                          : Vector<Dim>(m / density[j] * (A[j] - A[i]) * gradW(pair));
        }
        return choices.gradient == "normalised" ? Vector<Dim>(L(pairs[i], density) * result) : result;
    }

    /// Div v at i.
    double divergence(int i, const Pairs& pairs, const Densities& density, const Choices& choices,
                      const Vectors& v) const {
        const Matrix<Dim> Li =
            choices.gradient == "normalised" ? L(pairs[i], density) : Matrix<Dim>::Identity();
        double result = 0;
        for (const auto& pair : pairs[i]) {
            result += m / density[pair.j] * (v[pair.j] - v[i]).dot(Li * gradW(pair));
        }
        return result;
    }

    /// v + dt nu Laplacian v, at the density rho_0, or v' with v' - dt nu Laplacian v' = v.
    Vectors with_viscosity(const Vectors& v, double dt, const Pairs& pairs, const Choices& choices) const {
        Vectors result = v;
        const Eigen::MatrixXd lap = rho0 * diffusion(pairs, constant_density(), choices);
        if (choices.implicit) {
            const auto decomposed =
                (Eigen::MatrixXd::Identity(lap.rows(), lap.cols()) - dt * nu * lap).partialPivLu();
            for (int d = 0; d < Dim; ++d) {
                Eigen::VectorXd component(lap.rows());
                for (std::size_t i = 0; i < v.size(); ++i) {
                    component[static_cast<int>(i)] = v[i][d];
                }
                component = decomposed.solve(component).eval();
                for (std::size_t i = 0; i < v.size(); ++i) {
                    result[i][d] = component[static_cast<int>(i)];
                }
            }
            return result;
        }
        for (std::size_t i = 0; i < v.size(); ++i) {
            for (std::size_t j = 0; j < v.size() && !choices.monaghan_cleary; ++j) {
                result[i] += dt * nu * lap(i, j) * v[j];
            }
            for (const auto& pair : pairs[i]) {
                if (choices.monaghan_cleary) { // Lee 2008 §1.3: 8 m (nu + nu)/(rho + rho), 10 in 3-D
                    result[i] += dt * (Dim == 2 ? 8 : 10) * m * (nu + nu) / (rho0 + rho0) *
                                 (v[i] - v[pair.j]).dot(separation(pair)) /
                                 (pair.distance * pair.distance + choices.eta * choices.eta) * gradW(pair);
                }
            }
        }
        return result;
    }

    /// The solution of zero mean of A p = b: equations up to a constant, and the one more that the mean of p
    /// vanish.
    static Eigen::VectorXd solution(Eigen::MatrixXd A, Eigen::VectorXd b) {
        A.rowwise() -= A.colwise().mean().eval();
        b.array() -= b.mean();
        A.array() += A.norm() / static_cast<double>(b.size());
        return A.partialPivLu().solve(b);
    }

    void store_pressure(const Eigen::VectorXd& values) { p.assign(values.begin(), values.end()); }

    /// Laplacian p = (rho/dt) div u* + alpha (rho_0 - rho)/dt^2, and u* - (dt/rho) grad p.
    Vectors projected(const Vectors& u_star, double dt, const Pairs& pairs, const Choices& choices) {
        const Densities density = constant_density();
        const Densities particle_density = summed_density(pairs);
        Eigen::VectorXd b(x.size());
        for (int i = 0; i < b.size(); ++i) {
            b[i] = rho0 / dt * divergence(i, pairs, density, choices, u_star) +
                   choices.relaxation * (rho0 - particle_density[i]) / (dt * dt);
        }
        const Eigen::VectorXd pressure = solution(rho0 * diffusion(pairs, density, choices), b);
        Vectors result = u_star;
        for (int i = 0; i < b.size(); ++i) {
            result[i] -= dt / rho0 * gradient(i, pairs, density, choices, pressure);
        }
        store_pressure(pressure);
        return result;
    }

    static Vectors moved(const Vectors& from, double dt, const Vectors& by) {
        Vectors result = from;
        for (std::size_t i = 0; i < from.size(); ++i) {
            result[i] += dt * by[i];
        }
        return result;
    }

    /// Xu 2009 §2.2, ISPH_DF, and §2.3, ISPH_DFS, for C > 0.
    void isph_step(double dt, const Choices& choices) {
        const auto pairs = pairs_at(moved(x, dt, u));
        const Vectors u_next = projected(with_viscosity(u, dt, pairs, choices), dt, pairs, choices);
        x = moved(moved(x, dt / 2, u), dt / 2, u_next);
        u = u_next;
        if (choices.C > 0) {
            shift(choices.C * dt, choices.longest, choices.shift_order);
        }
    }

    /// Lee 2008 §1.2; Asai 2012 for a relaxation > 0.
    void isph_at_old_positions_step(double dt, const Choices& choices) {
        const auto pairs = pairs_at(x);
        u = projected(with_viscosity(u, dt, pairs, choices), dt, pairs, choices);
        x = moved(x, dt, u);
    }

    /// Shao & Lo 2003; Xu 2009 §2.2, ISPH_DI.
    void isph_di_step(double dt, const Choices& choices) {
        const Vectors u_star = with_viscosity(u, dt, pairs_at(x), choices);
        const auto pairs = pairs_at(moved(x, dt, u_star));
        const Densities density = summed_density(pairs);
        Eigen::VectorXd b(x.size());
        for (int i = 0; i < b.size(); ++i) {
            b[i] = (rho0 - density[i]) / (rho0 * dt * dt);
        }
        const Eigen::VectorXd pressure = solution(diffusion(pairs, density, choices), b);
        Vectors u_next = u_star;
        for (int i = 0; i < b.size(); ++i) {
            u_next[i] -= dt / density[i] * gradient(i, pairs, density, choices, pressure);
        }
        x = moved(moved(x, dt / 2, u), dt / 2, u_next);
        u = u_next;
        store_pressure(pressure);
    }

    /// Hu & Adams 2007; Xu 2009 §2.2, ISPH_DFDI, with the published pressure, which is halved in the end.
    void isph_dfdi_step(double dt, const Choices& choices) {
        const int count = static_cast<int>(x.size());
        const Vectors u_half = with_viscosity(u, dt / 2, pairs_at(x), choices);
        x = moved(x, dt, u_half);
        const double sigma0 = rho0 / m;
        auto pairs = pairs_at(x);
        Densities density = summed_density(pairs);
        density_iterations = 0;
        listed_pairs = {number_of(pairs)};
        for (; density_iterations < choices.density_iterations; ++density_iterations) {
            // sigma0 - sigma_i but for a constant, which is out of the equations' reach.
            const Eigen::VectorXd sigma = Eigen::Map<const Eigen::VectorXd>(density.data(), count) / m;
            const Eigen::VectorXd right = (sigma.mean() - sigma.array()) / sigma0;
            if (right.cwiseAbs().maxCoeff() < choices.density_tolerance) {
                break;
            }
            const Eigen::VectorXd q = solution(dt * dt / 2 * diffusion(pairs, density, choices), right);
            Vectors next = x;
            for (int i = 0; i < count; ++i) {
                next[i] -= dt * dt / 2 / density[i] * gradient(i, pairs, density, choices, q);
            }
            x = next;
            pairs = pairs_at(x);
            density = summed_density(pairs);
            listed_pairs.push_back(number_of(pairs));
        }
        const Vectors u_star = with_viscosity(u_half, dt / 2, pairs, choices);
        Eigen::VectorXd b(count);
        for (int i = 0; i < count; ++i) {
            b[i] = 2 / dt * divergence(i, pairs, density, choices, u_star);
        }
        const Eigen::VectorXd doubled = solution(diffusion(pairs, density, choices), b);
        for (int i = 0; i < count; ++i) {
            u[i] = u_star[i] - dt / 2 / density[i] * gradient(i, pairs, density, choices, doubled);
        }
        store_pressure(doubled / 2);
    }

    static std::int64_t number_of(const Pairs& pairs) {
        std::int64_t total = 0;
        for (const auto& row : pairs) {
            total += static_cast<std::int64_t>(row.size());
        }
        return total;
    }

    int density_iterations = 0;             ///< of the last step
    std::vector<std::int64_t> listed_pairs; ///< at r^(0) and after each

    /// dr . (grad grad A_i) . dr with grad grad A_i = sum_j V_j (grad A_j - grad A_i) (x) L_i gradW_ij.
    double second_order(int i, const Pairs& pairs, const Vectors& grad_A, const Vector<Dim>& dr) const {
        const Densities density = constant_density();
        Matrix<Dim> second = Matrix<Dim>::Zero();
        const Matrix<Dim> Li = L(pairs[i], density);
        for (const auto& pair : pairs[i]) {
            second += m / rho0 * (grad_A[pair.j] - grad_A[i]) * (Li * gradW(pair)).transpose();
        }
        return dr.dot(second * dr);
    }

    /// What a field A becomes at r + dr by its Taylor expansion.
    std::vector<double> carried(const std::vector<double>& A, const Pairs& pairs, const Vectors& dr,
                                int order) const {
        Choices choices{};
        choices.gradient = "normalised";
        const int count = static_cast<int>(A.size());
        const Eigen::VectorXd values = Eigen::Map<const Eigen::VectorXd>(A.data(), count);
        Vectors grad_A(A.size());
        for (int i = 0; i < count; ++i) {
            grad_A[i] = gradient(i, pairs, constant_density(), choices, values);
        }
        std::vector<double> result = A;
        for (int i = 0; i < count && order > 0; ++i) {
            result[i] += grad_A[i].dot(dr[i]);
            if (order > 1) {
                result[i] += second_order(i, pairs, grad_A, dr[i]) / 2;
            }
        }
        return result;
    }

    void shift(double C_dt, double longest, int order) {
        const int count = static_cast<int>(x.size());
        const auto pairs = pairs_at(x);
        double u_max = 0;
        for (const auto& ui : u) {
            u_max = std::max(u_max, ui.norm());
        }
        Vectors dr(count);
        for (int i = 0; i < count; ++i) {
            double mean_distance = 0;
            for (const auto& pair : pairs[i]) {
                mean_distance += pair.distance / static_cast<double>(pairs[i].size());
            }
            Vector<Dim> R = Vector<Dim>::Zero();
            for (const auto& pair : pairs[i]) {
                R += std::pow(mean_distance / pair.distance, Dim) * separation(pair) / pair.distance;
            }
            dr[i] = C_dt * u_max * shifting_factor<Dim> * R;
            if (dr[i].norm() > longest) {
                dr[i] *= longest / dr[i].norm();
            }
        }
        for (int d = 0; d < Dim; ++d) {
            std::vector<double> component(count);
            for (int i = 0; i < count; ++i) {
                component[i] = u[i][d];
            }
            component = carried(component, pairs, dr, order);
            for (int i = 0; i < count; ++i) {
                u[i][d] = component[i];
            }
        }
        p = carried(p, pairs, dr, order);
        x = moved(x, 1, dr);
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
    const auto number = [&](const char* key) { return settings.has(key) ? settings.number(key) : 0; };
    const std::string order = settings.has("shift_correction") ? settings.word("shift_correction") : "none";
    return {.gradient = settings.word("gradient"),
            .schwaiger = settings.word("laplacian") == "schwaiger",
            .monaghan_cleary = settings.word("viscosity") == "monaghan_cleary",
            .implicit = settings.word("viscous_step") == "implicit",
            .eta = settings.number("eta_over_h") * scene.smoothing_length,
            .C = number("shift_coefficient"),
            .longest = number("shift_limit") * scene.particle_spacing,
            .shift_order = order == "second" ? 2 : (order == "first" ? 1 : 0),
            .relaxation = number("relaxation"),
            .density_tolerance = number("density_tolerance"),
            .density_iterations = static_cast<int>(number("density_iterations"))};
}

/// One step of the algorithm that the scheme cites.
template <int Dim>
void projection_step(Reference<Dim>& reference, const Scheme& scheme, const Simulation<Dim>& scene) {
    using Step = void (Reference<Dim>::*)(double, const typename Reference<Dim>::Choices&);
    static const std::map<std::string_view, Step> steps{
        {"isph_df", &Reference<Dim>::isph_step},
        {"isph_dfs", &Reference<Dim>::isph_step},
        {"isph_di", &Reference<Dim>::isph_di_step},
        {"isph_dfdi", &Reference<Dim>::isph_dfdi_step},
        {"isph_lee", &Reference<Dim>::isph_at_old_positions_step},
        {"isph_asai", &Reference<Dim>::isph_at_old_positions_step}};
    (reference.*steps.at(scheme.name))(scene.time_step, choices(scene));
}

} // namespace sphvv::solver::scenes
