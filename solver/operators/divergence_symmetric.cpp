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
                along += (in.field[d][i] + in.field[d][j]) * row.separation[d][k];
            }
            total += in.V[j] * row.slope[k] * along;
        }
        return total;
    }
};

} // namespace

const Operator& divergence_symmetric() {
    static const Operator op = with_formula<Formula>({
        .name = "divergence_symmetric",
        .summary = "symmetric divergence, dual of the difference gradient",
        .formula = "sum_j V_j (u_i + u_j) . gradW_ij",
        .source = "Xu 2009 §2.1.2",
        .approximates = Approximates::divergence,
        .claims = {.conserves_momentum = true},
        .order = {.noise_power = 2,
                  .truncated = -1,
                  .source =
                      "as the symmetric gradient (verification rules §4; Quinlan, Basa & Lastiwka 2006)"},
    });
    return op;
}

} // namespace sphvv::solver::operators
