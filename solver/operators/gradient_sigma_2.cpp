#include "sphvv/solver/operators.hpp"

namespace sphvv::solver::operators {
namespace {

struct Formula {
    template <int Dim>
    static Vector<Dim> at(const Row<Dim>& row, int i, const OperatorInput<Dim>& in) {
        const double* A = in.field[0];
        const double* rho = in.density;
        Vector<Dim> total = Vector<Dim>::Zero();
        for (int k = 0; k < row.count; ++k) {
            const int j = row.index[k];
            const double m = rho[j] * in.V[j];
            const double pair = A[i] / (rho[i] * rho[i]) + A[j] / (rho[j] * rho[j]);
            const double weight = rho[i] * m * pair * row.slope[k];
            for (int d = 0; d < Dim; ++d) {
                total[d] += weight * row.separation[d][k];
            }
        }
        return total;
    }
};

} // namespace

const Operator& gradient_sigma_2() {
    static const Operator op = with_formula<Formula>({
        .name = "gradient_sigma_2",
        .summary = "symmetric gradient of the sigma family, sigma = 2 (sigma = 1 is gradient_symmetric)",
        .formula = "rho_i sum_j m_j (A_i/rho_i^2 + A_j/rho_j^2) gradW_ij",
        .source = "Oger et al. 2007, sigma = 2; Monaghan 1992; Lee 2008 §1.3",
        .approximates = Approximates::gradient,
        .claims = {.conserves_momentum = true, .adjoint = "divergence_sigma_2"},
        .order = {.noise_power = 2,
                  .truncated = -1,
                  .source = "as the symmetric gradient: zeroth moment times the field (verification rules "
                            "§4; Quinlan, Basa & Lastiwka 2006)"},
    });
    return op;
}

} // namespace sphvv::solver::operators
