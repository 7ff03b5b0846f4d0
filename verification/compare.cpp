#include "sphvv/verification/compare.hpp"

#include "sphvv/solver/error.hpp"
#include "sphvv/solver/storage/trial_reading.hpp"
#include "sphvv/verification/case.hpp"
#include "sphvv/verification/claims.hpp"
#include "sphvv/verification/markdown_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <set>

namespace sphvv::verification {
namespace {

constexpr double round_off_of_operators = 1e-6;
constexpr double round_off_of_schemes = Study::usual_round_off;
constexpr double no_error = 1e-11; // relative norms below are round-off themselves
// eps times the worst condition number of a checked operator (1e-6), or of coordinates of 1e6 L over a run
// (2e-6).
constexpr double bound_of_round_off = 1e-5;
constexpr double work_tolerance = 0.01;
constexpr double least_order_change = 0.05;
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr const char* none = "none"; // stands for a member that is null or not there; not the verdict NONE

constexpr std::array error_names{"l1", "l2", "linf"};
constexpr std::array work_names{"steps", "pair_evaluations", "solver_iterations", "matrix_entries",
                                "undetermined"};
/// What a check demands: loosening one of these turns a wrong answer into a right one.
constexpr std::array demand_names{"bound",  "at_least",  "expected", "tolerance", "reference", "is_bound",
                                  "theory", "theory_by", "low",      "high",      "fate",      "claims"};
/// What the end of a run must be that cannot reach its end time.
constexpr std::array fate_names{"spacing", "not_before"};

/// Lists of checks, the members that identify one, the one that says whether it is as it must be, and what it
/// measured: numbers, or lists of them.
struct CheckList {
    const char* name;
    std::vector<const char*> identity;
    const char* passes;
    std::vector<const char*> values{"value"};
    double round_off = round_off_of_operators;
};
const std::vector<CheckList>& check_lists() {
    static const std::vector<CheckList> lists{
        {"operator_properties", {"operator", "dimension", "arrangement", "property"}, "passes"},
        {"kernel_checks", {"kernel", "dimension", "check"}, "passes"},
        {"known_errors", {"kernel", "dimension", "check", "why"}, "passes"},
        {"published_figures", {"id"}, "agrees"},
        // A bisection ends at 0.5 %; the disagreements of a map are what its verdict is made of.
        {"stability_limits", {"scheme", "study", "limit"}, "passes", {"measured"}, round_off_of_schemes},
        {"stability_maps",
         {"scheme", "study"},
         "passes",
         {"disagreements", "undecided", "measured"},
         round_off_of_schemes},
        {"extreme_rows", {"scheme", "name"}, "passes", {"error"}, round_off_of_schemes},
        {"conditioning_rows", {"name", "study"}, "converged", {"iterations_two_level"}},
        {"conditioning_checks", {"subject", "name", "study"}, "passes", {"value"}, round_off_of_schemes},
        // The edge of the usable range, found by bisection.
        {"calibration",
         {"scheme", "depth", "duration", "dx", "dt"},
         "passes",
         {"usable"},
         round_off_of_schemes},
        {"claims", {"id", "group", "text"}, "agrees"},
        {"conservation", {"scheme", "group"}, "kept", {}},
    };
    return lists;
}
const std::vector<const char*> operator_identity{"operator", "dimension", "arrangement",
                                                 "path",     "kernel",    "tier"};
const std::vector<const char*> scheme_identity{"scheme", "group", "field", "tier"};

std::string text_of(const ResultTree& value) {
    return value.is_string() ? value.get<std::string>() : value.is_null() ? none : value.dump();
}

std::string text_of(double value, const char* format) {
    return std::isnan(value) ? none : number(value, format);
}

const ResultTree& member(const ResultTree& tree, const char* name) {
    static const ResultTree nothing;
    return tree.is_object() && tree.contains(name) ? tree.at(name) : nothing;
}

double number_of(const ResultTree& tree, const char* name) {
    const ResultTree& value = member(tree, name);
    return value.is_number() ? value.get<double>() : nan_value;
}

/// |after - before|/|before|; 0 for what is the same, infinite where either is no number.
double relative_change(const ResultTree& before, const ResultTree& after) {
    if (before == after) {
        return 0;
    }
    return before.is_number() && after.is_number()
               ? std::abs(after.get<double>() - before.get<double>()) / std::abs(before.get<double>())
               : std::numeric_limits<double>::infinity();
}

/// The first member, and the others put together. Throws UserError for an entry without identity: two of them
/// would be the same study. Only a tier may be missing (reports/FORMAT.md).
std::pair<std::string, std::string> identity_of(const ResultTree& entry,
                                                const std::vector<const char*>& names) {
    for (const char* name : names) {
        const ResultTree& value = member(entry, name);
        if (!value.is_string() && !value.is_number() && std::string_view(name) != "tier") {
            throw UserError("not a complete result or baseline: an entry has no '" + std::string(name) +
                            "' by which to find it: " + text_of(entry).substr(0, 80));
        }
    }
    std::string where;
    for (std::size_t k = 1; k < names.size(); ++k) {
        where += (where.empty() ? "" : ", ") + text_of(member(entry, names[k])) +
                 (std::string_view(names[k]) == "dimension" ? "-D" : "");
    }
    return {text_of(member(entry, names[0])), where};
}

std::string verdict_of(const ResultTree& study) {
    const ResultTree& fit = member(study, "fit");
    return text_of(member(fit, "verdict")) + (member(fit, "waiver").is_string() ? " (waived)" : "");
}

/// The runs that an entry is one field of.
std::string runs_of(const ResultTree& study) {
    return text_of(member(study, "scheme")) + "\n" + text_of(member(study, "group")) + "\n" +
           text_of(member(study, "tier"));
}

/// The expected band as text.
std::string band_of(const ResultTree& study) {
    const ResultTree& expected = member(study, "expected");
    const std::string low = text_of(member(expected, "low"));
    const std::string high = text_of(member(expected, "high"));
    return low == none && high == none ? none : low + "…" + high;
}

/// Whether a check is as it must be.
std::string outcome_of(const ResultTree& check, const char* passes) {
    if (member(check, passes).is_null()) {
        return none;
    }
    const ResultTree& waiver = member(check, "waiver");
    const bool waived = waiver.is_string() && !waiver.get<std::string>().empty();
    return std::string(member(check, passes) == true ? "holds" : "does not hold") +
           (waived ? " (waived)" : "");
}

/// Everything that is compared, by identity.
struct Contents {
    struct Study {
        std::string subject, where;
        const ResultTree* tree;
        bool of_operator;
        std::map<std::string, const ResultTree*> rungs;
    };
    struct Check {
        std::string subject, where;
        const ResultTree* tree;
        const CheckList* list;
    };
    std::map<std::string, Study> studies;
    std::map<std::string, Check> checks;
};

/// The entries of a list, which may be missing. Throws UserError for anything else.
const ResultTree& entries_of(const ResultTree& tree, const char* list) {
    const ResultTree& named = member(tree, list);
    const ResultTree& entries = named.is_object() ? member(named, "results") : named; // calibration
    if (!entries.is_null() && !entries.is_array()) {
        throw UserError("not a complete result or baseline: " + std::string(list) + " is not a list");
    }
    return entries;
}

/// Of every scheme of a group what it claims to conserve, and whether its runs that reached their end kept
/// it: the list of a baseline, or made of the runs of a result.
ResultTree conservation_of(const ResultTree& tree) {
    if (!member(tree, "conservation").is_null()) {
        return entries_of(tree, "conservation");
    }
    ResultTree list = ResultTree::array();
    for (const ResultTree& run : entries_of(tree, "runs")) {
        const ResultTree& budget = member(run, "budget");
        if (!member(budget, "claims").is_string()) {
            continue;
        }
        const auto same = [&](const ResultTree& entry) {
            return member(entry, "scheme") == member(run, "scheme") &&
                   member(entry, "group") == member(run, "group");
        };
        auto entry = std::ranges::find_if(list, same);
        if (entry == list.end()) {
            list.push_back({{"scheme", member(run, "scheme")},
                            {"group", member(run, "group")},
                            {"claims", member(budget, "claims")},
                            {"kept", true}});
            entry = std::prev(list.end());
        }
        const ResultTree& lost = member(budget, "lost");
        if (member(run, "survived") == true && lost.is_string() && !lost.get<std::string>().empty()) {
            (*entry)["kept"] = false;
        }
    }
    return list;
}

/// The checks of a list; `conservation` is that of the runs of `tree`.
const ResultTree& checks_of(const CheckList& list, const ResultTree& tree, const ResultTree& conservation) {
    return std::string_view(list.name) == "conservation" ? conservation : entries_of(tree, list.name);
}

/// A name that no other entry has: a study that stands twice in a file is compared twice, not passed over.
template <class Map>
std::string free_key(const Map& map, std::string key) {
    while (map.contains(key)) {
        key += " again";
    }
    return key;
}

/// Where an entry stands among its like: the list or nothing, the subject, the place.
std::string key_of(std::string_view list, const std::string& subject, const std::string& where) {
    std::string key(list);
    key.append("|").append(subject).append("|").append(where);
    return key;
}

[[noreturn]] void refuse_rung(const std::string& subject, const std::string& where) {
    throw UserError("not a complete result or baseline: a rung of " + subject + " (" + where +
                    ") has no 'n'");
}

/// "n = 40", and in time "n = 12, dt = 0.004".
std::string rung_of(const ResultTree& study, const ResultTree& sample) {
    const std::string n = "n = " + std::to_string(member(sample, "n").get<long>());
    return member(study, "axis") == "dt" ? n + ", dt = " + number(number_of(sample, "dt"), "%.6g") : n;
}

/// Of the claims of the literature only those are checks that are goals of the project.
bool is_check(const CheckList& list, const ResultTree& entry) {
    return std::string_view(list.name) != "claims" || member(entry, "binding") == true;
}

void collect_studies(const ResultTree& tree, const char* list, const std::vector<const char*>& identity,
                     Contents& contents) {
    for (const ResultTree& study : entries_of(tree, list)) {
        const auto [subject, where] = identity_of(study, identity);
        Contents::Study entry{subject, where, &study, &identity == &operator_identity, {}};
        for (const ResultTree& sample : entries_of(study, "samples")) {
            if (!member(sample, "n").is_number_integer()) {
                refuse_rung(subject, where);
            }
            entry.rungs[free_key(entry.rungs, rung_of(study, sample))] = &sample;
        }
        contents.studies.emplace(free_key(contents.studies, key_of("", subject, where)), std::move(entry));
    }
}

/// Points into `tree`, and into `conservation` that was made of it.
Contents contents_of(const ResultTree& tree, const ResultTree& conservation) {
    Contents contents;
    collect_studies(tree, "operator_studies", operator_identity, contents);
    collect_studies(tree, "studies", scheme_identity, contents);
    for (const CheckList& list : check_lists()) {
        for (const ResultTree& check : checks_of(list, tree, conservation)) {
            if (!is_check(list, check)) {
                continue;
            }
            const auto [subject, where] = identity_of(check, list.identity);
            contents.checks.emplace(free_key(contents.checks, key_of(list.name, subject, where)),
                                    Contents::Check{subject, where, &check, &list});
        }
    }
    return contents;
}

/// Round-off can end a solve of the pressure one iteration earlier or later; over independent solves, one a
/// step, that adds up to the square root of their number.
double tolerance_of_work(std::string_view name, const ResultTree& rung) {
    const double iterations = number_of(rung, "solver_iterations");
    const bool of_solves = name == "solver_iterations" || name == "matrix_entries";
    return of_solves && iterations > 0
               ? std::max(work_tolerance, std::sqrt(number_of(rung, "steps")) / iterations)
               : work_tolerance;
}

class Comparer {
public:
    Comparison run(const Contents& baseline, const Contents& current) {
        bool common = false;
        for (const auto& [key, before] : baseline.studies) {
            const auto after = current.studies.find(key);
            if (after == current.studies.end()) {
                note(Change::missing, before.subject, before.where, "study", "there", "not there");
                continue;
            }
            common = true;
            compare_study(before, after->second);
        }
        for (const auto& [key, before] : baseline.checks) {
            const auto after = current.checks.find(key);
            if (after == current.checks.end()) {
                note(Change::missing, before.subject, before.where, "check", "there", "not there");
                continue;
            }
            common = true;
            compare_check(before, after->second);
        }
        if (!common) {
            throw UserError("the two results have no study in common, so there is nothing to compare");
        }
        for (const auto& [key, after] : current.studies) {
            if (!baseline.studies.contains(key)) {
                note(Change::added, after.subject, after.where, "study", "not there", "there");
            }
        }
        for (const auto& [key, after] : current.checks) {
            if (!baseline.checks.contains(key)) {
                note(Change::added, after.subject, after.where, "check", "not there", "there");
            }
        }
        return std::move(result_);
    }

private:
    void note(Change change, const std::string& subject, const std::string& where, const std::string& what,
              const std::string& before, const std::string& after, double factor = 1) {
        result_.differences.push_back({change, subject, where, what, before, after, factor});
    }

