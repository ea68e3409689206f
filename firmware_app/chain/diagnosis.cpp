#include "firmware_app/chain/diagnosis.h"

#include <exception>
#include <new>
#include <optional>
#include <string>
#include <utility>

namespace app {

Diagnosis::Diagnosis(MissingEffectSearchConfig config, CorrectionLog& book, MakeGeometry make)
    : loop_(std::move(config)), book_(book), make_(std::move(make)) {}

core::closure::ClosureReport Diagnosis::report(bool final) {
  change_ = {};
  core::closure::ClosureReport report = loop_.report(final);
  amend(report);
  return report;
}

// A correction that cannot be made is reported and skipped; the previous correction stays in force.
void Diagnosis::amend(core::closure::ClosureReport& report) {
  if (const std::optional<CorrectionSet> correction_set = loop_.correction_set()) {
    const std::string refused = begin(*correction_set);
    if (!refused.empty()) report.changes.push_back("none of this is done: " + refused);
  }
  report.in_force = book_.newest().words;
  // At the end of the run: corrections that were due to begin later never did.
  for (std::uint32_t i = book_.newest().number; report.final && i > 0 && begins_after(i, report.last_sequence); --i)
    report.in_force = book_.at(i - 1).words;
}

bool Diagnosis::begins_after(std::uint32_t number, std::uint64_t last_sequence) const {
  return book_.at(number).from_sequence > last_sequence;
}

std::string Diagnosis::begin(const CorrectionSet& correction_set) {
  if (book_.full()) return "too many changes in one run";
  try {
    made_.push_back(make_(correction_set));
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    return e.what();
  }
  const CorrectionSet& added = book_.add(correction_set);
  change_.geometry = made_.back().get();
  change_.correction_set = added.number, change_.record = added.record;
  change_.from_sequence = added.from_sequence;
  return {};
}

CorrectionSwitch Diagnosis::change() const noexcept {
  CorrectionSwitch change = change_;
  change.next_report_at = loop_.next_report_at();
  change.n_delay_frames = loop_.n_delay_frames();
  return change;
}

}  // namespace app
