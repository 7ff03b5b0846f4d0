#include "sphvv/verification/table.hpp"

#include "sphvv/verification/claims.hpp"
#include "sphvv/verification/markdown_table.hpp"

#include <cmath>

namespace sphvv::verification {
namespace {

const std::string dash = "–";

std::string order_text(double order) {
    return std::isnan(order) ? dash : number(order, "%.2f");
}

std::string study_table(const FieldStudy& study) {
    MarkdownTable table({"n", "h", "dx", "N", "Δt", "steps", "L1", "order", "L2", "order", "L∞", "order",
                         "seconds", "pair evaluations"});
    for (std::size_t k = 0; k < study.samples.size(); ++k) {
        const Sample& s = study.samples[k];
        std::vector<std::string> row{std::to_string(s.n),         number(s.h, "%.4g"),
                                     number(s.dx, "%.4g"),        std::to_string(s.particles),
                                     number(s.time_step, "%.3e"), number(s.steps, "%.0f")};
        if (s.norms) {
            for (const auto& [norm, order] : {std::pair{s.norms->l1, study.order_l1[k]},
                                              {s.norms->l2, study.order_l2[k]},
                                              {s.norms->linf, study.order_linf[k]}}) {
                row.push_back(number(norm, "%.3e"));
                row.push_back(order_text(order));
            }
        } else {
            row.insert(row.end(), {"ended", dash, dash, dash, dash, dash});
        }
        row.push_back(number(s.seconds, "%.3g"));
        row.push_back(number(s.pair_evaluations, "%.3e"));
        table.add(std::move(row));
    }
    std::string out = table.text();
    for (const Sample& s : study.samples) {
        if (!s.survived) {
            out += "n = " + std::to_string(s.n) + " ended early: " + s.diagnosis + "\n";
        }
    }
    if (study.axis == Axis::time) {
        out += "errors against the run with a time step 32 times finer than the finest; orders in Δt\n";
    }
    bool relative = true;
    double spread = 0;
    for (const Sample& s : study.samples) {
        relative = relative && (!s.norms || s.norms->relative);
        spread = std::max(spread, s.l2_spread);
    }
    if (!relative) {
        out += "errors are absolute: the reference vanishes\n";
    }
    if (!study.samples.empty() && study.samples[0].seeds > 1) {
        out += "geometric mean over seeds 1 to " + std::to_string(study.samples[0].seeds) +
               "; largest spread of L2 " + number(100 * spread, "%.1f %%") + "\n";
    }
    return out;
}

std::string front_table(const std::vector<Front>& fronts) {
    MarkdownTable table({"field", "cost", "scheme", "front", "slower by", "at error", "than"});
    for (const Front& front : fronts) {
        for (const FrontRow& row : front.rows) {
            table.add({front.field, front.cost == "seconds" ? "seconds" : "work (pairs and matrix entries)",
                       row.name, row.on_front ? "yes" : "no",
                       row.slower_by ? number(*row.slower_by, "%.3g×") : dash,
                       std::isfinite(row.at_error) ? number(row.at_error, "%.3e") : dash,
                       row.than.empty() ? dash : row.than});
        }
    }
    return table.text();
}

} // namespace

std::string band(const Expected& expected) {
    if (expected.low && expected.high) {
        return number(*expected.low, "%g") + "…" + number(*expected.high, "%g");
    }
    return expected.low    ? "≥ " + number(*expected.low, "%g")
           : expected.high ? "≤ " + number(*expected.high, "%g")
                           : "no order";
}

std::string verdict_line(const FieldStudy& study) {
    std::string line;
    if (study.fit) {
        line += "order " + number(study.fit->order, "%.2f");
        line += std::isfinite(study.fit->ci95) ? " ± " + number(study.fit->ci95, "%.2f") : "";
    } else {
        line += "no order";
    }
    if (study.expectation && !study.expectation->ends_early) {
        line += " (expected " + band(study.expectation->order) + ", " + study.expectation->order.source + ")";
    } else if (study.expectation) {
        line += " (expected to end early, " + study.expectation->order.source + ")";
    }
    line += " " + study.verdict;
    if (study.expectation && !study.expectation->waiver.empty() && study.verdict != "PASS") {
        line += " (waived: " + study.expectation->waiver + ")";
    }
    return line + (study.reason.empty() ? "" : " — " + study.reason);
}

std::string markdown(const LadderResult& result) {
    std::string out = "## " + result.group + "\n\n";
    for (const FieldStudy& study : result.studies) {
        out += "### " + study.scheme + ", " + study.field + "\n\n" + study_table(study) +
               "\nfit: " + verdict_line(study) + "\n\n";
    }
    out += "### error against cost, L2\n\n" + front_table(result.fronts) + "\n";
    if (!result.claims.empty()) {
        MarkdownTable table({"claim", "what", "published", "ours", "agrees"});
        for (const ClaimFinding& c : result.claims) {
            table.add({c.claim->id, c.claim->text, c.claim->published, c.finding.ours,
                       c.finding.agrees ? "yes" : "NO"});
        }
        out += "### published claims\n\n" + table.text() + "\n";
    }
    return out;
}

} // namespace sphvv::verification
