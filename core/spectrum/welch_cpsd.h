#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "core/spectrum/innovation_gate.h"
#include "core/spectrum/outlier_gate.h"
#include "core/spectrum/real_fft.h"
#include "core/spectrum/window.h"
#include "core/types/cpsd.h"
#include "core/types/displacement.h"
#include "core/types/state_bytes.h"

namespace core {

struct WelchConfig {
  int n_channels = 1;
  int n_witnesses = 0;   // the last of the channels; their losses are not counted
  int segment = 512;     // samples
  double overlap = 0.5;  // 0 <= overlap < 1
  WindowKind window = WindowKind::kHann;
  double rate_hz = 1.0;
  // Blocks of the record kept for variance estimates. When all are full, neighbours are merged, so that between half
  // and all are in use. With forgetting this holds until all blocks together span two forget_s; then the two oldest are
  // merged. Even; 0 = none.
  int n_blocks = 20;
  // A segment is weighted by exp(-age / forget_s), for a structure that changes. 0 = all segments have equal weight.
  double forget_s = 0.0;
  // Newest segments whose spectra are kept with their phases, for steady lines (segment_spectra.h); 0 = none.
  int n_kept_segments = 0;
  bool bridge_losses = false;  // short gaps: see bridge_losses.h; false: every lost sample is masked
  // Single samples that their neighbours in time and the other channels do not allow are masked and counted
  // (outlier_gate.h, innovation_gate.h): for displacements from pictures. Not for decimated series, whose modes reach
  // up to half the rate.
  bool gate_outliers = false;
};

// Streaming Welch estimate of the cross-power spectra of all channels (Welch 1967), fixed memory.
// The mean of each segment is removed; it is windowed and zero-padded to a power of two >= 2 * segment, so that
// correlations up to one segment do not wrap around. A mask (1 seen, 0 missing) is windowed and transformed, too:
//   R_ij(lag) = IFFT(sum X_i conj(X_j)) / IFFT(sum M_i conj(M_j))
// is unbiased by the window and by random losses (METHOD.md). A sample that the gate rejects is masked with the next
// sample; if a segment ends before, a doubtful sample is masked in this segment.
// One thread; does not allocate after construction.
class WelchCpsd {
 public:
  explicit WelchCpsd(const WelchConfig& config);  // throws std::invalid_argument

  // Adds one grid cell of all channels. Returns true if this sample completes a segment (a "hop").
  bool push(std::span<const double> value, std::span<const std::uint8_t> seen) noexcept;
  // Adds the sample's channels, followed by its witnesses.
  bool push(const DisplacementSample& sample) noexcept;
  bool push_missing() noexcept;
  // End of the record: the last samples, with those that overlap, form a shorter segment with a window of its length.
  void flush() noexcept;

  // Restarts, as constructed, at another rate of the grid. Does not allocate. With forgetting (forget_s) its length in
  // hops is unchanged.
  void restart(double rate_hz) noexcept;

  // Saves the whole state: a restored accumulator continues bit-identically. save() does not allocate.
  void save(StateWriter& out) const noexcept;
  [[nodiscard]] std::size_t state_bytes() const noexcept;  // at most
  // False, with the accumulator as constructed, if the bytes are not those of this configuration.
  [[nodiscard]] bool restore(StateReader& in) noexcept;

  [[nodiscard]] const CpsdSums& sums() const noexcept { return sums_; }
  [[nodiscard]] std::uint64_t n_hops() const noexcept { return sums_.n_segments; }
  [[nodiscard]] int hop() const noexcept { return hop_; }
  [[nodiscard]] static CpsdSums empty_sums(const WelchConfig& config);  // with the sizes of sums()

 private:
  template <class Archive, class Self>
  static void describe(Archive& archive, Self& self) noexcept;
  [[nodiscard]] bool is_consistent() const noexcept;
  void put(std::size_t first, std::span<const double> value, std::span<const std::uint8_t> seen) noexcept;
  [[nodiscard]] std::size_t n_counted() const noexcept {
    return static_cast<std::size_t>(config_.n_channels - config_.n_witnesses);
  }
  void gate(std::size_t channel, double value, bool valid) noexcept;
  void gate_by_prediction() noexcept;
  void mask_outlier(std::size_t channel) noexcept;
  void mask(std::size_t channel, int at) noexcept;
  [[nodiscard]] bool is_doubtful(std::size_t channel) const noexcept;
  bool advance() noexcept;
  void accumulate_segment() noexcept;
  void set_doubtful_aside() noexcept;
  void restore_doubtful() noexcept;
  void transform_channel(int channel) noexcept;
  void transform_mask(int channel) noexcept;
  // one_mask: all channels lack the same samples.
  void add_products(bool one_mask, std::vector<std::complex<double>>& data_sum,
                    std::vector<std::complex<double>>& mask_sum) noexcept;
  void keep_spectra(bool one_mask) noexcept;
  void fade() noexcept;  // applies forgetting for one hop
  [[nodiscard]] CpsdBlock& current_block() noexcept;
  void make_room() noexcept;  // called when all blocks are in use

  WelchConfig config_;
  int hop_;
  std::vector<double> window_;
  RealFft fft_;
  OutlierGate gate_;
  InnovationGate innovation_gate_;
  CpsdSums sums_;
  int n_filled_ = 0;  // samples in the current segment
  int n_new_ = 0;     // of these, samples that are not yet part of an accumulated segment
  double kept_per_hop_ = 1.0;
  std::uint64_t segments_per_block_ = 1, most_segments_per_block_ = UINT64_MAX;
  std::vector<double> value_;                   // channels x segment
  std::vector<std::uint8_t> seen_;              // channels x segment
  std::vector<double> aside_;                   // newest sample per channel, masked while a segment is summed
  std::vector<std::uint8_t> is_aside_;          // channels
  std::vector<double> bridged_;                 // channels x segment; empty unless losses are bridged
  std::vector<std::uint8_t> held_;              // channels x segment; empty unless losses are bridged
  std::vector<double> padded_;                  // n_fft
  std::vector<std::complex<double>> data_;      // channels x bins
  std::vector<std::complex<double>> mask_;      // channels x bins; only the first if all are equal
  std::vector<float> seen_share_;               // channels
  std::vector<double> by_real_, by_imaginary_;  // one bin of all channels
};

}  // namespace core
