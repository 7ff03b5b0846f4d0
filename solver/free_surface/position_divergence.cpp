#include "sphvv/solver/free_surface.hpp"
#include "sphvv/solver/operators/renormalisation.hpp"

namespace sphvv::solver::free_surface {
namespace {

struct Formula {
    template <int Dim>
    struct Indicator {
        explicit Indicator(const SurfaceInput<Dim>& input) : volume{input.V} {}
        double operator()(const Row<Dim>& row, int /*i*/) const {
            return first_moments<Dim>(row, volume).trace();
        }
        VolumeField volume;
    };
};

/// In three dimensions nothing is printed. On a cubic lattice that ends at a plane (quintic spline, h/dx =
/// 1.3) the rows from the surface on have 1.938, 2.716, 2.987, …: halfway between the first two is 2.33 (the
/// same in two dimensions, 1.216 and 1.742, gives 1.48, the 1.5 in print). It parts the two rows with the
/// quartic and cubic splines too, and for h/dx from 1.2 to 1.5 (1.85 … 2.05 against 2.59 … 2.90).
double threshold(int dim, double /*radius*/) {
    return dim == 2 ? 1.5 : 2.33;
}

} // namespace

const Detector& position_divergence() {
    static const Detector detector = with_indicator<Formula>({
        .name = "position_divergence",
        .summary = "divergence of position, the dimension inside the fluid",
        .formula = "sum_j V_j (r_j - r_i) . gradW_ij < 1.5 (2-D), 2.33 (3-D)",
        .source = "Lee 2008 §1.3; Xu 2009 §6.1",
        .key = "surface_divergence",
        .key_summary = "div r below which a particle is at the free surface",
        .highest_threshold = 3,
        .default_value = "2-D: in print; 3-D: halfway between the first two rows of a flat lattice surface",
        .published = {{2, 1.5, "Lee 2008 §1.3; Xu 2009 §6.1"}},
        .threshold = threshold,
    });
    return detector;
}

} // namespace sphvv::solver::free_surface
