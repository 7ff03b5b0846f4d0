#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace sphvv::verification {

/// A Markdown table with its columns aligned, so that it reads well on a terminal too.
class MarkdownTable {
public:
    explicit MarkdownTable(std::vector<std::string> header) { rows_.push_back(std::move(header)); }
    void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }

    std::string text() const {
        std::vector<std::size_t> width(rows_[0].size(), 3);
        for (const auto& row : rows_) {
            for (std::size_t c = 0; c < row.size(); ++c) {
                width[c] = std::max(width[c], visible(row[c]));
            }
        }
        std::string out;
        for (std::size_t r = 0; r < rows_.size(); ++r) {
            for (std::size_t c = 0; c < rows_[r].size(); ++c) {
                out += "| " + std::string(width[c] - visible(rows_[r][c]), ' ') + rows_[r][c] + " ";
            }
            out += "|\n";
            if (r == 0) {
                for (const std::size_t w : width) {
                    out += "|" + std::string(w + 1, '-') + ":";
                }
                out += "|\n";
            }
        }
        return out;
    }

private:
    /// Characters of a UTF-8 text.
    static std::size_t visible(const std::string& text) {
        return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
            return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
        }));
    }

    std::vector<std::vector<std::string>> rows_;
};

} // namespace sphvv::verification
