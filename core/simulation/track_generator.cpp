#include "core/simulation/track_generator.h"

#include <cmath>
#include <numbers>

#include "core/simulation/random_stream.h"

namespace core::simulation {
namespace {

// A template under zoom errs not quite linearly (core/tracking/METHOD.md): its direction turns, rad per unit.
constexpr double kTurnPerGrowth = 2.5;

// Periodic in the sub-pixel phase, skewed as interpolation errors are, at most about 1.2.
double sub_pixel_error(double position_px) noexcept {
  const double phase = 2.0 * std::numbers::pi * position_px;
  return std::sin(phase) + 0.25 * std::sin(2.0 * phase + 0.5);
}

// Log-normal with a mean square of 1; exactly 1 without spread.
double unequal(double spread, RandomStream& stream) noexcept {
  return std::exp(spread * stream.gaussian() - spread * spread);
}

}  // namespace

TrackGenerator::TrackGenerator(const Scene& scene)
    : motion_(scene), light_(scene), regions_(tracking_regions(motion_)) {
  const std::vector<Mark> marks = marks_of(scene);
  for (std::size_t r = 0; r < marks.size(); ++r) {
    const auto& [body, low, high] = marks[r];
    RandomStream stream(scene.seed, "track_points", r), direction(scene.seed, "brightness_bias", r);
    RandomStream spread(scene.seed, "track_noise_spread", r), error(scene.seed, "track_sigma_error", r);
    for (int i = 0; i < scene.tracks.points_per_region; ++i) {
      const double x_mm = low.x_mm + (high.x_mm - low.x_mm) * stream.uniform();
      const double y_mm = low.y_mm + (high.y_mm - low.y_mm) * stream.uniform();
      const double angle = 2.0 * std::numbers::pi * direction.uniform();
      const double noise_px = scene.tracks.noise_px * unequal(scene.tracks.noise_spread, spread);
      const double stated_px = noise_px * unequal(scene.tracks.sigma_error, error);
      points_.push_back(
          {body, static_cast<std::uint16_t>(r), {x_mm, y_mm}, std::cos(angle), std::sin(angle), noise_px, stated_px});
    }
  }
}

// Magnification of a body since the first frame, minus 1.
double TrackGenerator::grown(int body, double t_s) const noexcept {
  const auto scale = [&](double at_s) {
    const auto moved = motion_.camera().deviation(at_s);
    return (1.0 + moved[6]) / (motion_.depth_mm(body) - motion_.scene().camera.z_mm - moved[2]);
  };
  return motion_.scene().tracks.template_zoom_px > 0.0 ? scale(t_s) / scale(0.0) - 1.0 : 0.0;
}

void TrackGenerator::generate_true(const DeliveredFrame& frame, core::TrackFrame& out) const {
  out.sequence = frame.sequence;
  out.t_start_ns = std::llround(frame.stamp_s * 1e9);
  out.gap_before = frame.gap_before;
  out.points.resize(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const ImagePoint image = motion_.see(points_[i].body, points_[i].point, frame.t_s);
    out.points[i] = {image.u_px, image.v_px, points_[i].stated_px, static_cast<std::uint32_t>(i), points_[i].region,
                     true,       true};
  }
}

void TrackGenerator::generate(const DeliveredFrame& frame, core::TrackFrame& out) const {
  generate_true(frame, out);
  const TrackParameters& tracks = motion_.scene().tracks;
  // Separate streams: a change of the loss leaves the noise of the remaining points unchanged. A repeated picture has
  // the same noise.
  RandomStream noise(motion_.scene().seed, "track_noise", frame.number);
  RandomStream loss(motion_.scene().seed, "track_loss", frame.number);
  for (std::size_t i = 0; i < out.points.size(); ++i) {
    core::TrackPoint& point = out.points[i];
    const double t_s = motion_.line_time_s(frame.t_s, {point.u_px, point.v_px});
    const double brighter = light_.factor(t_s) - 1.0;
    const double bright_px = tracks.brightness_bias_px * brighter;
    const double growth = grown(points_[i].body, t_s), grown_px = tracks.template_zoom_px * growth;
    const double bias_u = points_[i].bias_u, bias_v = points_[i].bias_v, turn = kTurnPerGrowth * growth;
    const double locked_u = tracks.pixel_locking_px * sub_pixel_error(point.u_px);
    const double locked_v = tracks.pixel_locking_px * sub_pixel_error(point.v_px);
    point.u_px +=
        locked_u + bright_px * bias_u + grown_px * (bias_u - turn * bias_v) + points_[i].noise_px * noise.gaussian();
    point.v_px +=
        locked_v + bright_px * bias_v + grown_px * (bias_v + turn * bias_u) + points_[i].noise_px * noise.gaussian();
    point.seen = loss.uniform() >= tracks.loss_probability;
    point.inlier = point.seen;
  }
}

}  // namespace core::simulation
