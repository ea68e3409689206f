#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "core/identification/mode_tracker.h"
#include "core/rotors/motor_lines.h"
#include "firmware_app/chain/correction_set.h"
#include "firmware_app/chain/items.h"
#include "firmware_app/chain/readout_aware_identifier.h"

namespace app {

// Snapshots of the sums, in order -> modes, each followed from one estimate to the next. Run time is not bounded; it
// allocates.
class ModeIdentification {
 public:
  // Makes an identifier for another sample rate than the camera's, or for a correction; may throw.
  using MakeIdentifier =
      std::function<std::unique_ptr<const ReadoutAwareIdentifier>(double rate_hz, const CorrectionSet& correction_set)>;

  // motors: those known before; what the aircraft states during the run takes their place.
  ModeIdentification(double rate_hz, MakeIdentifier make_identifier, const CorrectionLog& book,
                     core::MotorLines motors);

  // Throws std::bad_alloc: this estimate is lost, the next may succeed.
  void identify(const SnapshotHead& snapshot, const core::CpsdSums& sums, IdentificationResult& out);
  void identify(const SpectrumSnapshot& snapshot, IdentificationResult& out) { identify(snapshot, snapshot.sums, out); }

  // Saves the modes being followed, for a later run's resume(). False: they do not fit.
  [[nodiscard]] bool save(StateBytes& out) const noexcept;
  [[nodiscard]] std::size_t state_bytes() const noexcept { return tracker_.state_bytes(); }
  // Call before the first snapshot. False: the bytes do not fit, and no mode is followed.
  [[nodiscard]] bool resume(std::span<const std::uint8_t> bytes) noexcept;
  // Goes on as `rebuilt`, which is left as this one was.
  void take_over(ModeIdentification& rebuilt) noexcept;
  // Takes over the modes and the count of estimates from another object, which loses them.
  void go_on_from(ModeIdentification& earlier) noexcept;

  [[nodiscard]] const ReadoutAwareIdentifier& identifier() const noexcept {
    return *identifier_;
  }  // of the newest snapshot

 private:
  void follow(const SnapshotHead& snapshot, double rate_hz);

  MakeIdentifier make_identifier_;
  const CorrectionLog& book_;
  core::MotorLines motors_;
  double rate_hz_;
  std::uint32_t correction_set_ = 0, record_ = 0;
  std::unique_ptr<const ReadoutAwareIdentifier> identifier_;
  core::ModeTracker tracker_;
  std::uint64_t n_estimates_ = 0;
  const ModeIdentification* taken_over_ = nullptr;
};

}  // namespace app
