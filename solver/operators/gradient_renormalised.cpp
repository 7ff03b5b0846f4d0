#include "sphvv/solver/operators.hpp"
#include "sphvv/solver/operators/gradient_difference.hpp"
#include "sphvv/solver/operators/renormalisation.hpp"

namespace sphvv::solver::operators {
namespace {

struct Formula {
    template <int Dim>
    static Vector<Dim> at(const Row<Dim>& row, int i, const OperatorInput<Dim>& in) {
        const auto L = determined_renormalisation<Dim>(row, in.volume());
        if (!L) {
            return undetermined<Vector<Dim>>();
        }
        return *L * gradient_difference<Dim>(row, i, in.field[0], in.volume());
    }
};

} // namespace

const Operator& gradient_renormalised() {
    static const Operator op = with_formula<Formula>({
        .name = "gradient_renormalised",
        .summary = "renormalised difference gradient",
        .formula = "L_i sum_j V_j (A_j - A_i) gradW_ij",
        .source = "Xu 2009 §2.1.2; Oger et al. 2007",
        .approximates = Approximates::gradient,
        .claims = {.exact_degree = 1},
        .order = {.noise_power = 0,
                  .transition = true,
                  .truncated = 1,
                  .source = "exact for linears, so second moments off by O(p) h are left (verification rules "
                            "§4; Quinlan, Basa & Lastiwka 2006)"},
        .sweeps = 2,
    });
    return op;
}

} // namespace sphvv::solver::operators