    /// Counts one comparison and says whether it is done. What neither side has is no evidence of equality,
    /// so it is not counted; what one side lacks differs.
    bool settled(bool nothing, bool equal) {
        result_.compared += nothing ? 0 : 1;
        result_.bitwise += equal && !nothing ? 1 : 0;
        return nothing || equal;
    }
    bool settled(double before, double after) {
        return settled(std::isnan(before) && std::isnan(after), before == after);
    }

    /// One number; `otherwise` is the change if it is more than `tolerance`, or if one side has none.
    void compare_number(const Contents::Study& study, const std::string& rung, const char* name,
                        double before, double after, double tolerance, Change otherwise) {
        if (settled(before, after)) {
            return;
        }
        const double factor = after / before;
        const bool close = std::abs(after - before) <= tolerance * std::abs(before) ||
                           (otherwise == Change::error_level && !study.of_operator &&
                            std::abs(before) <= no_error && std::abs(after) <= no_error);
        note(close ? Change::round_off : otherwise, study.subject, study.where + ", " + rung, name,
             text_of(before, "%.4g"), text_of(after, "%.4g"), factor);
    }

    /// Errors and work of one rung.
    void compare_rung(const Contents::Study& study, const std::string& rung, const ResultTree& before,
                      const ResultTree& after, double round_off) {
        const std::string where = study.where + ", " + rung;
        const bool ended_before = member(before, "survived") == false; // all that a baseline says of it
        const bool ended_early = member(after, "survived") == false;
        if (ended_before || ended_early) {
            compare_word(Change::verdict, study.subject, where, "survived", ended_before ? "no" : "yes",
                         ended_early ? "no" : "yes");
        }
        for (const char* name : error_names) {
            compare_number(study, rung, name, number_of(before, name), number_of(after, name), round_off,
                           Change::error_level);
        }
        // All fields of a run do the same work; a baseline keeps it once.
        const bool kept = std::ranges::any_of(
            work_names, [&](const char* name) { return !std::isnan(number_of(before, name)); });
        for (const char* name : work_names) {
            if (kept && !ended_before) {
                compare_number(study, rung, name, number_of(before, name), number_of(after, name),
                               tolerance_of_work(name, before), Change::work);
            }
        }
        compare_seconds(study, rung, number_of(before, "seconds"), number_of(after, "seconds"));
    }

