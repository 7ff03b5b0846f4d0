#include "sphvv/solver/operators.hpp"
#include "sphvv/solver/operators/renormalisation.hpp"

namespace sphvv::solver::operators {
namespace {

struct Formula {
    /// Two sweeps: the neighbours' L_j is needed.
    template <int Dim>
    static void apply(const OperatorInput<Dim>& in, std::span<double* const> result) {
        std::vector<Matrix<Dim>> L(in.size());
        sweep<Dim>(in, [&](int i) {
            L[i] =
                determined_renormalisation<Dim>(in.row(i), in.volume()).value_or(undetermined<Matrix<Dim>>());
        });
        sweep<Dim>(in, result, [&](int i) -> Vector<Dim> {
            const Row<Dim> row = in.row(i);
            Vector<Dim> total = Vector<Dim>::Zero();
            for (int k = 0; k < row.count; ++k) {
                const int j = row.index[k];
                Vector<Dim> gradW;
                for (int d = 0; d < Dim; ++d) {
                    gradW[d] = row.slope[k] * row.separation[d][k];
                }
                total += in.V[j] * (in.field[0][i] * (L[i] * gradW) + in.field[0][j] * (L[j] * gradW));
            }
            return total;
        });
    }
};

} // namespace

const Operator& gradient_renormalised_coherent() {
    static const Operator op = with_formula<Formula>({
        .name = "gradient_renormalised_coherent",
        .summary = "coherent renormalised gradient, pairwise antisymmetric",
        .formula = "sum_j V_j (A_i L_i + A_j L_j) gradW_ij",
        .source = "Oger et al. 2007 (coherent renormalised)",
        .approximates = Approximates::gradient,
        .claims = {.conserves_momentum = true, .adjoint = "divergence_renormalised"},
        .order = {.noise_power = 2,
                  .truncated = -1,
                  .source = "the dual of the renormalised divergence; the zeroth moment is not removed "
                            "(verification rules §4; Quinlan, Basa & Lastiwka 2006)"},
        .sweeps = 2,
    });
    return op;
}

} // namespace sphvv::solver::operators
