#include "sphvv/solver/operators/laplacian_schwaiger.hpp"

#include "sphvv/solver/operators.hpp"

namespace sphvv::solver::operators {
namespace {

struct Formula {
    template <int Dim>
    static double at(const Row<Dim>& row, int i, const OperatorInput<Dim>& in) {
        const auto L = determined_renormalisation<Dim>(row, in.volume());
        if (!L) {
            return undetermined<double>();
        }
        return laplacian_schwaiger_scalar<Dim>(row, i, in.field[0], in.volume(), *L);
    }
};

} // namespace

const Operator& laplacian_schwaiger() {
    static const Operator op = with_formula<Formula>({
        .name = "laplacian_schwaiger",
        .summary = "Schwaiger's Laplacian LS, corrected form",
        .formula =
            "(tr L_i/dim) {2 sum_j V_j (A_i - A_j) F_ij - 2 (L_i G- A)_i . S_i}, S_i = sum_j V_j gradW_ij",
        .source = "Schwaiger 2008; Xu sheet §1.4",
        .approximates = Approximates::laplacian,
        .claims = {.exact_degree = 1},
        .order = {.noise_power = 1,
                  .truncated = 0,
                  .source = "exact for linears, second moments off by O(p) (verification rules §4; Quinlan, "
                            "Basa & Lastiwka 2006)"},
        .sweeps = 4,
    });
    return op;
}

} // namespace sphvv::solver::operators
