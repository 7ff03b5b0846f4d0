#include "sphvv/solver/wall_functions.hpp"

#include <cmath>

namespace sphvv::solver::wall_functions {
namespace {

LogLaw law(const Settings& settings, double nu) {
    const double kappa = settings.number("kappa");
    return {.kappa = kappa, .rough = 0, .viscous = nu * std::exp(-kappa * settings.number("b"))};
}

} // namespace

const WallFunction& smooth() {
    static const WallFunction function{
        .name = "smooth",
        .summary = "logarithmic law over a smooth wall; edge at 30 < z+",
        .formula = "u = u* [ln(z u*/nu)/kappa + B]",
        .source = "Issa 2005 §5.3",
        .keys = {Key::number("b", 5.2, 0, 10, "1", "B, constant of the law")},
        .law = law,
    };
    return function;
}

} // namespace sphvv::solver::wall_functions
