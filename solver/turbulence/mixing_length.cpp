#include "sphvv/solver/turbulence/shear_rate.hpp"

#include <algorithm>

namespace sphvv::solver::turbulence {
namespace {

struct Formula {
    Formula(const Settings& settings, double /*smoothing_length*/)
        : kappa(settings.number("kappa")), depth(settings.number("depth")) {}
    double squared_length(double z) const {
        const double share = depth > 0 ? std::max(0., 1 - z / depth) : 1;
        return kappa * kappa * z * z * share;
    }
    double kappa;
    double depth;
};

} // namespace

const TurbulenceModel& mixing_length() {
    static const TurbulenceModel model = with_length<Formula>({
        .name = "mixing_length",
        .summary = "Prandtl's mixing length in a free-surface channel, or near a wall",
        .formula = "nu_T = L^2 S, S = sqrt(2 s_ij s_ij), L = kappa z sqrt(1 - z/H)",
        .source = "Issa 2005 §5.1",
        .reads_wall_distance = true,
        .keys = {Key::number("kappa", 0.41, 0.3, 0.5, "1", "von Kármán's constant"),
                 Key::number("depth", 0, 0, 1e6, "m", "H, wall to surface; 0: L = kappa z")},
        .assemble_2d = nullptr,
        .assemble_3d = nullptr,
    });
    return model;
}

} // namespace sphvv::solver::turbulence
