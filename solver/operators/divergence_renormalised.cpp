#include "sphvv/solver/operators.hpp"
#include "sphvv/solver/operators/gradient_difference.hpp"
#include "sphvv/solver/operators/renormalisation.hpp"

namespace sphvv::solver::operators {
namespace {

struct Formula {
    template <int Dim>
    static double at(const Row<Dim>& row, int i, const OperatorInput<Dim>& in) {
        const auto L = determined_renormalisation<Dim>(row, in.volume());
        if (!L) {
            return undetermined<double>();
        }
        return (vector_gradient_difference<Dim>(row, i, in.field, in.volume()) * *L).trace();
    }
};

} // namespace

const Operator& divergence_renormalised() {
    static const Operator op = with_formula<Formula>({
        .name = "divergence_renormalised",
        .summary = "renormalised difference divergence",
        .formula = "sum_j V_j (u_j - u_i) . L_i gradW_ij",
        .source = "Xu 2009 §2.1.2; Oger et al. 2007",
        .approximates = Approximates::divergence,
        .claims = {.exact_degree = 1},
        .order = {.noise_power = 0,
                  .transition = true,
                  .truncated = 1,
                  .source =
                      "as the renormalised gradient (verification rules §4; Quinlan, Basa & Lastiwka 2006)"},
        .sweeps = 2,
    });
    return op;
}

} // namespace sphvv::solver::operators
