#pragma once

#include <string>
#include <vector>

#include "core/types/modal_estimate.h"
#include "firmware_app/report/pictures/parts.h"
#include "firmware_app/report/plot/svg_plot.h"

namespace app {

// Labels of the modes above a panel whose x axis is the apparent frequency: a vertical line each with its frequency
// above, in as many rows as are needed to keep them apart.
class ModeLabels {
 public:
  // `box_x_px`, `box_width_px`: position of the panel; its x axis is 0 .. `highest_hz`.
  ModeLabels(const core::ModalEstimate* estimate, double highest_hz, double box_x_px, double box_width_px,
             const PictureFormat& format);

  [[nodiscard]] double height_px() const noexcept { return kRowPx * n_rows_; }  // room required above the panel
  void draw(SvgDocument& svg, const PlotPanel& panel) const;
  [[nodiscard]] const std::vector<core::Mode>& modes() const noexcept { return modes_; }  // by apparent frequency

 private:
  static constexpr double kRowPx = 15.0;

  std::vector<core::Mode> modes_;
  std::vector<std::string> labels_;
  std::vector<double> label_x_px_;
  std::vector<int> rows_;
  int n_rows_ = 0;
};

// Rejected poles at their apparent frequency: a line for those with a known cause, on the page also a marker each
// along the panel's upper edge.
void draw_rejected(SvgDocument& svg, PlotPanel& panel, const core::ModalEstimate* estimate, double highest_hz,
                   const PictureFormat& format);

// "mode 12.93 Hz, seen at 12.07": the text shown at the cursor.
[[nodiscard]] std::string say_attribute(const core::Mode& mode);

}  // namespace app
