#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/closure/observation/observation_record.h"
#include "core/geometry/camera_model.h"
#include "core/types/track.h"

namespace core::closure {

// Window of the newest frames of tracks for the observation level: undistorted, on the grid of frame numbers; a missing
// frame is a row of NaN. The constructor allocates all memory.
class RecentTracks {
 public:
  // declared: everything except points and frames (regions, camera, rate, readout). n_frames: window length, at least
  // 1.
  RecentTracks(ObservationRecord declared, const CameraModel& camera, std::vector<std::size_t> region_of_point,
               std::size_t n_frames);

  // Starts the frame to which place() refers from now on. Does not allocate. False: the frame is not newer than the
  // last one and is ignored. A gap longer than the window restarts the window.
  bool begin_frame(std::uint64_t sequence) noexcept;
  // Stores a point seen in that frame, raw pixels.
  void place(std::size_t point, const TrackPoint& seen) noexcept;

  [[nodiscard]] std::size_t n_frames() const noexcept { return n_frames_; }  // currently in the window, gaps included
  [[nodiscard]] std::uint64_t last_sequence() const noexcept { return last_; }
  [[nodiscard]] std::uint64_t first_sequence() const noexcept { return n_frames_ == 0 ? 0 : last_ - n_frames_ + 1; }

  // Sigma of a point: rms of the sigmas stated with its samples.
  [[nodiscard]] ObservationRecord record() const;

 private:
  [[nodiscard]] Eigen::Index row(std::uint64_t sequence) const noexcept {
    return static_cast<Eigen::Index>(sequence % static_cast<std::uint64_t>(u_px_.rows()));
  }
  void forget_row(std::uint64_t sequence) noexcept;

  ObservationRecord declared_;
  CameraModel camera_;
  Eigen::MatrixXd u_px_, v_px_, sigma_px_;  // row: frame number modulo the rows
  std::vector<double> raw_share_;           // NaN: never seen
  std::uint64_t last_ = 0;
  std::size_t n_frames_ = 0;
};

}  // namespace core::closure
