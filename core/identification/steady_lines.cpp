#include "core/identification/steady_lines.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/identification/line_transform.h"
#include "core/types/constants.h"

namespace core {

namespace {

using Complex = std::complex<double>;

constexpr double kLeastModeDamping = 0.001;  // of a structure
constexpr double kModeLoss = 0.022;          // see least_coherence()
constexpr double kChance = 0.03;             // of a line found in noise, per record
constexpr int kFit = 1;                      // bins to either side that a line's amplitude is fitted to
constexpr double kStep = 1.0 / 6.0;          // of the frequencies tried, in 1 / length of the record
constexpr int kRounds = 2;
constexpr double kHalfBin = 0.55;  // tried to either side of a bin, in bins

// Spectra of the kept segments that are complete, without what the inputs explain, while lines are taken out of them.
class LineSearch {
 public:
  LineSearch(const CpsdSums& sums, const std::vector<ChannelInfo>& channels, const std::vector<int>& inputs)
      : rate_hz_(sums.rate_hz),
        hz_per_bin_(sums.rate_hz / sums.n_fft),
        n_bins_(sums.segments.n_bins()),
        n_inputs_(inputs.size()),
        transform_(sums.segments.window_a0(), sums.rate_hz) {
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const bool is_input = std::find(inputs.begin(), inputs.end(), static_cast<int>(c)) != inputs.end();
      if (!is_input && !channels[c].is_witness) channels_.push_back(c);
    }
    const SegmentSpectra& kept = sums.segments;
    const std::uint64_t whole = kept.n_added() > kept.first() ? kept.segment(kept.first()).n_samples : 0;
    for (std::uint64_t k = kept.first(); k < kept.n_added(); ++k) {
      if (kept.segment(k).n_samples == whole) segments_.push_back(k);
    }
    if (segments_.size() < kLeastLineSegments) return;
    n_samples_ = whole;
    take_spectra(kept);
    std::vector<std::vector<Complex>> given;
    given.reserve(inputs.size());
    for (const int input : inputs) given.push_back(spectra_of(kept, static_cast<std::size_t>(input)));
    take_out(std::move(given));
    weigh_channels();
    set_least_coherence();
  }

  [[nodiscard]] bool can_search() const noexcept { return n_samples_ > 0; }

  // The line with the most power among those that no mode and no chance explains.
  [[nodiscard]] std::optional<SteadyLine> strongest() const {
    std::vector<double> power(n_bins_);
    for (std::size_t bin = 1; bin + 1 < n_bins_; ++bin) power[bin] = power_at(bin);
    std::optional<Candidate> best;
    for (std::size_t bin = 2; bin + 2 < n_bins_; ++bin) {
      if (!(power[bin] > 0.0 && power[bin] >= power[bin - 1] && power[bin] >= power[bin + 1])) continue;
      const Candidate here = best_at(bin, power[bin]);
      if (here.coherence < least_coherence(here.hz)) continue;
      if (!best || here.coherence * here.power > best->coherence * best->power) best = here;
    }
    if (!best) return std::nullopt;
    return fitted(*best);
  }

  void remove(const SteadyLine& line) {
    const auto centre = static_cast<int>(std::lround(line.apparent_hz / hz_per_bin_));
    std::vector<Complex> unit;
    for (int i = std::max(0, centre - kLineReach); i <= std::min(static_cast<int>(n_bins_) - 1, centre + kLineReach);
         ++i) {
      const auto bin = static_cast<std::size_t>(i);
      for (std::size_t c = 0; c < channels_.size(); ++c) {
        line_at(bin, c, line.apparent_hz, unit);
        for (std::size_t k = 0; k < unit.size(); ++k) value_[at(bin, c, k)] -= line.amplitude[channels_[c]] * unit[k];
      }
    }
  }

 private:
  struct Candidate {
    double hz = 0.0, coherence = 0.0, power = 0.0;
  };

  [[nodiscard]] std::size_t at(std::size_t bin, std::size_t c, std::size_t k) const noexcept {
    return (bin * channels_.size() + c) * segments_.size() + k;
  }

  void take_spectra(const SegmentSpectra& kept) {
    const std::size_t n = segments_.size();
    value_.resize(n_bins_ * channels_.size() * n);
    for (std::size_t k = 0; k < n; ++k) {
      start_s_.push_back(static_cast<double>(kept.segment(segments_[k]).start) / rate_hz_);
      for (std::size_t c = 0; c < channels_.size(); ++c) {
        share_.push_back(kept.seen(segments_[k], channels_[c]));
        is_seen_alike_ = is_seen_alike_ && share_.back() == share_[k * channels_.size()];
        const auto from = kept.value(segments_[k], channels_[c]);
        for (std::size_t bin = 0; bin < n_bins_; ++bin) value_[at(bin, c, k)] = Complex(from[bin]);
      }
    }
  }

