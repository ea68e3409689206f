#include "tools/hovermodal/selftest/closure_tracks_record.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/closure/observation/frame_model.h"
#include "core/simulation/camera/camera_motion.h"
#include "core/simulation/presets.h"
#include "core/simulation/track_generator.h"

namespace tools {
namespace {

using core::simulation::Scene;
constexpr double kDegree = 57.29577951308232;

void set_roll(Scene& s, double size) { s.hover.roll_rms_rad = size / kDegree; }
void set_pitch(Scene& s, double size) { s.hover.pitch_rms_rad = size / kDegree; }
void set_yaw(Scene& s, double size) { s.hover.yaw_rms_rad = size / kDegree; }
// What the operator declares is less than the truth by so many frames.
void set_readout(Scene& s, double size) { s.camera.readout_s += size / s.camera.rate_hz; }
void set_radial(Scene& s, double size) {
  s.camera.lens.model = core::simulation::LensParameters::Model::kRadialTangential;
  s.camera.lens.k = {-size, 0.0, 0.0, 0.0, 0.0};
}
void set_tangential(Scene& s, double size) {
  s.camera.lens.model = core::simulation::LensParameters::Model::kRadialTangential;
  s.camera.lens.k = {0.0, 0.0, size, -0.5 * size, 0.0};
}
void set_locking(Scene& s, double size) { s.tracks.pixel_locking_px = size; }
void set_rotor(Scene& s, double size) {
  s.rotor.frequency_hz = 88.3;
  s.rotor.roll_rms_rad = size / kDegree;
  s.rotor.pitch_rms_rad = s.rotor.yaw_rms_rad = 0.6 * size / kDegree;
}
double same(const Scene&, double size) { return size; }
// What the camera really did in this record, about its mean: place in CameraMotion::deviation().
template <std::size_t kAxis>
double turned_deg(const Scene& s, double) {
  const core::simulation::CameraMotion camera(s);
  const auto n = static_cast<double>(s.n_frames());
  double sum = 0.0, squares = 0.0;
  for (std::uint64_t k = 0; k < s.n_frames(); ++k) {
    const double turn = camera.deviation(static_cast<double>(k) / s.camera.rate_hz)[kAxis];
    sum += turn, squares += turn * turn;
  }
  return kDegree * std::sqrt(squares / n - sum / n * sum / n);
}
double negative(const Scene&, double size) { return -size; }
double rotor_hz(const Scene& s, double) { return s.rotor.frequency_hz; }

}  // namespace

const std::vector<HiddenEffect>& hidden_effects() {
  static const std::vector<HiddenEffect> all{
      {"camera roll", 5.0, 0.01, set_roll, turned_deg<5>},
      {"camera pitch", 0.15, 0.05, set_pitch, turned_deg<3>},
      {"camera yaw", 3.0, 0.05, set_yaw, turned_deg<4>},
      {"readout time", 0.9, 0.1, set_readout, same},
      {"radial distortion", 0.5, 0.01, set_radial, negative},
      {"tangential distortion", 0.05, 0.001, set_tangential, same},
      {"pixel locking", 0.2, 0.005, set_locking, same},
      {"rotor line", 1.0, 0.001, set_rotor, rotor_hz},
  };
  return all;
}

Scene closure_scene(const RecordSetup& setup, std::uint64_t seed) {
  Scene scene = core::simulation::make_paper_scene(seed, setup.duration_s);
  scene.tracks.points_per_region = 10;
  scene.camera.readout_s = setup.readout_frames / scene.camera.rate_hz;
  if (setup.shaking == Shaking::kWind) {
    scene.excitation.base = 0.0;
    scene.excitation.forces = 1.0;
  }
  return scene;
}

core::closure::ObservationRecord observation_record(const Scene& scene, const Scene& declared, bool background,
                                                    bool noise) {
  const core::simulation::TrackGenerator generator(scene);
  core::closure::ObservationRecord record;
  record.rate_hz = declared.camera.rate_hz;
  record.alpha_px = declared.camera.alpha_px;
  record.cx_px = declared.camera.cx_px, record.cy_px = declared.camera.cy_px;
  record.width_px = declared.camera.width_px, record.height_px = declared.camera.height_px;
  record.readout_frames = declared.camera.readout_s * declared.camera.rate_hz;
  record.readout_direction = declared.camera.readout_direction;
  const core::simulation::TrackGenerator as_declared(declared);
  for (const auto& region : as_declared.regions()) record.regions.push_back(region.region);
  std::vector<std::size_t> use;
  for (std::size_t i = 0; i < generator.points().size(); ++i) {
    const std::size_t region = generator.points()[i].region;
    if (!background && record.regions[region].role == core::RegionRole::kBackground) continue;
    use.push_back(i);
    record.region_of_point.push_back(region);
    record.sigma_px.push_back(declared.tracks.noise_px);
  }
  const auto n_frames = static_cast<Eigen::Index>(scene.n_frames());
  record.u_px.setConstant(n_frames, static_cast<Eigen::Index>(use.size()), std::numeric_limits<double>::quiet_NaN());
  record.v_px = record.u_px;
  core::simulation::FrameTiming timing = generator.timing();
  core::simulation::DeliveredFrame frame;
  core::TrackFrame tracks;
  while (timing.next(frame)) {
    noise ? generator.generate(frame, tracks) : generator.generate_true(frame, tracks);
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

EffectSize size_for(const HiddenEffect& effect, const RecordSetup& setup, double strength) {
  RecordSetup brief = setup;
  brief.duration_s = 40.0;
  const Scene plain = closure_scene(brief, 1);
  Scene with = plain;
  effect.set(with, effect.start);
  const auto a = observation_record(plain, plain, setup.background);  // the same noise in both: locking acts with it
  const auto b = observation_record(with, plain, setup.background);
  core::closure::FrameModel model(a);
  Eigen::MatrixXd change(2 * a.n_points(), a.n_frames());
  for (Eigen::Index j = 0; j < a.n_points(); ++j) {
    change.row(2 * j) = (b.u_px.col(j) - a.u_px.col(j)).transpose();
    change.row(2 * j + 1) = (b.v_px.col(j) - a.v_px.col(j)).transpose();
  }
  change.array().colwise() *= model.weight().array();
  const double n = static_cast<double>(change.size());
  const double visible = std::sqrt(model.left_of(change).squaredNorm() / n) / effect.start;
  EffectSize size;
  size.size = strength / visible;
  if (effect.most > 0.0) size.size = std::min(size.size, effect.most);
  size.strength = size.size * visible;
  size.plain_strength = size.size * std::sqrt(change.squaredNorm() / n) / effect.start;
  return size;
}

}  // namespace tools
