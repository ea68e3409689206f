#include "firmware_app/service/pipeline.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <stdexcept>

#include "drivers/host/host_status.h"
#include "firmware_app/chain/makers.h"
#include "firmware_app/chain/state/run_head.h"
#include "firmware_app/config/core_config.h"
#include "firmware_app/report/page/report_page.h"
#include "firmware_app/report/recording_words.h"
#include "firmware_app/service/health.h"
#include "firmware_app/service/pipeline_setup.h"
#include "firmware_app/service/stages/closure_stage.h"
#include "firmware_app/service/stages/identification_stage.h"
#include "rt/memory.h"
#include "rt/stage_runner.h"

namespace app {

// The data flow, top to bottom. Members are destroyed in reverse: threads first, then stages, rings, devices.
struct Pipeline::Parts {
  Parts(const AppConfig& c, std::unique_ptr<drivers::Camera> camera, std::unique_ptr<drivers::RunRecorder> record,
        std::unique_ptr<drivers::Publisher> publisher)
      : config(c),
        lock_refused(keep_memory(config)),
        source(std::move(camera), config),
        recorder(std::move(record)),
        out(std::move(publisher)) {
    connect();
    watch();
    const std::optional<RunState> resumed = keeps_state() ? keep_state() : std::nullopt;
    if (recorder)
      recorder->begin(
          run_head(config, source.info, source.keyframe, source.keyframe_image(), resumed ? &*resumed : nullptr));
  }

  AppConfig config;
  std::string lock_refused;  // why memory is not locked; empty: it is, or need not be
  Source source;             // camera, its first frame, the points seeded in it, the channels
  std::unique_ptr<drivers::AttitudeListener> attitude = open_attitude(config);  // null: none comes live
  std::unique_ptr<drivers::RunRecorder> recorder;                               // null: the run is not recorded
  std::unique_ptr<drivers::Publisher> out;
  std::unique_ptr<RunReport> report = open_report(config, source);

  // What the stages call: the chain, which a replay runs in one loop (TrackAnalysis).
  CorrectionLog book;  // what the diagnosis takes out beyond what was declared
  DisplacementMeter meter{source.displacement, source.readout};
  core::WelchConfig welch = welch_config(config.spectrum, source.displacement.spectra().size(), source.info.rate_hz,
                                         source.displacement.n_witnesses());
  SpectrumAccumulator spectra{welch, config.identification.period_hops};
  ModeIdentification modes{source.info.rate_hz,
                           identifier_maker(config, source.info, source.keyframe, source.displacement.spectra()), book};
  Diagnosis diagnosis{missing_effect_search_config(config, source.info, source.keyframe), book,
                      geometry_maker(config, source.info, source.keyframe)};
  core::PreviewMaker preview_maker = preview_maker_for(config, source);

  // camera -> [frames] -> tracking -> [samples] -> spectrum -> (snapshots) -> identification -> [results] -> publish
  //                                -> [records], (previews) -> publish
  //                                -> [recent_tracks] -> closure -> [closures] -> publish; [correction_switches] -> tracking
  // spectrum, identification -> (spectrum_states, mode_states) -> checkpoint -> the state file
  rt::SpscRing<core::Frame> frames{slots(config.rt.frame_slots), source.first_frame};
  rt::SpscRing<core::DisplacementSample> samples{slots(config.rt.sample_slots), source.displacement.sample_prototype()};
  rt::SpscRing<FrameRecord> records{slots(config.rt.sample_slots), record_prototype(source)};
  rt::TripleBuffer<core::Preview> previews{preview_maker.prototype()};
  rt::TripleBuffer<SpectrumSnapshot> snapshots{SpectrumSnapshot{core::WelchCpsd::empty_sums(welch)}};
  rt::SpscRing<IdentificationResult> results{slots(kResultSlots), IdentificationResult{}};
  rt::SpscRing<core::TrackFrame> recent_tracks{closes_loop() ? slots(kRecentSlots) : 1, source.keyframe};
  rt::SpscRing<core::closure::ClosureReport> closures{slots(kResultSlots), core::closure::ClosureReport{}};
  rt::SpscRing<CorrectionSwitch> correction_switches{slots(kResultSlots), CorrectionSwitch{}};
  rt::TripleBuffer<StateBytes> spectrum_states{state_room(spectra.state_bytes())};
  rt::TripleBuffer<StateBytes> mode_states{state_room(modes.state_bytes())};

