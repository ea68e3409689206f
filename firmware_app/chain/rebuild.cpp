#include "firmware_app/chain/rebuild.h"

#include <utility>

namespace app {

namespace {
constexpr double kLead_s = 4.0;  // of which the second half is compared
}

Rebuild::Rebuild(const Chain& chain, const CorrectionLog& book, std::vector<Stretch> stretches)
    : stretches_(std::move(stretches)),
      n_lead_frames_(static_cast<std::uint64_t>(kLead_s * chain.rate_hz)),
      meter_(stretches_.front().geometry->displacement, stretches_.front().geometry->readout),
      sample_(stretches_.front().geometry->displacement.sample_prototype()),
      next_sample_(sample_),
      offset_(sample_),
      next_offset_(sample_),
      spectra_(std::in_place, chain.welch, chain.period_hops),
      modes_(chain.rate_hz, chain.make_identifier, book, chain.motors) {
  meter_.set_offset(offset_);
  begin(stretches_.front());
  spectra_->begin_as(stretches_.front().correction_set, stretches_.front().record);
}

// Where row delays stay, the displacements go on from where they were, and no segment is masked.
void Rebuild::compare_with_next(const core::TrackFrame& frame, std::uint32_t stride) noexcept {
  const Stretch& next = stretches_[n_begun_];
  if (next.record != stretches_[n_begun_ - 1].record || frame.sequence + n_lead_frames_ < next.from_sequence) return;
  next_frame_ = frame;
  next.geometry->displacement.update(next_frame_, next_sample_);
  if (stride == 1) next.geometry->readout.update(next_frame_);
  if (frame.sequence + n_lead_frames_ / 2 >= next.from_sequence) next_offset_.add(sample_, next_sample_);
}

void Rebuild::begin(const Stretch& stretch) noexcept {
  CorrectionSwitch now;
  now.geometry = stretch.geometry.get();
  now.correction_set = stretch.correction_set, now.record = stretch.record;
  meter_.take(now);
  (void)meter_.begin_frame(0);
  if (next_offset_.is_known()) {
    spectra_->begin_as(stretch.correction_set, stretch.record);
  } else {
    next_offset_.clear();
  }
  meter_.set_offset(next_offset_);
  offset_ = next_offset_;
  next_offset_.clear();
  ++n_begun_;
}

void Rebuild::take(core::TrackFrame& frame, std::uint32_t stride) noexcept {
  while (n_begun_ < stretches_.size() && frame.sequence >= stretches_[n_begun_].from_sequence)
    begin(stretches_[n_begun_]);
  meter_.measure(frame, stride, sample_);
  if (n_begun_ < stretches_.size()) compare_with_next(frame, stride);
  for (bool is_done = false; !is_done; identify_when_due()) is_done = spectra_->step(sample_);
  taken_through_ = frame.sequence + 1;
}

void Rebuild::identify_when_due() noexcept {
  if (!spectra_->is_due()) return;
  const SnapshotHead head = spectra_->take_head();
  try {
    modes_.identify(head, spectra_->sums(), result_);
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

void Rebuild::release() noexcept {
  if (!spectra_ || !are_spectra_taken_.load(std::memory_order_acquire)) return;
  spectra_.reset();
  result_ = {};
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
