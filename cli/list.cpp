#include "sphvv/analytic/solutions.hpp"
#include "sphvv/solver/boundaries/wall_methods.hpp"
#include "sphvv/solver/operators.hpp"
#include "sphvv/solver/schemes.hpp"
#include "sphvv/verification/cases.hpp"
#include "sphvv/verification/conditioning.hpp"
#include "sphvv/verification/extreme.hpp"
#include "sphvv/verification/operator_results.hpp"
#include "sphvv/verification/stability.hpp"

#include "commands.hpp"
#include "output.hpp"
#include <algorithm>
#include <iostream>
#include <memory>

namespace sphvv::cli {
namespace {

using Entries = nlohmann::ordered_json;

template <class Registry>
Entries entries_of(const Registry& registry) {
    Entries entries = Entries::array();
    for (const auto* entry : registry) {
        entries.push_back({{"name", entry->name}, {"summary", entry->summary}, {"source", entry->source}});
    }
    return entries;
}

Entries keys_tree(const std::vector<solver::Key>& keys) {
    Entries list = Entries::array();
    for (const solver::Key& key : keys) {
        list.push_back({{"name", key.name},
                        {"value", key.value},
                        {"unit", key.unit},
                        {"accepted", key.accepted()},
                        {"summary", key.summary}});
    }
    return list;
}

Entries cases() {
    Entries entries = entries_of(verification::cases::all());
    for (Entries& entry : entries) {
        entry["keys"] = keys_tree(case_keys(verification::cases::find(entry["name"].get<std::string>())));
    }
    return entries;
}

Entries schemes() {
    Entries entries = entries_of(solver::schemes::all());
    for (Entries& entry : entries) {
        const solver::Scheme& scheme = solver::schemes::find(entry["name"].get<std::string>());
        entry["formula"] = scheme.formula;
        entry["keys"] = keys_tree(scheme.keys);
    }
    return entries;
}

std::string tier_text(verification::Tier tier, double cost) {
    return std::string(to_string(tier)) + " tier, " + verification::duration_text(cost) +
           " of processor time: ";
}

Entries studies() {
    Entries entries = Entries::array();
    for (const auto& [tier, cost] : verification::operator_tiers) {
        entries.push_back({{"name", "operators"},
                           {"summary", tier_text(tier, cost) + "all operators and kernels"},
                           {"source", "each operator's own"},
                           {"command", "operators"},
                           {"tier", to_string(tier)},
                           {"cost", cost}});
    }
    for (const verification::Case* flow : verification::cases::all()) {
        for (const verification::Study& study : flow->studies) {
            std::string summary = tier_text(study.tier, study.cost);
            for (const std::string& scheme : study.schemes) {
                summary += scheme + " ";
            }
            summary += "at n =";
            for (const int n : study.ladder) {
                summary += " " + std::to_string(n);
            }
            entries.push_back({{"name", study.name},
                               {"summary", summary},
                               {"source", flow->source},
                               {"command", "verify"},
                               {"tier", to_string(study.tier)},
                               {"cost", study.cost}});
        }
    }
    const auto add = [&](const auto& study, const std::string& summary, const std::string& source) {
        entries.push_back({{"name", study.name},
                           {"summary", tier_text(study.tier, study.cost) + summary},
                           {"source", source},
                           {"command", "stability"},
                           {"tier", to_string(study.tier)},
                           {"cost", study.cost}});
    };
    for (const verification::ExtremeStudy& study : verification::extreme_studies()) {
        add(study, "scenes at and past the edge of what the schemes are made for", "each row's own");
    }
    for (const verification::ConditioningStudy& study : verification::conditioning_studies()) {
        add(study, study.summary, "each check's own");
    }
    for (const verification::StabilityStudy& study : verification::stability_studies()) {
        add(study, study.summary, study.source);
    }
    return entries;
}

Entries operators() {
    Entries entries = entries_of(solver::operators::all());
    for (Entries& entry : entries) {
        const solver::Operator& op = solver::operators::find(entry["name"].get<std::string>());
        entry["formula"] = op.formula;
        entry["approximates"] = to_string(op.approximates);
    }
    return entries;
}

Entries boundaries() {
    Entries entries = entries_of(solver::wall_methods::all());
    for (Entries& entry : entries) {
        entry["formula"] = solver::wall_methods::find(entry["name"].get<std::string>()).formula;
    }
    return entries;
}

struct Subject {
    const char* name;
    Entries (*entries)();
};

const std::vector<Subject>& subjects() {
    static const std::vector<Subject> all{
        {"cases", cases},
        {"schemes", schemes},
        {"operators", operators},
        {"kernels", [] { return entries_of(solver::kernels::all()); }},
        {"turbulence", [] { return entries_of(solver::turbulence::all()); }},
        {"wall_functions", [] { return entries_of(solver::wall_functions::all()); }},
        {"boundaries", boundaries},
        {"studies", studies},
        {"solutions", [] { return entries_of(analytic::solutions::all()); }},
    };
    return all;
}

int list(const std::string& wanted, const Common& common) {
    Entries found = Entries::array();
    std::string text;
    for (const Subject& subject : subjects()) {
        if (!wanted.empty() && wanted != subject.name) {
            continue;
        }
        if (wanted.empty()) {
            text += std::string(text.empty() ? "" : "\n") + subject.name + "\n";
        }
        for (Entries entry : subject.entries()) {
            std::string name = entry["name"];
            name.resize(std::max<std::size_t>(name.size(), 26), ' ');
            text += (wanted.empty() ? "  " : "") + name + "  " + entry["summary"].get<std::string>() + "  [" +
                    entry["source"].get<std::string>() + "]\n";
            if (wanted.empty()) {
                entry["kind"] = subject.name;
            }
            found.push_back(entry);
        }
    }
    if (!common.json.empty()) {
        write_text(common.json, found.dump(2) + "\n");
    }
    if (common.json != "-") {
        std::cout << text;
    }
    return 0;
}

} // namespace

void add_list(CLI::App& app, Act& act) {
    struct Options {
        Common common;
        std::string subject;
    };
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("list", "what there is, one line each with its source");
    std::vector<std::string> names;
    for (const Subject& subject : subjects()) {
        names.emplace_back(subject.name);
    }
    command
        ->add_option("subject", options->subject,
                     "cases, schemes, operators, kernels, boundaries, studies or solutions; all if left out")
        ->check(CLI::IsMember(names));
    add_common(*command, options->common);
    command->footer("Example: sphvv list schemes --json -");
    command->callback(
        [options, &act] { act = [options] { return list(options->subject, options->common); }; });
}

} // namespace sphvv::cli
