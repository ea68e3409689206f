#include "core/identification/camera_leakage.h"

#include <algorithm>
#include <cmath>

#include "core/types/constants.h"

namespace core {

namespace {

using Complex = std::complex<double>;

constexpr double kSameDirection = 0.99;
constexpr int kHalfWidth_bins = 8;    // of the moving average over bins
constexpr double kQuietShare = 0.25;  // share of the bins that are taken to contain only noise
constexpr double kNoiseAboveQuiet = 1.05;
constexpr double kNoticeable = 0.1, kMostLeft = 0.1;  // shares of a shape's square

std::vector<double> smoothed(const std::vector<double>& values) {
  const auto n = static_cast<int>(values.size());
  std::vector<double> out;
  for (int k = 0; k < n; ++k) {
    const int first = std::max(0, k - kHalfWidth_bins), last = std::min(n - 1, k + kHalfWidth_bins);
    double sum = 0.0;
    for (int m = first; m <= last; ++m) sum += values[static_cast<std::size_t>(m)];
    out.push_back(sum / (last - first + 1));
  }
  return out;
}

double square(const std::vector<Complex>& shape, std::size_t n) {
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) sum += std::norm(shape[i]);
  return sum;
}

}  // namespace

CameraLeakage::CameraLeakage(const CpsdSums& sums, const std::vector<ChannelInfo>& channels)
    : hz_per_bin_(sums.n_fft > 0 ? sums.rate_hz / sums.n_fft : 0.0) {
  list(channels);
  for (std::size_t w = 0; w < witnesses_.size(); ++w) measure(sums, static_cast<int>(w));
}

void CameraLeakage::list(const std::vector<ChannelInfo>& channels) {
  const auto first =
      std::find_if(channels.begin(), channels.end(), [](const ChannelInfo& channel) { return channel.is_witness; });
  for (auto w = first; w != channels.end(); ++w) {
    witnesses_.push_back({static_cast<std::size_t>(w - channels.begin()), w->row_delay_s, 0.0, {}});
  }
  for (auto channel = channels.begin(); channel != first; ++channel) {
    Output output{-1, 1.0, channel->row_delay_s};
    for (auto w = first; w != channels.end(); ++w) {
      const double cosine = channel->direction_u * w->direction_u + channel->direction_v * w->direction_v;
      if (std::abs(cosine) < kSameDirection) continue;
      output.witness = static_cast<int>(w - first);
      output.sign = cosine < 0.0 ? -1.0 : 1.0;
    }
    outputs_.push_back(output);
  }
}

// Spectra of a witness (w) and of the mean of the outputs that it represents (m), without row delays; smoothed over
// bins.
CameraLeakage::Spectra CameraLeakage::spectra_of(const CpsdSums& sums, int w) const {
  const Witness& witness = witnesses_[static_cast<std::size_t>(w)];
  const auto own = static_cast<int>(witness.channel);
  const auto at = [&](int bin, int i, int j) {
    const Complex s = sums.data_sum[static_cast<std::size_t>(
        bin * sums.n_pairs() + CpsdSums::pair_index(std::min(i, j), std::max(i, j), sums.n_channels))];
    return i <= j ? s : std::conj(s);
  };
  std::vector<int> alike;
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    if (outputs_[i].witness == w) alike.push_back(static_cast<int>(i));
  }
  const double share = 1.0 / static_cast<double>(std::max<std::size_t>(1, alike.size()));
  std::vector<Complex> turns;  // phase factors that remove the row delays
  Spectra out;
  for (int k = 0; k < sums.n_bins(); ++k) {
    turns.clear();
    for (const int i : alike) {
      const Output& output = outputs_[static_cast<std::size_t>(i)];
      turns.push_back(share * output.sign *
                      std::polar(1.0, -kTwoPi * k * hz_per_bin_ * (output.delay_s - witness.delay_s)));
    }
    Complex cross = 0.0, mean = 0.0;
    for (std::size_t a = 0; a < alike.size(); ++a) {
      cross += at(k, alike[a], own) * turns[a];
      for (std::size_t b = 0; b < alike.size(); ++b) mean += at(k, alike[a], alike[b]) * turns[a] * std::conj(turns[b]);
    }
    out.own.push_back(at(k, own, own).real());
    out.mean.push_back(mean.real());
    out.in_phase.push_back(cross.real());
    out.out_of_phase.push_back(cross.imag());
  }
  for (auto* values : {&out.own, &out.mean, &out.in_phase, &out.out_of_phase}) *values = smoothed(*values);
  return out;
}

// The gain is the mean of S_mw / S_ww over bins, weighted by the fourth power of their coherence: where it is high,
// both channels contain little but camera motion.
void CameraLeakage::measure(const CpsdSums& sums, int w) {
  if (sums.data_sum.empty()) return;
  Witness& witness = witnesses_[static_cast<std::size_t>(w)];
  const Spectra s = spectra_of(sums, w);
  double weights = 0.0, sum = 0.0;
  for (std::size_t k = 0; k < s.own.size(); ++k) {
    const double power = s.own[k] * s.mean[k];
    if (!(power > 0.0)) continue;
    const double coherence = (s.in_phase[k] * s.in_phase[k] + s.out_of_phase[k] * s.out_of_phase[k]) / power;
    const double weight = std::pow(coherence, 4);
    weights += weight;
    sum += weight * s.in_phase[k] / s.own[k];
  }
  witness.gain = weights > 0.0 ? sum / weights : 0.0;
  std::vector<double> ordered = s.own;
  const auto quiet = ordered.begin() + static_cast<std::ptrdiff_t>(kQuietShare * static_cast<double>(ordered.size()));
  std::nth_element(ordered.begin(), quiet, ordered.end());
  const double noise = kNoiseAboveQuiet * *quiet;
  for (const double power : s.own) witness.certainty.push_back(power > noise ? 1.0 - noise / power : 0.0);
}

Complex CameraLeakage::part(std::size_t output, const std::vector<Complex>& shape, double apparent_hz) const {
  const Output& own = outputs_[output];
  if (own.witness < 0) return 0.0;
  const Witness& witness = witnesses_[static_cast<std::size_t>(own.witness)];
  if (witness.certainty.empty() || !(hz_per_bin_ > 0.0)) return 0.0;
  const auto bin = std::clamp<std::ptrdiff_t>(std::lround(apparent_hz / hz_per_bin_), 0,
                                              static_cast<std::ptrdiff_t>(witness.certainty.size()) - 1);
  const Complex turn = std::polar(own.sign, kTwoPi * apparent_hz * (own.delay_s - witness.delay_s));
  return witness.gain * witness.certainty[static_cast<std::size_t>(bin)] * turn * shape[witness.channel];
}

std::vector<Complex> CameraLeakage::without(const std::vector<Complex>& shape, double apparent_hz, bool leave) const {
  std::vector<Complex> out(shape.begin(), shape.begin() + static_cast<std::ptrdiff_t>(outputs_.size()));
  if (leave) return out;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] -= part(i, shape, apparent_hz);
  return out;
}

CameraLeakage::Finding CameraLeakage::examine(const std::vector<Complex>& shape, double apparent_hz) const {
  const double whole = square(shape, outputs_.size());
  if (!(whole > 0.0)) return {};
  double taken = 0.0;
  for (std::size_t i = 0; i < outputs_.size(); ++i) taken += std::norm(part(i, shape, apparent_hz));
  const double left = square(without(shape, apparent_hz, false), outputs_.size());
  return {std::clamp(1.0 - left / whole, 0.0, 1.0), taken > kNoticeable * whole && left > kMostLeft * whole};
}

}  // namespace core
