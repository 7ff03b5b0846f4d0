// From samples to verdicts, without running anything: synthetic runs with a known answer.
#include "sphvv/analytic/solutions.hpp"
#include "sphvv/verification/claims.hpp"
#include "sphvv/verification/document.hpp"
#include "sphvv/verification/scene.hpp"
#include "sphvv/verification/study.hpp"
#include "sphvv/verification/table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <random>
#include <set>

namespace sphvv::verification {
namespace {

const solver::Scheme& scheme(const char* name) {
    return solver::schemes::find(name);
}

const Expectation* expectation_of(const char* name, const char* field,
                                  const solver::Assignments& given = {}) {
    const SceneRecord scene =
        resolve_scene(cases::find("taylor_green"), &solver::schemes::find(name), given, 20);
    return find_expectation(*scene.flow, name, field, scene.case_settings, scene.scheme_settings);
}

solver::Settings settings_of(const Case& flow, const solver::Assignments& given = {}) {
    return solver::Settings(case_keys(flow), given);
}

/// Runs of one scheme whose L2 errors of both fields are `error(h)`.
template <class Error>
std::vector<RunRecord> synthetic_runs(const std::string& name, const std::vector<int>& ladder,
                                      Error&& error) {
    std::vector<RunRecord> runs;
    for (const int n : ladder) {
        RunRecord run;
        run.scheme = name;
        run.n = n;
        run.dx = 1.0 / n;
        run.h = 1.3 / n;
        run.particles = static_cast<std::size_t>(n) * n;
        run.survived = true;
        run.steps = n;
        run.seconds = 1e-3 * n;
        run.work.pair_evaluations = n * n;
        const double e = error(run.h);
        for (const char* field : {"velocity", "pressure"}) {
            run.errors.push_back({field, {e, e, e, e, e, e, true}});
        }
        runs.push_back(run);
    }
    return runs;
}

/// The verdict on the velocity of isph_dfs on taylor_green at Re = 100 for these runs.
FieldStudy judged(const std::vector<RunRecord>& runs, const char* name = "isph_dfs") {
    const Case& flow = cases::find("taylor_green");
    const SceneRecord scene = resolve_scene(flow, &scheme(name), {}, 20);
    return judge_runs({&scene, 1}, runs, Axis::space).front();
}

LadderResult result_of(FieldStudy study) {
    LadderResult result{
        {&cases::find("taylor_green"), {&scheme("isph_dfs")}, {}, {20, 40, 80, 160}, "command"},
        "taylor_green re=100",
        {},
        {},
        {},
        {}};
    result.studies.push_back(std::move(study));
    return result;
}

const std::vector<int> ladder{20, 40, 80, 160};

TEST(Verdicts, FirstOrderPassesAndExitsZero) {
    const FieldStudy study = judged(synthetic_runs("isph_dfs", ladder, [](double h) { return h; }));
    EXPECT_EQ(study.verdict, "PASS");
    EXPECT_EQ(exit_status(result_of(study)), 0);
}

TEST(Verdicts, WrongOrderFailsAndExitsOne) {
    const FieldStudy study =
        judged(synthetic_runs("isph_dfs", ladder, [](double h) { return std::sqrt(h); }));
    EXPECT_EQ(study.verdict, "FAIL");
    EXPECT_EQ(exit_status(result_of(study)), 1);
}

// house.md §7.11: another code's gate prints "correct" for a field without half of its kinetic energy.
TEST(Verdicts, HalfOfTheKineticEnergyMissingFails) {
    const double error = 1 - std::sqrt(0.5);
    const FieldStudy study = judged(synthetic_runs("isph_dfs", ladder, [&](double) { return error; }));
    EXPECT_EQ(study.verdict, "FAIL") << study.reason;
}

TEST(Verdicts, FloorIsInconclusiveAndExitsOne) {
    const FieldStudy study =
        judged(synthetic_runs("isph_dfs", ladder, [](double h) { return h * h + 2e-4; }));
    EXPECT_EQ(study.verdict, "INCONCLUSIVE");
    EXPECT_NE(study.reason.find("floor"), std::string::npos) << study.reason;
    EXPECT_EQ(exit_status(result_of(study)), 1);
}

// house.md §7.13: a tier that cannot decide says so.
TEST(Verdicts, NarrowLadderIsInconclusive) {
    const FieldStudy study = judged(synthetic_runs("isph_dfs", {20, 24, 28, 32}, [](double h) { return h; }));
    EXPECT_EQ(study.verdict, "INCONCLUSIVE");
    EXPECT_EQ(exit_status(result_of(study)), 1);
}

TEST(Verdicts, TwoRungsAreErrorsWithoutVerdict) {
    const FieldStudy study = judged(synthetic_runs("isph_dfs", {40, 80}, [](double h) { return h; }));
    EXPECT_EQ(study.verdict, "NONE");
    EXPECT_FALSE(study.fit.has_value());
    EXPECT_EQ(exit_status(result_of(study)), 0);
}

TEST(Verdicts, UnexpectedEarlyEndFailsAndExitsThree) {
    auto runs = synthetic_runs("isph_dfs", ladder, [](double h) { return h; });
    runs[2].survived = false;
    runs[2].diagnosis = "minimum spacing 0.1 dx at t = 0.5";
    runs[2].errors.clear();
    const FieldStudy study = judged(runs);
    EXPECT_EQ(study.verdict, "FAIL");
    EXPECT_NE(study.reason.find("minimum spacing"), std::string::npos);
    EXPECT_EQ(exit_status(result_of(study)), 3);
    EXPECT_FALSE(study.samples[2].norms.has_value());
    const std::string table = markdown(result_of(study));
    EXPECT_EQ(table.find("nan"), std::string::npos) << table;
    EXPECT_NE(table.find("n = 80 ended early"), std::string::npos);
}

TEST(Verdicts, ExpectedEarlyEndPassesOnlyIfEveryRungEnds) {
    auto runs = synthetic_runs("isph_df", ladder, [](double h) { return h; });
    for (RunRecord& run : runs) {
        run.survived = false;
        run.diagnosis = "arrangement lost";
        run.time = 0.24;
        run.minimum_spacing = 0.25;
        run.errors.clear();
    }
    EXPECT_EQ(judged(runs, "isph_df").verdict, "PASS");
    auto one_survives = runs;
    one_survives[1] = synthetic_runs("isph_df", {40}, [](double h) { return h; }).front();
    const FieldStudy study = judged(one_survives, "isph_df");
    EXPECT_EQ(study.verdict, "FAIL");
    EXPECT_NE(study.reason.find("n = 40"), std::string::npos) << study.reason;
    EXPECT_EQ(exit_status(result_of(study)), 1);
}

// Ladders in time: the abscissa is the step, the demand is the scheme's own declaration.

FieldStudy judged_in_time(double observed_order) {
    std::vector<SceneRecord> scenes;
    std::vector<RunRecord> runs;
    for (const double dt : {0.008, 0.004, 0.002, 0.001, 0.0005}) {
        scenes.push_back(resolve_scene(cases::find("taylor_green"), &scheme("isph_df"),
                                       {{"time_step", solver::shortest(dt)}}, 20));
        runs.push_back(
            synthetic_runs("isph_df", {20}, [&](double) { return std::pow(dt, observed_order); }).front());
        runs.back().time_step = runs.back().prescribed_time_step = dt;
    }
    return judge_runs(scenes, runs, Axis::time).front();
}

TEST(LaddersInTime, DemandTheOrderThatTheSchemeDeclares) {
    const FieldStudy first = judged_in_time(1);
    EXPECT_EQ(first.verdict, "PASS") << first.reason;
    EXPECT_EQ(first.axis, Axis::time);
    EXPECT_NEAR(first.fit->order, 1, 1e-12);
    ASSERT_EQ(first.samples.size(), 5U);
    EXPECT_GT(first.samples.front().time_step, first.samples.back().time_step);
    EXPECT_EQ(judged_in_time(0.5).verdict, "FAIL");
    EXPECT_EQ(judged_in_time(2).verdict, "FAIL") << "better than theory is wrong theory";
}

TEST(LaddersInTime, TakeOneResolutionAndSetTheStepThemselves) {
    LadderRequest request{
        &cases::find("taylor_green"), {&scheme("isph_df")}, {}, {20, 40}, "command", {0.01}};
    EXPECT_THROW(plan(request), UserError);
    request.ladder = {20};
    EXPECT_EQ(plan(request).size(), 1U);
    request.settings["time_step"] = "0.01";
    EXPECT_THROW(plan(request), UserError);
}

TEST(Variants, ReadBackAsTheirLabel) {
    EXPECT_EQ(variant_of("isph_dfs").label(), "isph_dfs");
    const Variant variant = variant_of("isph_dfs:shift_correction=none:arrangement=settled");
    EXPECT_EQ(variant.scheme, &scheme("isph_dfs"));
    EXPECT_EQ(variant.settings,
              (solver::Assignments{{"arrangement", "settled"}, {"shift_correction", "none"}}));
    EXPECT_EQ(variant_of(variant.label()), variant);
    for (const char* wrong : {"isph_dfs:", "isph_dfs:a", "isph_dfs:=1", "isph_dfs:a=", "isph_dfs:a=1:a=2",
                              "no_scheme", "", ":a=1"}) {
        EXPECT_THROW(variant_of(wrong), UserError) << wrong;
    }
}

// Its own settings win over those of the ladder, reach case and scheme, and must exist there.
TEST(Variants, SetWhatTheirScenesAreMadeOf) {
    const Case& flow = cases::find("taylor_green");
    LadderRequest request{&flow,
                          {&scheme("isph_dfs"), variant_of("isph_dfs:re=10:h_over_dx=1.5")},
                          {{"re", "100"}},
                          {20, 40},
                          "command"};
    const std::vector<SceneRecord> scenes = plan(request);
    ASSERT_EQ(scenes.size(), 4U);
    EXPECT_EQ(scenes[0].label, "isph_dfs");
    EXPECT_EQ(scenes[0].case_settings.number("re"), 100);
    EXPECT_EQ(scenes[2].label, "isph_dfs:h_over_dx=1.5:re=10");
    EXPECT_EQ(scenes[2].case_settings.number("re"), 10);
    EXPECT_EQ(scenes[2].scheme_settings.number("h_over_dx"), 1.5);
    request.schemes = {variant_of("isph_dfs:gamma=7"), &scheme("wcsph")};
    EXPECT_THROW(plan(request), UserError) << "a key of another scheme of the ladder";
}

// The expectations of a scheme hold for the variants that their conditions admit.
TEST(Variants, AreJudgedApartUnderTheirLabels) {
    const Case& flow = cases::find("taylor_green");
    const char* euler = "isph_mls:integrator=euler";
    const std::vector<SceneRecord> scenes{resolve_scene(flow, &scheme("isph_mls"), {}, 20),
                                          resolve_scene(flow, variant_of(euler), {}, 20)};
    std::vector<RunRecord> runs =
        synthetic_runs("isph_mls", {20, 40, 80, 160}, [](double h) { return h * h; });
    const auto slower = synthetic_runs(euler, {20, 40, 80, 160}, [](double h) { return h; });
    runs.insert(runs.end(), slower.begin(), slower.end());
    const std::vector<FieldStudy> studies = judge_runs(scenes, runs, Axis::space);
    ASSERT_EQ(studies.size(), 4U);
    EXPECT_EQ(studies[0].scheme, "isph_mls");
    EXPECT_EQ(studies[0].verdict, "PASS") << studies[0].reason;
    EXPECT_NEAR(studies[0].fit->order, 2, 1e-9);
    EXPECT_EQ(studies[2].scheme, euler);
    EXPECT_EQ(studies[2].verdict, "PASS") << studies[2].reason;
    EXPECT_NEAR(studies[2].fit->order, 1, 1e-9);
    EXPECT_FALSE(studies[3].expectation) << "nothing is derived for the pressure of Euler's";
}

TEST(Claims, MeasureOrdersAndWork) {
    std::vector<RunRecord> runs = synthetic_runs("a", {10, 20, 40, 80, 160}, [](double h) { return h * h; });
    for (RunRecord& run : runs) {
        run.work.pair_evaluations = 70 * run.n;
        run.work.matrix_entries = 30 * run.n;
    }
    EXPECT_NEAR(*fitted_order(runs, "a", "velocity", 10), 2, 1e-9);
    EXPECT_FALSE(fitted_order(runs, "a", "velocity", 20)) << "four rungs of five";
    EXPECT_NEAR(*fitted_order(runs, "a", "velocity", 20, 4), 2, 1e-9);
    EXPECT_FALSE(fitted_order(runs, "b", "velocity", 10));
    const double h = 1.3 / 30; // between the rungs
    EXPECT_NEAR(*work_at_error(runs, "a", h * h), 3000, 1e-6);
    EXPECT_FALSE(work_at_error(runs, "a", 1)) << "no extrapolation to coarser rungs";
    EXPECT_FALSE(work_at_error(runs, "a", 1e-9));
    std::vector<RunRecord> seeds;
    for (const RunRecord& run : runs) {
        for (const int seed : {1, 2}) {
            seeds.push_back(run);
            seeds.back().seed = static_cast<std::uint64_t>(seed);
            seeds.back().errors[0].norms.l2 *= seed;
        }
    }
    EXPECT_NEAR(*fitted_order(seeds, "a", "velocity", 10), 2, 1e-9) << "seeds are not rungs";
    EXPECT_NEAR(*work_at_error(seeds, "a", h * h), 3000, 1e-6);
    runs[2].survived = false;
    EXPECT_FALSE(fitted_order(runs, "a", "velocity", 10));
}

/// Runs of every scheme that a study of the case has, on every rung, whose results are drawn at random.
std::vector<RunRecord> random_world(const Case& flow, std::mt19937_64& engine) {
    const auto uniform = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(engine() >> 11U) * 0x1p-53;
    };
    std::set<std::string> labels;
    for (const Study& study : flow.studies) {
        for (const std::string& text : study.schemes) {
            labels.insert(variant_of(text).label());
        }
    }
    std::vector<RunRecord> runs;
    for (const std::string& label : labels) {
        const std::array<double, 2> order{uniform(0, 3), uniform(0, 3)};
        const std::array<double, 2> level{std::pow(10, uniform(-4, 0)), std::pow(10, uniform(-4, 0))};
        const bool survives = uniform(0, 1) < 0.85;
        const double speed = uniform(-0.1, 0.1);
        const double cost = std::pow(10, uniform(-4, 0));
        const double disorder = uniform(0, 0.2);
        const double growth = uniform(0.5, 2.5);
        for (RunRecord run : synthetic_runs(label, {20, 28, 30, 32, 40, 56, 80, 112, 160, 200, 240},
                                            [](double h) { return h; })) {
            const double share = std::pow(20. / run.n, 1);
            for (int f = 0; f < 2; ++f) {
                run.errors[f].norms.l2 = level[f] * std::pow(share, order[f]);
            }
            for (const std::string& name : compared_names(flow)) {
                if (std::ranges::find(run.errors, name, &FieldError::field) == run.errors.end()) {
                    FieldError error = run.errors[1];
                    error.field = name;
                    error.norms.l2 = std::pow(10, uniform(-6, 1));
                    run.errors.push_back(error);
                }
            }
            for (FieldError& error : run.errors) {
                error.norms.linf = error.norms.l2 * uniform(1, 3);
            }
            run.minimum_spacing = uniform(0, 1);
            Deviation end{};
            end.errors = run.errors;
            end.minimum_spacing = run.minimum_spacing;
            end.maximum_speed_exact = 1;
            end.maximum_speed = 1 + speed * share * uniform(0.5, 1);
            run.maximum_speed_error = end.maximum_speed - 1;
            run.survived = survives;
            run.time = survives ? 1 : uniform(0.2, 0.3);
            end.time = run.time;
            run.history = {end};
            if (!survives) {
                run.errors.clear();
            }
            run.seconds = cost * run.n;
            run.work.pair_evaluations = static_cast<std::int64_t>(1e6 * cost * std::pow(run.n, growth));
            run.budget.momentum_drift = std::pow(10, uniform(-18, -6));
            run.budget.energy_drift = std::pow(10, uniform(-9, 0));
            run.settings = {{"kernel", "quintic_spline"}};
            Picture picture;
            picture.box = {0, 1, 0, 1};
            for (int k = 0; k < 36; ++k) {
                picture.x.push_back((k % 6 + disorder * uniform(0, 1)) / 6);
                picture.y.push_back((k / 6 + disorder * uniform(0, 1)) / 6);
            }
            run.h = 1.3 / run.n;
            run.picture = picture;
            if (flow.profile_direction >= 0) {
                for (const std::string& name : flow.fields) {
                    const double error = std::pow(10, uniform(-4, 0));
                    Profile profile{name, {}, {}, {}};
                    for (int k = 0; k < 20; ++k) {
                        profile.coordinate.push_back((k + 0.5) / 20);
                        profile.exact.push_back(1);
                        profile.ours.push_back(1 + error * uniform(-0.5, 1));
                    }
                    run.profiles.push_back(profile);
                }
            }
            runs.push_back(run);
        }
    }
    return runs;
}

// house.md §7.10: no claim agrees, or disagrees, whatever the runs say. One that no run of its studies could
// measure would be found, too.
TEST(Claims, CanAllBeMetAndMissed) {
    for (const Case* flow : cases::all()) {
        std::map<const Claim*, std::set<bool>> outcomes;
        std::mt19937_64 engine(20261123);
        const auto decided = [&](const Claim& claim) { return outcomes[&claim].size() == 2; };
        for (int world = 0; world < 2000 && !std::ranges::all_of(flow->claims, decided); ++world) {
            const std::vector<RunRecord> runs = random_world(*flow, engine);
            for (const Claim& claim : flow->claims) {
                if (outcomes[&claim].size() < 2) {
                    if (const auto finding = claim.measure(runs)) {
                        outcomes[&claim].insert(finding->agrees);
                        EXPECT_FALSE(finding->ours.empty());
                    }
                }
            }
        }
        for (const Claim& claim : flow->claims) {
            EXPECT_EQ(outcomes[&claim].size(), 2U) << claim.id << ": " << claim.text << " is always "
                                                   << (outcomes[&claim].empty()    ? "silent"
                                                       : *outcomes[&claim].begin() ? "met"
                                                                                   : "missed");
        }
    }
}

// A run that died supports no claim of accuracy, smoothness or cost.
TEST(Claims, AreNotMetByRunsThatDied) {
    const Case& flow = cases::find("taylor_green");
    std::mt19937_64 engine(20261124);
    const std::set<std::string> fates{"XU-TG, Re 100 and 1000", "ASAI, volume"};
    for (int world = 0; world < 50; ++world) {
        std::vector<RunRecord> runs = random_world(flow, engine);
        for (RunRecord& run : runs) {
            run.survived = false;
            run.errors.clear();
        }
        for (const Claim& claim : flow.claims) {
            const bool conserves = claim.id.ends_with("pairing") || claim.id.ends_with("momentum");
            if (const auto finding = claim.measure(runs);
                finding && !conserves && !fates.contains(claim.id)) {
                EXPECT_FALSE(finding->agrees) << claim.id << ": " << finding->ours;
            }
        }
    }
}

// Real runs of two integrators of the same equations: their orders are known, and they are told apart.
TEST(LaddersInTime, TellAFirstOrderIntegratorFromASecondOrderOne) {
    for (const auto& [integrator, order] : {std::pair{"explicit", 1.}, {"predictor_corrector", 2.}}) {
        const LadderRequest request{&cases::find("taylor_green"),
                                    {&scheme("wcsph")},
                                    {{"re", "10"}, {"end_time", "0.016"}, {"integrator", integrator}},
                                    {12},
                                    "command",
                                    {0.002, 0.001, 0.0005, 0.00025}};
        const LadderResult result = run_ladder(request);
        ASSERT_EQ(result.studies.size(), 2U);
        for (const FieldStudy& study : result.studies) {
            EXPECT_EQ(study.verdict, "PASS") << integrator << ", " << study.field << ": " << study.reason;
            EXPECT_NEAR(study.fit->order, order, 0.2);
        }
        EXPECT_TRUE(result.fronts.empty());
    }
}

// house.md §7.8: a waiver changes the exit status only, and is printed wherever the verdict is.
TEST(Verdicts, WaiverIsPrintedWithTheFailure) {
    Expectation waived = *expectation_of("isph_dfs", "velocity");
    waived.waiver = "known: issue 0";
    FieldStudy study = judged(synthetic_runs("isph_dfs", ladder, [](double h) { return std::sqrt(h); }));
    study.expectation = waived;
    EXPECT_EQ(study.verdict, "FAIL");
    EXPECT_EQ(exit_status(result_of(study)), 0);
    EXPECT_NE(verdict_line(study).find("FAIL (waived: known: issue 0)"), std::string::npos);
    LadderResult result = result_of(study);
    const LadderResult results[] = {result};
    const auto document = result_document("sphvv verify", current_provenance(), 1, results);
    EXPECT_EQ(document["studies"][0]["fit"]["waiver"], "known: issue 0");
    EXPECT_EQ(document["studies"][0]["fit"]["verdict"], "FAIL");
}

// A run that is expected to end early passes only if it ends as theory has it.
TEST(Verdicts, AnEarlyEndMustBeTheExpectedOne) {
    const auto ended = [](double time, double spacing, bool survived) {
        std::vector<RunRecord> runs = synthetic_runs("isph_df", ladder, [](double) { return 1.0; });
        for (RunRecord& run : runs) {
            run.survived = survived;
            run.diagnosis = survived ? "" : "made up";
            run.time = time;
            run.minimum_spacing = spacing;
            if (!survived) {
                run.errors.clear();
            }
        }
        return judged(runs, "isph_df");
    };
    EXPECT_EQ(ended(0.24, 0.25, false).verdict, "PASS");
    EXPECT_NE(ended(0.24, 0.25, false).reason.find("t = 0.24, smallest spacing 0.25 dx"), std::string::npos);
    EXPECT_EQ(ended(1, 0.25, true).verdict, "FAIL") << "survived";
    const FieldStudy at_once = ended(0.01, 0.98, false);
    EXPECT_EQ(at_once.verdict, "FAIL") << "a fault that ends a run in its first steps";
    EXPECT_NE(at_once.reason.find("made up"), std::string::npos);
    EXPECT_TRUE(at_once.ended_unexpectedly);
    EXPECT_EQ(ended(0.24, 0.8, false).verdict, "FAIL") << "not squeezed";
    EXPECT_EQ(ended(0.05, 0.3, false).verdict, "FAIL") << "too early";
}

// A goal of the project is no mere remark.
TEST(Verdicts, AMissedGoalFailsTheLadder) {
    LadderResult result{};
    const Claim goal{
        .id = "goal", .text = "", .published = "", .source = "", .where = {}, .measure = {}, .binding = true};
    const Claim remark{.id = "remark", .text = "", .published = "", .source = "", .where = {}, .measure = {}};
    result.claims = {{&goal, {"", true}}, {&remark, {"", false}}};
    EXPECT_EQ(exit_status(result), 0);
    result.claims[0].finding.agrees = false;
    EXPECT_EQ(exit_status(result), 1);
}

// A waiver for one start arrangement must not reach the others.
TEST(Verdicts, AConditionOnAWordHoldsForThatWordOnly) {
    EXPECT_FALSE(expectation_of("wcsph", "velocity", {{"arrangement", "jittered"}})->waiver.empty());
    EXPECT_TRUE(expectation_of("wcsph", "velocity")->waiver.empty());
}

// Non-convergence that theory predicts passes, but never reads as accuracy.
TEST(Verdicts, ExpectedStagnationIsNamed) {
    const FieldStudy study = judged(synthetic_runs("wcsph", ladder, [](double) { return 0.77; }), "wcsph");
    EXPECT_EQ(study.verdict, "PASS");
    EXPECT_NE(study.reason.find("does not converge here, its finest L2 error is 0.77"), std::string::npos)
        << study.reason;
    EXPECT_EQ(judged(synthetic_runs("wcsph", ladder, [](double h) { return h; }), "wcsph").verdict, "FAIL");
}

TEST(Verdicts, SeedsAreRepeatsOfARungNotRungs) {
    std::vector<RunRecord> runs;
    for (int seed = 1; seed <= 5; ++seed) {
        for (RunRecord run :
             synthetic_runs("isph_dfs", ladder, [&](double h) { return h * (1 + 0.01 * seed); })) {
            run.seed = static_cast<std::uint64_t>(seed);
            runs.push_back(run);
        }
    }
    const FieldStudy study = judged(runs);
    EXPECT_EQ(study.samples.size(), 4U);
    EXPECT_EQ(study.samples[0].seeds, 5);
    EXPECT_NEAR(study.samples[0].l2_spread, 1.05 / 1.01 - 1, 1e-12);
    EXPECT_NEAR(study.fit->order, 1, 1e-12);
    EXPECT_EQ(study.verdict, "PASS");
}

// house.md §7.7: every band comes with a source and a reason, and excludes something.
TEST(Cases, EveryExpectationHasBandReasonAndSource) {
    for (const Case* flow : cases::all()) {
        for (const Expectation& e : flow->expectations) {
            SCOPED_TRACE(std::string(flow->name) + " " + e.scheme + " " + e.field);
            EXPECT_FALSE(e.order.source.empty());
            EXPECT_FALSE(e.text.empty());
            EXPECT_EQ(e.ends_early.has_value(), !e.order.low && !e.order.high);
            const solver::Settings of_scheme(solver::schemes::find(e.scheme).keys, {});
            for (const Condition& condition : e.where) {
                EXPECT_NO_THROW(applies({&condition, 1}, settings_of(*flow), of_scheme));
            }
        }
    }
}

// house.md §7.12 and §7.9: the start arrangement is an axis, and random ones run on five fixed seeds.
TEST(Cases, ArrangementIsAnAxisAndSeedsAreFixed) {
    const Case& flow = cases::find("taylor_green");
    bool jittered = false;
    for (const Study& study : flow.studies) {
        jittered = jittered || (study.tier == Tier::quick && study.settings.count("arrangement") == 1);
    }
    EXPECT_TRUE(jittered) << "the quick tier runs from the lattice only";
    const LadderRequest request{
        &flow, {&scheme("isph_dfs")}, {{"arrangement", "jittered"}}, {20, 40}, "command"};
    std::set<std::uint64_t> seeds;
    for (const SceneRecord& scene : plan(request)) {
        seeds.insert(scene.seed);
    }
    EXPECT_EQ(seeds, (std::set<std::uint64_t>{1, 2, 3, 4, 5}));
}

TEST(Cases, EveryStudyCanBePlanned) {
    for (const Case* flow : cases::all()) {
        ASSERT_FALSE(flow->studies.empty());
        for (const Study& study : flow->studies) {
            LadderRequest request{flow, {}, study.settings, study.ladder, "quick", study.time_steps};
            for (const std::string& name : study.schemes) {
                request.schemes.push_back(variant_of(name));
            }
            EXPECT_NO_THROW(plan(request)) << study.name;
            EXPECT_GT(study.cost, 0) << study.name;
            for (const std::string& name : study.chaotic) { // or its width would be of no run
                EXPECT_TRUE(std::ranges::count(study.schemes, name)) << study.name << ": " << name;
            }
        }
    }
}

TEST(Cases, TheListMatchesTheFiles) {
    std::set<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(SPHVV_CASES)) {
        files.insert(entry.path().stem());
    }
    std::set<std::string> names;
    for (const Case* flow : cases::all()) {
        names.insert(std::string(flow->name));
        EXPECT_NO_THROW(analytic::solutions::find(flow->solution));
    }
    EXPECT_EQ(files, names);
}

