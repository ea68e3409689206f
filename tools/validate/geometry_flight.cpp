#include "tools/validate/geometry_flight.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "core/simulation/channel_generator.h"
#include "core/simulation/random_stream.h"
#include "firmware_app/replay/track_analysis.h"
#include "tools/hovermodal/simulate/config.h"
#include "tools/validate/geometry_attitude.h"
#include "tools/validate/recorded_hover.h"

namespace tools {
namespace {

using core::simulation::DeliveredFrame;
using core::simulation::TrackGenerator;

void hover_instead(core::simulation::HoverParameters& hover, double scale) {
  hover.x_rms_mm = hover.z_rms_mm = 120.0 * scale;
  hover.y_rms_mm = 40.0 * scale;
}

// A hundredth of the tracker's noise in each channel: a static ground region without noise would count as no channel.
double whisper_mm(const core::simulation::Scene& scene) {
  const double mm_per_px = (scene.plates.front().z_mm - scene.camera.z_mm) / scene.camera.alpha_px;
  return 0.01 * mm_per_px * scene.tracks.noise_px / std::sqrt(scene.tracks.points_per_region);
}

// The scene without the tracker's errors, except for this small noise.
core::simulation::Scene quiet(core::simulation::Scene scene) {
  scene.channels = {.noise_mm = whisper_mm(scene), .loss_probability = 0.0};
  return scene;
}

bool is_background(const core::Region& region) { return region.role == core::RegionRole::kBackground; }

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

// Adds the user's statements about the regions to the text written by `simulate`.
std::string with_region_facts(std::string text, const core::simulation::Scene& scene, bool ground_rests) {
  if (configuration_knows("depth_m") && text.find("depth_m") == std::string::npos) {
    const double depth_m = 1e-3 * (scene.background.depth_mm - scene.camera.z_mm);
    text = replaced(text, "role: background\n", fmt::format("role: background\n    depth_m: {}\n", depth_m));
  }
  return ground_rests && configuration_knows("| ground") ? replaced(text, "role: base", "role: ground") : text;
}

// The points then determine the scale.
std::string without_known_length(std::string text) {
  for (const char* key : {"  known_length_mm:", "  from:", "  to:"}) {
    const std::size_t at = text.find(key);
    if (at != std::string::npos) text.erase(at, text.find('\n', at) + 1 - at);
  }
  return replaced(std::move(text), "scale:\n", "");
}

// scale.points: corners of the lowest, a middle and the highest plate, in mm along the plane.
std::string plane_points(const core::simulation::SceneMotion& motion) {
  constexpr double kReading_px = 0.5;
  const auto& plates = motion.scene().plates;
  core::simulation::RandomStream reading(motion.scene().seed, "plane_points");
  std::string out;
  for (const std::size_t body : {std::size_t{0}, plates.size() / 2, plates.size() - 1}) {
    for (const double x : {-0.5, 0.5}) {
      for (const double y : {-0.5, 0.5}) {
        const core::simulation::PlanePoint corner{x * plates[body].width_mm, y * plates[body].height_mm};
        const auto seen = motion.see(static_cast<int>(body), corner, 0.0);
        const double u_px = seen.u_px + kReading_px * reading.gaussian();
        out += fmt::format("{}[{:.2f}, {:.2f}, {}, {}]", out.empty() ? "" : ", ", u_px,
                           seen.v_px + kReading_px * reading.gaussian(), plates[body].x_mm + corner.x_mm,
                           plates[body].y_mm + corner.y_mm);
      }
    }
  }
  return "scale.points=[" + out + "]";
}

// One way of analysis, fed frame by frame.
class Run {
 public:
  Run(const DeclaredRun& declared, const Way& way, const core::TrackFrame& keyframe,
      const core::simulation::SceneMotion& motion)
      : without_(way.with_background ? -1 : background_of(declared.config)),
        config_(without_ < 0 ? declared.config : without_background(declared.config)),
        tracks_(keyframe),
        analysis_(config_, declared.camera, kept(keyframe)) {
    if (way.attitude_sigma_deg > 0.0) attitude_.emplace(motion.camera(), way.attitude_sigma_deg, motion.scene().seed);
  }

