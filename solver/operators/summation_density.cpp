#include "sphvv/solver/operators/summation_density.hpp"

#include "sphvv/solver/operators.hpp"

namespace sphvv::solver::operators {
namespace {

struct Formula {
    template <int Dim>
    static double at(const Row<Dim>& row, int i, const OperatorInput<Dim>& in) {
        return summation_density<Dim>(row, *in.kernel, in.h, in.volume(), in.V[i]);
    }
};

} // namespace

const Operator& summation_density() {
    static const Operator op = with_formula<Formula>({
        .name = "summation_density",
        .summary = "sum of the kernel over all particles, the particle itself included",
        .formula = "sum_j V_j W_ij",
        .source = "Gingold & Monaghan 1977; Asai 2012 (particle density)",
        .approximates = Approximates::unity,
        .claims = {},
        .order = {.noise_power = 1,
                  .truncated = 0,
                  .source = "W has the size of h^-dim, the noise that of its first differences (verification "
                            "rules §4; Quinlan, Basa & Lastiwka 2006)"},
    });
    return op;
}

} // namespace sphvv::solver::operators
