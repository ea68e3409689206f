#include "core/identification/relative_motion.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "core/types/constants.h"
#include "core/types/witness.h"

namespace core {

namespace {

using Complex = std::complex<double>;

constexpr double kSameAxis = 0.99;
constexpr double kLeastCoherence = 0.6, kLeastGain = 0.6;
constexpr double kByChance = 1e-3;
constexpr double kQuietPart = 0.25;  // share of the bins in which a region at rest is taken to show noise
constexpr double kAboveRestNoise = 4.0;

std::size_t pair_of(const CpsdSums& sums, int i, int j) {
  return static_cast<std::size_t>(CpsdSums::pair_index(std::min(i, j), std::max(i, j), sums.n_channels));
}

Complex cross_of(const CpsdSums& sums, int bin, int i, int j) {
  const Complex value = sums.data_sum[static_cast<std::size_t>(bin * sums.n_pairs()) + pair_of(sums, i, j)];
  return i > j ? std::conj(value) : value;
}

// The coherence of n independent segments exceeds c by chance with probability (1 - c)^(n - 1).
double least_coherence_of(double n_segments) {
  return n_segments > 1.0 ? std::max(kLeastCoherence, 1.0 - std::pow(kByChance, 1.0 / (n_segments - 1.0))) : 1.0;
}

double noise_of(const CpsdSums& sums, int witness) {
  std::vector<double> power;
  power.reserve(static_cast<std::size_t>(sums.n_bins()));
  for (int k = 1; k < sums.n_bins(); ++k) power.push_back(cross_of(sums, k, witness, witness).real());
  if (power.empty()) return 0.0;
  const auto at = power.begin() + static_cast<std::ptrdiff_t>(kQuietPart * static_cast<double>(power.size()));
  std::nth_element(power.begin(), at, power.end());
  return *at;
}

class RelativeSums {
 public:
  RelativeSums(const CpsdSums& sums, const std::vector<ChannelInfo>& channels, int base)
      : sums_(sums), channels_(channels), base_(base), turn_(channels.size()) {
    zero_lag_.assign(static_cast<std::size_t>(sums.n_pairs()), 0.0);
    for (std::size_t at = 0; at < sums.mask_sum.size(); ++at)
      zero_lag_[at % zero_lag_.size()] += sums.mask_sum[at].real();
  }

  void from(std::vector<Complex>& data_sum) {
    const auto pairs = static_cast<std::size_t>(sums_.n_pairs());
    std::vector<Complex> before(pairs);
    for (int k = 0; k < sums_.n_bins(); ++k) {
      Complex* at = data_sum.data() + static_cast<std::size_t>(k) * pairs;
      std::copy_n(at, pairs, before.begin());
      set_turns(k);
      for (int i = 0; i < sums_.n_channels; ++i) {
        for (int j = i; j < sums_.n_channels; ++j) *at++ = relative(before, i, j);
      }
    }
  }

 private:
  void set_turns(int bin) {
    const ChannelInfo& base = channels_[static_cast<std::size_t>(base_)];
    const double hz = bin * sums_.rate_hz / sums_.n_fft;
    for (std::size_t c = 0; c < channels_.size(); ++c) {
      const ChannelInfo& own = channels_[c];
      const double same = cosine_between(own, base);
      const bool moves = !own.is_base && !own.is_witness && std::abs(same) > kSameAxis;
      turn_[c] = moves ? std::polar(1.0, kTwoPi * hz * (own.row_delay_s - base.row_delay_s)) * std::copysign(1.0, same)
                       : Complex();
    }
  }
  // As if the pair lacked the samples that (i, j) lack.
  [[nodiscard]] Complex cross(const std::vector<Complex>& before, int a, int b, std::size_t like) const {
    const std::size_t own = pair_of(sums_, a, b);
    const Complex value = before[own] * (zero_lag_[own] > 0.0 ? zero_lag_[like] / zero_lag_[own] : 1.0);
    return a > b ? std::conj(value) : value;
  }
  [[nodiscard]] Complex relative(const std::vector<Complex>& before, int i, int j) const {
    const Complex ti = turn_[static_cast<std::size_t>(i)], tj = turn_[static_cast<std::size_t>(j)];
    const std::size_t like = pair_of(sums_, i, j);
    return cross(before, i, j, like) - ti * cross(before, base_, j, like) -
           std::conj(tj) * cross(before, i, base_, like) + ti * std::conj(tj) * cross(before, base_, base_, like);
  }

  const CpsdSums& sums_;
  const std::vector<ChannelInfo>& channels_;
  int base_;
  std::vector<Complex> turn_;
  std::vector<double> zero_lag_;  // of the masks, per pair
};

}  // namespace

CpsdSums relative_to_base(const CpsdSums& sums, const std::vector<ChannelInfo>& channels, int base) {
  CpsdSums out = sums;
  RelativeSums relative(sums, channels, base);
  relative.from(out.data_sum);
  for (std::size_t b = 0; b < out.n_blocks; ++b) relative.from(out.blocks[b].data_sum);
  return out;
}

SharedMotion::SharedMotion(const CpsdSums& sums, const CpsdSums& relative, const std::vector<ChannelInfo>& channels,
                           int base)
    : sums_(sums),
      relative_(relative),
      channels_(channels),
      base_(base),
      least_coherence_(least_coherence_of(sums.weight.effective())) {
  for (int c = 0; c < sums.n_channels; ++c)
    noise_.push_back(channels[static_cast<std::size_t>(c)].is_witness ? noise_of(sums, c) : 0.0);
}

// Sums of three bins, because a Hann window spreads a line over three.
bool SharedMotion::in_bin(int bin) const {
  double camera = 0.0, largest = 0.0, coherence = 0.0;
  for (int k = bin - 1; k <= bin + 1; ++k) camera += cross_of(sums_, k, base_, base_).real();
  for (int c = 0; c < sums_.n_channels; ++c) {
    const ChannelInfo& own = channels_[static_cast<std::size_t>(c)];
    if (own.is_base || own.is_witness) continue;
    double power = 0.0;
    for (int k = bin - 1; k <= bin + 1; ++k) power += cross_of(relative_, k, c, c).real();
    largest = std::max(largest, power);
    for (int w = 0; w < sums_.n_channels; ++w) {
      const ChannelInfo& witness = channels_[static_cast<std::size_t>(w)];
      if (!witness.is_witness || std::abs(cosine_between(own, witness)) < kSameAxis) continue;
      Complex cross = 0.0;
      double rest = 0.0;
      for (int k = bin - 1; k <= bin + 1; ++k)
        cross += cross_of(relative_, k, c, w), rest += cross_of(sums_, k, w, w).real();
      const bool moves = rest > kAboveRestNoise * 3.0 * noise_[static_cast<std::size_t>(w)];
      if (power > 0.0 && moves) coherence = std::max(coherence, std::norm(cross) / (power * rest));
    }
  }
  return coherence > least_coherence_ && largest > kLeastGain * kLeastGain * camera;
}

bool SharedMotion::at(double apparent_hz) const {
  return in_bin(
      std::clamp(static_cast<int>(std::lround(apparent_hz * sums_.n_fft / sums_.rate_hz)), 1, sums_.n_bins() - 2));
}

bool SharedMotion::anywhere() const {
  for (int bin = 1; bin < sums_.n_bins() - 1; ++bin) {
    if (in_bin(bin)) return true;
  }
  return false;
}

}  // namespace core
