#pragma once

#include "sphvv/verification/case.hpp"
#include "sphvv/verification/kernel_checks.hpp"
#include "sphvv/verification/operator_study.hpp"
#include "sphvv/verification/published_operators.hpp"

#include <nlohmann/json.hpp>

#include <array>

namespace sphvv::verification {

/// Everything that `sphvv operators` finds.
struct OperatorResults {
    std::string tier;
    std::vector<OperatorStudy> studies;
    std::vector<PropertyCheck> properties;
    std::vector<OperatorCost> costs;
    std::vector<OperatorFront> fronts;
    // Only where all operators are asked for:
    std::vector<KernelCheck> kernel_checks;
    std::vector<KernelCheck> known_errors; ///< wrong constants in print, which the checks must refuse
    std::vector<PublishedFigure> figures;
    std::vector<ConsistencyRow> consistency_sums;
};

/// s: the budget of all operators in a tier, processor time of all threads.
struct OperatorTier {
    Tier tier;
    double cost;
};
inline constexpr std::array operator_tiers{OperatorTier{Tier::quick, 160}, OperatorTier{Tier::nightly, 1500}};

/// Studies, properties and costs of the operators; with `everything`, also the kernels and the published
/// figures.
OperatorResults run_operator_workbench(std::span<const solver::Operator* const> operators,
                                       std::string_view tier, const solver::Kernel& kernel, bool everything,
                                       const OperatorProgress& progress = {});

/// Adds the members that reports/FORMAT.md lists under "operator workbench".
void add_to_document(const OperatorResults& results, nlohmann::ordered_json& document);

/// One row an operator with the order of every ladder, then whatever did not pass with its reason; with
/// `details`, also the ladders of every operator in full.
std::string markdown(const OperatorResults& results, bool details);

/// 0, or 1 if a verdict, a property, a kernel or a published figure is not as it must be.
int exit_status(const OperatorResults& results);

} // namespace sphvv::verification
