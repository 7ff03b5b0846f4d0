#include "sphvv/solver/operators/gradient_symmetric.hpp"

#include "sphvv/solver/operators.hpp"

namespace sphvv::solver::operators {
namespace {

struct Formula {
    template <int Dim>
    static Vector<Dim> at(const Row<Dim>& row, int i, const OperatorInput<Dim>& in) {
        return gradient_symmetric<Dim>(row, i, in.field[0], in.volume());
    }
};

} // namespace

const Operator& gradient_symmetric() {
    static const Operator op = with_formula<Formula>({
        .name = "gradient_symmetric",
        .summary = "symmetric gradient G+, pairwise antisymmetric",
        .formula = "sum_j V_j (A_i + A_j) gradW_ij",
        .source = "Xu 2009 §2.1.2",
        .approximates = Approximates::gradient,
        .claims = {.conserves_momentum = true, .adjoint = "divergence_difference"},
        .order = {.noise_power = 2,
                  .truncated = -1,
                  .source = "2 A_i sum_j V_j gradW_ij = O(1/h) p (verification rules §4; Quinlan, Basa & "
                            "Lastiwka 2006)"},
    });
    return op;
}

} // namespace sphvv::solver::operators
