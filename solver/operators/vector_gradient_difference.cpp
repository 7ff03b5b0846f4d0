#include "sphvv/solver/operators.hpp"
#include "sphvv/solver/operators/gradient_difference.hpp"

namespace sphvv::solver::operators {
namespace {

struct Formula {
    template <int Dim>
    static Matrix<Dim> at(const Row<Dim>& row, int i, const OperatorInput<Dim>& in) {
        return vector_gradient_difference<Dim>(row, i, in.field, in.volume());
    }
};

} // namespace

const Operator& vector_gradient_difference() {
    static const Operator op = with_formula<Formula>({
        .name = "vector_gradient_difference",
        .summary = "difference gradient of a vector field",
        .formula = "sum_j V_j (u_j - u_i) (x) gradW_ij",
        .source = "Xu 2009 §2.1.2",
        .approximates = Approximates::vector_gradient,
        .claims = {.exact_degree = 0},
        .order = {.noise_power = 1,
                  .truncated = 0,
                  .source =
                      "as the difference gradient (verification rules §4; Quinlan, Basa & Lastiwka 2006)"},
    });
    return op;
}

} // namespace sphvv::solver::operators
