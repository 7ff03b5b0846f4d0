#include "sphvv/analytic/solution.hpp"

#include "sphvv/analytic/solutions.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>

namespace sphvv::analytic {
namespace {

/// Shortest text that reads back as the same number, so that no rejected value prints as an accepted one.
std::string exact_text(double value) {
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

/// "re in [0.001, 1e+08]", with the unit where there is one.
std::string accepted(const Parameter& parameter) {
    std::string text(parameter.name);
    text += " in [" + exact_text(parameter.low) + ", " + exact_text(parameter.high) + "]";
    if (parameter.unit != "1") {
        text.append(" ").append(parameter.unit);
    }
    return text;
}

std::string accepted_keys(const Solution& solution) {
    std::string text;
    for (const Parameter& parameter : solution.parameters) {
        text += (text.empty() ? "" : ", ") + accepted(parameter);
    }
    return text.empty() ? "none" : text;
}

} // namespace

Values resolve(const Solution& solution, const Values& given) {
    Values values;
    for (const Parameter& parameter : solution.parameters) {
        values.emplace(parameter.name, parameter.value);
    }
    for (const auto& [key, value] : given) {
        const auto parameter = std::ranges::find(solution.parameters, key, &Parameter::name);
        if (parameter == solution.parameters.end()) {
            throw std::invalid_argument("The exact solution " + std::string(solution.name) +
                                        " has no parameter \"" + key +
                                        "\"; accepted: " + accepted_keys(solution) + ".");
        }
        const bool inside = parameter->low <= value && value <= parameter->high; // false for NaN
        if (!inside) {
            throw std::invalid_argument("The exact solution " + std::string(solution.name) + " cannot take " +
                                        key + " = " + exact_text(value) +
                                        "; accepted: " + accepted(*parameter) + ".");
        }
        values[key] = value;
    }
    return values;
}

std::string_view to_string(Equations equations) {
    switch (equations) {
    case Equations::navier_stokes:
        return "Navier-Stokes";
    case Equations::reynolds_averaged:
        return "Reynolds-averaged";
    case Equations::hydrostatic:
        return "hydrostatic";
    case Equations::impulsive:
        break;
    }
    return "impulsive";
}

Boundary flat_boundary(std::string_view name, BoundaryKind kind, const Domain& domain, Face face,
                       const Vector& velocity) {
    const double plane = face.high ? domain.high[face.direction] : domain.low[face.direction];
    return {name, kind,
            [face, plane](const Vector& x) {
                const double ahead = x[face.direction] - plane;
                return face.high ? -ahead : ahead;
            },
            [velocity](const Vector&, double) { return velocity; }, face};
}

std::vector<Boundary> boundaries(const Solution& solution, const Values& values) {
    return solution.boundaries != nullptr ? solution.boundaries(values) : std::vector<Boundary>{};
}

bool has_quantity(const Solution& solution, std::string_view name) {
    return std::ranges::find(solution.quantities, name, &Quantity::name) != solution.quantities.end();
}

Scalar quantity(const Solution& solution, std::string_view name, const Values& values) {
    std::string names;
    for (const Quantity& candidate : solution.quantities) {
        if (candidate.name == name) {
            return candidate.bind(values);
        }
        names.append(names.empty() ? "" : ", ").append(candidate.name);
    }
    throw std::invalid_argument("The exact solution " + std::string(solution.name) + " has no quantity \"" +
                                std::string(name) + "\"; accepted: " + (names.empty() ? "none" : names) +
                                ".");
}

Vector body_force(const Solution& solution, const Values& values, double t) {
    return solution.body_force != nullptr ? solution.body_force(values, t)
                                          : solution.medium(values).body_force;
}

double density(const State& state, const Medium& medium) {
    return state.density.value_or(medium.density);
}

namespace solutions {

const Solution& find(std::string_view name) {
    std::string names;
    for (const Solution* solution : all()) {
        if (solution->name == name) {
            return *solution;
        }
        names.append(names.empty() ? "" : ", ").append(solution->name);
    }
    throw std::invalid_argument("There is no exact solution \"" + std::string(name) +
                                "\"; accepted: " + names + ".");
}

} // namespace solutions
} // namespace sphvv::analytic
