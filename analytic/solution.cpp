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
