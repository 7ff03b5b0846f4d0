#include "sphvv/solver/linear/pressure_poisson.hpp"

#include "sphvv/solver/lanes.hpp"
#include "sphvv/solver/simulation.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace sphvv::solver {
namespace {

void remove_mean(double* x, int count) {
    const double mean = deterministic_sum(count, [&](int i) { return x[i]; }) / count;
    for (int i = 0; i < count; ++i) {
        x[i] -= mean;
    }
}

} // namespace

template <int Dim>
class PairMatrix;
} // namespace sphvv::solver

namespace Eigen::internal {
// Lets Eigen's iterative solvers take the matrix-free operator (Eigen documentation, "Matrix-free solvers").
template <int Dim>
struct traits<sphvv::solver::PairMatrix<Dim>> : traits<SparseMatrix<double>> {};
} // namespace Eigen::internal

namespace sphvv::solver {

/// The operator A of PressurePoisson in the form that Eigen's solvers take.
template <int Dim>
class PairMatrix : public Eigen::EigenBase<PairMatrix<Dim>> {
public:
    using Scalar = double;
    using RealScalar = double;
    using StorageIndex = int;
    enum { ColsAtCompileTime = Eigen::Dynamic, MaxColsAtCompileTime = Eigen::Dynamic, IsRowMajor = false };

    explicit PairMatrix(const PressurePoisson<Dim>& discrete) : problem(discrete) {}
    Eigen::Index rows() const { return problem.size(); }
    Eigen::Index cols() const { return problem.size(); }
    template <class Rhs>
    Eigen::Product<PairMatrix, Rhs, Eigen::AliasFreeProduct>
    operator*(const Eigen::MatrixBase<Rhs>& x) const {
        return {*this, x.derived()};
    }

    const PressurePoisson<Dim>& problem;
};

} // namespace sphvv::solver

namespace Eigen::internal {
template <int Dim, class Rhs>
struct generic_product_impl<sphvv::solver::PairMatrix<Dim>, Rhs, SparseShape, DenseShape, GemvProduct>
    : generic_product_impl_base<
          sphvv::solver::PairMatrix<Dim>, Rhs,
          generic_product_impl<sphvv::solver::PairMatrix<Dim>, Rhs, SparseShape, DenseShape>> {
    template <class Destination>
    static void scaleAndAddTo(Destination& y, const sphvv::solver::PairMatrix<Dim>& A, const Rhs& x,
                              double alpha) {
        const Ref<const VectorXd> source(x);
        VectorXd product(source.size());
        A.problem.multiply(source.data(), product.data());
        y += alpha * product;
    }
};
} // namespace Eigen::internal

namespace sphvv::solver {

/// Galerkin restriction of the matrix to vectors that are constant on each cell of the neighbour grid. Cells
/// are as wide as the support, so a cell couples to its neighbours only and the coarse matrix stays sparse.
template <int Dim>
struct PressurePoisson<Dim>::CoarseSpace {
    Eigen::SparseMatrix<double> matrix;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor;
    Eigen::VectorXd restricted;
    Eigen::VectorXd solution;
    int pinned_cell = 0;

