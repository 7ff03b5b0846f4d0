#include "sphvv/solver/operators/gradient_difference.hpp"

#include "sphvv/solver/operators.hpp"

namespace sphvv::solver::operators {
namespace {

struct Formula {
    template <int Dim>
    static Vector<Dim> at(const Row<Dim>& row, int i, const OperatorInput<Dim>& in) {
        return gradient_difference<Dim>(row, i, in.field[0], in.volume());
    }
};

} // namespace

const Operator& gradient_difference() {
    static const Operator op = with_formula<Formula>({
        .name = "gradient_difference",
        .summary = "difference gradient G-",
        .formula = "sum_j V_j (A_j - A_i) gradW_ij",
        .source = "Xu 2009 §2.1.2",
        .approximates = Approximates::gradient,
        .claims = {.exact_degree = 0, .adjoint = "divergence_symmetric"},
        .order = {.noise_power = 1,
                  .truncated = 0,
                  .source = "the zeroth moment has no part in it, the first is off by O(p) (verification "
                            "rules §4; Quinlan, Basa & Lastiwka 2006)"},
    });
    return op;
}

} // namespace sphvv::solver::operators
