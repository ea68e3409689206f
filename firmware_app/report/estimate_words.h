#pragma once

#include <string>
#include <vector>

#include "core/types/displacement.h"
#include "core/types/modal_estimate.h"

namespace app {

// Warnings for the reader of an estimate: excluded channels, samples masked by the gate, poles that are not listed as
// modes only because the record is short or the alias order open. Whole sentences, the most serious first; for the log,
// terminal and the report's first lines.
[[nodiscard]] std::vector<std::string> estimate_words(const core::ModalEstimate& estimate,
                                                      const std::vector<core::ChannelInfo>& channels);

// ", or 17.3, 32.7 Hz": other frequencies that the samples do not exclude; empty: there are none.
[[nodiscard]] std::string other_frequencies_text(const core::Mode& mode);

// The estimate with the unknown components of its shapes set to NaN, which pictures leave out.
[[nodiscard]] core::ModalEstimate with_unknown_components(const core::ModalEstimate& estimate);

}  // namespace app
