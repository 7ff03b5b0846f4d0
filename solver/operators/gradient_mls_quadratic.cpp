#include "sphvv/solver/operators.hpp"
#include "sphvv/solver/operators/moving_least_squares.hpp"

namespace sphvv::solver::operators {
namespace {

struct Formula {
    template <int Dim>
    static Vector<Dim> at(const Row<Dim>& row, int i, const OperatorInput<Dim>& in) {
        return gradient_mls<Dim, 2>(row, i, in.field[0], in.h);
    }
};

} // namespace

const Operator& gradient_mls_quadratic() {
    static const Operator op = with_formula<Formula>({
        .name = "gradient_mls_quadratic",
        .summary = "gradient by moving least squares, quadratic polynomials",
        .formula = "gradient at i of the polynomial p through A_i that minimises sum_j (-F_ij) (A_j - p_j)^2",
        .source = "Lancaster & Salkauskas 1981; Dilts 1999",
        .approximates = Approximates::gradient,
        .claims = {.exact_degree = 2},
        .order = {.smoothing = 2,
                  .noise_power = -1,
                  .truncated = 2,
                  .source =
                      "Taylor: the first term left out is of degree 3, over h; even degrees cancel on a "
                      "symmetric support"},
    });
    return op;
}

} // namespace sphvv::solver::operators
