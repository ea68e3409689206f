#pragma once

#include "core/types/modal_estimate.h"
#include "firmware_app/report/plot/mode_layout.h"
#include "firmware_app/report/plot/svg_plot.h"

namespace app {

struct ModePlotSpec {
  Box box;
  double low_px = 0.0, high_px = 1.0;  // stretch of the structure that is shown, in image pixels
  bool with_names = true;              // of the regions, beside or below the panel
};

// The components of one mode along the structure: one panel, -1 .. 1 across it, with a bar of one standard deviation to
// both sides where that is known.
void draw_mode_plot(SvgDocument& svg, const ModePlotSpec& spec, const ModeLayout& layout, const core::Mode& mode);

}  // namespace app
