#pragma once

#include <vector>

#include "core/structure/declared_frame.h"
#include "core/types/loop_result.h"
#include "firmware_app/replay/analysis.h"

namespace app {

// The modes of a record before any correction and after the last, identified from the whole and from its halves, each
// paired with the reference mode that lies within a tenth of its frequency.
class LoopModes {
 public:
  LoopModes(std::vector<double> reference_hz, double max_frequency_hz);

  // Fills modes, errors and has_reference. Records whose halves are too short have no `halves_percent`.
  void compare(const ChannelSeries& before, const ChannelSeries& after, core::closure::LoopResult& out) const;
  // The modes after the last correction, numbered from the lowest, for a structural model.
  [[nodiscard]] static std::vector<core::structure::ReferenceMode> for_structure(
      const core::closure::LoopResult& result, const core::structure::DeclaredFrame& declared);

 private:
  using Estimate = core::closure::LoopMode::Estimate;
  [[nodiscard]] std::vector<Estimate> estimates(const ChannelSeries& series) const;
  [[nodiscard]] std::vector<core::Mode> modes_of(const ChannelSeries& series) const;

  std::vector<double> reference_hz_;
  double max_frequency_hz_ = 0.0;
};

}  // namespace app
