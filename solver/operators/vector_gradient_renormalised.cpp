#include "sphvv/solver/operators.hpp"
#include "sphvv/solver/operators/gradient_difference.hpp"
#include "sphvv/solver/operators/renormalisation.hpp"

namespace sphvv::solver::operators {
namespace {

struct Formula {
    template <int Dim>
    static Matrix<Dim> at(const Row<Dim>& row, int i, const OperatorInput<Dim>& in) {
        const auto L = determined_renormalisation<Dim>(row, in.volume());
        if (!L) {
            return undetermined<Matrix<Dim>>();
        }
        return vector_gradient_difference<Dim>(row, i, in.field, in.volume()) * *L;
    }
};

} // namespace

const Operator& vector_gradient_renormalised() {
    static const Operator op = with_formula<Formula>({
        .name = "vector_gradient_renormalised",
        .summary = "renormalised gradient of a vector field",
        .formula = "[sum_j V_j (u_j - u_i) (x) gradW_ij] L_i",
        .source = "Xu 2009 §2.1.2",
        .approximates = Approximates::vector_gradient,
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