    void compute(const PressurePoisson& problem);
    void add_correction(const PressurePoisson& problem, const double* residual, double* z);
};

template <int Dim>
void PressurePoisson<Dim>::CoarseSpace::compute(const PressurePoisson& problem) {
    const NeighbourList<Dim>& neighbours = *problem.neighbours_;
    const CellGrid<Dim>& grid = neighbours.grid();
    const int cells = grid.cell_count();
    std::vector<int> members; // particles cell by cell
    std::ranges::copy_if(grid.order(), std::back_inserter(members),
                         [&](int i) { return i < problem.size() && !problem.is_fixed(i); });
    std::vector<int> first(cells + 1, 0);
    for (const int i : members) {
        ++first[grid.cell_of(i) + 1];
    }
    for (int c = 0; c < cells; ++c) {
        first[c + 1] += first[c];
    }
    std::vector<std::vector<std::pair<int, double>>> rows(cells);
#pragma omp parallel
    {
        std::vector<double> sums(cells, 0.0);
        std::vector<char> touched(cells, 0);
        std::vector<int> touched_cells;
#pragma omp for schedule(dynamic, 8)
        for (int c = 0; c < cells; ++c) {
            const auto touch = [&](int other) {
                if (!touched[other]) {
                    touched[other] = 1;
                    touched_cells.push_back(other);
                }
            };
            touch(c);
            for (int m = first[c]; m < first[c + 1]; ++m) {
                const int i = members[m];
                const auto row = neighbours.row(i);
                const double* w = problem.weights_.data() + neighbours.row_start(i);
                sums[c] += problem.diagonal_[i];
                for (int k = 0; k < row.count; ++k) {
                    const int j = problem.unknown_of(row.index[k]);
                    if (problem.is_fixed(j)) {
                        continue;
                    }
                    const int other = grid.cell_of(j);
                    touch(other);
                    sums[other] -= w[k] * problem.sign_of(row.index[k]);
                }
            }
            std::sort(touched_cells.begin(), touched_cells.end());
            for (const int other : touched_cells) {
                rows[c].emplace_back(other, sums[other]);
                sums[other] = 0;
                touched[other] = 0;
            }
            touched_cells.clear();
        }
    }
    pinned_cell = problem.singular() ? grid.cell_of(members[0]) : -1;
    std::vector<Eigen::Triplet<double>> entries;
    for (int c = 0; c < cells; ++c) {
        const bool empty = first[c] == first[c + 1];
        for (const auto& [other, value] : rows[c]) {
            // Constants are in the null space: the value of the first cell that holds a particle is pinned to
            // make the matrix definite, which shifts the correction by a constant only. An empty cell has no
            // equation.
            const bool pinned = c == pinned_cell || other == pinned_cell;
            if (c == other) {
                entries.emplace_back(c, c, pinned || empty ? 1.0 : value);
            } else if (!pinned) {
                entries.emplace_back(c, other, value);
            }
        }
    }
    matrix.resize(cells, cells);
    matrix.setFromTriplets(entries.begin(), entries.end());
    factor.compute(matrix);
    restricted.resize(cells);
}

template <int Dim>
void PressurePoisson<Dim>::CoarseSpace::add_correction(const PressurePoisson& problem, const double* residual,
                                                       double* z) {
    const CellGrid<Dim>& grid = problem.neighbours_->grid();
    restricted.setZero();
    for (int i = 0; i < problem.size(); ++i) {
        restricted[grid.cell_of(i)] += residual[i]; // of a fixed pressure: 0
    }
    if (pinned_cell >= 0) {
        restricted[pinned_cell] = 0;
    }
    solution = factor.solve(restricted);
    for (int i = 0; i < problem.size(); ++i) {
        z[i] += problem.is_fixed(i) ? 0 : solution[grid.cell_of(i)];
    }
}

/// z = D^-1 r, plus the coarse correction where there is a coarse space.
template <class Problem>
class CellPreconditioner {
public:
    using StorageIndex = int;
    CellPreconditioner() = default;