  CaptureStage capture{*source.camera, frames.writer(), source.first_frame, config.rt.thin_overload};
  TrackingStage tracking{{frames.reader(), samples.writer(), records.writer(), previews, attitude_samples(),
                          where(closes_loop(), recent_tracks.writer()), where(takes_out(), correction_switches.reader())},
                         {source.tracker, meter, preview_maker, capture.thinning()},
                         source.info.lossless,
                         diagnosis.change()};
  SpectrumStage spectrum{
      {samples.reader(), snapshots, keeps_state() ? &spectrum_states : nullptr}, spectra, source.info.lossless};
  IdentificationStage identification{{snapshots, results.writer(), keeps_state() ? &mode_states : nullptr}, modes};
  ClosureStage closure{{recent_tracks.reader(), closures.writer(), where(takes_out(), correction_switches.writer())},
                       diagnosis};
  CheckpointStage checkpoint{spectrum_states, mode_states, view_of(config, source), state_path(config)};
  HealthCollector health{source.info.rate_hz, capture, tracking, spectrum};
  PublishStage publish{{records.reader(), results.reader(), previews, where(closes_loop(), closures.reader())},
                       outlets()};

  // Started back to front, stopped front to back.
  rt::StageRunner run_capture{capture, frame_thread("hm-capture", config.rt, config.rt.capture_cpu)};
  rt::StageRunner run_tracking{tracking, frame_thread("hm-tracking", config.rt, config.rt.tracking_cpu)};
  rt::StageRunner run_spectrum{spectrum, frame_thread("hm-spectrum", config.rt, config.rt.spectrum_cpu)};
  rt::StageRunner run_identification{identification, {"hm-identify"}};
  rt::StageRunner run_closure{closure, {"hm-closure"}};
  rt::StageRunner run_publish{publish, {"hm-publish"}};
  rt::StageRunner run_checkpoint{checkpoint, {"hm-checkpoint"}};
  const std::vector<rt::StageRunner*> all_runners = list_runners();  // in flow order

  static constexpr int kResultSlots = 8, kRecentSlots = 1024;
  static std::size_t slots(int n) { return static_cast<std::size_t>(n); }
  template <class End>
  static std::optional<End> where(bool is_wanted, End end) {
    return is_wanted ? std::optional<End>(std::move(end)) : std::nullopt;
  }

  // Before anything is allocated and before the camera runs: locking takes as long as several frames.
  [[nodiscard]] static std::string keep_memory(const AppConfig& config) {
    if (!config.rt.lock_memory) return {};
    rt::keep_freed_memory();
    return rt::lock_memory();
  }
  [[nodiscard]] const std::vector<rt::StageRunner*>& runners() const noexcept { return all_runners; }
  [[nodiscard]] bool closes_loop() const noexcept { return config.closure.adopt != ClosureAdopt::kOff; }
  [[nodiscard]] bool takes_out() const noexcept { return config.closure.adopt == ClosureAdopt::kAuto; }
  [[nodiscard]] bool keeps_state() const noexcept { return !config.state.directory.empty(); }
  [[nodiscard]] std::optional<rt::RingReader<core::AttitudeSample>> attitude_samples() const {
    return attitude ? std::optional(attitude->samples()) : std::nullopt;
  }
  [[nodiscard]] StateBytes state_room(std::size_t n_bytes) const {
    return {std::vector<std::uint8_t>(keeps_state() ? n_bytes : 0), 0};
  }
  [[nodiscard]] std::vector<rt::StageRunner*> list_runners() {
    std::vector<rt::StageRunner*> all{&run_capture, &run_tracking, &run_spectrum, &run_identification};
    if (closes_loop()) all.push_back(&run_closure);
    all.push_back(&run_publish);
    if (keeps_state()) all.push_back(&run_checkpoint);
    return all;
  }
  [[nodiscard]] PublishStage::Outlets outlets() {
    return {*out,
            recorder.get(),
            report.get(),
            [this] { return status_with_host(); },
            picture_drawer(config, source, report.get()),
            source.channels(),
            corrections(config, source.info),
            caveats(config, source.info),
            config.telemetry,
            config.regions};
  }

