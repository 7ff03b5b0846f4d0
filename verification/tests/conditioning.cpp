// Condition numbers against dense linear algebra and matrices that are known, and the verdicts on them.
#include "sphvv/verification/conditioning.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <tuple>

namespace sphvv::verification {
namespace {

constexpr double pi = std::numbers::pi;

ConditioningCheck check_of(double value, double low, double high) {
    ConditioningCheck check{
        .subject = "", .name = "", .value = value, .low = low, .high = high, .why = "theory"};
    judge(check);
    return check;
}

TEST(ConditioningChecks, PassInsideTheirBand) {
    EXPECT_EQ(check_of(1, 1, 2).verdict, "PASS");
    EXPECT_EQ(check_of(2, 1, 2).verdict, "PASS");
    EXPECT_EQ(check_of(1.5, 1, 2).reason, "theory");
    EXPECT_EQ(check_of(2.001, 1, 2).verdict, "FAIL");
    EXPECT_EQ(check_of(0.999, 1, 2).verdict, "FAIL");
    EXPECT_EQ(check_of(std::nan(""), 1, 2).verdict, "FAIL");
    EXPECT_EQ(check_of(INFINITY, 1, INFINITY).verdict, "FAIL");
    ConditioningCheck judged = check_of(1.5, 1, 2);
    judged.value = 3;
    judge(judged);
    EXPECT_EQ(judged.verdict, "PASS") << "a verdict stays";
}

TEST(ConditioningChecks, ThatDoNotPassAreInTheStatusAndTheDocument) {
    std::vector<ConditioningResults> results(1);
    results[0].study = "synthetic";
    results[0].checks = {check_of(1, 1, 2)};
    EXPECT_EQ(exit_status(results), 0);
    for (const char* verdict : {"FAIL", "INCONCLUSIVE"}) {
        results[0].checks = {check_of(1, 1, 2), check_of(std::nan(""), 1, 2)};
        results[0].checks[1].verdict = verdict;
        EXPECT_EQ(exit_status(results), 1);
    }
    nlohmann::ordered_json document;
    add_to_document(results, document);
    EXPECT_TRUE(document["conditioning_checks"][0]["passes"]);
    EXPECT_FALSE(document["conditioning_checks"][1]["passes"]);
    EXPECT_TRUE(document["conditioning_checks"][1]["value"].is_null());
}

// A study of a matrix that cannot be, a column without a row, and of those beside it.
TEST(ConditioningStudies, GoOnAfterAMatrixThatFails) {
    const ConditioningStudy study{.name = "synthetic",
                                  .tier = Tier::quick,
                                  .summary = "",
                                  .cost = 1,
                                  .ladder = {12},
                                  .disordered = {12},
                                  .side = 12,
                                  .depths = {0, 4}};
    const ConditioningResults results = run_conditioning(study);
    int thrown = 0; // the ladders of one rung are FAILs for another reason
    for (const ConditioningCheck& check : results.checks) {
        thrown += check.reason.starts_with("thrown: ") ? 1 : 0;
    }
    EXPECT_EQ(thrown, 1);
    const auto is_column = [](const Conditioning& row) {
        return row.problem.boundary == PressureBoundary::surface && row.problem.rows == 4;
    };
    EXPECT_TRUE(std::ranges::any_of(results.rows, is_column));
    EXPECT_EQ(exit_status(std::vector{results}), 1);
    // The lattice and its 10 % of jitter are of two ladders each, but one matrix. Periodic: the lattice and
    // six jitters of five seeds; Schwaiger's likewise; five with a pair at one place; a column; three between
    // walls.
    using Matrix = std::tuple<PressureBoundary, int, int, double, std::uint64_t, bool, bool, double>;
    std::set<Matrix> matrices;
    for (const Conditioning& row : results.rows) {
        const PressureProblem& p = row.problem;
        matrices.emplace(p.boundary, p.columns, p.rows, p.jitter, p.seed, p.schwaiger, p.coincident, p.mean);
    }
    EXPECT_EQ(results.rows.size(), (1U + 6 * 5) * 2 + 5 + 1 + 3);
    EXPECT_EQ(matrices.size(), results.rows.size());
}

// The nearest neighbours alone would give 2 (1 - cos k dx)/dx^2; the kernel's lattice sum is held against
// the solver's matrix by every row of the study. Here: what the theory owes by itself.
TEST(LatticeTheory, HasTheLimitsOfTheLaplacian) {
    for (const auto& [boundary, k] :
         {std::pair{PressureBoundary::periodic, 2 * pi}, {PressureBoundary::closed, pi}}) {
        const LatticeTheory theory = lattice_theory(boundary, 80, 80);
        EXPECT_NEAR(theory.matrix.least, k * k, 0.005 * k * k);
        EXPECT_LE(theory.jacobi.greatest, 2);
        EXPECT_NEAR(theory.jacobi.condition(), theory.matrix.condition(), 1e-9 * theory.matrix.condition())
            << "the diagonal of a lattice is the same everywhere";
    }
    // A mirror box has the even waves of a periodic one of twice the side: a quarter of the particles of it,
    // spacing for spacing (lengths are in units of the side: 4 times the eigenvalue).
    const LatticeTheory closed = lattice_theory(PressureBoundary::closed, 20, 20);
    const LatticeTheory twice = lattice_theory(PressureBoundary::periodic, 40, 40);
    EXPECT_NEAR(4 * closed.matrix.least, twice.matrix.least, 1e-9 * twice.matrix.least);
    // A column of 1 m: (pi/2H)^2.
    const LatticeTheory column = lattice_theory(PressureBoundary::surface, 80, 80);
    EXPECT_NEAR(column.matrix.least, pi * pi / 4, 0.01 * pi * pi / 4);
}

// Each kind of boundary against Eigen's dense solver, of weights written down from F itself.
TEST(Conditioning, AgreesWithADenseSolver) {
    constexpr int n = 12;
    constexpr double dx = 1. / n;
    for (const auto boundary :
         {PressureBoundary::periodic, PressureBoundary::closed, PressureBoundary::surface}) {
        const auto& kernel = solver::kernels::find("quintic_spline");
        const bool periodic = boundary == PressureBoundary::periodic;
        const bool closed = boundary == PressureBoundary::closed;
        const int free = boundary == PressureBoundary::surface ? n * (n - 1) : n * n;
        Eigen::MatrixXd A = Eigen::MatrixXd::Zero(free, free);
        Eigen::VectorXd D = Eigen::VectorXd::Zero(free);
        // A coordinate of the j-th place and of what it is seen as across sides.
        const auto seen = [](int j, bool wraps, bool low, bool high) {
            std::vector<double> places{j + 0.5};
            if (wraps) {
                places.insert(places.end(), {j + 0.5 - n, j + 0.5 + n});
            }
            if (low) {
                places.push_back(-j - 0.5);
            }
            if (high) {
                places.push_back(2 * n - j - 0.5);
            }
            return places;
        };
        for (int i = 0; i < free; ++i) {
            const int column_of_i = i % n;
            const int row_of_i = i / n;
            for (int j = 0; j < n * n; ++j) {
                const int row = j / n;
                for (const double x : seen(j % n, !closed, closed, closed)) {
                    for (const double y : seen(row, periodic, !periodic, closed)) {
                        const double r = dx * std::hypot(x - column_of_i - 0.5, y - row_of_i - 0.5);
                        if (r < 1e-9) {
                            continue;
                        }
                        const double w = -2 * dx * dx * kernel.slope(2, r, 1.3 * dx);
                        D[i] += w;
                        if (j < free) {
                            A(i, j) -= w;
                        }
                    }
                }
            }
        }
        A.diagonal() += D;
        const Eigen::VectorXd root = D.cwiseSqrt().cwiseInverse();
        const int first = boundary == PressureBoundary::surface ? 0 : 1; // after the constants
        const auto condition = [&](const Eigen::MatrixXd& matrix) {
            const Eigen::VectorXd values =
                Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
            return values[free - 1] / values[first];
        };
        const Conditioning found = measure_conditioning({.boundary = boundary, .columns = n, .rows = n});
        EXPECT_EQ(found.unknowns, free);
        const double expected = condition(A);
        EXPECT_NEAR(found.matrix.condition(), expected, 1e-4 * expected) << to_string(boundary);
        EXPECT_NEAR(found.theory, expected, 1e-9 * expected) << to_string(boundary);
        const double scaled = condition(root.asDiagonal() * A * root.asDiagonal());
        EXPECT_NEAR(found.condition_jacobi, scaled, 1e-4 * scaled) << to_string(boundary);
        EXPECT_NEAR(found.theory_jacobi, scaled, 1e-9 * scaled) << to_string(boundary);
    }
}

// The singular values of a matrix that is not symmetric but in name: Schwaiger's is Morris's times a number
// on a lattice, and its field of values then begins at the least of them.
TEST(Conditioning, OfSchwaigersMatrixIsThatOfMorrissOnALattice) {
    const Conditioning morris = measure_conditioning({.columns = 12, .rows = 12});
    const Conditioning schwaiger = measure_conditioning({.columns = 12, .rows = 12, .schwaiger = true});
    EXPECT_NEAR(schwaiger.matrix.condition(), morris.matrix.condition(), 1e-4 * morris.matrix.condition());
    EXPECT_NEAR(schwaiger.least_of_field, schwaiger.matrix.least, 1e-9 * schwaiger.matrix.greatest);
    const Conditioning disordered =
        measure_conditioning({.columns = 12, .rows = 12, .jitter = 4, .schwaiger = true});
    EXPECT_GT(disordered.negative_share, 0);
    EXPECT_LT(disordered.least_of_field, disordered.matrix.greatest);
    EXPECT_TRUE(std::isnan(disordered.theory));
}

// kappa = 100, D constant, 1e-6: 5 ln(2 10/1e-6) = 5 * 16.811 = 84.06.
TEST(ConjugateGradientBound, IsThatOfTheFormula) {
    EXPECT_EQ(conjugate_gradient_bound(100, 1, 1e-6), 85);
    EXPECT_EQ(conjugate_gradient_bound(100, 100, 1e-6), 96); // 5 (16.811 + ln 10) = 95.57
    EXPECT_EQ(conjugate_gradient_bound(1, 1, 2), 0);
}

TEST(ConditioningStudies, HaveNamesOfTheirOwnAndLaddersThatDecide) {
    std::set<std::string> names;
    for (const ConditioningStudy& study : conditioning_studies()) {
        EXPECT_TRUE(names.insert(study.name).second);
        EXPECT_GE(study.ladder.size(), 4U);
        EXPECT_GE(study.disordered.size(), 4U);
    }
}

} // namespace
} // namespace sphvv::verification