TEST(Scenes, WrongKeyNamesWhatBothTake) {
    try {
        resolve_scene(cases::find("taylor_green"), &scheme("wcsph"), {{"reynolds", "100"}}, 20);
        FAIL();
    } catch (const UserError& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find("'reynolds'"), std::string::npos);
        EXPECT_NE(text.find("re, "), std::string::npos);
        EXPECT_NE(text.find("c0_over_u"), std::string::npos);
    }
}

TEST(Scenes, TooCoarseNamesTheSmallestResolution) {
    SceneRecord scene = resolve_scene(cases::find("taylor_green"), &scheme("isph_dfs"), {}, 7);
    EXPECT_THROW(check_scene(scene), UserError); // 2 x 3.9 dx does not fit into 7 dx
    scene.n = 8;
    EXPECT_NO_THROW(check_scene(scene));
    scene.n = 3;
    try {
        check_scene(scene);
        FAIL();
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("n >= 8"), std::string::npos) << error.what();
    }
    scene.n = 100000;
    EXPECT_THROW(check_scene(scene), UserError);
}

// The probe compares at the current positions and time: particles that carry the exact solution have no
// error.
TEST(Runs, StartIsExactAndErrorsAreReported) {
    SceneRecord scene = resolve_scene(cases::find("taylor_green"), &scheme("isph_dfs"),
                                      {{"end_time", "0.02"}, {"arrangement", "jittered"}}, 16);
    const RunRecord run = run_scene(scene);
    ASSERT_TRUE(run.survived) << run.diagnosis;
    EXPECT_EQ(run.time, 0.02);
    ASSERT_EQ(run.errors.size(), 2U);
    EXPECT_GT(run.errors[0].norms.l2, 0);
    EXPECT_LT(run.errors[0].norms.l2, 0.1);
    EXPECT_LE(run.errors[0].norms.l1_abs, run.errors[0].norms.l2_abs);
    EXPECT_LE(run.errors[0].norms.l2_abs, run.errors[0].norms.linf_abs);
    EXPECT_EQ(run.repeats, 3);
    EXPECT_EQ(run.work.particle_steps, run.steps * 256);
}

