#include "sphvv/verification/document.hpp"

#include "sphvv/analytic/solutions.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace sphvv::verification {
namespace {

using Tree = nlohmann::ordered_json;

Tree finite_or_null(double value) {
    return std::isfinite(value) ? Tree(value) : Tree(nullptr);
}

/// Pairwise orders; null at the coarsest rung and wherever a run has no error.
Tree orders(const std::vector<double>& values) {
    Tree list = Tree::array();
    for (const double value : values) {
        list.push_back(finite_or_null(value));
    }
    return list;
}

Tree provenance_tree(const Provenance& p, double seconds) {
    Tree libraries = Tree::object();
    for (const auto& [name, version] : p.libraries) {
        libraries[name] = version;
    }
    return {{"version", p.version},   {"revision", p.revision}, {"tree_clean", p.tree_clean},
            {"compiler", p.compiler}, {"flags", p.flags},       {"build_type", p.build_type},
            {"cpu", p.cpu},           {"threads", p.threads},   {"libraries", libraries},
            {"started", p.started},   {"seconds", seconds}};
}

std::string domain_text(const analytic::Domain& domain, int dimension) {
    std::string text;
    for (int d = 0; d < dimension; ++d) {
        text += (d == 0 ? "[" : " x [") + solver::shortest(domain.low[d]) + ", " +
                solver::shortest(domain.high[d]) + "] m" + (domain.periodic[d] ? " periodic" : "");
    }
    return text;
}

Tree case_tree(const LadderResult& result) {
    const Case& flow = *result.request.flow;
    const SceneRecord scene = plan(result.request).front();
    const analytic::Solution& solution = analytic::solutions::find(flow.solution);
    Tree parameters = Tree::array();
    for (const solver::Key& key : scene.case_settings.keys()) {
        parameters.push_back(
            {{"name", key.name}, {"value", key.value}, {"unit", key.unit}, {"summary", key.summary}});
    }
    Tree variants = Tree::array();
    for (const auto& [variant, name] : flow.variant_names) {
        if (std::ranges::find(result.request.schemes, variant_of(variant)) != result.request.schemes.end()) {
            variants.push_back({{"scheme", variant_of(variant).label()}, {"name", name}});
        }
    }
    return {{"name", flow.name},
            {"group", result.group},
            {"summary", flow.summary},
            {"equations", flow.equations},
            {"source", flow.source},
            {"reference", std::string(solution.formula) + " (" + std::string(solution.source) + ")"},
            {"dimension", solution.dimension},
            {"reference_length", scene.case_settings.number(flow.reference_length)},
            {"domain", domain_text(solution.domain(solution_values(scene)), solution.dimension)},
            {"parameters", parameters},
            {"variants", variants}};
}

Tree sample_tree(const Sample& s) {
    Tree row{{"n", s.n},          {"h", s.h},        {"dx", s.dx}, {"particles", s.particles},
             {"dt", s.time_step}, {"steps", s.steps}};
    const auto norm = [&](const char* name, double Norms::*member) {
        row[name] = s.norms ? finite_or_null((*s.norms).*member) : Tree(nullptr);
    };
    norm("l1", &Norms::l1);
    norm("l2", &Norms::l2);
    norm("linf", &Norms::linf);
    norm("l1_abs", &Norms::l1_abs);
    norm("l2_abs", &Norms::l2_abs);
    norm("linf_abs", &Norms::linf_abs);
    row.update({{"relative", !s.norms || s.norms->relative},
                {"l2_spread", s.seeds > 1 ? finite_or_null(s.l2_spread) : Tree(nullptr)},
                {"seeds", s.seeds},
                {"seconds", s.seconds},
                {"seconds_spread", finite_or_null(s.seconds_spread)},
                {"repeats", s.repeats},
                {"cpu_seconds", s.cpu_seconds},
                {"pair_evaluations", s.pair_evaluations},
                {"solver_iterations", s.solver_iterations},
                {"matrix_entries", s.matrix_entries},
                {"particle_steps", s.particle_steps},
                {"survived", s.survived},
                {"diagnosis", s.diagnosis}});
    return row;
}

Tree study_tree(const LadderResult& result, const FieldStudy& study) {
    Tree settings = Tree::object();
    for (const auto& [key, value] : result.request.settings) {
        settings[key] = value;
    }
    Tree expected = Tree::object();
    if (const auto& e = study.expectation) {
        expected = {{"low", e->order.low ? Tree(*e->order.low) : Tree(nullptr)},
                    {"high", e->order.high ? Tree(*e->order.high) : Tree(nullptr)},
                    {"text", e->text},
                    {"source", e->order.source}};
        if (e->ends_early) {
            expected["fate"] = "ends_early";
            expected["spacing"] = e->ends_early->spacing;
            expected["not_before"] = e->ends_early->not_before;
        }
    }
    Tree fit{{"norm", "l2"},
             {"order", study.fit ? finite_or_null(study.fit->order) : Tree(nullptr)},
             {"ci95", study.fit ? finite_or_null(study.fit->ci95) : Tree(nullptr)},
             {"verdict", study.verdict},
             {"reason", study.reason},
             {"order_l1", orders(study.order_l1)},
             {"order_l2", orders(study.order_l2)},
             {"order_linf", orders(study.order_linf)}};
    if (study.expectation && !study.expectation->waiver.empty()) {
        fit["waiver"] = study.expectation->waiver;
    }
    const bool is_chaotic =
        std::ranges::find(result.request.chaotic, study.scheme) != result.request.chaotic.end();
    Tree samples = Tree::array();
    for (const Sample& sample : study.samples) {
        samples.push_back(sample_tree(sample));
    }
    return {{"case", result.request.flow->name},
            {"group", result.group},
            {"scheme", study.scheme},
            {"field", study.field},
            {"tier", result.request.tier},
            {"axis", study.axis == Axis::space ? "h" : "dt"},
            {"settings", settings},
            {"round_off", is_chaotic ? result.request.chaotic_round_off : Study::usual_round_off},
            {"expected", expected},
            {"fit", fit},
            {"samples", samples}};
}

Tree budget_tree(const Budget& budget) {
    const auto if_any = [](const std::optional<double>& value) {
        return value ? finite_or_null(*value) : Tree(nullptr);
    };
    return {{"momentum_drift", finite_or_null(budget.momentum_drift)},
            {"kinetic_energy_start", finite_or_null(budget.kinetic_energy_start)},
            {"kinetic_energy_end", finite_or_null(budget.kinetic_energy_end)},
            {"elastic_energy_start", if_any(budget.elastic_energy_start)},
            {"elastic_energy_end", if_any(budget.elastic_energy_end)},
            {"energy_drift", finite_or_null(budget.energy_drift)},
            {"internal_torque", if_any(budget.internal_torque)},
            {"claims", budget.claims},
            {"lost", budget.lost}};
}

Tree history_tree(const std::vector<Deviation>& history) {
    Tree rows = Tree::array();
    for (const Deviation& at : history) {
        const auto l2 = [&](std::string_view field) {
            const Norms* norms = at.find(field);
            return norms == nullptr ? Tree(nullptr) : finite_or_null(norms->l2);
        };
        rows.push_back({{"time", at.time},
                        {"l2_velocity", l2("velocity")},
                        {"l2_pressure", l2("pressure")},
                        {"maximum_speed", finite_or_null(at.maximum_speed)},
                        {"maximum_speed_exact", finite_or_null(at.maximum_speed_exact)},
                        {"energy_error", finite_or_null(at.energy_error)}});
    }
    return rows;
}

Tree numbers_tree(std::span<const double> values) {
    Tree entries = Tree::array();
    for (const double value : values) {
        entries.push_back(finite_or_null(value));
    }
    return entries;
}

Tree picture_tree(const Picture& picture) {
    return {{"time", picture.time},
            {"x", numbers_tree(picture.x)},
            {"y", numbers_tree(picture.y)},
            {"speed", numbers_tree(picture.speed)},
            {"pressure", numbers_tree(picture.pressure)},
            {"box", numbers_tree(picture.box)}};
}

Tree profiles_tree(const std::vector<Profile>& profiles) {
    Tree list = Tree::array();
    for (const Profile& profile : profiles) {
        list.push_back({{"field", profile.field},
                        {"coordinate", numbers_tree(profile.coordinate)},
                        {"ours", numbers_tree(profile.ours)},
                        {"exact", numbers_tree(profile.exact)}});
    }
    return list;
}

Tree run_tree(const LadderResult& result, const RunRecord& run) {
    Tree stages = Tree::array();
    for (const auto& stage : run.stages) {
        stages.push_back(
            {{"name", stage.name}, {"seconds", stage.seconds}, {"pair_evaluations", stage.pair_evaluations}});
    }
    Tree fields = Tree::array();
    for (const auto& field : run.fields) {
        fields.push_back({{"name", field.name},
                          {"bytes_per_particle", field.bytes_per_particle},
                          {"asked_by", field.asked_by}});
    }
    Tree settings = Tree::object();
    for (const auto& [key, value] : run.settings) {
        settings[key] = value;
    }
    Tree tree{{"case", result.request.flow->name},
              {"group", result.group},
              {"scheme", run.scheme},
              {"n", run.n},
              {"seed", run.seed},
              {"survived", run.survived},
              {"diagnosis", run.diagnosis},
              {"end_time", run.time},
              {"setup_seconds", run.setup_seconds},
              {"bytes_per_particle", run.bytes_per_particle},
              {"neighbour_bytes_per_particle", run.neighbour_bytes_per_particle},
              {"pair_bytes_per_particle", run.pair_bytes_per_particle},
              {"energy_error", finite_or_null(run.energy_error)},
              {"maximum_speed_error", finite_or_null(run.maximum_speed_error)},
              {"minimum_spacing", finite_or_null(run.minimum_spacing)},
              {"budget", budget_tree(run.budget)},
              {"stages", stages},
              {"fields", fields},
              {"settings", settings},
              {"history", history_tree(run.history)}};
    if (run.picture) {
        tree["picture"] = picture_tree(*run.picture);
        tree["profiles"] = profiles_tree(run.profiles);
    }
    return tree;
}

Tree front_tree(const LadderResult& result, const Front& front) {
    Tree curves = Tree::array();
    for (std::size_t k = 0; k < front.curves.size(); ++k) {
        curves.push_back({{"scheme", front.curves[k].name},
                          {"n", front.n[k]},
                          {"error", front.curves[k].error},
                          {"cost", front.curves[k].cost}});
    }
    Tree rows = Tree::array();
    for (const FrontRow& row : front.rows) {
        rows.push_back({{"scheme", row.name},
                        {"on_front", row.on_front},
                        {"slower_by", row.slower_by ? finite_or_null(*row.slower_by) : Tree(nullptr)},
                        {"at_error", finite_or_null(row.at_error)},
                        {"than", row.than}});
    }
    return {{"group", result.group}, {"field", front.field}, {"norm", "l2"},
            {"cost", front.cost},    {"curves", curves},     {"rows", rows}};
}

} // namespace

