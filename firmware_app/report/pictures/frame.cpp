#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "core/types/role_names.h"
#include "drivers/images/image_encoder.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/report/pictures/parts.h"

namespace app {
namespace {

constexpr double kLongSidePx = 1200.0;  // larger frames are reduced to this
constexpr double kShortestPx = 640.0;   // smaller frames are enlarged, because their labels would cover them
constexpr std::size_t kMaxBytes = 480'000;
constexpr int kPngLevel = 6;
constexpr int kGrayStep = 4;  // coarser gray levels: otherwise sensor noise would fill most of the file
constexpr std::size_t kMaxNameBytes = 32;
constexpr double kFontScale = 0.45;
constexpr int kDrawShift = 3;  // coordinates in 1/8 px

// Blue, green, red; colours of Okabe and Ito.
cv::Scalar color_of(core::RegionRole role) {
  switch (role) {
    case core::RegionRole::kStructure:
      return {233, 180, 86};
    case core::RegionRole::kBase:
      return {0, 159, 230};
    case core::RegionRole::kBackground:
    case core::RegionRole::kGround:
      return {167, 121, 204};
  }
  return {233, 180, 86};
}

std::string label_of(const core::Region& region) {
  const std::string name = drivers::printable(region.name, kMaxNameBytes);
  const std::string role(core::to_string(region.role));
  return name == role ? name : name + " (" + role + ")";
}

// The frame at the picture's size, in colour, as background of the drawing.
class FramePicture {
 public:
  FramePicture(const core::Frame& frame, double scale) : scale_(scale) {
    // cv::Mat borrows the pixels; imgproc only reads them.
    const cv::Mat gray(frame.height_px, frame.width_px, CV_8UC1, const_cast<std::uint8_t*>(frame.pixels.data()));
    const cv::Size size(std::max(1, cvRound(frame.width_px * scale)), std::max(1, cvRound(frame.height_px * scale)));
    cv::Mat sized;
    cv::resize(gray, sized, size, 0.0, 0.0, scale < 1.0 ? cv::INTER_AREA : cv::INTER_LINEAR);
    for (auto value = sized.begin<std::uint8_t>(); value != sized.end<std::uint8_t>(); ++value) {
      *value = static_cast<std::uint8_t>(std::min(255, (*value + kGrayStep / 2) / kGrayStep * kGrayStep));
    }
    cv::cvtColor(sized, picture_, cv::COLOR_GRAY2BGR);
  }

  void draw(const PictureInputs& inputs) {
    for (const core::Region& region : inputs.regions) draw_region(region);
    if (inputs.keyframe != nullptr) draw_points(inputs.keyframe->points);
    for (std::size_t i = 0; i < inputs.regions.size(); ++i)
      draw_label(inputs.regions[i], label_of(inputs.regions[i]), taken_[i]);
  }

  [[nodiscard]] std::string encoded() const {
    const std::vector<std::uint8_t> bytes = drivers::encode_png(picture_, kPngLevel);
    return {bytes.begin(), bytes.end()};
  }

 private:
  // Pixel centres lie at integers, also in the reduced picture.
  [[nodiscard]] double scaled(double px) const { return (std::clamp(px, -1e5, 1e5) + 0.5) * scale_ - 0.5; }

  void draw_region(const core::Region& region) {
    const cv::Point a(cvRound(scaled(region.u_px)), cvRound(scaled(region.v_px)));
    const cv::Point b(cvRound(scaled(region.u_px + region.width_px - 1.0)),
                      cvRound(scaled(region.v_px + region.height_px - 1.0)));
    taken_.emplace_back(a, b + cv::Point(1, 1));
    cv::rectangle(picture_, a, b, {0, 0, 0}, 4);
    cv::rectangle(picture_, a, b, color_of(region.role), 2);
  }

  void draw_points(const std::vector<core::TrackPoint>& points) {
    for (const core::TrackPoint& point : points) {
      if (!point.seen || !std::isfinite(point.u_px) || !std::isfinite(point.v_px)) continue;
      const double unit = 1 << kDrawShift;
      const cv::Point centre(cvRound(scaled(point.u_px) * unit), cvRound(scaled(point.v_px) * unit));
      cv::circle(picture_, centre, cvRound(2.6 * unit), {0, 0, 0}, cv::FILLED, cv::LINE_AA, kDrawShift);
      cv::circle(picture_, centre, cvRound(1.8 * unit), {66, 228, 240}, cv::FILLED, cv::LINE_AA, kDrawShift);
    }
  }

  // Placed beside the rectangle where there is room: right, left, above, below; else inside, if it fits. In crowded
  // regions it is left out: a label must not cover another region's points.
  void draw_label(const core::Region& region, const std::string& label, const cv::Rect& around) {
    int below_line = 0;
    const cv::Size text = cv::getTextSize(label, cv::FONT_HERSHEY_SIMPLEX, kFontScale, 1, &below_line);
    const int width = text.width + 8, height = text.height + below_line + 4;
    const int middle = around.y + (around.height - height) / 2;
    const cv::Rect image(0, 0, picture_.cols, picture_.rows);
    const cv::Rect places[] = {{around.x + around.width + 4, middle, width, height},
                               {around.x - width - 4, middle, width, height},
                               {around.x, around.y - height - 3, width, height},
                               {around.x, around.y + around.height + 3, width, height}};
    cv::Rect place(around.x + 2, around.y + 2, width, height);
    bool found = (place & around & image) == place;
    for (const cv::Rect& candidate : places) {
      const bool free =
          std::none_of(taken_.begin(), taken_.end(), [&](const cv::Rect& r) { return (r & candidate).area() > 0; });
      if (!free || (candidate & image) != candidate) continue;
      place = candidate, found = true;
      break;
    }
    if (!found) return;
    taken_.push_back(place);
    cv::rectangle(picture_, place, {24, 24, 24}, cv::FILLED);
    cv::putText(picture_, label, {place.x + 4, place.y + text.height + 3}, cv::FONT_HERSHEY_SIMPLEX, kFontScale,
                color_of(region.role), 1, cv::LINE_AA);
  }

  double scale_;
  cv::Mat picture_;
  std::vector<cv::Rect> taken_;  // rectangles of the regions, then of the labels
};

}  // namespace

std::string frame_png(const PictureInputs& inputs) {
  const core::Frame* frame = inputs.first_frame;
  if (frame == nullptr || frame->width_px < 1 || frame->height_px < 1) return {};
  const auto n_pixels = static_cast<std::size_t>(frame->width_px) * static_cast<std::size_t>(frame->height_px);
  if (frame->pixels.size() < n_pixels) return {};
  const double long_side = std::max(frame->width_px, frame->height_px);
  double scale = std::clamp(1.0, kShortestPx / long_side, std::max(kShortestPx, kLongSidePx) / long_side);
  // A frame full of fine detail compresses badly: its size is reduced until the limit is met.
  constexpr int kMaxAttempts = 12;
  for (int attempt = 1;; ++attempt) {
    FramePicture picture(*frame, scale);
    picture.draw(inputs);
    std::string png = picture.encoded();
    if (png.size() <= kMaxBytes || attempt == kMaxAttempts) return png;
    scale *= 0.96 * std::sqrt(static_cast<double>(kMaxBytes) / static_cast<double>(png.size()));
  }
}

}  // namespace app
