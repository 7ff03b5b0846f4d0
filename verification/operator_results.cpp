#include "sphvv/verification/operator_results.hpp"

#include "sphvv/verification/claims.hpp"
#include "sphvv/verification/markdown_table.hpp"
#include "sphvv/verification/table.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace sphvv::verification {
namespace {

using Tree = nlohmann::ordered_json;

Tree finite_or_null(double value) {
    return std::isfinite(value) ? Tree(value) : Tree(nullptr);
}

Tree finite_or_null(const std::vector<double>& values) {
    Tree list = Tree::array();
    for (const double value : values) {
        list.push_back(finite_or_null(value));
    }
    return list;
}

std::string ladder_name(const OperatorLadder& ladder) {
    return std::to_string(ladder.dimension) + "-D " + std::string(to_string(ladder.arrangement)) + ", " +
           std::string(to_string(ladder.path));
}

Tree study_tree(const OperatorStudy& study, const std::string& tier) {
    Tree expected = Tree::object();
    if (study.expected) {
        expected = {{"low", study.expected->low ? Tree(*study.expected->low) : Tree(nullptr)},
                    {"high", study.expected->high ? Tree(*study.expected->high) : Tree(nullptr)},
                    {"source", study.expected->source}};
    }
    Tree fit{{"norm", "l2"},
             {"order", study.fit ? finite_or_null(study.fit->order) : Tree(nullptr)},
             {"ci95", study.fit ? finite_or_null(study.fit->ci95) : Tree(nullptr)},
             {"verdict", study.verdict},
             {"reason", study.reason},
             {"order_l1", finite_or_null(study.order_l1)},
             {"order_l2", finite_or_null(study.order_l2)},
             {"order_linf", finite_or_null(study.order_linf)}};
    Tree samples = Tree::array();
    for (const OperatorSample& s : study.samples) {
        Tree row{{"n", s.n}, {"h", s.h}, {"dx", s.dx}, {"particles", s.particles}};
        const Norms none{std::nan(""), std::nan(""), std::nan(""), std::nan(""),
                         std::nan(""), std::nan(""), true};
        const Norms& norms = s.norms ? *s.norms : none;
        for (const auto& [name, member] : {std::pair{"l1", &Norms::l1},
                                           {"l2", &Norms::l2},
                                           {"linf", &Norms::linf},
                                           {"l1_abs", &Norms::l1_abs},
                                           {"l2_abs", &Norms::l2_abs},
                                           {"linf_abs", &Norms::linf_abs}}) {
            row[name] = finite_or_null(norms.*member);
        }
        row["l2_spread"] = s.seeds > 1 ? finite_or_null(s.l2_spread) : Tree(nullptr);
        row["seeds"] = s.seeds;
        row["undetermined"] = s.undetermined;
        row["pair_evaluations"] = s.pair_evaluations;
        samples.push_back(row);
    }
    return {{"operator", study.op->name},
            {"approximates", to_string(study.op->approximates)},
            {"dimension", study.ladder.dimension},
            {"arrangement", to_string(study.ladder.arrangement)},
            {"path", to_string(study.ladder.path)},
            {"kernel", study.kernel},
            {"tier", tier},
            {"expected", expected},
            {"fit", fit},
            {"samples", samples}};
}

Tree kernel_tree(const KernelCheck& check) {
    return {{"kernel", check.kernel},
            {"dimension", check.dimension},
            {"check", check.check},
            {"value", finite_or_null(check.value)},
            {"expected", finite_or_null(check.expected)},
            {"tolerance", finite_or_null(check.tolerance)},
            {"passes", check.passes},
            {"why", check.why}};
}

bool as_it_must_be(const PublishedFigure& figure) {
    return figure.agrees == figure.waiver.empty();
}

/// Every random arrangement and field has a seed that the program fixes.
constexpr std::string_view seeds_text =
    "seeds: 1 to 5 on irregular arrangements of ladders (1 where one is enough), 7 to 9 and 31 to 52 "
    "in property checks";

std::string order_cell(const OperatorStudy& study) {
    const std::string order = study.fit ? number(study.fit->order, "%.2f") : "–";
    return study.verdict == "PASS" || study.verdict == "NONE" ? order : order + " " + study.verdict;
}

/// One row an operator, one column a ladder.
std::string order_matrix(const OperatorResults& results, int dimension) {
    std::vector<std::string> header{"operator"};
    std::map<std::string, std::size_t> column;
    std::vector<std::string> names;
    std::map<std::string, std::vector<std::string>> rows;
    for (const OperatorStudy& study : results.studies) {
        const std::string ladder = ladder_name(study.ladder).substr(4);
        if (study.ladder.dimension == dimension && column.emplace(ladder, header.size()).second) {
            header.push_back(ladder);
        }
    }
    for (const OperatorStudy& study : results.studies) {
        if (study.ladder.dimension != dimension) {
            continue;
        }
        const std::string name(study.op->name);
        if (rows.emplace(name, std::vector<std::string>(header.size(), "–")).second) {
            names.push_back(name);
            rows[name][0] = name;
        }
        rows[name][column.at(ladder_name(study.ladder).substr(4))] = order_cell(study);
    }
    if (names.empty()) {
        return {};
    }
    MarkdownTable table(header);
    for (const std::string& name : names) {
        table.add(rows[name]);
    }
    return "### observed orders in dx, " + std::to_string(dimension) + "-D (relative L2)\n\n" + table.text() +
           "\n";
}

std::string study_table(const OperatorStudy& study) {
    MarkdownTable table({"n", "h/dx", "N", "L1", "order", "L2", "order", "L∞", "order", "spread",
                         "undetermined", "pair evaluations"});
    for (std::size_t k = 0; k < study.samples.size(); ++k) {
        const OperatorSample& s = study.samples[k];
        std::vector<std::string> row{std::to_string(s.n), number(s.h / s.dx, "%.3g"),
                                     std::to_string(s.particles)};
        for (const auto& [norm, order] : {std::pair{&Norms::l1, study.order_l1[k]},
                                          {&Norms::l2, study.order_l2[k]},
                                          {&Norms::linf, study.order_linf[k]}}) {
            row.push_back(s.norms ? number((*s.norms).*norm, "%.3e") : "–");
            row.push_back(std::isnan(order) ? "–" : number(order, "%.2f"));
        }
        row.push_back(s.seeds > 1 ? number(100 * s.l2_spread, "%.1f %%") : "–");
        row.push_back(number(s.undetermined, "%g"));
        row.push_back(number(s.pair_evaluations, "%.3e"));
        table.add(std::move(row));
    }
    std::string text =
        "### " + std::string(study.op->name) + ", " + ladder_name(study.ladder) + "\n\n" + table.text();
    text += "\nfit: ";
    text += study.fit ? "order " + number(study.fit->order, "%.2f") + " ± " + number(study.fit->ci95, "%.2f")
                      : std::string("no order");
    if (study.expected) {
        text += " (expected " + band(*study.expected) + ", " + study.expected->source + ")";
    }
    return text + " " + study.verdict + " — " + study.reason + "\n\n";
}

std::string property_text(const PropertyCheck& check) {
    return check.op + ", " + std::to_string(check.dimension) + "-D, " + check.arrangement + ": " +
           check.property + " is " + number(check.value, "%.3g") + ", must be " +
           (check.at_least ? "at least " : "at most ") + number(check.bound, "%.3g");
}

/// Every finding that is not as it must be, one line each.
std::vector<std::string> failures(const OperatorResults& results) {
    std::vector<std::string> lines;
    for (const OperatorStudy& study : results.studies) {
        if (study.verdict != "PASS" && study.verdict != "NONE") {
            lines.push_back(study.verdict + " " + std::string(study.op->name) + ", " +
                            ladder_name(study.ladder) + ": " + study.reason);
        }
    }
    for (const PropertyCheck& check : results.properties) {
        if (!check.passes) {
            lines.push_back("FAIL " + property_text(check));
        }
    }
    for (const KernelCheck& check : results.kernel_checks) {
        if (!check.passes) {
            lines.push_back("FAIL kernel " + check.kernel + ", " + std::to_string(check.dimension) +
                            "-D: " + check.check + " is " + number(check.value, "%.6g") + ", expected " +
                            number(check.expected, "%.6g") + " (" + check.why + ")");
        }
    }
    for (const KernelCheck& check : results.known_errors) {
        if (!check.passes) {
            lines.push_back("FAIL a known wrong constant was not refused: " + check.check + " (" + check.why +
                            ")");
        }
    }
    for (const PublishedFigure& figure : results.figures) {
        if (!as_it_must_be(figure)) {
            lines.push_back("FAIL published figure " + figure.id + ": " + figure.published + ", ours " +
                            figure.ours + (figure.agrees ? " agrees, although it is known not to" : ""));
        }
    }
    return lines;
}

std::string costs_text(const OperatorResults& results) {
    if (results.costs.empty()) {
        return {};
    }
    MarkdownTable table(
        {"operator", "ns per pair", "spread", "front, error against time", "slower by", "than"});
    for (const OperatorCost& cost : results.costs) {
        std::vector<std::string> row{cost.op,
                                     number(cost.nanoseconds_per_pair, "%.2f"),
                                     number(100 * cost.spread, "%.0f %%"),
                                     "–",
                                     "–",
                                     "–"};
        for (const OperatorFront& front : results.fronts) {
            for (const FrontRow& place : front.rows) {
                if (front.cost == "nanoseconds" && place.name == cost.op) {
                    row[3] = place.on_front ? "yes" : "no";
                    row[4] = place.slower_by ? number(*place.slower_by, "%.3g") : "–";
                    row[5] = place.than.empty() ? "–" : place.than;
                }
            }
        }
        table.add(std::move(row));
    }
    return "### cost of one application, 2-D, one thread (jittered 20 %; fronts on jittered 10 %)\n\n" +
           table.text() + "\n";
}

} // namespace