TEST(Runs, DifferentSeedsDifferAndTheSameSeedRepeats) {
    SceneRecord scene = resolve_scene(cases::find("taylor_green"), &scheme("wcsph"),
                                      {{"end_time", "0.01"}, {"arrangement", "jittered"}}, 12);
    const double first = run_scene(scene).errors[0].norms.l2;
    EXPECT_EQ(first, run_scene(scene).errors[0].norms.l2);
    scene.seed = 2;
    EXPECT_NE(first, run_scene(scene).errors[0].norms.l2);
}

// 2-D Taylor-Green vortices carry no momentum and lose energy to viscosity alone, 16 pi^2 nu t of it at
// first.
TEST(Runs, BudgetsOfMomentumEnergyAndTorque) {
    const auto run = [](const char* of, const solver::Assignments& more) {
        solver::Assignments given{{"end_time", "0.05"}, {"arrangement", "jittered"}, {"re", "1000"}};
        given.insert(more.begin(), more.end());
        return run_scene(resolve_scene(cases::find("taylor_green"), &scheme(of), given, 20));
    };
    const RunRecord variational = run("wcsph", {{"integrator", "predictor_corrector"}});
    const Budget& budget = variational.budget;
    EXPECT_LT(budget.momentum_drift, 1e-15);
    ASSERT_TRUE(budget.elastic_energy_start && budget.elastic_energy_end && budget.internal_torque);
    EXPECT_NEAR(budget.kinetic_energy_start, 250, 5); // 1000 kg/m3 at a mean square of (1 m/s)^2/2
    EXPECT_DOUBLE_EQ(budget.energy_drift, (budget.kinetic_energy_end + *budget.elastic_energy_end -
                                           budget.kinetic_energy_start - *budget.elastic_energy_start) /
                                              budget.kinetic_energy_start);
    // The viscous loss cannot exceed some times that of the smooth flow; disorder adds to it.
    const double smooth = 16 * 9.87 * 1e-3 * 0.05;
    EXPECT_LT(budget.energy_drift, -0.5 * smooth);
    EXPECT_GT(budget.energy_drift, -10 * smooth);
    EXPECT_GT(*budget.elastic_energy_end - *budget.elastic_energy_start, 0) << "disorder makes sound";

    const RunRecord other = run("wcsph", {{"pressure_force", "difference"}});
    EXPECT_GT(other.budget.momentum_drift, 1e-8);

    const RunRecord projected = run("isph_dfs", {});
    EXPECT_FALSE(projected.budget.elastic_energy_start || projected.budget.internal_torque);
    EXPECT_NEAR(projected.budget.energy_drift,
                projected.budget.kinetic_energy_end / projected.budget.kinetic_energy_start - 1,
                1e-15); // of the quotient, near 1
}