    template <class Matrix>
    CellPreconditioner& analyzePattern(const Matrix&) {
        return *this;
    }
    template <class Matrix>
    CellPreconditioner& factorize(const Matrix& A) {
        problem_ = &A.problem;
        return *this;
    }
    template <class Matrix>
    CellPreconditioner& compute(const Matrix& A) {
        return factorize(A);
    }
    template <class Rhs>
    Eigen::VectorXd solve(const Rhs& residual) const {
        const Eigen::Ref<const Eigen::VectorXd> r(residual);
        Eigen::VectorXd z = r.cwiseQuotient(problem_->diagonal_);
        if (problem_->coarse_) {
            problem_->coarse_->add_correction(*problem_, r.data(), z.data());
        }
        return z;
    }
    Eigen::ComputationInfo info() const { return Eigen::Success; }

private:
    const Problem* problem_ = nullptr;
};

template <int Dim>
PressurePoisson<Dim>::PressurePoisson(Options options) : options_(options) {
    if (options_.preconditioner == Preconditioner::two_level) {
        coarse_ = std::make_unique<CoarseSpace>();
    }
}
template <int Dim>
PressurePoisson<Dim>::~PressurePoisson() = default;
template <int Dim>
PressurePoisson<Dim>::PressurePoisson(PressurePoisson&&) noexcept = default;
template <int Dim>
PressurePoisson<Dim>& PressurePoisson<Dim>::operator=(PressurePoisson&&) noexcept = default;

template <int Dim>
void PressurePoisson<Dim>::reset(const NeighbourList<Dim>& neighbours, const Images<Dim>& images) {
    neighbours_ = &neighbours;
    images_ = &images;
    weights_.resize(neighbours.entries());
    diagonal_.resize(neighbours.size());
    source_.resize(neighbours.size());
    fixed_.clear();
    has_conditions_ = false;
    has_identity_ = false;
    image_sign_.clear();
    coarse_is_current_ = false;
}

template <int Dim>
void PressurePoisson<Dim>::add_identity(double c) {
    for_each_row(*neighbours_, [&](int i, const auto& row) {
        for (int k = 0; k < row.padded; ++k) {
            weights(i)[k] *= c;
        }
        diagonal_[i] = 1 + c * diagonal_[i];
    });
    has_identity_ = true;
    coarse_is_current_ = false;
}

template <int Dim>
void PressurePoisson<Dim>::set_image_signs(std::vector<double> sign) {
    coarse_is_current_ = coarse_is_current_ && sign == image_sign_;
    image_sign_ = std::move(sign);
}

template <int Dim>
void PressurePoisson<Dim>::set_image_differences(const std::vector<double>& difference) {
    for_each_row(*neighbours_, [&](int i, const auto& row) {
        double total = 0;
        for (int k = 0; k < row.count; ++k) {
            total += row.index[k] < size() ? 0 : weights(i)[k] * difference[row.index[k] - size()];
        }
        source_[i] += total;
    });
}

template <int Dim>
void PressurePoisson<Dim>::fix_at_zero(int i) {
    fixed_.resize(size());
    fixed_[i] = 1;
    const auto row = neighbours_->row(i);
    std::fill(weights(i), weights(i) + row.padded, 0.0);
    diagonal_[i] = 1;
    source_[i] = 0;
    coarse_is_current_ = false;
}

template <int Dim>
void PressurePoisson<Dim>::set_condition(int i, double own) {
    const auto row = neighbours_->row(i);
    double total = own;
    for (int k = 0; k < row.count; ++k) {
        total += weights(i)[k];
    }
    diagonal_[i] = total;
    source_[i] = 0;
    has_conditions_ = true;
    coarse_is_current_ = false;
}

template <int Dim>
void PressurePoisson<Dim>::multiply(const double* x, double* y) const {
    if (!images_->empty()) {
        with_images_.assign(x, x + size());
        with_images_.resize(size() + images_->size());
        images_->fill(with_images_.data(), size());
        for (std::size_t k = 0; k < image_sign_.size(); ++k) {
            with_images_[size() + k] *= image_sign_[k];
        }
        x = with_images_.data();
    }
    for_each_row(*neighbours_, [&](int i, const auto& row) {
        const double* w = weights_.data() + neighbours_->row_start(i);
        Lanes total{};
        for (int k = 0; k < row.padded; k += lane_count) {
            total += load(w + k) * gather(x, row.index + k);
        }
        y[i] = diagonal_[i] * x[i] - sum(total);
    });
    if (!symmetric() && singular()) {
        remove_mean(y, size());
    }
}

template <int Dim>
LinearSolve PressurePoisson<Dim>::solve(double* pressure) {
    // Eigen's own vectors are aligned alike in every run; how it sums over foreign memory depends on the
    // address.
    Eigen::VectorXd p = Eigen::Map<const Eigen::VectorXd>(pressure, size());
    // Told before it spreads to all others.
    int alone = -1;
    for (int i = 0; i < size(); ++i) {
        const char* fault = !std::isfinite(source_[i])     ? "source not finite"
                            : !std::isfinite(diagonal_[i]) ? "equation not finite"
                            : !std::isfinite(p[i])         ? "first guess not finite"
                                                           : nullptr;
        if (fault != nullptr) {
            return {0, std::numeric_limits<double>::quiet_NaN(), false, 0, i, fault};
        }
        alone = alone < 0 && diagonal_[i] == 0 ? i : alone;
    }
    if (singular()) {
        remove_mean(source_.data(), size());
    }
    // A fixed pressure that starts at zero stays there: its equation has no residual, and no other changes
    // it. So the columns of fixed pressures are never used, and what is left of a symmetric matrix is
    // symmetric.
    for (int i = 0; i < size() && !fixed_.empty(); ++i) {
        p[i] = is_fixed(i) ? 0 : p[i];
    }
    LinearSolve result{0, 0, true, 0};
    if (source_.norm() <= round_off_ * std::sqrt(size())) {
        std::fill(pressure, pressure + size(), 0.0);
        return result;
    }
    if (alone >= 0) {
        return {0, 1, false, 0, alone, "equation without neighbours"};
    }
    if (coarse_ && !coarse_is_current_) {
        coarse_->compute(*this);
        coarse_is_current_ = true;
    }
    const PairMatrix<Dim> matrix(*this);
    // The rounding error of a product is eps |A| |x| or less. Weights are positive but for few, so that |A|
    // is about twice the largest diagonal.
    const double unit = std::numeric_limits<double>::epsilon() * 2 * diagonal_.cwiseAbs().maxCoeff();
    const double aim = options_.tolerance * source_.norm();
    const auto run = [&](auto&& solver, int products_per_iteration) {
        solver.setTolerance(options_.tolerance);
        solver.setMaxIterations(options_.maximum_iterations);
        solver.compute(matrix);
        const Eigen::VectorXd guess = p;
        p = solver.solveWithGuess(source_, guess);
        const auto iterations = static_cast<int>(solver.iterations());
        result.iterations += iterations;
        result.residual = solver.error();
        result.converged = solver.info() == Eigen::Success;
        int products = 1 + products_per_iteration * iterations;
        // The solvers carry the residual along; what they lose of it is of the size of the largest vector on
        // their way (Greenbaum 1997). On that of conjugate gradients it is the guess or the solution, on that
        // of Bi-CGSTAB it may be any.
        const double lost = (1 + iterations) * unit * (guess.norm() + p.norm());
        if (result.converged && iterations > 0 && (!symmetric() || lost > aim)) {
            Eigen::VectorXd solution = p;
            if (singular()) {
                remove_mean(solution.data(), size()); // it may be far larger, and is no part of it
            }
            Eigen::VectorXd product(size());
            multiply(solution.data(), product.data());
            ++products;
            const double residual = (source_ - product).norm();
            result.residual = residual / source_.norm();
            // No solver gets below the error of the product that tells.
            result.converged = residual <= aim + (1 + iterations) * unit * solution.norm();
        }
        result.matrix_entries += (neighbours_->pairs() + size()) * std::int64_t{products};
    };
    using Conditioner = CellPreconditioner<PressurePoisson>;
    const auto run_from_guess = [&] {
        if (symmetric()) {
            run(Eigen::ConjugateGradient<PairMatrix<Dim>, Eigen::Lower | Eigen::Upper, Conditioner>(), 1);
        } else {
            run(Eigen::BiCGSTAB<PairMatrix<Dim>, Conditioner>(), 2);
        }
    };
    const auto start_from_zero = [&] {
        p.setZero();
        if (singular()) {
            remove_mean(source_.data(), size()); // what rounding left of a mean much larger than the rest
        }
    };
    // A guess so large that its own rounding drowns the tolerance is of no use.
    constexpr double beyond_doubt = 10; // times that bound, which rounding at random stays well below
    if (unit * p.norm() > beyond_doubt * aim) {
        start_from_zero();
    }
    const bool from_nothing = p.isZero(0);
    run_from_guess();
    if (!result.converged && !from_nothing) {
        start_from_zero(); // the residual of a guess far larger than the solution ends at its round-off
        run_from_guess();
    }
    if (singular()) {
        remove_mean(p.data(), size());
    } else if (keeps_mean()) {
        p.array() += deterministic_sum(size(), [&](int i) { return source_[i] - p[i]; }) / size();
    }
    std::copy(p.begin(), p.end(), pressure);
    return result;
}

template <int Dim>
std::size_t PressurePoisson<Dim>::bytes() const {
    return weights_.capacity() * sizeof(double) + 2 * diagonal_.size() * sizeof(double);
}

template class PressurePoisson<2>;
template class PressurePoisson<3>;

} // namespace sphvv::solver
