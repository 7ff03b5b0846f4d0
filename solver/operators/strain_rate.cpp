#include "sphvv/solver/operators.hpp"
#include "sphvv/solver/operators/gradient_difference.hpp"
#include "sphvv/solver/operators/renormalisation.hpp"

namespace sphvv::solver::operators {
namespace {

struct Formula {
    template <int Dim>
    static Matrix<Dim> at(const Row<Dim>& row, int i, const OperatorInput<Dim>& in) {
        const auto L = determined_renormalisation<Dim>(row, in.volume());
        if (!L) {
            return undetermined<Matrix<Dim>>();
        }
        const Matrix<Dim> gradient = vector_gradient_difference<Dim>(row, i, in.field, in.volume()) * *L;
        return (gradient + gradient.transpose()) / 2;
    }
};

} // namespace

const Operator& strain_rate() {
    static const Operator op = with_formula<Formula>({
        .name = "strain_rate",
        .summary = "strain rate from the renormalised gradient",
        .formula = "(grad u + grad u^T)/2",
        .source = "Xu 2009 App. B (sub-particle stress); Asai 2012 (Smagorinsky)",
        .approximates = Approximates::strain_rate,
        .claims = {.exact_degree = 1},
        .order = {.noise_power = 0,
                  .transition = true,
                  .truncated = 1,
                  .source =
                      "as the renormalised gradient (verification rules §4; Quinlan, Basa & Lastiwka 2006)"},
        .sweeps = 2,
    });
    return op;
}

} // namespace sphvv::solver::operators
