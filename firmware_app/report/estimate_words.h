#pragma once

#include <string>
#include <vector>

#include "core/types/displacement.h"
#include "core/types/modal_estimate.h"

namespace app {

// What a reader must know before the numbers: channels that take no part, samples masked by the gate, poles that are no
// modes only because the record is short or the alias order open. Whole sentences, the gravest first; for the log, the
// terminal and the report's first lines.
[[nodiscard]] std::vector<std::string> estimate_words(const core::ModalEstimate& estimate,
                                                      const std::vector<core::ChannelInfo>& channels);

// ", or 17.3, 32.7 Hz" where the samples do not exclude other frequencies; else empty.
[[nodiscard]] std::string other_frequencies_text(const core::Mode& mode);

// The estimate with the unknown components of its shapes as NaN, which pictures leave out.
[[nodiscard]] core::ModalEstimate with_unknown_components(const core::ModalEstimate& estimate);

}  // namespace app
