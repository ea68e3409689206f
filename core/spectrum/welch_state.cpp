#include "core/spectrum/welch_cpsd.h"

#include <algorithm>
#include <cmath>

namespace core {

namespace {
using Complex = std::complex<double>;

bool is_finite(const std::vector<Complex>& values) noexcept {
  return std::all_of(values.begin(), values.end(),
                     [](const Complex& x) { return std::isfinite(x.real()) && std::isfinite(x.imag()); });
}
bool is_finite(const SegmentWeight& weight) noexcept {
  return std::isfinite(weight.sum) && std::isfinite(weight.squares);
}
bool is_finite(const CpsdBlock& block) noexcept {
  return is_finite(block.weight) && is_finite(block.data_sum) && is_finite(block.mask_sum);
}
}  // namespace

// Fields that determine sizes come first, so that another configuration is detected before anything is restored.
template <class Archive, class Self>
void WelchCpsd::describe(Archive& archive, Self& self) noexcept {
  auto& sums = self.sums_;
  archive.value(sums.n_segments);
  archive.value(sums.weight);
  archive.value(sums.n_samples);
  archive.value(sums.n_missing);
  archive.array(sums.n_outlying);
  archive.array(sums.data_sum);
  archive.array(sums.mask_sum);
  archive.value(sums.n_blocks);
  for (std::size_t b = 0; b < sums.n_blocks && b < sums.blocks.size() && archive.ok(); ++b) {
    auto& block = sums.blocks[b];
    archive.value(block.n_segments);
    archive.value(block.weight);
    archive.array(block.data_sum);
    archive.array(block.mask_sum);
  }
  SegmentSpectra::describe(archive, sums.segments);
  archive.value(self.n_filled_);
  archive.value(self.n_new_);
  archive.value(self.segments_per_block_);
  archive.array(self.value_);
  archive.array(self.seen_);
  archive.array(self.gate_.state());
  archive.array(self.innovation_gate_.state());
}

void WelchCpsd::save(StateWriter& out) const noexcept {
  out.value(sums_.n_channels);
  out.value(config_.segment);
  out.value(hop_);
  out.value(sums_.n_fft);
  out.value(sums_.rate_hz);
  out.value(sums_.window_power);
  out.value(kept_per_hop_);
  describe(out, *this);
}

std::size_t WelchCpsd::state_bytes() const noexcept {
  const std::size_t sums = 2 * (sums_.data_sum.size() * sizeof(Complex) + 64);
  return 512 + (1 + sums_.blocks.size()) * sums + sums_.segments.state_bytes() + value_.size() * (sizeof(double) + 1) +
         gate_.state().size() *
             (sizeof(OutlierGate::Channel) + sizeof(InnovationGate::Channel) + sizeof(std::uint64_t));
}

bool WelchCpsd::restore(StateReader& in) noexcept {
  int n_channels = 0, segment = 0, hop = 0, n_fft = 0;
  double rate_hz = 0.0, window_power = 0.0, kept_per_hop = 0.0;
  in.value(n_channels), in.value(segment), in.value(hop), in.value(n_fft);
  in.value(rate_hz), in.value(window_power), in.value(kept_per_hop);
  const bool same = in.ok() && n_channels == sums_.n_channels && segment == config_.segment && hop == hop_ &&
                    n_fft == sums_.n_fft && rate_hz == sums_.rate_hz && window_power == sums_.window_power &&
                    kept_per_hop == kept_per_hop_;
  if (same) describe(in, *this);
  if (same && in.ok() && is_consistent()) return true;
  in.fail();
  restart(sums_.rate_hz);
  return false;
}

// Checks indices and numbers on which later steps rely.
bool WelchCpsd::is_consistent() const noexcept {
  const bool has_numbers =
      is_finite(sums_.data_sum) && is_finite(sums_.mask_sum) &&
      std::all_of(value_.begin(), value_.end(), [](double x) { return std::isfinite(x); }) &&
      std::all_of(sums_.blocks.begin(), sums_.blocks.end(), [](const CpsdBlock& block) { return is_finite(block); }) &&
      sums_.segments.is_consistent(static_cast<std::uint64_t>(config_.segment)) &&
      (sums_.segments.n_room() == 0 || sums_.segments.n_added() == sums_.n_segments);
  return has_numbers && gate_.is_consistent() && innovation_gate_.is_consistent() &&
         sums_.n_blocks <= sums_.blocks.size() && n_filled_ >= 0 && n_filled_ < config_.segment && n_new_ >= 0 &&
         n_new_ <= n_filled_ && segments_per_block_ > 0;
}

}  // namespace core
