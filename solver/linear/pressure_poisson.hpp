#pragma once

#include "sphvv/solver/boundaries/images.hpp"
#include "sphvv/solver/neighbours/neighbour_list.hpp"

#include <Eigen/Core>

#include <memory>
#include <string>
#include <vector>

namespace sphvv::solver {

/// Outcome of one linear solve.
struct LinearSolve {
    int iterations;
    double residual;             ///< |b - A x| / |b|
    bool converged;              ///< to the tolerance, or to the round-off of the product that would tell
    std::int64_t matrix_entries; ///< entries multiplied
    int faulty = -1;             ///< the first particle without an equation to solve; -1: none
    const char* fault = "";      ///< what is wrong with its equation
};

/// The discrete Poisson problem on the particles: sum_j w_ij (p_i - p_j) = b_i, with weights that a Laplacian
/// operator writes into the layout of the neighbour list.
///
/// An image of j beyond a wall has the pressure of j, plus a given difference.
///
/// add_identity() makes it the discrete Helmholtz problem p_i + c sum_j w_ij (p_i - p_j) = b_i, of which
/// p may be a component of a velocity: an image then has plus or minus the value of j, plus a difference.
///
/// The matrix is never copied: products run over the list. Constants are in its null space (no free
/// surface), so the mean of the right-hand side is projected out, and so is the mean of each product where
/// the matrix is not symmetric and its range is another hyperplane; the solution is returned with zero mean.
/// Conjugate gradients for symmetric weights, Bi-CGSTAB otherwise, both Eigen's, started from the given
/// pressure.
template <int Dim>
class PressurePoisson {
public:
    enum class Preconditioner {
        jacobi,
        two_level ///< Jacobi plus an exact solve for one unknown per cell of the neighbour grid
    };

    struct Options {
        double tolerance = 1e-5; ///< on |b - A x| / |b|
        int maximum_iterations = 2000;
        Preconditioner preconditioner = Preconditioner::two_level;
        bool symmetric = true;
    };

    explicit PressurePoisson(Options options);
    ~PressurePoisson();
    PressurePoisson(PressurePoisson&&) noexcept;
    PressurePoisson& operator=(PressurePoisson&&) noexcept;
    PressurePoisson(const PressurePoisson&) = delete;
    PressurePoisson& operator=(const PressurePoisson&) = delete;

    /// Makes room for the pairs of a list; the operator then writes row i's weights to weights(i) and their
    /// sum to diagonal(i).
    void reset(const NeighbourList<Dim>& neighbours, const Images<Dim>& images);
    double* weights(int i) { return weights_.data() + neighbours_->row_start(i); }
    double& diagonal(int i) { return diagonal_[i]; }
    double& source(int i) { return source_[i]; }
    /// A source whose root mean square about the mean is at most this is nothing but round-off, and its
    /// solution is 0. No solver gets from a first guess of another size to a residual that is small against
    /// round-off.
    void set_round_off(double root_mean_square) { round_off_ = root_mean_square; }

    /// Equation i, which has been written as that of Poisson's problem, becomes p_i + c sum_j w_ij (p_i -
    /// p_j) = b_i: the solution is unique. Where the weights are symmetric and nothing lies beyond a wall,
    /// the columns of the matrix sum to 1, and the solution is returned with the mean of b to round-off.
    void add_identity(double c);

    /// An image k has sign_k (1 or -1) times the value of its particle, plus its difference; 1 until told
    /// otherwise.
    void set_image_signs(std::vector<double> sign);

    /// Takes given differences p_k - p_j (with signs, p_k - sign_k p_j) of images k and their particles j
    /// (Pa, image by image) to the sources, of which the equations have been written.
    void set_image_differences(const std::vector<double>& difference);

    /// p_i = 0 takes the place of equation i, which has been written. With one such particle the solution is
    /// unique, and no mean is projected out of anything.
    void fix_at_zero(int i);

    /// Equation i, which has been written, becomes own p_i + sum_j w_ij (p_i - p_j) = 0 with weights that the
    /// caller writes to weights(i): a condition on the pressure, and the solution is unique, as with fixed
    /// ones.
    void set_condition(int i, double own);

    /// Solves for `pressure`, which holds the first guess; where that leads nowhere, from zero. Leaves it as
    /// it is where an equation or the guess is no number, or an equation has no neighbours but a source.
    LinearSolve solve(double* pressure);

    /// y = A x.
    void multiply(const double* x, double* y) const;
    int size() const { return static_cast<int>(diagonal_.size()); }
    std::size_t bytes() const;

private:
    template <class T>
    friend class CellPreconditioner;
    struct CoarseSpace;

    Options options_;
    bool symmetric() const { return options_.symmetric && images_->symmetric() && !has_conditions_; }
    /// Whether constants are in the null space.
    bool singular() const { return fixed_.empty() && !has_conditions_ && !has_identity_; }
    /// Whether the mean of the solution is that of the source.
    bool keeps_mean() const { return has_identity_ && symmetric() && images_->empty() && fixed_.empty(); }
    bool is_fixed(int i) const { return !fixed_.empty() && fixed_[i]; }
    /// The particle whose pressure a neighbour has.
    int unknown_of(int neighbour) const {
        return neighbour < size() ? neighbour : images_->particle(neighbour - size());
    }
    double sign_of(int neighbour) const {
        return neighbour < size() || image_sign_.empty() ? 1 : image_sign_[neighbour - size()];
    }

    const NeighbourList<Dim>* neighbours_ = nullptr;
    const Images<Dim>* images_ = nullptr;
    mutable std::vector<double> with_images_; // x of a product, and its values at the images
    std::vector<double> weights_;
    std::vector<char> fixed_; // empty where none is
    bool has_conditions_ = false;
    bool has_identity_ = false;
    std::vector<double> image_sign_; // empty where all are 1
    bool coarse_is_current_ = false;
    Eigen::VectorXd diagonal_;
    Eigen::VectorXd source_;
    std::unique_ptr<CoarseSpace> coarse_;
    double round_off_ = 0;
};

} // namespace sphvv::solver
