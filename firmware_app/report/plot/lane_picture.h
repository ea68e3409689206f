#pragma once

#include <optional>
#include <string>
#include <vector>

#include "firmware_app/report/pictures/parts.h"
#include "firmware_app/report/plot/svg_plot.h"

namespace app {

// One curve over time in a panel of its own.
struct Lane {
  std::string name;
  std::string remark;                          // beside the name, e.g. its rms
  std::vector<PlotPoint> points;               // x in seconds since the first sample
  std::vector<std::vector<PlotPoint>> behind;  // for comparison, drawn behind; may leave the panel
  bool empty = true;                           // no sample at all
  double low = 0.0, high = 0.0;                // of all samples, including those not drawn
};

struct LanesText {
  std::string title;
  std::string quantity;  // with its unit
  std::string unit;
  std::optional<PlotAxis> range;  // of every lane; empty: each lane centred on its own data, all with the same span
};

// Lanes one below the other, so that amplitudes can be compared. `lanes` must not be empty.
[[nodiscard]] std::string lanes_svg(const std::vector<Lane>& lanes, double duration_s, const LanesText& text,
                                    const PictureFormat& format);

[[nodiscard]] PlotAxis time_axis(double duration_s);

}  // namespace app
