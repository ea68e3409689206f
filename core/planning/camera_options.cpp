#include "core/planning/camera_options.h"

#include <algorithm>
#include <cmath>

namespace core::planning {
namespace {

Obstacle obstacle_of(const PlannedCamera& camera) noexcept {
  constexpr double kRounding = 1e-9;
  const double period_s = (1.0 + kRounding) / camera.rate_hz;
  if (std::abs(camera.readout_s) > period_s) return Obstacle::kReadoutTooLong;
  return camera.exposure_s > period_s ? Obstacle::kExposureTooLong : Obstacle::kNone;
}

void count_troubles(const PlanInput& input, const PlannedCamera& camera, CameraOption& option) {
  const FoldSurvey survey = survey_folds(input, camera);
  for (std::size_t i = 0; i < survey.places.size(); ++i) {
    const FoldPlace& place = survey.places[i];
    const PlannedMode& mode = input.modes[i];
    const bool folded = place.n != 0;
    const bool open = place.outlook == FoldOutlook::kAmbiguous || place.outlook == FoldOutlook::kNoDelays;
    const double half_power_hz = 2.0 * mode.damping_ratio * mode.frequency_hz;
    const bool hidden =
        (folded && place.apparent_hz < kHoverBandHz) ||
        (place.apparent_hz >= kHoverBandHz && at_edge(place.apparent_hz, half_power_hz, camera.rate_hz));
    option.n_folded += folded ? 1 : 0;
    option.n_open += open ? 1 : 0;
    option.n_hidden += hidden ? 1 : 0;
    if (place.margin) option.least_margin = std::min(option.least_margin.value_or(1.0), *place.margin);
  }
  option.n_overlaps = static_cast<int>(survey.overlaps.size());
  option.n_merging = static_cast<int>(
      std::count_if(survey.overlaps.begin(), survey.overlaps.end(), [](const Overlap& o) { return o.merges; }));
  option.penalty =
      3.0 * option.n_open + 2.0 * option.n_hidden + option.n_merging + option.n_overlaps + 0.25 * option.n_folded;
}

CameraOption evaluate(const PlanInput& input, double rate_hz, bool is_turned) {
  PlannedCamera camera = is_turned ? turned(input.camera) : input.camera;
  camera.rate_hz = rate_hz;
  CameraOption option;
  option.rate_hz = rate_hz;
  option.turned = is_turned;
  option.obstacle = obstacle_of(camera);
  option.fits = fits(input, camera);
  if (option.obstacle == Obstacle::kNone) count_troubles(input, camera, option);
  if (!option.fits) option.penalty += 10.0;
  return option;
}

}  // namespace

double highest_frequency_hz(const PlanInput& input) noexcept {
  double highest_hz = 0.0;
  for (const PlannedMode& mode : input.modes) highest_hz = std::max(highest_hz, mode.frequency_hz);
  return std::ceil(1.1 * highest_hz);
}

bool fits(const PlanInput& input, const PlannedCamera& camera) noexcept {
  constexpr double kShareOfPicture = 0.9;  // share of the image for the structure; the rest is for drift
  return input.length_mm / mm_per_px(camera, input.distance_mm) <= kShareOfPicture * room_px(camera, input.axis);
}

FoldSurvey survey_folds(const PlanInput& input, const PlannedCamera& camera) {
  FoldSurvey survey;
  const FoldingConfig folding{camera.rate_hz, highest_frequency_hz(input),
                              row_delays_s(camera, input.axis, input.distance_mm, input.length_mm, input.positions)};
  const auto [low, high] = std::minmax_element(folding.delay_s.begin(), folding.delay_s.end());
  survey.delay_span_frames = (*high - *low) * camera.rate_hz;
  std::vector<double> apparent_hz, half_power_hz;
  for (std::size_t i = 0; i < input.modes.size(); ++i) {
    const PlannedMode& mode = input.modes[i];
    const std::vector<double> shape =
        mode.shape.empty() ? ideal_shape(input.kind, static_cast<int>(i) + 1, input.positions, input.n_floors)
                           : mode.shape;
    survey.places.push_back(fold_place(mode.frequency_hz, mode.damping_ratio, shape, folding));
    apparent_hz.push_back(survey.places.back().apparent_hz);
    half_power_hz.push_back(2.0 * mode.damping_ratio * mode.frequency_hz);
  }
  survey.overlaps = overlaps(apparent_hz, half_power_hz);
  return survey;
}

std::vector<CameraOption> camera_options(const PlanInput& input) {
  std::vector<double> rates{input.camera.rate_hz};
  for (const double rate_hz : input.rates_hz) {
    if (std::find(rates.begin(), rates.end(), rate_hz) == rates.end()) rates.push_back(rate_hz);
  }
  std::sort(rates.begin() + 1, rates.end());
  std::vector<CameraOption> out;
  for (const double rate_hz : rates) {
    out.push_back(evaluate(input, rate_hz, false));
    out.push_back(evaluate(input, rate_hz, true));
  }
  return out;
}

std::size_t best_option(const std::vector<CameraOption>& options) noexcept {
  std::size_t best = 0;
  const auto distance = [&](std::size_t i) {
    return std::abs(std::log(options[i].rate_hz / options[0].rate_hz)) + (options[i].turned ? 1e-6 : 0.0);
  };
  for (std::size_t i = 1; i < options.size(); ++i) {
    if (options[i].obstacle != Obstacle::kNone) continue;
    const double gain = options[best].penalty - options[i].penalty;
    if (gain > 0.0 || (gain == 0.0 && distance(i) < distance(best))) best = i;
  }
  return best;
}

}  // namespace core::planning
