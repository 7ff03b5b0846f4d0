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
        operators::find("gradient_symmetric").template apply<Dim>(in, out);
        operators::find("divergence_difference").template apply<Dim>(second, result);
    }
};

} // namespace

const Operator& laplacian_div_grad() {
    static const Operator op = with_formula<Formula>({
        .name = "laplacian_div_grad",
        .summary = "divergence of the gradient with an adjoint pair: blind to a checkerboard",
        .formula = "D- G+ A",
        .source = "Cummins & Rudman 1999; Xu 2009 §2.1.3 (not used there: checkerboard pressure)",
        .approximates = Approximates::laplacian,
        .claims = {.symmetric = true, .nonpositive = true, .sees_checkerboard = false},
        .order = {.noise_power = 3,
                  .truncated = -2,
                  .source = "the noise O(1/h) p of G+ is differentiated once more (verification rules §4; "
                            "Quinlan, Basa & Lastiwka 2006)"},
        .sweeps = 2,
    });
    return op;
}

} // namespace sphvv::solver::operators
