#include "core/closure/observation/frame_shift.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <vector>

#include "core/spectrum/real_fft.h"

namespace core::closure {
namespace {

using Complex = std::complex<double>;

constexpr int kLeastBridge = 64;           // smallest number of frames that blend the record's end into its beginning
constexpr int kSmooth = 12;                // a spectrum is averaged over so many bins on either side
constexpr double kLeastSignalPower = 1.5;  // smallest power of a signal, in noise variances

// One series made periodic, and its spectrum.
class Periodic {
 public:
  Periodic(Eigen::Index n, int n_fft)
      : n_(static_cast<std::size_t>(n)),
        fft_(n_fft),
        series_(static_cast<std::size_t>(n_fft)),
        bins_(static_cast<std::size_t>(fft_.n_bins())) {
    const std::size_t bridge = series_.size() - n_;
    share_after_.reserve(bridge);
    for (std::size_t i = 1; i <= bridge; ++i) {
      const double along = static_cast<double>(i) / static_cast<double>(bridge + 1);
      share_after_.push_back(0.5 + 0.5 * std::cos(std::numbers::pi * along));
    }
  }

  [[nodiscard]] std::vector<Complex>& bins() noexcept { return bins_; }

  void forward(const Eigen::MatrixXd& from, Eigen::Index row) {
    for (std::size_t k = 0; k < n_; ++k) series_[k] = from(row, static_cast<Eigen::Index>(k));
    const std::size_t bridge = share_after_.size(), last = n_ - 1;
    for (std::size_t i = 1; i <= bridge; ++i) {
      const double after = 2.0 * series_[last] - series_[i < last ? last - i : 0];
      const double before = 2.0 * series_[0] - series_[std::min(bridge + 1 - i, last)];
      const double share = share_after_[i - 1];
      series_[last + i] = share * after + (1.0 - share) * before;
    }
    fft_.forward(series_, bins_);
  }

  void inverse(Eigen::MatrixXd& to, Eigen::Index row) {
    fft_.inverse(bins_, series_);
    for (std::size_t k = 0; k < n_; ++k) to(row, static_cast<Eigen::Index>(k)) = series_[k];
  }

 private:
  std::size_t n_;
  RealFft fft_;
  std::vector<double> series_;
  std::vector<double> share_after_;  // of what follows the record, in the frames that blend its end into its beginning
  std::vector<Complex> bins_;
};

// Wiener gain per bin: 1 - noise / power of the averaged periodogram.
std::vector<double> wiener_gain(const std::vector<Complex>& bins, double noise_power) {
  const auto n = static_cast<int>(bins.size());
  std::vector<double> sum(bins.size() + 1, 0.0), gain(bins.size(), 0.0);
  for (std::size_t k = 0; k < bins.size(); ++k) sum[k + 1] = sum[k] + std::norm(bins[k]);
  for (int k = 0; k < n; ++k) {
    const int from = std::max(k - kSmooth, 0), to = std::min(k + kSmooth + 1, n);
    const double power = (sum[static_cast<std::size_t>(to)] - sum[static_cast<std::size_t>(from)]) / (to - from);
    if (power > kLeastSignalPower * noise_power) gain[static_cast<std::size_t>(k)] = 1.0 - noise_power / power;
  }
  return gain;
}

}  // namespace

FrameShift::FrameShift(Eigen::Index n_frames)
    : n_frames_(n_frames), n_fft_(next_power_of_two(static_cast<int>(n_frames) + kLeastBridge)) {}

void FrameShift::advance(Eigen::MatrixXd& series, const Eigen::VectorXd& frames) const {
  Periodic periodic(n_frames_, n_fft_);
  std::vector<Complex>& bins = periodic.bins();
  for (Eigen::Index row = 0; row < series.rows(); ++row) {
    if (frames(row) == 0.0) continue;
    periodic.forward(series, row);
    const Complex step = std::polar(1.0, 2.0 * std::numbers::pi * frames(row) / n_fft_);
    Complex turn = 1.0;
    for (std::size_t k = 0; k + 1 < bins.size(); ++k, turn *= step) bins[k] *= turn;
    bins.back() *= turn.real();  // the bin at half the rate has no phase
    periodic.inverse(series, row);
  }
}

Eigen::MatrixXd FrameShift::signal_rates(const Eigen::MatrixXd& series, double noise_variance) const {
  Eigen::MatrixXd out(series.rows(), series.cols());
  Periodic periodic(n_frames_, n_fft_);
  std::vector<Complex>& bins = periodic.bins();
  for (Eigen::Index row = 0; row < series.rows(); ++row) {
    periodic.forward(series, row);
    const std::vector<double> gain = wiener_gain(bins, noise_variance * n_fft_);
    for (std::size_t k = 0; k < bins.size(); ++k)
      bins[k] *= Complex(0.0, gain[k] * 2.0 * std::numbers::pi * static_cast<double>(k) / n_fft_);
    bins.back() = 0.0;
    periodic.inverse(out, row);
  }
  return out;
}

Eigen::MatrixXcd FrameShift::spectra(const Eigen::MatrixXd& series) const {
  Periodic periodic(n_frames_, n_fft_);
  Eigen::MatrixXcd out(series.rows(), static_cast<Eigen::Index>(periodic.bins().size()));
  for (Eigen::Index row = 0; row < out.rows(); ++row) {
    periodic.forward(series, row);
    for (Eigen::Index k = 0; k < out.cols(); ++k) out(row, k) = periodic.bins()[static_cast<std::size_t>(k)];
  }
  return out;
}

Eigen::MatrixXd FrameShift::series(const Eigen::MatrixXcd& spectra) const {
  Periodic periodic(n_frames_, n_fft_);
  Eigen::MatrixXd out(spectra.rows(), n_frames_);
  for (Eigen::Index row = 0; row < out.rows(); ++row) {
    for (Eigen::Index k = 0; k < spectra.cols(); ++k) periodic.bins()[static_cast<std::size_t>(k)] = spectra(row, k);
    periodic.inverse(out, row);
  }
  return out;
}

}  // namespace core::closure
