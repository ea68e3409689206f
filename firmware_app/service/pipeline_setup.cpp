#include "firmware_app/service/pipeline_setup.h"

#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "core/tracking/view_match.h"
#include "drivers/camera/camera_factory.h"
#include "drivers/storage/checkpoint_file.h"
#include "drivers/telemetry/publisher_factory.h"
#include "firmware_app/chain/readout_aware_identifier.h"
#include "firmware_app/chain/state/run_view.h"
#include "firmware_app/config/config_image.h"
#include "firmware_app/config/core_config.h"
#include "firmware_app/report/pictures/pictures.h"
#include "firmware_app/report/run_findings.h"

namespace app {

namespace {

constexpr std::chrono::seconds kFirstFrameTimeout{10};

// Starts the camera once its source fits the configuration; what it is, is complete only then (exposure, readout,
// rate).
core::CameraInfo started(drivers::Camera& camera, const AppConfig& config) {
  const core::CameraInfo info = camera.info();
  check_against_image(config, info.width_px, info.height_px);
  const auto segment = static_cast<std::uint64_t>(config.spectrum.segment);
  if (info.frame_count != 0 && info.frame_count < segment) {
    throw ConfigError(
        fmt::format("spectrum.segment: {} frames in {} are fewer than one segment of {}: film at least {:.1f} s at "
                    "{:g} fps, or set spectrum.segment to {} or less",
                    info.frame_count, config.camera.source, segment, static_cast<double>(segment) / info.rate_hz,
                    info.rate_hz, info.frame_count));
  }
  camera.start();
  return camera.info();
}

core::Frame take_first_frame(drivers::Camera& camera, const core::CameraInfo& info) {
  core::Frame frame;
  frame.width_px = info.width_px;
  frame.height_px = info.height_px;
  frame.pixels.resize(static_cast<std::size_t>(info.width_px) * static_cast<std::size_t>(info.height_px));
  if (camera.capture(frame, kFirstFrameTimeout) != drivers::CaptureStatus::kFrame) {
    const std::string why = camera.fault();
    throw std::runtime_error(fmt::format("{}: no first frame within {} s{}{}", info.description,
                                         kFirstFrameTimeout.count(), why.empty() ? "" : ": ", why));
  }
  return frame;
}

// The kept points as they are found in the first frame; `kept` is emptied, and `datum` says why, where they are not.
core::StructureTracker tracker_of_kept(const AppConfig& config, const core::Frame& first,
                                       std::optional<KeptKeyframe>& kept, std::string& datum) {
  core::StructureTracker tracker(tracker_config(config));
  tracker.set_keyframe(kept->image, kept->points);
  core::TrackFrame found = kept->points;
  (void)tracker.track(first, found);
  const std::string other = core::why_other_view(kept->points, found, config.tracking.min_points);
  datum = other.empty() ? "displacements are measured from the keyframe of the run before"
                        : "points are seeded anew: " + other;
  if (!other.empty()) {
    kept.reset();
    return tracker;
  }
  tracker.learn(found);  // the next frame's points are looked for where these are
  kept->points.sequence = first.sequence;
  kept->points.t_start_ns = first.t_start_ns;
  return tracker;
}

std::optional<KeptKeyframe> find_kept(const AppConfig& config, const core::CameraInfo& info, std::string& datum) {
  if (config.state.directory.empty()) return {};
  KeyframeRead read = read_keyframe(keyframe_path(config), config.hash, info, config.regions.size());
  if (!read.refused.empty()) datum = "points are seeded anew: " + read.refused;
  return std::move(read.keyframe);
}

core::StructureTracker started_tracker(const AppConfig& config, const core::Frame& first,
                                       std::optional<KeptKeyframe>& kept, std::string& datum) {
  if (kept) {
    core::StructureTracker tracker = tracker_of_kept(config, first, kept, datum);
    if (kept) return tracker;
  }
  core::StructureTracker tracker(tracker_config(config));
  if (const std::string refused = tracker.seed(first); !refused.empty()) throw ConfigError("regions: " + refused);
  return tracker;
}

std::string refusal(const rt::ThreadConfig& thread, const std::error_code& code) {
  std::string asked;
  if (thread.fifo_priority > 0) asked = fmt::format("priority {}", thread.fifo_priority);
  if (thread.cpu >= 0) asked += fmt::format("{}CPU {}", asked.empty() ? "" : " on ", thread.cpu);
  const char* remedy = code.value() == EPERM ? "grant CAP_SYS_NICE or raise RLIMIT_RTPRIO"
                                             : "is there such a CPU, and may the service use it? (taskset -p 1)";
  return fmt::format("{}: {} refused ({}): {}", thread.name, asked, code.message(), remedy);
}

// The seeds as the first frame's tracks: the tracker finds each point where it was put.
core::TrackFrame track_keyframe(core::StructureTracker& tracker, const core::Frame& first) {
  core::TrackFrame keyframe;
  keyframe.points.resize(tracker.n_points());
  (void)tracker.track(first, keyframe);
  return keyframe;
}

}  // namespace

Source::Source(std::unique_ptr<drivers::Camera> opened, const AppConfig& config)
    : camera(std::move(opened)),
      info(started(*camera, config)),
      first_frame(take_first_frame(*camera, info)),
      kept(find_kept(config, info, datum)),
      tracker(started_tracker(config, first_frame, kept, datum)),
      keyframe(kept ? kept->points : track_keyframe(tracker, first_frame)),
      displacement(displacement_config(config, info), keyframe),
      readout(readout_config(config, info), keyframe) {}

std::unique_ptr<drivers::Camera> open_camera(const AppConfig& config) {
  const CameraConfig& c = config.camera;
  drivers::CameraOptions options;
  options.kind = static_cast<drivers::CameraKind>(c.driver);
  options.source = c.source;
  options.rate_hz = c.rate_hz;
  options.width_px = c.size_px[0];
  options.height_px = c.size_px[1];
  options.format = c.format;
  options.realtime = c.pace == Pace::kRealtime;
  options.readout_ms = c.readout_ms;
  options.readout_direction = c.readout_direction;
  options.exposure_ms = c.exposure_ms;
  options.synthetic_duration_s = c.synthetic_duration_s;
  options.synthetic_seed = c.synthetic_seed;
  return drivers::make_camera(options);
}

std::unique_ptr<drivers::AttitudeListener> open_attitude(const AppConfig& config) {
  if (config.camera.attitude_channel.empty()) return nullptr;
  return drivers::listen_for_attitude(config.telemetry.lcm_url, config.camera.attitude_channel);
}

std::unique_ptr<drivers::RunRecorder> open_recorder(const AppConfig& config) {
  if (config.record.directory.empty()) return nullptr;
  constexpr std::uint64_t kMb = 1'000'000;
  const TelemetryConfig& t = config.telemetry;
  return drivers::make_run_recorder({config.record.directory,
                                     kMb * static_cast<std::uint64_t>(config.record.file_mb),
                                     kMb * static_cast<std::uint64_t>(config.record.quota_mb),
                                     t.channel_prefix,
                                     {t.stream_id, config.hash}});
}

std::unique_ptr<drivers::Publisher> open_publisher(const AppConfig& config, drivers::RunRecorder* recorder,
                                                   std::string& warning) {
  const TelemetryConfig& t = config.telemetry;
  return drivers::make_publisher({t.lcm_url,
                                  t.channel_prefix,
                                  t.log_file,
                                  {t.stream_id, config.hash},
                                  t.max_kbit_s,
                                  recorder != nullptr ? recorder->log() : nullptr},
                                 &warning);
}

std::unique_ptr<RunReport> open_report(const AppConfig& config, const Source& source) {
  if (config.report.directory.empty()) return nullptr;
  return std::make_unique<RunReport>(config.report.directory, config, source.info, source.channels(),
                                     region_names(config));
}

std::string short_record(const AppConfig& config, const core::CameraInfo& info, const core::ModalEstimate& estimate) {
  const auto segment = static_cast<std::uint64_t>(config.spectrum.segment);
  if (estimate.n_samples >= segment) return {};
  return fmt::format(
      "the record holds {} samples, fewer than one segment of {}: its modes are a guess. Film at least {:.1f} s at "
      "{:g} fps, or lower "
      "spectrum.segment",
      estimate.n_samples, segment, static_cast<double>(segment) / info.rate_hz, info.rate_hz);
}

std::function<void(const PublishStage::Findings&, const core::Health&)> picture_drawer(const AppConfig& config,
                                                                                       const Source& source,
                                                                                       const RunReport* report) {
  if (report == nullptr) return {};
  return [&config, &source, report](const PublishStage::Findings& found, const core::Health& health) {
    PictureInputs inputs = picture_inputs(config, source.info, source.channels());
    inputs.first_frame = &source.keyframe_image();
    inputs.keyframe = &source.keyframe;
    inputs.spectrum = &found.spectrum;
    inputs.estimate = &found.estimate;
    inputs.closure = found.closure;
    inputs.history = &report->history();
    const RunFacts facts = run_facts(config, source.info, config.camera.source, health, found.estimate);
    inputs.facts = &facts;
    (void)write_pictures(config.report.directory, inputs);
  };
}

core::PreviewMaker preview_maker_for(const AppConfig& config, const Source& source) {
  const bool is_heard = !config.telemetry.lcm_url.empty() || !config.telemetry.log_file.empty();
  return {{is_heard ? config.telemetry.preview_period_s : 0.0, config.telemetry.preview_px},
          source.info.width_px,
          source.info.height_px,
          source.keyframe,
          config.regions.size()};
}

FrameRecord record_prototype(const Source& source) { return {source.keyframe, source.displacement.sample_prototype()}; }

RunState view_of(const AppConfig& config, const Source& source) {
  RunState view = run_view(config, source.info, source.channels());
  const bool is_file = config.camera.driver == CameraDriver::kFile || config.camera.driver == CameraDriver::kSynthetic;
  if (!is_file) view.boot_id = drivers::boot_id();
  return view;
}

std::string state_path(const AppConfig& config) {
  return config.state.directory.empty() ? "" : config.state.directory + "/hovermodal.state";
}

std::string keyframe_path(const AppConfig& config) {
  return config.state.directory.empty() ? "" : config.state.directory + "/hovermodal.keyframe";
}

void keep_keyframe(const AppConfig& config, const Source& source, HealthCollector& health) {
  if (!source.datum.empty()) health.warn(source.datum);
  if (source.kept) return;  // it stands there
  std::error_code unmade;   // then the writing says why
  std::filesystem::create_directories(config.state.directory, unmade);
  const std::string failure = write_keyframe(keyframe_path(config), config.hash, source.first_frame, source.keyframe);
  if (!failure.empty()) health.warn("the keyframe could not be kept: " + failure);
}

std::optional<RunState> resume_state(const std::string& path, const RunState& view, SpectrumAccumulator& spectra,
                                     ModeIdentification& modes, HealthCollector& health) {
  std::string refused;
  try {
    const drivers::CheckpointRead read = drivers::read_checkpoint(path);
    if (!read.exists) return {};
    refused = read.refused;
    if (refused.empty()) {
      RunState saved = run_state_of(read.bytes);
      refused = why_foreign(saved, view);
      if (view.boot_id.empty() || saved.boot_id != view.boot_id) saved.boot_id.clear();
      if (refused.empty() && !spectra.resume(saved.spectrum, !saved.boot_id.empty()))
        refused = "its spectra do not fit";
      if (refused.empty()) {
        const bool has_modes = modes.resume(saved.modes);
        const core::CpsdSums& sums = spectra.sums();
        health.warn(fmt::format("goes on with the state in {}: {:.1f} s of record, {} segments{}", path,
                                static_cast<double>(sums.n_samples) / sums.rate_hz, sums.n_segments,
                                has_modes ? "" : "; its modes begin anew"));
        return saved;
      }
    }
  } catch (const std::exception& e) {
    refused = e.what();
  }
  health.warn(fmt::format("the state in {} is not taken: {}; the record begins anew", path, refused));
  return {};
}

void refuse_or_warn(const RtConfig& config, const std::string& refused, HealthCollector& health) {
  if (config.required) throw RealTimeRefused(refused + " (rt.required is true)");
  health.warn(refused);
}

rt::ThreadConfig frame_thread(std::string name, const RtConfig& config, int cpu) {
  constexpr std::size_t kStackBytes = 2 << 20, kPrefaultBytes = 512 << 10;
  return {std::move(name), config.priority, cpu, kStackBytes, kPrefaultBytes};
}

std::string event_line(std::string_view stage, const rt::Event& event) {
  std::string text = event.what;
  for (const std::int64_t value : event.values) {
    const std::size_t at = text.find("{}");
    if (at != text.npos) text.replace(at, 2, std::to_string(value));
  }
  return fmt::format("{}: {}", stage, text);
}

void start_runner(rt::StageRunner& runner, const RtConfig& config, HealthCollector& health) {
  try {
    runner.start();
  } catch (const std::system_error& e) {
    if (!runner.config().is_special()) throw;
    refuse_or_warn(config, refusal(runner.config(), e.code()), health);
    runner.be_ordinary();
    runner.start();
  }
}

}  // namespace app
