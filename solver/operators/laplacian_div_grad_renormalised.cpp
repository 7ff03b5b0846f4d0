#include "sphvv/solver/operators.hpp"

namespace sphvv::solver::operators {
namespace {

struct Formula {
    template <int Dim>
    static void apply(const OperatorInput<Dim>& in, std::span<double* const> result) {
        std::array<std::vector<double>, Dim> gradient;
        std::array<double*, Dim> out;
        OperatorInput<Dim> second = in;
        for (int d = 0; d < Dim; ++d) {
            gradient[d].resize(in.size());
            second.field[d] = out[d] = gradient[d].data();
        }
        operators::find("gradient_renormalised").template apply<Dim>(in, out);
        operators::find("divergence_renormalised").template apply<Dim>(second, result);
    }
};

} // namespace

const Operator& laplacian_div_grad_renormalised() {
    static const Operator op = with_formula<Formula>({
        .name = "laplacian_div_grad_renormalised",
        .summary = "divergence of the gradient, both renormalised: blind to a checkerboard",
        .formula = "sum_j V_j (g_j - g_i) . L_i gradW_ij, g = L G- A",
        .source = "Xu 2009 §2.1.2 and §2.1.3",
        .approximates = Approximates::laplacian,
        .claims = {.exact_degree = 1, .sees_checkerboard = false},
        .order = {.noise_power = 1,
                  .transition = true,
                  .truncated = 0,
                  .source = "the noise O(h) p of the renormalised gradient is differentiated once more "
                            "(verification rules §4; Quinlan, Basa & Lastiwka 2006)"},
        .sweeps = 4,
    });
    return op;
}

} // namespace sphvv::solver::operators
