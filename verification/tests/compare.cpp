// The regression gate on synthetic results: every kind of change, the table that names it, and what is no
// baseline.
#include "sphvv/verification/compare.hpp"

#include "sphvv/solver/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace sphvv::verification {
namespace {

ResultTree sample(int n, double error) {
    return {{"n", n},
            {"l1", error},
            {"l2", 1.1 * error},
            {"linf", 2 * error},
            {"steps", 10},
            {"pair_evaluations", 1000. * n},
            {"seconds", 0.1},
            {"survived", true}};
}

ResultTree operator_study(const std::string& name, const std::string& arrangement) {
    ResultTree samples = ResultTree::array();
    for (const int n : {20, 40, 80, 160}) {
        samples.push_back(sample(n, 1. / n));
    }
    return {{"operator", name},
            {"dimension", 2},
            {"arrangement", arrangement},
            {"path", "h/dx fixed"},
            {"kernel", "quintic_spline"},
            {"tier", "quick"},
            {"expected", {{"low", 0.75}, {"high", 1.25}}},
            {"fit", {{"order", 1.0}, {"ci95", 0.01}, {"verdict", "PASS"}}},
            {"samples", samples}};
}

/// A result of two operators on two arrangements, a scheme, a property, a kernel check and figures. A
/// list of one entry is ResultTree::array({entry}): of `{entry}` alone clang makes a copy of the entry.
ResultTree result() {
    ResultTree tree{{"format", "sphvv-results"},
                    {"provenance", {{"revision", "abc"}, {"tree_clean", true}, {"cpu", "x"}}}};
    tree["operator_studies"] = {operator_study("gradient", "square"), operator_study("gradient", "random"),
                                operator_study("laplacian", "square")};
    ResultTree scheme = operator_study("", "");
    for (const char* name : {"operator", "dimension", "arrangement", "path", "kernel"}) {
        scheme.erase(name);
    }
    scheme["scheme"] = "isph_dfs";
    scheme["group"] = "taylor_green re=100";
    scheme["field"] = "velocity";
    tree["studies"] = ResultTree::array({scheme});
    tree["operator_properties"] = ResultTree::array({{{"operator", "gradient"},
                                                      {"dimension", 2},
                                                      {"arrangement", "random"},
                                                      {"property", "exact for linears"},
                                                      {"value", 1e-15},
                                                      {"bound", 1e-10},
                                                      {"at_least", false},
                                                      {"passes", true}}});
    tree["kernel_checks"] = ResultTree::array({{{"kernel", "quintic_spline"},
                                                {"dimension", 2},
                                                {"check", "unit integral"},
                                                {"value", 1.0},
                                                {"expected", 1.0},
                                                {"tolerance", 1e-12},
                                                {"passes", true}}});
    tree["published_figures"] = {
        {{"id", "XU-LAP"},
         {"reference", 66.5},
         {"value", 66.5},
         {"tolerance", 0.02},
         {"is_bound", false},
         {"agrees", true},
         {"waiver", ""}},
        {{"id", "XU-ODD"}, {"value", 4000.}, {"agrees", false}, {"waiver", "a misprint"}}};
    return tree;
}

std::size_t count(const Comparison& comparison, Change change) {
    return static_cast<std::size_t>(std::ranges::count_if(
        comparison.differences, [&](const Difference& d) { return d.change == change; }));
}

/// The comparison after one edit of the current result.
template <class Edit>
Comparison after(const Edit& edit) {
    ResultTree current = result();
    edit(current);
    return compare(result(), current);
}

TEST(Compare, TheSameIsBitwiseEqualWhateverItsOrder) {
    EXPECT_FALSE(compare(result(), result()).fails());
    const Comparison comparison = after([](ResultTree& tree) {
        std::reverse(tree["operator_studies"].begin(), tree["operator_studies"].end());
        std::reverse(tree["studies"][0]["samples"].begin(), tree["studies"][0]["samples"].end());
    });
    EXPECT_TRUE(comparison.differences.empty());
    EXPECT_EQ(comparison.bitwise, comparison.compared);
    EXPECT_TRUE(markdown(comparison).starts_with("bitwise equal")) << markdown(comparison);
}

TEST(Compare, ABaselineComparesBitwiseEqualWithItsResult) {
    const ResultTree baseline = ResultTree::parse(baseline_text(reduced_for_baseline(result())));
    const Comparison comparison = compare(baseline, result());
    EXPECT_TRUE(comparison.differences.empty()) << markdown(comparison);
    EXPECT_GT(comparison.compared, 50);
}

TEST(Compare, RoundOffPassesAndAChangedConstantIsNamed) {
    const auto scaled = [](double factor) {
        return after([&](ResultTree& tree) {
            for (ResultTree& study : tree["operator_studies"]) {
                for (ResultTree& row : study["samples"]) {
                    if (study["operator"] == "gradient") {
                        row["l2"] = factor * row["l2"].get<double>();
                    }
                }
            }
        });
    };
    EXPECT_EQ(count(scaled(1 + 1e-9), Change::round_off), 8);
    EXPECT_FALSE(scaled(1 + 1e-9).fails());
    for (const double factor : {1.01, 0.99}) { // an improvement needs a new baseline, too
        const Comparison comparison = scaled(factor);
        EXPECT_EQ(count(comparison, Change::error_level), 8);
        EXPECT_TRUE(comparison.fails());
        const std::string table = markdown(comparison);
        EXPECT_NE(table.find("| gradient |"), std::string::npos) << table;
        EXPECT_EQ(table.find("laplacian"), std::string::npos) << table;
        EXPECT_EQ(std::ranges::count(table, '\n'), 5) << "header, rule, one row, blank, counts\n" << table;
    }
}

TEST(Compare, StabilityAndExtremeScenesAreChecks) {
    ResultTree before;
    before["provenance"]["tree_clean"] = true;
    before["stability_limits"] = ResultTree::array({{{"study", "stability/acoustic"},
                                                     {"scheme", "wcsph"},
                                                     {"limit", "acoustic"},
                                                     {"theory", 4.5},
                                                     {"theory_by", "lattice sums"},
                                                     {"high", 1.05},
                                                     {"measured", 4.51},
                                                     {"passes", true}}});
    before["stability_maps"] = ResultTree::array({{{"study", "stability/tensile_map"},
                                                   {"scheme", "wcsph"},
                                                   {"theory", {1.0, 1.02, 1.03}},
                                                   {"disagreements", 0},
                                                   {"undecided", 1},
                                                   {"measured", {1.0, nullptr, 1.031}},
                                                   {"passes", true}}});
    before["extreme_rows"] = ResultTree::array({{{"name", "a spray"},
                                                 {"scheme", "wcsph"},
                                                 {"fate", "bounded"},
                                                 {"bound", 1e-12},
                                                 {"error", 2e-16},
                                                 {"passes", true},
                                                 {"waiver", ""}}});
    before["conditioning_rows"] = ResultTree::array({{{"name", "periodic, 16 x 16"},
                                                      {"study", "stability/conditioning"},
                                                      {"converged", true},
                                                      {"iterations_two_level", 24},
                                                      {"tolerance", 1}}});
    before["conditioning_checks"] = ResultTree::array({{{"subject", "periodic, 16 x 16"},
                                                        {"name", "iterations"},
                                                        {"study", "stability/conditioning"},
                                                        {"value", 40},
                                                        {"low", 1},
                                                        {"high", 50},
                                                        {"tolerance", 1},
                                                        {"passes", true},
                                                        {"waiver", ""}}});
    const ResultTree baseline = ResultTree::parse(baseline_text(reduced_for_baseline(before)));
    EXPECT_TRUE(compare(baseline, before).differences.empty());
    const auto with = [&](const auto& edit) {
        ResultTree now = before;
        edit(now);
        return compare(baseline, now);
    };
    EXPECT_FALSE(with([](ResultTree& now) { now["stability_limits"][0]["measured"] = 4.53; }).fails());
    EXPECT_FALSE(with([](ResultTree& now) { now["extreme_rows"][0]["error"] = 9e-16; }).fails());
    ResultTree unheld = before;
    unheld["extreme_rows"][0]["fate"] = "survives";
    unheld["extreme_rows"][0].erase("bound");
    unheld["extreme_rows"][0]["error"] = 2e-3;
    ResultTree later = unheld;
    for (const auto& [error, fails] : {std::pair{5e-3, false}, {5e-4, false}, {5e-2, true}, {5e-5, true}}) {
        later["extreme_rows"][0]["error"] = error;
        EXPECT_EQ(compare(unheld, later).fails(), fails) << error;
        later["extreme_rows"][0]["fate"] = "bounded";
        ResultTree held = unheld;
        held["extreme_rows"][0]["fate"] = "bounded";
        EXPECT_TRUE(compare(held, later).fails()) << error;
        later["extreme_rows"][0]["fate"] = "survives";
    }
    // Below a bound of physics, not of round-off, there are digits to compare.
    ResultTree physics = before;
    physics["extreme_rows"][0]["bound"] = 1.0;
    physics["extreme_rows"][0]["error"] = 0.34;
    ResultTree doubled = physics;
    doubled["extreme_rows"][0]["error"] = 0.68;
    EXPECT_EQ(count(compare(physics, doubled), Change::error_level), 1);
    ResultTree older = baseline;
    older["stability_maps"][0].erase("undecided");
    older["stability_maps"][0].erase("measured");
    EXPECT_FALSE(compare(older, before).fails()) << "a baseline that is older than the member";
    EXPECT_FALSE(
        with([](ResultTree& now) { now["conditioning_rows"][0]["iterations_two_level"] = 25; }).fails());
    for (const auto& [list, name, value, change] :
         {std::tuple{"stability_limits", "measured", ResultTree(4.0), Change::error_level},
          {"stability_limits", "measured", ResultTree(nullptr), Change::error_level},
          {"stability_limits", "theory", ResultTree(5.0), Change::demand},
          {"stability_limits", "theory_by", ResultTree("linearised step"), Change::demand},
          {"stability_limits", "high", ResultTree(2.0), Change::demand},
          {"stability_limits", "passes", ResultTree(false), Change::verdict},
          {"stability_maps", "disagreements", ResultTree(3), Change::error_level},
          {"stability_maps", "undecided", ResultTree(2), Change::error_level},
          {"stability_maps", "undecided", ResultTree(nullptr), Change::error_level},
          {"stability_maps", "measured", ResultTree({1.0, nullptr, 1.0311}), Change::round_off},
          {"stability_maps", "measured", ResultTree({1.0, nullptr, 1.05}), Change::error_level},
          {"stability_maps", "measured", ResultTree({1.0, 1.02, 1.031}), Change::error_level},
          {"stability_maps", "measured", ResultTree({1.0, nullptr, nullptr}), Change::error_level},
          {"stability_maps", "measured", ResultTree({1.0, nullptr}), Change::error_level},
          {"stability_maps", "measured", ResultTree(nullptr), Change::error_level},
          {"stability_maps", "theory", ResultTree({1.0, 1.0200000001, 1.03}), Change::round_off},
          {"stability_maps", "theory", ResultTree({1.0, 1.021, 1.03}), Change::demand},
          {"stability_maps", "theory", ResultTree({1.0, 1.02}), Change::demand},
          {"extreme_rows", "bound", ResultTree(1.0), Change::demand},
          {"extreme_rows", "fate", ResultTree("survives"), Change::demand},
          {"extreme_rows", "passes", ResultTree(false), Change::verdict},
          {"conditioning_rows", "iterations_two_level", ResultTree(26), Change::error_level},
          {"conditioning_rows", "converged", ResultTree(false), Change::verdict},
          {"conditioning_checks", "value", ResultTree(42), Change::error_level},
          {"conditioning_checks", "high", ResultTree(60), Change::demand},
          {"conditioning_checks", "low", ResultTree(0.5), Change::demand},
          {"conditioning_checks", "passes", ResultTree(false), Change::verdict}}) {
        ResultTree now = before;
        now[list][0][name] = value;
        EXPECT_EQ(count(compare(baseline, now), change), 1) << list << ' ' << name;
    }
}

TEST(Compare, SchemesHaveTheirOwnRoundOff) {
    const auto scaled = [](double factor) {
        return after([&](ResultTree& tree) {
            tree["studies"][0]["samples"][1]["l1"] =
                factor * tree["studies"][0]["samples"][1]["l1"].get<double>();
        });
    };
    EXPECT_FALSE(scaled(1.005).fails());
    EXPECT_EQ(count(scaled(1.02), Change::error_level), 1);
}

/// A ladder in time: every rung has the same n.
ResultTree in_time() {
    ResultTree tree = result();
    ResultTree& study = tree["studies"][0];
    study["axis"] = "dt";
    double dt = 0.008;
    for (ResultTree& row : study["samples"]) {
        row["n"] = 12;
        row["dt"] = dt;
        row["l2"] = dt * dt;
        dt /= 2;
    }
    return tree;
}

TEST(Compare, TheRungsOfALadderInTimeAreTold) {
    const ResultTree baseline = ResultTree::parse(baseline_text(reduced_for_baseline(in_time())));
    EXPECT_EQ(baseline["studies"][0]["samples"].size(), 4);
    EXPECT_TRUE(compare(baseline, in_time()).differences.empty());
    for (std::size_t rung = 0; rung < 4; ++rung) {
        ResultTree now = in_time();
        now["studies"][0]["samples"][rung]["l2"] = 1.0;
        const Comparison comparison = compare(baseline, now);
        ASSERT_EQ(count(comparison, Change::error_level), 1) << rung;
        EXPECT_NE(comparison.differences[0].where.find("dt = "), std::string::npos);
    }
    ResultTree fewer = in_time();
    fewer["studies"][0]["samples"].erase(2);
    EXPECT_EQ(count(compare(baseline, fewer), Change::missing), 1);
}

TEST(Compare, AStudySaysWhatItsRoundOffIs) {
    const auto compared = [](double declared, double factor) {
        ResultTree before = result();
        before["studies"][0]["round_off"] = declared;
        ResultTree now = before;
        now["studies"][0]["samples"][1]["l1"] = factor * now["studies"][0]["samples"][1]["l1"].get<double>();
        return compare(ResultTree::parse(baseline_text(reduced_for_baseline(before))), now);
    };
    EXPECT_FALSE(compared(0.1, 1.05).fails());
    EXPECT_TRUE(compared(0.1, 1.2).fails());
    EXPECT_TRUE(compared(1e-6, 1.0001).fails());
    // What is loosened today is a weaker demand and excuses nothing.
    ResultTree before = result();
    before["studies"][0]["round_off"] = 0.01;
    ResultTree now = before;
    now["studies"][0]["round_off"] = 100.0;
    now["studies"][0]["samples"][1]["l1"] = 1.0;
    EXPECT_EQ(count(compare(before, now), Change::demand), 1);
    EXPECT_EQ(count(compare(before, now), Change::error_level), 1);
}

TEST(Compare, WhatIsZeroToRoundOffHasNoDigits) {
    ResultTree before = result();
    before["studies"][0]["samples"][0]["linf"] = 3e-15;
    ResultTree now = before;
    now["studies"][0]["samples"][0]["linf"] = 5e-14;
    EXPECT_EQ(count(compare(before, now), Change::round_off), 1);
    EXPECT_FALSE(compare(before, now).fails());
    now["studies"][0]["samples"][0]["linf"] = 1e-9;
    EXPECT_TRUE(compare(before, now).fails());
}

TEST(Compare, ARunThatEndsEarlyIsHeldToItsFateAndNotToItsSteps) {
    ResultTree before = result();
    before["studies"][0]["expected"]["fate"] = "ends_early";
    for (const char* norm : {"l1", "l2", "linf"}) {
        before["studies"][0]["samples"][3][norm] = nullptr;
    }
    before["studies"][0]["samples"][3]["survived"] = false;
    const ResultTree baseline = ResultTree::parse(baseline_text(reduced_for_baseline(before)));
    ResultTree later = before;
    later["studies"][0]["samples"][3]["steps"] = 99;
    EXPECT_TRUE(compare(baseline, later).differences.empty());
    ResultTree survives = before;
    survives["studies"][0]["samples"][3]["survived"] = true;
    EXPECT_EQ(count(compare(baseline, survives), Change::verdict), 1);
    ResultTree undemanded = before;
    undemanded["studies"][0]["expected"].erase("fate");
    EXPECT_EQ(count(compare(baseline, undemanded), Change::demand), 1);
    // When and how it may end is the whole demand; a baseline that is older than its bounds says nothing.
    for (const char* name : {"spacing", "not_before"}) {
        ResultTree bounded = before;
        bounded["studies"][0]["expected"][name] = 0.1;
        const ResultTree kept = ResultTree::parse(baseline_text(reduced_for_baseline(bounded)));
        EXPECT_TRUE(compare(kept, bounded).differences.empty());
        bounded["studies"][0]["expected"][name] = 0.2;
        EXPECT_EQ(count(compare(kept, bounded), Change::demand), 1) << name;
        EXPECT_EQ(count(compare(kept, before), Change::demand), 1) << name;
        EXPECT_EQ(count(compare(baseline, bounded), Change::added), 1) << name;
        EXPECT_FALSE(compare(baseline, bounded).fails());
    }
}

ResultTree with_runs(const char* claims, const char* lost) {
    ResultTree tree = result();
    for (const bool survived : {true, false}) {
        tree["runs"].push_back({{"scheme", "isph_lee"},
                                {"group", "g"},
                                {"survived", survived},
                                {"budget", {{"claims", claims}, {"lost", survived ? lost : "energy"}}}});
    }
    return tree;
}

TEST(Compare, AClaimToConserveThatIsGivenUpIsALoosenedDemand) {
    const ResultTree before = with_runs("momentum, energy", "");
    const ResultTree baseline = ResultTree::parse(baseline_text(reduced_for_baseline(before)));
    EXPECT_EQ(baseline["conservation"].size(), 1U);
    EXPECT_TRUE(compare(baseline, before).differences.empty());
    const Comparison given_up = compare(baseline, with_runs("momentum", ""));
    EXPECT_EQ(count(given_up, Change::demand), 1);
    EXPECT_TRUE(given_up.fails());
    EXPECT_EQ(count(compare(baseline, with_runs("momentum, energy", "energy")), Change::verdict), 1);
    EXPECT_EQ(count(compare(baseline, result()), Change::missing), 1);
    EXPECT_FALSE(compare(result(), before).fails()) << "an older baseline";
}

TEST(Compare, ASolveMayEndOneIterationEarlierOrLater) {
    const auto compared = [](double steps, double before, double after) {
        ResultTree old = result();
        old["studies"][0]["samples"][0]["steps"] = steps;
        old["studies"][0]["samples"][0]["solver_iterations"] = before;
        ResultTree now = old;
        now["studies"][0]["samples"][0]["solver_iterations"] = after;
        return compare(old, now).fails();
    };
    EXPECT_FALSE(compared(1, 15, 16));
    EXPECT_TRUE(compared(1, 15, 17));
    EXPECT_FALSE(compared(100, 500, 510)); // the root of a hundred
    EXPECT_TRUE(compared(100, 500, 515));
    EXPECT_FALSE(compared(100, 5000, 5049)) << "1 %";
}

TEST(Compare, WorkIsKeptOnceForAllFieldsOfARun) {
    ResultTree before = result();
    ResultTree pressure = before["studies"][0];
    pressure["field"] = "pressure";
    before["studies"].push_back(pressure);
    const ResultTree baseline = ResultTree::parse(baseline_text(reduced_for_baseline(before)));
    EXPECT_TRUE(baseline["studies"][0]["samples"][0].contains("steps"));
    EXPECT_FALSE(baseline["studies"][1]["samples"][0].contains("steps"));
    EXPECT_TRUE(compare(baseline, before).differences.empty());
    ResultTree dearer = before;
    for (ResultTree& study : dearer["studies"]) {
        study["samples"][0]["pair_evaluations"] = 9e9;
    }
    EXPECT_EQ(count(compare(baseline, dearer), Change::work), 1);
}

TEST(Compare, GoalsAndCalibrationsAreChecksAndClaimsOfOthersAreNot) {
    ResultTree before;
    before["provenance"]["tree_clean"] = true;
    before["claims"] = {{{"id", "GOAL"}, {"group", "g"}, {"text", "t"}, {"agrees", true}, {"binding", true}},
                        {{"id", "XU"}, {"group", "g"}, {"text", "t"}, {"agrees", false}, {"binding", false}}};
    before["calibration"]["results"] = ResultTree::array({{{"scheme", "isph_asai"},
                                                           {"depth", 0.2},
                                                           {"duration", 1.0},
                                                           {"dx", 0.01},
                                                           {"dt", 0.001},
                                                           {"usable", 0.1},
                                                           {"passes", true}}});
    const ResultTree baseline = ResultTree::parse(baseline_text(reduced_for_baseline(before)));
    EXPECT_EQ(baseline["claims"].size(), 1);
    EXPECT_TRUE(compare(baseline, before).differences.empty());
    ResultTree now = before;
    now["claims"][1]["agrees"] = true;
    EXPECT_TRUE(compare(baseline, now).differences.empty());
    now["claims"][0]["agrees"] = false;
    EXPECT_EQ(count(compare(baseline, now), Change::verdict), 1);
    EXPECT_THROW(reduced_for_baseline(now), UserError) << "a goal is missed";
    now = before;
    now["calibration"]["results"][0]["usable"] = 0.05;
    EXPECT_EQ(count(compare(baseline, now), Change::error_level), 1);
}

TEST(Compare, WhereTheGateFailsTheTableHasOnlyWhatItFailsOn) {
    const Comparison comparison = after([](ResultTree& t) {
        t["operator_studies"].push_back(operator_study("new", "square"));
        t["studies"][0]["samples"][0]["seconds"] = 9.0;
        t["studies"][0]["samples"][0]["l2"] = 9.0;
    });
    EXPECT_EQ(count(comparison, Change::added) + count(comparison, Change::run_time), 2);
    const std::string table = markdown(comparison);
    EXPECT_EQ(std::ranges::count(table, '\n'), 5) << "header, rule, one row, blank, counts\n" << table;
    EXPECT_NE(table.find("1 new"), std::string::npos) << table;
}

TEST(Summary, FitsAPullRequestAndNamesVerdictBuildsAndWhy) {
    ResultTree before = result();
    ResultTree now = result();
    now["provenance"]["revision"] = "def";
    for (int k = 0; k < 100; ++k) {
        const std::string name = "operator_" + std::to_string(k);
        before["operator_studies"].push_back(operator_study(name, "square"));
        now["operator_studies"].push_back(operator_study(name, "square"));
        now["operator_studies"].back()["samples"][0]["l2"] = 7.0;
    }
    const std::string text = summary(compare(before, now), before, now);
    EXPECT_LE(std::ranges::count(text, '\n'), 40) << text;
    for (const char* part : {"FAIL", "abc", "def", "operator_0", "more rows", "run time"}) {
        EXPECT_NE(text.find(part), std::string::npos) << part << '\n' << text;
    }
    EXPECT_NE(summary(compare(before, before), before, before).find("PASS"), std::string::npos);
}

TEST(Compare, AddsUpTheSecondsOfARunOnce) {
    ResultTree tree = result();
    tree.erase("operator_studies");
    tree["studies"].push_back(tree["studies"][0]);
    tree["studies"][1]["field"] = "pressure";
    double seconds = 0;
    for (const ResultTree& sample : tree["studies"][0]["samples"]) {
        seconds += sample["seconds"].get<double>();
    }
    ASSERT_GT(seconds, 0);
    EXPECT_DOUBLE_EQ(compare(tree, tree).seconds_before, seconds);
}

TEST(Merged, IsAllOfOneBuild) {
    ResultTree operators = result();
    operators.erase("studies");
    ResultTree schemes{{"provenance", operators["provenance"]}, {"studies", result()["studies"]}};
    const ResultTree both = merged(std::array{operators, schemes});
    EXPECT_TRUE(compare(result(), both).differences.empty());
    EXPECT_FALSE(compare(result(), both).fails());
    schemes["provenance"]["interrupted"] = true;
    EXPECT_THROW(reduced_for_baseline(merged(std::array{operators, schemes})), UserError);
    schemes["provenance"]["revision"] = "other";
    EXPECT_THROW(merged(std::array{operators, schemes}), UserError);
}

TEST(Compare, EveryKindOfChangeIsSeen) {
    EXPECT_EQ(
        count(after([](ResultTree& t) { t["operator_studies"][0]["fit"]["order"] = 1.2; }), Change::order),
        1);
    EXPECT_EQ(
        count(after([](ResultTree& t) { t["operator_studies"][0]["fit"]["order"] = 1.04; }), Change::order),
        0);
    EXPECT_EQ(count(after([](ResultTree& t) { t["operator_studies"][0]["fit"]["verdict"] = "FAIL"; }),
                    Change::verdict),
              1);
    EXPECT_EQ(count(after([](ResultTree& t) { t["studies"][0]["samples"][0]["pair_evaluations"] = 3e4; }),
                    Change::work),
              1);
    EXPECT_EQ(
        count(after([](ResultTree& t) { t["operator_properties"][0]["passes"] = false; }), Change::verdict),
        1);
    EXPECT_EQ(
        count(after([](ResultTree& t) { t["published_figures"][0]["value"] = 66.51; }), Change::error_level),
        1);
    EXPECT_EQ(count(after([](ResultTree& t) { t["operator_studies"].erase(1); }), Change::missing), 1);
    EXPECT_EQ(count(after([](ResultTree& t) { t["studies"][0]["samples"].erase(1); }), Change::missing), 1);
    EXPECT_EQ(count(after([](ResultTree& t) { t["operator_studies"][0]["samples"][0]["l1"] = nullptr; }),
                    Change::error_level),
              1);
}

TEST(Compare, AWeakerDemandIsSeen) {
    const auto wider = after([](ResultTree& t) { t["operator_studies"][0]["expected"]["low"] = -2.0; });
    EXPECT_EQ(count(wider, Change::demand), 1);
    EXPECT_TRUE(wider.fails());
    const auto demand = [](const char* list, const char* name, const ResultTree& value) {
        const Comparison comparison = after([&](ResultTree& t) { t[list][0][name] = value; });
        EXPECT_EQ(comparison.fails(), count(comparison, Change::demand) == 1) << list << ' ' << name;
        return count(comparison, Change::demand);
    };
    EXPECT_EQ(demand("operator_properties", "bound", 1.0), 1);
    EXPECT_EQ(demand("operator_properties", "at_least", true), 1);
    EXPECT_EQ(demand("kernel_checks", "tolerance", 1e-3), 1);
    EXPECT_EQ(demand("kernel_checks", "tolerance", nullptr), 1) << "infinite";
    EXPECT_EQ(demand("kernel_checks", "expected", 1.1), 1);
    EXPECT_EQ(demand("published_figures", "reference", 67.0), 1);
    EXPECT_EQ(demand("published_figures", "tolerance", 0.5), 1);
    EXPECT_EQ(demand("published_figures", "is_bound", true), 1);
    EXPECT_EQ(demand("published_figures", "reference", 66.5 * (1 + 1e-12)), 0) << "computed elsewhere";
}

TEST(Compare, ADemandThatAnOldBaselineDoesNotKeepIsReportedAndDoesNotFail) {
    ResultTree old = reduced_for_baseline(result());
    old["kernel_checks"][0].erase("expected");
    for (const char* name : {"reference", "tolerance", "is_bound"}) {
        old["published_figures"][0].erase(name);
    }
    const Comparison comparison = compare(old, result());
    EXPECT_EQ(count(comparison, Change::added), 4);
    EXPECT_FALSE(comparison.fails());
    const std::string table = markdown(comparison);
    EXPECT_EQ(std::ranges::count(table, '\n'), 6) << "header, rule, one row a list, blank, counts\n" << table;
    ResultTree loosened = result();
    loosened["kernel_checks"][0]["tolerance"] = 1e-3; // which the old baseline keeps
    EXPECT_TRUE(compare(old, loosened).fails());
}

TEST(Compare, WhatNeitherSideHasIsNotCounted) {
    const ResultTree rung{{"n", 20}, {"l1", 0.1}, {"l2", nullptr}, {"pair_evaluations", 5}};
    ResultTree tree = result();
    tree.erase("studies");
    tree.erase("operator_properties");
    tree.erase("kernel_checks");
    tree["published_figures"] = ResultTree::array({{{"id", "XU-LAP"}, {"value", 66.5}, {"agrees", true}}});
    tree["operator_studies"] = ResultTree::array({operator_study("gradient", "square")});
    tree["operator_studies"][0]["samples"] = ResultTree::array({rung});
    tree["operator_studies"][0].erase("expected");
    const Comparison same = compare(tree, tree);
    EXPECT_EQ(same.compared, 6) << "verdict, order, l1, pair_evaluations; agrees, value";
    EXPECT_EQ(same.bitwise, same.compared);
    // What only one side has is seen from either.
    ResultTree more = tree;
    more["operator_studies"][0]["samples"][0]["l2"] = 0.1;
    for (const Comparison& comparison : {compare(tree, more), compare(more, tree)}) {
        EXPECT_EQ(count(comparison, Change::error_level), 1);
        EXPECT_EQ(comparison.compared, same.compared + 1);
        EXPECT_NE(markdown(comparison).find(" none |"), std::string::npos) << markdown(comparison);
        EXPECT_TRUE(comparison.fails());
    }
}

TEST(Compare, WhatIsInformationalDoesNotFail) {
    const Comparison slower = after([](ResultTree& t) { t["studies"][0]["samples"][0]["seconds"] = 1.0; });
    EXPECT_EQ(count(slower, Change::run_time), 1);
    EXPECT_FALSE(slower.fails());
    const Comparison more =
        after([](ResultTree& t) { t["operator_studies"].push_back(operator_study("new", "square")); });
    EXPECT_EQ(count(more, Change::added), 1);
    EXPECT_FALSE(more.fails());
    const Comparison noise = after([](ResultTree& t) { t["operator_properties"][0]["value"] = 9e-13; });
    EXPECT_EQ(count(noise, Change::round_off), 1);
    EXPECT_FALSE(noise.fails());
}

TEST(Compare, BitwiseEqualIsNotSaidOfWhatIsNotTheSame) {
    // h takes part in the order but not in the errors.
    const Comparison finer = after([](ResultTree& t) { t["operator_studies"][0]["fit"]["order"] = 1.04; });
    EXPECT_EQ(count(finer, Change::round_off), 1);
    EXPECT_FALSE(finer.fails());
    const Comparison lost = after([](ResultTree& t) { t["operator_studies"][0]["fit"].erase("order"); });
    EXPECT_EQ(count(lost, Change::order), 1);
    EXPECT_TRUE(lost.fails());
    const Comparison rung =
        after([](ResultTree& t) { t["operator_studies"][0]["samples"].push_back(sample(320, 0.1)); });
    EXPECT_EQ(count(rung, Change::added), 1);
    // A study that stands twice in the file.
    const Comparison twice = after([](ResultTree& t) {
        const ResultTree copy = t["operator_studies"][0];
        t["operator_studies"].push_back(copy);
    });
    EXPECT_EQ(count(twice, Change::added), 1);
}

TEST(Compare, AKernelCheckIsNoBetterThanItsTolerance) {
    const auto estimated = [](double value, double tolerance) {
        ResultTree tree;
        tree["provenance"]["tree_clean"] = true;
        tree["kernel_checks"] = ResultTree::array({{{"kernel", "wendland_c6"},
                                                    {"dimension", 0},
                                                    {"check", "smoothness"},
                                                    {"value", value},
                                                    {"tolerance", tolerance},
                                                    {"passes", true}}});
        return tree;
    };
    EXPECT_FALSE(compare(estimated(5.9479, 0.3), estimated(5.94797, 0.3)).fails());
    EXPECT_TRUE(compare(estimated(5.9, 0.3), estimated(5.5, 0.3)).fails());
    // A check that was loosened does not excuse a new value.
    EXPECT_TRUE(compare(estimated(1, 1e-12), estimated(1.1, 0.3)).fails());
    EXPECT_EQ(reduced_for_baseline(estimated(6, 0.3))["kernel_checks"][0]["tolerance"], 0.3);
}

TEST(Compare, EntriesWithoutIdentityAreRefused) {
    const auto refused = [](const auto& edit) {
        ResultTree tree = result();
        edit(tree);
        EXPECT_THROW(compare(tree, tree), UserError) << tree.dump();
    };
    refused([](ResultTree& t) { t["operator_studies"] = 5; });
    refused([](ResultTree& t) { t["operator_studies"][0].erase("operator"); });
    refused([](ResultTree& t) { t["operator_studies"][0]["samples"][0].erase("n"); });
    refused([](ResultTree& t) { t["operator_studies"][0]["samples"][0]["n"] = "20"; });
    refused([](ResultTree& t) { t["operator_properties"][0].erase("property"); });
}

TEST(Compare, TheTableStaysShort) {
    ResultTree before = result();
    ResultTree now = result();
    for (int k = 0; k < 100; ++k) {
        before["operator_studies"].push_back(operator_study("operator_" + std::to_string(k), "square"));
        now["operator_studies"].push_back(operator_study("operator_" + std::to_string(k), "square"));
        now["operator_studies"].back()["samples"][0]["l2"] = 7.0;
    }
    EXPECT_LE(std::ranges::count(markdown(compare(before, now)), '\n'), 40);
}

TEST(Compare, ResultsWithNothingInCommonAreRefused) {
    ResultTree other = result();
    for (const char* list :
         {"operator_studies", "operator_properties", "kernel_checks", "published_figures"}) {
        other[list] = ResultTree::array();
    }
    ResultTree operators = result();
    operators["studies"] = ResultTree::array();
    EXPECT_THROW(compare(operators, other), UserError);
}

TEST(Bless, RefusesWhatDoesNotPassAndNamesIt) {
    const auto refusal = [](const auto& edit) -> std::string {
        ResultTree tree = result();
        edit(tree);
        try {
            reduced_for_baseline(tree);
        } catch (const UserError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(refusal([](ResultTree&) {}), "");
    EXPECT_NE(
        refusal([](ResultTree& t) { t["operator_studies"][2]["fit"]["verdict"] = "FAIL"; }).find("laplacian"),
        std::string::npos);
    EXPECT_NE(
        refusal([](ResultTree& t) { t["studies"][0]["fit"]["verdict"] = "INCONCLUSIVE"; }).find("isph_dfs"),
        std::string::npos);
    EXPECT_EQ(refusal([](ResultTree& t) {
                  t["studies"][0]["fit"]["verdict"] = "INCONCLUSIVE";
                  t["studies"][0]["fit"]["waiver"] = "known";
              }),
              "");
    EXPECT_NE(refusal([](ResultTree& t) {
                  t["operator_properties"][0]["passes"] = false;
              }).find("exact for linears"),
              std::string::npos);
    EXPECT_NE(refusal([](ResultTree& t) { t["published_figures"][0]["agrees"] = false; }).find("XU-LAP"),
              std::string::npos);
    EXPECT_NE(refusal([](ResultTree& t) { t["provenance"]["interrupted"] = true; }).find("interrupted"),
              std::string::npos);
    EXPECT_NE(refusal([](ResultTree& t) { t["provenance"]["tree_clean"] = false; }).find("--allow-dirty"),
              std::string::npos);
    // A disagreement that is known must stay one: if it agrees, its waiver has to go.
    EXPECT_NE(refusal([](ResultTree& t) { t["published_figures"][1]["agrees"] = true; }).find("XU-ODD"),
              std::string::npos);
}

TEST(Bless, RefusesARunThatLostWhatItClaims) {
    EXPECT_NO_THROW(reduced_for_baseline(with_runs("momentum", "")));
    EXPECT_THROW(reduced_for_baseline(with_runs("momentum", "momentum")), UserError);
}

TEST(Bless, KeepsWhetherTheTreeWasClean) {
    EXPECT_EQ(reduced_for_baseline(result())["provenance"]["tree_clean"], true);
    ResultTree dirty = result();
    dirty["provenance"]["tree_clean"] = false;
    EXPECT_EQ(reduced_for_baseline(dirty, true)["provenance"]["tree_clean"], false);
}

} // namespace
} // namespace sphvv::verification
