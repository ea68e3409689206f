#include "firmware_app/service/stages/publish_stage.h"

#include <exception>
#include <utility>

#include "rt/clock.h"

namespace app {

namespace {
constexpr std::int64_t kHealthPeriodNs = 1'000'000'000;

// A caveat of the report for each.
std::vector<std::string> late_words(std::uint32_t left_out) {
  std::vector<std::string> out;
  if ((left_out & PublishStage::kEstimate) != 0) {
    out.emplace_back(
        "the run was stopped during an estimate that did not end in time: the modes are those of the estimate before "
        "it; replay the run's record or tracks for the last one");
  }
  if ((left_out & PublishStage::kDiagnosis) != 0)
    out.emplace_back("the run was stopped during residual diagnosis, whose last report did not end in time");
  // Where the estimate is left, so is the comparison that waits for it.
  if ((left_out & PublishStage::kComparison) != 0 && (left_out & PublishStage::kEstimate) == 0)
    out.emplace_back("the run was stopped while the declared structure was compared; that report did not end in time");
  return out;
}

}  // namespace

PublishStage::PublishStage(Ends ends, Outlets outlets) : ends_(std::move(ends)), outlets_(std::move(outlets)) {}

rt::StepStatus PublishStage::step() noexcept {
  publish_health_when_due();
  if (const IdentificationResult* result = ends_.results.front()) {
    publish_result(*result);
    ends_.results.pop();
    return rt::StepStatus::kWorked;
  }
  if (const core::closure::ClosureReport* closure = ends_.closures ? ends_.closures->front() : nullptr) {
    publish_closure(*closure);
    ends_.closures->pop();
    return rt::StepStatus::kWorked;
  }
  if (const core::closure::ClosureReport* comparison = ends_.comparisons ? ends_.comparisons->front() : nullptr) {
    (void)outlets_.publisher.publish(*comparison);
    ends_.comparisons->pop();
    return rt::StepStatus::kWorked;
  }
  if (ends_.previews.refresh()) {
    (void)outlets_.publisher.publish(ends_.previews.front(), outlets_.regions);
    return rt::StepStatus::kWorked;
  }
  if (const FrameRecord* record = ends_.records.front()) {
    publish_record(*record);
    ends_.records.pop();
    rt::StageStats::add(stats().n_in);
    return rt::StepStatus::kWorked;
  }
  const std::uint32_t late = late_.load(std::memory_order_relaxed);
  const bool is_over = ends_.records.finished() && (missing(kEstimate | kDiagnosis | kComparison) & ~late) == 0;
  return is_over ? rt::StepStatus::kFinished : rt::StepStatus::kIdle;
}

std::uint32_t PublishStage::missing(std::uint32_t late) noexcept {
  if (ends_.results.finished()) late &= ~std::uint32_t{kEstimate};
  if (!ends_.closures || ends_.closures->finished()) late &= ~std::uint32_t{kDiagnosis};
  if (!ends_.comparisons || ends_.comparisons->finished()) late &= ~std::uint32_t{kComparison};
  return late;
}

void PublishStage::publish_record(const FrameRecord& record) noexcept {
  const auto due = [this](int every) { return every > 0 && n_records_ % static_cast<std::uint64_t>(every) == 0; };
  if (due(outlets_.telemetry.displacement_every)) (void)outlets_.publisher.publish(record.sample, outlets_.channels);
  if (due(outlets_.telemetry.tracks_every)) (void)outlets_.publisher.publish(record.tracks);
  if (outlets_.recorder != nullptr && record.aircraft.n > 0) (void)outlets_.recorder->add(record.aircraft);
  if (outlets_.recorder != nullptr) (void)outlets_.recorder->add(record.tracks, record.attitude, record.sample.stride);
  if (outlets_.report != nullptr) {
    // The report counts a file that failed, and its finish() reports it.
    (void)outlets_.report->add(record.tracks);
    (void)outlets_.report->add(record.sample);
  }
  ++n_records_;
}

void PublishStage::publish_result(const IdentificationResult& result) noexcept {
  (void)outlets_.publisher.publish(result.estimate, outlets_.channels);
  (void)outlets_.publisher.publish(result.sums, outlets_.channels);
  try {
    if (outlets_.report != nullptr) outlets_.report->add(result.estimate, result.aircraft);
    last_estimate_ = result.estimate;
    last_sums_ = result.sums;
  } catch (...) {
    fault_ = "out of memory for an estimate";
  }
  n_estimates_.store(n_estimates_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  rt::StageStats::add(stats().n_out);
}

void PublishStage::publish_closure(const core::closure::ClosureReport& report) noexcept {
  (void)outlets_.publisher.publish(report);
  try {
    last_closure_ = report;
  } catch (...) {
    fault_ = "out of memory for a report of closing the loop";
  }
}

// By the wall clock, because it serves a human observer; it enters no result.
void PublishStage::publish_health_when_due() noexcept {
  const std::int64_t now_ns = rt::monotonic_ns();
  if (now_ns < next_health_ns_) return;
  next_health_ns_ = now_ns + kHealthPeriodNs;
  try {
    (void)outlets_.publisher.publish(outlets_.health());
  } catch (...) {  // out of memory: the next status follows in a second
  }
}

void PublishStage::complete_report(const core::Health& health) {
  std::vector<std::string> caveats = outlets_.caveats;
  if (outlets_.findings) {
    for (std::string& words : outlets_.findings()) caveats.push_back(std::move(words));
  }
  for (std::string& words : late_words(left_out_)) caveats.push_back(std::move(words));
  if (outlets_.report == nullptr) return;
  outlets_.report->finish(last_estimate_, health, outlets_.corrections, caveats, closure(),
                          [&](const std::string& folder) {
                            if (outlets_.draw) outlets_.draw({last_estimate_, last_sums_, closure()}, health, folder);
                          });
}

void PublishStage::finish() noexcept {
  left_out_ = missing(late_.load(std::memory_order_relaxed));
  try {
    core::Health health = outlets_.health();
    if (outlets_.recorder != nullptr && health.times.known()) (void)outlets_.recorder->end(health.times);
    try {
      complete_report(health);
    } catch (const std::exception& e) {
      fault_ = e.what();
      health.state = "fault: " + fault_;
    }
    if (health.state.rfind("fault", 0) != 0) health.state = "finished";
    (void)outlets_.publisher.publish(health);
    if (outlets_.recorder != nullptr) (void)outlets_.recorder->close();  // health reports a failure
  } catch (const std::exception& e) {
    fault_ = e.what();
  }
}

}  // namespace app