  void push(const core::TrackFrame& frame) {
    constexpr double kAhead_s = 0.05;  // attitudes received by the time the frame is tracked
    if (attitude_) {
      for (const core::AttitudeSample& sample :
           attitude_->until(1e-9 * static_cast<double>(frame.t_start_ns) + kAhead_s))
        analysis_.take(sample);
    }
    (void)analysis_.push(kept(frame));
  }
  [[nodiscard]] app::TrackAnalysis& analysis() noexcept { return analysis_; }

 private:
  static int background_of(const app::AppConfig& config) {
    const auto at = std::find_if(config.regions.begin(), config.regions.end(), is_background);
    return at == config.regions.end() ? -1 : static_cast<int>(at - config.regions.begin());
  }
  static app::AppConfig without_background(app::AppConfig config) {
    std::erase_if(config.regions, is_background);
    return config;
  }
  // The background is the last region, so the numbers of the others do not change.
  core::TrackFrame& kept(const core::TrackFrame& frame) {
    tracks_ = frame;
    if (without_ >= 0) std::erase_if(tracks_.points, [&](const auto& point) { return point.region == without_; });
    return tracks_;
  }

  int without_;
  app::AppConfig config_;
  core::TrackFrame tracks_;
  app::TrackAnalysis analysis_;
  std::optional<ToldAttitude> attitude_;
};

// Spectra of the true motion are computed once, and identified with each prewhitening that a way uses.
class Truth {
 public:
  Truth(const DeclaredRun& declared, const core::simulation::ChannelGenerator& generator)
      : generator_(generator),
        analysis_(declared.config, generator.channels(), declared.camera.rate_hz),
        sample_(generator.sample_prototype()) {}

  void push(const DeliveredFrame& frame) {
    generator_.generate(frame, sample_);
    (void)analysis_.push(sample_);
  }
  void finish() { (void)analysis_.finish(); }
  [[nodiscard]] const core::DisplacementSample& sample() const noexcept { return sample_; }
  [[nodiscard]] const core::CpsdSums& sums() const noexcept { return analysis_.sums(); }
  [[nodiscard]] const core::ModalEstimate& identified(int n_differences) {
    const auto known = estimates_.find(n_differences);
    if (known != estimates_.end()) return known->second;
    return estimates_[n_differences] = analysis_.identified(n_differences);
  }

