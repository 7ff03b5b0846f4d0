// The scheme isph_mls against its equations, carried out with all pairs, dense matrices and least squares by
// QR, and what its pressure equation is for.
//   solver_isph_mls
#include "sphvv/solver/tests/reference.hpp"

#include <Eigen/QR>
#include <gtest/gtest.h>
#include <omp.h>

#include <vector>

namespace sphvv::solver {
namespace {

using namespace scenes;

/// Positions, velocities and the divergence integral, or their rates.
template <int Dim>
struct State {
    std::vector<Vector<Dim>> x, u;
    std::vector<double> s;

    /// this + factor * rates
    State after(double factor, const State& rates) const {
        State result = *this;
        for (std::size_t i = 0; i < x.size(); ++i) {
            result.x[i] += factor * rates.x[i];
            result.u[i] += factor * rates.u[i];
            result.s[i] += factor * rates.s[i];
        }
        return result;
    }
};

template <int Dim>
struct Equations {
    const Reference<Dim>& scene;
    double U, dx;
    double damping, stiffness, shifting;
    bool quadratic;
    std::vector<double> strength; ///< of repulsion, particle by particle
    Eigen::VectorXd pressure{};

    /// Rows of the derivatives of a quadratic fit: gradient first, then the second derivatives.
    static Eigen::MatrixXd fit(const std::vector<Neighbour<Dim>>& row) {
        constexpr int terms = Dim + Dim * (Dim + 1) / 2;
        Eigen::MatrixXd P(row.size(), terms);
        Eigen::VectorXd root(row.size());
        for (std::size_t k = 0; k < row.size(); ++k) {
            const Vector<Dim> r = -Reference<Dim>::separation(row[k]);
            root[k] = std::sqrt(-row[k].F);
            int m = 0;
            for (int a = 0; a < Dim; ++a) {
                P(k, m++) = r[a];
            }
            for (int a = 0; a < Dim; ++a) {
                for (int b = a; b < Dim; ++b) {
                    P(k, m++) = a == b ? r[a] * r[a] / 2 : r[a] * r[b];
                }
            }
        }
        const Eigen::HouseholderQR<Eigen::MatrixXd> qr(root.asDiagonal() * P);
        const Eigen::MatrixXd Q = qr.householderQ() * Eigen::MatrixXd::Identity(P.rows(), terms);
        const Eigen::MatrixXd R = qr.matrixQR().topRows(terms).template triangularView<Eigen::Upper>();
        return R.triangularView<Eigen::Upper>().solve(Q.transpose()) * root.asDiagonal();
    }

    /// The same rows where the gradient is the renormalised one and the Laplacian Morris's, which is put
    /// where the second derivative along x stands.
    Eigen::MatrixXd renormalised(const std::vector<Neighbour<Dim>>& row) const {
        const double volume = std::pow(dx, Dim);
        Matrix<Dim> moment = Matrix<Dim>::Zero();
        for (const auto& pair : row) {
            const Vector<Dim> r = Reference<Dim>::separation(pair);
            moment -= volume * pair.F * r * r.transpose();
        }
        const Matrix<Dim> inverse = moment.inverse();
        Eigen::MatrixXd derivatives = Eigen::MatrixXd::Zero(Dim + Dim * (Dim + 1) / 2, row.size());
        for (std::size_t k = 0; k < row.size(); ++k) {
            const Vector<Dim> gradient = inverse * Reference<Dim>::separation(row[k]);
            for (int d = 0; d < Dim; ++d) {
                derivatives(d, k) = volume * row[k].F * gradient[d];
            }
            derivatives(Dim, k) = -2 * volume * row[k].F;
        }
        return derivatives;
    }

    double push(double r) const {
        const double radius = scene.kernel.support * scene.h;
        return std::pow(dx / r, Dim) * std::pow(1 - r * r / (radius * radius), 2);
    }

    /// Repulsion of a particle that is displaced by a small distance from a lattice, per distance.
    double lattice_stiffness() const {
        const double away = 1e-4 * dx;
        const int reach = 6;
        const int depth = Dim == 3 ? reach : 0;
        double total = 0;
        for (int x = -reach; x <= reach; ++x) {
            for (int y = -reach; y <= reach; ++y) {
                for (int z = -depth; z <= depth; ++z) {
                    const double along = away - x * dx;
                    const double r = std::sqrt(along * along + (y * y + z * z) * dx * dx);
                    if ((x != 0 || y != 0 || z != 0) && r < scene.kernel.support * scene.h) {
                        total += push(r) * along / r;
                    }
                }
            }
        }
        return -total / away;
    }

