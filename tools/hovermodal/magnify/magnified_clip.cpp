#include "tools/hovermodal/magnify/magnified_clip.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

#include "core/geometry/mesh_warp.h"
#include "core/types/constants.h"
#include "drivers/camera/camera_factory.h"
#include "drivers/storage/clip_writer.h"
#include "drivers/storage/printable.h"
#include "tools/hovermodal/clip_source.h"
#include "tools/hovermodal/magnify/region_places.h"
#include "tools/hovermodal/simulate/progress.h"

namespace tools {
namespace {

constexpr double kShownRate_hz = 25.0, kShownSeconds = 6.0;  // of the first frame
constexpr int kStripPx = 28;
// Of the largest possible factor, without --factor. Between parts that nearly touch, the mesh's cells feel where they
// stand.
constexpr double kChosenShare = 0.9, kChosenShareOfClip = 0.5;
constexpr double kSwingShare = 0.012;  // of the image's longer side: the largest motion without --factor

// The frames of the clip, in order.
class ClipFrames {
 public:
  ClipFrames(const std::string& clip, int decoder_mb, const ModalMotion& motion) : clip_(clip) {
    drivers::CameraOptions source;
    source.source = clip;
    source.decoder_mb = decoder_mb;
    // Images state no rate.
    if (std::filesystem::is_directory(clip) && !std::filesystem::exists(std::filesystem::path(clip) / "timestamps.csv"))
      source.rate_hz = motion.rate_hz;
    camera_ = open_clip_camera(source);
    const core::CameraInfo info = camera_->info();
    if (info.width_px != motion.width_px || info.height_px != motion.height_px) {
      throw std::invalid_argument(fmt::format("{}: {}x{}, but the run saw {}x{}", clip, info.width_px, info.height_px,
                                              motion.width_px, motion.height_px));
    }
    rate_hz_ = info.rate_hz;
    frame_.pixels.resize(static_cast<std::size_t>(info.width_px) * static_cast<std::size_t>(info.height_px));
    camera_->start();
  }
  ~ClipFrames() { camera_->stop(); }
  ClipFrames(const ClipFrames&) = delete;
  ClipFrames& operator=(const ClipFrames&) = delete;

  // False: the end.
  bool next() {
    drivers::CaptureStatus status = drivers::CaptureStatus::kTimeout;
    for (int i = 0; i < 30 && status == drivers::CaptureStatus::kTimeout; ++i)
      status = camera_->capture(frame_, std::chrono::milliseconds(1000));
    if (status == drivers::CaptureStatus::kFrame) return true;
    const std::string fault = camera_->fault();
    if (status == drivers::CaptureStatus::kTimeout || !fault.empty()) {
      throw std::runtime_error(
          fmt::format("\"{}\": no frame{}{}", drivers::printable(clip_), fault.empty() ? "" : ": ", fault));
    }
    return false;
  }
  [[nodiscard]] const core::Frame& frame() const noexcept { return frame_; }
  [[nodiscard]] cv::Mat image() const {
    return {frame_.height_px, frame_.width_px, CV_8UC1, const_cast<std::uint8_t*>(frame_.pixels.data())};
  }
  [[nodiscard]] double rate_hz() const noexcept { return rate_hz_; }