    /// A baseline that is older than a member has none.
    void compare_round_off(const Contents::Study& study, const ResultTree& before, const ResultTree& after) {
        if (!member(before, "round_off").is_null()) {
            compare_word(Change::demand, study.subject, study.where, "round_off",
                         text_of(member(before, "round_off")), text_of(member(after, "round_off")));
        }
    }

    void compare_word(Change change, const std::string& subject, const std::string& where,
                      const std::string& what, const std::string& before, const std::string& after) {
        if (!settled(before == none && after == none, before == after)) {
            note(change, subject, where, what, before, after);
        }
    }

    void compare_study(const Contents::Study& before, const Contents::Study& after) {
        compare_word(Change::demand, before.subject, before.where, "expected order", band_of(*before.tree),
                     band_of(*after.tree));
        compare_word(Change::demand, before.subject, before.where, "expected fate",
                     text_of(member(member(*before.tree, "expected"), "fate")),
                     text_of(member(member(*after.tree, "expected"), "fate")));
        for (const char* name : fate_names) {
            compare_demand(before.subject, before.where, "studies", member(*before.tree, "expected"),
                           member(*after.tree, "expected"), name);
        }
        compare_round_off(before, *before.tree, *after.tree);
        compare_word(Change::verdict, before.subject, before.where, "verdict", verdict_of(*before.tree),
                     verdict_of(*after.tree));
        compare_order(before, after);
        const double declared = number_of(*before.tree, "round_off");
        const double round_off = before.of_operator     ? round_off_of_operators
                                 : std::isnan(declared) ? round_off_of_schemes
                                                        : declared;
        for (const auto& [name, rung] : before.rungs) {
            const auto found = after.rungs.find(name);
            if (found == after.rungs.end()) {
                note(Change::missing, before.subject, before.where, name, "there", "not there");
                continue;
            }
            compare_rung(before, name, *rung, *found->second, round_off);
        }
        for (const auto& [name, rung] : after.rungs) {
            if (!before.rungs.contains(name)) {
                note(Change::added, after.subject, after.where, name, "not there", "there");
            }
        }
    }

