#include "firmware_app/service/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "firmware_app/config/region_axis.h"
#include "firmware_app/report/axis_findings.h"
#include "firmware_app/report/loss_words.h"
#include "firmware_app/report/page/report_page.h"
#include "firmware_app/service/data_flow.h"
#include "firmware_app/service/found_axes.h"
#include "firmware_app/service/preflight.h"
#include "firmware_app/service/run_diagnosis.h"
#include "rt/clock.h"
#include "rt/memory.h"

namespace app {

Pipeline::Pipeline(const AppConfig& declared) {
  // The search for axes and the camera start threads.
  if (!declared.rt.lock_memory) rt::give_back_large_blocks();
  std::optional<core::structure::DeclaredFrame> structure = declared_structure(declared);
  std::string unclaimed;
  claims_ = claim_folders(declared, unclaimed);
  const AppConfig config = with_found_axes(declared);
  std::unique_ptr<drivers::Camera> camera = open_camera(config);
  std::string warning;
  std::unique_ptr<drivers::RunRecorder> recorder = open_recorder(config);
  std::unique_ptr<drivers::Publisher> publisher = open_publisher(config, recorder.get(), warning);
  flow_ = std::make_unique<DataFlow>(config, std::move(structure), std::move(camera), std::move(recorder),
                                     std::move(publisher));
  if (!unclaimed.empty()) flow_->health.warn(unclaimed);
  if (!warning.empty()) flow_->health.warn(warning);
  for (const std::string& words : axis_caveats(config)) flow_->health.warn(words);
}

Pipeline::Pipeline(AppConfig config, std::unique_ptr<drivers::Camera> camera,
                   std::unique_ptr<drivers::Publisher> publisher) {
  std::string unclaimed;
  claims_ = claim_folders(config, unclaimed);
  take_u_where_sought(config);
  flow_ = std::make_unique<DataFlow>(config, declared_structure(config), std::move(camera), open_recorder(config),
                                     std::move(publisher));
  if (!unclaimed.empty()) flow_->health.warn(unclaimed);
}

Pipeline::~Pipeline() {
  request_stop();
  for (rt::StageRunner* runner : flow_->runners) runner->abort();
  for (rt::StageRunner* runner : flow_->runners) runner->join();
  flow_->source.camera->stop();
}

void Pipeline::start() {
  const RtConfig& rt_config = flow_->config.rt;
  if (!flow_->lock_refused.empty()) refuse_or_warn(rt_config, flow_->lock_refused, flow_->health);
  const auto& runners = flow_->runners;
  for (auto runner = runners.rbegin(); runner != runners.rend(); ++runner)
    start_runner(**runner, rt_config, flow_->health);
}

void Pipeline::request_stop() noexcept {
  std::int64_t none = 0;
  stop_ns_.compare_exchange_strong(none, rt::monotonic_ns(), std::memory_order_relaxed);
  flow_->capture.request_stop();
  flow_->structure_stage.request_stop();
}

bool Pipeline::is_left(const rt::StageRunner& runner) const noexcept {
  return (leaves_estimate_ && &runner == &flow_->run_identification) ||
         (leaves_diagnosis_ && &runner == &flow_->run_closure) ||
         (leaves_comparison_ && &runner == &flow_->run_structure);
}

// A step that was begun before the stop is measured from the stop on.
void Pipeline::leave_the_late() noexcept {
  const std::int64_t stop_ns = stop_ns_.load(std::memory_order_relaxed);
  if (stop_ns == 0) return;
  const std::int64_t now_ns = rt::monotonic_ns();
  const auto is_late = [&](const rt::StageRunner& runner, std::int64_t patience_ns) {
    return std::min(runner.in_step_for_ns(now_ns), now_ns - stop_ns) > patience_ns;
  };
  const bool has_estimate = flow_->publish.n_estimates() > 0;
  if (!leaves_estimate_ && is_late(flow_->run_identification, has_estimate ? kPatience_ns : kPatienceFirst_ns)) {
    leaves_estimate_ = true;
    flow_->spectrum.stop_waiting();
    flow_->publish.go_on_without(PublishStage::kEstimate);
  }
  if (!leaves_diagnosis_ && is_late(flow_->run_closure, kPatience_ns)) {
    leaves_diagnosis_ = true;
    flow_->tracking.stop_waiting();
    flow_->publish.go_on_without(PublishStage::kDiagnosis);
  }
  // Without the estimate that is left, the comparison's input does not end.
  if (!leaves_comparison_ && (leaves_estimate_ || is_late(flow_->run_structure, kPatience_ns))) {
    leaves_comparison_ = true;
    flow_->publish.go_on_without(PublishStage::kComparison);
  }
}

bool Pipeline::running() noexcept {
  leave_the_late();
  const auto& runners = flow_->runners;
  for (std::size_t i = runners.size(); i-- > 0;) {
    if (!runners[i]->faulted()) continue;
    for (std::size_t upstream = 0; upstream < i; ++upstream) runners[upstream]->abort();  // their output has no reader
  }
  for (rt::StageRunner* runner : runners) {
    if (!runner->finished() && !is_left(*runner)) return true;
  }
  return false;
}

Pipeline::Outcome Pipeline::join() {
  Outcome outcome;
  for (rt::StageRunner* runner : flow_->runners) {
    if (is_left(*runner) && !runner->finished())
      outcome.leaves_threads = true;
    else
      runner->join();
  }
  flow_->source.camera->stop();
  for (const rt::StageRunner* runner : flow_->runners)
    outcome.stages_ended_ns = std::max(outcome.stages_ended_ns, runner->steps_ended_ns());
  outcome.estimate = flow_->publish.last_estimate();
  outcome.leaves_out = flow_->publish.left_out() != 0;
  outcome.health = flow_->status();
  outcome.fault = flow_->fault();
  if (outcome.fault.empty()) {
    outcome.health.state = "finished";
    if (flow_->keeps_state()) {  // the run is complete: the next one must not resume it
      for (const std::string& path : {state_path(flow_->config), keyframe_path(flow_->config)}) {
        if (std::remove(path.c_str()) != 0 && errno != ENOENT)
          outcome.notes.push_back(fmt::format("{}: cannot be removed: {}; remove it, or the next run resumes this one",
                                              path, std::strerror(errno)));
      }
    }
  }
  if (outcome.fault.empty() && !flow_->source.camera->fault().empty())
    outcome.notes.push_back(flow_->source.camera->fault());
  if (std::string note = short_record(flow_->config, flow_->source.info, outcome.estimate); !note.empty()) {
    outcome.notes.push_back(std::move(note));
  }
  if (std::string words = point_loss_words(flow_->source.tracker.losses(), flow_->source.tracker.n_points());
      !words.empty()) {
    outcome.notes.push_back(std::move(words));
  }
  for (std::string& words : motion_across_words(flow_->config.regions, flow_->meter.axes()))
    outcome.notes.push_back(std::move(words));
  if (outcome.fault.empty() && flow_->report) outcome.page = flow_->config.report.directory + "/" + kReportName;
  return outcome;
}

std::string Pipeline::stall() const { return flow_->health.stall(); }
std::vector<std::string> Pipeline::take_events() {
  std::vector<std::string> lines;
  for (rt::StageRunner* runner : flow_->runners) {
    rt::Stage& stage = runner->stage();
    (void)stage.events().drain([&](const rt::Event& event) { lines.push_back(event_line(stage.name(), event)); });
  }
  return lines;
}
core::Health Pipeline::health() const { return flow_->status(); }
const AppConfig& Pipeline::config() const noexcept { return flow_->config; }
const std::optional<core::structure::DeclaredFrame>& Pipeline::structure() const noexcept { return flow_->structure; }
const core::CameraInfo& Pipeline::camera_info() const noexcept { return flow_->source.info; }
const std::vector<core::ChannelInfo>& Pipeline::channels() const noexcept { return flow_->source.channels(); }
std::vector<std::string> Pipeline::warnings() const { return flow_->status().warnings; }

std::string check_source(const AppConfig& declared) {
  const AppConfig config = with_found_axes(declared);
  Source source(open_camera(config), config);
  return preflight_text(preflight(config, source));
}

}  // namespace app
