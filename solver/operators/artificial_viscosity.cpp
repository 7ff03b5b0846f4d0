#include "sphvv/solver/operators.hpp"

namespace sphvv::solver::operators {
namespace {

struct Formula {
    static constexpr double alpha = 1;
    static constexpr double speed_of_sound = 1;

    template <int Dim>
    static Vector<Dim> at(const Row<Dim>& row, int i, const OperatorInput<Dim>& in) {
        Vector<Dim> total = Vector<Dim>::Zero();
        for (int k = 0; k < row.count; ++k) {
            const int j = row.index[k];
            double r2 = 0;
            double along = 0;
            for (int d = 0; d < Dim; ++d) {
                const double r = row.separation[d][k];
                r2 += r * r;
                along += r * (in.field[d][i] - in.field[d][j]);
            }
            if (along >= 0) {
                continue; // receding
            }
            const double mean_density = (in.density[i] + in.density[j]) / 2;
            const double Pi =
                -alpha * in.h * speed_of_sound / mean_density * along / (r2 + 0.01 * in.h * in.h);
            const double m = in.density[j] * in.V[j];
            for (int d = 0; d < Dim; ++d) {
                total[d] -= m * Pi * row.slope[k] * row.separation[d][k];
            }
        }
        return in.density[i] * total; // a force per volume, so that sum V O is the momentum
    }
};

} // namespace

const Operator& artificial_viscosity() {
    static const Operator op = with_formula<Formula>({
        .name = "artificial_viscosity",
        .summary = "artificial viscosity between approaching particles, alpha = 1, speed of sound 1 m/s",
        .formula =
            "-rho_i sum_j m_j Pi_ij gradW_ij, Pi_ij = -alpha h c/rho_ij u_ij.r_ij/(r_ij^2 + 0.01 h^2) if < 0",
        .source = "Monaghan 1992; Oger et al. 2007; Xu 2009 App. A",
        .approximates = Approximates::nothing,
        .claims = {.conserves_momentum = true, .dissipates = true, .alpha = 1},
        .order = {.source = "switched pair by pair: a limit only where all pairs approach, that of the "
                            "Monaghan-Cleary sum (Espanol & Revenga 2003)"},
    });
    return op;
}

} // namespace sphvv::solver::operators
