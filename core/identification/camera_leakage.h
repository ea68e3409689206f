#pragma once

#include <complex>
#include <vector>

#include "core/types/cpsd.h"
#include "core/types/displacement.h"

namespace core {

// Removes camera motion from mode shapes. Static reference regions (witnesses) are ordinary outputs of the
// identification. They do not take part in a structure's modes: where they move in a shape, camera translation has
// leaked into it, by the same amount in all channels of that direction,
//     phi_i -= g q(f) exp(i w (tau_i - tau_w)) phi_w.
// g: ratio of the channels' motion to the static region's (of their distances), estimated from the bins where both are
// coherent. q = 1 - N / S_ww(f): share of the static region's spectrum that is not tracking noise N (white, estimated
// from its quiet bins) [Wiener]. Needs neither depth nor focal length, and adds no noise to the spectra. If the removed
// part is noticeable and a substantial part of the shape remains, the static region itself moves: the shape is kept.
class CameraLeakage {
 public:
  // channels: those of the sums; witnesses, if any, last.
  CameraLeakage(const CpsdSums& sums, const std::vector<ChannelInfo>& channels);

  struct Finding {
    double share = 0.0;  // camera motion's share of the shape's square, 0 ... 1
    bool is_doubtful =
        false;  // the removed part is noticeable, yet the remainder is not small: the witness moves with the structure
  };
  // shape: as observed, of all channels, at that apparent frequency.
  [[nodiscard]] Finding examine(const std::vector<std::complex<double>>& shape, double apparent_hz) const;
  // The outputs' part of the shape after removal. Linear in the shape; `leave` skips the removal.
  [[nodiscard]] std::vector<std::complex<double>> without(const std::vector<std::complex<double>>& shape,
                                                          double apparent_hz, bool leave) const;

 private:
  struct Output {
    int witness = -1;  // index into witnesses_; -1: no witness measures its direction
    double sign = 1.0, delay_s = 0.0;
  };
  struct Witness {
    std::size_t channel = 0;
    double delay_s = 0.0, gain = 0.0;
    std::vector<double> certainty;  // q per bin
  };

  struct Spectra {
    std::vector<double> own, mean, in_phase, out_of_phase;  // S_ww, S_mm, Re and Im S_mw per bin
  };

  void list(const std::vector<ChannelInfo>& channels);
  [[nodiscard]] Spectra spectra_of(const CpsdSums& sums, int w) const;
  void measure(const CpsdSums& sums, int w);
  [[nodiscard]] std::complex<double> part(std::size_t output, const std::vector<std::complex<double>>& shape,
                                          double apparent_hz) const;

  std::vector<Output> outputs_;
  std::vector<Witness> witnesses_;
  double hz_per_bin_ = 0.0;
};

}  // namespace core
