#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/types/displacement.h"
#include "core/types/track.h"
#include "firmware_app/chain/correction_set.h"
#include "firmware_app/chain/displacement_meter.h"
#include "firmware_app/chain/items.h"
#include "firmware_app/chain/mode_identification.h"
#include "firmware_app/chain/sample_offset.h"
#include "firmware_app/chain/spectrum_accumulator.h"

namespace app {

// A run measured again under a correction, from its first frame on: geometry, spectra and modes as they would be had
// the correction been declared. It catches up with the run in the diagnosis' thread while the run goes on as it was; at
// an announced frame the run takes all of it over.
//
// Which frame: tracking announces it (the diagnosis' one, or a later one where a live source has passed that); the
// diagnosis takes every frame before it and then offers itself; tracking begins with it at that frame or, where a live
// source finds no offer, announces a later one. A lossless source waits for the offer. After the offer the diagnosis
// does not touch it any more.
class Rebuild {
 public:
  struct Chain {
    core::WelchConfig welch;
    int period_hops = 1;
    double rate_hz = 0.0;
    ModeIdentification::MakeIdentifier make_identifier;
    core::MotorLines motors = {};
  };
  // Frames from one on that are measured under one correction set.
  struct Stretch {
    std::uint64_t from_sequence = 0;
    std::uint32_t correction_set = 0, record = 0;
    std::unique_ptr<Geometry> geometry;
  };
  // stretches: one or more, in time; the run goes on with the last. The log outlives this.
  Rebuild(const Chain& chain, const CorrectionLog& book, std::vector<Stretch> stretches);

  // The diagnosis' thread: the next frame of the run, on the lattice. Computes an estimate where one is due.
  void take(core::TrackFrame& frame, std::uint32_t stride) noexcept;
  // The diagnosis' thread: offers it where every frame before the announced one is taken, because that frame comes
  // next, tracking waits, or the caller knows that no other comes before it (has_all). False: not yet.
  bool offer(bool has_all = false) noexcept;
  [[nodiscard]] bool offered() const noexcept { return (state_.load(std::memory_order_acquire) & kOffered) != 0; }

  // Tracking, before it measures frame `sequence`. False: not from this frame on.
  [[nodiscard]] bool begins_with(std::uint64_t sequence) const noexcept;
  void announce(std::uint64_t from_sequence) noexcept;
  [[nodiscard]] bool is_due(std::uint64_t sequence) const noexcept;  // the announced frame has come
  void wait_for(std::uint64_t shown_through) noexcept {  // the number after the last frame that the diagnosis will get
    waits_through_.store(shown_through, std::memory_order_release);
  }

  // After the offer: each is taken over by the one thread that uses its counterpart.
  [[nodiscard]] SampleOffset& offset() noexcept { return offset_; }
  [[nodiscard]] SpectrumAccumulator& spectra() noexcept { return *spectra_; }
  [[nodiscard]] ModeIdentification& modes() noexcept { return modes_; }
  // The thread that took them over does not use the spectra any more.
  void note_spectra_taken() noexcept {
    are_spectra_taken_.store(true, std::memory_order_release);
  }  // partner: release()
  // The diagnosis' thread: frees what was exchanged for the spectra, once it is known to be unused.
  void release() noexcept;

 private:
  void begin(const Stretch& stretch) noexcept;
  void compare_with_next(const core::TrackFrame& frame, std::uint32_t stride) noexcept;
  void identify_when_due() noexcept;

  // Frame number + 1; 0: none announced. The highest bit: offered.
  static constexpr std::uint64_t kOffered = std::uint64_t{1} << 63U;

  std::vector<Stretch> stretches_;
  std::size_t n_begun_ = 0;
  std::uint64_t n_lead_frames_;  // before a stretch, measured under both corrections
  DisplacementMeter meter_;
  core::DisplacementSample sample_, next_sample_;
  core::TrackFrame next_frame_;
  SampleOffset offset_, next_offset_;
  std::optional<SpectrumAccumulator> spectra_;  // empty once taken over and released
  ModeIdentification modes_;
  IdentificationResult result_;
  std::uint64_t taken_through_ = 0;  // the number after the last frame taken
  std::atomic<std::uint64_t> state_{0}, waits_through_{0};
  std::atomic<bool> are_spectra_taken_{false};
};

}  // namespace app