  [[nodiscard]] std::vector<Complex> spectra_of(const SegmentSpectra& kept, std::size_t channel) const {
    const std::size_t n = segments_.size();
    std::vector<Complex> out(n_bins_ * n);
    for (std::size_t k = 0; k < n; ++k) {
      const auto from = kept.value(segments_[k], channel);
      for (std::size_t bin = 0; bin < n_bins_; ++bin) out[bin * n + k] = Complex(from[bin]);
    }
    return out;
  }

  // Regression of every channel on the inputs, bin by bin over the segments (Gram-Schmidt). What is left of a line is
  // what is left of its phases after the same regression.
  void take_out(std::vector<std::vector<Complex>> given) {
    const std::size_t n = segments_.size();
    for (std::size_t i = 0; i < given.size(); ++i) {
      for (std::size_t bin = 0; bin < n_bins_; ++bin) {
        Complex* const unit = given[i].data() + bin * n;
        double power = 0.0;
        for (std::size_t k = 0; k < n; ++k) power += std::norm(unit[k]);
        const double scale = power > 0.0 ? 1.0 / std::sqrt(power) : 0.0;
        for (std::size_t k = 0; k < n; ++k) unit[k] *= scale;
        for (std::size_t j = i + 1; j < given.size(); ++j) project_out(unit, given[j].data() + bin * n);
        for (std::size_t c = 0; c < channels_.size(); ++c) project_out(unit, &value_[at(bin, c, 0)]);
      }
    }
    inputs_ = std::move(given);
  }

  void project_out(const Complex* unit, Complex* of) const {
    Complex cross = 0.0;
    for (std::size_t k = 0; k < segments_.size(); ++k) cross += of[k] * std::conj(unit[k]);
    for (std::size_t k = 0; k < segments_.size(); ++k) of[k] -= cross * unit[k];
  }

  // A line of amplitude 1 at the bin in every segment of a channel, after the same regression.
  void line_at(std::size_t bin, std::size_t c, double hz, std::vector<Complex>& out) const {
    const Complex shape = transform_.at(hz - static_cast<double>(bin) * hz_per_bin_, n_samples_);
    out.resize(segments_.size());
    for (std::size_t k = 0; k < out.size(); ++k)
      out[k] = share_[k * channels_.size() + c] * shape * std::polar(1.0, kTwoPi * hz * start_s_[k]);
    for (const auto& input : inputs_) project_out(input.data() + bin * out.size(), out.data());
  }

  // Every channel counts alike, whatever its amplitude.
  void weigh_channels() {
    std::vector<double> power(channels_.size());
    for (std::size_t bin = 2; bin + 2 < n_bins_; ++bin) {
      for (std::size_t c = 0; c < channels_.size(); ++c) {
        for (std::size_t k = 0; k < segments_.size(); ++k) power[c] += std::norm(value_[at(bin, c, k)]);
      }
    }
    for (const double p : power) weight_.push_back(p > 0.0 ? 1.0 / p : 0.0);
  }

  [[nodiscard]] double length_s() const {
    return start_s_.back() - start_s_.front() + static_cast<double>(n_samples_) / rate_hz_;
  }

  // For noise the coherence over n independent segments exceeds q with probability (1 - q)^(n - 1), at every frequency
  // that is tried.
  void set_least_coherence() {
    const double independent = std::min(0.95 * static_cast<double>(segments_.size()),
                                        1.9 * length_s() * rate_hz_ / static_cast<double>(n_samples_));
    const double tried = static_cast<double>(n_bins_) * std::max(1.0, hz_per_bin_ * length_s());
    const double freedom = std::max(1.0, independent - 1.0 - static_cast<double>(n_inputs_));
    by_chance_ = 1.0 - std::pow(kChance / tried, 1.0 / freedom);
  }

  // The phase of a mode wanders: one in a thousand records of length T has a coherence above exp(-0.022 r), r = 2 pi
  // zeta f T up to 20 (20 000 drawn records of narrow-band noise with a damping of zeta).
  [[nodiscard]] double least_coherence(double hz) const {
    return std::max(by_chance_, std::exp(-kModeLoss * kTwoPi * kLeastModeDamping * hz * length_s()));
  }

  [[nodiscard]] double power_at(std::size_t bin) const {
    double power = 0.0;
    for (std::size_t c = 0; c < channels_.size(); ++c) {
      double own = 0.0;
      const Complex* z = &value_[at(bin, c, 0)];
      for (std::size_t k = 0; k < segments_.size(); ++k) own += std::norm(z[k]);
      power += weight_[c] * own;
    }
    return power;
  }

