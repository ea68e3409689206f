#include "core/identification/measured_inputs.h"

#include <algorithm>
#include <complex>

#include "core/types/witness.h"

namespace core {

namespace {

constexpr double kLeastSteady =
    0.75;  // share of the record that a base's power fills; of a shake table's earthquake .56
constexpr double kMostExplained = 0.5;     // by a region at rest, of the channels' motion against one another
constexpr std::size_t kLeastSegments = 3;  // with fewer, chance coherence is no less than that

class Spectra {
 public:
  explicit Spectra(const CpsdSums& sums) : sums_(sums) {}

  [[nodiscard]] std::size_t at(int bin, int i, int j) const {
    return static_cast<std::size_t>(bin) * static_cast<std::size_t>(sums_.n_pairs()) +
           static_cast<std::size_t>(CpsdSums::pair_index(std::min(i, j), std::max(i, j), sums_.n_channels));
  }
  [[nodiscard]] std::complex<double> cross(int bin, int i, int j) const {
    const std::complex<double> value = sums_.data_sum[at(bin, i, j)];
    return i > j ? std::conj(value) : value;
  }
  [[nodiscard]] double power(int bin, int i) const { return cross(bin, i, i).real(); }
  [[nodiscard]] const CpsdSums& sums() const noexcept { return sums_; }

 private:
  const CpsdSums& sums_;
};

// (mean power)^2 / mean of the squared power of a segment, over the blocks, every frequency counting alike: 1 for a
// steady input, and where blocks are not kept.
double filled_share(const Spectra& spectra, int channel) {
  const CpsdSums& sums = spectra.sums();
  double n = 0.0, sum = 0.0, squares = 0.0;
  for (std::size_t b = 0; b < sums.n_blocks; ++b) {
    const CpsdBlock& block = sums.blocks[b];
    if (block.n_segments == 0) continue;
    double share = 0.0;
    for (int k = 1; k < sums.n_bins(); ++k) {
      const double whole = spectra.power(k, channel);
      if (whole > 0.0) share += block.data_sum[spectra.at(k, channel, channel)].real() / whole;
    }
    const auto segments = static_cast<double>(block.n_segments);
    n += segments, sum += share, squares += share * share / segments;
  }
  return squares > 0.0 ? sum * sum / (n * squares) : 1.0;
}

// Share of the outputs' motion against their mean that `witness` explains, without what chance explains.
double explained_share(const Spectra& spectra, const std::vector<int>& outputs, int witness) {
  const auto n = static_cast<double>(outputs.size());
  double explained = 0.0, whole = 0.0;
  for (int k = 1; k < spectra.sums().n_bins(); ++k) {
    const double own = spectra.power(k, witness);
    if (!(own > 0.0)) continue;
    std::complex<double> mean_with = 0.0, mean_square = 0.0;
    for (const int i : outputs) {
      mean_with += spectra.cross(k, i, witness) / n;
      for (const int j : outputs) mean_square += spectra.cross(k, i, j) / (n * n);
    }
    for (const int i : outputs) {
      explained += std::norm(spectra.cross(k, i, witness) - mean_with) / own;
      whole += spectra.power(k, i);
    }
    whole -= n * mean_square.real();
  }
  const double chance = 1.0 / static_cast<double>(std::max<std::size_t>(spectra.sums().n_segments, 1));
  return whole > 0.0 ? (explained / whole - chance) / (1.0 - chance) : 1.0;
}

}  // namespace

std::vector<int> measured_inputs(const CpsdSums& sums, const std::vector<ChannelInfo>& channels) {
  const Spectra spectra(sums);
  std::vector<int> inputs, outputs, witnesses;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    (channels[i].is_base ? inputs : channels[i].is_witness ? witnesses : outputs).push_back(static_cast<int>(i));
  }
  const auto is_transient = [&](int base) { return filled_share(spectra, base) < kLeastSteady; };
  if (outputs.empty() || std::any_of(inputs.begin(), inputs.end(), is_transient)) return {};
  if (sums.n_segments < kLeastSegments) return inputs;
  const bool has_base = !inputs.empty();
  bool all_rest = true;
  for (const int w : witnesses) {
    if (witnesses_turn(channels[static_cast<std::size_t>(w)])) continue;
    const bool rests = explained_share(spectra, outputs, w) < kMostExplained;
    if (rests && has_base) inputs.push_back(w);
    all_rest = all_rest && rests;
  }
  // The camera's rotation may well be most of the channels' motion against one another.
  for (const int w : witnesses) {
    if (all_rest && witnesses_turn(channels[static_cast<std::size_t>(w)])) inputs.push_back(w);
  }
  std::sort(inputs.begin(), inputs.end());
  return inputs;
}

}  // namespace core
