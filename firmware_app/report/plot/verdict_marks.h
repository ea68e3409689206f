#pragma once

#include <array>

#include "core/types/modal_estimate.h"
#include "firmware_app/report/plot/svg_document.h"

namespace app {

// Appearance of a pole of each verdict in every picture: shape, colour and words, so that none is needed alone.
struct VerdictMark {
  core::Verdict verdict;
  const char* label;       // for legends
  const char* plural;      // "7 input peaks"
  const char* line_class;  // of a vertical line
  Marker marker;
  const char* marker_class;
  const char* meaning;  // one sentence for readers
};

[[nodiscard]] const std::array<VerdictMark, 7>& verdict_marks() noexcept;
[[nodiscard]] const VerdictMark& mark_of(core::Verdict verdict) noexcept;

}  // namespace app
