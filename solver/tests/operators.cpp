// What each discrete operator owes besides its order: its formula, exactness, conservation, symmetry. The
// published errors at a truncated support are rows of `sphvv operators`.
//   solver_operators --gtest_filter='*Morris*'
#include "sphvv/solver/operators/divergence_difference.hpp"
#include "sphvv/solver/operators/gradient_difference.hpp"
#include "sphvv/solver/operators/laplacian_morris.hpp"
#include "sphvv/solver/operators/laplacian_schwaiger.hpp"
#include "sphvv/solver/operators/momentum_weakly_compressible.hpp"
#include "sphvv/solver/operators/moving_least_squares.hpp"
#include "sphvv/solver/operators/renormalisation.hpp"
#include "sphvv/solver/operators/shifting_vector.hpp"
#include "sphvv/solver/tests/scenes.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace sphvv::solver {
namespace {

using namespace scenes;

template <int Dim>
using VectorField = std::array<std::vector<double>, Dim>;

/// A field evaluated at every particle.
template <int Dim, class Function>
std::vector<double> values(const Sample<Dim>& sample, const Function& function) {
    std::vector<double> result;
    for (int i = 0; i < sample.count(); ++i) {
        Vector<Dim> x;
        for (int d = 0; d < Dim; ++d) {
            x[d] = sample.points[d][i];
        }
        result.push_back(function(x));
    }
    return result;
}

template <int Dim>
VectorField<Dim> random_vectors(Random& random, int count) {
    VectorField<Dim> u;
    for (int d = 0; d < Dim; ++d) {
        u[d] = random.values(count, -1, 1);
    }
    return u;
}

template <int Dim>
Vector<Dim> at(const VectorField<Dim>& u, int i) {
    Vector<Dim> result;
    for (int d = 0; d < Dim; ++d) {
        result[d] = u[d][i];
    }
    return result;
}

template <int Dim>
Vector<Dim> eigen(const std::array<double, Dim>& x) {
    Vector<Dim> result;
    for (int d = 0; d < Dim; ++d) {
        result[d] = x[d];
    }
    return result;
}

/// The arrangements on which the algebraic properties are held: lattices and 20 % jitter, closed and
/// truncated supports.
template <int Dim>
std::vector<Sample<Dim>> samples() {
    const int n = Dim == 2 ? 12 : 9;
    std::vector<Sample<Dim>> result;
    for (const bool periodic : {true, false}) {
        result.emplace_back(n, 0, 0, periodic);
        result.emplace_back(n, 0.2, 11, periodic);
        result.emplace_back(n, 0.2, 12, periodic, 0.01);
        result.emplace_back(n, 0.2, 13, periodic, 1, 1.5, kernels::find("wendland_c2"));
    }
    return result;
}

template <class Dimension>
class Operators : public testing::Test {
protected:
    Random random{20240609};
};

TYPED_TEST_SUITE(Operators, Dimensions);

// The formula of every operator, from positions and the profile's derivative alone, with unequal volumes.

template <int Dim>
struct Formulae {
    Vector<Dim> gradient = Vector<Dim>::Zero();
    Matrix<Dim> vector_gradient = Matrix<Dim>::Zero();
    Vector<Dim> S = Vector<Dim>::Zero();
    Matrix<Dim> M = Matrix<Dim>::Zero();
    Vector<Dim> morris = Vector<Dim>::Zero();
    Vector<Dim> morris_eta = Vector<Dim>::Zero();
    Vector<Dim> crowding = Vector<Dim>::Zero();
    double distances = 0;
};

TYPED_TEST(Operators, EqualTheirFormulae) {
    constexpr int Dim = TypeParam::value;
    for (const Sample<Dim>& sample : samples<Dim>()) {
        const double h = sample.h;
        const double eta = 0.1 * h;
        const std::vector<double> V = this->random.values(sample.count(), 0.5, 2);
        const std::vector<double> A = this->random.values(sample.count(), -1, 1);
        const VectorField<Dim> u = random_vectors<Dim>(this->random, sample.count());
        const VolumeField volume{V.data()};
        const auto neighbours = all_neighbours<Dim>(sample.box, sample.points, *sample.kernel, h);
        const double V_h = std::pow(h, -Dim); // the size of W
        for (int i = 0; i < sample.count(); ++i) {
            Formulae<Dim> f;
            for (const Neighbour<Dim>& pair : neighbours[i]) {
                const int j = pair.j;
                const Vector<Dim> gradW = eigen<Dim>(pair.gradW);
                const Vector<Dim> r = eigen<Dim>(pair.r);
                const double r2 = pair.distance * pair.distance;
                const Vector<Dim> u_ij = at<Dim>(u, i) - at<Dim>(u, j);
                f.gradient += V[j] * (A[j] - A[i]) * gradW;
                f.vector_gradient += -V[j] * u_ij * gradW.transpose();
                f.S += V[j] * gradW;
                f.M += -V[j] * r * gradW.transpose();
                f.morris += 2 * V[j] * r.dot(gradW) / r2 * u_ij;
                f.morris_eta += 2 * V[j] * r.dot(gradW) / (r2 + eta * eta) * u_ij;
                f.crowding += r / std::pow(pair.distance, Dim + 1);
                f.distances += pair.distance;
            }
            const Matrix<Dim> L = f.M.inverse();
            const double mean_distance = f.distances / static_cast<double>(neighbours[i].size());
            const auto row = sample.list.row(i);
            const auto velocity = pointers<Dim>(u);
            const double tolerance = 1e-11 * V_h;
            EXPECT_LT((gradient_difference<Dim>(row, i, A.data(), volume) - f.gradient).norm() * h,
                      tolerance);
            EXPECT_LT((vector_gradient_difference<Dim>(row, i, velocity, volume) - f.vector_gradient).norm() *
                          h,
                      tolerance);
            EXPECT_NEAR(divergence_difference<Dim>(row, i, velocity, volume) * h,
                        f.vector_gradient.trace() * h, tolerance);
            EXPECT_LT((gradient_of_unity<Dim>(row, volume) - f.S).norm() * h, tolerance);
            EXPECT_LT((renormalisation<Dim>(row, volume) - L).norm() / L.norm(), 1e-10);
            EXPECT_LT((laplacian_morris<Dim>(row, i, velocity, volume, 0.) - f.morris).norm() * h * h,
                      tolerance);
            EXPECT_LT((laplacian_morris<Dim>(row, i, velocity, volume, eta * eta) - f.morris_eta).norm() * h *
                          h,
                      tolerance);
            const Vector<Dim> schwaiger = L.trace() / Dim * (f.morris - 2 * f.vector_gradient * L * f.S);
            EXPECT_LT((laplacian_schwaiger<Dim>(row, i, velocity, volume, L) - schwaiger).norm() * h * h,
                      tolerance * (1 + L.norm() * L.norm() * V_h));
            const Vector<Dim> R = shifting_factor<Dim> * std::pow(mean_distance, Dim) * f.crowding;
            EXPECT_LT((shifting_vector<Dim>(row, sample.list.support_radius()) - R).norm(), 1e-10);
        }
    }
}

TYPED_TEST(Operators, TakeUniformVolumesAsFieldsOfEqualOnes) {
    constexpr int Dim = TypeParam::value;
    const Sample<Dim> sample(9, 0.2, 14, true);
    const std::vector<double> V(sample.count(), sample.volume());
    const std::vector<double> A = this->random.values(sample.count(), -1, 1);
    for (int i = 0; i < sample.count(); ++i) {
        const auto row = sample.list.row(i);
        EXPECT_EQ(gradient_difference<Dim>(row, i, A.data(), VolumeField{V.data()}),
                  gradient_difference<Dim>(row, i, A.data(), UniformVolume{sample.volume()}));
    }
}

// Exactness.

TYPED_TEST(Operators, AreZeroForConstants) {
    constexpr int Dim = TypeParam::value;
    for (const Sample<Dim>& sample : samples<Dim>()) {
        const UniformVolume volume{sample.volume()};
        const std::vector<double> A(sample.count(), 3.7);
        VectorField<Dim> u;
        u.fill(A);
        const auto velocity = pointers<Dim>(u);
        for (int i = 0; i < sample.count(); ++i) {
            const auto row = sample.list.row(i);
            const Matrix<Dim> L = renormalisation<Dim>(row, volume);
            EXPECT_EQ(gradient_difference<Dim>(row, i, A.data(), volume).norm(), 0);
            EXPECT_EQ(vector_gradient_difference<Dim>(row, i, velocity, volume).norm(), 0);
            EXPECT_EQ(divergence_difference<Dim>(row, i, velocity, volume), 0);
            EXPECT_EQ(laplacian_morris<Dim>(row, i, velocity, volume, 0.).norm(), 0);
            EXPECT_EQ(laplacian_schwaiger<Dim>(row, i, velocity, volume, L).norm(), 0);
        }
    }
}

// Renormalised G- and Schwaiger are exact for linear fields wherever the neighbours span the space: at edges,
// corners and on any disorder.
TYPED_TEST(Operators, AreExactForLinearFieldsWhereRenormalised) {
    constexpr int Dim = TypeParam::value;
    for (const Sample<Dim>& sample : samples<Dim>()) {
        if (sample.box.periodic[0]) {
            continue; // a linear field is not periodic
        }
        const std::vector<double> V =
            this->random.values(sample.count(), 0.5 * sample.volume(), 2 * sample.volume());
        const VolumeField volume{V.data()};
        Matrix<Dim> G;
        VectorField<Dim> u;
        for (int a = 0; a < Dim; ++a) {
            const Vector<Dim> g = eigen<Dim>(std::array<double, Dim>{1. + a, -2.5});
            G.row(a) = g.transpose();
            u[a] = values(sample, [&](const Vector<Dim>& x) { return 0.3 + g.dot(x); });
        }
        for (int i = 0; i < sample.count(); ++i) {
            const auto row = sample.list.row(i);
            const Matrix<Dim> L = renormalisation<Dim>(row, volume);
            const Vector<Dim> gradient = L * gradient_difference<Dim>(row, i, u[0].data(), volume);
            const Matrix<Dim> vector_gradient =
                vector_gradient_difference<Dim>(row, i, pointers<Dim>(u), volume) * L;
            EXPECT_LT((gradient - G.row(0).transpose()).norm(), 1e-12);
            EXPECT_LT((vector_gradient - G).norm(), 1e-12);
            EXPECT_LT(laplacian_schwaiger<Dim>(row, i, pointers<Dim>(u), volume, L).norm() * sample.h,
                      1e-11 * L.norm());
        }
    }
}

// On a lattice every odd moment vanishes and tr L/dim divides by the second moment, so LS is exact for
// quadratics; the Morris form misses the division and is wrong by the error of the second moment, the same at
// every h.
TYPED_TEST(Operators, GiveTheLaplacianOfQuadraticsOnALattice) {
    constexpr int Dim = TypeParam::value;
    for (const double side : {1.0, 1e-3}) {
        const Sample<Dim> sample(Dim == 2 ? 14 : 10, 0, 0, false, side);
        const UniformVolume volume{sample.volume()};
        VectorField<Dim> u;
        u.fill(values(sample, [](const Vector<Dim>& x) { return x.squaredNorm() + 3 * x[0] * x[1] - x[0]; }));
        int inside = 0;
        for (int i = 0; i < sample.count(); ++i) {
            bool full = true;
            for (int d = 0; d < Dim; ++d) {
                const double x = sample.points[d][i];
                full = full && x > 4 * sample.dx && x < side - 4 * sample.dx;
            }
            if (!full) {
                continue;
            }
            ++inside;
            const auto row = sample.list.row(i);
            const Matrix<Dim> L = renormalisation<Dim>(row, volume);
            const double schwaiger = laplacian_schwaiger<Dim>(row, i, pointers<Dim>(u), volume, L)[0];
            const double morris = laplacian_morris<Dim>(row, i, pointers<Dim>(u), volume, 0.)[0];
            EXPECT_NEAR(schwaiger, 2 * Dim, 1e-9);
            EXPECT_NEAR(morris, 2 * Dim * Dim / L.trace(), 1e-9);
            EXPECT_NEAR(morris, 2 * Dim, 0.02);
        }
        EXPECT_GT(inside, 0);
    }
}

TYPED_TEST(Operators, TakeTheTraceOfTheVectorGradientAsDivergence) {
    constexpr int Dim = TypeParam::value;
    const Sample<Dim> sample(9, 0.2, 15, true);
    const UniformVolume volume{sample.volume()};
    const VectorField<Dim> u = random_vectors<Dim>(this->random, sample.count());
    for (int i = 0; i < sample.count(); ++i) {
        const auto row = sample.list.row(i);
        const Matrix<Dim> gradient = vector_gradient_difference<Dim>(row, i, pointers<Dim>(u), volume);
        EXPECT_NEAR(divergence_difference<Dim>(row, i, pointers<Dim>(u), volume), gradient.trace(),
                    1e-12 * gradient.norm());
        for (int a = 0; a < Dim; ++a) {
            const Vector<Dim> of_component = gradient_difference<Dim>(row, i, u[a].data(), volume);
            EXPECT_LT((gradient.row(a).transpose() - of_component).norm(), 1e-12 * gradient.norm());
        }
    }
}

// Conservation.

template <int Dim>
struct Fluid {
    Fluid(Random& random, int count)
        : u(random_vectors<Dim>(random, count)), P(random.values(count, -1, 3)),
          v(random.values(count, 0.5, 2)) {}
    MomentumFields<Dim> fields() const { return {pointers<Dim>(u), P.data(), v.data()}; }

