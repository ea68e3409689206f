#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "firmware_app/report/pictures_parts.h"
#include "firmware_app/report/svg_plot.h"

namespace app {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kLeftPx = 66.0;
constexpr double kTopPx = 40.0;
constexpr double kBelowPx = 46.0;  // tick labels and the axis label
constexpr std::size_t kMaxNameCharacters = 20;
constexpr const char* kScaleColumn = "scale_mm_per_px";

struct Lane {
  std::string name;
  std::vector<PlotPoint> points;  // x in seconds since the first sample
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  double rms = 0.0;  // about the mean

  [[nodiscard]] bool empty() const noexcept { return low > high; }
};

// Where rows are missing for longer than this many usual steps the curve has a gap.
constexpr double kGapSteps = 2.5;

double usual_step(const std::vector<double>& t) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < t.size(); ++i) {
    if (std::isfinite(t[i] - t[i - 1])) steps.push_back(t[i] - t[i - 1]);
  }
  if (steps.empty()) return 0.0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

Lane lane_of(const std::string& name, const std::vector<double>& t, const std::vector<double>& value,
             std::size_t max_points) {
  Lane lane;
  lane.name = name;
  const double longest_step = kGapSteps * usual_step(t);
  double sum = 0.0, sum_squares = 0.0, n = 0.0, offset = kNan;
  std::vector<PlotPoint> points;
  points.reserve(t.size());
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (i > 0 && t[i] - t[i - 1] > longest_step) points.push_back({t[i - 1] - t.front(), kNan});
    points.push_back({t[i] - t.front(), value[i]});
    if (!std::isfinite(value[i])) continue;
    if (!std::isfinite(offset)) offset = value[i];
    lane.low = std::min(lane.low, value[i]), lane.high = std::max(lane.high, value[i]);
    sum += value[i] - offset, sum_squares += (value[i] - offset) * (value[i] - offset), n += 1.0;
  }
  if (n > 0.0) lane.rms = std::sqrt(std::max(0.0, sum_squares / n - sum / n * (sum / n)));
  lane.points = decimated(points, max_points);
  return lane;
}

const std::vector<double>* column_of(const drivers::SeriesFile& series, const std::string& name) {
  const int i = series.column(name);
  return i < 0 ? nullptr : &series.columns[static_cast<std::size_t>(i)];
}

std::vector<Lane> lanes_of(const drivers::SeriesFile& series) {
  const std::vector<double>* t = column_of(series, "t_s");
  if (t == nullptr || t->empty()) return {};
  std::vector<std::size_t> columns;
  for (std::size_t i = 0; i < series.names.size(); ++i) {
    const std::string& name = series.names[i];
    if (name != "frame" && name != "t_s" && name != kScaleColumn) columns.push_back(i);
  }
  std::vector<Lane> out;
  for (const std::size_t i : columns) {
    out.push_back(lane_of(series.names[i], *t, series.columns[i], curve_points(columns.size())));
  }
  return out;
}

PlotAxis time_axis(const std::vector<double>& t) {
  const auto last = std::find_if(t.rbegin(), t.rend(), [](double value) { return std::isfinite(value); });
  const double duration = last == t.rend() ? 0.0 : *last - t.front();
  return {0.0, std::isfinite(duration) && duration > 0.0 ? duration : 1.0, false, "time since the first sample, s"};
}

// Draws the lanes under each other: each about its own middle, all with the same span, so that amplitudes compare.
class LanePicture {
 public:
  LanePicture(const std::vector<Lane>& lanes, const PlotAxis& time, std::string unit)
      : lanes_(lanes), time_(time), unit_(std::move(unit)) {
    const double n = static_cast<double>(lanes.size());
    step_px_ = std::clamp(std::floor(720.0 / n), 16.0, 160.0);
    gap_px_ = tall() ? 10.0 : 2.0;  // room for tick labels at both edges
    for (const Lane& lane : lanes) {
      if (lane.empty()) continue;
      span_ = std::max(span_, lane.high - lane.low);
      largest_ = std::max({largest_, std::abs(lane.low), std::abs(lane.high)});
      const std::string name = shortened(lane.name, kMaxNameCharacters);
      right_px_ = std::max(right_px_, text_width_px(name, kTextPx) + 20.0);
    }
    span_ = std::max(1.08 * span_, std::max(1e-9, 1e-9 * largest_));
  }

