#pragma once

#include <functional>
#include <memory>
#include <span>
#include <utility>

#include "core/identification/mode_tracker.h"
#include "firmware_app/amendment.h"
#include "firmware_app/readout_use.h"
#include "firmware_app/stages/items.h"
#include "rt/spsc_ring.h"
#include "rt/stage.h"
#include "rt/triple_buffer.h"

namespace app {

// newest spectrum -> modes, each followed from one estimate to the next. Runs at ordinary priority and may take its
// time: nothing upstream waits for it but a lossless source.
class IdentificationStage : public rt::Stage {
 public:
  // make_identifier: for samples of another rate than the camera's, or under an amendment; may throw.
  using MakeIdentifier = std::function<std::unique_ptr<const ReadoutUse>(double rate_hz, const Amendment& amendment)>;

  IdentificationStage(rt::TripleBuffer<SpectrumSnapshot>& snapshots, double rate_hz, MakeIdentifier make_identifier,
                      const AmendmentBook& book, rt::RingWriter<IdentificationResult> results)
      : snapshots_(snapshots),
        make_identifier_(std::move(make_identifier)),
        book_(book),
        rate_hz_(rate_hz),
        identifier_(make_identifier_(rate_hz, book.at(0))),
        tracker_({.row_delay_s = identifier_->declared_delay_s()}),
        results_(std::move(results)) {}

  // Set-up only: the modes followed are handed over after every estimate, for a later run's resume().
  void keep_state(rt::TripleBuffer<StateBytes>& states) noexcept { states_ = &states; }
  [[nodiscard]] std::size_t state_bytes() const noexcept { return tracker_.state_bytes(); }
  // Set-up only. False: the bytes do not fit, and no mode is followed.
  [[nodiscard]] bool resume(std::span<const std::uint8_t> bytes) noexcept;

  [[nodiscard]] std::string_view name() const noexcept override { return "identification"; }
  [[nodiscard]] rt::StepStatus step() noexcept override;
  void finish() noexcept override { results_.close(); }

 private:
  void hand_over_state() noexcept;
  void follow(const SpectrumSnapshot& snapshot);
  [[nodiscard]] bool identify(const SpectrumSnapshot& snapshot, IdentificationResult& out) noexcept;

  rt::TripleBuffer<SpectrumSnapshot>& snapshots_;
  MakeIdentifier make_identifier_;
  const AmendmentBook& book_;
  double rate_hz_;
  std::uint32_t amendment_ = 0, record_ = 0;
  std::unique_ptr<const ReadoutUse> identifier_;
  core::ModeTracker tracker_;
  rt::RingWriter<IdentificationResult> results_;
  rt::TripleBuffer<StateBytes>* states_ = nullptr;  // null: no state is kept
  std::uint64_t n_estimates_ = 0;
};

}  // namespace app