OperatorResults run_operator_workbench(std::span<const solver::Operator* const> operators,
                                       std::string_view tier, const solver::Kernel& kernel, bool everything,
                                       const OperatorProgress& progress) {
    OperatorResults results{std::string(tier), {}, {}, {}, {}, {}, {}, {}, {}};
    // The cheap checks first: a wrong constant should not wait for the ladders.
    for (const solver::Operator* op : operators) {
        auto checks = check_properties(*op, kernel);
        std::move(checks.begin(), checks.end(), std::back_inserter(results.properties));
    }
    if (everything) {
        for (const solver::Kernel* each : solver::kernels::all()) {
            auto checks = check_kernel(*each);
            std::move(checks.begin(), checks.end(), std::back_inserter(results.kernel_checks));
        }
        for (const KnownError& error : known_errors()) {
            results.known_errors.push_back(check_known_error(error));
        }
        results.figures = published_operator_figures();
        results.consistency_sums = oger_consistency_sums();
    }
    results.studies = run_operator_studies(operators, operator_ladders(tier), kernel, progress);
    results.costs = measure_costs(operators, kernel);
    results.fronts = operator_fronts(results.studies, results.costs);
    return results;
}

void add_to_document(const OperatorResults& results, Tree& document) {
    for (const char* list :
         {"operators", "operator_studies", "operator_properties", "operator_costs", "operator_fronts",
          "kernel_checks", "known_errors", "published_figures", "consistency_sums"}) {
        document[list] = Tree::array();
    }
    for (const solver::Operator* op : solver::operators::all()) {
        document["operators"].push_back({{"name", op->name},
                                         {"summary", op->summary},
                                         {"formula", op->formula},
                                         {"source", op->source},
                                         {"approximates", to_string(op->approximates)},
                                         {"order_source", op->order.source}});
    }
    for (const OperatorStudy& study : results.studies) {
        document["operator_studies"].push_back(study_tree(study, results.tier));
    }
    for (const PropertyCheck& check : results.properties) {
        document["operator_properties"].push_back({{"operator", check.op},
                                                   {"dimension", check.dimension},
                                                   {"property", check.property},
                                                   {"arrangement", check.arrangement},
                                                   {"value", finite_or_null(check.value)},
                                                   {"bound", check.bound},
                                                   {"at_least", check.at_least},
                                                   {"passes", check.passes}});
    }
    for (const OperatorCost& cost : results.costs) {
        document["operator_costs"].push_back({{"operator", cost.op},
                                              {"dimension", cost.dimension},
                                              {"nanoseconds_per_pair", cost.nanoseconds_per_pair},
                                              {"spread", cost.spread},
                                              {"pairs", cost.pairs}});
    }
    for (const OperatorFront& front : results.fronts) {
        Tree curves = Tree::array();
        for (const CostCurve& curve : front.curves) {
            curves.push_back({{"operator", curve.name}, {"error", curve.error}, {"cost", curve.cost}});
        }
        Tree rows = Tree::array();
        for (const FrontRow& row : front.rows) {
            rows.push_back({{"operator", row.name},
                            {"on_front", row.on_front},
                            {"slower_by", row.slower_by ? Tree(*row.slower_by) : Tree(nullptr)},
                            {"at_error", finite_or_null(row.at_error)},
                            {"than", row.than}});
        }
        document["operator_fronts"].push_back(
            {{"approximates", front.approximates}, {"cost", front.cost}, {"curves", curves}, {"rows", rows}});
    }
    for (const KernelCheck& check : results.kernel_checks) {
        document["kernel_checks"].push_back(kernel_tree(check));
    }
    for (const KernelCheck& check : results.known_errors) {
        document["known_errors"].push_back(kernel_tree(check));
    }
    for (const PublishedFigure& figure : results.figures) {
        document["published_figures"].push_back({{"id", figure.id},
                                                 {"text", figure.text},
                                                 {"published", figure.published},
                                                 {"source", figure.source},
                                                 {"ours", figure.ours},
                                                 {"reference", finite_or_null(figure.reference)},
                                                 {"value", finite_or_null(figure.value)},
                                                 {"tolerance", finite_or_null(figure.tolerance)},
                                                 {"is_bound", figure.is_bound},
                                                 {"agrees", figure.agrees},
                                                 {"waiver", figure.waiver}});
    }
    for (const ConsistencyRow& row : results.consistency_sums) {
        document["consistency_sums"].push_back({{"jitter", row.jitter},
                                                {"h_over_dx", row.h_over_dx},
                                                {"neighbours", row.neighbours},
                                                {"worst_zeroth", row.worst_zeroth},
                                                {"worst_first", row.worst_first}});
    }
}