TEST(Runs, BudgetsStandInTheDocument) {
    LadderResult result = result_of(judged(synthetic_runs("isph_dfs", ladder, [](double h) { return h; })));
    RunRecord run;
    run.scheme = "isph_dfs";
    run.budget = {.momentum_drift = 0.125,
                  .kinetic_energy_start = 4,
                  .kinetic_energy_end = 3,
                  .elastic_energy_start = {},
                  .elastic_energy_end = 2,
                  .energy_drift = std::nan(""),
                  .internal_torque = 0.5,
                  .claims = "momentum, energy",
                  .lost = "momentum"};
    EXPECT_EQ(exit_status(result), 0);
    run.survived = true;
    result.runs.push_back(run);
    const LadderResult results[] = {result};
    const auto document = result_document("sphvv verify", current_provenance(), 1, results);
    EXPECT_EQ(
        document["runs"][0]["budget"].dump(),
        R"({"momentum_drift":0.125,"kinetic_energy_start":4.0,"kinetic_energy_end":3.0,)"
        R"("elastic_energy_start":null,"elastic_energy_end":2.0,"energy_drift":null,"internal_torque":0.5,)"
        R"("claims":"momentum, energy","lost":"momentum"})");
    EXPECT_EQ(exit_status(result), 1) << "what a scheme claims to conserve was lost";
}

