#include "firmware_app/report/closure_modes_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "firmware_app/report/plot/svg_plot.h"

namespace app {
namespace {

using core::closure::ClosureMode;
using core::closure::ClosureResult;

// Where the parts lie, px; the legend begins at (legend_x, legend_y).
struct ModesLayout {
  double width, height;
  Box box;
  double legend_x, legend_y;
  const char* title;
};
constexpr ModesLayout kWide{760.0, 400.0, {74.0, 46.0, 500.0, 290.0}, 596.0, 60.0, "Residual of each mode: rms"};
constexpr ModesLayout kNarrow{328.0, 456.0, {62.0, 46.0, 254.0, 290.0}, 74.0, 398.0, "rms"};
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

std::string modes_svg_of(const ClosureResult& result, const std::string& axis, const ModesLayout& layout) {
  int last = 0;
  for (const auto* modes : {&result.modes_before, &result.modes_after}) {
    for (const ClosureMode& mode : *modes) {
      if (mode.error_percent) last = std::max(last, mode.number);
    }
  }
  if (last == 0) return {};
  SvgDocument svg(layout.width, layout.height, "Error of each mode before and after");
  const Box& box = layout.box;
  svg.text(box.x, 24.0,
           fmt::format("{} {:.2f} % before, {:.2f} % after", layout.title, result.baseline_rms, result.residual_rms),
           Anchor::kStart, "h");
  PlotPanel panel(svg, box, {0.5, last + 0.5, false, "mode"}, error_axis(result, axis));
  panel.draw_x_axis(true, std::min(last, 10));
  panel.draw_y_axis(true, 8);
  panel.draw_frame();
  svg.line(box.x, panel.y_px(0.0), box.right(), panel.y_px(0.0), "v");
  const std::array both{Series{&result.modes_before, -kApart, Marker::kSquare, "m1", "k1", "before"},
                        Series{&result.modes_after, kApart, Marker::kDot, "m0", "k0", "after"}};
  double y = layout.legend_y;
  const double x = layout.legend_x;
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

}  // namespace

std::string closure_modes_svg(const ClosureResult& result, const std::string& axis) {
  return modes_svg_of(result, axis, kWide);
}

std::string closure_modes_narrow_svg(const ClosureResult& result, const std::string& axis) {
  return modes_svg_of(result, axis, kNarrow);
}

}  // namespace app
