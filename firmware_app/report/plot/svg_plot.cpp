#include "firmware_app/report/plot/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace app {
namespace {

constexpr double kLegendStepPx = 16.0;

std::string tick_label(double value, double step) {
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  std::string out =
      std::abs(value) < 1e6 && decimals <= 6 ? fmt::format("{:.{}f}", value, decimals) : fmt::format("{:.6g}", value);
  if (out.starts_with('-')) out.replace(0, 1, "−");
  return out;
}

std::vector<PlotTick> linear_ticks(const PlotAxis& axis, int n_wanted) {
  const double raw = (axis.high - axis.low) / std::max(1, n_wanted);
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double ratio = raw / power;
  const double step = (ratio <= 1.0 ? 1.0 : ratio <= 2.0 ? 2.0 : ratio <= 5.0 ? 5.0 : 10.0) * power;
  std::vector<PlotTick> out;
  const double slack = 1e-9 * (axis.high - axis.low);
  const double first = std::ceil((axis.low - slack) / step);
  for (double i = first; i * step <= axis.high + slack && out.size() < 100; ++i) {
    const double value = i == 0.0 ? 0.0 : i * step;  // avoids "-0"
    out.push_back({value, tick_label(value, step), 0});
  }
  return out;
}

std::vector<PlotTick> log_ticks(const PlotAxis& axis, int n_wanted) {
  const int first = static_cast<int>(std::ceil(std::log10(axis.low) - 1e-9));
  const int last = static_cast<int>(std::floor(std::log10(axis.high) + 1e-9));
  const int step = std::max(1, (last - first + n_wanted) / std::max(1, n_wanted));
  std::vector<PlotTick> out;
  for (int exponent = first; exponent <= last; exponent += step)
    out.push_back({std::pow(10.0, exponent), {}, exponent});
  return out;
}

}  // namespace

PlotAxis axis_around(double low, double high, const std::string& label) {
  if (!std::isfinite(low) || !std::isfinite(high) || low > high) low = 0.0, high = 1.0;
  // A narrower range is indistinguishable from rounding.
  const double least = std::max(1e-9, 1e-9 * std::max(std::abs(low), std::abs(high)));
  const double air = high - low > least ? 0.04 * (high - low) : std::max(least, 0.01 * std::abs(low));
  return {low - air, high + air, false, label};
}

PlotAxis log_axis_around(double low, double high, int max_decades, const std::string& label) {
  if (!std::isfinite(low) || !std::isfinite(high) || low <= 0.0 || low > high) low = 0.1, high = 1.0;
  const double top = std::clamp(std::ceil(std::log10(high) + 1e-3), -290.0, 290.0);
  const double bottom = std::clamp(std::floor(std::log10(low) - 1e-3), top - max_decades, top - 1.0);
  return {std::pow(10.0, bottom), std::pow(10.0, top), true, label};
}

std::vector<PlotTick> ticks_of(const PlotAxis& axis, int n_wanted) {
  return axis.logarithmic ? log_ticks(axis, n_wanted) : linear_ticks(axis, n_wanted);
}

PlotPanel::PlotPanel(SvgDocument& svg, const Box& box, const PlotAxis& x, const PlotAxis& y)
    : svg_(&svg), box_(box), x_(x), y_(y) {}

double PlotPanel::position(const PlotAxis& axis, double value, double from, double to) noexcept {
  if (!axis.logarithmic) return from + (to - from) * (value - axis.low) / (axis.high - axis.low);
  const double decades = std::log10(axis.high / axis.low);
  return value <= 0.0 ? from : from + (to - from) * std::log10(value / axis.low) / decades;  // NaN stays NaN
}

void PlotPanel::draw_x_axis(bool with_labels, int n_ticks) {
  for (const PlotTick& tick : ticks_of(x_, n_ticks)) {
    const double x = x_px(tick.value);
    svg_->line(x, box_.y, x, box_.bottom(), "g");
    if (!with_labels) continue;
    if (x_.logarithmic) {
      svg_->text(x, box_.bottom() + 15.0, power_of_ten_text(tick.exponent), Anchor::kMiddle, "s");
    } else {
      svg_->text(x, box_.bottom() + 15.0, tick.label, Anchor::kMiddle, "s");
    }
  }
  if (with_labels) svg_->text(box_.x + box_.width / 2.0, box_.bottom() + 32.0, x_.label, Anchor::kMiddle);
}

void PlotPanel::draw_y_axis(bool with_label, int n_ticks) {
  for (const PlotTick& tick : ticks_of(y_, n_ticks)) {
    const double y = y_px(tick.value);
    svg_->line(box_.x, y, box_.right(), y, "g");
    if (y_.logarithmic) {
      svg_->text(box_.x - 5.0, y + 4.0, power_of_ten_text(tick.exponent), Anchor::kEnd, "s");
    } else {
      svg_->text(box_.x - 5.0, y + 4.0, tick.label, Anchor::kEnd, "s");
    }
  }
  if (with_label) svg_->text_upwards(box_.x - 46.0, box_.y + box_.height / 2.0, y_.label);
}

