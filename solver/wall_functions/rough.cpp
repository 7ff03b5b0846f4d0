#include "sphvv/solver/wall_functions.hpp"

#include <cmath>

namespace sphvv::solver::wall_functions {
namespace {

LogLaw law(const Settings& settings, double /*nu*/) {
    const double kappa = settings.number("kappa");
    return {.kappa = kappa,
            .rough = settings.number("roughness") * std::exp(-kappa * settings.number("d")),
            .viscous = 0};
}

} // namespace

const WallFunction& rough() {
    static const WallFunction function{
        .name = "rough",
        .summary = "logarithmic law over a fully rough wall, xi u*/nu > 70",
        .formula = "u = u* [ln(z/xi)/kappa + D]",
        .source = "Issa 2005 §5.3",
        .keys = {Key::number("roughness", 0.01, 1e-9, 1e6, "m", "xi, height of the roughness"),
                 Key::number("d", 8.5, 5, 12, "1", "D, constant of the law")},
        .law = law,
    };
    return function;
}

} // namespace sphvv::solver::wall_functions