TEST(Fronts, WorkIsPairEvaluationsAndMatrixEntries) {
    const LadderRequest request{&cases::find("taylor_green"),
                                {&scheme("isph_df"), &scheme("wcsph")},
                                {{"re", "10"}, {"end_time", "0.01"}},
                                {12, 16},
                                "command"};
    const LadderResult result = run_ladder(request);
    ASSERT_EQ(result.fronts.size(), 4U); // two fields, two costs
    EXPECT_EQ(result.fronts[0].cost, "seconds");
    const Front& front = result.fronts[1];
    EXPECT_EQ(front.cost, "work");
    ASSERT_EQ(front.curves.size(), 2U);
    for (std::size_t scheme_index = 0; scheme_index < 2; ++scheme_index) {
        for (std::size_t rung = 0; rung < 2; ++rung) {
            const RunRecord& run = result.runs[2 * scheme_index + rung];
            EXPECT_EQ(front.curves[scheme_index].cost[rung], work_of(run));
            EXPECT_EQ(run.work.matrix_entries > 0, scheme_index == 0);
        }
    }
}

// A settled start: the tile of the seed, which must fit the box.
TEST(Runs, SettledStartsRepeatATile) {
    const Case& flow = cases::find("taylor_green");
    const SceneRecord scene = resolve_scene(flow, &scheme("isph_dfs"), {{"arrangement", "settled"}}, 40);
    const solver::Simulation<2> simulation = build_scene<2>(scene);
    ASSERT_EQ(simulation.particles.size(), 1600U);
    solver::Simulation<2> lattice = build_scene<2>(resolve_scene(flow, &scheme("isph_dfs"), {}, 40));
    EXPECT_NE(simulation.particles.position.components, lattice.particles.position.components);
    const solver::Box<2>& box = simulation.box;
    std::array<double, 2> mean{};
    for (std::size_t i = 0; i < simulation.particles.size(); ++i) {
        for (int d = 0; d < 2; ++d) {
            const double x = simulation.particles.position.components[d][i];
            ASSERT_GE(x, box.low[d]);
            ASSERT_LT(x, box.high[d]);
            mean[d] += (x - box.low[d]) / 1600;
        }
    }
    EXPECT_NEAR(mean[0], 0.5, 0.02) << "the whole box is filled";
    EXPECT_NEAR(mean[1], 0.5, 0.02);
    SceneRecord other = scene;
    other.seed = 2;
    EXPECT_NE(build_scene<2>(other).particles.position.components, simulation.particles.position.components);
    other.n = 30;
    EXPECT_THROW(check_scene(other), UserError) << "no multiple of the tile";
    EXPECT_EQ(plan({&flow, {&scheme("isph_dfs")}, {{"arrangement", "settled"}}, {20}, "command"}).size(), 5U);
}

