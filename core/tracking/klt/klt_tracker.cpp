#include "core/tracking/klt/klt_tracker.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace core {

namespace {

constexpr double kFarthest_px = 1e6;
constexpr double kLongestStep_px = 3.0;
constexpr double kLeastGain = 0.2, kMostGain = 5.0;
constexpr double kLeastCorrelation = 0.5;
constexpr int kStepsOfOldGain = 3;
constexpr double kRounding = 1.0 / 12.0;
constexpr double kOfRounding = 0.5;  // smaller steps are below this share of the error of rounding to 8 bits

bool window_lies_in(const GrayView& gray, int u, int v, int radius) noexcept {
  return u >= radius && v >= radius && u + radius < gray.width && v + radius < gray.height;
}

// Cuts the patch about the pixel nearest to a point. False: the point is not finite.
bool cut_about(const GrayView& gray, const Vector2& point, Patch& patch) noexcept {
  if (gray.empty() || !(std::abs(point.u) < kFarthest_px) || !(std::abs(point.v) < kFarthest_px)) return false;
  cut_patch(gray, static_cast<int>(std::lround(point.u)), static_cast<int>(std::lround(point.v)), patch);
  return true;
}

}  // namespace

bool is_trackable(const GrayView& gray, const Vector2& point, int window_px) {
  Patch patch;
  return cut_about(gray, point, patch) && has_texture(patch, window_px / 2);
}

void KltTracker::set_keyframe(const GrayView& gray, const std::vector<Vector2>& points) {
  if (gray.empty()) throw std::invalid_argument("KltTracker: the keyframe is not an 8-bit image");
  if (config_.window_px < 5 || config_.window_px > kWindow)
    throw std::invalid_argument("KltTracker: a window has 5 to 21 px");
  points_.assign(points.size(), {});
  Patch patch;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Point& point = points_[i];
    point.datum = points[i];
    if (!cut_about(gray, points[i], patch)) continue;
    point.u0 = std::round(points[i].u), point.v0 = std::round(points[i].v);
    build_template(patch, config_.window_px / 2, 1, point.pattern);
    judge_texture(point);
  }
}

void KltTracker::replace_template(std::size_t i, const Patch& mean, int n_averaged,
                                  const Deformation& deformation) noexcept {
  Point& point = points_[i];
  PointTemplate averaged;
  averaged.noise = point.pattern.noise;  // noise of a single image
  build_template(mean, point.pattern.radius, n_averaged, averaged);
  if (!averaged.is_trackable) return;
  point.pattern = averaged;
  point.reference = deformation;
  judge_texture(point);
  correct(point);
}

bool KltTracker::renew(std::size_t i, const GrayView& gray, const Vector2& place, const Vector2& beside,
                       double most_variance_px2) noexcept {
  Point& point = points_[i];
  const Vector2 middle{std::round(place.u + beside.u), std::round(place.v + beside.v)};
  Patch patch;
  if (!cut_about(gray, middle, patch) ||
      !window_lies_in(gray, static_cast<int>(middle.u), static_cast<int>(middle.v), config_.window_px / 2))
    return false;
  PointTemplate pattern;
  build_template(patch, config_.window_px / 2, 1, pattern);
  if (!pattern.is_trackable || !(place_variance(pattern) <= most_variance_px2)) return false;
  point = {pattern, place, middle.u, middle.v, 1.0, 0.0, point.deformation, point.deformation, {}};
  judge_texture(point);
  return true;
}

void KltTracker::shift_datum(std::size_t i, const Vector2& less) noexcept {
  Vector2& datum = points_[i].datum;
  datum = {datum.u - less.u, datum.v - less.v};
}

void KltTracker::set_deformation(std::size_t i, const Deformation& now, KltPoint& found) noexcept {
  Point& point = points_[i];
  const Vector2 before = point.correction;
  point.deformation = now;
  correct(point);
  if (!found.seen) return;
  found.position = {found.position.u + (point.correction.u - before.u),
                    found.position.v + (point.correction.v - before.v)};
  state_sigma(point, found);
}

// The template is found at an offset caused by deformation. The point lies off the window's centre, and this offset is
// deformed as well.
void KltTracker::correct(Point& point) noexcept {
  const Deformation since = point.deformation - point.reference;
  const Vector2 pull = point.pattern.deformed.pull_of(since), beside = since.of(point.beside());
  point.correction = {beside.u - pull.u, beside.v - pull.v};
}