std::string markdown(const OperatorResults& results, bool details) {
    std::string text = "## operators, " + results.tier + " tier\n\n" + std::string(seeds_text) + "\n\n";
    if (details) {
        for (const OperatorStudy& study : results.studies) {
            text += study_table(study);
        }
    }
    text += order_matrix(results, 2) + order_matrix(results, 3) + costs_text(results);
    const auto count = [](std::size_t passing, std::size_t all, const std::string& what) {
        return all == 0 ? std::string()
                        : std::to_string(passing) + " of " + std::to_string(all) + " " + what + "\n";
    };
    const auto passes = [](const auto& check) { return check.passes; };
    const auto verdicts = [&](const char* verdict) {
        return static_cast<std::size_t>(
            std::ranges::count(results.studies, verdict, &OperatorStudy::verdict));
    };
    text += count(verdicts("PASS"), results.studies.size() - verdicts("NONE"),
                  "order ladders as theory has them");
    text += verdicts("NONE") == 0
                ? ""
                : std::to_string(verdicts("NONE")) + " ladders without a law: observed only\n";
    text += count(std::ranges::count_if(results.properties, passes), results.properties.size(),
                  "declared properties hold");
    text += count(std::ranges::count_if(results.kernel_checks, passes), results.kernel_checks.size(),
                  "kernel checks pass");
    text += count(std::ranges::count_if(results.known_errors, passes), results.known_errors.size(),
                  "wrong constants in print are refused");
    text += count(
        std::ranges::count_if(results.figures, [](const PublishedFigure& figure) { return figure.agrees; }),
        results.figures.size(), "published figures reproduced; the others:");
    for (const PublishedFigure& figure : results.figures) {
        if (!figure.agrees && !figure.waiver.empty()) {
            text += "  " + figure.id + ": published " + figure.published + ", ours " + figure.ours +
                    " (waived: " + figure.waiver + ")\n";
        }
    }
    for (const std::string& line : failures(results)) {
        text += line + "\n";
    }
    return text;
}

int exit_status(const OperatorResults& results) {
    return failures(results).empty() ? 0 : 1;
}

} // namespace sphvv::verification
