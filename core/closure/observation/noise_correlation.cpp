#include "core/closure/observation/noise_correlation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "core/closure/observation/row_spectra.h"
#include "core/linear/dense.h"
#include "core/linear/median.h"

namespace core::closure {
namespace {

using Index = Eigen::Index;

constexpr std::size_t kBands = 8;
constexpr int kDescents = 200;
constexpr double kLeastSeen = 0.05;   // of a kind's squares that the fit must leave
constexpr double kLeastShare = 0.05;  // of the variance: independent noise seems to have less

enum Kind : Index { kOwn, kWindow, kNeighbourhood, kRegionU, kRegionV, kKinds };
using Shares = Eigen::Matrix<double, kKinds, 1>;
using Normal = Eigen::Matrix<double, kKinds, kKinds>;

// Covariance between the points of one region and axis, by kind of noise: what the fit leaves of noise with unit share.
struct Expected {
  std::vector<Index> rows;
  std::array<Eigen::MatrixXd, kKinds> of_kind;
};

Eigen::MatrixXd of_kind(Kind kind, const Eigen::VectorXd& places_px, const std::vector<Index>& rows) {
  const auto n = static_cast<Index>(rows.size());
  const Index axis = rows.front() % 2;
  switch (kind) {
    case kOwn:
      return Eigen::MatrixXd::Identity(n, n);
    case kWindow:
      return window_overlap(places_px, rows);
    case kNeighbourhood:
      return neighbourhood(places_px, rows);
    case kRegionU:
      return Eigen::MatrixXd::Constant(n, n, axis == 0 ? 1.0 : 0.0);
    default:
      return Eigen::MatrixXd::Constant(n, n, axis == 1 ? 1.0 : 0.0);
  }
}

std::vector<Expected> expected(const Eigen::MatrixXd& removal, const std::vector<std::vector<Index>>& groups,
                               const Eigen::VectorXd& places_px) {
  std::vector<Expected> out;
  for (const auto& rows : groups) out.push_back({rows, {}});
  for (Index kind = 0; kind < kKinds; ++kind) {
    Eigen::MatrixXd coloured = Eigen::MatrixXd::Zero(removal.rows(), removal.cols());  // removal x covariance
    for (const auto& rows : groups) {
      const Eigen::MatrixXd of_rows = removal(Eigen::all, rows);
      coloured(Eigen::all, rows) = of_rows * of_kind(static_cast<Kind>(kind), places_px, rows);
    }
    for (Expected& e : out) {
      const Eigen::MatrixXd left = removal(e.rows, Eigen::all), right = coloured(e.rows, Eigen::all);
      e.of_kind[static_cast<std::size_t>(kind)] = right * left.transpose();
    }
  }
  return out;
}

// Least squares with shares that are not negative, by descent along one share after the other.
Shares fitted(const Normal& normal, const Shares& whole, const Shares& right) {
  Shares out = Shares::Zero();
  for (int step = 0; step < kDescents; ++step) {
    for (Index i = 0; i < kKinds; ++i) {
      if (!(normal(i, i) > kLeastSeen * whole(i))) continue;
      const double gradient = right(i) - normal.row(i).dot(out);
      out(i) = std::max(0.0, out(i) + gradient / normal(i, i));
    }
  }
  return out;
}

}  // namespace

CorrelationShares noise_correlation(const Eigen::MatrixXd& residual, const Eigen::MatrixXd& removal,
                                    const std::vector<std::size_t>& region_of_point, const Eigen::VectorXd& places_px,
                                    double rate_hz, double from_hz) {
  const std::vector<Expected> model = expected(removal, rows_by_region(region_of_point), places_px);
  Normal normal = Normal::Zero();
  Shares whole = Shares::Zero();  // squares of each kind before the fit
  for (const Expected& e : model) {
    for (std::size_t i = 0; i < kKinds; ++i) {
      whole(static_cast<Index>(i)) += of_kind(static_cast<Kind>(i), places_px, e.rows).squaredNorm();
      for (std::size_t k = 0; k < kKinds; ++k)
        normal(static_cast<Index>(i), static_cast<Index>(k)) += e.of_kind[i].cwiseProduct(e.of_kind[k]).sum();
    }
  }
  const Eigen::MatrixXcd bins = row_spectra(residual, row_fft_size(residual));
  const auto first = std::clamp<Index>(
      static_cast<Index>(std::ceil(2.0 * from_hz / rate_hz * static_cast<double>(bins.cols()))), 1, bins.cols() / 2);
  const Index in_band = (bins.cols() - first) / static_cast<Index>(kBands);
  if (in_band < 1) return {};
  std::array<std::vector<double>, kKinds> shares;
  for (Index band = 0; band < static_cast<Index>(kBands); ++band) {
    const Eigen::MatrixXcd part = bins.middleCols(first + band * in_band, in_band);
    Shares right = Shares::Zero();
    for (const Expected& e : model) {
      const Eigen::MatrixXcd of_rows = part(e.rows, Eigen::all);
      const Eigen::MatrixXd seen = gram(of_rows.real()) + gram(of_rows.imag());
      for (std::size_t i = 0; i < kKinds; ++i) right(static_cast<Index>(i)) += e.of_kind[i].cwiseProduct(seen).sum();
    }
    const Shares of_band = fitted(normal, whole, right);
    // The two shares of a whole region exist along one axis each.
    const double u = of_band.head<3>().sum() + of_band(kRegionU), v = of_band.head<3>().sum() + of_band(kRegionV);
    if (!(u > 0.0) || !(v > 0.0)) continue;
    const double both = 0.5 * (u + v);
    for (Index i = 0; i < kKinds; ++i)
      shares[static_cast<std::size_t>(i)].push_back(of_band(i) / (i == kRegionU ? u : i == kRegionV ? v : both));
  }
  if (shares[kOwn].empty()) return {};
  const auto share_of = [&](Kind kind) {
    const double share = median(shares[static_cast<std::size_t>(kind)]);
    return share < kLeastShare ? 0.0 : share;
  };
  // Medians need not add up to the variance: the shares are those of their sum, of the axis with the larger one.
  CorrelationShares out{share_of(kWindow), share_of(kNeighbourhood), share_of(kRegionU), share_of(kRegionV)};
  const double sum = share_of(kOwn) + std::max(out.along(0), out.along(1));
  if (!(sum > 1.0)) return out;
  return {out.window / sum, out.neighbourhood / sum, out.region_u / sum, out.region_v / sum};
}

}  // namespace core::closure