// Forty marks and the end; the last entry is what the errors are taken from.
TEST(Runs, KeepTheirHistoryAndWhereAskedTheirParticles) {
    SceneRecord scene = resolve_scene(cases::find("taylor_green"), &scheme("wcsph"),
                                      {{"end_time", "0.5"}, {"minimum_spacing", "0"}}, 12);
    scene.picture = true;
    const RunRecord run = run_scene(scene);
    ASSERT_TRUE(run.survived) << run.diagnosis;
    ASSERT_GE(run.history.size(), 20U);
    ASSERT_LE(run.history.size(), 41U);
    for (std::size_t k = 1; k < run.history.size(); ++k) {
        EXPECT_GT(run.history[k].time, run.history[k - 1].time);
    }
    EXPECT_EQ(run.history.back().time, run.time);
    EXPECT_EQ(run.history.back().find("velocity")->l2, run.errors[0].norms.l2);
    EXPECT_EQ(run.history.back().find("pressure")->l2, run.errors[1].norms.l2);
    EXPECT_DOUBLE_EQ(run.history.back().maximum_speed / run.history.back().maximum_speed_exact - 1,
                     run.maximum_speed_error);
    ASSERT_TRUE(run.picture);
    EXPECT_EQ(run.picture->time, run.time);
    EXPECT_EQ(run.picture->x.size(), 144U);
    EXPECT_EQ(run.picture->pressure.size(), 144U);
    EXPECT_DOUBLE_EQ(*std::max_element(run.picture->speed.begin(), run.picture->speed.end()),
                     run.history.back().maximum_speed);
    scene.picture = false;
    EXPECT_FALSE(run_scene(scene).picture);

    LadderResult result = result_of(judged(synthetic_runs("isph_dfs", ladder, [](double h) { return h; })));
    result.runs = {run};
    const LadderResult results[] = {result};
    const auto document = result_document("sphvv verify", current_provenance(), 1, results);
    EXPECT_EQ(document["runs"][0]["history"].size(), run.history.size());
    EXPECT_EQ(document["runs"][0]["history"].back()["l2_velocity"], run.errors[0].norms.l2);
    EXPECT_EQ(document["runs"][0]["picture"]["x"].size(), 144U);
    EXPECT_EQ(document["runs"][0]["picture"]["box"], (std::vector<double>{-0.5, 0.5, -0.5, 0.5}));
}

