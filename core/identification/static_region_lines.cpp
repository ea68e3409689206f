// Lines of the camera in the spectra of static regions.
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/identification/camera_lines.h"
#include "core/identification/camera_shape.h"
#include "core/identification/line_height.h"
#include "core/types/witness.h"

namespace core {

namespace {

using Complex = std::complex<double>;

constexpr double kLowestLine = 2.0, kHeightSigmas = 8.0;
// The edge of a line is where this share of its height is left. A recorded hover has shelves that are wider.
constexpr double kEdge = 1.0 / 3.0, kWidest_hz = 1.2;
// Shares of the motion that a camera explains, and by how much those differ that the rows do not distinguish.
constexpr double kLeastExplained = 0.85, kAlike = 0.03;
constexpr std::size_t kLeastRows = 4;

struct Explained {
  double hz = 0.0, share = 0.0;
};

// Every frequency that is seen at the line's, the one that explains most of its motion first.
std::vector<Explained> explained_by(const CameraLine& line, const FoldingConfig& folding) {
  std::vector<Explained> out;
  const int reach = static_cast<int>(std::ceil(kFastestCamera_hz / folding.rate_hz)) + 1;
  for (int n = -reach; n <= reach; ++n) {
    const double hz = line.apparent_hz + n * folding.rate_hz;
    if (std::abs(hz) <= kFastestCamera_hz) out.push_back({hz, camera_share(line.motion, hz, folding.delay_s)});
  }
  std::stable_sort(out.begin(), out.end(), [](const Explained& a, const Explained& b) { return a.share > b.share; });
  return out;
}

void unfold_line(const FoldingConfig& folding, CameraLine& line) {
  if (line.motion.size() < kLeastRows) return;
  const std::vector<Explained> candidates = explained_by(line, folding);
  if (candidates.size() < 2) return;
  const double least = std::max(kLeastExplained, candidates.front().share - kAlike);
  const auto beyond =
      std::find_if(candidates.begin(), candidates.end(), [&](const Explained& one) { return one.share < least; });
  if (static_cast<std::size_t>(beyond - candidates.begin()) > kMostTrueFrequencies) return;
  for (auto one = candidates.begin(); one != beyond; ++one) line.true_hz.push_back(one->hz);
  std::sort(line.true_hz.begin(), line.true_hz.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  line.margin = candidates[0].share - candidates[1].share;
}

class WitnessSpectrum {
 public:
  WitnessSpectrum(const CpsdSums& sums, std::size_t witness)
      : sums_(sums), witness_(witness), hz_per_bin_(sums.rate_hz / sums.n_fft) {
    for (int bin = 0; bin < sums.n_bins(); ++bin) power_.push_back(cross(bin, witness).real());
    for (int bin = 0; bin < sums.n_bins(); ++bin) {
      const auto [first, last] = smoothing_at(bin, sums.n_bins());
      double sum = 0.0;
      for (int b = first; b <= last; ++b) sum += power_[static_cast<std::size_t>(b)];
      smooth_.push_back(sum / (last - first + 1));
    }
    height_ = heights(smooth_, hz_per_bin_);
  }

  void add_lines(const FoldingConfig& folding, std::vector<CameraLine>& lines) const {
    const double least = std::max(kLowestLine, 1.0 + kHeightSigmas / std::sqrt(values_per_bin(sums_)));
    std::vector<double> height = height_;
    while (true) {
      const auto highest = std::max_element(height.begin(), height.end());
      if (highest == height.end() || !(*highest > least)) return;
      const auto bin = static_cast<int>(highest - height.begin());
      const auto [first, last] = edges(bin);
      if ((last - first) * hz_per_bin_ <= kWidest_hz) lines.push_back(line(bin, first, last, folding));
      const int beside = bins(kLineReach_hz);
      for (int b = std::max(0, first - beside); b <= std::min(sums_.n_bins() - 1, last + beside); ++b)
        height[static_cast<std::size_t>(b)] = 0.0;
    }
  }

 private:
  [[nodiscard]] int bins(double hz) const noexcept { return static_cast<int>(hz / hz_per_bin_); }

  // S of an earlier channel and the witness.
  [[nodiscard]] Complex cross(int bin, std::size_t channel) const {
    const int pair = CpsdSums::pair_index(static_cast<int>(channel), static_cast<int>(witness_), sums_.n_channels);
    return sums_.data_sum.data()[static_cast<std::ptrdiff_t>(bin) * sums_.n_pairs() + pair];
  }

  [[nodiscard]] std::pair<int, int> edges(int bin) const {
    const double level = kEdge * smooth_[static_cast<std::size_t>(bin)];
    const int reach = bins(kWidest_hz);
    const auto is_within = [&](int b) {
      return b >= 0 && b < sums_.n_bins() && std::abs(b - bin) <= reach + 1 &&
             smooth_[static_cast<std::size_t>(b)] > level;
    };
    int first = bin, last = bin;
    while (is_within(first - 1)) --first;
    while (is_within(last + 1)) ++last;
    return {first, last};
  }

  [[nodiscard]] CameraLine line(int bin, int first, int last, const FoldingConfig& folding) const {
    CameraLine out;
    double power = 0.0, moment = 0.0;
    std::vector<Complex> sum(folding.delay_s.size());
    for (int b = first; b <= last; ++b) {
      const double own = power_[static_cast<std::size_t>(b)];
      power += own, moment += own * b;
      for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += cross(b, c);
    }
    out.apparent_hz = hz_per_bin_ * moment / power;  // its height is above 0
    out.half_width_hz = 0.5 * (last - first + 1) * hz_per_bin_;
    out.height = height_[static_cast<std::size_t>(bin)];
    out.of_the_region = true;
    for (const Complex& one : sum) out.motion.push_back(one / power);
    unfold_line(folding, out);
    return out;
  }

  const CpsdSums& sums_;
  std::size_t witness_;
  double hz_per_bin_;
  std::vector<double> power_, smooth_, height_;  // per bin
};

}  // namespace

std::vector<CameraLine> lines_of_static_regions(const CpsdSums& sums, const std::vector<ChannelInfo>& channels,
                                                const FoldingConfig& folding) {
  std::vector<CameraLine> lines;
  for (std::size_t w = 0; w < channels.size(); ++w) {
    if (channels[w].is_witness && !witnesses_turn(channels[w])) WitnessSpectrum(sums, w).add_lines(folding, lines);
  }
  return lines;
}

}  // namespace core