  [[nodiscard]] std::string draw() {
    const double height = kTopPx + step_px_ * static_cast<double>(lanes_.size()) - gap_px_ + kBelowPx;
    SvgDocument svg(kPictureWidthPx, height, "Displacement of every channel over time");
    svg.text(kLeftPx, 24.0, "Displacement of every channel", Anchor::kStart, "h");
    svg.text(kPictureWidthPx - 14.0, 24.0, fmt::format("every lane spans {} {}", four_digits_text(span_), unit_),
             Anchor::kEnd, "t q");
    for (std::size_t i = 0; i < lanes_.size(); ++i) draw_lane(svg, i);
    if (tall()) svg.text_upwards(20.0, kTopPx + (height - kTopPx - kBelowPx) / 2.0, "displacement, " + unit_);
    return svg.text_of();
  }

 private:
  [[nodiscard]] bool tall() const noexcept { return step_px_ >= 40.0; }

  void draw_lane(SvgDocument& svg, std::size_t i) const {
    const Lane& lane = lanes_[i];
    const Box box{kLeftPx, kTopPx + step_px_ * static_cast<double>(i), kPictureWidthPx - kLeftPx - right_px_,
                  step_px_ - gap_px_};
    const double middle = lane.empty() ? 0.0 : lane.low + (lane.high - lane.low) / 2.0;
    PlotPanel panel(svg, box, time_, {middle - span_ / 2.0, middle + span_ / 2.0, false, {}});
    panel.draw_x_axis(i + 1 == lanes_.size());
    if (tall() && !lane.empty()) panel.draw_y_axis(false, step_px_ < 80.0 ? 2 : 4);
    panel.draw_frame();
    panel.curve(lane.points, line_class(0));
    const double x = box.right() + 8.0;
    const double y = box.y + box.height / 2.0;
    svg.text(x, tall() ? y : y + 4.0, shortened(lane.name, kMaxNameCharacters));
    if (lane.empty()) svg.text(box.x + box.width / 2.0, y + 3.5, "no sample", Anchor::kMiddle, "s q");
    if (!tall() || lane.empty()) return;
    svg.text(x, y + 14.0, fmt::format("rms {} {}", four_digits_text(lane.rms), unit_), Anchor::kStart, "s q");
  }

  const std::vector<Lane>& lanes_;
  PlotAxis time_;
  std::string unit_;
  double step_px_ = 0.0, gap_px_ = 0.0, span_ = 0.0, largest_ = 0.0;
  double right_px_ = 100.0;
};

}  // namespace

std::string displacements_svg(const PictureInputs& inputs, const drivers::SeriesFile& series) {
  const std::vector<Lane> lanes = lanes_of(series);
  if (lanes.empty()) return {};
  return LanePicture(lanes, time_axis(*column_of(series, "t_s")), inputs.millimetres ? "mm" : "px").draw();
}

std::string scale_svg(const PictureInputs& inputs, const drivers::SeriesFile& series) {
  // Less than this much is below what the tracks resolve.
  constexpr double kLeastVariation = 1e-5;
  const std::vector<double>* t = column_of(series, "t_s");
  const std::vector<double>* scale = column_of(series, kScaleColumn);
  if (t == nullptr || scale == nullptr || t->empty()) return {};
  const Lane lane = lane_of("scale", *t, *scale, curve_points(1));
  if (lane.empty() || lane.low <= 0.0 || lane.high - lane.low < kLeastVariation * lane.low) return {};

  SvgDocument svg(kPictureWidthPx, 320.0, "Scale over time");
  svg.text(kLeftPx, 24.0, "Scale over time", Anchor::kStart, "h");
  svg.text(kPictureWidthPx - 20.0, 24.0,
           fmt::format("{} … {}: {} %", four_digits_text(lane.low), four_digits_text(lane.high),
                       decimals_text(100.0 * (lane.high / lane.low - 1.0), 2)),
           Anchor::kEnd, "t q");
  const Box box{kLeftPx, kTopPx, kPictureWidthPx - kLeftPx - 20.0, 320.0 - kTopPx - kBelowPx};
  const PlotAxis y = axis_around(lane.low, lane.high, inputs.millimetres ? "scale, mm/px" : "scale, relative");
  PlotPanel panel(svg, box, time_axis(*t), y);
  panel.draw_x_axis(true);
  panel.draw_y_axis(true);
  panel.draw_frame();
  panel.curve(lane.points, line_class(0));
  return svg.text_of();
}

}  // namespace app
