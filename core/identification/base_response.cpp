#include "core/identification/base_response.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/identification/spectral_peaks.h"
#include "core/types/constants.h"

namespace core {

namespace {

using Complex = std::complex<double>;

constexpr double kSideStep = 0.1;      // relative
constexpr double kWidths = 6.0;        // of the fit, in half-power widths to either side
constexpr double kLobe = 0.7;          // half-power width of the window's own line, in units of the resolution
constexpr double kIndependent = 1.5;   // resolutions between independent values of a Hann-windowed spectrum
constexpr double kLeastBeside = 0.01;  // the fitted spectrum beside a peak is at least this share of it
constexpr double kLeastSteady = 0.65;  // share of the record that the base's power fills

class BaseSpectra {
 public:
  BaseSpectra(const CpsdSums& sums, const std::vector<ChannelInfo>& channels, int base)
      : sums_(sums), channels_(channels), base_(base) {}

  struct Largest {
    double gain = 0.0, coherence = 0.0;
  };
  // Over the channels; sums of three bins, because a Hann window spreads a line over three.
  [[nodiscard]] Largest largest(double frequency_hz) const {
    const int centre = std::clamp(bin_of(frequency_hz), 1, sums_.n_bins() - 2);
    Largest out;
    for (int r = 0; r < sums_.n_channels; ++r) {
      if (!is_response(r)) continue;
      Complex cross = 0.0;
      double base = 0.0, own = 0.0;
      for (int k = centre - 1; k <= centre + 1; ++k) {
        cross += at(k, r, base_);
        base += at(k, base_, base_).real();
        own += at(k, r, r).real();
      }
      if (!(base > 0.0 && own > 0.0)) continue;
      out.gain = std::max(out.gain, std::abs(cross) / base);
      out.coherence = std::max(out.coherence, std::norm(cross) / (base * own));
    }
    return out;
  }

  void fit_resonance(double frequency_hz, double damping_ratio, BaseResponse& out) const {
    const double resolution = resolution_hz(sums_);
    const double half_width = std::max(std::abs(damping_ratio) * frequency_hz, kLobe * resolution);
    const int first = std::max(2, bin_of(frequency_hz - kWidths * half_width));
    const int last = std::min(sums_.n_bins() - 2, bin_of(frequency_hz + kWidths * half_width));
    const double n_independent = (last - first + 1) * hz_per_bin() / (kIndependent * resolution);
    if (!(n_independent > 4.0)) return;  // three unknowns
    fit_base({frequency_hz, half_width, first, last, n_independent}, out);
    for (int r = 0; r < sums_.n_channels; ++r) {
      if (is_response(r)) fit_channel(r, {frequency_hz, half_width, first, last, n_independent}, out);
    }
  }

 private:
  struct Band {
    double frequency_hz, half_width;
    int first, last;
    double n_independent;
  };

  [[nodiscard]] double hz_per_bin() const noexcept { return sums_.rate_hz / sums_.n_fft; }
  [[nodiscard]] int bin_of(double hz) const { return static_cast<int>(std::lround(hz / hz_per_bin())); }
  [[nodiscard]] const ChannelInfo& channel(int c) const { return channels_[static_cast<std::size_t>(c)]; }
  [[nodiscard]] bool is_response(int r) const { return !channel(r).is_base && !channel(r).is_witness; }

  // H of a channel that moves as the base does.
  [[nodiscard]] Complex rigid(int r, double frequency_hz) const {
    const ChannelInfo &own = channel(r), &base = channel(base_);
    const double same = own.direction_u * base.direction_u + own.direction_v * base.direction_v;
    return same * std::pow(Complex(0.0, kTwoPi * frequency_hz), own.n_integrations - base.n_integrations);
  }

