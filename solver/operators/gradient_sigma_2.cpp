#include "sphvv/solver/operators/gradient_sigma_2.hpp"

#include "sphvv/solver/operators.hpp"

namespace sphvv::solver::operators {
namespace {

struct MassField {
    const double* rho;
    const double* V;
    Lanes operator()(const int* j) const { return gather(rho, j) * gather(V, j); }
};

struct Formula {
    template <int Dim>
    static Vector<Dim> at(const Row<Dim>& row, int i, const OperatorInput<Dim>& in) {
        return gradient_sigma_2<Dim>(row, i, in.field[0], MassField{in.density, in.V}, in.density);
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
