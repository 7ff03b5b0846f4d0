#pragma once

#include "sphvv/verification/case.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Scenes at and past the edge of what a scheme is made for. Each row says what must become of it, and why.
/// The scenes are in verification/extreme_scenes/, one kind of edge a file.
namespace sphvv::verification {

enum class Fate {
    bounded,  ///< survives, with an error under a bound from an exact solution or a scaling argument
    survives, ///< survives; nothing more can be claimed
    ends      ///< ends early, with one of these diagnoses
};
std::string_view to_string(Fate fate);

struct ExtremeOutcome {
    bool survived = false;
    std::string diagnosis; ///< of a run that ended
    double error = 0;      ///< of what the row measures
    std::int64_t steps = 0;
};

struct ExtremeRow {
    std::string name;
    std::string scheme; ///< a variant
    std::string must;   ///< what must become of it, and what `error` is
    std::string why;    ///< theory or source
    Fate fate;
    double bound = 0;                     ///< of the error, where it survives
    std::vector<std::string> diagnoses{}; ///< how the text may begin with which it must end
    std::function<ExtremeOutcome(const std::string& scheme)> run{};
    std::string waiver{}; ///< reason for which another outcome is tolerated
    Tier tier = Tier::quick;
};

struct ExtremeResult {
    ExtremeRow row;
    ExtremeOutcome outcome;
    std::string verdict; ///< PASS or FAIL
    std::string reason;
    double seconds = 0;
};

/// The rows of every file in verification/extreme_scenes/. The quick ones take 23 s of one processor
/// together, the nightly ones 164 s.
std::span<const ExtremeRow> extreme_rows();

/// A study is all rows of a tier.
struct ExtremeStudy {
    std::string name;
    Tier tier;
    double cost; ///< s: the budget, processor time
};
std::span<const ExtremeStudy> extreme_studies();

/// FAIL for another fate or diagnosis, for an error that is not finite, and for one above its bound.
void judge(ExtremeResult& result);

/// Runs and judges a row. What its run throws other than a diagnosis is a FAIL with that text; no row keeps
/// the others from running.
ExtremeResult run_extreme(const ExtremeRow& row);

std::string markdown(std::span<const ExtremeResult> results);
/// Adds `extreme_rows` (reports/FORMAT.md).
void add_to_document(std::span<const ExtremeResult> results, nlohmann::ordered_json& document);
/// 1 if a row without a waiver failed.
int exit_status(std::span<const ExtremeResult> results);

} // namespace sphvv::verification
