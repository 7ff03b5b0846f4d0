#include "sphvv/solver/operators/shifting_vector.hpp"

#include "sphvv/solver/operators.hpp"

namespace sphvv::solver::operators {
namespace {

struct Formula {
    template <int Dim>
    static Vector<Dim> at(const Row<Dim>& row, int /*i*/, const OperatorInput<Dim>& in) {
        return shifting_vector<Dim>(row, in.neighbours->support_radius());
    }
};

} // namespace

const Operator& shifting_vector() {
    static const Operator op = with_formula<Formula>({
        .name = "shifting_vector",
        .summary = "shifting vector, away from where particles crowd",
        .formula = "sum_j (rbar_i/r_ij)^2 n_ij in 2-D, 0.216 sum_j (rbar_i/r_ij)^3 n_ij in 3-D",
        .source = "Xu 2009 §2.3; power and factor in 3-D: shifting_vector.hpp",
        .approximates = Approximates::nothing,
        .claims = {.vanishes_on_lattices = true},
        .order = {.source = "of an arrangement, not of a field"},
    });
    return op;
}

} // namespace sphvv::solver::operators