  // The reader is nudged when an item arrives, the writer when a slot becomes free. A newest value's writer waits for
  // its reader only where a lossless source does.
  template <class Ring>
  static void nudge(Ring& ring, rt::Stage& writer, rt::Stage& reader) {
    ring.set_writer_wakeup(&writer.wakeup());
    ring.set_reader_wakeup(&reader.wakeup());
  }
  void connect() {
    nudge(frames, capture, tracking);
    nudge(samples, tracking, spectrum);
    nudge(records, tracking, publish);
    nudge(snapshots, spectrum, identification);
    nudge(results, identification, publish);
    nudge(recent_tracks, tracking, closure);
    nudge(closures, closure, publish);
    nudge(correction_switches, closure, tracking);
    previews.set_reader_wakeup(&publish.wakeup());
    spectrum_states.set_reader_wakeup(&checkpoint.wakeup());
  }
  [[nodiscard]] std::optional<RunState> keep_state() {
    spectra.keep_state(config.state.period_s);
    health.watch_state(checkpoint);
    health.watch({&run_checkpoint, {}, 0});
    keep_keyframe(config, source, health);
    return resume_state(state_path(config), view_of(config, source), spectra, modes, health);
  }
  void watch() {
    health.name_regions(region_names(config));
    health.watch_camera(*source.camera);
    if (attitude) health.watch_attitude(*attitude);
    if (recorder) health.watch_record(*recorder);
    health.watch({&run_capture, {}, 0});
    health.watch({&run_tracking, [this] { return frames.depth(); }, frames.n_slots()});
    health.watch({&run_spectrum, [this] { return samples.depth(); }, samples.n_slots()});
    health.watch({&run_identification, {}, 0});
    if (closes_loop()) health.watch({&run_closure, [this] { return recent_tracks.depth(); }, recent_tracks.n_slots()});
    health.watch({&run_publish, [this] { return records.depth(); }, records.n_slots()});
    const auto stall_ns = static_cast<std::int64_t>(1e9 * config.rt.stall_s);
    for (rt::StageRunner* runner : runners()) runner->set_stall_limit_ns(stall_ns);
    for (rt::StageRunner* slow : {&run_identification, &run_closure}) slow->set_stall_limit_ns(10 * stall_ns);
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
  [[nodiscard]] core::Health status_with_host() {
    core::Health now = status();
    now.host = drivers::read_host_status(config.report.directory);
    return now;
  }
};

Pipeline::Pipeline(const AppConfig& config) {
  std::unique_ptr<drivers::Camera> camera = open_camera(config);
  std::string warning;
  std::unique_ptr<drivers::RunRecorder> recorder = open_recorder(config);
  std::unique_ptr<drivers::Publisher> publisher = open_publisher(config, recorder.get(), warning);
  parts_ = std::make_unique<Parts>(config, std::move(camera), std::move(recorder), std::move(publisher));
  if (!warning.empty()) parts_->health.warn(warning);
}

Pipeline::Pipeline(const AppConfig& config, std::unique_ptr<drivers::Camera> camera,
                   std::unique_ptr<drivers::Publisher> publisher)
    : parts_(std::make_unique<Parts>(config, std::move(camera), open_recorder(config), std::move(publisher))) {}

Pipeline::~Pipeline() {
  request_stop();
  for (rt::StageRunner* runner : parts_->runners()) runner->abort();
  for (rt::StageRunner* runner : parts_->runners()) runner->join();
  parts_->source.camera->stop();
}

void Pipeline::start() {
  const RtConfig& rt_config = parts_->config.rt;
  if (!parts_->lock_refused.empty()) refuse_or_warn(rt_config, parts_->lock_refused, parts_->health);
  const auto& runners = parts_->runners();
  for (auto runner = runners.rbegin(); runner != runners.rend(); ++runner)
    start_runner(**runner, rt_config, parts_->health);
}

void Pipeline::request_stop() noexcept { parts_->capture.request_stop(); }

bool Pipeline::running() noexcept {
  const auto& runners = parts_->runners();
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
  for (const rt::StageRunner* runner : parts_->runners())
    outcome.stages_ended_ns = std::max(outcome.stages_ended_ns, runner->steps_ended_ns());
  outcome.estimate = parts_->publish.last_estimate();
  outcome.health = parts_->status();
  outcome.fault = parts_->fault();
  if (outcome.fault.empty()) {
    outcome.health.state = "finished";
    if (parts_->keeps_state()) {  // the next run is another one
      std::remove(state_path(parts_->config).c_str());
      std::remove(keyframe_path(parts_->config).c_str());
    }
  }
  if (outcome.fault.empty() && !parts_->source.camera->fault().empty())
    outcome.notes.push_back(parts_->source.camera->fault());
  if (std::string note = short_record(parts_->config, parts_->source.info, outcome.estimate); !note.empty()) {
    outcome.notes.push_back(std::move(note));
  }
  if (outcome.fault.empty() && parts_->report) outcome.page = parts_->config.report.directory + "/" + kReportName;
  return outcome;
}

std::string Pipeline::stall() const { return parts_->health.stall(); }
std::vector<std::string> Pipeline::take_events() {
  std::vector<std::string> lines;
  for (rt::StageRunner* runner : parts_->runners()) {
    rt::Stage& stage = runner->stage();
    (void)stage.events().drain([&](const rt::Event& event) { lines.push_back(event_line(stage.name(), event)); });
  }
  return lines;
}
core::Health Pipeline::health() const { return parts_->status(); }
const core::CameraInfo& Pipeline::camera_info() const noexcept { return parts_->source.info; }
const std::vector<core::ChannelInfo>& Pipeline::channels() const noexcept { return parts_->source.channels(); }
std::vector<std::string> Pipeline::warnings() const { return parts_->status().warnings; }

std::string check_source(const AppConfig& config) {
  return recording_words(Source(open_camera(config), config).camera->times());
}

}  // namespace app
