#include "firmware_app/report/plot/spectral_matrix.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "firmware_app/report/plot/spectrum_curves.h"
#include "firmware_app/report/plot/svg_plot.h"

namespace app {
namespace {

constexpr std::size_t kMaxLines = 1'200;
constexpr std::size_t kMaxMatrixChannels = 128;
constexpr std::size_t kMaxCubes = 40'000'000;  // lines x channels^3: about two seconds
constexpr std::size_t kMaxValues = 40'000;     // lines x channels: what the page embeds

std::vector<std::size_t> matrix_channels(const core::CpsdSums& sums, const core::ModalEstimate* estimate) {
  std::vector<std::size_t> out;
  for (std::size_t c = 0; c < static_cast<std::size_t>(sums.n_channels); ++c) {
    if (estimate == nullptr || c >= estimate->channels.size() || estimate->channels[c].takes_part) out.push_back(c);
  }
  return out;
}

std::size_t lines_for(std::size_t n) {
  return std::clamp<std::size_t>(std::min(kMaxCubes / (n * n * n), kMaxValues / n), 2, kMaxLines);
}

Eigen::MatrixXcd matrix_at(const core::CpsdSums& sums, int bin, const std::vector<std::size_t>& channels) {
  const double factor = 1.0 / density_divisor(sums, bin);
  const auto n = static_cast<Eigen::Index>(channels.size());
  Eigen::MatrixXcd out(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = i; j < n; ++j) {
      const int pair =
          core::CpsdSums::pair_index(static_cast<int>(channels[static_cast<std::size_t>(i)]),
                                     static_cast<int>(channels[static_cast<std::size_t>(j)]), sums.n_channels);
      const std::size_t at = static_cast<std::size_t>(bin) * static_cast<std::size_t>(sums.n_pairs());
      out(i, j) = factor * sums.data_sum[at + static_cast<std::size_t>(pair)];
      out(j, i) = std::conj(out(i, j));
    }
  }
  return out;
}

std::vector<std::complex<double>> shape_of(const Eigen::VectorXcd& vector, const std::vector<std::size_t>& channels,
                                           std::size_t n_channels) {
  Eigen::Index largest = 0;
  (void)vector.cwiseAbs().maxCoeff(&largest);
  std::vector<std::complex<double>> out(n_channels, 0.0);
  for (std::size_t i = 0; i < channels.size(); ++i)
    out[channels[i]] = vector[static_cast<Eigen::Index>(i)] / vector[largest];
  return out;
}

std::optional<SpectralLine> line_at(const core::CpsdSums& sums, int bin, const SpectralLines& all) {
  const Eigen::MatrixXcd matrix = matrix_at(sums, bin, all.channels);
  if (!matrix.allFinite()) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd> solver(matrix);
  const double total = solver.eigenvalues().cwiseMax(0.0).sum();
  const Eigen::Index n = matrix.rows();
  if (solver.info() != Eigen::Success || !(total > 0.0) || !std::isfinite(total)) return std::nullopt;
  SpectralLine line;
  line.frequency_hz = bin * sums.rate_hz / sums.n_fft;
  for (std::size_t k = 0; k < all.n_singular; ++k)
    line.singular.push_back(solver.eigenvalues()[n - 1 - static_cast<Eigen::Index>(k)]);
  line.share = line.singular.front() / total;
  line.shape = shape_of(solver.eigenvectors().col(n - 1), all.channels, static_cast<std::size_t>(sums.n_channels));
  return line;
}

}  // namespace

std::size_t SpectralLines::nearest(double frequency_hz) const noexcept {
  const auto at = std::min_element(lines.begin(), lines.end(), [&](const SpectralLine& a, const SpectralLine& b) {
    return std::abs(a.frequency_hz - frequency_hz) < std::abs(b.frequency_hz - frequency_hz);
  });
  return static_cast<std::size_t>(at - lines.begin());
}

SpectralLines spectral_lines(const core::CpsdSums* sums, const core::ModalEstimate* estimate) {
  SpectralLines out;
  if (!is_drawable(sums)) return out;
  out.channels = matrix_channels(*sums, estimate);
  if (out.channels.empty() || out.channels.size() > kMaxMatrixChannels) return out;
  // A matrix made of fewer segments than channels has no further values.
  out.n_singular = std::min({kMaxSingular, out.channels.size(), static_cast<std::size_t>(sums->n_segments)});
  for (const PlotPoint& point : decimated(total_density(*sums), lines_for(out.channels.size()))) {
    const int bin = static_cast<int>(std::lround(point.x * sums->n_fft / sums->rate_hz));
    if (auto line = line_at(*sums, bin, out)) out.lines.push_back(std::move(*line));
  }
  return out;
}

}  // namespace app
