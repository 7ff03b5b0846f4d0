#include "scene_file.hpp"

// toml++ (3.3.0) takes for granted what a file may well violate ("[%", a date with a T and no time behind
// it). Here it is an error like any other, in every kind of build.
namespace sphvv::cli {
struct MalformedToml {};
constexpr void require_of_toml(bool condition) {
    if (!condition) {
        throw MalformedToml();
    }
}
} // namespace sphvv::cli
#undef NDEBUG
#define TOML_ASSERT(condition) sphvv::cli::require_of_toml(condition)
#include <toml++/toml.h>

#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

namespace sphvv::cli {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
    throw UserError("--scene: '" + path + "'" + what);
}

/// The line with the first character beyond ASCII that is not in a comment; 0 if there is none. Names and
/// numbers have none, and toml++ (3.3.0) looks such a character up in a table that does not have all of them:
/// undefined behaviour.
std::size_t line_beyond_ascii(std::string_view text) {
    std::size_t line = 1;
    std::string_view quote; // that the string in progress began with
    bool comment = false;
    for (std::size_t k = 0; k < text.size(); ++k) {
        const std::string_view rest = text.substr(k);
        if (text[k] == '\n') {
            ++line;
            comment = false;
            quote = quote.size() == 3 ? quote : std::string_view();
        } else if (comment) {
            continue;
        } else if ((static_cast<unsigned char>(text[k]) & 0x80U) != 0) {
            return line;
        } else if (quote.empty() && (text[k] == '"' || text[k] == '\'')) {
            const bool three = rest.starts_with(text[k] == '"' ? "\"\"\"" : "'''");
            quote = rest.substr(0, three ? 3 : 1);
            k += quote.size() - 1;
        } else if (quote.empty()) {
            comment = text[k] == '#';
        } else if (rest.starts_with(quote)) {
            k += quote.size() - 1;
            quote = {};
        } else if (quote.front() == '"' && (rest.starts_with("\\\"") || rest.starts_with("\\\\"))) {
            ++k;
        }
    }
    return 0;
}

std::string setting_of(const std::string& path, const std::string& key, const toml::node& node) {
    if (const auto* text = node.as_string()) {
        return text->get();
    }
    if (const auto number = node.value<double>()) {
        return solver::shortest(*number);
    }
    refuse(path, ": '" + key + "' must be a number or a text");
}

} // namespace

SceneDescription parse_scene(std::string_view text, const std::string& path) {
    SceneDescription description;
    if (const std::size_t line = line_beyond_ascii(text); line > 0) {
        refuse(path, ", line " + std::to_string(line) + ": only comments may have characters beyond ASCII");
    }
    toml::table table;
    try {
        table = toml::parse(text, path);
    } catch (const toml::parse_error& error) {
        refuse(path, ", line " + std::to_string(error.source().begin.line) + ": " +
                         std::string(error.description()));
    } catch (const MalformedToml&) {
        refuse(path, ": is not TOML");
    }
    for (const auto& [name, node] : table) {
        const std::string key(name.str());
        if (key == "case" || key == "scheme") {
            const auto word = node.value<std::string>();
            if (!word) {
                refuse(path, ": '" + key + "' must be a text");
            }
            (key == "case" ? description.flow : description.scheme) = *word;
        } else if (key == "n" || key == "seed") {
            const auto number = node.value_exact<std::int64_t>();
            if (!number || *number < 1 || *number > 1'000'000) {
                refuse(path, ": '" + key + "' must be an integer from 1 to 1000000");
            }
            (key == "n" ? description.n : description.seed) = static_cast<int>(*number);
        } else if (key == "set" && node.is_table()) {
            for (const auto& [set_name, value] : *node.as_table()) {
                const std::string set_key(set_name.str());
                description.settings[set_key] = setting_of(path, set_key, value);
            }
        } else {
            refuse(path,
                   ": there is no key '" + key + "'; accepted: case, scheme, n, seed, and a table [set]");
        }
    }
    return description;
}

SceneDescription read_scene_file(const std::string& path) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) { // it could be opened, but not read
        refuse(path, " is a folder, where a file is needed");
    }
    errno = 0;
    std::ifstream stream(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    if (!stream.is_open() || stream.bad()) {
        refuse(path, " cannot be read: " + std::generic_category().message(errno != 0 ? errno : EIO));
    }
    return parse_scene(text, path);
}

} // namespace sphvv::cli