    /// h takes part in the order, so it can change where no error does. An order that is gone is a change,
    /// too.
    void compare_order(const Contents::Study& before, const Contents::Study& after) {
        const ResultTree& fit_before = member(*before.tree, "fit");
        const ResultTree& fit_after = member(*after.tree, "fit");
        const double order_before = number_of(fit_before, "order");
        const double order_after = number_of(fit_after, "order");
        if (settled(order_before, order_after)) {
            return;
        }
        const double allowed =
            std::max(least_order_change, number_of(fit_before, "ci95") + number_of(fit_after, "ci95"));
        const bool close = std::abs(order_after - order_before) <= allowed; // not if one is missing
        note(close ? Change::round_off : Change::order, before.subject, before.where, "order",
             text_of(order_before, "%.3f"), text_of(order_after, "%.3f"));
    }

    void compare_seconds(const Contents::Study& study, const std::string& rung, double before, double after) {
        constexpr double noticeable = 1.5;
        constexpr double least = 0.1; // s: below, the clock tells of other work
        const double factor = after / before;
        // All fields of a run have the same seconds.
        const std::string of_run =
            (study.of_operator ? study.subject + "\n" + study.where : runs_of(*study.tree)) + "\n" + rung;
        if (!std::isnan(factor) && timed_.insert(of_run).second) {
            result_.seconds_before += before;
            result_.seconds_after += after;
        }
        if (std::max(before, after) >= least && (factor > noticeable || factor < 1 / noticeable)) {
            note(Change::run_time, study.subject, study.where + ", " + rung, "seconds",
                 number(before, "%.3g"), number(after, "%.3g"), factor);
        }
    }

