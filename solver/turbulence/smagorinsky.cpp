#include "sphvv/solver/turbulence/shear_rate.hpp"

namespace sphvv::solver::turbulence {
namespace {

struct Formula {
    Formula(const Settings& settings, double smoothing_length)
        : length(settings.number("smagorinsky") * settings.number("filter_over_h") * smoothing_length) {}
    double squared_length(double /*z*/) const { return length * length; }
    double length;
};

} // namespace

const TurbulenceModel& smagorinsky() {
    static const TurbulenceModel model = with_length<Formula>({
        .name = "smagorinsky",
        .summary = "Smagorinsky's subgrid viscosity, without damping at walls",
        .formula = "nu_T = (C_S Delta)^2 S, S = sqrt(2 s_ij s_ij)",
        .source = "Issa 2005 §5.2",
        .reads_wall_distance = false,
        .keys = {Key::number("smagorinsky", 0.1, 0.01, 1, "1", "C_S"),
                 Key::number("filter_over_h", 2, 0.1, 10, "1", "width Delta of the filter over h")},
        .assemble_2d = nullptr,
        .assemble_3d = nullptr,
    });
    return model;
}

} // namespace sphvv::solver::turbulence
