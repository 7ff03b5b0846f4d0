#include "sphvv/verification/cases.hpp"
#include "sphvv/verification/claims.hpp"
#include "sphvv/verification/wall_orders.hpp"

namespace sphvv::verification::cases {
namespace {

// An explicit and an implicit viscous step, all else alike.
const std::string explicit_step = "isph_dfs:laplacian=schwaiger";
const std::string implicit_step = "isph_dfs:laplacian=schwaiger:viscous_step=implicit";

/// Work of the explicit step over that of the implicit one at the same n.
struct WorkRatio {
    int n;
    double ratio;
};

struct Comparison {
    std::vector<WorkRatio> at; ///< in the order of the ladder
    std::string text;
    bool as_accurate = false; ///< on the finest rung the implicit step, to a tenth
};

Comparison compared(std::span<const RunRecord> runs) {
    Comparison result;
    for (const RunRecord& by_explicit : runs) {
        const RunRecord* by_implicit = find_run(runs, implicit_step, by_explicit.n);
        if (by_explicit.scheme != explicit_step || by_implicit == nullptr || !by_implicit->survived ||
            !by_explicit.survived) {
            continue;
        }
        const double errors = l2_error(*by_implicit, "velocity") / l2_error(by_explicit, "velocity");
        const double ratio = work_of(by_explicit) / work_of(*by_implicit);
        result.as_accurate = errors < 1.1; // both end at the steady flow of the same operators
        result.at.push_back({by_explicit.n, ratio});
        result.text += (result.text.empty() ? "" : "; ") + ("n = " + std::to_string(by_explicit.n)) + ": " +
                       number(ratio, "%.3g") + " (steps " + std::to_string(by_explicit.steps) + " and " +
                       std::to_string(by_implicit->steps) + ", seconds " +
                       number(by_explicit.seconds / by_implicit->seconds, "%.2g") + ", L2 " +
                       percent(l2_error(by_explicit, "velocity")) + " and " +
                       percent(l2_error(*by_implicit, "velocity")) + ")";
    }
    return result;
}

/// The n at which the ratio passes 1, on a straight line in logarithms.
std::string crossing(const std::vector<WorkRatio>& at) {
    for (std::size_t k = 1; k < at.size(); ++k) {
        const auto& [coarse, below] = at[k - 1];
        const auto& [fine, above] = at[k];
        if (below < 1 && above >= 1) {
            const double share = std::log(1 / below) / std::log(above / below);
            return "; even at n = " + number(coarse * std::pow(double(fine) / coarse, share), "%.0f");
        }
    }
    return at.front().ratio >= 1 ? "; the implicit step is cheaper on every rung"
                                 : "; the explicit step is cheaper on every rung";
}

/// Work of the explicit over the implicit step along the ladder; `holds` says what must be so.
template <class Holds>
Claim work_claim(const char* text, const char* expected, const std::vector<Condition>& where, bool binding,
                 const Holds& holds) {
    return {.id = "VISCOUS, steady",
            .text = text,
            .published = expected,
            .source = "derived: steps of limits proportional to h and to h^2",
            .where = where,
            .measure = [holds](std::span<const RunRecord> runs) -> std::optional<Claim::Finding> {
                const Comparison comparison = compared(runs);
                if (comparison.at.size() < 2) {
                    return std::nullopt;
                }
                return Claim::Finding{"work of the explicit over the implicit step at " + comparison.text +
                                          crossing(comparison.at),
                                      comparison.as_accurate && holds(comparison.at)};
            },
            .binding = binding};
}

/// Until T = 2 D^2/nu and later the flow is steady to exp(-2 pi^2) and better, and has no error of the time
/// marching. Explicit steps of 0.2 h^2/nu are T nu/(0.2 h^2) many, proportional to n^2; implicit ones go to
/// the advective limit, 0.2 h/u_max, with u_max = 1.5 U: T 1.5 U/(0.2 h), proportional to n. Their ratio is
/// nu/(1.5 U h) = n/(1.5 x 1.3 Re) with h = 1.3 D/n, but never below 1, as both keep to the smaller limit:
/// below n = 2 Re the steps are alike, and each of the implicit ones costs a solve more.
std::vector<Claim> claims() {
    const auto last_above = [](double ratio) {
        return [ratio](const std::vector<WorkRatio>& at) { return at.back().ratio > ratio; };
    };
    return {
        work_claim("a steady flow at a low Reynolds number: the implicit step reaches the same error with "
                   "less work on the finest rung",
                   "steps n/(1.95 Re) times fewer: 50 times at n = 10 and Re = 0.1", {{"re", 0, 1}}, true,
                   last_above(1)),
        work_claim(
            "the same at Re = 10: the explicit step does less work on a coarse ladder, the implicit "
            "one on a fine one",
            "as many steps up to n = 1.95 Re, then n/(1.95 Re) times fewer", {{"re", 10, 10}}, false,
            [](const std::vector<WorkRatio>& at) { return at.front().ratio < 1 && at.back().ratio > 1; })};
}

std::vector<Study> studies() {
    std::vector<Study> all = wall_orders::studies("poiseuille");
    const std::vector<std::string> both{explicit_step, implicit_step};
    all.push_back({.name = "poiseuille/implicit",
                   .tier = Tier::quick,
                   .schemes = both,
                   .settings = {{"re", "0.1"}, {"end_time", "0.2"}, {"columns", "10"}},
                   .ladder = {10, 14, 20, 28},
                   .cost = 8});
    all.push_back({.name = "poiseuille/implicit_fine",
                   .tier = Tier::nightly,
                   .schemes = both,
                   .settings = {{"re", "0.1"}, {"end_time", "0.3"}, {"columns", "10"}},
                   .ladder = {10, 20, 40, 80},
                   .cost = 170});
    all.push_back({.name = "poiseuille/implicit_re10",
                   .tier = Tier::full,
                   .schemes = both,
                   .settings = {{"re", "10"}, {"end_time", "20"}, {"columns", "10"}},
                   .ladder = {10, 20, 40, 80},
                   .cost = 240});
    return all;
}

} // namespace

const Case& poiseuille() {
    static const Case flow{
        .name = "poiseuille",
        .summary = "plane channel between two walls at rest, driven by a body force from rest",
        .equations = "incompressible Navier-Stokes in 2-D with a body force",
        .source =
            "Schlichting 1979 ch. V; transients: Carslaw & Jaeger 1959 ch. III; as a test of SPH: Morris "
            "et al. 1997",
        .solution = "poiseuille",
        .reference_length = "width",
        .leading_key = "re",
        .end_time = 1,
        .expectations = wall_orders::expectations(wall_orders::MorrisFloor::below),
        .claims = claims(),
        .studies = studies(),
        .fields = {"velocity"},
        .columns = 16,
        .profile_direction = 1,
    };
    return flow;
}

} // namespace sphvv::verification::cases