    /// A demand that is gone is weaker than any. One that the baseline does not keep yet is reported under
    /// its list, one row for all, and fails nothing. Some are computed, so they are equal to round-off only.
    void compare_demand(const std::string& subject, const std::string& where, const char* list,
                        const ResultTree& before, const ResultTree& after, const char* name) {
        const ResultTree& old_demand = member(before, name);
        const ResultTree& demand = member(after, name);
        if (old_demand.is_null() && !demand.is_null()) {
            note(Change::added, list, subject + (where.empty() ? "" : ", ") + where, name, none,
                 text_of(demand));
            return;
        }
        if (settled(demand.is_null() && old_demand.is_null(), demand == old_demand)) {
            return;
        }
        const auto near = [](const ResultTree& x, const ResultTree& y) {
            return relative_change(x, y) <= round_off_of_operators;
        };
        const bool lists = old_demand.is_array() && demand.is_array() && old_demand.size() == demand.size();
        const bool close = lists ? std::ranges::equal(old_demand, demand, near) : near(old_demand, demand);
        const double x = number_of(before, name);
        const double y = number_of(after, name);
        note(close ? Change::round_off : Change::demand, subject, where, name, text_of(old_demand),
             text_of(demand), old_demand.is_number() ? y / x : 1);
    }

    void compare_check(const Contents::Check& before, const Contents::Check& after) {
        compare_word(Change::verdict, before.subject, before.where, before.list->passes,
                     outcome_of(*before.tree, before.list->passes),
                     outcome_of(*after.tree, before.list->passes));
        for (const char* name : demand_names) {
            compare_demand(before.subject, before.where, before.list->name, *before.tree, *after.tree, name);
        }
        for (const char* name : before.list->values) {
            if (member(*before.tree, name).is_array()) {
                compare_list(before, after, name);
            } else {
                compare_value(before, after, name);
            }
        }
    }

    /// Every number of a list, such as the growth at each point of a map: the worst of them stands for all.
    void compare_list(const Contents::Check& before, const Contents::Check& after, const char* name) {
        const ResultTree& old_list = member(*before.tree, name);
        const ResultTree& list = member(*after.tree, name);
        if (settled(false, old_list == list)) {
            return;
        }
        if (!list.is_array() || list.size() != old_list.size()) {
            note(Change::error_level, before.subject, before.where, name,
                 "of " + std::to_string(old_list.size()),
                 list.is_array() ? "of " + std::to_string(list.size()) : text_of(list));
            return;
        }
        std::size_t worst = 0;
        double most = 0;
        for (std::size_t k = 0; k < list.size(); ++k) {
            const double change = relative_change(old_list[k], list[k]);
            if (change > most) {
                worst = k;
                most = change;
            }
        }
        note(most <= before.list->round_off ? Change::round_off : Change::error_level, before.subject,
             before.where, std::string(name) + " at " + std::to_string(worst), text_of(old_list[worst]),
             text_of(list[worst]), most + 1);
    }

