#include "core/closure/observation/point_correlation.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace core::closure {
namespace {

constexpr double kWindow_px = 21.0;  // side of a tracking window
constexpr double kNeighbourhood_px = 40.0;
constexpr double kLeastOwnShare = 0.02;  // of a point's variance: keeps the correlation regular

double overlap(double distance_px) { return std::max(0.0, 1.0 - std::abs(distance_px) / kWindow_px); }

// `of(du, dv)` for all pairs of points.
template <class Of>
Eigen::MatrixXd over_pairs(const Eigen::VectorXd& places_px, const std::vector<Eigen::Index>& rows, const Of& of) {
  const auto n = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd out(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index k = 0; k < n; ++k) {
      const Eigen::Index a = rows[static_cast<std::size_t>(i)] / 2, b = rows[static_cast<std::size_t>(k)] / 2;
      out(i, k) = of(places_px(2 * a) - places_px(2 * b), places_px(2 * a + 1) - places_px(2 * b + 1));
    }
  }
  return out;
}

}  // namespace

std::vector<std::vector<Eigen::Index>> rows_by_region(const std::vector<std::size_t>& region_of_point) {
  std::size_t n_regions = 0;
  for (const std::size_t region : region_of_point) n_regions = std::max(n_regions, region + 1);
  std::vector<std::vector<Eigen::Index>> out(2 * n_regions);
  for (std::size_t j = 0; j < region_of_point.size(); ++j) {
    const auto at = static_cast<Eigen::Index>(2 * j);
    out[2 * region_of_point[j]].push_back(at);
    out[2 * region_of_point[j] + 1].push_back(at + 1);
  }
  std::erase_if(out, [](const auto& rows) { return rows.empty(); });
  return out;
}

Eigen::MatrixXd window_overlap(const Eigen::VectorXd& places_px, const std::vector<Eigen::Index>& rows) {
  return over_pairs(places_px, rows, [](double du, double dv) { return overlap(du) * overlap(dv); });
}

Eigen::MatrixXd neighbourhood(const Eigen::VectorXd& places_px, const std::vector<Eigen::Index>& rows) {
  return over_pairs(places_px, rows,
                    [](double du, double dv) { return std::exp(-std::hypot(du, dv) / kNeighbourhood_px); });
}

PointCorrelation::PointCorrelation(const CorrelationShares& shares, const std::vector<std::size_t>& region_of_point,
                                   const Eigen::VectorXd& places_px)
    : shares_(shares) {
  for (std::vector<Eigen::Index>& rows : rows_by_region(region_of_point)) {
    const Eigen::Index axis = rows.front() % 2, n = static_cast<Eigen::Index>(rows.size());
    const double common = axis == 0 ? shares.region_u : shares.region_v;
    if (n < 2 || !(shares.along(axis) > 0.0)) continue;
    Eigen::MatrixXd correlation = shares.window * window_overlap(places_px, rows) +
                                  shares.neighbourhood * neighbourhood(places_px, rows) +
                                  Eigen::MatrixXd::Constant(n, n, common);
    correlation.diagonal().array() += std::max(1.0 - shares.along(axis), kLeastOwnShare);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlation);
    blocks_.push_back({std::move(rows), solver.operatorSqrt(), solver.operatorInverseSqrt()});
  }
}

}  // namespace core::closure
