#include "firmware_app/chain/diagnosis.h"

#include <exception>
#include <new>
#include <optional>
#include <string>
#include <utility>

namespace app {

Diagnosis::Diagnosis(LoopCloserConfig config, AmendmentBook& book, MakeGeometry make)
    : loop_(std::move(config)), book_(book), make_(std::move(make)) {}

core::closure::ClosureReport Diagnosis::report(bool final) {
  change_ = {};
  core::closure::ClosureReport report = loop_.report(final);
  amend(report);
  return report;
}

// A correction that cannot be made is said and left: what came before it stays in force.
void Diagnosis::amend(core::closure::ClosureReport& report) {
  if (const std::optional<Amendment> amendment = loop_.amendment()) {
    const std::string refused = begin(*amendment);
    if (!refused.empty()) report.changes.push_back("none of this is done: " + refused);
  }
  report.in_force = book_.newest().words;
}

std::string Diagnosis::begin(const Amendment& amendment) {
  if (book_.full()) return "too many changes in one run";
  try {
    made_.push_back(make_(amendment));
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    return e.what();
  }
  const Amendment& added = book_.add(amendment);
  change_.geometry = made_.back().get();
  change_.amendment = added.number, change_.record = added.record;
  change_.from_sequence = added.from_sequence;
  return {};
}

ViewChange Diagnosis::change() const noexcept {
  ViewChange change = change_;
  change.next_report_at = loop_.next_report_at();
  change.n_delay_frames = loop_.n_delay_frames();
  return change;
}

}  // namespace app