    VectorField<Dim> u;
    std::vector<double> P; ///< p/rho^2
    std::vector<double> v; ///< 1/rho
};

TYPED_TEST(Operators, ConserveMomentumPairByPair) {
    constexpr int Dim = TypeParam::value;
    for (const Sample<Dim>& sample : samples<Dim>()) {
        const Fluid<Dim> fluid(this->random, sample.count());
        for (const auto& [mu, pressure] : {std::pair{0.0, 1.0}, std::pair{0.7, 0.0}, std::pair{0.7, 1.0}}) {
            Fluid<Dim> part = fluid;
            for (double& P : part.P) {
                P *= pressure;
            }
            for (const double eta : {0.0, 0.1 * sample.h}) {
                Vector<Dim> total = Vector<Dim>::Zero();
                double size = 0;
                for (int i = 0; i < sample.count(); ++i) {
                    const Vector<Dim> a = momentum_weakly_compressible<Dim>(
                        sample.list.row(i), i, part.fields(), 0.4, mu, eta * eta);
                    total += a;
                    size += a.norm();
                }
                EXPECT_GT(size, 0);
                EXPECT_LT(total.norm(), 1e-14 * size);
            }
        }
    }
}

TYPED_TEST(Operators, AccelerateTwoParticlesAsTheFormulaHasIt) {
    constexpr int Dim = TypeParam::value;
    for (const Kernel* kernel : kernels::all()) {
        Points<Dim> points;
        std::array<double, Dim> x{0.41, 0.52};
        append<Dim>(points, x);
        x[0] += 0.03;
        x[1] -= 0.04;
        append<Dim>(points, x);
        const double r = 0.05;
        const double h = 0.04;
        NeighbourList<Dim> list;
        list.build(cube<Dim>(1, false), *kernel, h, 0, pointers<Dim>(points), 2);
        const double m = 0.2;
        const double mu = 0.6;
        const double eta = 0.02;
        VectorField<Dim> u;
        u.fill({0, 0});
        u[0] = {1, -2};
        u[1] = {0.5, 0.25};
        const std::vector<double> P{3, 4};
        const std::vector<double> v{0.5, 0.8};
        const MomentumFields<Dim> fields{pointers<Dim>(u), P.data(), v.data()};
        const Vector<Dim> first = momentum_weakly_compressible<Dim>(list.row(0), 0, fields, m, mu, eta * eta);
        const Vector<Dim> second =
            momentum_weakly_compressible<Dim>(list.row(1), 1, fields, m, mu, eta * eta);
        EXPECT_EQ(first, -second);
        const double dW = kernel->normalisation[Dim] / std::pow(h, Dim + 1) * kernel->derivative(r / h);
        Vector<Dim> expected = Vector<Dim>::Zero();
        const std::array<double, 2> r_ij{-0.03, 0.04};
        for (int d = 0; d < 2; ++d) {
            expected[d] = -m * (3 + 4) * dW * r_ij[d] / r +
                          m * 2 * mu * 0.5 * 0.8 * dW * r / (r * r + eta * eta) * (u[d][0] - u[d][1]);
        }
        EXPECT_LT((first - expected).norm(), 1e-12 * expected.norm());
        EXPECT_LT(-m * 7 * dW * r_ij[0], 0) << "pressure pushes the first away from the second";
    }
}

// The Laplacian as a matrix.

/// -Laplacian as a dense matrix, from the weights of the list.
template <int Dim, class Weights>
Eigen::MatrixXd dense(const Sample<Dim>& sample, const Weights& weights) {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(sample.count(), sample.count());
    for (int i = 0; i < sample.count(); ++i) {
        const auto row = sample.list.row(i);
        std::vector<double> w(row.padded);
        A(i, i) += weights(row, w.data());
        for (int k = 0; k < row.count; ++k) {
            A(i, row.index[k]) -= w[k];
        }
        for (int k = row.count; k < row.padded; ++k) {
            EXPECT_EQ(w[k], 0) << "padding";
        }
    }
    return A;
}

TYPED_TEST(Operators, MorrisMatrixIsSymmetricAndSemidefiniteWithConstantsAsNullSpace) {
    constexpr int Dim = TypeParam::value;
    const double eta_over_h = 0.1;
    for (const double disorder : {0.0, 0.3}) {
        const Sample<Dim> sample(Dim == 2 ? 13 : 8, disorder, 16, true);
        for (const double eta : {0.0, eta_over_h * sample.h}) {
            const Eigen::MatrixXd A = dense(sample, [&](const Row<Dim>& row, double* w) {
                return laplacian_morris_weights<Dim>(row, UniformVolume{sample.volume()}, eta * eta, w);
            });
            EXPECT_LT((A - A.transpose()).norm(), 1e-13 * A.norm());
            EXPECT_LT(A.rowwise().sum().norm(), 1e-13 * A.norm());
            EXPECT_LE((A - Eigen::MatrixXd(A.diagonal().asDiagonal())).maxCoeff(), 0)
                << "weights are positive";
            const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(A, Eigen::EigenvaluesOnly);
            const Eigen::VectorXd& eigenvalues = modes.eigenvalues();
            EXPECT_NEAR(eigenvalues[0], 0, 1e-12 * A.norm());
            // The next is that of the longest wave, (2 pi)^2, but for smoothing and disorder.
            EXPECT_NEAR(eigenvalues[1] / (4 * pi * pi), 1, 0.25);
            EXPECT_GT(eigenvalues[1], 0);
        }
    }
}

TYPED_TEST(Operators, WeightsAreTheOperatorAsAMatrix) {
    constexpr int Dim = TypeParam::value;
    for (const Sample<Dim>& sample : samples<Dim>()) {
        const std::vector<double> V =
            this->random.values(sample.count(), 0.5 * sample.volume(), 2 * sample.volume());
        const VolumeField volume{V.data()};
        const VectorField<Dim> u = random_vectors<Dim>(this->random, sample.count());
        const double eta_squared = std::pow(0.1 * sample.h, 2);
        for (int i = 0; i < sample.count(); ++i) {
            const auto row = sample.list.row(i);
            const Matrix<Dim> L = renormalisation<Dim>(row, volume);
            std::vector<double> w(row.padded);
            const auto by_weights = [&](double diagonal) {
                double total = 0;
                Vector<Dim> result = Vector<Dim>::Zero();
                for (int k = 0; k < row.padded; ++k) {
                    total += w[k];
                    result -= w[k] * (at<Dim>(u, i) - at<Dim>(u, row.index[k]));
                }
                double size = 0;
                for (const double weight : w) {
                    size += std::abs(weight);
                }
                EXPECT_NEAR(diagonal, total, 1e-13 * size);
                return std::pair{result, 1e-12 * size};
            };
            const auto velocity = pointers<Dim>(u);
            for (const double eta2 : {0.0, eta_squared}) {
                const auto [morris, error] =
                    by_weights(laplacian_morris_weights<Dim>(row, volume, eta2, w.data()));
                EXPECT_LT((morris - laplacian_morris<Dim>(row, i, velocity, volume, eta2)).norm(), error);
            }
            const auto [schwaiger, error] =
                by_weights(laplacian_schwaiger_weights<Dim>(row, volume, L, w.data()));
            EXPECT_LT((schwaiger - laplacian_schwaiger<Dim>(row, i, velocity, volume, L)).norm(), error);
        }
    }
}

// Invariance.

/// A rotation that mixes all directions.
template <int Dim>
Matrix<Dim> rotation() {
    Matrix<Dim> Q = Matrix<Dim>::Identity();
    for (int a = 0; a + 1 < Dim; ++a) {
        Matrix<Dim> turn = Matrix<Dim>::Identity();
        const double angle = 0.7 + a;
        turn(a, a) = turn(a + 1, a + 1) = std::cos(angle);
        turn(a, a + 1) = -std::sin(angle);
        turn(a + 1, a) = std::sin(angle);
        Q = turn * Q;
    }
    return Q;
}

TYPED_TEST(Operators, TurnWithTheArrangement) {
    constexpr int Dim = TypeParam::value;
    Sample<Dim> sample(Dim == 2 ? 12 : 7, 0.2, 17, false);
    Sample<Dim> turned = sample;
    const Matrix<Dim> Q = rotation<Dim>();
    const Fluid<Dim> fluid(this->random, sample.count());
    Fluid<Dim> turned_fluid = fluid;
    for (int i = 0; i < sample.count(); ++i) {
        const Vector<Dim> x = Q * at<Dim>(sample.points, i);
        const Vector<Dim> u = Q * at<Dim>(fluid.u, i);
        for (int d = 0; d < Dim; ++d) {
            turned.points[d][i] = x[d];
            turned_fluid.u[d][i] = u[d];
        }
    }
    turned.box.low.fill(-2);
    turned.box.high.fill(2);
    turned.build();
    ASSERT_EQ(turned.list.pairs(), sample.list.pairs());
    const UniformVolume volume{sample.volume()};
    const std::vector<double>& A = fluid.P;
    for (int i = 0; i < sample.count(); ++i) {
        const auto row = sample.list.row(i);
        const auto other = turned.list.row(i);
        const auto u = pointers<Dim>(fluid.u);
        const auto turned_u = pointers<Dim>(turned_fluid.u);
        const Matrix<Dim> L = renormalisation<Dim>(row, volume);
        const Matrix<Dim> turned_L = renormalisation<Dim>(other, volume);
        EXPECT_LT((turned_L - Q * L * Q.transpose()).norm(), 1e-11 * L.norm());
        const auto expect_turned = [&](const Vector<Dim>& rotated, const Vector<Dim>& original,
                                       double scale) {
            EXPECT_LT((rotated - Q * original).norm(), 1e-11 * (original.norm() + scale));
        };
        const double per_h = 1 / sample.h;
        expect_turned(gradient_difference<Dim>(other, i, A.data(), volume),
                      gradient_difference<Dim>(row, i, A.data(), volume), per_h);
        expect_turned(laplacian_morris<Dim>(other, i, turned_u, volume, 1e-4),
                      laplacian_morris<Dim>(row, i, u, volume, 1e-4), per_h * per_h);
        expect_turned(laplacian_schwaiger<Dim>(other, i, turned_u, volume, turned_L),
                      laplacian_schwaiger<Dim>(row, i, u, volume, L), per_h * per_h);
        expect_turned(momentum_weakly_compressible<Dim>(other, i, turned_fluid.fields(), 0.1, 0.3, 1e-4),
                      momentum_weakly_compressible<Dim>(row, i, fluid.fields(), 0.1, 0.3, 1e-4),
                      per_h * per_h);
        expect_turned(shifting_vector<Dim>(other, turned.list.support_radius()),
                      shifting_vector<Dim>(row, sample.list.support_radius()), 1);
        EXPECT_NEAR(divergence_difference<Dim>(other, i, turned_u, volume),
                    divergence_difference<Dim>(row, i, u, volume), 1e-11 * per_h);
    }
}

// Shifting.

/// The shifting vector of the first of some particles.
template <int Dim>
Vector<Dim> shift_of_first(const std::vector<std::array<double, Dim>>& particles, double radius,
                           double skin = 0) {
    Points<Dim> points;
    for (const auto& particle : particles) {
        append<Dim>(points, particle);
    }
    Box<Dim> box;
    box.low.fill(-10);
    box.high.fill(10);
    NeighbourList<Dim> list;
    list.build(box, kernels::find("quintic_spline"), radius / 3, skin, pointers<Dim>(points),
               static_cast<int>(particles.size()));
    return shifting_vector<Dim>(list.row(0), list.support_radius());
}

TYPED_TEST(Operators, ShiftNothingOnALattice) {
    constexpr int Dim = TypeParam::value;
    const Sample<Dim> sample(10, 0, 0, true);
    for (int i = 0; i < sample.count(); ++i) {
        EXPECT_LT(shifting_vector<Dim>(sample.list.row(i), sample.list.support_radius()).norm(), 1e-11);
    }
}

TYPED_TEST(Operators, ShiftAwayFromCrowding) {
    constexpr int Dim = TypeParam::value;
    // one neighbour at any distance: rbar = r, so R is along the unit vector from it
    const Vector<Dim> pair = shift_of_first<Dim>({{}, {0.3, -0.4}}, 1);
    EXPECT_NEAR(pair[0], -0.6 * shifting_factor<Dim>, 1e-15);
    EXPECT_NEAR(pair[1], 0.8 * shifting_factor<Dim>, 1e-15);
    // neighbours at a and b on either side, rbar = (a + b)/2: R = rbar^dim (1/b^dim - 1/a^dim) towards a
    const Vector<Dim> three = shift_of_first<Dim>({{}, {0.5}, {-0.25}}, 1) / shifting_factor<Dim>;
    EXPECT_NEAR(three[0], std::pow(0.375, Dim) * (std::pow(0.25, -Dim) - std::pow(0.5, -Dim)), 1e-14);
    EXPECT_NEAR(three.norm(), three[0], 1e-15);
}

// div (n/r^dim) = -1/r^(dim+1), shared alike by all directions on a lattice: a particle that leaves its place
// by a little is sent back at the rate (rbar^dim/dim) sum 1/r^(dim+1), which the factor makes the same in
// three dimensions.
TYPED_TEST(Operators, ShiftAParticleBackIntoTheMiddleOfItsNeighbours) {
    constexpr int Dim = TypeParam::value;
    const Sample<Dim> sample(10, 0, 0, true);
    const int i = sample.count() / 3;
    double rate = 0;
    double distances = 0;
    const auto neighbours = all_neighbours<Dim>(sample.box, sample.points, *sample.kernel, sample.h)[i];
    for (const Neighbour<Dim>& pair : neighbours) {
        rate += std::pow(pair.distance, -Dim - 1) / Dim;
        distances += pair.distance;
    }
    rate *= shifting_factor<Dim> * std::pow(distances / static_cast<double>(neighbours.size()), Dim);
    EXPECT_NEAR(rate * sample.dx, 24.3, 0.05);
    const double moved = 1e-3 * sample.dx;
    for (int d = 0; d < Dim; ++d) {
        Sample<Dim> displaced = sample;
        displaced.points[d][i] += moved;
        displaced.build();
        const Vector<Dim> R = shifting_vector<Dim>(displaced.list.row(i), displaced.list.support_radius());
        EXPECT_NEAR(R[d] / moved, -rate, 1e-4 * rate);
        EXPECT_NEAR(R.norm(), -R[d], 1e-9);
    }
}

TYPED_TEST(Operators, ShiftByNeighboursWithinTheSupportOnly) {
    constexpr int Dim = TypeParam::value;
    // the list reaches to 1.5, the sum to 1
    const Vector<Dim> shift = shift_of_first<Dim>({{}, {0, 0.5}, {1.2}, {-1.0001, 0}}, 1, 0.5);
    EXPECT_EQ(shift[0], 0);
    EXPECT_DOUBLE_EQ(shift[1], -shifting_factor<Dim>);
}

TYPED_TEST(Operators, ShiftAlikeAtAnyScale) {
    constexpr int Dim = TypeParam::value;
    const Sample<Dim> sample(9, 0.3, 18, true);
    const Sample<Dim> small(9, 0.3, 18, true, 1e-3);
    for (int i = 0; i < sample.count(); ++i) {
        const Vector<Dim> R = shifting_vector<Dim>(sample.list.row(i), sample.list.support_radius());
        EXPECT_LT((R - shifting_vector<Dim>(small.list.row(i), small.list.support_radius())).norm(), 1e-9);
        EXPECT_GT(R.norm(), 1e-3);
    }
}

TYPED_TEST(Operators, TakeCoincidentParticlesWithoutHarm) {
    constexpr int Dim = TypeParam::value;
    EXPECT_EQ(shift_of_first<Dim>({{}, {}}, 1).norm(), 0);
    EXPECT_EQ(shift_of_first<Dim>({{}}, 1).norm(), 0);
    const Vector<Dim> beside = shift_of_first<Dim>({{}, {}, {0.25}}, 1);
    EXPECT_DOUBLE_EQ(beside[0], -shifting_factor<Dim>)
        << "a coincident particle is in neither the sum nor the mean distance";

    const Points<Dim> points = [] {
        Points<Dim> all;
        append<Dim>(all, {0.5, 0.5});
        append<Dim>(all, {0.5, 0.5});
        append<Dim>(all, {0.55, 0.5});
        return all;
    }();
    NeighbourList<Dim> list;
    list.build(cube<Dim>(1, false), kernels::find("wendland_c2"), 0.1, 0, pointers<Dim>(points), 3);
    const Fluid<Dim> fluid(this->random, 3);
    const UniformVolume volume{0.01};
    for (int i = 0; i < 3; ++i) {
        const auto row = list.row(i);
        const auto u = pointers<Dim>(fluid.u);
        EXPECT_TRUE(gradient_difference<Dim>(row, i, fluid.P.data(), volume).allFinite());
        EXPECT_TRUE(laplacian_morris<Dim>(row, i, u, volume, 0.).allFinite());
        EXPECT_TRUE(momentum_weakly_compressible<Dim>(row, i, fluid.fields(), 1, 1, 0.).allFinite());
        EXPECT_TRUE(renormalisation<Dim>(row, volume).allFinite());
    }
}

// Neighbours that do not span the space.

TYPED_TEST(Operators, RenormaliseByTheIdentityWhereNeighboursDoNotSpanTheSpace) {
    constexpr int Dim = TypeParam::value;
    const Matrix<Dim> identity = Matrix<Dim>::Identity();
    const Matrix<Dim> Q = rotation<Dim>();
    const auto of_first = [](const Points<Dim>& points) {
        Box<Dim> box;
        box.low.fill(-3);
        box.high.fill(3);
        NeighbourList<Dim> list;
        list.build(box, kernels::find("quintic_spline"), 0.13, 0, pointers<Dim>(points), size<Dim>(points));
        return renormalisation<Dim>(list.row(0), UniformVolume{std::pow(0.1, Dim)});
    };
    Points<Dim> points;
    append<Dim>(points, {});
    EXPECT_EQ(of_first(points), identity) << "no neighbour";
    // in 3-D a plane, in 2-D a line; askew, so that round-off keeps the moments from being singular to the
    // bit
    for (int k = 1; k < 4; ++k) {
        for (int side = -1; side <= 1; side += 2) {
            for (int l = 0; l < (Dim == 2 ? 1 : 3); ++l) {
                Vector<Dim> x = Vector<Dim>::Zero();
                x[0] = 0.1 * k * side;
                x[1] = 0.07 * l;
                x = Q * x;
                std::array<double, Dim> point;
                std::copy(x.begin(), x.end(), point.begin());
                append<Dim>(points, point);
            }
        }
    }
    EXPECT_EQ(of_first(points), identity) << "a line or a plane";
}

// Published numbers.

/// The eta of the Morris form lowers the Laplacian of any quadratic, hence of any smooth field, by a fraction
/// that no resolution removes: integral of F r^4/(r^2 + eta^2) over integral of F r^2 in the continuum. Here
/// at a particle with enough neighbours to make quadrature negligible.
template <int Dim>
double fraction_left(const Kernel& kernel, double h, double eta_over_h, double h_over_dx) {
    const double dx = h / h_over_dx;
    const int reach = static_cast<int>(kernel.support * h_over_dx) + 1;
    Points<Dim> points;
    append<Dim>(points, {});
    std::array<int, Dim> at;
    at.fill(-reach);
    while (at[Dim - 1] <= reach) {
        std::array<double, Dim> x;
        double squared = 0;
        for (int d = 0; d < Dim; ++d) {
            x[d] = at[d] * dx;
            squared += x[d] * x[d];
        }
        if (squared > 0 && squared < std::pow(kernel.support * h, 2)) {
            append<Dim>(points, x);
        }
        for (int d = 0; d < Dim && ++at[d] > reach && d + 1 < Dim; ++d) {
            at[d] = -reach;
        }
    }
    // A single row: the list of all pairs would be large.
    const int count = size<Dim>(points) - 1;
    const int padded = (count + lane_count - 1) / lane_count * lane_count;
    std::vector<int> index(padded, 0);
    std::vector<double> slope(padded, 0.0);
    VectorField<Dim> separation;
    separation.fill(std::vector<double>(padded, 0.0));
    std::vector<double> squares(count + 1, 0.0);
    for (int k = 0; k < count; ++k) {
        index[k] = k + 1;
        for (int d = 0; d < Dim; ++d) {
            separation[d][k] = -points[d][k + 1];
            squares[k + 1] += points[d][k + 1] * points[d][k + 1];
        }
        slope[k] = kernel.slope(Dim, std::sqrt(squares[k + 1]), h);
    }
    const Row<Dim> row{count, padded, index.data(), slope.data(), pointers<Dim>(separation)};
    std::array<const double*, Dim> u;
    u.fill(squares.data());
    const double eta = eta_over_h * h;
    return laplacian_morris<Dim>(row, 0, u, UniformVolume{std::pow(dx, Dim)}, eta * eta)[0] / (2 * Dim);
}

TEST(MorrisLaplacian, LosesThePublishedFractionByItsEta) {
    const Kernel& quintic = kernels::find("quintic_spline");
    const Kernel& wendland = kernels::find("wendland_c2");
    // Xu sheet §1.4, at any h
    for (const double h : {1e-4, 1.0, 300.0}) {
        EXPECT_NEAR(fraction_left<2>(quintic, h, 0.1, 20), 0.9907, 5e-5) << h;
        EXPECT_NEAR(fraction_left<3>(quintic, h, 0.1, 10), 0.9934, 5e-5) << h;
        EXPECT_NEAR(fraction_left<2>(wendland, h, 0.1, 20), 0.9837, 5e-5) << h;
        EXPECT_NEAR(fraction_left<3>(wendland, h, 0.1, 10), 0.9887, 5e-5) << h;
    }
    for (const Kernel* kernel : {&quintic, &wendland}) {
        EXPECT_NEAR(fraction_left<2>(*kernel, 1, 0, 20), 1, 2e-5);
        EXPECT_NEAR(fraction_left<3>(*kernel, 1, 0, 10), 1, 2e-5);
    }
}

// Every coefficient of the fit is the derivative that its place stands for, those of the third degree
// included, which neither gradient nor Laplacian reads.
TEST(MovingLeastSquares, CoefficientsOfACubicAreItsDerivatives) {
    const Sample<2> sample(12, 0.2, 5, false, 1, 1.6);
    const double x0 = 0.4;
    const double y0 = 0.6;
    const auto A = values<2>(sample, [&](const Vector<2>& r) {
        const double x = r[0] - x0;
        const double y = r[1] - y0;
        return 0.3 + 2 * x - 3 * y + 5 * x * x / 2 + 7 * x * y - 11 * y * y / 2 + 13 * x * x * x / 6 +
               17 * x * x * y / 2 - 19 * x * y * y / 2 + 23 * y * y * y / 6;
    });
    for (int i = 0; i < sample.count(); i += 7) {
        const double x = sample.points[0][i] - x0;
        const double y = sample.points[1][i] - y0;
        const std::array expected{2 + 5 * x + 7 * y + 13 * x * x / 2 + 17 * x * y - 19 * y * y / 2,
                                  -3 + 7 * x - 11 * y + 17 * x * x / 2 - 19 * x * y + 23 * y * y / 2,
                                  5 + 13 * x + 17 * y,
                                  7 + 17 * x - 19 * y,
                                  -11 - 19 * x + 23 * y,
                                  13.,
                                  17.,
                                  -19.,
                                  23.};
        const auto found = taylor_coefficients<2, 3>(sample.list.row(i), i, A.data(), sample.h);
        ASSERT_TRUE(found.has_value());
        for (int m = 0; m < 9; ++m) {
            EXPECT_NEAR((*found)[m], expected[m], 1e-7) << i << ", derivative " << m;
        }
    }
}

} // namespace
} // namespace sphvv::solver
