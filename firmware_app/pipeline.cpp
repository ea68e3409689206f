#include "firmware_app/pipeline.h"

#include <optional>
#include <stdexcept>

#include "firmware_app/core_config.h"
#include "firmware_app/health.h"
#include "firmware_app/pipeline_setup.h"
#include "firmware_app/readout_use.h"
#include "firmware_app/report/page/report_page.h"
#include "firmware_app/stages/identification_stage.h"
#include "rt/memory.h"
#include "rt/stage_runner.h"

namespace app {

// The data flow, top to bottom. Members are destroyed in reverse: threads first, then stages, rings, devices.
struct Pipeline::Parts {
  Parts(const AppConfig& c, std::unique_ptr<drivers::Camera> camera, std::unique_ptr<drivers::Publisher> publisher)
      : config(c), source(std::move(camera), config), out(std::move(publisher)) {
    connect();
    watch();
  }

  AppConfig config;
  Source source;  // camera, its first frame, the points seeded in it, the channels
  std::unique_ptr<drivers::AttitudeListener> attitude = open_attitude(config);  // null: none comes live
  std::unique_ptr<drivers::Publisher> out;
  std::unique_ptr<RunReport> report = open_report(config, source);
  ReadoutUse identifier{config, source.info, source.keyframe, source.channels()};

  // camera -> [frames] -> tracking -> [samples] -> spectrum -> [snapshots] -> identification -> [results] -> publish
  //                          \------------------ [records] ------------------------------------------------/
  rt::SpscRing<core::Frame> frames{slots(config.rt.frame_slots), source.first_frame};
  CaptureStage capture{*source.camera, frames.writer(), source.first_frame};

  rt::SpscRing<core::DisplacementSample> samples{slots(config.rt.sample_slots), source.displacement.sample_prototype()};
  rt::SpscRing<FrameRecord> records{slots(config.rt.sample_slots), record_prototype(source)};
  TrackingStage tracking{frames.reader(),  source.tracker,   source.displacement, source.readout,
                         samples.writer(), records.writer(), source.info.lossless};

  core::WelchConfig welch = welch_config(config.spectrum, source.channels().size(), source.info.rate_hz);
  rt::TripleBuffer<SpectrumSnapshot> snapshots{SpectrumSnapshot{core::WelchCpsd::empty_sums(welch), 0, 0, false, {}}};
  SpectrumStage spectrum{samples.reader(), welch, config.identification.period_hops, snapshots, source.info.lossless};

  rt::SpscRing<IdentificationResult> results{slots(kResultSlots), IdentificationResult{}};
  IdentificationStage identification{snapshots, identifier, results.writer()};

  HealthCollector health{source.info.rate_hz, capture, tracking, spectrum};
  PublishStage publish{records.reader(), results.reader(), outlets()};

  // Started back to front, stopped front to back.
  rt::StageRunner run_capture{capture, {"hm-capture", config.rt.priority}};
  rt::StageRunner run_tracking{tracking, {"hm-tracking", config.rt.priority}};
  rt::StageRunner run_spectrum{spectrum, {"hm-spectrum", config.rt.priority}};
  rt::StageRunner run_identification{identification, {"hm-identify"}};
  rt::StageRunner run_publish{publish, {"hm-publish"}};

  static constexpr int kResultSlots = 8;
  static std::size_t slots(int n) { return static_cast<std::size_t>(n); }

  [[nodiscard]] std::array<rt::StageRunner*, 5> runners() noexcept {
    return {&run_capture, &run_tracking, &run_spectrum, &run_identification, &run_publish};
  }
  [[nodiscard]] PublishStage::Outlets outlets() {
    return {*out,
            report.get(),
            [this] { return status(); },
            picture_drawer(config, source, report.get()),
            source.channels(),
            corrections(config, source.info),
            caveats(config, source.info),
            config.telemetry};
  }

