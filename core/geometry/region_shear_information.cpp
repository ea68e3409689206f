// RegionShear: covariances of carriers and shears from the keyframe's points, computed once.
#include <Eigen/Dense>

#include "core/geometry/region_shear.h"

namespace core {

// Covariance of the unknowns of usable regions (six each, in order; zero elsewhere), pitch and yaw last.
Eigen::MatrixXd RegionShear::covariance() const {
  using Eigen::Index;
  const auto n = static_cast<Index>(kOwn * regions_.size() + 2), own = static_cast<Index>(kOwn);
  Eigen::MatrixXd normal = Eigen::MatrixXd::Identity(n, n);
  normal.bottomRightCorner<2, 2>() /= kMostTurn * kMostTurn;
  for (std::size_t r = 0; r < regions_.size(); ++r) {
    if (!regions_[r].usable) continue;
    const auto place = [&](Index c) { return c < own ? own * static_cast<Index>(r) + c : n - 2 + c - own; };
    const Normal& part = regions_[r].normal;
    for (Index a = 0; a < static_cast<Index>(kAll); ++a) {
      for (Index b = a; b < static_cast<Index>(kAll); ++b) {
        const double value = part[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)];
        if (a < own && b < own && place(a) == place(b))
          normal(place(a), place(a)) = value;
        else {
          normal(place(a), place(b)) += value;
          if (a != b) normal(place(b), place(a)) += value;
        }
      }
    }
  }
  Eigen::MatrixXd inverse = normal.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
  for (std::size_t r = 0; r < regions_.size(); ++r) {
    if (regions_[r].usable) continue;
    inverse.middleRows(own * static_cast<Index>(r), own).setZero();
    inverse.middleCols(own * static_cast<Index>(r), own).setZero();
  }
  return inverse;
}

// Rows of unknowns `from`, `from` + 1 of every region, scaled to pixels.
Eigen::MatrixXd RegionShear::selection(std::size_t from) const {
  using Eigen::Index;
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(static_cast<Index>(kAxes * regions_.size()),
                                               static_cast<Index>(kOwn * regions_.size() + 2));
  for (std::size_t r = 0; r < regions_.size(); ++r) {
    const double scale = from == kShear ? 1.0 / regions_[r].fraction_scale : 1.0;
    for (std::size_t a = 0; a < kAxes; ++a)
      rows(static_cast<Index>(kAxes * r + a), static_cast<Index>(kOwn * r + from + a)) = scale;
  }
  return rows;
}

void RegionShear::make_information() {
  using Eigen::Index;
  const Eigen::MatrixXd all = covariance();
  const Eigen::MatrixXd shear = selection(kShear);
  const auto n_fields = static_cast<Index>(fields_.size());
  Eigen::MatrixXd fields = Eigen::MatrixXd::Zero(n_fields, all.cols());
  fields.topRows(shear.rows()) = selection(kTurn);
  fields.bottomRightCorner<2, 2>().setIdentity();
  carrier_ = Eigen::MatrixXd::Zero(shear.rows(), n_fields);
  for (std::size_t r = 0; r < regions_.size(); ++r) {
    if (!regions_[r].usable) continue;
    for (std::size_t f = 0; f < 2; ++f) {
      carrier_.col(static_cast<Index>(2 * r + f)) = shear * all * field_response(r, kTurn + f);
      carrier_.col(n_fields - 2 + static_cast<Index>(f)) += shear * all * field_response(r, kOwn + f);
    }
  }
  const Eigen::MatrixXd carrier = selection(0) + carrier_ * fields;
  carrier_covariance_ = carrier * all * carrier.transpose();
  Eigen::MatrixXd scatter = shear * all * shear.transpose();
  for (Index c = 0; c < scatter.rows(); ++c) {
    if (!regions_[static_cast<std::size_t>(c) / kAxes].usable) scatter(c, c) = 1.0;
  }
  information_ = scatter.ldlt().solve(Eigen::MatrixXd::Identity(scatter.rows(), scatter.cols()));
  for (Index c = 0; c < scatter.rows(); ++c) {
    if (regions_[static_cast<std::size_t>(c) / kAxes].tells) continue;
    information_.row(c).setZero();
    information_.col(c).setZero();
  }
}

// Right-hand side of the normal equations if the points of one region are shifted by their readout fraction times the
// field of one unknown of unit size.
Eigen::VectorXd RegionShear::field_response(std::size_t region, std::size_t unknown) const {
  using Eigen::Index;
  const RegionFit& own = regions_[region];
  Normal normal{};
  for (const std::size_t j : own.points) {
    const Point& point = points_[j];
    const double fraction = own.mean_fraction + point.column[0][kShear] * own.fraction_scale;
    add_point(point, {fraction * point.column[0][unknown], fraction * point.column[1][unknown]}, normal);
  }
  const auto n = static_cast<Index>(kOwn * regions_.size() + 2);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  for (std::size_t c = 0; c < kAll; ++c) {
    right(c < kOwn ? static_cast<Index>(kOwn * region + c) : n - 2 + static_cast<Index>(c - kOwn)) = normal[c][kAll];
  }
  return right;
}

}  // namespace core
