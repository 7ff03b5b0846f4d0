// `sphvv run --scene`: any text is a scene, or is refused in words.
#include "../scene_file.hpp"

#include "sphvv/solver/fuzz/target.hpp"

using namespace sphvv;

namespace {

/// A TOML text with every character that is not plain written as an escape.
std::string toml_text(std::string_view text) {
    std::string result = "\"";
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (code < 0x20 || code == 0x7F || c == '"' || c == '\\') {
            char escape[8];
            std::snprintf(escape, sizeof escape, "\\u%04X", static_cast<unsigned>(code));
            result += escape;
        } else {
            result += c;
        }
    }
    return result + '"';
}

std::string toml_of(const cli::SceneDescription& description) {
    std::string text = "case = " + toml_text(description.flow) +
                       "\nscheme = " + toml_text(description.scheme) +
                       "\nseed = " + std::to_string(description.seed) + "\n";
    if (description.n > 0) {
        text += "n = " + std::to_string(description.n) + "\n";
    }
    text += "[set]\n";
    for (const auto& [key, value] : description.settings) {
        text += toml_text(key) + " = " + toml_text(value) + "\n";
    }
    return text;
}

/// One key of each kind, as a case or a scheme has them.
solver::Settings resolved(const cli::SceneDescription& description) {
    using solver::Key;
    return {{Key::number("re", 100, 1e-3, 1e6, "1", ""), Key::integer("columns", 0, 0, 1000, ""),
             Key::word("start", "lattice", {"lattice", "jittered"}, "")},
            description.settings};
}

/// What a user sees of resolved settings leads to them again.
solver::Assignments texts_of(const solver::Settings& settings) {
    solver::Assignments texts;
    for (const solver::Key& key : settings.keys()) {
        texts[key.name] = key.value;
    }
    return texts;
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::is_refused_in_words([&] {
        const std::string_view text(reinterpret_cast<const char*>(data), size);
        cli::SceneDescription description = cli::parse_scene(text, "scene.toml");
        fuzz::require(cli::parse_scene(toml_of(description), "again.toml") == description,
                      "a scene does not come back from what it is written as");
        const solver::Assignments texts = texts_of(resolved(description));
        description.settings = texts;
        fuzz::require(texts_of(resolved(description)) == texts, "settings change when they are read again");
    });
    return 0;
}
