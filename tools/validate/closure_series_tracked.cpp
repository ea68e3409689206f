// Records of displacements measured from tracks, with an effect in their clock or structure, and without any.
#include "tools/validate/closure_series_tracked.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "core/simulation/track_generator.h"
#include "core/types/constants.h"
#include "firmware_app/replay/track_analysis.h"
#include "tools/validate/drawn_scene.h"
#include "tools/validate/geometry_flight.h"

namespace tools {
namespace {

using core::kRadPerDeg;
using core::simulation::Scene;
using core::simulation::TrackGenerator;

constexpr double kTrackedDuration_s = 120.0, kNear = 0.06;

double lost(const Scene&, const TrackedSeries& s) { return s.n_lost; }
double twice(const Scene&, const TrackedSeries& s) { return s.n_twice; }
double jitter(const Scene&, const TrackedSeries& s) { return s.jitter_rms_ms; }

void soften(Scene& s, double size) { s.change.softening = size * Draw(s.seed, "softening").sign(); }
void drift(Scene& s, double size) { s.change.frequency_drift = size * Draw(s.seed, "frequency_drift").sign(); }
double softness(const Scene& s, const TrackedSeries&) { return -100.0 * s.change.softening; }
double drifted(const Scene& s, const TrackedSeries&) { return 100.0 * s.change.frequency_drift; }
// Larger jitter would exchange neighbours, and the simulator refuses it.
void jitter_by(Scene& s, double size) { s.timing.jitter_rms_s = std::min(size, 0.2 / s.camera.rate_hz); }
void drop(Scene& s, double size) { s.timing.drop_probability = size * Draw(s.seed, "drops").log_uniform(0.5, 2.0); }
void repeat(Scene& s, double size) {
  s.timing.duplicate_probability = size * Draw(s.seed, "repeats").log_uniform(0.5, 2.0);
}
void nothing(Scene&, double) {}

class Recorder {
 public:
  explicit Recorder(const Scene& scene) : scene_(scene), generator_(scene) {
    job_.file.scene = scene;
    job_.depth = Depth::kTracks;
  }

  TrackedSeries record(const Delivery& delivery) {
    TrackedSeries out;
    Draw insertion(scene_.seed, "inserted_frames");
    core::simulation::FrameTiming timing = generator_.timing();
    std::uint64_t last = 0;
    shimmer_px_ = delivery.shimmer_px;
    double squares = 0.0, n = 0.0;
    for (core::simulation::DeliveredFrame frame; timing.next(frame); n += 1.0) {
      if (n > 0.0 && frame.number == last) ++out.n_twice;
      if (frame.number > last) out.n_lost += static_cast<int>(frame.number - last) - 1;
      last = frame.number;
      squares += std::pow(1e3 * (frame.t_s - static_cast<double>(frame.number) / scene_.camera.rate_hz), 2);
      take(frame, out.series);
      if (n > 0.0 && insertion.uniform(0.0, 1.0) < delivery.inserted) take(frame, out.series), ++out.n_twice;
    }
    out.n_lost = delivery.inserted > 0.0 ? 0 : out.n_lost - out.n_twice;
    out.jitter_rms_ms = std::sqrt(squares / n);
    out.series.rate_hz = scene_.camera.rate_hz;
    if (delivery.average) out.series.rate_hz *= static_cast<double>(n_rows_) / static_cast<double>(scene_.n_frames());
    out.clock.rate_is_average = delivery.average;
    return out;
  }

 private:
  // Frames are counted: the sequence is that of delivery.
  void take(const core::simulation::DeliveredFrame& frame, app::ChannelSeries& out) {
    generator_.generate(frame, tracks_);
    tracks_.sequence = n_rows_;
    tracks_.t_start_ns = std::llround(1e9 * static_cast<double>(n_rows_) / scene_.camera.rate_hz);
    ++n_rows_;
    if (shimmer_px_ > 0.0) shimmer();
    if (!analysis_) {
      const DeclaredRun run = declared_run(job_, {}, {.overrides = {"telemetry.lcm_url="}}, generator_.motion());
      analysis_ = std::make_unique<app::TrackAnalysis>(run.config, run.camera, tracks_);
      out.channels = analysis_->channels();
      out.value.resize(out.channels.size());
      out.unit = "mm";
    }
    (void)analysis_->push(tracks_);
    const core::DisplacementSample& sample = analysis_->sample();
    for (std::size_t c = 0; c < out.channels.size(); ++c)
      out.value[c].push_back(sample.seen[c] != 0 ? sample.value_mm[c] : std::nan(""));
  }

  // Air between camera and structure: neighbouring regions move together, with a correlation time of some tenths of a
  // second.
  void shimmer() {
    const double keep = std::exp(-2.0 * std::numbers::pi * air_corner_hz_ / scene_.camera.rate_hz);
    const std::size_t n_regions = generator_.regions().size();
    air_.resize(n_regions + 1, 0.0);
    for (double& one : air_) one = keep * one + std::sqrt(1.0 - keep * keep) * air_draw_.gaussian();
    for (core::TrackPoint& point : tracks_.points)
      point.u_px += shimmer_px_ * std::sqrt(0.5) * (air_[point.region] + air_[point.region + 1]);
  }

