#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "firmware_app/report/plot/svg_plot.h"
#include "tools/hovermodal/changes/mode_histories.h"

namespace tools {
namespace {

using app::Box;
using core::monitoring::Change;
using core::monitoring::ChangeKind;

constexpr double kWidthPx = 960.0, kPanelWidthPx = 350.0, kPanelHeightPx = 120.0, kPitchPx = 190.0, kTopPx = 84.0;
constexpr double kLeftPx = 86.0, kRightPanelPx = 530.0, kMarginDays = 0.04;
constexpr std::size_t kMostModes = 12;

double as_is(double value) { return value; }
double percent_of_log(double value) { return 100.0 * std::exp(value); }

// The fitted course at one flight, in the unit of the series.
double fitted(const ModeHistories& result, const Change& change, std::size_t flight, double mean_kelvin) {
  const double day = result.flights[flight].day - result.flights.front().day;
  double value = change.mean;
  if (change.is_significant)
    value += change.kind == ChangeKind::kStep ? (flight >= change.first_flight ? change.size : 0.0) : change.size * day;
  const double kelvin = result.flights[flight].temperature_c - mean_kelvin;
  return change.per_kelvin_std > 0.0 && std::isfinite(kelvin) ? value + change.per_kelvin * kelvin : value;
}

double mean_temperature(const ModeHistories& result, const History& history) {
  double sum = 0.0, n = 0.0;
  for (const auto& value : history.values) {
    const double warm = result.flights[value.flight].temperature_c;
    if (std::isfinite(warm)) sum += warm, n += 1.0;
  }
  return n > 0.0 ? sum / n : 0.0;
}

void draw(app::SvgDocument& svg, const ModeHistories& result, const History& history, double (*shown)(double),
          const std::string& label, const Box& box) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const auto& value : history.values) {
    low = std::min(low, shown(value.value - value.std)), high = std::max(high, shown(value.value + value.std));
  }
  const double first = result.flights.front().day, span = std::max(1e-9, result.flights.back().day - first);
  app::PlotPanel panel(svg, box,
                       {-kMarginDays * span, (1.0 + kMarginDays) * span, false, "days since the first flight"},
                       app::axis_around(low, high, label));
  panel.draw_x_axis(true, 8);
  panel.draw_y_axis(true, 4);
  panel.draw_frame();
  const Change& change = history.change;
  if (change.is_tested) {
    std::vector<app::PlotPoint> course;
    const double mean_kelvin = mean_temperature(result, history);
    for (const auto& value : history.values) {
      course.push_back(
          {result.flights[value.flight].day - first, shown(fitted(result, change, value.flight, mean_kelvin))});
    }
    panel.curve(course, "v");
  }
  if (change.is_significant && change.kind == ChangeKind::kStep)
    panel.vertical(result.flights[change.first_flight].day - first, "v", "stroke-dasharray=\"4 3\"");
  for (const auto& value : history.values) {
    const double x = panel.x_px(result.flights[value.flight].day - first);
    const bool is_after =
        change.is_significant && change.kind == ChangeKind::kStep && value.flight >= change.first_flight;
    svg.line(x, panel.y_px(shown(value.value - value.std)), x, panel.y_px(shown(value.value + value.std)),
             app::line_class(is_after ? 1 : 0));
    svg.marker(x, panel.y_px(shown(value.value)), 3.5, is_after ? app::Marker::kDiamond : app::Marker::kDot,
               app::fill_class(is_after ? 1 : 0));
  }
}

std::string title(const ModeHistory& mode, std::size_t number) {
  const Change& f = mode.frequency.change;
  std::string out = fmt::format("mode {}", number);
  if (f.is_tested) out += fmt::format(": {:.4f} Hz", f.mean);
  if (!mode.is_changed()) return out + ", no change";
  if (f.is_significant) {
    out += f.kind == ChangeKind::kStep ? fmt::format(", step of {:+.2f} %", 100.0 * f.size / f.mean)
                                       : fmt::format(", trend of {:+.2f} % a year", 36525.0 * f.size / f.mean);
  }
  if (mode.log_damping.change.is_significant) out += ", damping changed";
  const auto n = std::count_if(mode.shape.begin(), mode.shape.end(),
                               [](const auto& one) { return one.value.change.is_significant; });
  if (n > 0) out += fmt::format(", shape changed in {} channel{}", n, n == 1 ? "" : "s");
  return out;
}

}  // namespace

std::string changes_svg(const ModeHistories& result) {
  if (result.modes.empty()) return {};
  const std::size_t n_modes = std::min(result.modes.size(), kMostModes);
  app::SvgDocument svg(kWidthPx, kTopPx + static_cast<double>(n_modes) * kPitchPx, "Modes over the flights");
  svg.text(20.0, 24.0,
           fmt::format("{} flights: {}", result.flights.size(), result.is_changed() ? "changed" : "no change"),
           app::Anchor::kStart, "h");
  svg.text(20.0, 44.0,
           fmt::format("points: flights with one sigma; line: fitted course{}; diamonds: after a step{}",
                       result.knows_temperature ? " with the temperature" : "",
                       result.modes.size() > kMostModes ? fmt::format("; the lowest {} modes", kMostModes) : ""),
           app::Anchor::kStart, "t q");
  for (std::size_t m = 0; m < n_modes; ++m) {
    const double y = kTopPx + static_cast<double>(m) * kPitchPx;
    svg.text(kLeftPx, y - 8.0, title(result.modes[m], m + 1));
    if (!result.modes[m].frequency.values.empty())
      draw(svg, result, result.modes[m].frequency, as_is, "Hz", {kLeftPx, y, kPanelWidthPx, kPanelHeightPx});
    if (!result.modes[m].log_damping.values.empty()) {
      draw(svg, result, result.modes[m].log_damping, percent_of_log, "damping, %",
           {kRightPanelPx, y, kPanelWidthPx, kPanelHeightPx});
    }
  }
  return svg.text_of();
}

}  // namespace tools
