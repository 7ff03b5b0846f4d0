#include "sphvv/solver/operators.hpp"
#include "sphvv/solver/operators/laplacian_morris.hpp"

namespace sphvv::solver::operators {
namespace {

struct Formula {
    template <int Dim>
    static Vector<Dim> at(const Row<Dim>& row, int i, const OperatorInput<Dim>& in) {
        return laplacian_morris<Dim>(row, i, in.field, in.volume(), 0.0);
    }
};

} // namespace

const Operator& viscous_morris() {
    static const Operator op = with_formula<Formula>({
        .name = "viscous_morris",
        .summary = "Morris viscous operator, eta = 0: the Laplacian of every component",
        .formula = "2 sum_j V_j (u_i - u_j) F_ij",
        .source = "Morris et al. 1997; Xu 2009 §2.1.3",
        .approximates = Approximates::vector_laplacian,
        .claims = {.exact_degree = 0, .conserves_momentum = true, .symmetric = true, .nonpositive = true},
        .order = {.noise_power = 2,
                  .truncated = -1,
                  .source = "as its scalar form (verification rules §4; Quinlan, Basa & Lastiwka 2006)"},
    });
    return op;
}

} // namespace sphvv::solver::operators
