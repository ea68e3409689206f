#include "core/simulation/track_generator.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "core/simulation/random_stream.h"

namespace core::simulation {
namespace {

void validate(const TrackOptions& options) {
  if (options.points_per_region < 1 || options.points_per_region > 10000) {
    throw std::invalid_argument("simulation: points per region is " + std::to_string(options.points_per_region) +
                                "; give 1 to 10000");
  }
  if (!(options.noise_px >= 0.0 && options.noise_px <= 100.0)) {
    throw std::invalid_argument("simulation: track noise is " + std::to_string(options.noise_px) +
                                " px; give 0 to 100");
  }
  if (!(options.loss_probability >= 0.0 && options.loss_probability <= 1.0)) {
    throw std::invalid_argument("simulation: loss probability is " + std::to_string(options.loss_probability) +
                                "; give 0 to 1");
  }
}

}  // namespace

TrackGenerator::TrackGenerator(const Scene& scene, const TrackOptions& options)
    : motion_(scene), options_(options), regions_(tracking_regions(motion_)) {
  validate(options);
  for (std::size_t r = 0; r < regions_.size(); ++r) {
    const core::Region& region = regions_[r].region;
    RandomStream stream(scene.seed, "track_points", r);
    for (int i = 0; i < options.points_per_region; ++i) {
      const double u = region.u_px + region.width_px * stream.uniform();
      const double v = region.v_px + region.height_px * stream.uniform();
      points_.push_back(
          {regions_[r].body, static_cast<std::uint16_t>(r), motion_.material_point(regions_[r].body, {u, v}, 0.0)});
    }
  }
}

void TrackGenerator::generate_true(std::uint64_t frame, core::TrackFrame& out) const {
  const double t_frame_s = motion_.frame_time_s(frame);
  out.sequence = frame;
  out.t_start_ns = std::llround(t_frame_s * 1e9);
  out.gap_before = false;
  out.points.resize(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const ImagePoint image = motion_.see(points_[i].body, points_[i].point, t_frame_s);
    core::TrackPoint& point = out.points[i];
    point = {image.u_px, image.v_px, options_.noise_px, static_cast<std::uint32_t>(i), points_[i].region, true, true};
  }
}

void TrackGenerator::generate(std::uint64_t frame, core::TrackFrame& out) const {
  generate_true(frame, out);
  // Two streams: a change of the loss leaves the noise of the points that remain.
  RandomStream noise(motion_.scene().seed, "track_noise", frame);
  RandomStream loss(motion_.scene().seed, "track_loss", frame);
  for (core::TrackPoint& point : out.points) {
    point.u_px += options_.noise_px * noise.gaussian();
    point.v_px += options_.noise_px * noise.gaussian();
    point.seen = loss.uniform() >= options_.loss_probability;
    point.inlier = point.seen;
  }
}

}  // namespace core::simulation