void PlotPanel::draw_frame() { svg_->rect(box_, "x"); }

void PlotPanel::curve(std::span<const PlotPoint> points, const std::string& css_class, std::string_view attributes) {
  std::vector<PlotPoint> path;
  path.reserve(points.size());
  for (const PlotPoint& point : points) {
    const double y = y_px(point.y);  // NaN must stay NaN: clamp would not keep it
    path.push_back({x_px(point.x), std::isfinite(y) ? std::clamp(y, box_.y, box_.bottom()) : y});
  }
  svg_->path(path, css_class, attributes);
}

void PlotPanel::vertical(double x, const std::string& css_class, std::string_view attributes) {
  svg_->line(x_px(x), box_.y, x_px(x), box_.bottom(), css_class, attributes);
}

void PlotPanel::begin_readout(std::string_view kind) {
  const std::size_t comma = y_.label.rfind(", ");
  const std::string unit = comma == std::string::npos ? std::string() : y_.label.substr(comma + 2);
  svg_->begin_group(fmt::format(
      "data-read=\"{}\" data-box=\"{} {} {} {}\" data-x=\"{:g} {:g}\" data-y=\"{:g} {:g} {}\" data-unit=\"{}\"", kind,
      svg_number(box_.x), svg_number(box_.y), svg_number(box_.right()), svg_number(box_.bottom()), x_.low, x_.high,
      y_.low, y_.high, y_.logarithmic ? "log" : "linear", svg_escaped(unit)));
}

std::vector<PlotPoint> decimated(std::span<const PlotPoint> points, std::size_t max_points) {
  if (points.size() <= max_points) return {points.begin(), points.end()};
  const std::size_t n_intervals = std::max<std::size_t>(1, max_points / 2);
  std::vector<PlotPoint> out;
  out.reserve(2 * n_intervals);
  for (std::size_t i = 0; i < n_intervals; ++i) {
    const std::size_t begin = i * points.size() / n_intervals, end = (i + 1) * points.size() / n_intervals;
    std::size_t lowest = end, highest = end;
    for (std::size_t k = begin; k < end; ++k) {
      if (!std::isfinite(points[k].x) || !std::isfinite(points[k].y)) continue;
      if (lowest == end || points[k].y < points[lowest].y) lowest = k;
      if (highest == end || points[k].y > points[highest].y) highest = k;
    }
    if (lowest == end) {
      out.push_back({points[begin].x, std::numeric_limits<double>::quiet_NaN()});
      continue;
    }
    out.push_back(points[std::min(lowest, highest)]);
    if (lowest != highest) out.push_back(points[std::max(lowest, highest)]);
  }
  return out;
}

void draw_legend(SvgDocument& svg, const Box& box, std::span<const LegendEntry> entries) {
  const auto room = static_cast<std::size_t>(std::max(1.0, box.height / kLegendStepPx));
  const std::size_t n_shown = entries.size() <= room ? entries.size() : room - 1;
  for (std::size_t i = 0; i < n_shown; ++i) {
    const double y = box.y + kLegendStepPx * (static_cast<double>(i) + 0.5);
    const std::vector<PlotPoint> sample{{box.x, y}, {box.x + 24.0, y}};
    svg.path(sample, entries[i].css_class);
    svg.text(box.x + 30.0, y + 4.0, entries[i].label);
  }
  if (n_shown == entries.size()) return;
  const double y = box.y + kLegendStepPx * (static_cast<double>(n_shown) + 0.5);
  svg.text(box.x + 30.0, y + 4.0, fmt::format("and {} more", entries.size() - n_shown), Anchor::kStart, "t q");
}

std::vector<int> label_rows(std::span<const double> x_px, std::span<const std::string> labels, int n_rows) {
  std::vector<double> end_of_row(static_cast<std::size_t>(std::max(0, n_rows)),
                                 -std::numeric_limits<double>::infinity());
  std::vector<int> out;
  for (std::size_t i = 0; i < x_px.size() && i < labels.size(); ++i) {
    const double half = text_width_px(labels[i], kTextPx) / 2.0;
    const auto row =
        std::find_if(end_of_row.begin(), end_of_row.end(), [&](double end) { return x_px[i] - half > end + 8.0; });
    out.push_back(row == end_of_row.end() ? -1 : static_cast<int>(row - end_of_row.begin()));
    if (row != end_of_row.end()) *row = x_px[i] + half;
  }
  return out;
}

}  // namespace app
