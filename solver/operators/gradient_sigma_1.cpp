#include "sphvv/solver/operators.hpp"
#include "sphvv/solver/operators/gradient_sigma.hpp"

namespace sphvv::solver::operators {
namespace {

struct Formula {
    template <int Dim>
    static Vector<Dim> at(const Row<Dim>& row, int i, const OperatorInput<Dim>& in) {
        return gradient_sigma<Dim, 1>(row, i, in.field[0], in.density, in.V);
    }
};

} // namespace

const Operator& gradient_sigma_1() {
    static const Operator op = with_formula<Formula>({
        .name = "gradient_sigma_1",
        .summary = "symmetric gradient of the sigma family, sigma = 1",
        .formula = "rho_i sum_j m_j (A_i + A_j)/(rho_i rho_j) gradW_ij",
        .source = "Oger et al. 2007, sigma = 1",
        .approximates = Approximates::gradient,
        .claims = {.conserves_momentum = true},
        .order = {.noise_power = 2,
                  .truncated = -1,
                  .source = "as the symmetric gradient: zeroth moment times the field (verification rules "
                            "§4; Quinlan, Basa & Lastiwka 2006)"},
    });
    return op;
}

} // namespace sphvv::solver::operators
