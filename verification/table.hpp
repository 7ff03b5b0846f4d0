#pragma once

#include "sphvv/verification/study.hpp"

#include <string>

namespace sphvv::verification {

/// The Markdown tables of a ladder, one a scheme and field, each followed by its fit and verdict; then the
/// error-against- cost table, the claims and the waivers. This is what `sphvv verify` prints.
std::string markdown(const LadderResult& result);

/// An expected order: "0.9…2", "≥ 0.9" or "≤ 0.5".
std::string band(const Expected& expected);

/// "order 1.10 ± 0.27 (expected 0.9...2, SOURCE) PASS" without the leading word "fit: ".
std::string verdict_line(const FieldStudy& study);

} // namespace sphvv::verification
