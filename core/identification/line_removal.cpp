// Sums without steady lines.
#include <algorithm>
#include <cmath>
#include <set>

#include "core/identification/line_transform.h"
#include "core/identification/steady_lines.h"
#include "core/types/constants.h"

namespace core {

namespace {

using Complex = std::complex<double>;

// Segments first ... last - 1 of the stream, with the sum of their weights.
struct LineStretch {
  std::uint64_t first = 0, last = 0;
  double weight = 0.0;
};

class LineRemoval {
 public:
  LineRemoval(const CpsdSums& sums, const std::vector<SteadyLine>& lines)
      : kept_(sums.segments),
        lines_(lines),
        rate_hz_(sums.rate_hz),
        hz_per_bin_(sums.rate_hz / sums.n_fft),
        n_channels_(static_cast<std::size_t>(sums.n_channels)),
        transform_(sums.segments.window_a0(), sums.rate_hz) {
    const int last_bin = static_cast<int>(kept_.n_bins()) - 1;
    for (const SteadyLine& line : lines) {
      const auto centre = static_cast<int>(std::lround(line.apparent_hz / hz_per_bin_));
      for (int bin = std::max(0, centre - kLineReach); bin <= std::min(last_bin, centre + kLineReach); ++bin)
        bins_.insert(bin);
    }
  }

  void from(std::vector<Complex>& data_sum, const LineStretch& stretch) const {
    for (const int bin : bins_)
      from_bin(bin, stretch, data_sum.data() + static_cast<std::size_t>(bin) * n_channels_ * (n_channels_ + 1) / 2);
  }

 private:
  // (x - p)(x - p)' for x x', p the lines' part of a segment x that is kept.
  void from_bin(int bin, const LineStretch& stretch, Complex* pairs) const {
    std::vector<Complex> part(n_channels_), seen(n_channels_);
    double older = stretch.weight;
    for (std::uint64_t k = std::max(stretch.first, kept_.first()); k < stretch.last; ++k) {
      const SegmentSpectra::Segment& segment = kept_.segment(k);
      std::fill(part.begin(), part.end(), 0.0);
      for (const SteadyLine& line : lines_) {
        const double turns = line.apparent_hz * static_cast<double>(segment.start) / rate_hz_;
        const Complex unit = transform_.at(line.apparent_hz - bin * hz_per_bin_, segment.n_samples) *
                             std::polar(1.0, kTwoPi * (turns - std::floor(turns)));
        for (std::size_t c = 0; c < line.amplitude.size(); ++c)
          part[c] += static_cast<double>(kept_.seen(k, c)) * line.amplitude[c] * unit;
      }
      for (std::size_t c = 0; c < n_channels_; ++c) seen[c] = Complex(kept_.value(k, c)[static_cast<std::size_t>(bin)]);
      older -= segment.weight;
      Complex* sum = pairs;
      for (std::size_t i = 0; i < n_channels_; ++i) {
        for (std::size_t j = i; j < n_channels_; ++j)
          *sum++ -= segment.weight * (part[i] * std::conj(seen[j]) + (seen[i] - part[i]) * std::conj(part[j]));
      }
    }
    if (older > 1e-9 * stretch.weight) from_older(bin, older, pairs);
  }

  void from_older(int bin, double weight, Complex* pairs) const {
    const std::uint64_t n_samples = kept_.segment(kept_.first()).n_samples;
    for (const SteadyLine& line : lines_) {
      const double power = weight * std::norm(transform_.at(line.apparent_hz - bin * hz_per_bin_, n_samples));
      Complex* sum = pairs;
      for (std::size_t i = 0; i < n_channels_; ++i) {
        for (std::size_t j = i; j < n_channels_; ++j, ++sum) {
          if (j < line.amplitude.size()) *sum -= power * line.amplitude[i] * std::conj(line.amplitude[j]);
        }
      }
    }
  }

  const SegmentSpectra& kept_;
  const std::vector<SteadyLine>& lines_;
  double rate_hz_, hz_per_bin_;
  std::size_t n_channels_;
  LineTransform transform_;
  std::set<int> bins_;
};

}  // namespace

CpsdSums without_lines(const CpsdSums& sums, const std::vector<SteadyLine>& lines) {
  CpsdSums out = sums;
  const LineRemoval removal(sums, lines);
  removal.from(out.data_sum, {0, sums.n_segments, sums.weight.sum});
  std::uint64_t first = 0;
  for (std::size_t b = 0; b < out.n_blocks; ++b) {
    CpsdBlock& block = out.blocks[b];
    removal.from(block.data_sum, {first, first + block.n_segments, block.weight.sum});
    first += block.n_segments;
  }
  return out;
}

}  // namespace core
