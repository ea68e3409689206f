#include "firmware_app/chain/diagnosis.h"

#include <exception>
#include <new>
#include <optional>
#include <string>
#include <utility>

namespace app {

Diagnosis::Diagnosis(MissingEffectSearchConfig config, CorrectionLog& book, MakeGeometry make,
                     std::unique_ptr<Past> past)
    : loop_(std::move(config)), book_(book), make_(std::move(make)), past_(std::move(past)) {}

void Diagnosis::take(const core::TrackFrame& frame, std::uint32_t stride) noexcept {
  loop_.take(frame);
  if (!past_) return;
  past_->tracks.add(frame, stride);
  if (rebuilt_.empty() || rebuilt_.back()->offered()) return;
  past_->frame = frame;
  rebuilt_.back()->take(past_->frame, stride);
  (void)rebuilt_.back()->offer();
}

core::closure::ClosureReport Diagnosis::report(bool final) {
  change_ = {};
  for (const std::unique_ptr<Rebuild>& rebuilt : rebuilt_) rebuilt->release();
  core::closure::ClosureReport report = loop_.report(final);
  amend(report);
  return report;
}

// A correction that cannot be made is reported and skipped; the previous correction stays in force.
void Diagnosis::amend(core::closure::ClosureReport& report) {
  if (const std::optional<CorrectionSet> correction_set = loop_.correction_set()) {
    const std::string refused = begin(*correction_set);
    if (!refused.empty()) {
      report.changes.push_back("none of this is done: " + refused);
    } else if (past_) {
      report.changes.push_back("the run is measured again, so from frame " +
                               std::to_string(stretches_.back().from_sequence) + " on");
    }
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
  std::unique_ptr<Geometry> geometry;
  try {
    geometry = make_(correction_set);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    return e.what();
  }
  const CorrectionSet& added = book_.add(correction_set);
  CorrectionSwitch change;
  change.geometry = geometry.get();
  if (past_) {
    rebuild(added, std::move(geometry));
    change.rebuilt = rebuilt_.back().get();
  } else {
    made_.push_back(std::move(geometry));
  }
  change.correction_set = added.number, change.record = added.record;
  change.from_sequence = added.from_sequence;
  change_ = change;
  return {};
}

// Earlier stretches keep their corrections, with a geometry that begins anew.
void Diagnosis::rebuild(const CorrectionSet& added, std::unique_ptr<Geometry> geometry) {
  std::erase_if(stretches_, [&](const Stretch& s) { return s.from_sequence >= added.since_sequence; });
  std::vector<Rebuild::Stretch> stretches;
  for (const Stretch& s : stretches_) {
    const CorrectionSet& earlier = book_.at(s.correction_set);
    stretches.push_back({s.from_sequence, s.correction_set, earlier.record, make_(earlier)});
  }
  stretches.push_back({added.since_sequence, added.number, added.record, std::move(geometry)});
  stretches_.push_back({added.since_sequence, added.number});
  rebuilt_.push_back(std::make_unique<Rebuild>(past_->chain, book_, std::move(stretches)));
  for (std::size_t i = 0; i < past_->tracks.n_frames(); ++i) {
    const std::uint32_t stride = past_->tracks.read(i, past_->frame);
    rebuilt_.back()->take(past_->frame, stride);
  }
}

CorrectionSwitch Diagnosis::change() const noexcept {
  CorrectionSwitch change = change_;
  change.next_report_at = loop_.next_report_at();
  change.n_delay_frames = loop_.n_delay_frames();
  return change;
}

}  // namespace app
