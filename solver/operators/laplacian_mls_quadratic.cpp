#include "sphvv/solver/operators.hpp"
#include "sphvv/solver/operators/moving_least_squares.hpp"

namespace sphvv::solver::operators {
namespace {

struct Formula {
    template <int Dim>
    static double at(const Row<Dim>& row, int i, const OperatorInput<Dim>& in) {
        return laplacian_mls<Dim, 2>(row, i, in.field[0], in.h);
    }
};

} // namespace

const Operator& laplacian_mls_quadratic() {
    static const Operator op = with_formula<Formula>({
        .name = "laplacian_mls_quadratic",
        .summary = "Laplacian by moving least squares, quadratic polynomials",
        .formula =
            "Laplacian at i of the polynomial p through A_i that minimises sum_j (-F_ij) (A_j - p_j)^2",
        .source = "Lancaster & Salkauskas 1981; Dilts 1999",
        .approximates = Approximates::laplacian,
        .claims = {.exact_degree = 2},
        .order = {.noise_power = 0,
                  .transition = true,
                  .truncated = 1,
                  .source =
                      "Taylor: the first term left out is of degree 3, over h^2; odd degrees cancel on a "
                      "symmetric support"},
    });
    return op;
}

} // namespace sphvv::solver::operators
