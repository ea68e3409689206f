#include "firmware_app/service/outlets.h"

#include <fmt/core.h>

#include <utility>

#include "drivers/camera/network/stream_address.h"
#include "drivers/storage/text_file.h"
#include "drivers/telemetry/publisher_factory.h"
#include "drivers/telemetry/run_identity.h"
#include "firmware_app/config/core_config.h"
#include "firmware_app/report/modal_json.h"
#include "firmware_app/report/pictures/pictures.h"
#include "firmware_app/report/run_findings.h"

namespace app {

std::vector<std::shared_ptr<drivers::FolderClaim>> claim_folders(const AppConfig& config, std::string& warning) {
  std::vector<std::shared_ptr<drivers::FolderClaim>> claims;
  const auto claim = [&](const std::string& folder, const char* key) {
    if (!folder.empty()) claims.push_back(drivers::FolderClaim::take(folder, key));
  };
  claim(config.report.directory, "report.directory");
  claim(config.record.directory, "record.directory");
  try {
    claim(config.state.directory, "state.directory");
  } catch (const drivers::FileError& error) {  // a run without its state is worth more than none
    warning = fmt::format("{}; the run goes on without state", error.what());
  }
  return claims;
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
                                  {t.stream_id, config.hash, drivers::run_identity()},
                                  t.max_kbit_s,
                                  recorder != nullptr ? recorder->log() : nullptr},
                                 &warning);
}

std::unique_ptr<RunReport> open_report(const AppConfig& config, const Source& source) {
  if (config.report.directory.empty()) return nullptr;
  if (!config.report.compare.empty()) (void)read_modal_json(config.report.compare);  // refused now, not after the run
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

// Without a password.
std::string source_name(const CameraConfig& camera) {
  if (camera.driver != drivers::CameraKind::kStream) return camera.source;
  return drivers::stream_address(camera.source, camera.transport).shown;
}

std::function<void(const PublishStage::Findings&, const core::Health&, const std::string&)> picture_drawer(
    const AppConfig& config, const Source& source, const RunReport* report, const core::MotionAxes& axes) {
  if (report == nullptr) return {};
  return [&config, &source, report, &axes](const PublishStage::Findings& found, const core::Health& health,
                                           const std::string& folder) {
    PictureInputs inputs = picture_inputs(config, source.info, source.channels());
    inputs.first_frame = &source.keyframe_image();
    inputs.keyframe = &source.keyframe;
    inputs.spectrum = &found.spectrum;
    inputs.estimate = &found.estimate;
    inputs.closure = found.closure;
    inputs.history = &report->history();
    const RunFacts facts = run_facts(config, source.info, source_name(config.camera), health, found.estimate, axes);
    inputs.facts = &facts;
    (void)write_pictures(folder, inputs);
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

std::string event_line(std::string_view stage, const rt::Event& event) {
  std::string text = event.what;
  for (const std::int64_t value : event.values) {
    const std::size_t at = text.find("{}");
    if (at != text.npos) text.replace(at, 2, std::to_string(value));
  }
  return fmt::format("{}: {}", stage, text);
}

}  // namespace app