 private:
  std::string clip_;
  std::unique_ptr<drivers::Camera> camera_;
  core::Frame frame_;
  double rate_hz_ = 0.0;
};

// `shifts`: of the regions since the first frame; empty: none.
std::vector<core::WarpPart> parts_of(const ModalMotion& motion, double factor,
                                     const std::vector<core::Vector2>& shifts = {}) {
  std::vector<core::WarpPart> parts;
  for (std::size_t i = 0; i < motion.regions.size(); ++i) {
    const RegionMotion& region = motion.regions[i];
    const core::Vector2 by = i < shifts.size() ? shifts[i] : core::Vector2{};
    core::WarpPart part{region.left + by.u, region.top + by.v, region.right + by.u, region.bottom + by.v, 0.0, 0.0};
    if (!region.is_static && region.held.empty()) {
      part.swing_u = factor * motion.amplitude_px * region.shape_u;
      part.swing_v = factor * motion.amplitude_px * region.shape_v;
    }
    parts.push_back(part);
  }
  return parts;
}

// Two digits are enough for a factor, and can be remembered.
double two_digits(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return std::max(unit, std::floor(value / unit) * unit);
}

// The factor, and the warp that it gives. Throws where the image would fold.
core::MeshWarp warp_of(const ModalMotion& motion, double chosen_share, double& factor) {
  const core::MeshWarp one(motion.width_px, motion.height_px, parts_of(motion, 1.0));
  const double most = core::MeshWarp::kMostStrain / one.strain();
  if (factor <= 0.0) {
    const double swing_px = kSwingShare * std::max(motion.width_px, motion.height_px);
    factor = two_digits(std::min(swing_px / motion.amplitude_px, chosen_share * most));
  }
  if (factor > most) {
    throw std::invalid_argument(fmt::format(
        "--factor {:g}: parts of the image would be pushed over each other; at most {:g}", factor, two_digits(most)));
  }
  return {motion.width_px, motion.height_px, parts_of(motion, factor)};
}

std::string caption_of(const ModalMotion& motion, const MagnifyOptions& options, double factor) {
  return fmt::format("mode {}: {:.3f} Hz, motion x {:g}, shown at {:.2f} Hz", options.mode, motion.frequency_hz, factor,
                     1.0 / options.period_s);
}

// The picture with a strip below that states what is seen: the picture itself stays free.
cv::Mat with_strip(const cv::Mat& picture, const std::string& caption) {
  cv::Mat out(picture.rows + kStripPx + picture.rows % 2, picture.cols, CV_8UC1, cv::Scalar(16));
  picture.copyTo(out(cv::Rect(0, 0, picture.cols, picture.rows)));
  int base_px = 0;
  double scale = 0.5;
  const cv::Size size = cv::getTextSize(caption, cv::FONT_HERSHEY_SIMPLEX, scale, 1, &base_px);
  if (size.width > picture.cols - 12) scale *= (picture.cols - 12.0) / size.width;
  cv::putText(out, caption, {6, picture.rows + 19}, cv::FONT_HERSHEY_SIMPLEX, scale, cv::Scalar(235), 1, cv::LINE_AA);
  return out;
}

// The first frame through one cycle, again and again.
void draw_first(const core::MeshWarp& warp, const ClipFrames& frames, const std::string& caption,
                const MagnifyOptions& options, MagnifiedClip& out) {
  out.rate_hz = kShownRate_hz;
  const auto n_cycle = static_cast<std::size_t>(std::max(8L, std::lround(options.period_s * out.rate_hz)));
  std::vector<cv::Mat> cycle;
  {
    Progress progress("magnify", n_cycle, "frames", !options.answer.tells());
    for (std::size_t i = 0; i < n_cycle; ++i) {
      const double phase = core::kTwoPi * static_cast<double>(i) / static_cast<double>(n_cycle);
      cv::Mat drawn = warp.draw(frames.image(), phase);
      cycle.push_back(options.plain ? drawn : with_strip(drawn, caption));
      progress.update(i + 1);
    }
  }
  drivers::ClipWriter writer(options.out, cycle.front().cols, cycle.front().rows, out.rate_hz, options.crf);
  out.n_frames =
      static_cast<std::uint64_t>(std::max(1L, std::lround(options.seconds.value_or(kShownSeconds) * out.rate_hz)));
  for (std::uint64_t i = 0; i < out.n_frames; ++i) writer.write(cycle[i % n_cycle].data);
  writer.finish();
}

// Every frame, warped where its regions are in it.
void draw_all(const ModalMotion& motion, ClipFrames& frames, const std::string& caption, const MagnifyOptions& options,
              MagnifiedClip& out) {
  std::vector<std::string> names;
  for (const RegionMotion& region : motion.regions) names.push_back(region.name);
  RegionPlaces places((std::filesystem::path(options.run) / "tracks.csv").string(), names);
  out.rate_hz = frames.rate_hz();
  if (!(out.rate_hz > 0.0)) throw std::runtime_error(options.clip + ": its frame rate is not known");
  const double most = options.seconds ? std::max(1.0, *options.seconds * out.rate_hz) : 1e18;
  Progress progress("magnify", static_cast<std::uint64_t>(std::min(most, static_cast<double>(places.n_frames()))),
                    "frames", !options.answer.tells());
  std::unique_ptr<drivers::ClipWriter> writer;
  do {
    if (!places.advance(frames.frame().sequence)) break;
    const core::MeshWarp warp(motion.width_px, motion.height_px, parts_of(motion, out.factor, places.shifts()));
    if (warp.strain() > core::MeshWarp::kMostStrain) {
      throw std::invalid_argument(fmt::format(
          "--factor {:g}: in frame {} parts of the image would be pushed over each other; give a smaller one",
          out.factor, frames.frame().sequence));
    }
    const double t_s = static_cast<double>(frames.frame().sequence) / out.rate_hz;
    cv::Mat drawn = warp.draw(frames.image(), core::kTwoPi * t_s / options.period_s);
    if (!options.plain) drawn = with_strip(drawn, caption);
    if (!writer)
      writer = std::make_unique<drivers::ClipWriter>(options.out, drawn.cols, drawn.rows, out.rate_hz, options.crf);
    writer->write(drawn.data);
    progress.update(++out.n_frames);
  } while (static_cast<double>(out.n_frames) < most && frames.next());
  if (!writer) throw std::runtime_error(options.run + ": its tracks do not reach the clip's first frame");
  writer->finish();
}

}  // namespace

MagnifiedClip draw_magnified(const ModalMotion& motion, const MagnifyOptions& options) {
  ClipFrames frames(options.clip, options.decoder_mb, motion);
  if (!frames.next()) throw std::runtime_error(fmt::format("\"{}\": no frame", drivers::printable(options.clip)));
  MagnifiedClip out;
  out.factor = options.factor;
  const core::MeshWarp warp = warp_of(motion, options.all_frames ? kChosenShareOfClip : kChosenShare, out.factor);
  const std::string caption = caption_of(motion, options, out.factor);
  if (options.all_frames) {
    draw_all(motion, frames, caption, options, out);
  } else {
    draw_first(warp, frames, caption, options, out);
  }
  return out;
}

}  // namespace tools
