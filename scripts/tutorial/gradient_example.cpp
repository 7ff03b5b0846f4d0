#include "sphvv/solver/operators.hpp"

namespace sphvv::solver::operators {
namespace {

struct Formula {
    template <int Dim>
    static Vector<Dim> at(const Row<Dim>& row, int i, const OperatorInput<Dim>& in) {
        Vector<Dim> total = Vector<Dim>::Zero();
        for (int k = 0; k < row.count; ++k) {
            const int j = row.index[k];
            const double m = in.density[j] * in.V[j];
            const double weight = m * (in.field[0][j] - in.field[0][i]) * row.slope[k];
            for (int d = 0; d < Dim; ++d) {
                total[d] += weight * row.separation[d][k]; // slope times separation is gradW_ij
            }
        }
        return total / in.density[i];
    }
};

} // namespace

const Operator& gradient_example() {
    static const Operator op = with_formula<Formula>({
        .name = "gradient_example",
        .summary = "difference gradient weighted by mass",
        .formula = "1/rho_i sum_j m_j (A_j - A_i) gradW_ij",
        .source = "Monaghan 1992; Xu 2009 §2.1.2, general form with alpha = rho, n = 1",
        .approximates = Approximates::gradient,
        .claims = {.exact_degree = 0},
        .order = {.noise_power = 1,
                  .truncated = 0,
                  .source = "as the difference gradient: the zeroth moment has no part in it, the first is "
                            "off by O(p) (Quinlan, Basa & Lastiwka 2006)"},
    });
    return op;
}

} // namespace sphvv::solver::operators
