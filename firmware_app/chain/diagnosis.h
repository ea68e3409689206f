#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/types/closure_report.h"
#include "core/types/track.h"
#include "firmware_app/chain/correction_set.h"
#include "firmware_app/chain/items.h"
#include "firmware_app/chain/missing_effect_search.h"

namespace app {

// Newest points -> reports of what the model fails to explain and, with closure.adopt: auto, corrected geometries with
// the frame from which each applies. These geometries live as long as this object.
class Diagnosis {
 public:
  using MakeGeometry = std::function<std::unique_ptr<Geometry>(const CorrectionSet&)>;

  // make may throw: then nothing changes, and the report states why.
  Diagnosis(MissingEffectSearchConfig config, CorrectionLog& book, MakeGeometry make);

  void take(const core::TrackFrame& frame) noexcept { loop_.take(frame); }  // allocates nothing
  [[nodiscard]] bool is_due() const noexcept { return loop_.is_due(); }
  // At the end of the run: whether enough frames have come since the last report for another one.
  [[nodiscard]] bool is_left() const noexcept { return loop_.is_left(); }
  // Takes seconds. Throws std::bad_alloc: this report is lost, the next may succeed.
  [[nodiscard]] core::closure::ClosureReport report(bool final);

  // The change decided by the last report, even a lost one. Before the first report: when it is due.
  [[nodiscard]] CorrectionSwitch change() const noexcept;

 private:
  void amend(core::closure::ClosureReport& report);
  [[nodiscard]] bool begins_after(std::uint32_t number, std::uint64_t last_sequence) const;
  [[nodiscard]] std::string begin(const CorrectionSet& correction_set);  // why it cannot begin; empty: it will

  MissingEffectSearch loop_;
  CorrectionLog& book_;
  MakeGeometry make_;
  CorrectionSwitch change_;
  std::vector<std::unique_ptr<Geometry>> made_;  // frames are measured by the last or the last but one
};

}  // namespace app