  // Power that a line of this frequency explains at the bin: |e' z|^2 / e' e, e the line after the regression.
  [[nodiscard]] double explained(std::size_t bin, double hz) const {
    const std::size_t n = segments_.size();
    std::vector<Complex> line;
    double out = 0.0;
    for (std::size_t c = 0; c < channels_.size(); ++c) {
      if (c == 0 || !is_seen_alike_) line_at(bin, c, hz, line);
      const Complex* z = &value_[at(bin, c, 0)];
      double re = 0.0, im = 0.0, squares = 0.0;
      for (std::size_t k = 0; k < n; ++k) {
        re += line[k].real() * z[k].real() + line[k].imag() * z[k].imag();
        im += line[k].real() * z[k].imag() - line[k].imag() * z[k].real();
        squares += std::norm(line[k]);
      }
      if (squares > 0.0) out += weight_[c] * (re * re + im * im) / squares;
    }
    return out;
  }

  // The best frequency within half a bin: the best tried, then the vertex of the parabola through it and its
  // neighbours, twice, with a step a quarter as long the second time.
  [[nodiscard]] Candidate best_at(std::size_t bin, double power) const {
    const double centre = static_cast<double>(bin) * hz_per_bin_;
    double step = kStep / length_s(), best_hz = centre, best = -1.0;
    const int reach = static_cast<int>(std::ceil(kHalfBin * hz_per_bin_ / step));
    for (int j = -reach; j <= reach; ++j) {
      const double here = explained(bin, centre + j * step);
      if (here > best) best = here, best_hz = centre + j * step;
    }
    for (int round = 0; round < kRounds; ++round, step *= 0.25) {
      const double below = explained(bin, best_hz - step), at_best = explained(bin, best_hz),
                   above = explained(bin, best_hz + step);
      const double bend = below - 2.0 * at_best + above;
      if (bend < 0.0) best_hz += std::clamp(0.5 * (below - above) / bend, -1.0, 1.0) * step;
    }
    return {best_hz, explained(bin, best_hz) / power, power};
  }

  // Amplitudes by least squares over the segments and the bins beside.
  [[nodiscard]] SteadyLine fitted(const Candidate& found) const {
    SteadyLine line{found.hz, found.coherence, segments_.size(), {}};
    line.amplitude.assign(channels_.back() + 1, 0.0);
    const auto centre = static_cast<int>(std::lround(found.hz / hz_per_bin_));
    std::vector<Complex> unit;
    for (std::size_t c = 0; c < channels_.size(); ++c) {
      Complex cross = 0.0;
      double squares = 0.0;
      for (int i = centre - kFit; i <= centre + kFit; ++i) {
        const auto bin = static_cast<std::size_t>(i);
        line_at(bin, c, found.hz, unit);
        for (std::size_t k = 0; k < unit.size(); ++k) {
          cross += std::conj(unit[k]) * value_[at(bin, c, k)];
          squares += std::norm(unit[k]);
        }
      }
      if (squares > 0.0) line.amplitude[channels_[c]] = cross / squares;
    }
    return line;
  }

  double rate_hz_, hz_per_bin_;
  std::size_t n_bins_, n_inputs_;
  LineTransform transform_;
  std::vector<std::size_t> channels_;         // those that are no input and no static region
  std::vector<std::uint64_t> segments_;       // complete ones
  std::uint64_t n_samples_ = 0;               // of each; 0: too few
  std::vector<double> start_s_;               // per segment
  std::vector<double> share_;                 // segments x channels
  bool is_seen_alike_ = true;                 // the shares are those of the first channel
  std::vector<Complex> value_;                // bins x channels x segments
  std::vector<std::vector<Complex>> inputs_;  // per input: bins x segments, orthonormal over the segments of a bin
  std::vector<double> weight_;                // per channel
  double by_chance_ = 1.0;
};

}  // namespace

std::vector<SteadyLine> find_steady_lines(const CpsdSums& sums, const std::vector<ChannelInfo>& channels,
                                          const std::vector<int>& inputs) {
  std::vector<SteadyLine> lines;
  if (sums.segments.n_added() < kLeastLineSegments || sums.segments.n_room() < kLeastLineSegments) return lines;
  LineSearch search(sums, channels, inputs);
  while (search.can_search() && lines.size() < kMostSteadyLines) {
    const std::optional<SteadyLine> line = search.strongest();
    if (!line) break;
    search.remove(*line);
    lines.push_back(*line);
  }
  return lines;
}

}  // namespace core
