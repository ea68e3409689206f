#include "core/closure/observation/recent_tracks.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/types/constants.h"

namespace core::closure {
namespace {

using Eigen::Index;

}  // namespace

RecentTracks::RecentTracks(ObservationRecord declared, const CameraModel& camera,
                           std::vector<std::size_t> region_of_point, std::size_t n_frames)
    : declared_(std::move(declared)), camera_(camera) {
  if (n_frames == 0) throw std::invalid_argument("RecentTracks: keeps no frame");
  const auto n_points = static_cast<Index>(region_of_point.size());
  u_px_ = v_px_ = sigma_px_ = Eigen::MatrixXd::Constant(static_cast<Index>(n_frames), n_points, kNan);
  raw_share_.assign(region_of_point.size(), kNan);
  declared_.region_of_point = std::move(region_of_point);
}

void RecentTracks::forget_row(std::uint64_t sequence) noexcept {
  const Index k = row(sequence);
  u_px_.row(k).setConstant(kNan), v_px_.row(k).setConstant(kNan), sigma_px_.row(k).setConstant(kNan);
}

bool RecentTracks::begin_frame(std::uint64_t sequence) noexcept {
  if (n_frames_ > 0 && sequence <= last_) return false;
  const auto most = static_cast<std::uint64_t>(u_px_.rows());
  const std::uint64_t step = n_frames_ == 0 ? most : sequence - last_;
  if (step >= most) {
    u_px_.setConstant(kNan), v_px_.setConstant(kNan), sigma_px_.setConstant(kNan);
    n_frames_ = 1;
  } else {
    for (std::uint64_t k = last_ + 1; k <= sequence; ++k) forget_row(k);
    n_frames_ = static_cast<std::size_t>(std::min(most, n_frames_ + step));
  }
  last_ = sequence;
  return true;
}

void RecentTracks::place(std::size_t point, const TrackPoint& seen) noexcept {
  if (point >= raw_share_.size()) return;
  const Index k = row(last_), j = static_cast<Index>(point);
  const Vector2 at = camera_.undistort({seen.u_px, seen.v_px});
  u_px_(k, j) = at.u;
  // One scale for both axes: positions in units of the focal length stay the same.
  v_px_(k, j) = camera_.cy + (at.v - camera_.cy) * camera_.fx / camera_.fy;
  sigma_px_(k, j) = seen.sigma_px;
  if (std::isnan(raw_share_[point])) raw_share_[point] = declared_.readout_share(seen.u_px, seen.v_px);
}

ObservationRecord RecentTracks::record() const {
  ObservationRecord out = declared_;
  const auto n = static_cast<Index>(n_frames_);
  out.u_px.resize(n, u_px_.cols());
  out.v_px.resize(n, u_px_.cols());
  out.raw_share = raw_share_;
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(u_px_.cols()), count = squares;
  for (Index i = 0; i < n; ++i) {
    const Index k = row(first_sequence() + static_cast<std::uint64_t>(i));
    out.u_px.row(i) = u_px_.row(k);
    out.v_px.row(i) = v_px_.row(k);
    for (Index j = 0; j < u_px_.cols(); ++j) {
      if (std::isnan(u_px_(k, j))) continue;
      squares(j) += sigma_px_(k, j) * sigma_px_(k, j), count(j) += 1.0;
    }
  }
  out.sigma_px.clear();
  for (Index j = 0; j < u_px_.cols(); ++j) out.sigma_px.push_back(std::sqrt(squares(j) / count(j)));
  return out;
}

}  // namespace core::closure
