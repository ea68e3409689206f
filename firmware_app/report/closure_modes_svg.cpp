#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware_app/report/closure_json.h"
#include "firmware_app/report/plot/svg_plot.h"

namespace app {
namespace {

using core::closure::ClosureMode;
using core::closure::ClosureResult;

constexpr double kWidthPx = 760.0, kHeightPx = 400.0;
constexpr Box kBox{74.0, 46.0, 500.0, 290.0};
constexpr double kApart = 0.12;  // of a mode's width: "before" is drawn to the left, "after" to the right

struct Series {
  const std::vector<ClosureMode>* modes;
  double shift;
  Marker marker;
  const char *fill, *line, *label;
};

PlotAxis error_axis(const ClosureResult& result, const std::string& axis) {
  double low = 0.0, high = 0.0;
  for (const auto* modes : {&result.modes_before, &result.modes_after}) {
    for (const ClosureMode& mode : *modes) {
      if (!mode.error_percent) continue;
      low = std::min(low, *mode.error_percent - mode.sigma_percent.value_or(0.0));
      high = std::max(high, *mode.error_percent + mode.sigma_percent.value_or(0.0));
    }
  }
  return axis_around(low, high, axis);
}

void draw_series(SvgDocument& svg, const PlotPanel& panel, const Series& series) {
  for (const ClosureMode& mode : *series.modes) {
    if (!mode.error_percent) continue;
    const double x = panel.x_px(mode.number + series.shift);
    if (mode.sigma_percent) {
      const double top = panel.y_px(*mode.error_percent + *mode.sigma_percent);
      const double bottom = panel.y_px(*mode.error_percent - *mode.sigma_percent);
      svg.line(x, top, x, bottom, series.line);
      svg.line(x - 4.0, top, x + 4.0, top, series.line);
      svg.line(x - 4.0, bottom, x + 4.0, bottom, series.line);
    }
    svg.marker(x, panel.y_px(*mode.error_percent), 4.5, series.marker, series.fill);
  }
}

}  // namespace

std::string closure_modes_svg(const ClosureResult& result, const std::string& axis) {
  int last = 0;
  for (const ClosureMode& mode : result.modes_before) {
    if (mode.error_percent) last = std::max(last, mode.number);
  }
  if (last == 0) return {};
  SvgDocument svg(kWidthPx, kHeightPx, "Error of each mode before and after");
  svg.text(kBox.x, 24.0,
           fmt::format("Residual of each mode: rms {:.2f} % before, {:.2f} % after", result.baseline_rms,
                       result.residual_rms),
           Anchor::kStart, "h");
  PlotPanel panel(svg, kBox, {0.5, last + 0.5, false, "mode"}, error_axis(result, axis));
  panel.draw_x_axis(true, std::min(last, 10));
  panel.draw_y_axis(true, 8);
  panel.draw_frame();
  svg.line(kBox.x, panel.y_px(0.0), kBox.right(), panel.y_px(0.0), "v");
  const Series both[] = {{&result.modes_before, -kApart, Marker::kSquare, "m1", "k1", "before"},
                         {&result.modes_after, kApart, Marker::kDot, "m0", "k0", "after"}};
  double y = kBox.y + 14.0;
  const double x = kBox.right() + 22.0;
  for (const Series& series : both) {
    draw_series(svg, panel, series);
    svg.marker(x, y - 4.0, 4.5, series.marker, series.fill);
    svg.text(x + 14.0, y, series.label);
    y += 18.0;
  }
  svg.text(x - 8.0, y, "bars: one sigma", Anchor::kStart, "t q");
  for (const auto& step : result.steps) svg.text(x - 8.0, y += 18.0, "+ " + shortened(step.effect, 20));
  return svg.text_of();
}

}  // namespace app
