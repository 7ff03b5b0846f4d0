#pragma once

#include "sphvv/solver/operators/row.hpp"
#include "sphvv/solver/settings.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sphvv::solver {

/// What a detector of the free surface looks at. Images behind walls and dummy particles are ordinary entries
/// of the list: a particle whose support they fill is no surface particle.
template <int Dim>
struct SurfaceInput {
    const NeighbourList<Dim>* neighbours;
    const double* V;         ///< m^dim, one a particle
    double particle_spacing; ///< m
};

/// Where it writes, one entry a particle.
template <int Dim>
struct SurfaceOutput {
    std::uint8_t* surface;             ///< 1 at the free surface, else 0
    double* indicator = nullptr;       ///< the number that decided it (pure number); null: not wanted
    std::array<double*, Dim> normal{}; ///< unit vector out of the fluid, 0 where none can be told; null: not
                                       ///< wanted; written by the detectors that give one
};

/// A threshold in print.
struct PublishedThreshold {
    int dimension;
    double value;
    std::string_view source;
};

/// Declaration of a detector of the free surface: a number at every particle, and those below a threshold are
/// at the surface. One file in solver/free_surface/ defines one.
struct Detector {
    std::string_view name;
    std::string_view summary;
    std::string_view formula;
    std::string_view source;
    std::string_view key;           ///< setting that holds the threshold
    std::string_view key_summary;   ///< what the threshold is compared with
    double highest_threshold;       ///< that is accepted; the lowest is 0
    std::string_view default_value; ///< where threshold() comes from
    std::vector<PublishedThreshold> published;
    /// The threshold for `dim` dimensions where no other is given; `radius` is the support over the spacing.
    double (*threshold)(int dim, double radius);
    bool gives_normal = false;
    void (*detect2)(const SurfaceInput<2>&, double threshold, const SurfaceOutput<2>&) = nullptr;
    void (*detect3)(const SurfaceInput<3>&, double threshold, const SurfaceOutput<3>&) = nullptr;

    /// surface_i = indicator_i < threshold, in parallel over the particles, with the same bits on any number
    /// of threads. Throws UserError if the support is too small for the threshold (covered_ball).
    template <int Dim>
    void detect(const SurfaceInput<Dim>& input, double limit, const SurfaceOutput<Dim>& output) const {
        if constexpr (Dim == 2) {
            detect2(input, limit, output);
        } else {
            detect3(input, limit, output);
        }
    }

    /// The same with the detector's own threshold.
    template <int Dim>
    void detect(const SurfaceInput<Dim>& input, const SurfaceOutput<Dim>& output) const {
        detect<Dim>(input, threshold(Dim, input.neighbours->support_radius() / input.particle_spacing),
                    output);
    }

    /// The setting of a scheme that uses this detector in `dim` dimensions.
    Key threshold_key(int dim, double radius) const;
};

/// Neighbours of a particle of a square (cubic) lattice that are nearer than `radius` spacings, when the
/// lattice ends at a plane `rows` rows above the particle (0: it is itself in the last row).
int lattice_neighbours(int dim, double radius, int rows);

namespace detail {
template <class Formula, int Dim>
concept ChecksItsThreshold = requires(const SurfaceInput<Dim>& input, double threshold) {
    Formula::check(input, threshold);
};

template <class Indicator, int Dim>
concept GivesNormal = requires(Indicator& indicator, const Row<Dim>& row, int i) {
    { indicator.normal(row, i) } -> std::convertible_to<Vector<Dim>>;
};

template <class Formula, int Dim>
void detect(const SurfaceInput<Dim>& input, double threshold, const SurfaceOutput<Dim>& output) {
    if constexpr (ChecksItsThreshold<Formula, Dim>) {
        Formula::check(input, threshold);
    }
    using Indicator = typename Formula::template Indicator<Dim>;
    const int count = input.neighbours->size();
    const int blocks = input.neighbours->block_count();
#pragma omp parallel
    {
        Indicator indicator(input); // with the scratch space of one thread
#pragma omp for schedule(dynamic, 1)
        for (int b = 0; b < blocks; ++b) {
            const int begin = b * NeighbourList<Dim>::block_size;
            const int end = std::min(count, begin + NeighbourList<Dim>::block_size);
            for (int i = begin; i < end; ++i) {
                const Row<Dim> row = input.neighbours->row(i);
                const double value = indicator(row, i);
                output.surface[i] = value < threshold ? 1 : 0;
                if (output.indicator != nullptr) {
                    output.indicator[i] = value;
                }
                if constexpr (GivesNormal<Indicator, Dim>) {
                    if (output.normal[0] != nullptr) {
                        const Vector<Dim> n = indicator.normal(row, i);
                        for (int d = 0; d < Dim; ++d) {
                            output.normal[d][i] = n[d];
                        }
                    }
                }
            }
        }
    }
}
} // namespace detail

/// Completes a declaration with the formula, a type with a class template
///   template <int Dim> struct Indicator {
///       explicit Indicator(const SurfaceInput<Dim>&);          // one a thread: may own scratch space
///       double operator()(const Row<Dim>&, int i);             // the number at particle i
///       Vector<Dim> normal(const Row<Dim>&, int i) const;      // optional; after the number of the same i
///   };
/// and, optionally, template <int Dim> static void check(const SurfaceInput<Dim>&, double threshold).
template <class Formula>
Detector with_indicator(Detector declaration) {
    declaration.gives_normal = detail::GivesNormal<typename Formula::template Indicator<2>, 2>;
    declaration.detect2 = detail::detect<Formula, 2>;
    declaration.detect3 = detail::detect<Formula, 3>;
    return declaration;
}

namespace free_surface {
/// Every detector in solver/free_surface/, in the order of the file names.
std::span<const Detector* const> all();
/// The detector of that name. Throws UserError naming the accepted ones.
const Detector& find(std::string_view name);
} // namespace free_surface

} // namespace sphvv::solver