  // Complex weighted least squares of H_r on a line and on the resonance curve 1 / (1 + i x), x in half-widths. A bin
  // weighs by the inverse variance of H_r, (1 - coherence) S_rr / S_bb.
  void fit_channel(int r, const Band& band, BaseResponse& out) const {
    Eigen::Matrix3cd normal = Eigen::Matrix3cd::Zero();
    Eigen::Vector3cd right = Eigen::Vector3cd::Zero();
    double squares = 0.0;
    for (int k = band.first; k <= band.last; ++k) {
      const double base = at(k, base_, base_).real(), own = at(k, r, r).real();
      const Complex cross = at(k, r, base_);
      const double left = own - std::norm(cross) / base;
      if (!(base > 0.0 && left > 1e-9 * own)) continue;
      const double x = (k * hz_per_bin() - band.frequency_hz) / band.half_width, weight = base / left;
      const Eigen::Vector3cd row(1.0, x, 1.0 / Complex(1.0, x));
      normal += weight * row.conjugate() * row.transpose();
      right += weight * row.conjugate() * (cross / base);
      squares += weight * std::norm(cross / base);
    }
    const Eigen::FullPivLU<Eigen::Matrix3cd> lu(normal);
    if (!lu.isInvertible()) return;
    const Eigen::Vector3cd fit = lu.solve(right);
    const double unexplained = std::max(0.0, squares - fit.dot(right).real()) / (band.n_independent - 3.0);
    const double sigma = std::sqrt(lu.inverse()(2, 2).real() * unexplained);
    if (!std::isfinite(sigma) || !(sigma > 0.0) || !(std::abs(fit[2]) * out.resonance_sigma >= out.resonance * sigma))
      return;
    const Complex rest = fit[0] - rigid(r, band.frequency_hz);
    out.resonance = std::abs(fit[2]), out.resonance_sigma = sigma;
    out.relative = std::abs(rest + fit[2]), out.relative_without = std::abs(rest);
  }

  void fit_base(const Band& band, BaseResponse& out) const {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    double squares = 0.0;
    for (int k = band.first; k <= band.last; ++k) {
      const double power = at(k, base_, base_).real();
      if (!(power > 0.0)) continue;
      const double x = (k * hz_per_bin() - band.frequency_hz) / band.half_width, weight = 1.0 / (power * power);
      const Eigen::Vector3d row(1.0, x, 1.0 / (1.0 + x * x));
      normal += weight * row * row.transpose();
      right += weight * row * power;
      squares += 1.0;
    }
    const Eigen::FullPivLU<Eigen::Matrix3d> lu(normal);
    if (!lu.isInvertible()) return;
    const Eigen::Vector3d fit = lu.solve(right);
    const double unexplained = std::max(0.0, squares - fit.dot(right)) / (band.n_independent - 3.0);
    const double beside = std::max(fit[0], kLeastBeside * std::abs(fit[2]));
    out.base_peak = beside > 0.0 ? fit[2] / beside : 0.0;
    out.base_peak_sigma = beside > 0.0 ? std::sqrt(lu.inverse()(2, 2) * unexplained) / beside : 0.0;
    out.base_is_known = beside > 0.0 && filled_share(band) >= kLeastSteady;
  }

  // Share of the record that the base's power within the band fills: (mean power)^2 / mean of the squared power of a
  // segment, over the blocks. 1 for a steady input, and where blocks are not kept.
  [[nodiscard]] double filled_share(const Band& band) const {
    double n = 0.0, sum = 0.0, squares = 0.0;
    for (std::size_t b = 0; b < sums_.n_blocks; ++b) {
      const CpsdBlock& block = sums_.blocks[b];
      if (block.n_segments == 0) continue;
      double power = 0.0;
      for (int k = band.first; k <= band.last; ++k) power += block.data_sum[index(k, base_, base_)].real();
      n += static_cast<double>(block.n_segments), sum += power;
      squares += power * power / static_cast<double>(block.n_segments);
    }
    return squares > 0.0 ? sum * sum / (n * squares) : 1.0;
  }

  [[nodiscard]] std::size_t index(int bin, int i, int j) const {
    return static_cast<std::size_t>(bin) * static_cast<std::size_t>(sums_.n_pairs()) +
           static_cast<std::size_t>(CpsdSums::pair_index(std::min(i, j), std::max(i, j), sums_.n_channels));
  }
  [[nodiscard]] Complex at(int bin, int i, int j) const {
    const Complex value = sums_.data_sum[index(bin, i, j)];
    return i > j ? std::conj(value) : value;
  }

  const CpsdSums& sums_;
  const std::vector<ChannelInfo>& channels_;
  int base_;
};

}  // namespace

BaseResponse base_response(const CpsdSums& sums, const std::vector<ChannelInfo>& channels, double frequency_hz,
                           double damping_ratio) {
  const auto base = std::find_if(channels.begin(), channels.end(), [](const ChannelInfo& c) { return c.is_base; });
  if (base == channels.end()) return {};
  const BaseSpectra spectra(sums, channels, static_cast<int>(base - channels.begin()));
  const auto here = spectra.largest(frequency_hz);
  BaseResponse out;
  out.gain = here.gain, out.coherence = here.coherence;
  out.gain_beside = std::max(spectra.largest(frequency_hz * (1.0 - kSideStep)).gain,
                             spectra.largest(frequency_hz * (1.0 + kSideStep)).gain);
  spectra.fit_resonance(frequency_hz, damping_ratio, out);
  return out;
}

}  // namespace core
