#pragma once

#include "sphvv/solver/operators.hpp"
#include "sphvv/verification/particle_sets.hpp"

#include <numbers>

namespace sphvv::verification {

/// Owns what an operator reads: positions' neighbour list, volumes, density, a test field.
template <int Dim>
struct OperatorScene {
    ParticleSet<Dim> set;
    solver::NeighbourList<Dim> neighbours;
    std::vector<double> density; ///< kg/m^dim
    std::array<std::vector<double>, Dim> field;
    const solver::Kernel* kernel;
    double h;

    OperatorScene(ParticleSet<Dim> particles, const solver::Kernel& smoothing_kernel, double smoothing_length)
        : set(std::move(particles)), kernel(&smoothing_kernel), h(smoothing_length) {
        std::array<const double*, Dim> position;
        for (int d = 0; d < Dim; ++d) {
            position[d] = set.points[d].data();
            field[d].assign(set.size(), 0);
        }
        neighbours.build(set.box, *kernel, h, 0, position, set.size());
        density.assign(set.size(), 1);
    }

    solver::Vector<Dim> point(int i) const {
        solver::Vector<Dim> x;
        for (int d = 0; d < Dim; ++d) {
            x[d] = set.points[d][i];
        }
        return x;
    }

    solver::OperatorInput<Dim> input() const {
        std::array<const double*, Dim> columns;
        for (int d = 0; d < Dim; ++d) {
            columns[d] = field[d].data();
        }
        return {&neighbours, kernel, h, set.volume.data(), density.data(), columns};
    }

    /// The operator's result, one column a component.
    std::vector<std::vector<double>> apply(const solver::Operator& op) const {
        std::vector<std::vector<double>> columns(solver::result_components(op.approximates, Dim),
                                                 std::vector<double>(set.size()));
        std::vector<double*> pointers;
        pointers.reserve(columns.size());
        for (std::vector<double>& column : columns) {
            pointers.push_back(column.data());
        }
        op.template apply<Dim>(input(), pointers);
        return columns;
    }
};

/// Plane wave u sin(k.x + 0.3) (a scalar takes u_0) of one period along every side of the box, and what each
/// kind of operator makes of it.
template <int Dim>
struct PlaneWave {
    solver::Vector<Dim> k;
    solver::Vector<Dim> u;

    explicit PlaneWave(const solver::Box<Dim>& box) {
        constexpr std::array<double, 3> amplitude{1, -0.6, 0.3};
        for (int d = 0; d < Dim; ++d) {
            k[d] = 2 * std::numbers::pi / box.length(d);
            u[d] = amplitude[d];
        }
    }

    double phase(const solver::Vector<Dim>& x) const { return k.dot(x) + 0.3; }

    void fill(OperatorScene<Dim>& scene) const {
        for (int i = 0; i < scene.set.size(); ++i) {
            const double sine = std::sin(phase(scene.point(i)));
            for (int d = 0; d < Dim; ++d) {
                scene.field[d][i] = u[d] * sine;
            }
            scene.density[i] = 1 + 0.1 * std::cos(phase(scene.point(i)));
        }
    }

    /// Exact result at x, components in the operator's order.
    std::vector<double> exact(solver::Approximates kind, const solver::Vector<Dim>& x) const {
        using solver::Approximates;
        const double sine = std::sin(phase(x));
        const double cosine = std::cos(phase(x));
        std::vector<double> result;
        switch (kind) {
        case Approximates::gradient:
            for (int a = 0; a < Dim; ++a) {
                result.push_back(u[0] * k[a] * cosine);
            }
            break;
        case Approximates::divergence:
            result.push_back(u.dot(k) * cosine);
            break;
        case Approximates::laplacian:
            result.push_back(-u[0] * k.squaredNorm() * sine);
            break;
        case Approximates::vector_laplacian:
            for (int a = 0; a < Dim; ++a) {
                result.push_back(-u[a] * k.squaredNorm() * sine);
            }
            break;
        case Approximates::viscous:
            for (int a = 0; a < Dim; ++a) {
                result.push_back(-(u[a] * k.squaredNorm() + 2 * k[a] * k.dot(u)) * sine);
            }
            break;
        case Approximates::vector_gradient:
            for (int a = 0; a < Dim; ++a) {
                for (int b = 0; b < Dim; ++b) {
                    result.push_back(u[a] * k[b] * cosine);
                }
            }
            break;
        case Approximates::strain_rate:
            for (int a = 0; a < Dim; ++a) {
                for (int b = 0; b < Dim; ++b) {
                    result.push_back((u[a] * k[b] + u[b] * k[a]) / 2 * cosine);
                }
            }
            break;
        case Approximates::unity:
            result.push_back(1);
            break;
        case Approximates::dimension:
            result.push_back(Dim);
            break;
        case Approximates::nothing:
            break;
        }
        return result;
    }
};

} // namespace sphvv::verification
