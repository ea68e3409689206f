#include "firmware_app/chain/mode_identification.h"

#include <utility>
#include <vector>

namespace app {

ModeIdentification::ModeIdentification(double rate_hz, MakeIdentifier make_identifier, const CorrectionLog& book,
                                       core::MotorLines motors)
    : make_identifier_(std::move(make_identifier)),
      book_(book),
      motors_(std::move(motors)),
      rate_hz_(rate_hz),
      identifier_(make_identifier_(rate_hz, book.at(0))),
      tracker_({.row_delay_s = identifier_->declared_delay_s()}) {}

void ModeIdentification::identify(const SnapshotHead& snapshot, const core::CpsdSums& sums, IdentificationResult& out) {
  follow(snapshot, sums.rate_hz);
  out.estimate = identifier_->identify(sums, snapshot.readout);
  const std::vector<double> delay_s = identifier_->delay_s(out.estimate);
  out.aircraft = snapshot.aircraft.summary();
  const core::MotorLines heard(out.aircraft.motors);
  (heard.empty() ? motors_ : heard).judge(out.estimate, delay_s);
  out.estimate.amendments = book_.at(correction_set_).words;
  tracker_.set_row_delays(delay_s);
  out.sums.copy_totals(sums, identifier_->n_outputs());
  out.estimate.number = n_estimates_++;
  out.estimate.t_stream_ns = snapshot.t_last_ns;
  out.estimate.final = snapshot.final;
  tracker_.update(out.estimate);
}

// At another rate a mode has another apparent frequency. A new epoch shares no data with the old one.
void ModeIdentification::follow(const SnapshotHead& snapshot, double rate_hz) {
  if (snapshot.rebuilt != nullptr && snapshot.rebuilt != taken_over_) take_over(*snapshot.rebuilt);
  const bool begins = rate_hz != rate_hz_ || snapshot.record != record_;
  if (!begins && snapshot.correction_set == correction_set_) return;
  identifier_ = make_identifier_(rate_hz, book_.at(snapshot.correction_set));
  rate_hz_ = rate_hz;
  correction_set_ = snapshot.correction_set, record_ = snapshot.record;
  if (begins) tracker_.restart();
}

bool ModeIdentification::save(StateBytes& state) const noexcept {
  core::StateWriter out(state.bytes);
  tracker_.save(out);
  state.n_used = out.n_used();
  return out.ok();
}

bool ModeIdentification::resume(std::span<const std::uint8_t> bytes) noexcept {
  core::StateReader in(bytes);
  return tracker_.restore(in);
}

void ModeIdentification::take_over(ModeIdentification& rebuilt) noexcept {
  std::swap(rate_hz_, rebuilt.rate_hz_);
  std::swap(correction_set_, rebuilt.correction_set_);
  std::swap(record_, rebuilt.record_);
  std::swap(identifier_, rebuilt.identifier_);
  std::swap(tracker_, rebuilt.tracker_);
  std::swap(n_estimates_, rebuilt.n_estimates_);
  taken_over_ = &rebuilt;
}

void ModeIdentification::go_on_from(ModeIdentification& earlier) noexcept {
  std::swap(tracker_, earlier.tracker_);
  n_estimates_ = earlier.n_estimates_;
}

}  // namespace app
