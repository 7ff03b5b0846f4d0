#include "sphvv/solver/operators.hpp"
#include "sphvv/solver/operators/renormalisation.hpp"

namespace sphvv::solver::operators {
namespace {

struct Formula {
    template <int Dim>
    static double at(const Row<Dim>& row, int /*i*/, const OperatorInput<Dim>& in) {
        return first_moments<Dim>(row, in.volume()).trace();
    }
};

} // namespace

const Operator& position_divergence() {
    static const Operator op = with_formula<Formula>({
        .name = "position_divergence",
        .summary = "divergence of position, the free-surface detector",
        .formula = "sum_j V_j (r_j - r_i) . gradW_ij",
        .source = "Xu 2009 §6.1; Lee 2008 §1.3",
        .approximates = Approximates::dimension,
        .claims = {},
        .order = {.noise_power = 1,
                  .truncated = 0,
                  .source = "r^2 F has the size of h^-dim, as the summation density (verification rules §4; "
                            "Quinlan, Basa & Lastiwka 2006)"},
    });
    return op;
}

} // namespace sphvv::solver::operators
