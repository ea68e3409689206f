#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "drivers/images/image_encoder.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/report/page/page_parts.h"
#include "firmware_app/report/pictures/parts.h"

namespace app {
namespace {

constexpr double kLongSidePx = 1280.0;
constexpr std::size_t kMaxBytes = 260'000;  // base64 adds a third
constexpr int kJpegQuality = 78;
constexpr std::size_t kMaxRegionCharacters = 22;
constexpr double kLabelHeightPx = 17.0;

std::string jpeg_at(const core::Frame& frame, double scale) {
  // cv::Mat borrows the pixels; they are only read.
  const cv::Mat gray(frame.height_px, frame.width_px, CV_8UC1, const_cast<std::uint8_t*>(frame.pixels.data()));
  const cv::Size size(std::max(1, cvRound(frame.width_px * scale)), std::max(1, cvRound(frame.height_px * scale)));
  cv::Mat sized;
  cv::resize(gray, sized, size, 0.0, 0.0, cv::INTER_AREA);
  const std::vector<std::uint8_t> bytes = drivers::encode_jpeg(sized, kJpegQuality);
  return {bytes.begin(), bytes.end()};
}

// Regions, points and names over the frame, as in the keyframe.
class FrameOverlay {
 public:
  FrameOverlay(const PictureInputs& inputs, const PictureFormat& format, double image_width_px, double image_height_px)
      : inputs_(inputs),
        scale_(format.width_px / image_width_px),
        width_px_(format.width_px),
        height_px_(std::round(image_height_px * scale_)),
        narrow_(is_narrow(format)),
        svg_(format.width_px, height_px_, "The first frame with the regions and points that were followed", true) {}

  [[nodiscard]] std::string draw() {
    if (has_frame(inputs_)) {
      svg_.use(kFrameId, 0.0, 0.0, scale_);
    } else {
      svg_.rect({0.0, 0.0, width_px_, height_px_}, "blank");
    }
    for (const core::Region& region : inputs_.regions) draw_region(region);
    if (inputs_.keyframe != nullptr) draw_points();
    for (std::size_t i = 0; i < inputs_.regions.size(); ++i) draw_name(inputs_.regions[i], taken_[i]);
    return svg_.text_of();
  }

 private:
  void draw_region(const core::Region& region) {
    const Box box{region.u_px * scale_, region.v_px * scale_, region.width_px * scale_, region.height_px * scale_};
    taken_.push_back(box);
    svg_.rect(box, "halo");
    svg_.rect(box, role_class(region.role));
  }

  void draw_points() {
    for (const core::TrackPoint& point : inputs_.keyframe->points) {
      if (point.seen && std::isfinite(point.u_px) && std::isfinite(point.v_px))
        svg_.circle(point.u_px * scale_, point.v_px * scale_, narrow_ ? 0.9 : 2.0, "pt");
    }
  }

  // Placed beside the rectangle where there is room: right, left, above, below. A name must not cover another region.
  void draw_name(const core::Region& region, const Box& around) {
    const std::string name = shortened(region.name, kMaxRegionCharacters);
    const double width = text_width_px(name, kTextPx) + 8.0, h = kLabelHeightPx;
    const double middle = around.y + (around.height - h) / 2.0;
    const Box places[] = {{around.right() + 3.0, middle, width, h},
                          {around.x - width - 3.0, middle, width, h},
                          {around.x, around.y - h - 2.0, width, h},
                          {around.x, around.bottom() + 2.0, width, h},
                          {around.x + 2.0, around.y + 2.0, width, h}};
    for (const Box& place : places) {
      const bool is_last = &place == &places[4];
      const bool inside =
          place.x >= 0.0 && place.y >= 0.0 && place.right() <= width_px_ && place.bottom() <= height_px_;
      const bool free = std::none_of(taken_.begin(), taken_.end(), [&](const Box& other) {
        const bool own = is_last && other.x == around.x && other.y == around.y && place.right() <= around.right();
        return !own && overlap(place, other);
      });
      if (!free || !inside) continue;
      taken_.push_back(place);
      svg_.rect(place, "tag", 3.0);
      svg_.text(place.x + 4.0, place.y + 13.0, name, Anchor::kStart, "t on");
      return;
    }
  }

  const PictureInputs& inputs_;
  double scale_, width_px_, height_px_;
  bool narrow_;
  SvgDocument svg_;
  std::vector<Box> taken_;  // of the regions, then of the names
};

}  // namespace

bool has_frame(const PictureInputs& inputs) {
  const core::Frame* frame = inputs.first_frame;
  if (frame == nullptr || frame->width_px < 1 || frame->height_px < 1) return false;
  return frame->pixels.size() >= static_cast<std::size_t>(frame->width_px) * static_cast<std::size_t>(frame->height_px);
}

ImageSize image_size(const PictureInputs& inputs) {
  if (has_frame(inputs)) return {inputs.first_frame->width_px, inputs.first_frame->height_px};
  if (inputs.facts == nullptr) return {};
  return {inputs.facts->image_width_px, inputs.facts->image_height_px};
}

const char* role_class(core::RegionRole role) {
  switch (role) {
    case core::RegionRole::kStructure:
      return "r0";
    case core::RegionRole::kBase:
      return "r1";
    case core::RegionRole::kBackground:
    case core::RegionRole::kGround:
      return "r2";
  }
  return "r0";
}

std::string frame_jpeg(const core::Frame& frame) {
  double scale = std::min(1.0, kLongSidePx / std::max(frame.width_px, frame.height_px));
  // A frame full of fine detail compresses badly: its size is reduced until the limit is met.
  constexpr int kMaxAttempts = 12;
  for (int attempt = 1;; ++attempt) {
    std::string jpeg = jpeg_at(frame, scale);
    if (jpeg.size() <= kMaxBytes || attempt == kMaxAttempts) return jpeg;
    scale *= 0.96 * std::sqrt(static_cast<double>(kMaxBytes) / static_cast<double>(jpeg.size()));
  }
}

std::string frame_svg(const PictureInputs& inputs, const PictureFormat& format) {
  const ImageSize size = image_size(inputs);
  if (size.width_px < 1 || size.height_px < 1 || (!has_frame(inputs) && inputs.regions.empty())) return {};
  return FrameOverlay(inputs, format, size.width_px, size.height_px).draw();
}

}  // namespace app
