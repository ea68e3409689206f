#include "tools/validate/closure_tracks_record.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "core/closure/observation/point_motion_model.h"
#include "core/simulation/track_generator.h"
#include "tools/validate/drawn_scene.h"

namespace tools {
namespace {

using core::closure::ObservationRecord;
using core::simulation::Scene;
using core::simulation::TrackGenerator;

constexpr int kPointsPerRegion = 10;

// Indices in TrackGenerator::points().
std::vector<std::size_t> points_used(const TrackGenerator& tracks, bool background) {
  std::vector<std::size_t> use;
  for (std::size_t i = 0; i < tracks.points().size(); ++i) {
    const auto role = tracks.regions()[tracks.points()[i].region].region.role;
    if (background || role != core::RegionRole::kBackground) use.push_back(i);
  }
  return use;
}

// Over every n-th frame shown by both scenes, with the same noise in both: rms of their difference about each point's
// mean.
double change_px(const Scene& with, const Scene& without, bool background) {
  constexpr std::uint64_t kEvery = 7;
  const TrackGenerator a(with), b(without);
  const std::vector<std::size_t> use = points_used(b, background);
  std::vector<double> sum(2 * use.size(), 0.0), squares(sum.size(), 0.0);
  core::TrackFrame frame_a, frame_b;
  double n = 0.0;
  auto timing = b.timing();
  for (core::simulation::DeliveredFrame frame; timing.next(frame);) {
    if (frame.number % kEvery != 0) continue;
    a.generate(frame, frame_a), b.generate(frame, frame_b);
    ++n;
    for (std::size_t c = 0; c < use.size(); ++c) {
      const core::TrackPoint &p = frame_a.points[use[c]], &q = frame_b.points[use[c]];
      const double du = p.u_px - q.u_px, dv = p.v_px - q.v_px;
      sum[2 * c] += du, squares[2 * c] += du * du;
      sum[2 * c + 1] += dv, squares[2 * c + 1] += dv * dv;
    }
  }
  double total = 0.0;
  for (std::size_t i = 0; i < sum.size(); ++i) total += squares[i] / n - sum[i] / n * sum[i] / n;
  return std::sqrt(std::max(total, 0.0) / static_cast<double>(sum.size()));
}

}  // namespace

bool holds_the_view(const Scene& scene) {
  try {
    core::simulation::validate(scene);
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

Scene closure_scene(const RecordSetup& setup, std::uint64_t seed) {
  Scene scene = draw_scene(seed, setup.duration_s).scene;
  scene.tracks.points_per_region = kPointsPerRegion;
  if (setup.readout_frames) scene.camera.readout_s = *setup.readout_frames / scene.camera.rate_hz;
  if (setup.shaking == Shaking::kWind) scene.excitation.base = 0.0, scene.excitation.forces = 1.0;
  return scene;
}

ObservationRecord observation_record(const Scene& scene, const Scene& declared, bool background) {
  const TrackGenerator generator(scene), as_declared(declared);
  ObservationRecord record;
  record.rate_hz = declared.camera.rate_hz;
  record.alpha_px = declared.camera.alpha_px;
  record.cx_px = declared.camera.cx_px, record.cy_px = declared.camera.cy_px;
  record.width_px = declared.camera.width_px, record.height_px = declared.camera.height_px;
  record.readout_frames = declared.camera.readout_s * declared.camera.rate_hz;
  record.readout_direction = declared.camera.readout_direction;
  for (const auto& region : as_declared.regions()) record.regions.push_back(region.region);
  const std::vector<std::size_t> use = points_used(as_declared, background);
  for (const std::size_t i : use) {
    record.region_of_point.push_back(generator.points()[i].region);
    record.sigma_px.push_back(generator.points()[i].stated_px);
  }
  const auto n_frames = static_cast<Eigen::Index>(scene.n_frames());
  record.u_px.setConstant(n_frames, static_cast<Eigen::Index>(use.size()), std::numeric_limits<double>::quiet_NaN());
  record.v_px = record.u_px;
  core::simulation::FrameTiming timing = generator.timing();
  core::TrackFrame tracks;
  for (core::simulation::DeliveredFrame frame; timing.next(frame);) {
    generator.generate(frame, tracks);
    const auto k = static_cast<Eigen::Index>(frame.number);
    if (k >= n_frames) break;
    for (std::size_t c = 0; c < use.size(); ++c) {
      const core::TrackPoint& point = tracks.points[use[c]];
      if (!point.seen) continue;
      record.u_px(k, static_cast<Eigen::Index>(c)) = point.u_px;
      record.v_px(k, static_cast<Eigen::Index>(c)) = point.v_px;
    }
  }
  return record;
}

EffectStrength strength_of(const ObservationRecord& with, const ObservationRecord& without, double noise_px,
                           bool visible) {
  Eigen::MatrixXd change(2 * without.n_points(), without.n_frames());
  for (Eigen::Index j = 0; j < without.n_points(); ++j) {
    change.row(2 * j) = (with.u_px.col(j) - without.u_px.col(j)).transpose();
    change.row(2 * j + 1) = (with.v_px.col(j) - without.v_px.col(j)).transpose();
  }
  const Eigen::VectorXd mean = change.rowwise().mean();
  change.colwise() -= mean;
  const auto n = static_cast<double>(change.size());
  EffectStrength out;
  out.plain = std::sqrt(change.squaredNorm() / n) / noise_px;
  out.constant = std::sqrt(mean.squaredNorm() / static_cast<double>(mean.size())) / noise_px;
  if (!visible) return out;
  const core::closure::PointMotionModel model(without);
  change.array().colwise() *= model.weight().array();
  out.visible = std::sqrt(model.left_of(change).squaredNorm() / n);
  return out;
}

double noise_px(const Scene& scene, bool background) {
  const TrackGenerator tracks(scene);
  double squares = 0.0;
  const std::vector<std::size_t> use = points_used(tracks, background);
  for (const std::size_t i : use) squares += tracks.points()[i].noise_px * tracks.points()[i].noise_px;
  return std::sqrt(squares / static_cast<double>(use.size()));
}

SizedScene set_effects(const std::vector<const HiddenEffect*>& effects, const Scene& declared,
                       std::vector<double> size) {
  for (std::size_t i = 0; i < effects.size(); ++i) size[i] = std::min(size[i], effects[i]->most);
  for (;;) {
    Scene scene = declared;
    for (std::size_t i = 0; i < effects.size(); ++i) effects[i]->set(scene, size[i]);
    if (holds_the_view(scene)) return {scene, size};
    for (double& one : size) one *= 0.8;
  }
}

SizedScene with_effects(const std::vector<const HiddenEffect*>& effects, const Scene& declared, double strength,
                        bool background) {
  const double wanted_px = strength * noise_px(declared, background);
  SizedScene all{declared, {}};
  for (const HiddenEffect* effect : effects) {
    SizedScene one = set_effects({effect}, declared, {effect->start});
    // Two rounds, because most effects grow in proportion to their size, a lens nearly so.
    for (int round = 0; round < 2; ++round)
      one = set_effects({effect}, declared, {one.size[0] * wanted_px / change_px(one.scene, declared, background)});
    all.size.push_back(one.size[0]);
  }
  return set_effects(effects, declared, all.size);
}

}  // namespace tools
