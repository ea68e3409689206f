#pragma once

#include <string>
#include <vector>

#include "core/types/loop_result.h"
#include "core/types/modal_estimate.h"
#include "firmware_app/replay/analysis.h"

namespace app {

// The modes of a record before any correction and after the last, identified from the whole and from its halves, each
// paired with the reference mode that lies within a tenth of its frequency.
class LoopModes {
 public:
  LoopModes(std::vector<double> reference_hz, double max_frequency_hz);

  // Fills modes, errors and has_reference. Records whose halves are too short have no `halves_percent`. Returns the
  // estimate after the last correction, without modes where the record is too short, and its channels' names.
  struct Corrected {
    core::ModalEstimate estimate;
    std::vector<std::string> channel_names;
  };
  Corrected compare(const ChannelSeries& before, const ChannelSeries& after, core::closure::LoopResult& out) const;

 private:
  using Estimate = core::closure::LoopMode::Estimate;
  [[nodiscard]] SeriesResult identified(const ChannelSeries& series) const;
  [[nodiscard]] std::vector<Estimate> estimates(const ChannelSeries& series, const core::ModalEstimate& of_whole) const;

  std::vector<double> reference_hz_;
  double max_frequency_hz_ = 0.0;
};

}  // namespace app
