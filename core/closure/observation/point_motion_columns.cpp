// PointMotionModel: positions of the points and columns of the model.
#include <cmath>
#include <numbers>

#include "core/closure/observation/point_motion_model.h"

namespace core::closure {
namespace {

constexpr double kParallel_deg = 2.0;

double mean_seen(const Eigen::MatrixXd& values, Eigen::Index j) {
  double sum = 0.0;
  Eigen::Index n = 0;
  for (Eigen::Index k = 0; k < values.rows(); ++k) {
    if (std::isnan(values(k, j))) continue;
    sum += values(k, j);
    ++n;
  }
  return n > 0 ? sum / static_cast<double>(n) : 0.0;
}

// Mean of the regions' axes. Axes that differ by less than the precision of their declaration are taken as parallel;
// otherwise a camera translation would be a tiny difference of large motions.
double common_axis_deg(const ObservationRecord& record) {
  double sum = 0.0, n = 0.0;
  for (const Region& region : record.regions) {
    if (makes_channel(region.role) && !region.both_axes) sum += region.axis_deg, n += 1.0;
  }
  return n > 0.0 ? sum / n : 0.0;
}

}  // namespace

PointGeometry point_geometry(const ObservationRecord& record) {
  const Eigen::Index n = record.n_points();
  PointGeometry geometry{record.alpha_px, Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n)};
  for (Eigen::Index j = 0; j < n; ++j) {
    const double u = mean_seen(record.u_px, j), v = mean_seen(record.v_px, j);
    geometry.x(j) = (u - record.cx_px) / record.alpha_px;
    geometry.y(j) = (v - record.cy_px) / record.alpha_px;
    geometry.share(j) =
        record.raw_share.empty() ? record.readout_share(u, v) : record.raw_share[static_cast<std::size_t>(j)];
  }
  return geometry;
}

Eigen::MatrixXd later_in_readout(const ObservationRecord& record, const Eigen::MatrixXd& positions) {
  Eigen::MatrixXd later(record.n_points(), record.n_frames());
  for (Eigen::Index j = 0; j < later.rows(); ++j) {
    for (Eigen::Index k = 0; k < later.cols(); ++k)
      later(j, k) = record.readout_share(positions(2 * j, k), positions(2 * j + 1, k));
    later.row(j).array() -= later.row(j).mean();
  }
  return later;
}

void PointMotionModel::add_region_columns(const ObservationRecord& record) {
  const double common_deg = common_axis_deg(record);
  for (std::size_t r = 0; r < record.regions.size(); ++r) {
    const Region& region = record.regions[r];
    if (!makes_channel(region.role)) continue;
    const double axis_deg = std::abs(region.axis_deg - common_deg) < kParallel_deg ? common_deg : region.axis_deg;
    const double angle = region.both_axes ? 0.0 : axis_deg * std::numbers::pi / 180.0;
    for (int axis = 0; axis < (region.both_axes ? 2 : 1); ++axis) {
      Eigen::VectorXd field = Eigen::VectorXd::Zero(weight_.size());
      const double turn = angle + axis * 0.5 * std::numbers::pi;
      for (Eigen::Index j = 0; j < record.n_points(); ++j) {
        if (record.region_of_point[static_cast<std::size_t>(j)] == r)
          field.segment<2>(2 * j) = Eigen::Vector2d(std::cos(turn), std::sin(turn));
      }
      if (field.squaredNorm() == 0.0) continue;
      region_row_[2 * r + static_cast<std::size_t>(axis)] = static_cast<Eigen::Index>(own_.size());
      own_.push_back(field);
    }
  }
}

void PointMotionModel::add_plane_columns(const ObservationRecord& record) {
  zoom_row_of_point_.assign(static_cast<std::size_t>(record.n_points()), -1);
  for (const bool background : {false, true}) {
    Eigen::VectorXd along = Eigen::VectorXd::Zero(weight_.size()), across = along, zoom = along;
    for (Eigen::Index j = 0; j < record.n_points(); ++j) {
      const Region& region = record.regions[record.region_of_point[static_cast<std::size_t>(j)]];
      if ((region.role == RegionRole::kBackground) != background) continue;
      along(2 * j) = across(2 * j + 1) = 1.0;
      zoom.segment<2>(2 * j) = geometry_.alpha_px * Eigen::Vector2d(geometry_.x(j), geometry_.y(j));
    }
    for (const Eigen::VectorXd& field : {along, across, zoom}) {
      if (field.squaredNorm() > 0.0) own_.push_back(field);
    }
    if (!(zoom.squaredNorm() > 0.0)) continue;
    for (Eigen::Index j = 0; j < record.n_points(); ++j) {
      if (along(2 * j) > 0.0)
        zoom_row_of_point_[static_cast<std::size_t>(j)] = static_cast<Eigen::Index>(own_.size()) - 1;
    }
  }
}

}  // namespace core::closure
