#include "sphvv/solver/operators/divergence_difference.hpp"

#include "sphvv/solver/operators.hpp"

namespace sphvv::solver::operators {
namespace {

struct Formula {
    template <int Dim>
    static double at(const Row<Dim>& row, int i, const OperatorInput<Dim>& in) {
        return divergence_difference<Dim>(row, i, in.field, in.volume());
    }
};

} // namespace

const Operator& divergence_difference() {
    static const Operator op = with_formula<Formula>({
        .name = "divergence_difference",
        .summary = "difference divergence",
        .formula = "sum_j V_j (u_j - u_i) . gradW_ij",
        .source = "Xu 2009 §2.1.2; Lee 2008 §1.3",
        .approximates = Approximates::divergence,
        .claims = {.exact_degree = 0},
        .order = {.noise_power = 1,
                  .truncated = 0,
                  .source =
                      "as the difference gradient (verification rules §4; Quinlan, Basa & Lastiwka 2006)"},
    });
    return op;
}

} // namespace sphvv::solver::operators
