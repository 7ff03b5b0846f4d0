#pragma once

#include "sphvv/verification/provenance.hpp"
#include "sphvv/verification/study.hpp"

#include <nlohmann/json.hpp>

namespace sphvv::verification {

/// The tree that a result file holds (reports/FORMAT.md), as JSON and HDF5 alike.
nlohmann::ordered_json result_document(const std::string& command, const Provenance& provenance,
                                       double seconds, std::span<const LadderResult> results);

} // namespace sphvv::verification
