// The discrete pressure equation against manufactured solutions and dense linear algebra.
//   solver_pressure_poisson --gtest_filter='*Iterations*'
#include "sphvv/solver/linear/pressure_poisson.hpp"

#include "sphvv/solver/operators/laplacian_morris.hpp"
#include "sphvv/solver/operators/laplacian_schwaiger.hpp"
#include "sphvv/solver/operators/renormalisation.hpp"
#include "sphvv/solver/tests/scenes.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace sphvv::solver {
namespace {

using namespace scenes;

template <int Dim>
using Options = typename PressurePoisson<Dim>::Options;
template <int Dim>
using Preconditioner = typename PressurePoisson<Dim>::Preconditioner;

/// Writes the weights of the Morris (symmetric) or the Schwaiger Laplacian.
template <int Dim>
void write_weights(PressurePoisson<Dim>& problem, const NeighbourList<Dim>& list, double volume,
                   bool symmetric) {
    static const Images<Dim> no_images;
    problem.reset(list, no_images);
    for (int i = 0; i < list.size(); ++i) {
        const auto row = list.row(i);
        const UniformVolume V{volume};
        problem.diagonal(i) =
            symmetric
                ? laplacian_morris_weights<Dim>(row, V, 0., problem.weights(i))
                : laplacian_schwaiger_weights<Dim>(row, V, renormalisation<Dim>(row, V), problem.weights(i));
        problem.source(i) = 0;
    }
}

/// Sum over j of w_ij (p_i - p_j), dense, from the weights that the problem was given.
template <int Dim>
Eigen::MatrixXd dense(PressurePoisson<Dim>& problem, const NeighbourList<Dim>& list) {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(list.size(), list.size());
    for (int i = 0; i < list.size(); ++i) {
        const auto row = list.row(i);
        for (int k = 0; k < row.count; ++k) {
            A(i, i) += problem.weights(i)[k];
            A(i, row.index[k]) -= problem.weights(i)[k];
        }
    }
    return A;
}

Eigen::VectorXd with_zero_mean(const std::vector<double>& values) {
    Eigen::VectorXd p =
        Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
    p.array() -= p.mean();
    return p;
}

/// A smooth pressure: waves of all directions.
template <int Dim>
Eigen::VectorXd smooth_pressure(const Points<Dim>& points) {
    std::vector<double> p;
    for (int i = 0; i < size<Dim>(points); ++i) {
        double value = 0;
        for (int d = 0; d < Dim; ++d) {
            value += std::cos(2 * pi * points[d][i] + d) + 0.5 * std::sin(4 * pi * points[d][i]);
        }
        p.push_back(value);
    }
    return with_zero_mean(p);
}

template <int Dim>
void set_source(PressurePoisson<Dim>& problem, const Eigen::VectorXd& b) {
    for (int i = 0; i < problem.size(); ++i) {
        problem.source(i) = b[i];
    }
}

struct Case {
    bool symmetric;
    bool two_level;
};

const std::array cases{Case{true, false}, Case{true, true}, Case{false, false}, Case{false, true}};

template <int Dim>
Options<Dim> options(const Case& c, double tolerance) {
    Options<Dim> result;
    result.tolerance = tolerance;
    result.symmetric = c.symmetric;
    result.preconditioner = c.two_level ? Preconditioner<Dim>::two_level : Preconditioner<Dim>::jacobi;
    return result;
}

template <class Dimension>
class PressurePoissonTest : public testing::Test {
protected:
    static constexpr int dims = Dimension::value;

    /// Runs the check for both kinds of weights and both preconditioners on a lattice and on 20 % jitter.
    template <class Check>
    void for_each_case(int n, double tolerance, const Check& check) {
        for (const double disorder : {0.0, 0.2}) {
            const Sample<dims> sample(n, disorder, 21, true);
            for (const Case& c : cases) {
                SCOPED_TRACE(std::string(c.symmetric ? "symmetric" : "not symmetric") +
                             (c.two_level ? ", two levels" : ", Jacobi") + ", disorder " +
                             std::to_string(disorder));
                PressurePoisson<dims> problem(options<dims>(c, tolerance));
                write_weights(problem, sample.list, sample.volume(), c.symmetric);
                check(sample, problem, c);
            }
        }
    }

