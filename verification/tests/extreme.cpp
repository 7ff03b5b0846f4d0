#include "sphvv/verification/extreme.hpp"

#include "sphvv/verification/extreme_scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
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
            .diagnoses = {"kinetic energy", "velocity not finite"},
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
    EXPECT_EQ(verdict(Fate::ends, {false, "velocity not finite", 0, 5}), "PASS");
    EXPECT_EQ(verdict(Fate::ends, {false, "minimum spacing", 0, 5}), "FAIL");
    EXPECT_EQ(verdict(Fate::ends, {false, "particle 3: kinetic energy", 0, 5}), "FAIL") << "begins otherwise";
    EXPECT_EQ(verdict(Fate::ends, {true, "", 0, 5}), "FAIL");
}

TEST(ExtremeRows, ThatThrowFailAndKeepTheOthersRunning) {
    ExtremeRow row = row_of(Fate::survives, {});
    row.run = [](const std::string& /*scheme*/) -> ExtremeOutcome { throw std::logic_error("a bug"); };
    const ExtremeResult result = run_extreme(row);
    EXPECT_EQ(result.verdict, "FAIL");
    EXPECT_NE(result.reason.find("a bug"), std::string::npos);
    const std::vector<ExtremeResult> results{result};
    EXPECT_EQ(exit_status(results), 3);
    EXPECT_EQ(exit_status(std::vector{run_extreme(row_of(Fate::bounded, {true, "", 0.11, 5}))}), 1);
    EXPECT_EQ(
        exit_status(std::vector{run_extreme(row_of(Fate::bounded, {false, "kinetic energy above", 0, 5}))}),
        3);
    EXPECT_EQ(exit_status(std::vector{run_extreme(row_of(Fate::ends, {true, "", 0, 5}))}), 1);
    nlohmann::ordered_json document;
    add_to_document(results, document);
    EXPECT_FALSE(document["extreme_rows"][0]["passes"]);
    EXPECT_TRUE(document["extreme_rows"][0]["error"].is_null());
    row.waiver = "known";
    const std::vector<ExtremeResult> waived{run_extreme(row)};
    EXPECT_EQ(exit_status(waived), 0);
}

TEST(ExtremeRows, WithoutADiagnosisCannotPass) {
    ExtremeRow row = row_of(Fate::ends, {false, "kinetic energy above", 0, 5});
    row.diagnoses.clear();
    EXPECT_EQ(run_extreme(row).verdict, "FAIL");
}

TEST(ExtremeRows, TakeARefusalForADiagnosis) {
    ExtremeRow row = row_of(Fate::ends, {});
    row.run = [](const std::string& /*scheme*/) -> ExtremeOutcome { throw UserError("no such physics"); };
    EXPECT_EQ(run_extreme(row).verdict, "FAIL") << "another refusal";
    row.diagnoses = {"no such physics"};
    EXPECT_EQ(run_extreme(row).verdict, "PASS");
    row.fate = Fate::survives;
    EXPECT_EQ(run_extreme(row).verdict, "FAIL");
}

TEST(ExtremeRows, DoNotHang) {
    ExtremeRow row = row_of(Fate::survives, {});
    row.run = [](const std::string& scheme) {
        return extreme_scenes::run_case("taylor_green", scheme, {{"time_step", "1e-8"}}, 8);
    };
    const ExtremeResult result = run_extreme(row);
    EXPECT_EQ(result.verdict, "FAIL");
    EXPECT_NE(result.reason.find("still running after"), std::string::npos) << result.reason;
}

TEST(ExtremeRows, AreOfTheFilesOfTheirFolder) {
    std::set<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(SPHVV_EXTREME_SCENES)) {
        files.insert(entry.path().stem());
    }
    std::set<std::string> listed;
    for (const ExtremeScenes* scenes : extreme_scenes::all()) {
        listed.emplace(scenes->name);
        EXPECT_FALSE(scenes->rows().empty());
    }
    EXPECT_EQ(files, listed);
}

TEST(ExtremeRows, CompareListsThatHoldNoNumber) {
    EXPECT_EQ(extreme_scenes::largest_difference({{0, 0}, {3, 4}}, {{0, 0}, {0, 0}}), 5);
    EXPECT_TRUE(
        std::isnan(extreme_scenes::largest_difference({{std::nan(""), 0}, {3, 4}}, {{0, 0}, {0, 0}})));
}

TEST(ExtremeRows, AreAllAsTheyMustBe) {
    std::set<std::pair<std::string, std::string>> names;
    std::set<Fate> fates;
    for (const ExtremeRow& row : extreme_rows()) {
        EXPECT_TRUE(names.emplace(row.name, row.scheme).second) << row.name;
        EXPECT_FALSE(row.must.empty() || row.why.empty());
        fates.insert(row.fate);
        if (row.tier != Tier::quick) {
            continue;
        }
        const ExtremeResult result = run_extreme(row);
        EXPECT_EQ(result.verdict == "PASS", row.waiver.empty())
            << row.name << ", " << row.scheme << ": " << result.reason << ", error " << result.outcome.error;
    }
    EXPECT_EQ(fates.size(), 3U);
}

} // namespace
} // namespace sphvv::verification
