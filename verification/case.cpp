#include "sphvv/analytic/solutions.hpp"
#include "sphvv/verification/cases.hpp"

#include <algorithm>

namespace sphvv::verification {

using solver::Key;

std::string_view to_string(Tier tier) {
    switch (tier) {
    case Tier::quick:
        return "quick";
    case Tier::nightly:
        return "nightly";
    case Tier::full:
        break;
    }
    return "full";
}

std::vector<Key> case_keys(const Case& c) {
    const analytic::Solution& solution = analytic::solutions::find(c.solution);
    std::vector<Key> keys;
    for (const analytic::Parameter& p : solution.parameters) {
        keys.push_back(Key::number(std::string(p.name), p.value, p.low, p.high, std::string(p.unit),
                                   std::string(p.summary)));
    }
    keys.push_back(Key::number("end_time", c.end_time, 1e-9, 1e9, "s", "time at which errors are taken"));
    keys.push_back(Key::word("arrangement", "lattice", {"lattice", "jittered", "settled"},
                             "particles at the start; jittered and settled (a jittered tile relaxed by "
                             "shifts, repeated) run five seeds per rung"));
    keys.push_back(
        Key::number("jitter", 0.1, 0, 0.5, "1", "largest displacement of a jittered start over dx"));
    keys.push_back(
        Key::number("maximum_energy", 1.1, 1, 1e9, "1",
                    "a run whose kinetic energy exceeds its start value by this factor has gained "
                    "energy that nothing supplies: the flow is not driven, and elastic energy is of "
                    "the order (U/c0)^2 = 1 %"));
    keys.push_back(Key::number(
        "minimum_spacing", 0.25, 0, 1, "1",
        "a run in which two particles come closer than this times dx has lost its arrangement: a strain "
        "that squeezes the lattice to dx/4 stretches it to 4 dx, the reach of the kernels (3.9 dx for the "
        "quintic spline), where a particle sees no neighbour that way"));
    return keys;
}

bool applies(std::span<const Condition> conditions, const solver::Settings& of_case,
             const solver::Settings& of_scheme) {
    return std::all_of(conditions.begin(), conditions.end(), [&](const Condition& condition) {
        const solver::Settings& settings = of_scheme.has(condition.key) ? of_scheme : of_case;
        if (!condition.word.empty()) {
            return settings.word(condition.key) == condition.word;
        }
        const double value = settings.number(condition.key);
        return value >= condition.low && value <= condition.high;
    });
}

const Expectation* find_expectation(const Case& c, std::string_view scheme, std::string_view field,
                                    const solver::Settings& of_case, const solver::Settings& of_scheme) {
    for (const Expectation& expectation : c.expectations) {
        if (expectation.scheme == scheme && (expectation.field.empty() || expectation.field == field) &&
            applies(expectation.where, of_case, of_scheme)) {
            return &expectation;
        }
    }
    return nullptr;
}

namespace cases {
const Case& find(std::string_view name) {
    return solver::find_by_name(all(), name, "case");
}
} // namespace cases

} // namespace sphvv::verification
