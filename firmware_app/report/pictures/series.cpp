#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "firmware_app/report/plot/lane_picture.h"
#include "firmware_app/report/run_history.h"

namespace app {
namespace {

// A record of one sample has no history to plot.
bool has_course(const PictureInputs& inputs) { return inputs.history != nullptr && inputs.history->n_samples() > 1; }

Lane lane_of(const std::string& name, const BinnedSeries& series, std::vector<PlotPoint> points,
             std::size_t max_points) {
  Lane lane;
  lane.name = name;
  lane.points = decimated(points, max_points);
  lane.empty = series.empty();
  lane.low = series.low(), lane.high = series.high();
  return lane;
}

std::string region_name(const PictureInputs& inputs, std::size_t i) {
  return i < inputs.regions.size() ? inputs.regions[i].name : fmt::format("region {}", i);
}

std::size_t n_with_points(const RunHistory& history) {
  const auto& regions = history.regions();
  return static_cast<std::size_t>(
      std::count_if(regions.begin(), regions.end(), [](const auto& region) { return region.n_points > 0; }));
}

// 1, 2 or 5 times a power of ten, so that the upper end has a tick.
double round_above(double value) {
  if (!std::isfinite(value) || value <= 0.0) return 1.0;
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (value <= factor * power) return factor * power;
  }
  return 10.0 * power;
}

}  // namespace

std::string displacements_svg(const PictureInputs& inputs, const PictureFormat& format) {
  if (!has_course(inputs) || inputs.history->displacements().empty()) return {};
  const RunHistory& history = *inputs.history;
  const std::size_t n = history.displacements().size();
  std::vector<Lane> lanes;
  for (std::size_t i = 0; i < n; ++i) {
    const BinnedSeries& series = history.displacements()[i];
    const std::string name = i < inputs.channels.size() ? inputs.channels[i].name : fmt::format("channel {}", i);
    lanes.push_back(lane_of(name, series, series.curve(history.cell_s()), curve_points(n, format)));
    if (!series.empty()) lanes.back().remark = fmt::format("rms {} {}", four_digits_text(series.rms()), inputs.unit);
  }
  return lanes_svg(lanes, history.duration_s(),
                   {"Displacement of every channel", "displacement, " + inputs.unit, inputs.unit, {}}, format);
}

std::string points_seen_svg(const PictureInputs& inputs, const PictureFormat& format) {
  if (!has_course(inputs) || !inputs.history->has_tracks()) return {};
  const RunHistory& history = *inputs.history;
  std::vector<Lane> lanes;
  for (std::size_t i = 0; i < history.regions().size(); ++i) {
    const RunHistory::Region& region = history.regions()[i];
    if (region.n_points == 0) continue;
    std::vector<PlotPoint> percent = region.share_seen.curve(history.cell_s());
    for (PlotPoint& point : percent) point.y *= 100.0;
    lanes.push_back(
        lane_of(region_name(inputs, i), region.share_seen, percent, curve_points(n_with_points(history), format)));
    const std::string shares =
        fmt::format("mean {} %, least {:.0f} %", decimals_text(100.0 * region.share_seen.mean(), 2),
                    100.0 * region.share_seen.low());
    lanes.back().remark = is_narrow(format) ? shares : fmt::format("{} points, {}", region.n_points, shares);
  }
  if (lanes.empty()) return {};
  const PlotAxis range{0.0, 105.0, false, {}};
  return lanes_svg(lanes, history.duration_s(), {"Share of the points seen", "points seen, %", "%", range}, format);
}

std::string point_sigma_svg(const PictureInputs& inputs, const PictureFormat& format) {
  if (!has_course(inputs) || !inputs.history->has_tracks()) return {};
  const RunHistory& history = *inputs.history;
  std::vector<Lane> lanes;
  double highest = 0.0;
  for (std::size_t i = 0; i < history.regions().size(); ++i) {
    const BinnedSeries& sigma = history.regions()[i].sigma_px;
    if (history.regions()[i].n_points == 0) continue;
    lanes.push_back(lane_of(region_name(inputs, i), sigma, sigma.curve(history.cell_s()),
                            curve_points(n_with_points(history), format)));
    highest = std::max(highest, sigma.high());
    if (sigma.empty()) continue;
    lanes.back().remark =
        is_narrow(format)
            ? fmt::format("{} px, worst {}", decimals_text(sigma.mean(), 3), decimals_text(sigma.high(), 3))
            : fmt::format("mean {} px, worst {} px", decimals_text(sigma.mean(), 4), decimals_text(sigma.high(), 4));
  }
  if (lanes.empty()) return {};
  const PlotAxis range{0.0, round_above(highest), false, {}};
  return lanes_svg(lanes, history.duration_s(), {"Standard deviation of a point", "sigma, px", "px", range}, format);
}

std::string scale_svg(const PictureInputs& inputs, const PictureFormat& format) {
  // A smaller variation is below the resolution of the tracks.
  constexpr double kLeastVariation = 1e-5;
  if (!has_course(inputs)) return {};
  const BinnedSeries& scale = inputs.history->scale();
  const double low = scale.low(), high = scale.high();
  if (scale.empty() || low <= 0.0 || high - low < kLeastVariation * low) return {};

  const double top = format.on_page ? 8.0 : 40.0, left = 72.0, right = 20.0, below = 46.0;
  const double height = is_narrow(format) ? 220.0 : 320.0;
  SvgDocument svg(format.width_px, height, "Scale over time", format.on_page);
  if (!format.on_page) {
    svg.text(left, 24.0, "Scale over time", Anchor::kStart, "h");
    svg.text(format.width_px - 20.0, 24.0, scale_range_text(inputs), Anchor::kEnd, "t q");
  }
  const Box box{left, top, format.width_px - left - right, height - top - below};
  const PlotAxis y = axis_around(low, high, "scale, " + scale_unit(inputs));
  PlotPanel panel(svg, box, time_axis(inputs.history->duration_s()), y);
  panel.draw_x_axis(true, is_narrow(format) ? 5 : 10);
  panel.draw_y_axis(true);
  panel.draw_frame();
  panel.curve(decimated(scale.curve(inputs.history->cell_s()), curve_points(1, format)), line_class(0));
  return svg.text_of();
}

std::string scale_unit(const PictureInputs& inputs) { return inputs.unit == "mm" ? "mm/px" : "relative"; }

std::string scale_range_text(const PictureInputs& inputs) {
  const BinnedSeries& scale = inputs.history->scale();
  return fmt::format("{} … {} {}: {} %", four_digits_text(scale.low()), four_digits_text(scale.high()),
                     scale_unit(inputs), decimals_text(100.0 * (scale.high() / scale.low() - 1.0), 2));
}

}  // namespace app