    const int moderate = dims == 2 ? 24 : 10;
    Random random{20240610};
};

TYPED_TEST_SUITE(PressurePoissonTest, Dimensions);

TYPED_TEST(PressurePoissonTest, MultipliesLikeTheDenseMatrix) {
    constexpr int Dim = TypeParam::value;
    this->for_each_case(
        Dim == 2 ? 12 : 8, 1e-5, [&](const Sample<Dim>& sample, PressurePoisson<Dim>& problem, Case c) {
            const Eigen::MatrixXd A = dense(problem, sample.list);
            const std::vector<double> x = this->random.values(sample.count(), -1, 1);
            std::vector<double> y(x.size());
            problem.multiply(x.data(), y.data());
            Eigen::VectorXd expected = A * Eigen::Map<const Eigen::VectorXd>(x.data(), A.rows());
            if (!c.symmetric) {
                expected.array() -= expected.mean(); // no source may be out of the equation's reach
            }
            EXPECT_EQ(problem.size(), sample.count());
            EXPECT_LT((Eigen::Map<const Eigen::VectorXd>(y.data(), A.rows()) - expected).norm(),
                      1e-13 * expected.norm());
            EXPECT_NEAR(expected.mean(), 0, 1e-12 * expected.norm());
        });
}

TYPED_TEST(PressurePoissonTest, RecoversTheManufacturedPressure) {
    constexpr int Dim = TypeParam::value;
    constexpr double tolerance = 1e-11;
    this->for_each_case(
        this->moderate, tolerance, [&](const Sample<Dim>& sample, PressurePoisson<Dim>& problem, Case) {
            const Eigen::VectorXd exact = smooth_pressure<Dim>(sample.points);
            Eigen::VectorXd b(exact.size());
            problem.multiply(exact.data(), b.data());
            set_source(problem, b);
            Eigen::VectorXd p = Eigen::VectorXd::Zero(exact.size());
            const LinearSolve solve = problem.solve(p.data());
            EXPECT_TRUE(solve.converged);
            EXPECT_LE(solve.residual, tolerance);
            EXPECT_GT(solve.iterations, 0);
            Eigen::VectorXd product(p.size());
            problem.multiply(p.data(), product.data());
            EXPECT_LT((product - b).norm(), 2 * tolerance * b.norm());
            // The operator's smallest eigenvalue belongs to the longest wave, which is in the pressure.
            EXPECT_LT((p - exact).norm(), 10 * tolerance * exact.norm() + 1e-9 * exact.norm());
            EXPECT_NEAR(p.mean(), 0, 1e-14);
        });
}

TYPED_TEST(PressurePoissonTest, AgreesWithADenseSolve) {
    constexpr int Dim = TypeParam::value;
    this->for_each_case(
        Dim == 2 ? 12 : 8, 1e-12, [&](const Sample<Dim>& sample, PressurePoisson<Dim>& problem, Case) {
            Eigen::MatrixXd A = dense(problem, sample.list);
            const Eigen::VectorXd b = with_zero_mean(this->random.values(sample.count(), -1, 1));
            set_source(problem, b);
            std::vector<double> p = this->random.values(sample.count(), -1, 1);
            EXPECT_TRUE(problem.solve(p.data()).converged);
            // Equations up to a constant, and the one more that the mean vanish: square again and regular.
            A.rowwise() -= A.colwise().mean().eval();
            A.array() += A.norm() / static_cast<double>(A.rows());
            const Eigen::VectorXd expected = A.partialPivLu().solve(b);
            const Eigen::VectorXd found = Eigen::Map<const Eigen::VectorXd>(p.data(), b.size());
            EXPECT_LT((found - expected).norm(), 1e-8 * expected.norm());
        });
}

TYPED_TEST(PressurePoissonTest, IgnoresTheMeanOfTheSourceAndOfTheGuess) {
    constexpr int Dim = TypeParam::value;
    this->for_each_case(
        this->moderate, 1e-10, [&](const Sample<Dim>& sample, PressurePoisson<Dim>& problem, Case) {
            const Eigen::VectorXd b = with_zero_mean(this->random.values(sample.count(), -1, 1));
            set_source(problem, b);
            Eigen::VectorXd p = Eigen::VectorXd::Zero(sample.count());
            const LinearSolve solve = problem.solve(p.data());
            Eigen::VectorXd shifted_b = b;
            shifted_b.array() += 17;
            set_source(problem, shifted_b);
            Eigen::VectorXd q = Eigen::VectorXd::Constant(sample.count(), 3);
            const LinearSolve shifted = problem.solve(q.data());
            EXPECT_TRUE(solve.converged && shifted.converged);
            EXPECT_LT((p - q).norm(), 1e-6 * p.norm());
            EXPECT_NEAR(q.mean(), 0, 1e-13) << "round-off of the guess's mean";
        });
}

TYPED_TEST(PressurePoissonTest, HasNoPressureWithoutASource) {
    constexpr int Dim = TypeParam::value;
    this->for_each_case(Dim == 2 ? 12 : 8, 1e-5,
                        [&](const Sample<Dim>& sample, PressurePoisson<Dim>& problem, Case) {
                            std::vector<double> p = this->random.values(sample.count(), -1, 1);
                            const LinearSolve solve = problem.solve(p.data());
                            EXPECT_TRUE(solve.converged);
                            EXPECT_EQ(solve.iterations, 0);
                            EXPECT_EQ(p, std::vector<double>(p.size(), 0.0));
                        });
}

TYPED_TEST(PressurePoissonTest, HasNoPressureWhereTheSourceIsRoundOff) {
    constexpr int Dim = TypeParam::value;
    this->for_each_case(9, 1e-5, [&](const Sample<Dim>& sample, PressurePoisson<Dim>& problem, Case) {
        const std::vector<double> noise = this->random.values(sample.count(), 2 - 1e-14, 2 + 1e-14);
        const auto solve_with = [&](double round_off) {
            set_source(problem, Eigen::Map<const Eigen::VectorXd>(noise.data(), sample.count()));
            problem.set_round_off(round_off);
            std::vector<double> p = this->random.values(sample.count(), -1, 1);
            const LinearSolve solve = problem.solve(p.data());
            const bool nothing = std::ranges::all_of(p, [](double value) { return value == 0; });
            EXPECT_EQ(nothing, round_off > 1e-14);
            EXPECT_EQ(solve.iterations == 0, nothing);
            EXPECT_TRUE(solve.converged);
            EXPECT_LT(solve.iterations, 500) << "from zero at once: the guess is lost against its round-off";
        };
        solve_with(1e-13);
        solve_with(1e-15); // a solution that is lost against the guess
    });
}

// A guess that is 10^m times the solution is forgotten. The residual that the solvers carry along loses what
// is of the guess's round-off, and Bi-CGSTAB ended 118 % off while it reported 1e-6.
TYPED_TEST(PressurePoissonTest, ForgetsAGuessThatIsFarTooLarge) {
    constexpr int Dim = TypeParam::value;
    constexpr double tolerance = 1e-6;
    this->for_each_case(9, tolerance, [&](const Sample<Dim>& sample, PressurePoisson<Dim>& problem, Case) {
        const Eigen::VectorXd exact = smooth_pressure<Dim>(sample.points);
        Eigen::VectorXd b(exact.size());
        problem.multiply(exact.data(), b.data());
        for (const double size : {1e3, 1e6, 1e9, 1e10, 1e11, 1e12, 1e13, 1e15}) {
            SCOPED_TRACE(size);
            set_source(problem, b);
            std::vector<double> p = this->random.values(sample.count(), -size, size);
            const LinearSolve solve = problem.solve(p.data());
            EXPECT_TRUE(solve.converged) << solve.residual;
            Eigen::VectorXd product(exact.size());
            problem.multiply(p.data(), product.data());
            EXPECT_NEAR((product - b).norm() / b.norm(), solve.residual, 1e-2 * tolerance);
            EXPECT_LT(solve.residual, tolerance);
            // of the longest waves, which the operator takes the least of
            EXPECT_LT((with_zero_mean(p) - exact).norm(), 10 * tolerance * exact.norm());
            EXPECT_LT(solve.iterations, 500) << "a tenth of two vain starts";
        }
    });
}

// What is no number is told of its particle, before it spreads to all.
TYPED_TEST(PressurePoissonTest, NamesTheParticleWithoutAnEquation) {
    constexpr int Dim = TypeParam::value;
    constexpr int culprit = 17;
    this->for_each_case(9, 1e-6, [&](const Sample<Dim>& sample, PressurePoisson<Dim>& problem, Case c) {
        for (const double wrong : {not_a_number, infinity}) {
            const auto fault_of = [&](const auto& spoil) {
                write_weights(problem, sample.list, sample.volume(), c.symmetric);
                set_source(problem, with_zero_mean(this->random.values(sample.count(), -1, 1)));
                std::vector<double> p(sample.count(), 1);
                spoil(p);
                const std::vector<double> guess = p;
                const LinearSolve solve = problem.solve(p.data());
                EXPECT_FALSE(solve.converged);
                EXPECT_EQ(solve.iterations, 0);
                EXPECT_EQ(solve.faulty, culprit);
                EXPECT_EQ(p[0], guess[0]);
                return std::string(solve.fault);
            };
            EXPECT_EQ(fault_of([&](auto&) { problem.source(culprit) = wrong; }), "source not finite");
            EXPECT_EQ(fault_of([&](auto&) { problem.diagonal(culprit) = wrong; }), "equation not finite");
            EXPECT_EQ(fault_of([&](auto& p) { p[culprit] = wrong; }), "first guess not finite");
            EXPECT_EQ(fault_of([&](auto&) { problem.diagonal(culprit) = 0; }), "equation without neighbours");
        }
    });
}

TYPED_TEST(PressurePoissonTest, NeedsNoIterationFromTheSolution) {
    constexpr int Dim = TypeParam::value;
    this->for_each_case(
        this->moderate, 1e-6, [&](const Sample<Dim>& sample, PressurePoisson<Dim>& problem, Case) {
            const Eigen::VectorXd exact = smooth_pressure<Dim>(sample.points) +
                                          0.1 * with_zero_mean(this->random.values(sample.count(), -1, 1));
            Eigen::VectorXd b(exact.size());
            problem.multiply(exact.data(), b.data());
            set_source(problem, b);
            Eigen::VectorXd p = exact;
            const LinearSolve solve = problem.solve(p.data());
            EXPECT_TRUE(solve.converged);
            EXPECT_EQ(solve.iterations, 0);
            EXPECT_LT((p - exact).norm(), 1e-14 * exact.norm());
            EXPECT_EQ(solve.matrix_entries, sample.list.pairs() + sample.count())
                << "one product, for the residual";
            // and fewer from near it than from nothing
            p = 1.001 * exact;
            const LinearSolve near = problem.solve(p.data());
            p.setZero();
            EXPECT_LT(near.iterations, problem.solve(p.data()).iterations);
        });
}

TYPED_TEST(PressurePoissonTest, SaysWhenItDidNotConverge) {
    constexpr int Dim = TypeParam::value;
    const Sample<Dim> sample(this->moderate, 0.2, 22, true);
    for (const Case& c : cases) {
        Options<Dim> impatient = options<Dim>(c, 1e-12);
        impatient.maximum_iterations = 3;
        PressurePoisson<Dim> problem(impatient);
        write_weights(problem, sample.list, sample.volume(), c.symmetric);
        set_source(problem, with_zero_mean(this->random.values(sample.count(), -1, 1)));
        std::vector<double> p(sample.count());
        const LinearSolve solve = problem.solve(p.data());
        EXPECT_FALSE(solve.converged);
        EXPECT_EQ(solve.iterations, 3);
        EXPECT_GT(solve.residual, 1e-12);
        EXPECT_EQ(solve.matrix_entries,
                  (sample.list.pairs() + sample.count()) * (1 + 3 * (c.symmetric ? 1 : 2)));
    }
}

TYPED_TEST(PressurePoissonTest, GivesTheSameBitsAtAnyAddressAndOnAnyObject) {
    constexpr int Dim = TypeParam::value;
    this->for_each_case(
        this->moderate, 1e-9, [&](const Sample<Dim>& sample, PressurePoisson<Dim>& problem, Case c) {
            const std::vector<double> b = this->random.values(sample.count(), -1, 1);
            const std::vector<double> guess = this->random.values(sample.count(), -1, 1);
            std::vector<double> first;
            for (std::size_t offset = 0; offset < 8; ++offset) {
                std::vector<double> memory(guess.size() + 8);
                std::copy(guess.begin(), guess.end(), memory.begin() + offset);
                set_source(problem, Eigen::Map<const Eigen::VectorXd>(b.data(), sample.count()));
                problem.solve(memory.data() + offset);
                const std::vector<double> p(memory.begin() + offset, memory.begin() + offset + guess.size());
                first = offset == 0 ? p : first;
                EXPECT_EQ(p == first, true) << "offset " << offset;
            }
            PressurePoisson<Dim> other(options<Dim>(c, 1e-9));
            other = PressurePoisson<Dim>(options<Dim>(c, 1e-9));
            write_weights(other, sample.list, sample.volume(), c.symmetric);
            set_source(other, Eigen::Map<const Eigen::VectorXd>(b.data(), sample.count()));
            std::vector<double> p = guess;
            other.solve(p.data());
            EXPECT_EQ(p == first, true);
        });
}

TYPED_TEST(PressurePoissonTest, CanBeUsedAgainForOtherParticles) {
    constexpr int Dim = TypeParam::value;
    for (const Case& c : cases) {
        PressurePoisson<Dim> problem(options<Dim>(c, 1e-10));
        for (const int n : {this->moderate, 9, this->moderate + 1}) {
            const Sample<Dim> sample(n, 0.1, 23, true);
            write_weights(problem, sample.list, sample.volume(), c.symmetric);
            const Eigen::VectorXd exact = smooth_pressure<Dim>(sample.points);
            Eigen::VectorXd b(exact.size());
            problem.multiply(exact.data(), b.data());
            set_source(problem, b);
            Eigen::VectorXd p = Eigen::VectorXd::Zero(exact.size());
            EXPECT_TRUE(problem.solve(p.data()).converged);
            EXPECT_LT((p - exact).norm(), 1e-7 * exact.norm());
            EXPECT_GE(problem.bytes(), 8 * (sample.list.entries() + 2 * sample.count()));
        }
    }
}

// A free surface: the pressure of some particles is given, and no constant is left free.
TYPED_TEST(PressurePoissonTest, KeepsFixedPressuresAtZero) {
    constexpr int Dim = TypeParam::value;
    this->for_each_case(
        Dim == 2 ? 12 : 8, 1e-12, [&](const Sample<Dim>& sample, PressurePoisson<Dim>& problem, Case) {
            Eigen::MatrixXd A = dense(problem, sample.list);
            Eigen::VectorXd b(sample.count());
            for (int i = 0; i < sample.count(); ++i) {
                b[i] = this->random.uniform(0, 1); // with a mean
            }
            set_source(problem, b);
            for (int i = 0; i < sample.count(); ++i) {
                if (sample.points[0][i] > 0.8) {
                    problem.fix_at_zero(i);
                    A.row(i).setZero();
                    A(i, i) = 1;
                    b[i] = 0;
                }
            }
            const std::vector<double> guess = this->random.values(sample.count(), -1, 1);
            std::vector<double> p = guess;
            EXPECT_TRUE(problem.solve(p.data()).converged);
            const Eigen::VectorXd expected = A.partialPivLu().solve(b);
            const Eigen::VectorXd found = Eigen::Map<const Eigen::VectorXd>(p.data(), b.size());
            EXPECT_LT((found - expected).norm(), 1e-8 * expected.norm());
            for (int i = 0; i < sample.count(); ++i) {
                EXPECT_TRUE(sample.points[0][i] <= 0.8 || p[i] == 0) << i;
            }
        });
}

TEST(PressurePoissonIterations, DoNotGrowWithTheNumberOfParticlesBelowASurface) {
    const auto iterations_below = [](int n) {
        const Sample<2> sample(n, 0.1, 28, true);
        PressurePoisson<2> problem(options<2>({true, true}, 1e-8));
        write_weights(problem, sample.list, sample.volume(), true);
        set_source(problem, Eigen::VectorXd::Ones(sample.count()));
        for (int i = 0; i < sample.count(); ++i) {
            if (sample.points[1][i] > 1 - sample.dx) {
                problem.fix_at_zero(i);
            }
        }
        std::vector<double> p(sample.count());
        const LinearSolve solve = problem.solve(p.data());
        EXPECT_TRUE(solve.converged);
        return solve.iterations;
    };
    EXPECT_LE(iterations_below(80), 1.3 * iterations_below(20));
}

// A block of fluid in the upper corner of an otherwise empty box: the first cells hold no particle.
TYPED_TEST(PressurePoissonTest, SolvesWhereCellsAreEmpty) {
    constexpr int Dim = TypeParam::value;
    Sample<Dim> block(Dim == 2 ? 20 : 8, 0.1, 24, false);
    block.box.low.fill(-1);
    block.box.high.fill(1.5);
    block.build();
    std::array<int, 2> iterations{};
    for (const bool two_level : {false, true}) {
        const Case c{true, two_level};
        PressurePoisson<Dim> problem(options<Dim>(c, 1e-10));
        write_weights(problem, block.list, std::pow(block.dx, Dim), c.symmetric);
        for (const int i : block.list.grid().order()) {
            ASSERT_NE(block.list.grid().cell_of(i), 0);
        }
        const Eigen::VectorXd exact = smooth_pressure<Dim>(block.points);
        Eigen::VectorXd b(exact.size());
        problem.multiply(exact.data(), b.data());
        set_source(problem, b);
        Eigen::VectorXd p = Eigen::VectorXd::Zero(exact.size());
        const LinearSolve solve = problem.solve(p.data());
        EXPECT_TRUE(solve.converged);
        EXPECT_LT((p - exact).norm(), 1e-7 * exact.norm());
        iterations[two_level ? 1 : 0] = solve.iterations;
    }
    EXPECT_LT(iterations[1], iterations[0]) << "the coarse space is of use";
}

/// Iterations from nothing to 1e-8, summed over three arrangements; the source has waves of all lengths.
template <int Dim>
int iterations(const Case& c, int n) {
    int total = 0;
    for (const std::uint64_t seed : {25U, 26U, 27U}) {
        const Sample<Dim> sample(n, 0.1, seed, true);
        PressurePoisson<Dim> problem(options<Dim>(c, 1e-8));
        write_weights(problem, sample.list, sample.volume(), c.symmetric);
        Random random(seed);
        const Eigen::VectorXd rough = with_zero_mean(random.values(sample.count(), -1, 1));
        set_source(problem, rough + smooth_pressure<Dim>(sample.points));
        std::vector<double> p(sample.count());
        const LinearSolve solve = problem.solve(p.data());
        EXPECT_TRUE(solve.converged);
        total += solve.iterations;
    }
    return total;
}

// The coarse space removes the long waves, whose number of iterations grows in proportion to n under Jacobi
// alone.
TEST(PressurePoissonIterations, DoNotGrowWithTheNumberOfParticlesOnTwoLevels) {
    for (const bool symmetric : {true, false}) {
        const int few = iterations<2>({symmetric, true}, 20);
        const int many = iterations<2>({symmetric, true}, 80);
        EXPECT_LE(many, 1.3 * few) << few << " to " << many;
    }
    EXPECT_LE(iterations<3>({true, true}, 20), 1.3 * iterations<3>({true, true}, 10));
}

TEST(PressurePoissonIterations, GrowWithTheNumberOfParticlesUnderJacobi) {
    const int few = iterations<2>({true, false}, 20);
    const int many = iterations<2>({true, false}, 80);
    EXPECT_GE(many, 2.5 * few) << few << " to " << many;
    EXPECT_LE(many, 5.5 * few) << few << " to " << many;
    EXPECT_GT(many, 2 * iterations<2>({true, true}, 80));
}

} // namespace
} // namespace sphvv::solver
