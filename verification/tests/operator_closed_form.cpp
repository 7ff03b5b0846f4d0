// The errors that the operator workbench measures on a lattice, against their closed form.
#include "sphvv/verification/operator_study.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace sphvv::verification {
namespace {

using solver::Operator;
using solver::operators::find;

constexpr double pi = std::numbers::pi;

const solver::Kernel& quintic() {
    return solver::kernels::find("quintic_spline");
}

OperatorStudy study(const Operator& op, const OperatorLadder& ladder) {
    const std::array operators{&op};
    const std::array ladders{ladder};
    return run_operator_studies(operators, ladders, quintic()).at(0);
}

/// C_dim f'(q)/h^(dim+1) of the quintic spline, typed in from Xu 2009 §2.1.1.
double kernel_slope(int dim, double r, double h) {
    const double q = r / h;
    double derivative = 0;
    for (const auto& [edge, factor] : {std::pair{3., 1.}, {2., -6.}, {1., 15.}}) {
        derivative -= q < edge ? 5 * factor * std::pow(edge - q, 4) : 0;
    }
    const double constant = dim == 2 ? 7 / (478 * pi) : 1 / (120 * pi);
    return constant / std::pow(h, dim + 1) * derivative;
}

/// Calls visit(offset, V W'(r)/r) for all lattice offsets within the support.
template <class Visit>
void over_the_lattice(int dim, double dx, double h, const Visit& visit) {
    const int reach = static_cast<int>(std::ceil(3 * h / dx));
    const int reach_z = dim == 3 ? reach : 0;
    for (int x = -reach; x <= reach; ++x) {
        for (int y = -reach; y <= reach; ++y) {
            for (int z = -reach_z; z <= reach_z; ++z) {
                const double r = dx * std::sqrt(x * x + y * y + z * z);
                if (r > 0) {
                    visit(std::array{x * dx, y * dx, z * dx},
                          std::pow(dx, dim) * kernel_slope(dim, r, h) / r);
                }
            }
        }
    }
}

// On a lattice sum_j V A_j F r_ij of A = sin(k.x + c) is, by the symmetry of the support,
// -cos(k.x + c) sum V F r sin(k.r): the exact gradient k cos times a number, the same for every direction
// since all k_a are 2 pi. The Laplacian 2 sum V F (A_i - A_j) is sin times 2 sum V F (1 - cos k.r). So every
// relative norm of the error is |number - 1|.
TEST(OperatorStudies, ReproduceTheErrorInClosedFormOnTheSquareLattice) {
    for (const int dim : {2, 3}) {
        const std::vector<int> n = dim == 2 ? std::vector{16, 23, 40} : std::vector{10, 14};
        const OperatorLadder ladder{dim, Arrangement::square, Path::fixed_ratio, n, 1.5, 1};
        const OperatorStudy gradient = study(find("gradient_plain"), ladder);
        const OperatorStudy laplacian = study(find("laplacian_morris"), ladder);
        for (std::size_t rung = 0; rung < n.size(); ++rung) {
            const double dx = 1.0 / n[rung];
            double first = 0;
            double second = 0;
            over_the_lattice(dim, dx, 1.5 * dx, [&](const std::array<double, 3>& r, double VF) {
                const double kr = 2 * pi * (r[0] + r[1] + r[2]);
                first -= VF * r[0] * std::sin(kr) / (2 * pi);
                second -= 2 * VF * (1 - std::cos(kr)) / (dim * 4 * pi * pi);
            });
            ASSERT_TRUE(gradient.samples[rung].norms && laplacian.samples[rung].norms);
            for (double Norms::*norm : {&Norms::l1, &Norms::l2, &Norms::linf}) {
                EXPECT_NEAR((*gradient.samples[rung].norms).*norm, std::abs(first - 1), 1e-11);
                EXPECT_NEAR((*laplacian.samples[rung].norms).*norm, std::abs(second - 1), 1e-11);
            }
            EXPECT_GT(std::abs(first - 1), 1e-3) << "an error worth the name";
        }
    }
}

} // namespace
} // namespace sphvv::verification