    void compare_value(const Contents::Check& before, const Contents::Check& after, const char* measured) {
        const double value_before = number_of(*before.tree, measured);
        const double value_after = number_of(*after.tree, measured);
        if (settled(value_before, value_after)) {
            return;
        }
        if (measured != before.list->values.front() &&
            std::isnan(value_before)) { // younger than the baseline
            note(Change::added, before.list->name, before.where, measured, none,
                 text_of(value_after, "%.6g"));
            return;
        }
        note(equal_to_round_off(before, value_before, value_after) ? Change::round_off : Change::error_level,
             before.subject, before.where, measured, text_of(value_before, "%.6g"),
             text_of(value_after, "%.6g"), value_after / value_before);
    }

    /// Whether values of a check differ by no more than what its list, its bound and its tolerance let pass.
    static bool equal_to_round_off(const Contents::Check& check, double before, double after) {
        const std::string_view list = check.list->name;
        const double bound = number_of(*check.tree, "bound");
        const double change = std::abs(after - before);
        const bool close = change <= check.list->round_off * std::abs(before);
        // Round-off has no digits to compare; it is held to its bound by the check itself.
        const bool both_round_off =
            bound <= bound_of_round_off && std::abs(before) <= bound && std::abs(after) <= bound;
        const bool tiny = std::abs(before) < 1e-9 && std::abs(after) < 1e-9;
        // A film that rests at 5e-7 under a bound of 1 is at what a solver leaves.
        const bool immaterial = list == "extreme_rows" && change <= 1e-5 * bound;
        // A scene that is held to no bound, or not by it, may amplify rounding without limit: at a surface
        // the last bit of a distance decides a shift, and starts that differ by 4e-16 end up to 4 times
        // apart.
        const bool unheld = list == "extreme_rows" && (member(*check.tree, "fate") == "survives" ||
                                                       member(*check.tree, check.list->passes) == false);
        const bool of_one_size = before > 0 && after <= 10 * before && after >= before / 10;
        // A kernel's smoothness is an estimate from differences, good to the tolerance of its check and no
        // better; so is a number of iterations. That of a published figure is a distance from the figure.
        const bool within_tolerance =
            list != "published_figures" && change <= number_of(*check.tree, "tolerance");
        return close || both_round_off || tiny || immaterial || (unheld && of_one_size) || within_tolerance;
    }