 private:
  const core::simulation::ChannelGenerator& generator_;
  app::ChannelAnalysis analysis_;
  core::DisplacementSample sample_;
  std::map<int, core::ModalEstimate> estimates_;
};

}  // namespace

bool configuration_knows(const std::string& words) {
  static const std::string help = app::config_help();
  return help.find(words) != std::string::npos;
}

SimulateJob flight_job(const FlightSetup& setup, std::uint64_t seed, double duration_s,
                       const GeometryOptions& options) {
  drivers::SceneOverrides overrides;
  overrides.seed = seed;
  overrides.duration_s = options.duration_s > 0.0 ? options.duration_s : duration_s;
  SimulateJob job;
  job.file = drivers::parse_scene(setup.scene, "geometry", overrides);
  job.depth = Depth::kTracks;
  auto& scene = job.file.scene;
  if (setup.drawn) scene = drawn_flight(scene, *setup.drawn);
  if (setup.flight_scale > 0.0 && options.flight.empty()) hover_instead(scene.hover, setup.flight_scale);
  if (setup.flight_scale > 0.0 && !options.flight.empty()) {
    scene.flight = recorded_hover(options.flight, setup.flight_scale, seed, scene.duration_s);
  }
  core::simulation::validate(scene);
  return job;
}

std::vector<std::string> configuration_of(const SimulateJob& job, const FlightSetup& setup) {
  std::vector<std::string> overrides = setup.configuration;
  if (!setup.drawn) return overrides;
  const std::vector<std::string> own = drawn_configuration(job.scene(), *setup.drawn);
  overrides.insert(overrides.end(), own.begin(), own.end());
  return overrides;
}

DeclaredRun declared_run(const SimulateJob& job, const FlightSetup& setup, const Way& way,
                         const core::simulation::SceneMotion& motion) {
  SimulateJob declared = job;
  drivers::Declared& readout = declared.file.declare.readout_ms;
  if (way.readout == StatedReadout::kNone) readout.kind = drivers::Declared::Kind::kNothing;
  if (way.readout == StatedReadout::kWholeFrame) {
    readout = {drivers::Declared::Kind::kValue, 1e3 / job.scene().camera.rate_hz};
  }
  std::vector<std::string> overrides{"closure.adopt=off"};  // reports change no mode, and take seconds each
  for (const std::string& text : configuration_of(job, setup)) overrides.push_back(text);
  overrides.insert(overrides.end(), way.overrides.begin(), way.overrides.end());
  if (way.plane_points) overrides.push_back(plane_points(motion));
  if (way.attitude_sigma_deg > 0.0) {  // passed frame by frame, not over a network
    for (const std::string& text :
         {fmt::format("camera.attitude_sigma_deg={}", way.attitude_sigma_deg),
          std::string("camera.attitude_channel=SIM"), std::string("telemetry.lcm_url=udpm://239.255.76.67:7667?ttl=0")})
      overrides.push_back(text);
  }
  const bool is_paper = std::find(overrides.begin(), overrides.end(), "method=paper") != overrides.end();
  std::string text =
      with_region_facts(config_text(declared, motion, "tracks.csv"), job.scene(), setup.ground_rests && !is_paper);
  if (way.plane_points) text = without_known_length(std::move(text));
  return {app::parse_config(text, way.name, overrides), declared.declared_camera()};
}

AnalysedFlight analyse_flight(const SimulateJob& job, const FlightSetup& setup, const std::vector<Way>& ways,
                              const SampleObserver& observe) {
  const TrackGenerator generator(job.scene());
  const core::simulation::ChannelGenerator true_channels(core::simulation::SceneMotion(quiet(job.scene())),
                                                         job.scene().camera.readout_s);
  Truth truth(declared_run(job, setup, {}, generator.motion()), true_channels);

  std::vector<std::unique_ptr<Run>> runs;
  core::TrackFrame frame;
  auto timing = generator.timing();
  for (DeliveredFrame delivered; timing.next(delivered);) {
    generator.generate(delivered, frame);
    if (runs.empty()) {
      for (const Way& way : ways) {
        runs.push_back(
            std::make_unique<Run>(declared_run(job, setup, way, generator.motion()), way, frame, generator.motion()));
      }
    }
    truth.push(delivered);
    for (std::size_t w = 0; w < runs.size(); ++w) {
      runs[w]->push(frame);
      if (observe) observe(w, runs[w]->analysis().sample(), truth.sample());
    }
  }
  truth.finish();
  AnalysedFlight result{{}, truth.sums(), job.scene().camera.rate_hz, job.scene().duration_s};
  for (const auto& run : runs) {
    app::ChannelAnalysis& analysis = run->analysis().analysis();
    Analysed analysed{analysis.finish(), {}, run->analysis().channels(), analysis.sums()};
    analysed.truth = truth.identified(analysis.n_differences());
    result.ways.push_back(std::move(analysed));
  }
  return result;
}

core::ModalEstimate true_estimate(const SimulateJob& job, const FlightSetup& setup, int n_differences) {
  const core::simulation::SceneMotion motion(quiet(job.scene()));
  const core::simulation::ChannelGenerator channels(motion, job.scene().camera.readout_s);
  Truth truth(declared_run(job, setup, {}, motion), channels);
  auto timing = channels.timing();
  for (DeliveredFrame delivered; timing.next(delivered);) truth.push(delivered);
  truth.finish();
  return truth.identified(n_differences);
}

}  // namespace tools
