#pragma once

#include "sphvv/solver/operators/row.hpp"

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace sphvv::solver {

/// What an operator forms of its test field, and so what it is held against.
enum class Approximates {
    gradient,         ///< scalar A: grad A
    divergence,       ///< vector u: div u
    laplacian,        ///< scalar A: div grad A
    vector_laplacian, ///< vector u: div grad u
    viscous,          ///< vector u: div grad u + 2 grad div u
    vector_gradient,  ///< vector u: du_a/dx_b, row by row
    strain_rate,      ///< vector u: (du_a/dx_b + du_b/dx_a)/2, row by row
    unity,            ///< no field: 1
    dimension,        ///< no field: div r, the dimension
    nothing,          ///< no continuous limit: only its properties are studied
};

/// "gradient", "divergence", …
std::string_view to_string(Approximates kind);
/// Components of the test field (0, 1 or dim) and of the result (1, dim or dim^2).
int field_components(Approximates kind, int dim);
int result_components(Approximates kind, int dim);

/// What an operator is evaluated on. All arrays have one entry a particle.
template <int Dim>
struct OperatorInput {
    const NeighbourList<Dim>* neighbours;
    const Kernel* kernel;
    double h;                             ///< m
    const double* V;                      ///< m^dim
    const double* density;                ///< kg/m^dim
    std::array<const double*, Dim> field; ///< the test field; a scalar is component 0

    Row<Dim> row(int i) const { return neighbours->row(i); }
    VolumeField volume() const { return {V}; }
    int size() const { return neighbours->size(); }
};

/// The value of a row whose neighbours do not determine the operator (a singular moment matrix): not a
/// number in every component, which a study counts and never divides by.
template <class Value>
Value undetermined() {
    if constexpr (std::is_same_v<Value, double>) {
        return std::numeric_limits<double>::quiet_NaN();
    } else {
        return Value::Constant(std::numeric_limits<double>::quiet_NaN());
    }
}

/// The quadrature noise of sums over irregular neighbours, p dx^(1+d/2) h^(-power-d/2) for displacements p dx
/// (Quinlan, Basa & Lastiwka 2006; project rules of evidence §4), is what most expected orders follow from.
struct OrderModel {
    double smoothing = 2;    ///< error ~ h^smoothing where sums are as good as integrals
    double noise_power = 0;  ///< `power` above
    bool transition = false; ///< on irregular particles the smoothing error still shows on affordable ladders
    double truncated = 0;    ///< order at fixed h/dx at a free edge or corner
    bool lattice_floor =
        false; ///< not smooth at r = 0: a lattice sum at h/dx = 2 already shows its quadrature error
    std::string_view source; ///< derivation or citation
};

/// What an operator claims besides its order; every claim is checked.
struct OperatorClaims {
    int exact_degree = -1; ///< polynomials of up to this degree are exact on any arrangement; -1: none
    bool conserves_momentum = false; ///< sum_i V_i O_i = 0 for any field
    std::string_view adjoint{};      ///< the divergence D with sum V A (D u) = - sum V u . O A, periodic box
    bool symmetric = false;          ///< sum V B O A = sum V A O B
    bool nonpositive = false;        ///< sum V A O A <= 0
    bool dissipates = false;         ///< sum V u . O u <= 0, and O u = 0 for rigid motion
    /// Artificial viscosity: where all pairs approach, O u = alpha h c/(2(dim+2)) (div grad u + 2 grad div
    /// u), c = 1 m/s (the sum of Monaghan & Cleary); 0: none.
    double alpha = 0;
    bool sees_checkerboard =
        true; ///< Laplacians: a field of alternating sign on the lattice is not in the null space
    bool vanishes_on_lattices = false; ///< O = 0 where every neighbour has its mirror image
};

/// Declaration of a discrete operator. One file in solver/operators/ defines one.
struct Operator {
    std::string_view name;
    std::string_view summary;
    std::string_view formula;
    std::string_view source;
    Approximates approximates;
    OperatorClaims claims;
    OrderModel order;
    int sweeps = 1;       ///< passes over all pairs, those that prepare others included
    bool chained = false; ///< set by with_formula: other particles' results are read, two supports away
    void (*apply2)(const OperatorInput<2>&, std::span<double* const> result) = nullptr;
    void (*apply3)(const OperatorInput<3>&, std::span<double* const> result) = nullptr;

    /// Evaluates the operator at all particles; one array a component of the result.
    template <int Dim>
    void apply(const OperatorInput<Dim>& input, std::span<double* const> result) const {
        if constexpr (Dim == 2) {
            apply2(input, result);
        } else {
            apply3(input, result);
        }
    }
};

namespace detail {
inline void store(double value, int i, std::span<double* const> result) {
    result[0][i] = value;
}
template <class Derived>
void store(const Eigen::MatrixBase<Derived>& value, int i, std::span<double* const> result) {
    for (int a = 0, c = 0; a < value.rows(); ++a) {
        for (int b = 0; b < value.cols(); ++b, ++c) {
            result[c][i] = value(a, b);
        }
    }
}
} // namespace detail

/// at(i) at every particle, in parallel over the blocks of the neighbour list.
template <int Dim, class At>
void sweep(const OperatorInput<Dim>& input, const At& at) {
    const int count = input.size();
#pragma omp parallel for schedule(dynamic, 1)
    for (int begin = 0; begin < count; begin += NeighbourList<Dim>::block_size) {
        const int end = std::min(count, begin + NeighbourList<Dim>::block_size);
        for (int i = begin; i < end; ++i) {
            at(i);
        }
    }
}

/// One sweep: result_i = at(i).
template <int Dim, class At>
void sweep(const OperatorInput<Dim>& input, std::span<double* const> result, const At& at) {
    sweep<Dim>(input, [&](int i) { detail::store(at(i), i, result); });
}

namespace detail {
template <class Formula, int Dim>
concept AppliesItself = requires(const OperatorInput<Dim>& input, std::span<double* const> result) {
    Formula::template apply<Dim>(input, result);
};

template <class Formula, int Dim>
void apply(const OperatorInput<Dim>& input, std::span<double* const> result) {
    if constexpr (AppliesItself<Formula, Dim>) {
        Formula::template apply<Dim>(input, result);
    } else {
        sweep<Dim>(input, result, [&](int i) { return Formula::template at<Dim>(input.row(i), i, input); });
    }
}
} // namespace detail

/// Completes a declaration with the formula, a type with
///   template <int Dim> static VALUE at(const Row<Dim>&, int i, const OperatorInput<Dim>&)
/// for one sweep (VALUE double, Vector<Dim> or Matrix<Dim>), or, for more than one sweep,
///   template <int Dim> static void apply(const OperatorInput<Dim>&, std::span<double* const> result).
template <class Formula>
Operator with_formula(Operator declaration) {
    declaration.chained = detail::AppliesItself<Formula, 2>;
    declaration.apply2 = detail::apply<Formula, 2>;
    declaration.apply3 = detail::apply<Formula, 3>;
    return declaration;
}

namespace operators {
/// Every operator in solver/operators/, in the order of the file names.
std::span<const Operator* const> all();
/// The operator of that name. Throws UserError naming the accepted ones.
const Operator& find(std::string_view name);
} // namespace operators

} // namespace sphvv::solver