    State<Dim> rates(const State<Dim>& state) {
        const int count = static_cast<int>(state.x.size());
        const auto pairs = scene.pairs_at(state.x);
        std::vector<Eigen::MatrixXd> G(Dim, Eigen::MatrixXd::Zero(count, count));
        Eigen::MatrixXd laplacian = Eigen::MatrixXd::Zero(count, count);
        for (int i = 0; i < count; ++i) {
            const Eigen::MatrixXd derivatives = quadratic ? fit(pairs[i]) : renormalised(pairs[i]);
            for (std::size_t k = 0; k < pairs[i].size(); ++k) {
                const int j = pairs[i][k].j;
                for (int d = 0; d < Dim; ++d) {
                    G[d](i, j) += derivatives(d, k);
                    G[d](i, i) -= derivatives(d, k);
                    // The squares stand where b = a.
                    const int square = Dim + (d == 0 ? 0 : d == 1 ? Dim : 2 * Dim - 1);
                    laplacian(i, j) += derivatives(square, k);
                    laplacian(i, i) -= derivatives(square, k);
                }
            }
        }
        const double lambda = damping * U / scene.h;
        const double kappa = stiffness * U * U / (scene.h * scene.h);
        double squares = 0;
        for (const Vector<Dim>& u : state.u) {
            squares += u.squaredNorm() / count;
        }
        const double mobility = shifting * std::sqrt(squares) / scene.h / lattice_stiffness();
        State<Dim> result = state;
        Eigen::VectorXd source(count);
        for (int i = 0; i < count; ++i) {
            Matrix<Dim> gradient = Matrix<Dim>::Zero();
            Vector<Dim> viscous = Vector<Dim>::Zero();
            for (int j = 0; j < count; ++j) {
                for (int d = 0; d < Dim; ++d) {
                    gradient.col(d) += G[d](i, j) * state.u[j];
                }
                viscous += laplacian(i, j) * state.u[j];
            }
            Vector<Dim> shift = Vector<Dim>::Zero();
            for (const auto& pair : pairs[i]) {
                shift += mobility * strength[pair.j] * push(pair.distance) *
                         Reference<Dim>::separation(pair) / pair.distance;
            }
            result.x[i] = state.u[i] + shift;
            result.u[i] = scene.nu * viscous + gradient * shift;
            result.s[i] = kappa * gradient.trace();
            source[i] = scene.rho0 * (lambda * gradient.trace() + state.s[i] - (gradient * gradient).trace());
        }
        // Equations up to a constant, and the one more that the mean of p vanish.
        Eigen::MatrixXd A = laplacian;
        A.rowwise() -= A.colwise().mean().eval();
        source.array() -= source.mean();
        A.array() += A.norm() / count;
        pressure = A.partialPivLu().solve(source);
        for (int i = 0; i < count; ++i) {
            for (int d = 0; d < Dim; ++d) {
                result.u[i][d] -= G[d].row(i).dot(pressure) / scene.rho0;
            }
        }
        return result;
    }
};

TEST(IsphMls, CarriesOutItsEquations) {
    for (const auto& choice : {std::pair<std::string, std::string>{"euler", "quadratic"},
                               {"heun2", "quadratic"},
                               {"heun3", "quadratic"},
                               {"rk4", "quadratic"},
                               {"heun2", "renormalised"}}) {
        const std::string integrator = choice.first;
        const std::string operators = choice.second;
        SCOPED_TRACE(integrator + ", " + operators);
        in_2d_and_3d([&](auto dimension) {
            constexpr int Dim = dimension;
            const Scheme& scheme = schemes::find("isph_mls");
            Simulation<Dim> scene = general_scene<Dim>(scheme, {{"integrator", integrator},
                                                                {"operators", operators},
                                                                {"pressure_tolerance", "1e-13"},
                                                                {"h_over_dx", "1.7"},
                                                                {"divergence_damping", "4"},
                                                                {"divergence_stiffness", "3"},
                                                                {"shift_coefficient", "0.7"}});
            Reference<Dim> reference(scene);
            State<Dim> state{reference.x, reference.u, std::vector<double>(reference.x.size(), 0.0)};
            scheme.assemble(scene);
            const Field& strength = *scene.particles.find("repulsion_strength");
            Equations<Dim> equations{reference,
                                     scene.reference_speed,
                                     scene.particle_spacing,
                                     4,
                                     3,
                                     0.7,
                                     operators == "quadratic",
                                     std::vector<double>(scene.particles.size())};
            for (std::size_t k = 0; k < scene.particles.size(); ++k) {
                equations.strength[scene.particles.id[k]] = strength[0][k];
            }
            for (int step = 0; step < 2; ++step) {
                advance(scene);
                const double dt = scene.time_step;
                const State<Dim> k1 = equations.rates(state);
                if (integrator == "euler") {
                    state = state.after(dt, k1);
                } else if (integrator == "heun2") {
                    const State<Dim> k2 = equations.rates(state.after(dt, k1));
                    state = state.after(dt / 2, k1).after(dt / 2, k2);
                } else if (integrator == "heun3") {
                    const State<Dim> k2 = equations.rates(state.after(dt / 3, k1));
                    const State<Dim> k3 = equations.rates(state.after(2 * dt / 3, k2));
                    state = state.after(dt / 4, k1).after(3 * dt / 4, k3);
                } else {
                    const State<Dim> k2 = equations.rates(state.after(dt / 2, k1));
                    const State<Dim> k3 = equations.rates(state.after(dt / 2, k2));
                    const State<Dim> k4 = equations.rates(state.after(dt, k3));
                    state = state.after(dt / 6, k1).after(dt / 3, k2).after(dt / 3, k3).after(dt / 6, k4);
                }
                equations.rates(state); // the pressure at the end of the step
                reference.x = state.x;
                reference.u = state.u;
                reference.p.assign(equations.pressure.begin(), equations.pressure.end());
                reference.expect_equals(scene, 1e-8);
            }
        });
    }
}

// Differing strengths break the symmetry of a lattice; alike, a particle on a saddle point of the flow loses
// its arrangement (n = 4m + 2 puts one there).
TEST(IsphMls, SurvivesAParticleOnASaddlePoint) {
    const Scheme& scheme = schemes::find("isph_mls");
    const auto smallest_spacing = [&](const char* disorder) {
        Simulation<2> scene = flowing_scene<2>(scheme, {{"shift_disorder", disorder}}, 22);
        scheme.assemble(scene);
        double smallest = infinity;
        for (int step = 0; step < 60 && smallest > 0.25 / 22; ++step) {
            advance(scene);
            smallest = std::min(smallest, scene.neighbours.minimum_distance());
        }
        return smallest * 22;
    };
    EXPECT_GT(smallest_spacing("0.1"), 0.4);
    EXPECT_LT(smallest_spacing("0"), 0.25);
}

/// Root of the mean square divergence of the velocity (1/s), by the fit.
double divergence_at(int n, const Assignments& given) {
    const Scheme& scheme = schemes::find("isph_mls");
    Simulation<2> scene = flowing_scene<2>(scheme, given, n);
    scene.end_time = 0.3;
    scheme.assemble(scene);
    while (scene.time < scene.end_time) {
        advance(scene);
    }
    const Field& rate = *scene.particles.find("divergence_rate");
    const double kappa = scene.settings.number("divergence_stiffness") / std::pow(scene.smoothing_length, 2);
    double squares = 0;
    for (const double value : rate.components[0]) {
        squares += std::pow(value / kappa, 2);
    }
    return std::sqrt(squares / static_cast<double>(scene.particles.size()));
}

// Which particle a diagnosis names must not depend on the number of threads.
TEST(IsphMls, NamesTheFirstParticleWhoseNeighboursAreTooFew) {
    const Scheme& scheme = schemes::find("isph_mls");
    Points<2> points = lattice<2>(cube<2>(0.5, false), 1. / 48);
    for (const double x : {0.7, 0.75, 0.8, 0.85, 0.9}) {
        append<2>(points, {x, x});
    }
    const auto still = still_scene<2>(scheme, {}, 48);
    const int threads = omp_get_max_threads();
    std::vector<std::string> diagnoses;
    for (const int team : {1, 2, 2, 2, 2}) {
        omp_set_num_threads(team);
        Simulation<2> scene(still.box, points[0].size());
        scene.settings = still.settings;
        scene.kernel = still.kernel;
        scene.particle_spacing = still.particle_spacing;
        scene.smoothing_length = still.smoothing_length;
        scene.density = 1;
        scene.kinematic_viscosity = 0.01;
        scene.reference_speed = 1;
        scene.particle_mass = still.particle_mass;
        scene.end_time = 1;
        for (int d = 0; d < 2; ++d) {
            scene.particles.position.components[d] = points[d];
        }
        scheme.assemble(scene);
        try {
            advance(scene);
        } catch (const Diverged& reason) {
            diagnoses.emplace_back(reason.what());
        }
    }
    omp_set_num_threads(threads);
    ASSERT_EQ(diagnoses.size(), 5U);
    EXPECT_NE(diagnoses[0].find("particle " + std::to_string(points[0].size() - 5) + " "), std::string::npos)
        << diagnoses[0];
    for (const std::string& diagnosis : diagnoses) {
        EXPECT_EQ(diagnosis, diagnoses[0]);
    }
}

// What keeps the divergence down: with hardly any integral it settles at e/lambda, with it at De/Dt / kappa,
// or at what the disorder of the particles leaves.
TEST(IsphMls, IntegralTakesTheDivergenceDown) {
    for (const int n : {20, 40}) {
        EXPECT_LT(divergence_at(n, {}), divergence_at(n, {{"divergence_stiffness", "1e-6"}}) / 2) << n;
    }
}

} // namespace
} // namespace sphvv::solver
