#include "sphvv/verification/extreme.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <stdexcept>

namespace sphvv::verification {
namespace {

ExtremeRow row_of(Fate fate, const ExtremeOutcome& outcome) {
    return {.name = "synthetic",
            .scheme = "wcsph",
            .must = "",
            .why = "",
            .fate = fate,
            .bound = 0.1,
            .diagnosis = "kinetic energy",
            .run = [outcome](const std::string& /*scheme*/) { return outcome; }};
}

std::string verdict(Fate fate, const ExtremeOutcome& outcome) {
    return run_extreme(row_of(fate, outcome)).verdict;
}

TEST(ExtremeRows, AreJudgedByTheirFate) {
    EXPECT_EQ(verdict(Fate::bounded, {true, "", 0.09, 5}), "PASS");
    EXPECT_EQ(verdict(Fate::bounded, {true, "", 0.11, 5}), "FAIL");
    EXPECT_EQ(verdict(Fate::bounded, {true, "", std::nan(""), 5}), "FAIL");
    EXPECT_EQ(verdict(Fate::bounded, {false, "kinetic energy above", 0, 5}), "FAIL");
    EXPECT_EQ(verdict(Fate::survives, {true, "", 7, 5}), "PASS");
    EXPECT_EQ(verdict(Fate::survives, {true, "", std::nan(""), 5}), "FAIL");
    EXPECT_EQ(verdict(Fate::survives, {false, "kinetic energy above", 0, 5}), "FAIL");
    EXPECT_EQ(verdict(Fate::ends, {false, "kinetic energy above", 0, 5}), "PASS");
    EXPECT_EQ(verdict(Fate::ends, {false, "minimum spacing", 0, 5}), "FAIL");
    EXPECT_EQ(verdict(Fate::ends, {true, "", 0, 5}), "FAIL");
}

TEST(ExtremeRows, ThatThrowFailAndKeepTheOthersRunning) {
    ExtremeRow row = row_of(Fate::survives, {});
    row.run = [](const std::string& /*scheme*/) -> ExtremeOutcome { throw std::logic_error("a bug"); };
    const ExtremeResult result = run_extreme(row);
    EXPECT_EQ(result.verdict, "FAIL");
    EXPECT_NE(result.reason.find("a bug"), std::string::npos);
    const std::vector<ExtremeResult> results{result};
    EXPECT_EQ(exit_status(results), 1);
    nlohmann::ordered_json document;
    add_to_document(results, document);
    EXPECT_FALSE(document["extreme_rows"][0]["passes"]);
    EXPECT_TRUE(document["extreme_rows"][0]["error"].is_null());
    row.waiver = "known";
    const std::vector<ExtremeResult> waived{run_extreme(row)};
    EXPECT_EQ(exit_status(waived), 0);
}

TEST(ExtremeRows, AreAllAsTheyMustBe) {
    std::set<std::pair<std::string, std::string>> names;
    std::set<Fate> fates;
    for (const ExtremeRow& row : extreme_rows()) {
        EXPECT_TRUE(names.emplace(row.name, row.scheme).second) << row.name;
        EXPECT_FALSE(row.must.empty() || row.why.empty());
        fates.insert(row.fate);
        const ExtremeResult result = run_extreme(row);
        EXPECT_TRUE(result.verdict == "PASS" || !row.waiver.empty())
            << row.name << ", " << row.scheme << ": " << result.reason << ", error " << result.outcome.error;
    }
    EXPECT_EQ(fates.size(), 3U);
}

} // namespace
} // namespace sphvv::verification
