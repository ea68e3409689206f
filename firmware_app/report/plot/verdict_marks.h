#pragma once

#include <array>

#include "core/types/modal_estimate.h"
#include "firmware_app/report/plot/svg_document.h"

namespace app {

// How a pole of each verdict looks in every picture: a shape, a colour and words, so that none stands alone.
struct VerdictMark {
  core::Verdict verdict;
  const char* label;       // for legends
  const char* plural;      // "7 input peaks"
  const char* line_class;  // of a vertical line
  Marker marker;
  const char* marker_class;
  const char* meaning;  // one sentence for people
};

[[nodiscard]] const std::array<VerdictMark, 7>& verdict_marks() noexcept;
[[nodiscard]] const VerdictMark& mark_of(core::Verdict verdict) noexcept;

}  // namespace app
