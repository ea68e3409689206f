#include "core/closure/observation/free_motions.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/closure/observation/row_spectra.h"

namespace core::closure {
namespace {

using Eigen::Index;

constexpr double kRankTolerance = 1e-9;  // of the largest column
constexpr double kReach_hz = 0.5, kStep_hz = 0.25;
constexpr double kValuesPerCoefficient = 4.0;

Eigen::MatrixXd without_zero_rows(const Eigen::MatrixXd& rows) {
  std::vector<Index> kept;
  for (Index i = 0; i < rows.rows(); ++i) {
    if (!rows.row(i).isZero(0.0)) kept.push_back(i);
  }
  return rows(kept, Eigen::all);
}

// A point of the base; without one, of the structure.
Index point_of_base(const FitView& fit) {
  Index point = -1;
  for (Index j = fit.record.n_points() - 1; j >= 0; --j) {
    const RegionRole role = fit.record.regions[fit.record.region_of_point[static_cast<std::size_t>(j)]].role;
    if (role == RegionRole::kBase) return j;
    if (makes_channel(role)) point = j;
  }
  return point;
}

// Across the axis along which its region is declared to move.
Eigen::Vector2d still_direction(const FitView& fit, Index point) {
  const Region& region = fit.record.regions[fit.record.region_of_point[static_cast<std::size_t>(point)]];
  const double axis = region.axis_deg * std::numbers::pi / 180.0;
  return region.both_axes ? Eigen::Vector2d::Zero() : Eigen::Vector2d(-std::sin(axis), std::cos(axis));
}

// Central first and second difference; zero at the ends.
void append_with_differences(const Eigen::RowVectorXd& cause, Eigen::MatrixXd& columns, Index& at) {
  const Index n = cause.size();
  const Eigen::RowVectorXd centred = cause.array() - cause.mean();
  Eigen::RowVectorXd first = Eigen::RowVectorXd::Zero(n), second = first;
  first.segment(1, n - 2) = 0.5 * (centred.tail(n - 2) - centred.head(n - 2));
  second.segment(1, n - 2) = centred.tail(n - 2) - 2.0 * centred.segment(1, n - 2) + centred.head(n - 2);
  for (const Eigen::RowVectorXd& one : {centred, first, second}) {
    const double norm = one.norm();
    if (norm > 0.0) columns.col(at++) = one.transpose() / norm;
  }
}

}  // namespace

std::optional<FreeMotions> free_motions(const FitView& fit) {
  const PointMotionModel& model = fit.model;
  const Index plane = model.first_plane_row(), background = model.first_background_row();
  if (background < 0) return std::nullopt;
  const Eigen::MatrixXd& rows = model.common_amplitudes();
  FreeMotions out;
  out.rate_hz = fit.record.rate_hz;
  out.structure = without_zero_rows(rows.topRows(plane + 2));
  const Index of_base = point_of_base(fit);
  out.base = model.translation_of_point(of_base);
  out.still = still_direction(fit, of_base);
  out.structure_zoom = rows.row(plane + 2);
  out.background = rows.middleRows(background, 2);
  out.background_zoom = rows.row(background + 2);
  out.background_sigma = {model.sigma_of_column(background), model.sigma_of_column(background + 1)};
  out.background_zoom_sigma = model.sigma_of_column(background + 2);
  out.added = without_zero_rows(rows.bottomRows(rows.rows() - model.n_own()));
  if (!out.background_sigma.allFinite() || !std::isfinite(out.background_zoom_sigma)) return std::nullopt;
  return out;
}

Eigen::RowVectorXd beyond_causes(const Eigen::RowVectorXd& series, const Eigen::MatrixXd& causes) {
  Eigen::MatrixXd columns(series.size(), 3 * causes.rows());
  Index n = 0;
  for (Index i = 0; i < causes.rows(); ++i) append_with_differences(causes.row(i), columns, n);
  columns.conservativeResize(Eigen::NoChange, n);
  const Eigen::VectorXd centred = series.transpose().array() - series.mean();
  if (n == 0) return centred.transpose();
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver;
  solver.setThreshold(kRankTolerance);
  solver.compute(columns);
  const Eigen::VectorXd left = centred - columns * solver.solve(centred);
  return left.transpose().array() - left.mean();
}

Index TaperedSpectra::bin_of(double hz) const noexcept {
  return std::clamp<Index>(static_cast<Index>(std::lround(hz / bin_hz)), 0, bins.cols() - 1);
}

TaperedSpectra tapered_spectra(const Eigen::MatrixXd& series, double rate_hz) {
  const auto n = static_cast<double>(series.cols());
  Eigen::RowVectorXd taper(series.cols());
  for (Index k = 0; k < taper.size(); ++k)
    taper(k) = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (static_cast<double>(k) + 0.5) / n);
  taper *= std::sqrt(n) / taper.norm();
  Eigen::MatrixXd tapered = series.colwise() - series.rowwise().mean();
  tapered.array().rowwise() *= taper.array();
  const int n_fft = row_fft_size(series);
  return {row_spectra(tapered, n_fft, 1.0 / std::sqrt(n)), rate_hz / n_fft, n / n_fft};
}

Eigen::VectorXcd beyond_neighbours(const TaperedSpectra& spectra) {
  const Index n_bins = spectra.bins.cols(), n_causes = spectra.bins.rows() - 1;
  const double wanted = 0.5 * kValuesPerCoefficient * 2.0 * static_cast<double>(n_causes) / spectra.independent;
  const auto reach = static_cast<Index>(std::ceil(std::max(kReach_hz / spectra.bin_hz, wanted)));
  const auto half = std::max<Index>(1, static_cast<Index>(std::lround(0.5 * kStep_hz / spectra.bin_hz)));
  Eigen::VectorXcd out = Eigen::VectorXcd::Zero(n_bins);
  for (Index centre = half + 1; centre + half < n_bins; centre += 2 * half + 1) {
    const Index first = std::max<Index>(1, centre - reach), last = std::min(n_bins - 1, centre + reach);
    const Index n = last - first + 1;
    Eigen::MatrixXcd columns(n, 2 * n_causes);
    for (Index i = 0; i < n_causes; ++i) {
      const Eigen::VectorXcd cause = spectra.bins.row(i + 1).segment(first, n).transpose();
      const double norm = std::max(cause.norm(), 1e-300);
      for (Index k = 0; k < n; ++k) {
        const double place = static_cast<double>(first + k - centre) / static_cast<double>(reach);
        columns(k, 2 * i) = cause(k) / norm, columns(k, 2 * i + 1) = place * cause(k) / norm;
      }
    }
    Eigen::ColPivHouseholderQR<Eigen::MatrixXcd> solver;
    solver.setThreshold(kRankTolerance);
    solver.compute(columns);
    const Eigen::VectorXcd series = spectra.bins.row(0).segment(first, n).transpose();
    const Eigen::VectorXcd left = series - columns * solver.solve(series);
    const double values = spectra.independent * static_cast<double>(n);
    const double freedom = (values - static_cast<double>(solver.rank())) / values;
    out.segment(centre - half, 2 * half + 1) =
        left.segment(centre - half - first, 2 * half + 1) / std::sqrt(std::max(freedom, 0.2));
  }
  return out;
}

double power_gain(double mean, double level, double n) noexcept {
  const double ratio = mean / level;
  return ratio > 1.0 ? n * (ratio - 1.0 - std::log(ratio)) : 0.0;
}

}  // namespace core::closure
