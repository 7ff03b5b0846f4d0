#include "sphvv/verification/study.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <numeric>
#include <set>

namespace sphvv::verification {
namespace {

constexpr int seeds_of_random_starts = 5; // verification.md §3: at least five

std::string group_label(const LadderRequest& request, const SceneRecord& scene) {
    const std::string leading(request.flow->leading_key);
    std::string label = (request.study.empty() ? std::string(request.flow->name) : request.study) + " " +
                        leading + "=" + scene.case_settings.text(leading);
    for (const auto& [key, value] : request.settings) {
        if (key != leading) {
            label.append(" ").append(key).append("=").append(value);
        }
    }
    if (!request.time_steps.empty()) {
        label += " n=" + std::to_string(request.ladder.front()) + ", in time";
    }
    return label;
}

const FieldError* error_of(const RunRecord& run, const std::string& field) {
    const auto found = std::find_if(run.errors.begin(), run.errors.end(),
                                    [&](const FieldError& e) { return e.field == field; });
    return found == run.errors.end() ? nullptr : &*found;
}

double geometric_mean(const std::vector<double>& values) {
    const double total = std::accumulate(values.begin(), values.end(), 0.0,
                                         [](double sum, double value) { return sum + std::log(value); });
    return values.size() == 1 ? values[0] : std::exp(total / static_cast<double>(values.size()));
}

/// Mean of a member over the runs of one rung.
template <class Member>
double mean(const std::vector<const RunRecord*>& runs, Member&& member) {
    double total = 0;
    for (const RunRecord* run : runs) {
        total += static_cast<double>(member(*run));
    }
    return total / static_cast<double>(runs.size());
}

Sample sample_of(const std::vector<const RunRecord*>& runs, const std::string& field) {
    const RunRecord& first = *runs.front();
    Sample sample{};
    sample.n = first.n;
    sample.h = first.h;
    sample.dx = first.dx;
    sample.particles = first.particles;
    sample.seeds = static_cast<int>(runs.size());
    sample.repeats = first.repeats;
    sample.time_step = mean(runs, [](const RunRecord& r) { return r.time_step; });
    sample.steps = mean(runs, [](const RunRecord& r) { return r.steps; });
    sample.seconds = mean(runs, [](const RunRecord& r) { return r.seconds; });
    sample.seconds_spread = mean(runs, [](const RunRecord& r) { return r.seconds_spread; });
    sample.cpu_seconds = mean(runs, [](const RunRecord& r) { return r.cpu_seconds; });
    sample.pair_evaluations = mean(runs, [](const RunRecord& r) { return r.work.pair_evaluations; });
    sample.solver_iterations = mean(runs, [](const RunRecord& r) { return r.work.solver_iterations; });
    sample.matrix_entries = mean(runs, [](const RunRecord& r) { return r.work.matrix_entries; });
    sample.particle_steps = mean(runs, [](const RunRecord& r) { return r.work.particle_steps; });
    const auto lost = std::find_if(runs.begin(), runs.end(), [](const RunRecord* r) { return !r->survived; });
    sample.survived = lost == runs.end();
    if (!sample.survived) {
        sample.diagnosis = (*lost)->diagnosis;
        if (runs.size() > 1) {
            sample.diagnosis += " (seed " + std::to_string((*lost)->seed) + ")";
        }
        return sample;
    }
    const auto over_seeds = [&](double Norms::*norm) {
        std::vector<double> values;
        values.reserve(runs.size());
        for (const RunRecord* run : runs) {
            values.push_back(error_of(*run, field)->norms.*norm);
        }
        return values;
    };
    Norms norms = error_of(first, field)->norms;
    for (double Norms::*norm :
         {&Norms::l1, &Norms::l2, &Norms::linf, &Norms::l1_abs, &Norms::l2_abs, &Norms::linf_abs}) {
        norms.*norm = geometric_mean(over_seeds(norm));
    }
    sample.norms = norms;
    const std::vector<double> l2 = over_seeds(&Norms::l2);
    sample.l2_spread = *std::max_element(l2.begin(), l2.end()) / *std::min_element(l2.begin(), l2.end()) - 1;
    return sample;
}

double abscissa(const Sample& sample, Axis axis) {
    return axis == Axis::space ? sample.h : sample.time_step;
}

std::vector<double> pairwise_orders(const std::vector<Sample>& samples, double Norms::*norm, Axis axis) {
    std::vector<double> orders(samples.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t k = 1; k < samples.size(); ++k) {
        if (samples[k].norms && samples[k - 1].norms) {
            orders[k] = std::log((*samples[k - 1].norms).*norm / (*samples[k].norms).*norm) /
                        std::log(abscissa(samples[k - 1], axis) / abscissa(samples[k], axis));
        }
    }
    return orders;
}

std::string count_of(std::size_t count, const char* noun) {
    return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

/// "0.2" or "0.2…0.3"
std::string range_of(const std::vector<double>& values) {
    const auto [low, high] = std::ranges::minmax(values);
    char text[64];
    std::snprintf(text, sizeof text, low == high ? "%.3g" : "%.3g…%.3g", low, high);
    return text;
}

/// Runs that are expected to end early.
void judge_fate(FieldStudy& study, const std::vector<const RunRecord*>& runs) {
    const EarlyEnd& expected = *study.expectation->ends_early;
    std::vector<double> times;
    std::vector<double> spacings;
    for (const RunRecord* run : runs) {
        times.push_back(run->time);
        spacings.push_back(run->minimum_spacing);
        const std::string at = "the run at n = " + std::to_string(run->n);
        if (run->survived) {
            study.verdict = "FAIL";
            study.reason = at + " reached the end time, although it is expected to end early: ";
            study.reason += study.expectation->text;
            return;
        }
        if (run->time < expected.not_before || !(run->minimum_spacing <= expected.spacing)) {
            char text[160];
            std::snprintf(text, sizeof text,
                          " ended at t = %.3g with a smallest spacing of %.3g dx; expected: not before %.3g, "
                          "at most %.3g dx: ",
                          run->time, run->minimum_spacing, expected.not_before, expected.spacing);
            study.verdict = "FAIL";
            study.reason = at + text + run->diagnosis;
            study.ended_unexpectedly = true;
            return;
        }
    }
    study.verdict = "PASS";
    study.reason = "ended early on " + count_of(study.samples.size(), "rung") + " (t = " + range_of(times) +
                   ", smallest spacing " + range_of(spacings) + " dx), as expected: ";
    study.reason += study.expectation->text;
}

void judge_order(FieldStudy& study, const std::vector<Rung>& rungs) {
    if (study.samples.size() < 4) {
        study.verdict = "NONE";
        study.reason = count_of(study.samples.size(), "rung") + ": errors only, an order verdict needs 4";
        return;
    }
    const auto is_zero = [](const Rung& rung) {
        return std::ranges::find(rung.errors, 0.) != rung.errors.end();
    };
    if (std::ranges::any_of(rungs, is_zero)) {
        study.verdict = "NONE";
        study.reason = "an error is zero to the last bit: no order";
        return;
    }
    if (!study.expectation) {
        study.verdict = "NONE";
        study.reason = "no order is derived or published for this field of this scheme: observed only";
        study.fit = fit_order(rungs);
        return;
    }
    const Judgement judgement = judge(rungs, study.expectation->order);
    study.verdict = to_string(judgement.verdict);
    study.reason = judgement.reason;
    study.fit = judgement.fit;
    const Expected& band = study.expectation->order;
    if (judgement.verdict == Verdict::pass && band.high && *band.high <= 0.5) {
        // "As expected" must not read as "accurate".
        char text[80];
        std::snprintf(text, sizeof text, "; the scheme does not converge here, its finest L2 error is %.3g",
                      study.samples.back().norms->l2);
        study.reason += text;
    }
}

/// Runs of one scheme, from the coarsest rung to the finest: all seeds of a rung together.
std::map<double, std::vector<const RunRecord*>> rungs_of(std::span<const RunRecord> runs,
                                                         std::string_view scheme, Axis axis) {
    std::map<double, std::vector<const RunRecord*>> rungs;
    for (const RunRecord& run : runs) {
        if (run.scheme == scheme) {
            rungs[axis == Axis::space ? run.n : -run.prescribed_time_step].push_back(&run);
        }
    }
    return rungs;
}

FieldStudy judge_field(const std::string& label, const std::string& field, Axis axis,
                       std::optional<Expectation> expectation, std::span<const RunRecord> all_runs) {
    FieldStudy study{};
    study.scheme = label;
    study.field = field;
    study.axis = axis;
    study.expectation = std::move(expectation);
    std::vector<Rung> rungs;
    std::vector<const RunRecord*> of_label;
    for (const auto& [coarseness, runs] : rungs_of(all_runs, label, axis)) {
        of_label.insert(of_label.end(), runs.begin(), runs.end());
        const Sample& sample = study.samples.emplace_back(sample_of(runs, field));
        if (sample.survived) {
            Rung& rung = rungs.emplace_back(Rung{abscissa(sample, axis), {}});
            for (const RunRecord* run : runs) {
                rung.errors.push_back(error_of(*run, field)->norms.l2);
            }
        }
    }
    const auto lost = std::ranges::find(study.samples, false, &Sample::survived);
    study.order_l1 = pairwise_orders(study.samples, &Norms::l1, axis);
    study.order_l2 = pairwise_orders(study.samples, &Norms::l2, axis);
    study.order_linf = pairwise_orders(study.samples, &Norms::linf, axis);
    if (study.expectation && study.expectation->ends_early) {
        judge_fate(study, of_label);
    } else if (lost != study.samples.end()) {
        study.ended_unexpectedly = true;
        study.verdict = "FAIL";
        study.reason = "the run at n = " + std::to_string(lost->n) + " ended early: " + lost->diagnosis;
    } else {
        judge_order(study, rungs);
    }
    return study;
}

/// What a ladder in time must show: the order of the scheme's time marching, within what a finite step leaves
/// of the next order.
Expectation expectation_in_time(const solver::Scheme& scheme, const std::string& field,
                                const solver::Settings& settings) {
    const solver::TimeOrder theory = scheme.time_order(settings);
    return {.scheme = std::string(scheme.name),
            .field = field,
            .where = {},
            .order = {theory.order - 0.2, theory.order + 0.3, theory.source},
            .text =
                "differences from a run with a step 32 times finer than the finest, on the same particles",
            .waiver = theory.waiver};
}

void check_time_ladder(const LadderRequest& request) {
    if (request.ladder.size() != 1) {
        throw UserError("a ladder in time takes one resolution; give --n one number, not " +
                        std::to_string(request.ladder.size()));
    }
    const auto sets_it = [](const Variant& variant) { return variant.settings.contains("time_step"); };
    if (request.settings.contains("time_step") || std::ranges::any_of(request.schemes, sets_it)) {
        throw UserError("a ladder in time sets the key time_step itself; leave it out");
    }
}

std::vector<Front> fronts_of(const Case& flow, const std::vector<FieldStudy>& studies) {
    std::vector<Front> fronts;
    for (const std::string& field : compared_names(flow)) {
        for (const std::string cost : {"seconds", "work"}) {
            Front front{field, cost, {}, {}, {}};
            for (const FieldStudy& study : studies) {
                CostCurve curve{study.scheme, {}, {}};
                std::vector<int> n;
                for (const Sample& sample : study.samples) {
                    // An error that is zero to the last bit has no place on logarithmic axes.
                    if (study.field == field && sample.norms && sample.norms->l2 > 0) {
                        curve.error.push_back(sample.norms->l2);
                        curve.cost.push_back(cost == "seconds"
                                                 ? sample.seconds
                                                 : sample.pair_evaluations + sample.matrix_entries);
                        n.push_back(sample.n);
                    }
                }
                if (!n.empty()) {
                    front.curves.push_back(curve);
                    front.n.push_back(n);
                }
            }
            front.rows = cost_front(front.curves);
            fronts.push_back(std::move(front));
        }
    }
    return fronts;
}

} // namespace

std::vector<SceneRecord> plan(const LadderRequest& request) {
    std::vector<solver::Key> any_scheme;
    for (const Variant& variant : request.schemes) {
        const std::vector<solver::Key>& keys = variant.scheme->keys;
        any_scheme.insert(any_scheme.end(), keys.begin(), keys.end());
    }
    std::vector<SceneRecord> scenes;
    if (!request.time_steps.empty()) {
        check_time_ladder(request);
    }
    for (const Variant& variant : request.schemes) {
        for (const double time_step : request.time_steps) { // on the same particles: one seed
            solver::Assignments settings = request.settings;
            settings["time_step"] = solver::shortest(time_step);
            scenes.push_back(
                resolve_scene(*request.flow, variant, settings, request.ladder.front(), any_scheme));
            check_scene(scenes.back());
        }
        for (const int n : request.time_steps.empty() ? request.ladder : std::vector<int>{}) {
            SceneRecord scene = resolve_scene(*request.flow, variant, request.settings, n, any_scheme);
            const std::string& arrangement = scene.case_settings.word("arrangement");
            const bool random =
                arrangement == "jittered" || arrangement == "settled" || arrangement == "unstructured";
            check_scene(scene);
            for (int seed = 1; seed <= (random ? seeds_of_random_starts : 1); ++seed) {
                scene.seed = static_cast<std::uint64_t>(seed);
                scene.picture = n == request.picture_at && seed == 1;
                scenes.push_back(scene);
            }
        }
    }
    return scenes;
}

namespace {

/// Ladders in time hold velocity and pressure against a finer run.
std::vector<std::string> judged_fields(const Case& flow, Axis axis) {
    return axis == Axis::time ? std::vector<std::string>{"velocity", "pressure"} : compared_names(flow);
}

/// Not every scheme has every field: an incompressible one has no density. Of runs that all died nothing is
/// known.
bool is_compared(const SceneRecord& scene, std::span<const RunRecord> runs, const std::string& field) {
    bool any_survived = false;
    for (const RunRecord& run : runs) {
        if (run.scheme == scene.label && run.survived) {
            any_survived = true;
            if (error_of(run, field) != nullptr) {
                return true;
            }
        }
    }
    return !any_survived;
}

} // namespace

std::vector<FieldStudy> judge_runs(std::span<const SceneRecord> scenes, std::span<const RunRecord> runs,
                                   Axis axis) {
    std::vector<FieldStudy> studies;
    std::set<std::string> judged;
    for (const SceneRecord& scene : scenes) {
        if (!judged.insert(scene.label).second) {
            continue;
        }
        for (const std::string& field : judged_fields(*scene.flow, axis)) {
            if (!is_compared(scene, runs, field)) {
                continue;
            }
            std::optional<Expectation> expectation;
            if (axis == Axis::time) {
                expectation = expectation_in_time(*scene.scheme, field, scene.scheme_settings);
            } else if (const Expectation* found =
                           find_expectation(*scene.flow, scene.scheme->name, field, scene.case_settings,
                                            scene.scheme_settings)) {
                expectation = *found;
            }
            studies.push_back(judge_field(scene.label, field, axis, std::move(expectation), runs));
        }
    }
    return studies;
}

namespace {

/// The scene with a step 32 times finer: a reference only 8 times finer would read a first order as 1.1 on
/// the last pair (verification.md §6).
SceneRecord reference_of(const SceneRecord& finest) {
    solver::Assignments settings;
    for (const solver::Key& key : finest.scheme_settings.keys()) {
        settings[key.name] = key.value;
    }
    settings["time_step"] = solver::shortest(finest.scheme_settings.number("time_step") / 32);
    SceneRecord scene = finest;
    scene.scheme_settings = solver::Settings(finest.scheme->keys, settings);
    return scene;
}

/// Runs the scenes, which differ in their time step alone, with the finest last.
void run_in_time(std::span<const SceneRecord> scenes, const std::function<Progress(const SceneRecord&)>& tell,
                 const std::function<void(RunRecord)>& keep) {
    EndState exact;
    const SceneRecord finer = reference_of(scenes.back());
    const RunRecord reference = run_scene_once(finer, exact, tell(finer));
    for (const SceneRecord& scene : scenes) {
        EndState end;
        RunRecord run = run_scene_once(scene, end, tell(scene));
        run.errors.clear();
        if (run.survived && !reference.survived) {
            run.survived = false;
            run.diagnosis = "the reference with a time step of " + solver::shortest(reference.time_step) +
                            " s ended early: " + reference.diagnosis;
        } else if (run.survived) {
            run.errors = differences(end, exact);
        }
        keep(std::move(run));
    }
}

} // namespace

LadderResult run_ladder(const LadderRequest& request, const LadderProgress& progress) {
    const std::vector<SceneRecord> scenes = plan(request);
    LadderResult result{request, group_label(request, scenes.front()), {}, {}, {}, {}};
    const auto tell = [&](const SceneRecord& scene) -> Progress {
        RunRecord announced;
        announced.scheme = scene.label;
        announced.n = scene.n;
        announced.seed = scene.seed;
        announced.prescribed_time_step = scene.scheme_settings.number("time_step");
        return [&progress, &result, announced](double fraction) {
            if (progress && fraction < 1) {
                progress(result.group, announced, fraction);
            }
        };
    };
    const auto keep = [&](RunRecord run) {
        result.runs.push_back(std::move(run));
        if (progress) {
            progress(result.group, result.runs.back(), 1);
        }
    };
    if (!request.time_steps.empty()) {
        const std::size_t rungs = request.time_steps.size();
        for (std::size_t first = 0; first < scenes.size(); first += rungs) {
            run_in_time(std::span(scenes).subspan(first, rungs), tell, keep);
        }
        result.studies = judge_runs(scenes, result.runs, Axis::time);
        return result;
    }
    for (const SceneRecord& scene : scenes) {
        keep(run_scene(scene, tell(scene)));
    }
    result.studies = judge_runs(scenes, result.runs, Axis::space);
    result.fronts = fronts_of(*request.flow, result.studies);
    for (const Claim& claim : request.flow->claims) {
        if (applies(claim.where, scenes.front().case_settings, scenes.front().scheme_settings)) {
            if (const auto finding = claim.measure(result.runs)) {
                result.claims.push_back({&claim, *finding});
            }
        }
    }
    return result;
}

int exit_status(const LadderResult& result) {
    int status = 0;
    for (const FieldStudy& study : result.studies) {
        const bool waived = study.expectation && !study.expectation->waiver.empty();
        if (waived || study.verdict == "PASS" || study.verdict == "NONE") {
            continue;
        }
        status = std::max(status, study.ended_unexpectedly ? 3 : 1);
    }
    for (const RunRecord& run : result.runs) {
        if (run.survived && !run.budget.lost.empty()) {
            status = std::max(status, 1);
        }
    }
    for (const ClaimFinding& claim : result.claims) {
        if (claim.claim->binding && !claim.finding.agrees) {
            status = std::max(status, 1);
        }
    }
    return status;
}

} // namespace sphvv::verification
