#include "sphvv/solver/operators/laplacian_morris.hpp"

#include "sphvv/solver/operators.hpp"

namespace sphvv::solver::operators {
namespace {

struct Formula {
    template <int Dim>
    static double at(const Row<Dim>& row, int i, const OperatorInput<Dim>& in) {
        return laplacian_morris_scalar<Dim>(row, i, in.field[0], in.volume(), 0.0);
    }
};

} // namespace

const Operator& laplacian_morris() {
    static const Operator op = with_formula<Formula>({
        .name = "laplacian_morris",
        .summary = "Morris-type Laplacian LM, eta = 0",
        .formula = "2 sum_j V_j (A_i - A_j) F_ij",
        .source = "Morris et al. 1997; Xu 2009 §2.1.3",
        .approximates = Approximates::laplacian,
        .claims = {.exact_degree = 0, .conserves_momentum = true, .symmetric = true, .nonpositive = true},
        .order = {.noise_power = 2,
                  .truncated = -1,
                  .source = "2 grad A . sum_j V_j r_ij F_ij = O(1/h) p (verification rules §4; Quinlan, Basa "
                            "& Lastiwka 2006)"},
    });
    return op;
}

} // namespace sphvv::solver::operators