Tree result_document(const std::string& command, const Provenance& provenance, double seconds,
                     std::span<const LadderResult> results) {
    Tree document{{"format", "sphvv-results"},
                  {"format_version", 1},
                  {"kind", "verify"},
                  {"command", command},
                  {"provenance", provenance_tree(provenance, seconds)}};
    for (const char* list : {"cases", "studies", "runs", "fronts", "claims"}) {
        document[list] = Tree::array();
    }
    for (const LadderResult& result : results) {
        document["cases"].push_back(case_tree(result));
        for (const FieldStudy& study : result.studies) {
            document["studies"].push_back(study_tree(result, study));
        }
        for (const RunRecord& run : result.runs) {
            document["runs"].push_back(run_tree(result, run));
        }
        for (const Front& front : result.fronts) {
            document["fronts"].push_back(front_tree(result, front));
        }
        for (const ClaimFinding& c : result.claims) {
            document["claims"].push_back({{"group", result.group},
                                          {"id", c.claim->id},
                                          {"text", c.claim->text},
                                          {"published", c.claim->published},
                                          {"source", c.claim->source},
                                          {"ours", c.finding.ours},
                                          {"agrees", c.finding.agrees},
                                          {"binding", c.claim->binding}});
        }
    }
    return document;
}

} // namespace sphvv::verification
