#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/types/frame.h"
#include "core/types/region.h"

namespace core::closure {

// Tracks of one record in the form used by the observation level, and the operator's declarations. Plain data. Frames
// are on an even grid: a lost frame is a row of NaN.
struct ObservationRecord {
  double rate_hz = 0.0;
  double alpha_px = 0.0;  // focal length
  double cx_px = 0.0, cy_px = 0.0;
  int width_px = 0, height_px = 0;
  double readout_frames = 0.0;  // declared readout time x frame rate, first to last line as the direction runs; signed
  ReadoutDirection readout_direction = ReadoutDirection::kDown;
  std::vector<Region> regions;
  std::vector<std::size_t> region_of_point;
  std::vector<double> sigma_px;   // per point and axis
  std::vector<double> raw_share;  // per point, its readout fraction; empty: computed from its position
  Eigen::MatrixXd u_px, v_px;     // frames x points; NaN = missing

  [[nodiscard]] Eigen::Index n_frames() const noexcept { return u_px.rows(); }
  [[nodiscard]] Eigen::Index n_points() const noexcept { return static_cast<Eigen::Index>(region_of_point.size()); }
  // Readout fraction of a pixel (core/geometry/rolling_shutter.h).
  [[nodiscard]] double readout_share(double u, double v) const noexcept;
};

struct RecordCheck {
  std::vector<std::string> faults;    // reasons why the record cannot be used
  std::vector<std::string> warnings;  // conclusions that the record does not support, and those that it still does
  std::vector<Eigen::Index> points;   // usable ones, ascending
};

// Never throws. Points are excluded if more than a fifth of their frames is missing, or if all values are NaN or out of
// range.
[[nodiscard]] RecordCheck check_record(const ObservationRecord& record);

// The record with these points only, ascending.
[[nodiscard]] ObservationRecord select_points(ObservationRecord record, const std::vector<Eigen::Index>& points);

}  // namespace core::closure
