#include "firmware_app/stages/closure_stage.h"

#include <exception>
#include <utility>

namespace app {

ClosureStage::ClosureStage(rt::RingReader<core::TrackFrame> tracks, LoopCloserConfig config,
                           rt::RingWriter<core::closure::ClosureReport> reports)
    : tracks_(std::move(tracks)), loop_(std::move(config)), reports_(std::move(reports)) {}

void ClosureStage::amend(AmendmentBook& book, MakeGeometry make, rt::RingWriter<ViewChange> changes) {
  book_ = &book;
  make_ = std::move(make);
  changes_.emplace(std::move(changes));
}

ViewChange ClosureStage::first_view() const noexcept {
  ViewChange view;
  view.next_report_at = loop_.next_report_at(), view.n_delay_frames = loop_.n_delay_frames();
  return view;
}

rt::StepStatus ClosureStage::step() noexcept {
  if (loop_.is_due()) return report(false);
  if (const core::TrackFrame* frame = tracks_.front()) {
    loop_.take(*frame);
    tracks_.pop();
    rt::StageStats::add(stats().n_in);
    return rt::StepStatus::kWorked;
  }
  if (!tracks_.finished()) return rt::StepStatus::kIdle;
  return loop_.is_left() ? report(true) : rt::StepStatus::kFinished;
}

rt::StepStatus ClosureStage::report(bool final) noexcept {
  core::closure::ClosureReport* slot = reports_.try_claim();
  if (slot == nullptr || (changes_ && changes_->try_claim() == nullptr)) return rt::StepStatus::kIdle;
  change_ = {};
  bool is_made = false;
  try {
    *slot = loop_.report(final);
    if (changes_) amend(*slot);
    is_made = true;
  } catch (const std::exception&) {  // out of memory: this one is lost and counted, the next may succeed
    rt::StageStats::add(stats().n_dropped);
  }
  if (changes_) tell_tracking();
  if (!is_made) return rt::StepStatus::kWorked;
  reports_.publish();
  rt::StageStats::add(stats().n_out);
  return rt::StepStatus::kWorked;
}

void ClosureStage::amend(core::closure::ClosureReport& report) {
  const std::optional<Amendment> amendment = loop_.amendment();
  if (!amendment) return;
  if (book_->full()) {
    report.changes.emplace_back("none of this is done: too many changes in one run");
    return;
  }
  made_.push_back(make_(*amendment));
  const Amendment& added = book_->add(*amendment);
  change_.amendment = added.number, change_.record = added.record;
  change_.from_sequence = amendment->from_sequence;
  change_.geometry = made_.back().get();
}

void ClosureStage::tell_tracking() noexcept {
  change_.next_report_at = loop_.next_report_at();
  change_.n_delay_frames = loop_.n_delay_frames();
  *changes_->try_claim() = change_;
  changes_->publish();
}

void ClosureStage::finish() noexcept {
  reports_.close();
  if (changes_) changes_->close();
}

}  // namespace app
