#pragma once

namespace core {

// Whether the points contradict the estimated camera motion for so long that it is better given up: a region declared
// static moves, or the camera vibrates faster than the estimated motion follows (its rates then grow from frame to
// frame). One thread; does not allocate.
class MotionContradiction {
 public:
  // most_points: most of the points do not move as their region does. resting_px: largest mean motion of a static
  // region that is left after removal of the camera's motion.
  void add(bool most_points, double resting_px) noexcept {
    n_in_a_row_ = most_points ? n_in_a_row_ + 1 : 0;
    share_ += ((resting_px > kMostResting_px ? 1.0 : 0.0) - share_) / kMemory_frames;
    lasts_ = lasts_ || n_in_a_row_ > kMostInARow || share_ > kMostShare;
  }
  [[nodiscard]] bool lasts() const noexcept { return lasts_; }

 private:
  static constexpr int kMostInARow = 50;
  // Where the estimate holds, static regions stay within 0.6 px; where it diverges, they leave it in 7 % of the frames.
  static constexpr double kMostResting_px = 1.0, kMostShare = 0.05, kMemory_frames = 500.0;

  int n_in_a_row_ = 0;
  double share_ = 0.0;
  bool lasts_ = false;
};

}  // namespace core
