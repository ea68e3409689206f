#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/planning/hover_time.h"
#include "firmware_app/report/plot/lane_picture.h"
#include "firmware_app/report/run_history.h"

namespace app {
namespace {

constexpr std::uint64_t kLeastEstimates = 3;
constexpr std::size_t kMaxLanes = 12;

using SeriesOf = BinnedSeries RunHistory::FollowedMode::*;

// One quantity of a mode over the record, in % of its last value.
struct Course {
  double last = 0.0;
  double sigma = 0.0;  // of the last estimate, relative
};

Course frequency_of(const core::Mode& mode, double record_s) {
  const double theory = core::planning::relative_frequency_sigma(mode.frequency_hz, mode.damping_ratio, record_s);
  return {mode.frequency_hz, mode.frequency_std_hz ? *mode.frequency_std_hz / mode.frequency_hz : theory};
}

Course damping_of(const core::Mode& mode, double record_s) {
  const double theory = core::planning::relative_damping_sigma(mode.frequency_hz, mode.damping_ratio, record_s);
  return {mode.damping_ratio, mode.damping_std ? *mode.damping_std / mode.damping_ratio : theory};
}

// An estimate over T seconds shares its data with the last one, over T_end: it may differ from it by
// sigma_end sqrt(T_end / T - 1) (core/identification/frequency_trend.h). Drawn at twice that, to either side.
std::vector<PlotPoint> bound(const Course& course, double from_s, double end_s, double side) {
  constexpr int kSteps = 60;
  std::vector<PlotPoint> out;
  for (int i = 0; i <= kSteps; ++i) {
    const double t = from_s + (end_s - from_s) * i / kSteps;
    out.push_back({t, side * 200.0 * course.sigma * std::sqrt(std::max(0.0, end_s / t - 1.0))});
  }
  return out;
}

Lane lane_of(const BinnedSeries& series, const Course& course, double cell_s, double record_s) {
  Lane lane;
  for (PlotPoint point : series.means(cell_s)) {
    point.y = 100.0 * (point.y / course.last - 1.0);
    if (!std::isfinite(point.y)) continue;
    lane.high = std::max(lane.high, std::abs(point.y));
    lane.points.push_back(point);
  }
  lane.low = -lane.high;  // centres the last value
  lane.empty = lane.points.empty();
  if (lane.empty || !std::isfinite(course.sigma)) return lane;
  for (const double side : {-1.0, 1.0}) lane.behind.push_back(bound(course, lane.points.front().x, record_s, side));
  return lane;
}

std::string svg_of(const PictureInputs& inputs, const PictureFormat& format, SeriesOf series,
                   Course (*course_of)(const core::Mode&, double), const LanesText& text) {
  if (inputs.history == nullptr || inputs.estimate == nullptr || inputs.history->n_estimates() < kLeastEstimates)
    return {};
  const double record_s = inputs.estimate->duration_s;
  std::vector<Lane> lanes;
  const std::vector<core::Mode>& modes = inputs.estimate->modes;
  for (std::size_t i = 0; i < modes.size() && lanes.size() < kMaxLanes; ++i) {
    const core::Mode& mode = modes[i];
    const auto* followed = mode.history ? inputs.history->followed(mode.history->id) : nullptr;
    if (followed == nullptr || !(mode.frequency_hz > 0.0) || !(mode.damping_ratio > 0.0)) continue;
    const Course course = course_of(mode, record_s);
    lanes.push_back(lane_of(followed->*series, course, inputs.history->cell_s(), record_s));
    lanes.back().name = fmt::format("mode {}: {} Hz", i + 1, four_digits_text(mode.frequency_hz));
    lanes.back().remark = fmt::format("± {} % now", decimals_text(100.0 * course.sigma, 2));
  }
  return lanes.empty() ? std::string() : lanes_svg(lanes, record_s, text, format);
}

}  // namespace

std::string frequency_convergence_svg(const PictureInputs& inputs, const PictureFormat& format) {
  return svg_of(inputs, format, &RunHistory::FollowedMode::frequency_hz, frequency_of,
                {"Frequency of every mode over the estimates", "frequency, % of the last", "%", {}});
}

std::string damping_convergence_svg(const PictureInputs& inputs, const PictureFormat& format) {
  return svg_of(inputs, format, &RunHistory::FollowedMode::damping_ratio, damping_of,
                {"Damping of every mode over the estimates", "damping, % of the last", "%", {}});
}

}  // namespace app
