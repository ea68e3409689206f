#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/types/closure_report.h"
#include "core/types/track.h"
#include "firmware_app/chain/correction_set.h"
#include "firmware_app/chain/items.h"
#include "firmware_app/chain/missing_effect_search.h"
#include "firmware_app/chain/rebuild.h"
#include "firmware_app/chain/track_store.h"

namespace app {

// Newest points -> reports of what the model fails to explain and, with closure.adopt: auto, corrected geometries with
// the frame from which each applies. These geometries live as long as this object.
class Diagnosis {
 public:
  using MakeGeometry = std::function<std::unique_ptr<Geometry>(const CorrectionSet&)>;

  // What a run is measured again from, once a correction is adopted.
  struct Past {
    Rebuild::Chain chain;
    TrackStore tracks;
    core::TrackFrame frame;  // sized as the keyframe
  };

  // make may throw: then nothing changes, and the report states why. past: null: a correction applies to the frames
  // that come, and new sums begin where it changes the row delays.
  Diagnosis(MissingEffectSearchConfig config, CorrectionLog& book, MakeGeometry make,
            std::unique_ptr<Past> past = nullptr);

  void take(const core::TrackFrame& frame, std::uint32_t stride) noexcept;
  // A run that goes on with the sums of an earlier one cannot be measured again: these would be lost.
  void forget_past() noexcept { past_.reset(); }
  // Whether a run measured again has had all frames before the one at which it is to be taken over.
  void offer() noexcept {
    if (!rebuilt_.empty()) (void)rebuilt_.back()->offer();
  }
  [[nodiscard]] bool is_due() const noexcept { return loop_.is_due(); }
  // At the end of the run: whether enough frames have come since the last report for another one.
  [[nodiscard]] bool is_left() const noexcept { return loop_.is_left(); }
  // Takes seconds. Throws std::bad_alloc: this report is lost, the next may succeed.
  [[nodiscard]] core::closure::ClosureReport report(bool final);

  // The change decided by the last report, even a lost one. Before the first report: when it is due.
  [[nodiscard]] CorrectionSwitch change() const noexcept;

 private:
  void amend(core::closure::ClosureReport& report);
  void rebuild(const CorrectionSet& added, std::unique_ptr<Geometry> geometry);
  [[nodiscard]] bool begins_after(std::uint32_t number, std::uint64_t last_sequence) const;
  [[nodiscard]] std::string begin(const CorrectionSet& correction_set);  // why it cannot begin; empty: it will

  MissingEffectSearch loop_;
  CorrectionLog& book_;
  MakeGeometry make_;
  CorrectionSwitch change_;
  std::vector<std::unique_ptr<Geometry>> made_;  // frames are measured by the last or the last but one
  struct Stretch {
    std::uint64_t from_sequence = 0;
    std::uint32_t correction_set = 0;
  };
  std::vector<Stretch> stretches_{{}};  // of the run measured again
  std::unique_ptr<Past> past_;
  std::vector<std::unique_ptr<Rebuild>> rebuilt_;  // the last is the one under way
};

}  // namespace app
