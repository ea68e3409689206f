#include "firmware_app/chain/rebuild.h"

#include <utility>

namespace app {

Rebuild::Rebuild(const Chain& chain, const CorrectionLog& book, std::vector<Stretch> stretches)
    : stretches_(std::move(stretches)),
      meter_(stretches_.front().geometry->displacement, stretches_.front().geometry->readout),
      sample_(stretches_.front().geometry->displacement.sample_prototype()),
      spectra_(chain.welch, chain.period_hops),
      modes_(chain.rate_hz, chain.make_identifier, book, chain.motors),
      snapshot_{spectra_.sums()} {
  begin(stretches_.front());
  spectra_.begin_as(stretches_.front().correction_set, stretches_.front().record);
}

void Rebuild::begin(const Stretch& stretch) noexcept {
  CorrectionSwitch now;
  now.geometry = stretch.geometry.get();
  now.correction_set = stretch.correction_set, now.record = stretch.record;
  meter_.take(now);
  (void)meter_.begin_frame(0);
  ++n_begun_;
}

void Rebuild::take(core::TrackFrame& frame, std::uint32_t stride) noexcept {
  while (n_begun_ < stretches_.size() && frame.sequence >= stretches_[n_begun_].from_sequence)
    begin(stretches_[n_begun_]);
  meter_.measure(frame, stride, sample_);
  for (bool is_done = false; !is_done; identify_when_due()) is_done = spectra_.step(sample_);
  taken_through_ = frame.sequence + 1;
}

void Rebuild::identify_when_due() noexcept {
  if (!spectra_.is_due()) return;
  spectra_.take_snapshot(snapshot_);
  try {
    modes_.identify(snapshot_, result_);
  } catch (...) {  // out of memory: the history of the modes lacks this estimate
  }
}

bool Rebuild::offer(bool has_all) noexcept {
  std::uint64_t state = state_.load(std::memory_order_acquire);
  if ((state & kOffered) != 0) return true;
  if (state == 0) return false;
  const std::uint64_t waits = waits_through_.load(std::memory_order_acquire);
  has_all = has_all || taken_through_ + 1 >= state || (waits > 0 && taken_through_ >= waits);
  // Release: tracking, spectrum and identification see everything that was computed.
  return has_all && state_.compare_exchange_strong(state, state | kOffered, std::memory_order_acq_rel);
}

void Rebuild::announce(std::uint64_t from_sequence) noexcept {
  std::uint64_t state = state_.load(std::memory_order_acquire);
  if ((state & kOffered) == 0)
    (void)state_.compare_exchange_strong(state, from_sequence + 1, std::memory_order_acq_rel);
}

bool Rebuild::begins_with(std::uint64_t sequence) const noexcept {
  const std::uint64_t state = state_.load(std::memory_order_acquire);
  return (state & kOffered) != 0 && sequence + 1 >= (state & ~kOffered);
}

bool Rebuild::is_due(std::uint64_t sequence) const noexcept {
  const std::uint64_t state = state_.load(std::memory_order_acquire);
  return state != 0 && sequence + 1 >= (state & ~kOffered);
}

}  // namespace app
