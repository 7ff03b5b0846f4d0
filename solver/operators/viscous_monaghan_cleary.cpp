#include "sphvv/solver/operators/viscous_monaghan_cleary.hpp"

#include "sphvv/solver/operators.hpp"

namespace sphvv::solver::operators {
namespace {

struct Formula {
    template <int Dim>
    static Vector<Dim> at(const Row<Dim>& row, int i, const OperatorInput<Dim>& in) {
        return viscous_monaghan_cleary<Dim>(row, i, in.field, in.volume(), 0.0);
    }
};

} // namespace

const Operator& viscous_monaghan_cleary() {
    static const Operator op = with_formula<Formula>({
        .name = "viscous_monaghan_cleary",
        .summary = "Monaghan-Cleary viscous operator, along the line of the pair",
        .formula = "2(dim+2) sum_j V_j (u_ij . r_ij)/r_ij^2 gradW_ij",
        .source =
            "Cleary & Monaghan 1999; Lee 2008 §1.3 (8 in 2-D, 10 in 3-D); limit: Espanol & Revenga 2003",
        .approximates = Approximates::viscous,
        .claims = {.exact_degree = 0, .conserves_momentum = true, .symmetric = true, .nonpositive = true},
        .order = {.noise_power = 2,
                  .truncated = -1,
                  .lattice_floor = true,
                  .source =
                      "as the Morris Laplacian; r_a r_b/r^2 is not smooth at r = 0, so a lattice sum is off "
                      "by (dx/h)^(dim+2) (verification rules §4; Quinlan, Basa & Lastiwka 2006)"},
    });
    return op;
}

} // namespace sphvv::solver::operators
