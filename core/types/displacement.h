#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/types/readout.h"

namespace core {

// A channel is one region along one axis. These properties are fixed over the run.
struct ChannelInfo {
  std::uint16_t region = 0;
  std::string name;          // region name; "<region>.u" / "<region>.v" for a region with both axes
  double direction_u = 1.0;  // unit vector of the axis in the image
  double direction_v = 0.0;
  double row_delay_s = 0.0;  // tau: the channel is seen this long after the frame's time stamp (geometry/METHOD.md)
  bool is_base = false;      // region role `base`: measured input, kept as an output
  bool is_witness = false;   // a static reference region, used to remove camera motion from the others
  int n_integrations = 0;    // to convert its samples to displacements: 0 displacement, 1 velocity, 2 acceleration
};

// One sample of every channel, relative to the keyframe.
struct DisplacementSample {
  std::uint64_t sequence = 0;
  std::int64_t t_start_ns = 0;
  bool gap_before = false;
  double scale_mm_per_px = 0.0;         // per-frame scale (paper Eq. 6)
  std::vector<double> value_mm;         // n_channels; 0 where not seen
  std::vector<double> sigma_mm;         // n_channels
  std::vector<std::uint8_t> seen;       // n_channels; 1 = a sample
  std::vector<std::uint16_t> n_points;  // n_channels; inlier points of the sample
  // Static reference regions (witnesses), after the channels (ChannelDisplacement::spectra()); not displacements.
  std::vector<double> witness_mm{};
  std::vector<std::uint8_t> witness_seen{};
  ReadoutEstimate readout{};  // from the tracks up to this frame
  // Id of the correction set in force (0 = none in addition to the declared values): displacements jump where it
  // changes. `record`: the epoch; a new one also changes the channels' row delays.
  std::uint32_t correction_set = 0, record = 0;
  std::uint32_t stride = 1;  // one of so many frames of the source is kept: more than 1 under overload
};

}  // namespace core
