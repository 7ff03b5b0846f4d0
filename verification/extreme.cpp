#include "sphvv/verification/extreme.hpp"

#include "sphvv/verification/extreme_scenes.hpp"
#include "sphvv/verification/markdown_table.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace sphvv::verification {

using Tree = nlohmann::ordered_json;

std::string_view to_string(Fate fate) {
    return fate == Fate::bounded ? "bounded" : fate == Fate::survives ? "survives" : "ends";
}

std::span<const ExtremeRow> extreme_rows() {
    static const std::vector<ExtremeRow> rows = [] {
        std::vector<ExtremeRow> all;
        for (const ExtremeScenes* scenes : extreme_scenes::all()) {
            std::ranges::move(scenes->rows(), std::back_inserter(all));
        }
        return all;
    }();
    return rows;
}

std::span<const ExtremeStudy> extreme_studies() {
    // A fifth more than the 24 s and 171 s measured.
    static const std::vector<ExtremeStudy> studies{{"stability/extreme", Tier::quick, 30},
                                                   {"stability/extreme_long", Tier::nightly, 210}};
    return studies;
}

void judge(ExtremeResult& result) {
    const ExtremeRow& row = result.row;
    const ExtremeOutcome& outcome = result.outcome;
    const auto fail = [&](const std::string& reason) {
        result.verdict = "FAIL";
        result.reason = reason;
    };
    result.verdict = "PASS";
    result.reason = row.why;
    if (row.fate == Fate::ends) {
        if (outcome.survived) {
            fail("survived, but must end");
        } else if (std::ranges::none_of(row.diagnoses, [&](const std::string& diagnosis) {
                       return outcome.diagnosis.starts_with(diagnosis);
                   })) {
            fail("ended with another diagnosis: " + outcome.diagnosis);
        }
    } else if (!outcome.survived) {
        fail("ended: " + outcome.diagnosis);
    } else if (!std::isfinite(outcome.error)) {
        fail("the error is not finite");
    } else if (row.fate == Fate::bounded && outcome.error > row.bound) {
        fail("the error is above its bound");
    }
}

ExtremeResult run_extreme(const ExtremeRow& row) {
    const auto begin = std::chrono::steady_clock::now();
    ExtremeResult result{row, {}, "", "", 0};
    try {
        try {
            result.outcome = row.run(row.scheme);
        } catch (const UserError& refused) { // before anything ran: a diagnosis like those of the steps
            result.outcome.diagnosis = refused.what();
        }
        judge(result);
    } catch (const std::exception& error) {
        result.verdict = "FAIL";
        result.reason = std::string("thrown: ") + error.what();
    }
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return result;
}

std::string markdown(std::span<const ExtremeResult> results) {
    MarkdownTable table(
        {"scene", "scheme", "fate", "bound", "error", "steps", "seconds", "verdict", "what happened"});
    const auto number = [](double value, const char* format) {
        char text[32];
        std::snprintf(text, sizeof text, format, value);
        return std::string(text);
    };
    for (const ExtremeResult& result : results) {
        const bool measured = result.outcome.survived && std::isfinite(result.outcome.error);
        table.add(
            {result.row.name, result.row.scheme, std::string(to_string(result.row.fate)),
             result.row.fate == Fate::bounded ? number(result.row.bound, "%.2g") : "–",
             measured ? number(result.outcome.error, "%.2g") : "–", std::to_string(result.outcome.steps),
             number(result.seconds, "%.2f"), result.verdict + (result.row.waiver.empty() ? "" : " (waived)"),
             result.outcome.diagnosis.empty() ? (result.verdict == "PASS" ? "to the end" : result.reason)
                                              : result.outcome.diagnosis});
    }
    return "\n### extreme scenes\n\n" + table.text();
}

void add_to_document(std::span<const ExtremeResult> results, Tree& document) {
    Tree& rows = document["extreme_rows"] = Tree::array();
    for (const ExtremeResult& result : results) {
        const bool measured = result.outcome.survived && std::isfinite(result.outcome.error);
        rows.push_back({{"name", result.row.name},
                        {"scheme", result.row.scheme},
                        {"must", result.row.must},
                        {"why", result.row.why},
                        {"fate", to_string(result.row.fate)},
                        {"bound", result.row.fate == Fate::bounded ? Tree(result.row.bound) : Tree(nullptr)},
                        {"survived", result.outcome.survived},
                        {"diagnosis", result.outcome.diagnosis},
                        {"error", measured ? Tree(result.outcome.error) : Tree(nullptr)},
                        {"steps", result.outcome.steps},
                        {"seconds", result.seconds},
                        {"verdict", result.verdict},
                        {"passes", result.verdict == "PASS"},
                        {"waiver", result.row.waiver},
                        {"reason", result.reason}});
    }
}

int exit_status(std::span<const ExtremeResult> results) {
    int status = 0;
    for (const ExtremeResult& result : results) {
        if (result.verdict != "PASS" && result.row.waiver.empty()) {
            status = std::max(status, result.row.fate != Fate::ends && !result.outcome.survived ? 3 : 1);
        }
    }
    return status;
}

} // namespace sphvv::verification
