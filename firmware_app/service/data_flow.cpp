#include "firmware_app/service/data_flow.h"

#include "drivers/host/host_status.h"
#include "firmware_app/chain/state/run_head.h"
#include "firmware_app/report/axis_findings.h"
#include "rt/memory.h"

namespace app {
namespace {

// Before anything is allocated and before the camera runs: locking memory takes as long as several frames.
std::string lock_memory_of(const RtConfig& config) {
  if (!config.lock_memory) return {};
  rt::keep_freed_memory();
  return rt::lock_memory();
}

// The reader is woken when an item arrives, the writer when a slot becomes free. The writer of a triple buffer waits
// for its reader only for a lossless source.
template <class Ring>
void nudge(Ring& ring, rt::Stage& writer, rt::Stage& reader) {
  ring.set_writer_wakeup(&writer.wakeup());
  ring.set_reader_wakeup(&reader.wakeup());
}

}  // namespace

DataFlow::DataFlow(const AppConfig& c, std::optional<core::structure::DeclaredFrame> declared,
                   std::unique_ptr<drivers::Camera> camera, std::unique_ptr<drivers::RunRecorder> record,
                   std::unique_ptr<drivers::Publisher> publisher)
    : config(c),
      structure(std::move(declared)),
      lock_refused(lock_memory_of(config.rt)),
      source(std::move(camera), config),
      recorder(std::move(record)),
      out(std::move(publisher)) {
  connect();
  watch();
  if (report && !report->remark().empty()) health.warn(report->remark());
  const std::optional<RunState> resumed = keeps_state() ? keep_state() : std::nullopt;
  if (resumed) checkpoint.go_on_with(resumed->modes);
  if (resumed) diagnosis.forget_past();
  if (resumed && report) report->set_recovered();
  if (recorder)
    recorder->begin(
        run_head(config, source.info, source.keyframe, source.keyframe_image(), resumed ? &*resumed : nullptr));
}

std::vector<rt::StageRunner*> DataFlow::list_runners() {
  std::vector<rt::StageRunner*> all{&run_capture, &run_tracking, &run_spectrum, &run_identification};
  if (closes_loop()) all.push_back(&run_closure);
  if (compares_structure()) all.push_back(&run_structure);
  all.push_back(&run_publish);
  if (keeps_state()) all.push_back(&run_checkpoint);
  return all;
}

PublishStage::Outlets DataFlow::outlets() {
  return {*out,
          recorder.get(),
          report.get(),
          [this] { return host_status(); },
          picture_drawer(config, source, report.get(), meter.axes()),
          source.channels(),
          corrections(config, source.info),
          caveats(config, source.info),
          config.telemetry,
          config.regions,
          [this] { return motion_across_words(config.regions, meter.axes()); }};
}

void DataFlow::connect() {
  nudge(frames, capture, tracking);
  nudge(samples, tracking, spectrum);
  nudge(aircraft_updates, tracking, spectrum);
  nudge(takeovers, tracking, spectrum);
  nudge(records, tracking, publish);
  nudge(snapshots, spectrum, identification);
  nudge(results, identification, publish);
  nudge(recent_tracks, tracking, closure);
  nudge(closures, closure, publish);
  nudge(correction_switches, closure, tracking);
  nudge(comparisons, structure_stage, publish);
  estimates.set_reader_wakeup(&structure_stage.wakeup());
  previews.set_reader_wakeup(&publish.wakeup());
  spectrum_states.set_reader_wakeup(&checkpoint.wakeup());
}

std::optional<RunState> DataFlow::keep_state() {
  spectra.keep_state(config.state.period_s);
  health.watch_state(checkpoint);
  health.watch({&run_checkpoint, {}, 0});
  keep_keyframe(config, source, health);
  return resume_state(state_path(config), view_of(config, source), spectra, modes, health);
}

void DataFlow::watch() {
  health.name_regions(region_names(config));
  health.watch_camera(*source.camera);
  if (attitude) health.watch_attitude(*attitude);
  if (aircraft) health.watch_aircraft(*aircraft);
  if (recorder) health.watch_record(*recorder);
  health.watch({&run_capture, {}, 0});
  health.watch({&run_tracking, [this] { return frames.depth(); }, frames.n_slots()});
  health.watch({&run_spectrum, [this] { return samples.depth(); }, samples.n_slots()});
  health.watch({&run_identification, {}, 0});
  if (closes_loop()) health.watch({&run_closure, [this] { return recent_tracks.depth(); }, recent_tracks.n_slots()});
  if (compares_structure()) health.watch({&run_structure, {}, 0});
  health.watch({&run_publish, [this] { return records.depth(); }, records.n_slots()});
  const auto stall_ns = static_cast<std::int64_t>(1e9 * config.rt.stall_s);
  for (rt::StageRunner* runner : runners) runner->set_stall_limit_ns(stall_ns);
  for (rt::StageRunner* slow : {&run_identification, &run_closure, &run_structure})
    slow->set_stall_limit_ns(10 * stall_ns);
}

std::string DataFlow::fault() {
  if (run_capture.faulted()) return "camera: " + source.camera->fault();
  if (run_publish.finished() && !publish.fault().empty()) return publish.fault();
  return {};
}

core::Health DataFlow::status() {
  core::Health now = health.collect(*out);
  if (const std::string text = fault(); !text.empty()) now.state = "fault: " + text;
  return now;
}

core::Health DataFlow::host_status() {
  core::Health now = status();
  now.host = drivers::read_host_status(config.report.directory);
  return now;
}

}  // namespace app
