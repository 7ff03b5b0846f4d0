#pragma once

#include "sphvv/solver/error.hpp"

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sphvv::solver {

/// A parameter that can be set by name: a number in a closed interval, or one of a list of words.
struct Key {
    std::string name;
    std::string summary;
    std::string unit;  ///< SI unit, "1" for a pure number, "" for a word
    std::string value; ///< used where the caller sets none
    double low = 0;
    double high = 0;
    std::vector<std::string> choices; ///< empty for a number

    static Key number(std::string name, double value, double low, double high, std::string unit,
                      std::string summary);
    static Key integer(std::string name, int value, int low, int high, std::string summary);
    static Key word(std::string name, std::string value, std::vector<std::string> choices,
                    std::string summary);
    /// What is accepted, in words: "a number from 0 to 1", "one of a, b".
    std::string accepted() const;

    bool whole = false; ///< the number must be an integer
};

/// Text given for keys by the user or a study record.
using Assignments = std::map<std::string, std::string, std::less<>>;

/// Values for a list of keys, checked against what each accepts.
class Settings {
public:
    Settings() = default;
    /// Throws UserError for an unknown key, a value outside what its key accepts, or text that is no number.
    Settings(std::vector<Key> keys, const Assignments& given);

    double number(std::string_view key) const;
    int integer(std::string_view key) const { return static_cast<int>(number(key)); }
    const std::string& word(std::string_view key) const;
    bool has(std::string_view key) const;
    const std::vector<Key>& keys() const { return keys_; }
    /// The text of a value, as it goes into provenance.
    const std::string& text(std::string_view key) const { return word(key); }

private:
    std::vector<Key> keys_; // with value = the resolved text
    std::map<std::string, double, std::less<>> numbers_;
};

/// The number that the whole of `text` spells; throws UserError naming `what`.
double parse_number(std::string_view text, std::string_view what);

/// The text with the fewest digits that reads back as the same double.
std::string shortest(double value);

/// The entries' names, separated by commas.
template <class Entries>
std::string names_of(const Entries& entries) {
    std::string names;
    for (const auto* entry : entries) {
        names += (names.empty() ? "" : ", ") + std::string(entry->name);
    }
    return names;
}

/// The entry of that name in a registry. Throws UserError naming the accepted ones.
template <class Entries>
const auto& find_by_name(const Entries& entries, std::string_view name, std::string_view kind) {
    for (const auto* entry : entries) {
        if (entry->name == name) {
            return *entry;
        }
    }
    throw UserError("there is no " + std::string(kind) + " '" + std::string(name) +
                    "'; accepted: " + names_of(entries));
}

} // namespace sphvv::solver
