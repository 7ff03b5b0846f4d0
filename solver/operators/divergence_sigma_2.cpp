#include "sphvv/solver/operators.hpp"

namespace sphvv::solver::operators {
namespace {

struct Formula {
    template <int Dim>
    static double at(const Row<Dim>& row, int i, const OperatorInput<Dim>& in) {
        double total = 0;
        for (int k = 0; k < row.count; ++k) {
            const int j = row.index[k];
            double along = 0;
            for (int d = 0; d < Dim; ++d) {
                along += (in.field[d][j] - in.field[d][i]) * row.separation[d][k];
            }
            total += in.density[j] * in.V[j] * along * row.slope[k];
        }
        return total / in.density[i];
    }
};

} // namespace

const Operator& divergence_sigma_2() {
    static const Operator op = with_formula<Formula>({
        .name = "divergence_sigma_2",
        .summary = "difference divergence of the sigma family, sigma = 2: that of drho/dt = sum m u_ij.gradW",
        .formula = "1/rho_i sum_j m_j (u_j - u_i) . gradW_ij",
        .source = "Oger et al. 2007, sigma = 2; Monaghan 1992",
        .approximates = Approximates::divergence,
        .claims = {.exact_degree = 0},
        .order = {.noise_power = 1,
                  .truncated = 0,
                  .source =
                      "as the difference gradient (verification rules §4; Quinlan, Basa & Lastiwka 2006)"},
    });
    return op;
}

} // namespace sphvv::solver::operators