    Comparison result_;
    std::set<std::string> timed_; ///< runs whose seconds are in the sums
};

/// Distance of a factor from one, up and down alike; not-a-number is worst.
double size_of(const Difference& difference) {
    const double size = std::abs(std::log(difference.factor));
    return std::isnan(size) ? std::numeric_limits<double>::infinity() : size;
}

ResultTree picked(const ResultTree& tree, const std::vector<const char*>& names) {
    ResultTree result = ResultTree::object();
    for (const char* name : names) {
        if (!member(tree, name).is_null()) {
            result[name] = member(tree, name);
        }
    }
    return result;
}

ResultTree reduced_study(const ResultTree& study, const std::vector<const char*>& identity) {
    ResultTree result = picked(study, identity);
    std::vector<const char*> demands{"low", "high", "fate"};
    demands.insert(demands.end(), fate_names.begin(), fate_names.end());
    result["expected"] = picked(member(study, "expected"), demands);
    if (member(study, "axis") == "dt") {
        result["axis"] = "dt";
    }
    if (!member(study, "round_off").is_null()) {
        result["round_off"] = member(study, "round_off");
    }
    result["fit"] = picked(member(study, "fit"), {"order", "ci95", "verdict", "waiver"});
    result["samples"] = ResultTree::array();
    std::vector<const char*> kept{"n"};
    if (result.contains("axis")) {
        kept.push_back("dt");
    }
    kept.insert(kept.end(), error_names.begin(), error_names.end());
    kept.insert(kept.end(), work_names.begin(), work_names.end());
    for (const ResultTree& sample : member(study, "samples")) {
        result["samples"].push_back(picked(sample, kept));
        if (member(sample, "survived") == false) {
            result["samples"].back()["survived"] = false;
        }
    }
    return result;
}

/// Takes the work out of `study` where an entry before it is another field of the same runs.
void keep_work_once(const ResultTree& entries, ResultTree& study) {
    const auto same_runs = [&](const ResultTree& other) {
        return runs_of(other) == runs_of(study) && other.at("samples").size() == study.at("samples").size();
    };
    if (!study.contains("field") || std::ranges::none_of(entries, same_runs)) {
        return;
    }
    for (ResultTree& sample : study["samples"]) {
        for (const char* name : work_names) {
            sample.erase(name);
        }
    }
}

void refuse_unless_passing(const ResultTree& study, const std::vector<const char*>& identity) {
    const std::string verdict = verdict_of(study);
    if (verdict != "PASS" && verdict != "NONE" && !verdict.ends_with("(waived)")) {
        const auto [subject, where] = identity_of(study, identity);
        throw UserError("no baseline is made of a result that does not pass: " + subject + " (" + where +
                        ") is " + verdict);
    }
}

void refuse_unless_holding(const ResultTree& check, const CheckList& list) {
    const ResultTree& waiver = member(check, "waiver");
    const bool known = waiver.is_string() && !waiver.get<std::string>().empty();
    if ((member(check, list.passes) == true) == known) {
        const auto [subject, where] = identity_of(check, list.identity);
        throw UserError("no baseline is made of a result that does not pass: " + subject + " (" + where +
                        ") is not as it must be, see " + list.name);
    }
}

} // namespace

std::string_view to_string(Change change) {
    constexpr std::array<std::string_view, 10> names{"bitwise equal", "equal to round-off",
                                                     "run time",      "new",
                                                     "work",          "error level",
                                                     "order",         "demand",
                                                     "verdict",       "missing"};
    return names[static_cast<std::size_t>(change)];
}

bool Comparison::fails() const {
    return std::ranges::any_of(differences, [](const Difference& d) { return d.change >= Change::work; });
}

ResultTree read_comparable(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    if (!stream || (stream >> std::ws).peek() != '{') {
        solver::storage::read_in_trial(path);
        ResultTree tree = read_results_hdf5(path);
        check_result_file(tree, path);
        return tree;
    }
    ResultTree tree = ResultTree::parse(stream, nullptr, false);
    if (member(tree, "format") == "sphvv-results") {
        check_result_file(tree, path);
        return tree;
    }
    if (member(tree, "format") != "sphvv-baseline" || member(tree, "format_version") != 1) {
        throw UserError("'" + path.string() +
                        "' is neither a result file of sphvv (HDF5 or JSON) nor a baseline");
    }
    return tree;
}

Comparison compare(const ResultTree& baseline, const ResultTree& current) {
    const ResultTree before = conservation_of(baseline);
    const ResultTree after = conservation_of(current);
    return Comparer().run(contents_of(baseline, before), contents_of(current, after));
}

std::string markdown(const Comparison& comparison, std::size_t most_lines) {
    const std::size_t most_rows = most_lines - 6; // without headings, counts and what is left out
    struct Group {
        const Difference* worst;
        std::size_t count;
    };
    std::map<std::pair<int, std::string>, Group> groups; // worst kind of change first
    std::map<Change, std::size_t> counts;
    for (const Difference& d : comparison.differences) {
        ++counts[d.change];
        if (d.change == Change::round_off || (comparison.fails() && d.change < Change::work)) {
            continue;
        }
        const auto [group, fresh] =
            groups.try_emplace({-static_cast<int>(d.change), d.subject}, Group{&d, 0});
        ++group->second.count;
        if (!fresh && size_of(d) > size_of(*group->second.worst)) {
            group->second.worst = &d;
        }
    }
    std::string text;
    if (comparison.bitwise == comparison.compared && comparison.differences.empty()) {
        return "bitwise equal: " + std::to_string(comparison.compared) + " numbers and words\n";
    }
    if (!groups.empty()) {
        MarkdownTable table({"change", "of", "worst at", "what", "baseline", "current", "factor", "cases"});
        std::size_t rows = 0;
        for (const auto& [key, group] : groups) {
            if (++rows > most_rows) {
                break;
            }
            const Difference& d = *group.worst;
            table.add({std::string(to_string(d.change)), d.subject, d.where, d.what, d.baseline, d.current,
                       text_of(d.factor, "%.6g"), std::to_string(group.count)});
        }
        text += table.text();
        if (groups.size() > most_rows) {
            text += std::to_string(groups.size() - most_rows) + " more rows are in the JSON form\n";
        }
        text += "\n";
    }
    text += std::to_string(comparison.compared) + " compared: " + std::to_string(comparison.bitwise) +
            " bitwise equal";
    for (const auto& [change, count] : counts) {
        text += ", " + std::to_string(count) + " " + std::string(to_string(change));
    }
    return text + (comparison.fails() ? "; FAIL\n" : "; PASS\n");
}

std::string summary(const Comparison& comparison, const ResultTree& baseline, const ResultTree& current) {
    const auto build = [](const ResultTree& tree) {
        const ResultTree& provenance = member(tree, "provenance");
        return text_of(member(provenance, "revision")).substr(0, 12) +
               (member(provenance, "tree_clean") == false ? " with changes" : "") + " (" +
               text_of(member(provenance, "compiler")) + ", " + text_of(member(provenance, "cpu")) + ")";
    };
    constexpr std::size_t lines_around = 8;
    std::string text = "### Regression gate: " + std::string(comparison.fails() ? "FAIL" : "PASS") + "\n\n" +
                       "baseline " + build(baseline) + "; current " + build(current) + "\n\n" +
                       markdown(comparison, 40 - lines_around);
    if (comparison.seconds_before > 0) {
        text += "\nrun time of what both time: " + number(comparison.seconds_before, "%.3g") + " s, now " +
                number(comparison.seconds_after, "%.3g") + " s (informational)\n";
    }
    return text;
}

ResultTree merged(std::span<const ResultTree> results) {
    ResultTree all = results.front();
    for (const ResultTree& result : results.subspan(1)) {
        for (const char* name : {"revision", "tree_clean", "compiler", "flags"}) {
            const ResultTree& first = member(member(all, "provenance"), name);
            const ResultTree& other = member(member(result, "provenance"), name);
            if (first != other) {
                throw UserError("the results are of different builds: " + std::string(name) + " is " +
                                text_of(first) + " in one and " + text_of(other) + " in another");
            }
        }
        if (member(member(result, "provenance"), "interrupted") == true) {
            all["provenance"]["interrupted"] = true;
        }
        for (const auto& [name, value] : result.items()) {
            if (value.is_array()) {
                ResultTree& list = all[name];
                for (const ResultTree& entry : value) {
                    list.push_back(entry);
                }
            } else if (!all.contains(name)) {
                all[name] = value;
            } else if (name == "calibration") {
                for (const ResultTree& entry : member(value, "results")) {
                    all[name]["results"].push_back(entry);
                }
            }
        }
    }
    return all;
}

ResultTree reduced_for_baseline(const ResultTree& result, bool allow_dirty) {
    if (!allow_dirty && member(member(result, "provenance"), "tree_clean") != true) {
        throw UserError("no baseline is made of a result whose source was not committed when it was built, "
                        "since no revision reproduces it; --allow-dirty does it all the same");
    }
    if (member(member(result, "provenance"), "interrupted") == true) {
        throw UserError("no baseline is made of an interrupted run, which lacks studies");
    }
    ResultTree baseline{{"format", "sphvv-baseline"}, {"format_version", 1}};
    baseline["provenance"] =
        picked(member(result, "provenance"), {"revision", "tree_clean", "compiler", "flags", "cpu"});
    for (const auto& [list, identity] :
         {std::pair{"operator_studies", &operator_identity}, std::pair{"studies", &scheme_identity}}) {
        baseline[list] = ResultTree::array();
        for (const ResultTree& study : member(result, list)) {
            refuse_unless_passing(study, *identity);
            ResultTree reduced = reduced_study(study, *identity);
            keep_work_once(baseline[list], reduced);
            baseline[list].push_back(std::move(reduced));
        }
    }
    const ResultTree conservation = conservation_of(result);
    for (const CheckList& list : check_lists()) {
        baseline[list.name] = ResultTree::array();
        std::vector<const char*> kept = list.identity;
        kept.insert(kept.end(), demand_names.begin(), demand_names.end());
        kept.insert(kept.end(), list.values.begin(), list.values.end());
        kept.insert(kept.end(), {"waiver", "binding", list.passes});
        for (const ResultTree& check : checks_of(list, result, conservation)) {
            if (!is_check(list, check)) {
                continue;
            }
            refuse_unless_holding(check, list);
            baseline[list.name].push_back(picked(check, kept));
        }
    }
    return baseline;
}

std::string baseline_text(const ResultTree& baseline) {
    std::string text = "{";
    bool first = true;
    for (const auto& [name, value] : baseline.items()) {
        text += (first ? "\n" : ",\n") + ResultTree(name).dump() + ": ";
        first = false;
        if (!value.is_array()) {
            text += value.dump();
            continue;
        }
        text += "[";
        for (std::size_t k = 0; k < value.size(); ++k) {
            text += k == 0 ? "\n" : ",\n";
            if (!value[k].contains("samples")) {
                text += value[k].dump();
                continue;
            }
            ResultTree head = value[k];
            head.erase("samples");
            std::string line = head.dump();
            line.pop_back();
            text += line + ",\"samples\":[";
            const ResultTree& samples = value[k].at("samples");
            for (std::size_t r = 0; r < samples.size(); ++r) {
                text += (r == 0 ? "\n " : ",\n ") + samples[r].dump();
            }
            text += "]}";
        }
        text += "]";
    }
    return text + "\n}\n";
}

} // namespace sphvv::verification
