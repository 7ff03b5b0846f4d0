#include "sphvv/solver/settings.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace sphvv::solver {

std::string shortest(double value) {
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value);
    return {buffer, end.ptr};
}

double parse_number(std::string_view text, std::string_view what) {
    double value = 0;
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (status != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
        throw UserError(std::string(what) + ": '" + std::string(text) + "' is not a finite number");
    }
    return value;
}

Key Key::number(std::string name, double value, double low, double high, std::string unit,
                std::string summary) {
    return {std::move(name), std::move(summary), std::move(unit), shortest(value), low, high, {}, false};
}

Key Key::integer(std::string name, int value, int low, int high, std::string summary) {
    return {std::move(name), std::move(summary), "1", std::to_string(value),
            double(low),     double(high),       {},  true};
}

Key Key::word(std::string name, std::string value, std::vector<std::string> choices, std::string summary) {
    return {std::move(name), std::move(summary), "", std::move(value), 0, 0, std::move(choices), false};
}

std::string Key::accepted() const {
    if (choices.empty()) {
        return std::string(whole ? "an integer" : "a number") + " from " + shortest(low) + " to " +
               shortest(high);
    }
    std::string list;
    for (const std::string& choice : choices) {
        list += (list.empty() ? "one of " : ", ") + choice;
    }
    return list;
}

Settings::Settings(std::vector<Key> keys, const Assignments& given) : keys_(std::move(keys)) {
    for (const auto& assignment : given) {
        const std::string& name = assignment.first;
        const auto key =
            std::find_if(keys_.begin(), keys_.end(), [&](const Key& k) { return k.name == name; });
        if (key == keys_.end()) {
            std::string accepted;
            for (const Key& k : keys_) {
                accepted.append(accepted.empty() ? "" : ", ").append(k.name);
            }
            throw UserError(
                std::string("there is no key '").append(name).append("'; accepted: ").append(accepted));
        }
        key->value = assignment.second;
    }
    for (Key& key : keys_) {
        const std::string where = "key '" + key.name + "'";
        if (!key.choices.empty()) {
            if (std::find(key.choices.begin(), key.choices.end(), key.value) == key.choices.end()) {
                throw UserError(where + ": '" + key.value + "' is not accepted; give " + key.accepted());
            }
            continue;
        }
        const double value = parse_number(key.value, where);
        if (value < key.low || value > key.high || (key.whole && value != std::floor(value))) {
            throw UserError(where + ": " + key.value + " is not accepted; give " + key.accepted());
        }
        key.value = shortest(value);
        numbers_[key.name] = value;
    }
}

double Settings::number(std::string_view key) const {
    const auto found = numbers_.find(key);
    if (found == numbers_.end()) {
        throw std::logic_error("no number is declared under the key '" + std::string(key) + "'");
    }
    return found->second;
}

const std::string& Settings::word(std::string_view key) const {
    const auto found = std::find_if(keys_.begin(), keys_.end(), [&](const Key& k) { return k.name == key; });
    if (found == keys_.end()) {
        throw std::logic_error("the key '" + std::string(key) + "' is not declared");
    }
    return found->value;
}

bool Settings::has(std::string_view key) const {
    return std::any_of(keys_.begin(), keys_.end(), [&](const Key& k) { return k.name == key; });
}

} // namespace sphvv::solver
