#include "core/closure/observation/observation_record.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/geometry/rolling_shutter.h"

namespace core::closure {
namespace {

constexpr double kMostMissing = 0.2;    // largest share of a point's frames
constexpr double kLeastSeconds = 20.0;  // shortest record: ten blocks of two seconds
constexpr Eigen::Index kLeastPoints = 8;
constexpr double kLeastSpread = 0.02;  // smallest ratio of the singular values of the points' positions

std::string number(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (!text.empty() && text.back() == '.') text.pop_back();
  return text;
}

bool positive(double value) { return std::isfinite(value) && value > 0.0; }

void check_declared(const ObservationRecord& r, std::vector<std::string>& faults) {
  if (!positive(r.rate_hz)) faults.push_back("frame rate " + number(r.rate_hz) + ": must be positive, in Hz");
  if (!positive(r.alpha_px)) faults.push_back("focal length " + number(r.alpha_px) + " px: must be positive");
  if (!std::isfinite(r.cx_px) || !std::isfinite(r.cy_px)) faults.emplace_back("principal point: not a number");
  if (r.width_px <= 0 || r.height_px <= 0) faults.emplace_back("image size: width and height must be positive");
  constexpr double kRounding = 1e-3;  // relative rounding of times in ms and of rates with few digits
  if (!std::isfinite(r.readout_frames) || std::abs(r.readout_frames) > 1.0 + kRounding)
    faults.push_back("readout of " + number(r.readout_frames) + " frames: must lie between -1 and 1");
  const auto n = static_cast<std::size_t>(r.u_px.cols());
  if (r.v_px.rows() != r.u_px.rows() || r.v_px.cols() != r.u_px.cols() || r.region_of_point.size() != n ||
      r.sigma_px.size() != n || (!r.raw_share.empty() && r.raw_share.size() != n))
    faults.emplace_back("inconsistent record: u, v, regions and sigmas have different numbers of points or frames");
  for (const std::size_t region : r.region_of_point) {
    if (region >= r.regions.size()) {
      faults.emplace_back("a point belongs to no declared region");
      break;
    }
  }
}

bool usable(const ObservationRecord& r, Eigen::Index j) {
  const double sigma = r.sigma_px[static_cast<std::size_t>(j)];
  if (!positive(sigma)) return false;
  const double limit = 10.0 * std::max(r.width_px, r.height_px);
  Eigen::Index n_missing = 0;
  for (Eigen::Index k = 0; k < r.n_frames(); ++k) {
    const double u = r.u_px(k, j), v = r.v_px(k, j);
    if (std::isnan(u) || std::isnan(v))
      ++n_missing;
    else if (!(std::abs(u) < limit && std::abs(v) < limit))
      return false;
  }
  return static_cast<double>(n_missing) <= kMostMissing * static_cast<double>(r.n_frames());
}

// Smaller over larger standard deviation of the positions along their principal axes.
double spread_ratio(const ObservationRecord& r, const std::vector<Eigen::Index>& points) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  std::vector<Eigen::Vector2d> place;
  for (const Eigen::Index j : points) {
    for (Eigen::Index k = 0; k < r.n_frames(); ++k) {
      if (std::isnan(r.u_px(k, j)) || std::isnan(r.v_px(k, j))) continue;
      place.emplace_back(r.u_px(k, j), r.v_px(k, j));
      mean += place.back();
      break;
    }
  }
  mean /= static_cast<double>(place.size());
  Eigen::Matrix2d s = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& p : place) s += (p - mean) * (p - mean).transpose();
  const double half = 0.5 * s.trace(), root = std::sqrt(std::max(half * half - s.determinant(), 0.0));
  return half + root > 0.0 ? std::sqrt(std::max(half - root, 0.0) / (half + root)) : 0.0;
}

void check_regions(const ObservationRecord& r, RecordCheck& check) {
  std::vector<int> count(r.regions.size(), 0);
  for (const Eigen::Index j : check.points) ++count[r.region_of_point[static_cast<std::size_t>(j)]];
  int n_used = 0;
  bool background = false;
  for (std::size_t i = 0; i < count.size(); ++i) {
    n_used += count[i] > 0 ? 1 : 0;
    background = background || (count[i] > 2 && r.regions[i].role == RegionRole::kBackground);
  }
  if (n_used == 1)
    check.warnings.emplace_back(
        "one region: its motion cannot be distinguished from the camera's; lens, readout, roll and "
        "tracker errors still can if the region is large");
  if (!background)
    check.warnings.emplace_back(
        "no background: roll of the camera cannot be distinguished from rocking of the whole "
        "structure, and absolute translation is unknown");
}

}  // namespace

double ObservationRecord::readout_share(double u, double v) const noexcept {
  return ReadoutModel{0.0, readout_direction, width_px, height_px}.fraction(u, v);
}

RecordCheck check_record(const ObservationRecord& record) {
  RecordCheck check;
  check_declared(record, check.faults);
  if (!check.faults.empty()) return check;
  const double seconds = static_cast<double>(record.n_frames()) / record.rate_hz;
  if (seconds < kLeastSeconds || record.n_frames() < 250)
    check.faults.push_back("record of " + number(seconds) + " s, " + std::to_string(record.n_frames()) +
                           " frames: too short, held-out blocks need at least 20 s and 250 frames");
  for (Eigen::Index j = 0; j < record.n_points(); ++j) {
    if (usable(record, j)) check.points.push_back(j);
  }
  const auto n_usable = static_cast<Eigen::Index>(check.points.size());
  if (n_usable < record.n_points())
    check.warnings.push_back(std::to_string(record.n_points() - n_usable) +
                             " points excluded: more than a fifth of their frames are missing, or their numbers are "
                             "invalid");
  if (n_usable < kLeastPoints)
    check.faults.push_back(std::to_string(n_usable) + " usable points: at least " + std::to_string(kLeastPoints) +
                           " are needed to leave one out");
  if (!check.faults.empty()) return check;
  if (spread_ratio(record, check.points) < kLeastSpread)
    check.faults.emplace_back(
        "all points lie on one line: fields over the image cannot be distinguished; declare regions "
        "beside it");
  check_regions(record, check);
  return check;
}

ObservationRecord select_points(ObservationRecord record, const std::vector<Eigen::Index>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {  // ascending: no point is overwritten before it is read
    const auto to = static_cast<Eigen::Index>(i);
    const auto from = static_cast<std::size_t>(points[i]);
    record.u_px.col(to) = record.u_px.col(points[i]);
    record.v_px.col(to) = record.v_px.col(points[i]);
    record.region_of_point[i] = record.region_of_point[from];
    record.sigma_px[i] = record.sigma_px[from];
    if (!record.raw_share.empty()) record.raw_share[i] = record.raw_share[from];
  }
  record.u_px.conservativeResize(Eigen::NoChange, static_cast<Eigen::Index>(points.size()));
  record.v_px.conservativeResize(Eigen::NoChange, static_cast<Eigen::Index>(points.size()));
  record.region_of_point.resize(points.size());
  record.sigma_px.resize(points.size());
  if (!record.raw_share.empty()) record.raw_share.resize(points.size());
  return record;
}

}  // namespace core::closure
