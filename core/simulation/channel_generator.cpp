#include "core/simulation/channel_generator.h"

#include <cmath>
#include <numbers>

#include "core/simulation/random_stream.h"

namespace core::simulation {
namespace {

// +1 if the world's axis of motion appears along the region's axis, -1 if against it.
double sign_of(const SceneMotion& motion, int body, const core::ChannelInfo& channel) {
  const bool along_x = motion.scene().structure.axis == StructureModel::Axis::kX;
  const ImagePoint a = motion.see(body, {0.0, 0.0}, 0.0);
  const ImagePoint b = motion.see(body, {along_x ? 1.0 : 0.0, along_x ? 0.0 : 1.0}, 0.0);
  const double step = (b.u_px - a.u_px) * channel.direction_u + (b.v_px - a.v_px) * channel.direction_v;
  return step < 0.0 ? -1.0 : 1.0;
}

}  // namespace

ChannelGenerator::ChannelGenerator(const SceneMotion& motion, double stated_readout_s) : motion_(motion) {
  const CameraParameters& camera = motion.scene().camera;
  for (const auto& [body, region] : tracking_regions(motion_)) {
    if (body == kBackgroundBody) continue;
    const ImagePoint middle{region.u_px + 0.5 * region.width_px, region.v_px + 0.5 * region.height_px};
    const double share = readout_share(camera, middle), angle = region.axis_deg * std::numbers::pi / 180.0;
    core::ChannelInfo channel;
    channel.region = static_cast<std::uint16_t>(channels_.size());
    channel.name = region.name;
    channel.direction_u = std::cos(angle);
    channel.direction_v = std::sin(angle);
    channel.row_delay_s = stated_readout_s * share;
    channel.is_base = body == 0;
    Place place{body, sign_of(motion_, body, channel), motion_.line_time_s(0.0, middle), 0.0};
    place.keyframe_mm = along_axis_mm(place, 0.0);
    channels_.push_back(std::move(channel));
    places_.push_back(place);
  }
  scale_mm_per_px_ = (motion.scene().plates[0].z_mm - camera.z_mm) / camera.alpha_px;
}

double ChannelGenerator::along_axis_mm(const Place& place, double t_frame_s) const noexcept {
  const double t_s = t_frame_s + place.middle_s, offset_s = motion_.exposure_offset_s();
  const StructureResponse& structure = motion_.structure();
  if (offset_s <= 0.0) return place.sign * structure.displacement_mm(place.body, t_s);
  return 0.5 * place.sign *
         (structure.displacement_mm(place.body, t_s - offset_s) +
          structure.displacement_mm(place.body, t_s + offset_s));
}

core::DisplacementSample ChannelGenerator::sample_prototype() const {
  core::DisplacementSample sample;
  sample.value_mm.assign(channels_.size(), 0.0);
  sample.sigma_mm.assign(channels_.size(), motion_.scene().channels.noise_mm);
  sample.seen.assign(channels_.size(), 0);
  sample.n_points.assign(channels_.size(), 0);
  return sample;
}

void ChannelGenerator::generate(const DeliveredFrame& frame, core::DisplacementSample& out) const {
  if (out.value_mm.size() != channels_.size()) out = sample_prototype();
  const Scene& scene = motion_.scene();
  out.sequence = frame.sequence;
  out.t_start_ns = std::llround(frame.stamp_s * 1e9);
  out.gap_before = frame.gap_before;
  out.scale_mm_per_px = scale_mm_per_px_;
  // Separate streams: a change of the loss leaves the remaining noise unchanged. A repeated picture has the same noise.
  RandomStream noise(scene.seed, "channel_noise", frame.number), loss(scene.seed, "channel_loss", frame.number);
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const bool seen = loss.uniform() >= scene.channels.loss_probability;
    const double error_mm = scene.channels.noise_mm * noise.gaussian();
    out.value_mm[i] = seen ? along_axis_mm(places_[i], frame.t_s) - places_[i].keyframe_mm + error_mm : 0.0;
    out.seen[i] = seen ? 1 : 0;
    out.n_points[i] = seen ? static_cast<std::uint16_t>(scene.tracks.points_per_region) : std::uint16_t{0};
  }
}

}  // namespace core::simulation
