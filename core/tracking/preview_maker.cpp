#include "core/tracking/preview_maker.h"

#include <algorithm>

namespace core {
namespace {

constexpr int kLargestReduction = 256;  // a 16-bit column sum holds so many rows of value 255

int reduction_for(int width_px, int height_px, int long_side_px) {
  const int longest = std::max(width_px, height_px);
  return std::clamp((longest + long_side_px - 1) / long_side_px, 1, kLargestReduction);
}

}  // namespace

PreviewMaker::PreviewMaker(const Config& config, int width_px, int height_px, const TrackFrame& keyframe,
                           std::size_t n_regions)
    : period_ns_(static_cast<std::int64_t>(config.period_s * 1e9)), keyframe_(keyframe.points) {
  const int reduction = reduction_for(width_px, height_px, std::max(1, config.long_side_px));
  prototype_.reduction = reduction;
  prototype_.image_width_px = width_px, prototype_.image_height_px = height_px;
  // Incomplete boxes at the right and bottom are omitted; an image smaller than a box gives one pixel.
  prototype_.width_px = std::max(1, width_px / reduction), prototype_.height_px = std::max(1, height_px / reduction);
  prototype_.pixels.resize(static_cast<std::size_t>(prototype_.width_px) *
                           static_cast<std::size_t>(prototype_.height_px));
  prototype_.points = keyframe.points;
  prototype_.shifts.resize(n_regions);
  column_sums_.resize(static_cast<std::size_t>(prototype_.width_px) * static_cast<std::size_t>(reduction));
}

bool PreviewMaker::is_due(std::int64_t t_start_ns) noexcept {
  if (period_ns_ <= 0) return false;
  if (has_made_one_ && t_start_ns >= last_ns_ && t_start_ns - last_ns_ < period_ns_) return false;
  has_made_one_ = true;
  last_ns_ = t_start_ns;
  return true;
}

void PreviewMaker::make(const Frame& frame, const TrackFrame& tracks, Preview& out) noexcept {
  const bool fits = frame.width_px == prototype_.image_width_px && frame.height_px == prototype_.image_height_px &&
                    tracks.points.size() == keyframe_.size() && out.points.size() == keyframe_.size() &&
                    frame.width_px >= prototype_.reduction && frame.height_px >= prototype_.reduction;
  if (!fits) return;
  out.sequence = frame.sequence, out.t_start_ns = frame.t_start_ns;
  std::copy(tracks.points.begin(), tracks.points.end(), out.points.begin());
  reduce(frame, out);
  measure_shifts(tracks, out);
}

// Sums down the columns first, then along the sums: the first loop is the long one and can be vectorised.
void PreviewMaker::reduce(const Frame& frame, Preview& out) noexcept {
  const auto n = static_cast<std::size_t>(out.reduction), stride = static_cast<std::size_t>(frame.width_px);
  const auto area = static_cast<std::uint32_t>(out.reduction * out.reduction);
  const auto width = static_cast<std::size_t>(out.width_px), height = static_cast<std::size_t>(out.height_px);
  for (std::size_t y = 0; y < height; ++y) {
    std::fill(column_sums_.begin(), column_sums_.end(), std::uint16_t{0});
    for (std::size_t row = 0; row < n; ++row) {
      const std::uint8_t* from = frame.pixels.data() + (y * n + row) * stride;
      for (std::size_t x = 0; x < column_sums_.size(); ++x) {
        column_sums_[x] = static_cast<std::uint16_t>(column_sums_[x] + from[x]);
      }
    }
    for (std::size_t x = 0; x < width; ++x) {
      std::uint32_t sum = area / 2;  // rounds
      for (std::size_t k = 0; k < n; ++k) sum += column_sums_[x * n + k];
      out.pixels[y * width + x] = static_cast<std::uint8_t>(sum / area);
    }
  }
}

void PreviewMaker::measure_shifts(const TrackFrame& tracks, Preview& out) const noexcept {
  std::fill(out.shifts.begin(), out.shifts.end(), RegionShift{});
  for (std::size_t i = 0; i < keyframe_.size(); ++i) {
    const TrackPoint& now = tracks.points[i];
    if (!now.seen || !now.inlier || !keyframe_[i].seen || now.region >= out.shifts.size()) continue;
    RegionShift& shift = out.shifts[now.region];
    shift.u_px += now.u_px - keyframe_[i].u_px;
    shift.v_px += now.v_px - keyframe_[i].v_px;
    ++shift.n_points;
  }
  for (RegionShift& shift : out.shifts) {
    if (shift.n_points == 0) continue;
    shift.u_px /= shift.n_points;
    shift.v_px /= shift.n_points;
  }
}

}  // namespace core
