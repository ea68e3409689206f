#pragma once

#include <cstdint>

#include "core/simulation/scene.h"

namespace core::simulation {

// One frame as delivered to the service.
struct DeliveredFrame {
  std::uint64_t number = 0;    // of the sensor's frame slot
  double t_s = 0.0;            // true start of exposure of row 0 of the delivered picture
  double stamp_s = 0.0;        // stated time stamp
  std::uint64_t sequence = 0;  // stated sequence number
  bool gap_before = false;     // as stated
};

// Times at which frames are taken, which of them are delivered, and their stamps. Each part has its own random stream;
// each frame has its own number in it.
class FrameTiming {
 public:
  explicit FrameTiming(const Scene& scene);

  // True start of exposure of the sensor's frame, jitter included.
  [[nodiscard]] double frame_time_s(std::uint64_t number) const noexcept;
  [[nodiscard]] bool dropped(std::uint64_t number) const noexcept;  // never frame 0: it is the keyframe
  [[nodiscard]] bool duplicated(std::uint64_t number) const noexcept;
  // Advances frame by frame; false at the end. `number` of the first call: 0.
  bool next(DeliveredFrame& frame) noexcept;
  void restart() noexcept;

 private:
  [[nodiscard]] double draw(std::uint64_t key, std::uint64_t number) const noexcept;

  TimingParameters timing_;
  double rate_hz_;
  std::uint64_t n_frames_, seed_;
  std::uint64_t next_number_ = 0, n_delivered_ = 0;
  std::uint64_t shown_number_ = 0;  // number of the sensor frame delivered last
};

}  // namespace core::simulation
