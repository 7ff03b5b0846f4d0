#include "sphvv/solver/operators.hpp"
#include "sphvv/solver/operators/moving_least_squares.hpp"

namespace sphvv::solver::operators {
namespace {

struct Formula {
    template <int Dim>
    static Vector<Dim> at(const Row<Dim>& row, int i, const OperatorInput<Dim>& in) {
        return gradient_mls<Dim, 3>(row, i, in.field[0], in.h);
    }
};

} // namespace

const Operator& gradient_mls_cubic() {
    static const Operator op = with_formula<Formula>({
        .name = "gradient_mls_cubic",
        .summary = "gradient by moving least squares, cubic polynomials",
        .formula = "gradient at i of the polynomial p through A_i that minimises sum_j (-F_ij) (A_j - p_j)^2",
        .source = "Lancaster & Salkauskas 1981; Dilts 1999",
        .approximates = Approximates::gradient,
        .claims = {.exact_degree = 3},
        .order = {.smoothing = 4,
                  .noise_power = -2,
                  .transition = true,
                  .truncated = 3,
                  .source =
                      "Taylor: the first term left out is of degree 4, over h; even degrees cancel on a "
                      "symmetric support"},
    });
    return op;
}

} // namespace sphvv::solver::operators
