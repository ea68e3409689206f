#pragma once

#include <vector>

#include "core/types/cpsd.h"
#include "core/types/displacement.h"

namespace core {

// Sums of the motion relative to the base, in which the camera's translation, yaw and pitch cancel: every channel along
// the base's axis less the base's motion at the instant at which the channel's row is read,
//     y_i(f) - exp(i w (tau_i - tau_b)) y_b(f).
// Other channels stay as they are. Where channels lack different samples, a spectrum of two of them is scaled to the
// share that both have. base: its index.
[[nodiscard]] CpsdSums relative_to_base(const CpsdSums& sums, const std::vector<ChannelInfo>& channels, int base);

// Whether what moves the camera moves the structure, too, at an apparent frequency: a gust that both feel. Then the
// motion relative to the base is coherent with that of a region at rest, beyond what chance does once in a thousand,
// and is not small beside the camera's own; the region's motion stands out of its noise, which lost frames make
// coherent with everything. Given the region at rest as an input, such a mode is explained away.
class SharedMotion {
 public:
  // relative: of relative_to_base(sums, channels, base). Borrows its arguments.
  SharedMotion(const CpsdSums& sums, const CpsdSums& relative, const std::vector<ChannelInfo>& channels, int base);

  [[nodiscard]] bool at(double apparent_hz) const;
  [[nodiscard]] bool anywhere() const;

 private:
  [[nodiscard]] bool in_bin(int bin) const;

  const CpsdSums &sums_, &relative_;
  const std::vector<ChannelInfo>& channels_;
  int base_;
  double least_coherence_;
  std::vector<double> noise_;  // power of a bin, per channel; 0: no witness
};

}  // namespace core
