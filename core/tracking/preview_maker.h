#pragma once

#include <cstdint>
#include <vector>

#include "core/types/frame.h"
#include "core/types/preview.h"
#include "core/types/track.h"

namespace core {

// Makes previews of frames, at most one per period of stream time, by averaging boxes of pixels. Does not affect
// measurements. Allocates at construction only.
class PreviewMaker {
 public:
  struct Config {
    double period_s = 1.0;  // 0 = never
    int long_side_px = 320;
  };

  PreviewMaker(const Config& config, int width_px, int height_px, const TrackFrame& keyframe, std::size_t n_regions);

  [[nodiscard]] const Preview& prototype() const noexcept { return prototype_; }
  // True once per period; a stream that restarts at an earlier time is due at once.
  [[nodiscard]] bool is_due(std::int64_t t_start_ns) noexcept;
  // `out` is a copy of prototype(); `tracks` are those of this frame. A frame of another size leaves `out` unchanged.
  void make(const Frame& frame, const TrackFrame& tracks, Preview& out) noexcept;

 private:
  void reduce(const Frame& frame, Preview& out) noexcept;
  void measure_shifts(const TrackFrame& tracks, Preview& out) const noexcept;

  std::int64_t period_ns_;
  std::int64_t last_ns_ = 0;
  bool has_made_one_ = false;
  Preview prototype_;
  std::vector<TrackPoint> keyframe_;
  std::vector<std::uint16_t> column_sums_;  // over the rows of one box
};

}  // namespace core
