#include "core/tracking/klt/klt_tracker.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace core {

namespace {

constexpr double kFarthest_px = 1e6;
constexpr double kLeastGain = 0.2, kMostGain = 5.0;
constexpr double kLeastCorrelation = 0.5;
constexpr int kStepsOfOldGain = 3;
constexpr double kRounding = 1.0 / 12.0;
constexpr double kNear_px = 0.25;  // from a phase: more than to the middle between two, where neither is better

bool window_lies_in(const GrayView& gray, int u, int v, int radius) noexcept {
  return u >= radius && v >= radius && u + radius + 1 < gray.width && v + radius + 1 < gray.height;
}

// Thirds of a pixel. Left of or above the image: 0, where no window lies in it.
int nearest_phase(double place) noexcept {
  constexpr double kHalf = 0.5 / kPhasesPerPixel;
  return place > 0.0 ? static_cast<int>(kPhasesPerPixel * (place + kHalf)) : 0;
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
  note_deformation(point, point.deformation);
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
  const Deformation now = point.deformation;
  point = {};
  point.pattern = pattern;
  point.datum = place, point.u0 = middle.u, point.v0 = middle.v;
  point.reference = point.deformation = now;
  judge_texture(point);
  return true;
}

void KltTracker::shift_datum(std::size_t i, const Vector2& less) noexcept {
  Vector2& datum = points_[i].datum;
  datum = {datum.u - less.u, datum.v - less.v};
}

void KltTracker::set_deformation(std::size_t i, const Deformation& now, KltPoint& found) noexcept {
  Point& point = points_[i];
  if (found.seen) point.phase = found.phase;
  note_deformation(point, now);
  if (!found.seen) return;
  found.position = {found.position.u + (point.correction.u - found.correction.u),
                    found.position.v + (point.correction.v - found.correction.v)};
  found.correction = point.correction;
  state_sigma(point, found);
}

void KltTracker::note_deformation(Point& point, const Deformation& now) noexcept {
  point.deformation = now;
  point.deformed_energy = std::max(0.0, energy_of(point.pattern.deformed, now - point.reference));
  point.correction = correction(point);
}

// The template is found at an offset caused by deformation: that of its phase, less what the window has moved with the
// texture. The point lies off the window's centre, and this offset is deformed as well.
Vector2 KltTracker::correction(const Point& point) noexcept {
  const PhasePlace& phase = point.phase;
  const Deformation since = point.deformation - point.reference;
  const Vector2 pull = offset_by(point.pattern.phases[phase.v][phase.u].pull, since), moved = since.of(phase.off);
  const Vector2 beside = since.of(point.beside());
  return {beside.u - pull.u + moved.u, beside.v - pull.v + moved.v};
}

void KltTracker::state_sigma(const Point& point, KltPoint& found) noexcept {
  const PointTemplate& pattern = point.pattern;
  const Phase& phase = pattern.phases[found.phase.v][found.phase.u];
  const double deformed = found.residual_unit * (found.gain * found.gain) * point.deformed_energy;
  const double noise =
      std::max(kRounding, (found.residual - deformed) / (1.0 + phase.passed_noise / pattern.n_averaged));
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

void KltTracker::prefetch(const GrayView& gray, std::size_t i, const Vector2& predicted) const noexcept {
  const Point& point = points_[i];
  const Vector2 at = centre_at(point, predicted);
  if (!(at.u < kFarthest_px) || !(at.v < kFarthest_px)) return;
  const int thirds_u = nearest_phase(at.u), thirds_v = nearest_phase(at.v);
  const int cell_u = thirds_u / kPhasesPerPixel, cell_v = thirds_v / kPhasesPerPixel, radius = point.pattern.radius;
  if (!window_lies_in(gray, cell_u, cell_v, radius)) return;
  prefetch_window(gray, cell_u, cell_v, radius);
  prefetch_phase(point.pattern.phases[static_cast<std::size_t>(thirds_v % kPhasesPerPixel)]
                                     [static_cast<std::size_t>(thirds_u % kPhasesPerPixel)]);
}

KltPoint KltTracker::find(const GrayView& gray, std::size_t i, const Vector2& predicted) noexcept {
  Point& point = points_[i];
  const PointTemplate& pattern = point.pattern;
  KltPoint out;
  out.position = predicted, out.gain = point.gain;
  out.loss = PointLoss::kUnlike;
  if (!pattern.is_trackable) return out;
  const Vector2 start = centre_at(point, predicted);
  // Also rejects a NaN prediction.
  if (!(std::abs(start.u) < kFarthest_px) || !(std::abs(start.v) < kFarthest_px)) return out;
  Vector2 at = start;
  double gain = point.gain;
  for (int k = 0; k < config_.max_iterations; ++k) {
    const int thirds_u = nearest_phase(at.u), thirds_v = nearest_phase(at.v);
    const int cell_u = thirds_u / kPhasesPerPixel, cell_v = thirds_v / kPhasesPerPixel;
    if (!window_lies_in(gray, cell_u, cell_v, pattern.radius)) return out.loss = PointLoss::kLeftImage, out;
    out.phase.u = static_cast<std::uint8_t>(thirds_u % kPhasesPerPixel);
    out.phase.v = static_cast<std::uint8_t>(thirds_v % kPhasesPerPixel);
    const Phase& phase = pattern.phases[out.phase.v][out.phase.u];
    copy_window(gray, cell_u, cell_v, pattern.radius, window_);
    PhaseMatch match(phase, sums_over(window_, phase), pattern.radius);
    // Steps that do not converge have the wrong length, because the gain of the light has changed.
    if (k == kStepsOfOldGain && match.contrast() > 0.0) gain = std::clamp(match.contrast(), kLeastGain, kMostGain);
    const bool is_close = match.locate(gain);
    at = {static_cast<double>(thirds_u) / kPhasesPerPixel + match.place().u,
          static_cast<double>(thirds_v) / kPhasesPerPixel + match.place().v};
    if (!(length(at.u - start.u, at.v - start.v) <= config_.reach_px)) return out;
    if (!is_close) continue;
    gain = match.gain();
    if (std::abs(match.place().u) > kNear_px || std::abs(match.place().v) > kNear_px) continue;
    accept(point, match, at, out);
    return out;
  }
  out.position = {at.u - point.u0 + point.datum.u + point.correction.u,
                  at.v - point.v0 + point.datum.v + point.correction.v};
  return out;
}

// A place near the phase with which the window was compared.
void KltTracker::accept(Point& point, const PhaseMatch& match, const Vector2& place, KltPoint& out) const noexcept {
  out.phase.off = match.place();
  point.phase = out.phase;
  point.correction = out.correction = correction(point);
  out.position = {place.u - point.u0 + point.datum.u + point.correction.u,
                  place.v - point.v0 + point.datum.v + point.correction.v};
  const TemplateMatch found = match.judge();
  if (!(found.correlation >= point.least_correlation)) return;
  if (match.gain() < kLeastGain || match.gain() > kMostGain) {
    out.loss = PointLoss::kLight;
    return;
  }
  out.gain = point.gain = match.gain();
  out.residual = found.residual, out.residual_unit = found.residual_unit;
  state_sigma(point, out);
  out.seen = true, out.loss = PointLoss::kNone;
}

}  // namespace core
