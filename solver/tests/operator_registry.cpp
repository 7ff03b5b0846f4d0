// The list of operators: the files of the folder, each declared in full.
#include "sphvv/solver/operators.hpp"
#include "sphvv/solver/settings.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>

namespace sphvv::solver {
namespace {

TEST(Operators, AreTheFilesOfTheFolder) {
    std::vector<std::string> stems;
    for (const auto& entry : std::filesystem::directory_iterator(SPHVV_SOLVER_FOLDER "/operators")) {
        if (entry.path().extension() == ".cpp") {
            stems.push_back(entry.path().stem().string());
        }
    }
    std::ranges::sort(stems);
    std::vector<std::string> names;
    for (const Operator* op : operators::all()) {
        names.emplace_back(op->name);
    }
    EXPECT_FALSE(names.empty());
    EXPECT_EQ(names, stems);
}

TEST(Operators, RefuseAnUnknownNameAndNameTheKnownOnes) {
    for (const char* wrong : {"gradient", "", "gradient_plain ", "Gradient_plain"}) {
        try {
            operators::find(wrong);
            ADD_FAILURE() << "found '" << wrong << "'";
        } catch (const UserError& error) {
            const std::string sentence = error.what();
            EXPECT_NE(sentence.find(std::string("'") + wrong + "'"), std::string::npos) << sentence;
            for (const Operator* op : operators::all()) {
                EXPECT_NE(sentence.find(op->name), std::string::npos) << sentence;
            }
        }
    }
}

class EveryOperator : public testing::TestWithParam<const Operator*> {
protected:
    const Operator& op = *GetParam();
};

INSTANTIATE_TEST_SUITE_P(All, EveryOperator,
                         testing::ValuesIn(operators::all().begin(), operators::all().end()),
                         [](const auto& test) { return std::string(test.param->name); });

TEST_P(EveryOperator, IsFoundByItsName) {
    EXPECT_EQ(&operators::find(op.name), &op);
}

TEST_P(EveryOperator, IsDeclaredInFull) {
    EXPECT_FALSE(op.name.empty());
    EXPECT_FALSE(op.summary.empty());
    EXPECT_FALSE(op.formula.empty());
    EXPECT_FALSE(op.source.empty());
    EXPECT_FALSE(op.order.source.empty());
    EXPECT_NE(op.apply2, nullptr);
    EXPECT_NE(op.apply3, nullptr);
    EXPECT_GE(op.sweeps, 1);
    EXPECT_LE(op.sweeps, 4); // the most here: a composition of two operators, each behind a matrix of its own
    EXPECT_GE(op.claims.exact_degree, -1);
    EXPECT_LE(op.claims.exact_degree, 3);
    EXPECT_GT(op.order.smoothing, 0);
}

TEST(Operators, AreAdjointOnlyAsGradientAndDivergence) {
    int pairs = 0;
    for (const Operator* op : operators::all()) {
        if (!op->claims.adjoint.empty()) {
            ++pairs;
            EXPECT_EQ(op->approximates, Approximates::gradient) << op->name;
            EXPECT_EQ(operators::find(op->claims.adjoint).approximates, Approximates::divergence) << op->name;
        }
    }
    EXPECT_GT(pairs, 0);
}

// Forms that pair a field with a result need as many components in both.
TEST_P(EveryOperator, ClaimsOnlyWhatItsKindCanHave) {
    for (const int dim : {2, 3}) {
        const int field = field_components(op.approximates, dim);
        const int result = result_components(op.approximates, dim);
        EXPECT_GE(result, 1);
        EXPECT_LE(result, dim * dim);
        if (op.claims.symmetric || op.claims.nonpositive || op.claims.dissipates) {
            EXPECT_EQ(field, result);
        }
        if (field == 0) {
            EXPECT_EQ(op.claims.exact_degree, -1) << "there is no field to be exact for";
        }
    }
    if (!op.claims.sees_checkerboard) {
        EXPECT_EQ(op.approximates, Approximates::laplacian);
    }
}

TEST(OperatorKinds, HaveNamesOfTheirOwn) {
    std::set<std::string_view> names;
    for (int kind = 0; kind <= static_cast<int>(Approximates::nothing); ++kind) {
        EXPECT_TRUE(names.insert(to_string(static_cast<Approximates>(kind))).second) << kind;
    }
}

} // namespace
} // namespace sphvv::solver