void KltTracker::state_sigma(const Point& point, KltPoint& found) noexcept {
  const PointTemplate& pattern = point.pattern;
  const double energy = pattern.deformed.energy_of(point.deformation - point.reference);
  const double deformed = found.residual_unit * std::max(0.0, found.gain * found.gain * energy);
  const double noise = std::max(kRounding, (found.residual - deformed) / (1.0 + 1.0 / pattern.n_averaged));
  const double per_noise = 0.5 * (pattern.variance_u + pattern.variance_v);
  found.sigma_px = std::sqrt(noise * per_noise) / found.gain;
  found.deformed_px = std::sqrt(deformed * per_noise) / found.gain;
}

Vector2 KltTracker::middle_of(std::size_t i, const Vector2& position) const noexcept {
  const Point& point = points_[i];
  const Vector2 beside = (point.deformation - point.reference).of(point.beside());
  return {position.u - point.datum.u + point.u0 - beside.u, position.v - point.datum.v + point.v0 - beside.v};
}

void KltTracker::judge_texture(Point& point) const noexcept {
  const PointTemplate& pattern = point.pattern;
  const double signal = pattern.variance - pattern.noise / pattern.n_averaged;
  const double expected = signal / std::sqrt(std::max(1e-12, pattern.variance * (signal + pattern.noise)));
  point.least_correlation = std::max(kLeastCorrelation, config_.least_correlation * expected);
}

// If steps do not converge, their length is wrong because the gain of the light has changed; this estimates it.
double KltTracker::gain_here(double otherwise) const noexcept {
  const TemplateMatch match = window_.match();
  if (!(match.correlation > kLeastCorrelation)) return otherwise;
  return std::clamp(match.gain / match.correlation, kLeastGain, kMostGain);  // contrast gain, robust to offsets
}

KltPoint KltTracker::find(const GrayView& gray, std::size_t i, const Vector2& predicted) noexcept {
  Point& point = points_[i];
  KltPoint out{predicted, 0.0, point.gain};
  out.loss = PointLoss::kUnlike;
  if (!point.pattern.is_trackable) return out;
  const double start_u = predicted.u - point.datum.u + point.u0 - point.correction.u;
  const double start_v = predicted.v - point.datum.v + point.v0 - point.correction.v;
  // Also rejects a NaN prediction.
  if (!(std::abs(start_u) < kFarthest_px) || !(std::abs(start_v) < kFarthest_px)) return out;
  double u = start_u, v = start_v;
  int cell_u = 0, cell_v = 0;
  const double enough_px =
      std::max(config_.epsilon_px,
               kOfRounding * std::sqrt(kRounding * std::max(point.pattern.variance_u, point.pattern.variance_v)));
  bool is_settled = false;
  Vector2 step;
  double gain = point.gain;
  window_.begin(gray, point.pattern);
  const auto advance = [&] {
    const double way = length(step) / gain;
    const double share = (way > kLongestStep_px ? kLongestStep_px / way : 1.0) / gain;
    u -= share * step.u, v -= share * step.v;
    return way;
  };
  for (int k = 0; k < config_.max_iterations && !is_settled; ++k) {
    cell_u = static_cast<int>(std::floor(u)), cell_v = static_cast<int>(std::floor(v));
    if (!window_lies_in(gray, cell_u, cell_v, point.pattern.radius)) return out.loss = PointLoss::kLeftImage, out;
    window_.move_to(cell_u, cell_v, u - cell_u, v - cell_v);
    step = window_.step();
    if (k == kStepsOfOldGain) gain = gain_here(gain);
    is_settled = advance() < enough_px;
    if (!(length(u - start_u, v - start_v) <= config_.reach_px)) return out;
  }
  out.position = {u - point.u0 + point.datum.u + point.correction.u, v - point.v0 + point.datum.v + point.correction.v};
  if (!is_settled) return out;
  const TemplateMatch match = window_.match(step);
  if (!(match.correlation >= point.least_correlation)) return out;
  if (match.gain < kLeastGain || match.gain > kMostGain) return out.loss = PointLoss::kLight, out;
  out.gain = point.gain = match.gain;
  out.residual = match.residual, out.residual_unit = match.residual_unit;
  state_sigma(point, out);
  out.seen = true, out.loss = PointLoss::kNone;
  return out;
}

}  // namespace core