  Scene scene_;
  TrackGenerator generator_;
  SimulateJob job_;
  Draw air_draw_{scene_.seed, "air"};
  double air_corner_hz_ = air_draw_.log_uniform(0.5, 5.0), shimmer_px_ = 0.0;
  std::vector<double> air_;
  core::TrackFrame tracks_;
  std::unique_ptr<app::TrackAnalysis> analysis_;
  std::uint64_t n_rows_ = 0;
};

const core::Mode* nearest(const core::ModalEstimate& estimate, double hz) {
  const core::Mode* best = nullptr;
  double least = kNear * hz;
  for (const core::Mode& mode : estimate.modes) {
    if (std::abs(mode.frequency_hz - hz) < least) least = std::abs(mode.frequency_hz - hz), best = &mode;
  }
  return best;
}

}  // namespace

Scene tracked_scene(std::uint64_t seed) {
  Scene scene = draw_scene(seed, kTrackedDuration_s).scene;
  Draw hover(seed, "tracked_hover");
  // The view was drawn for the largest values of these.
  scene.hover.x_rms_mm *= hover.uniform(0.2, 1.0);
  scene.hover.y_rms_mm *= hover.uniform(0.2, 1.0);
  scene.hover.z_rms_mm *= hover.uniform(0.2, 1.0);
  scene.hover.corner_hz = hover.log_uniform(0.05, 0.4);
  scene.hover.order = hover.uniform(4.0, 6.0);
  if (hover.sign() > 0.0) scene.excitation.base = 0.0, scene.excitation.forces = 1.0;
  scene.timing.stamps_tell = false;
  scene.tracks.points_per_region = 10;
  return scene;
}

TrackedNull tracked_null(std::uint64_t seed) {
  TrackedNull out{tracked_scene(seed)};
  Scene& scene = out.scene;
  Draw draw(seed, "tracked_null");
  const Scene plain = scene;
  double much = 1.0;
  const auto add = [&] {
    scene = plain;
    switch (seed % 6) {
      case 0:
        out.words = "nothing else";
        break;
      case 1:
        out.words = "rolling gusts";
        scene.hover.roll_rms_rad = much * 0.5 * kRadPerDeg;
        scene.hover.corner_hz = 0.5, scene.hover.order = 4.0, scene.hover.limit_hz = 10.0;
        break;
      case 2:
        out.words = "oblique view";
        scene.camera.yaw_rad = much * 24.0 * kRadPerDeg, scene.camera.pitch_rad = much * 8.0 * kRadPerDeg;
        break;
      case 3:
        out.words = "fast hover";
        scene.hover.order = 3.0, scene.hover.limit_hz = 12.0;
        break;
      case 4:
        out.words = "rotors, locking";
        scene.rotor.pitch_rms_rad = scene.rotor.roll_rms_rad = 1e-4;
        scene.tracks.pixel_locking_px = 0.03;
        break;
      default:
        out.words = "shimmer", out.shimmer_px = 0.3;
    }
    try {
      core::simulation::validate(scene);
      return true;
    } catch (const std::invalid_argument&) {
      return false;
    }
  };
  much = draw.uniform(0.3, 1.0);
  while (!add()) much *= 0.7;
  out.shimmer_px *= much;
  return out;
}

const std::vector<TrackedCase>& tracked_cases() {
  static const std::vector<TrackedCase> all{
      {"softening", "softening", "3 %", 0.03, false, soften, softness},
      {"softening", "softening", "6 %", 0.06, true, soften, softness},
      {"softening", "softening", "12 %", 0.12, true, soften, softness},
      {"drift", "frequency_drift", "1 %", 0.01, false, drift, drifted},
      {"drift", "frequency_drift", "2 %", 0.02, true, drift, drifted},
      {"drift", "frequency_drift", "4 %", 0.04, true, drift, drifted},
      {"jitter", "time_stamp_jitter", "4 ms", 4e-3, true, jitter_by, jitter},
      {"drops", "dropped_frames", "1 %", 0.01, true, drop, lost},
      {"repeats", "duplicated_frames", "1 %", 0.01, true, repeat, twice},
      {"insertions", "duplicated_frames", "1 %", 0.0, true, nothing, twice, 0.01},
      {"variable rate", "dropped_frames", "5 %", 0.05, true, drop, lost, 0.0, true}};
  return all;
}

TrackedSeries tracked_series(const Scene& scene, const Delivery& delivery) { return Recorder(scene).record(delivery); }

PoleErrors pole_errors(const app::ChannelSeries& before, const app::ChannelSeries& after, const Scene& scene) {
  const app::ChannelSeries* series[2] = {&before, &after};
  core::ModalEstimate estimate[2];
  for (int i = 0; i < 2; ++i) estimate[i] = app::identify_series(*series[i], {}).estimate;
  PoleErrors out;
  for (const auto& truth : core::simulation::modes_of(scene.structure)) {
    const core::Mode* mode[2] = {nearest(estimate[0], truth.frequency_hz), nearest(estimate[1], truth.frequency_hz)};
    if (truth.frequency_hz > 0.45 * scene.camera.rate_hz || mode[0] == nullptr || mode[1] == nullptr) continue;
    ++out.n;
    for (int i = 0; i < 2; ++i) {
      const double f = mode[i]->frequency_hz / truth.frequency_hz - 1.0;
      const double zeta = mode[i]->damping_ratio - truth.damping_ratio;
      out.frequency[i] += f * f, out.pole[i] += f * f + zeta * zeta;
    }
  }
  for (int i = 0; i < 2; ++i) {
    out.frequency[i] = 100.0 * std::sqrt(out.frequency[i] / out.n);
    out.pole[i] = 100.0 * std::sqrt(out.pole[i] / out.n);
  }
  return out;
}

}  // namespace tools
