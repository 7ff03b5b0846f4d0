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

constexpr int jittered_seeds = 5; // verification.md §3: at least five
const std::vector<std::string> compared_fields{"velocity", "pressure"};

std::string group_label(const LadderRequest& request, const SceneRecord& scene) {
    const std::string leading(request.flow->leading_key);
    std::string label =
        std::string(request.flow->name) + " " + leading + "=" + scene.case_settings.text(leading);
    for (const auto& [key, value] : request.settings) {
        if (key != leading) {
            label.append(" ").append(key).append("=").append(value);
        }
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

std::vector<double> pairwise_orders(const std::vector<Sample>& samples, double Norms::*norm) {
    std::vector<double> orders(samples.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t k = 1; k < samples.size(); ++k) {
        if (samples[k].norms && samples[k - 1].norms) {
            orders[k] = std::log((*samples[k - 1].norms).*norm / (*samples[k].norms).*norm) /
                        std::log(samples[k - 1].h / samples[k].h);
        }
    }
    return orders;
}

std::string count_of(std::size_t count, const char* noun) {
    return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

/// A run that is expected to end early.
void judge_fate(FieldStudy& study) {
    const auto survivor = std::find_if(study.samples.begin(), study.samples.end(),
                                       [](const Sample& sample) { return sample.survived; });
    if (survivor != study.samples.end()) {
        study.verdict = "FAIL";
        study.reason = "the run at n = " + std::to_string(survivor->n) +
                       " reached the end time, although it is expected "
                       "to end early: " +
                       study.expectation->text;
        return;
    }
    study.verdict = "PASS";
    study.reason = "ended early on " + count_of(study.samples.size(), "rung") +
                   ", as expected: " + study.expectation->text;
}

void judge_order(FieldStudy& study, const std::vector<Rung>& rungs) {
    if (study.samples.size() < 4) {
        study.verdict = "NONE";
        study.reason = count_of(study.samples.size(), "rung") + ": errors only, an order verdict needs 4";
        return;
    }
    if (study.expectation == nullptr) {
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
    if (judgement.verdict == Verdict::pass && band.high && *band.high < 1) {
        // "As expected" must not read as "accurate".
        char text[80];
        std::snprintf(text, sizeof text, "; the scheme does not converge here, its finest L2 error is %.3g",
                      study.samples.back().norms->l2);
        study.reason += text;
    }
}

FieldStudy judge_field(const Case& flow, const solver::Scheme& scheme, const std::string& field,
                       const solver::Settings& case_settings,
                       const std::map<int, std::vector<const RunRecord*>>& by_rung) {
    FieldStudy study{};
    study.scheme = scheme.name;
    study.field = field;
    study.expectation = find_expectation(flow, scheme.name, field, case_settings);
    std::vector<Rung> rungs;
    const Sample* lost = nullptr;
    for (const auto& [n, runs] : by_rung) {
        study.samples.push_back(sample_of(runs, field));
    }
    for (const Sample& sample : study.samples) {
        if (!sample.survived) {
            lost = lost == nullptr ? &sample : lost;
            continue;
        }
        Rung rung{sample.h, {}};
        for (const RunRecord* run : by_rung.at(sample.n)) {
            rung.errors.push_back(error_of(*run, field)->norms.l2);
        }
        rungs.push_back(rung);
    }
    study.order_l1 = pairwise_orders(study.samples, &Norms::l1);
    study.order_l2 = pairwise_orders(study.samples, &Norms::l2);
    study.order_linf = pairwise_orders(study.samples, &Norms::linf);
    if (study.expectation != nullptr && study.expectation->ends_early) {
        judge_fate(study);
    } else if (lost != nullptr) {
        study.ended_unexpectedly = true;
        study.verdict = "FAIL";
        study.reason = "the run at n = " + std::to_string(lost->n) + " ended early: " + lost->diagnosis;
    } else {
        judge_order(study, rungs);
    }
    return study;
}

std::vector<Front> fronts_of(const std::vector<FieldStudy>& studies) {
    std::vector<Front> fronts;
    for (const std::string& field : compared_fields) {
        for (const auto& [cost, member] : {std::pair{"seconds", &Sample::seconds},
                                           std::pair{"pair_evaluations", &Sample::pair_evaluations}}) {
            Front front{field, cost, {}, {}, {}};
            for (const FieldStudy& study : studies) {
                CostCurve curve{study.scheme, {}, {}};
                std::vector<int> n;
                for (const Sample& sample : study.samples) {
                    if (study.field == field && sample.norms) {
                        curve.error.push_back(sample.norms->l2);
                        curve.cost.push_back(sample.*member);
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
    for (const solver::Scheme* scheme : request.schemes) {
        any_scheme.insert(any_scheme.end(), scheme->keys.begin(), scheme->keys.end());
    }
    std::vector<SceneRecord> scenes;
    for (const solver::Scheme* scheme : request.schemes) {
        for (const int n : request.ladder) {
            SceneRecord scene = resolve_scene(*request.flow, *scheme, request.settings, n, any_scheme);
            const bool random = scene.case_settings.word("arrangement") == "jittered";
            check_scene(scene);
            for (int seed = 1; seed <= (random ? jittered_seeds : 1); ++seed) {
                scene.seed = static_cast<std::uint64_t>(seed);
                scenes.push_back(scene);
            }
        }
    }
    return scenes;
}

std::vector<FieldStudy> judge_runs(const Case& flow, const std::vector<const solver::Scheme*>& schemes,
                                   const solver::Settings& case_settings, std::span<const RunRecord> runs) {
    std::vector<FieldStudy> studies;
    for (const solver::Scheme* scheme : schemes) {
        std::map<int, std::vector<const RunRecord*>> by_rung;
        for (const RunRecord& run : runs) {
            if (run.scheme == scheme->name) {
                by_rung[run.n].push_back(&run);
            }
        }
        for (const std::string& field : compared_fields) {
            studies.push_back(judge_field(flow, *scheme, field, case_settings, by_rung));
        }
    }
    return studies;
}

LadderResult run_ladder(const LadderRequest& request, const LadderProgress& progress) {
    const std::vector<SceneRecord> scenes = plan(request);
    LadderResult result{request, group_label(request, scenes.front()), {}, {}, {}, {}};
    for (const SceneRecord& scene : scenes) {
        RunRecord announced;
        announced.scheme = scene.scheme->name;
        announced.n = scene.n;
        announced.seed = scene.seed;
        const auto tell = [&](double fraction) {
            if (progress && fraction < 1) {
                progress(result.group, announced, fraction);
            }
        };
        result.runs.push_back(run_scene(scene, tell));
        if (progress) {
            progress(result.group, result.runs.back(), 1);
        }
    }
    result.studies = judge_runs(*request.flow, request.schemes, scenes.front().case_settings, result.runs);
    result.fronts = fronts_of(result.studies);
    for (const Claim& claim : request.flow->claims) {
        if (applies(claim.where, scenes.front().case_settings)) {
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
        const bool waived = study.expectation != nullptr && !study.expectation->waiver.empty();
        if (waived || study.verdict == "PASS" || study.verdict == "NONE") {
            continue;
        }
        status = std::max(status, study.ended_unexpectedly ? 3 : 1);
    }
    return status;
}

} // namespace sphvv::verification