// A run that ends early keeps its last state.
TEST(Runs, ALostArrangementEndsTheRunWithItsDiagnosis) {
    const SceneRecord scene = resolve_scene(cases::find("taylor_green"), &scheme("isph_df"), {}, 40);
    const RunRecord run = run_scene(scene);
    EXPECT_FALSE(run.survived);
    EXPECT_LT(run.time, 0.5);
    EXPECT_NE(run.diagnosis.find("particle"), std::string::npos) << run.diagnosis;
    EXPECT_NE(run.diagnosis.find("t = "), std::string::npos) << run.diagnosis;
    EXPECT_TRUE(run.errors.empty());
    EXPECT_EQ(run.history.back().time, run.time);
}

// verification.md §12: what each scheme's periodic scene carries, and nothing else.
TEST(Runs, ScenesAreLean) {
    const auto names = [](const char* of) {
        SceneRecord scene =
            resolve_scene(cases::find("taylor_green"), &scheme(of), {{"end_time", "0.01"}}, 12);
        const RunRecord run = run_scene(scene);
        std::set<std::string> fields;
        for (const auto& field : run.fields) {
            fields.insert(field.name);
        }
        return fields;
    };
    EXPECT_EQ(names("isph_df"), (std::set<std::string>{"position", "velocity", "pressure", "velocity_next",
                                                       "renormalisation"}));
    EXPECT_EQ(names("isph_dfs"), (std::set<std::string>{"position", "velocity", "pressure", "velocity_next",
                                                        "renormalisation", "shift_correction"}));
    EXPECT_EQ(names("wcsph"),
              (std::set<std::string>{"position", "velocity", "pressure", "density", "density_rate",
                                     "acceleration", "pressure_over_squared_density", "specific_volume"}));
}

} // namespace
} // namespace sphvv::verification
