#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware_app/report/plot/svg_plot.h"
#include "tools/hovermodal/batch/combine.h"

namespace tools {

namespace {

using app::Box;

constexpr double kWidthPx = 960.0, kPanelWidthPx = 350.0, kPanelHeightPx = 104.0, kPitchPx = 150.0, kTopPx = 84.0;
constexpr double kLeftPx = 86.0, kRightPanelPx = 530.0;
constexpr std::size_t kMostModes = 12;

// One quantity of one mode: the flights' values with their sigma, and the combined value.
struct Lane {
  std::string label;
  core::WeightedMean combined;
  double unit = 1.0;
  struct Point {
    std::size_t i_flight = 0;
    double value = 0.0;
    double sigma = 0.0;  // 0 = unknown
  };
  std::vector<Point> points;
};

Lane frequency_lane(const BatchResult& result, const BatchMode& mode) {
  Lane lane{"Hz", mode.frequency_hz, 1.0, {}};
  for (const BatchMode::Of& of : mode.flights) {
    const core::Mode& one = result.flights[of.index].report.estimate.modes[of.i_mode];
    lane.points.push_back({of.index, one.frequency_hz, one.frequency_std_hz.value_or(0.0)});
  }
  return lane;
}

Lane damping_lane(const BatchResult& result, const BatchMode& mode) {
  Lane lane{"damping, %", mode.damping_ratio, 100.0, {}};
  for (const BatchMode::Of& of : mode.flights) {
    const core::Mode& one = result.flights[of.index].report.estimate.modes[of.i_mode];
    lane.points.push_back({of.index, 100.0 * one.damping_ratio, 100.0 * one.damping_std.value_or(0.0)});
  }
  return lane;
}

app::PlotAxis value_axis(const Lane& lane) {
  const double middle = lane.unit * lane.combined.value, half = lane.unit * lane.combined.std;
  double low = middle - half, high = middle + half;
  for (const Lane::Point& point : lane.points) {
    low = std::min(low, point.value - point.sigma);
    high = std::max(high, point.value + point.sigma);
  }
  return app::axis_around(low, high, lane.label);
}

// The band of the combined value is drawn behind the flights.
void draw_lane(app::SvgDocument& svg, const Lane& lane, const Box& box, std::size_t n_flights,
               const BatchResult& result) {
  app::PlotPanel panel(svg, box, {0.5, static_cast<double>(n_flights) + 0.5, false, ""}, value_axis(lane));
  const double middle = lane.unit * lane.combined.value, half = lane.unit * lane.combined.std;
  const double top = panel.y_px(middle + half), bottom = panel.y_px(middle - half);
  svg.begin_group("opacity=\"0.3\"");
  svg.rect({box.x, top, box.width, std::max(bottom - top, 0.5)}, "m5");
  svg.end_group();
  panel.draw_x_axis(true, static_cast<int>(std::min<std::size_t>(n_flights, 10)));
  panel.draw_y_axis(true, 4);
  panel.draw_frame();
  svg.line(box.x, panel.y_px(middle), box.right(), panel.y_px(middle), "v");
  const double radius = n_flights > 60 ? 1.8 : 3.5;
  for (const Lane::Point& point : lane.points) {
    const double x = panel.x_px(static_cast<double>(point.i_flight + 1)), y = panel.y_px(point.value);
    const std::size_t i_view = result.flights[point.i_flight].i_view;
    if (point.sigma > 0.0)
      svg.line(x, panel.y_px(point.value - point.sigma), x, panel.y_px(point.value + point.sigma),
               app::line_class(i_view));
    svg.marker(x, y, radius, app::Marker::kDot, app::fill_class(i_view));
  }
}

std::string mode_title(std::size_t number, const BatchMode& mode) {
  return fmt::format("mode {}: {:.4f} Hz{}, damping {:.2f} %{}", number, mode.frequency_hz.value,
                     mode.frequency_hz.std > 0.0 ? fmt::format(" ± {:.5f}", mode.frequency_hz.std) : "",
                     100.0 * mode.damping_ratio.value,
                     mode.damping_ratio.std > 0.0 ? fmt::format(" ± {:.3f}", 100.0 * mode.damping_ratio.std) : "");
}

}  // namespace

std::string batch_svg(const BatchResult& result) {
  if (result.modes.empty()) return {};
  const std::size_t n_modes = std::min(result.modes.size(), kMostModes);
  app::SvgDocument svg(kWidthPx, kTopPx + static_cast<double>(n_modes) * kPitchPx, "Modes of every flight and of all");
  svg.text(20.0, 24.0, fmt::format("{} flights: each one's modes, and all together", result.flights.size()),
           app::Anchor::kStart, "h");
  svg.text(
      20.0, 44.0,
      fmt::format("points: flights by number, with one sigma, a colour for each view; band: all together, one sigma{}",
                  result.modes.size() > kMostModes ? fmt::format("; the lowest {} modes", kMostModes) : ""),
      app::Anchor::kStart, "t q");
  for (std::size_t m = 0; m < n_modes; ++m) {
    const BatchMode& mode = result.modes[m];
    const double y = kTopPx + static_cast<double>(m) * kPitchPx;
    svg.text(kLeftPx, y - 8.0, mode_title(m + 1, mode));
    draw_lane(svg, frequency_lane(result, mode), {kLeftPx, y, kPanelWidthPx, kPanelHeightPx}, result.flights.size(),
              result);
    if (mode.damping_ratio.n > 0)
      draw_lane(svg, damping_lane(result, mode), {kRightPanelPx, y, kPanelWidthPx, kPanelHeightPx},
                result.flights.size(), result);
  }
  return svg.text_of();
}

}  // namespace tools