  // Who is nudged when an item arrives, and when a slot becomes free.
  void connect() {
    if (attitude) tracking.hear_attitude(attitude->samples());
    frames.set_writer_wakeup(&capture.wakeup());
    frames.set_reader_wakeup(&tracking.wakeup());
    samples.set_writer_wakeup(&tracking.wakeup());
    samples.set_reader_wakeup(&spectrum.wakeup());
    records.set_writer_wakeup(&tracking.wakeup());
    records.set_reader_wakeup(&publish.wakeup());
    snapshots.set_writer_wakeup(&spectrum.wakeup());
    snapshots.set_reader_wakeup(&identification.wakeup());
    results.set_writer_wakeup(&identification.wakeup());
    results.set_reader_wakeup(&publish.wakeup());
  }
  void watch() {
    health.name_regions(region_names(config));
    health.watch({&capture, {}, 0});
    health.watch({&tracking, [this] { return frames.depth(); }, frames.n_slots()});
    health.watch({&spectrum, [this] { return samples.depth(); }, samples.n_slots()});
    health.watch({&identification, {}, 0});
    health.watch({&publish, [this] { return records.depth(); }, records.n_slots()});
  }
  [[nodiscard]] std::string fault() {
    if (run_capture.faulted()) return "camera: " + source.camera->fault();
    if (run_publish.finished() && !publish.fault().empty()) return publish.fault();
    return {};
  }
  [[nodiscard]] core::Health status() {
    core::Health now = health.collect(*out);
    if (const std::string text = fault(); !text.empty()) now.state = "fault: " + text;
    return now;
  }
};

Pipeline::Pipeline(const AppConfig& config) {
  std::unique_ptr<drivers::Camera> camera = open_camera(config);
  std::string warning;
  std::unique_ptr<drivers::Publisher> publisher = open_publisher(config, warning);
  parts_ = std::make_unique<Parts>(config, std::move(camera), std::move(publisher));
  if (!warning.empty()) parts_->health.warn(warning);
}

Pipeline::Pipeline(const AppConfig& config, std::unique_ptr<drivers::Camera> camera,
                   std::unique_ptr<drivers::Publisher> publisher)
    : parts_(std::make_unique<Parts>(config, std::move(camera), std::move(publisher))) {}

Pipeline::~Pipeline() {
  request_stop();
  for (rt::StageRunner* runner : parts_->runners()) runner->abort();
  for (rt::StageRunner* runner : parts_->runners()) runner->join();
  parts_->source.camera->stop();
}

void Pipeline::start() {
  const RtConfig& rt_config = parts_->config.rt;
  if (rt_config.lock_memory) {
    if (const std::string refused = rt::lock_memory(); !refused.empty())
      refuse_or_warn(rt_config, refused, parts_->health);
  }
  const auto runners = parts_->runners();
  for (auto runner = runners.rbegin(); runner != runners.rend(); ++runner)
    start_runner(**runner, rt_config, parts_->health);
}

void Pipeline::request_stop() noexcept { parts_->capture.request_stop(); }

bool Pipeline::running() noexcept {
  const auto runners = parts_->runners();
  for (std::size_t i = runners.size(); i-- > 0;) {
    if (!runners[i]->faulted()) continue;
    for (std::size_t upstream = 0; upstream < i; ++upstream) runners[upstream]->abort();  // their output has no reader
  }
  for (rt::StageRunner* runner : runners) {
    if (!runner->finished()) return true;
  }
  return false;
}

Pipeline::Outcome Pipeline::join() {
  for (rt::StageRunner* runner : parts_->runners()) runner->join();
  parts_->source.camera->stop();
  Outcome outcome;
  outcome.estimate = parts_->publish.last_estimate();
  outcome.health = parts_->status();
  outcome.fault = parts_->fault();
  if (outcome.fault.empty()) outcome.health.state = "finished";
  if (outcome.fault.empty() && !parts_->source.camera->fault().empty())
    outcome.notes.push_back(parts_->source.camera->fault());
  if (std::string note = short_record(parts_->config, parts_->source.info, outcome.estimate); !note.empty()) {
    outcome.notes.push_back(std::move(note));
  }
  if (outcome.fault.empty() && parts_->report) outcome.page = parts_->config.report.directory + "/" + kReportName;
  return outcome;
}

core::Health Pipeline::health() const { return parts_->status(); }
const core::CameraInfo& Pipeline::camera_info() const noexcept { return parts_->source.info; }
const std::vector<core::ChannelInfo>& Pipeline::channels() const noexcept { return parts_->source.channels(); }
std::vector<std::string> Pipeline::warnings() const { return parts_->status().warnings; }

void check_source(const AppConfig& config) { const Source source(open_camera(config), config); }

}  // namespace app
