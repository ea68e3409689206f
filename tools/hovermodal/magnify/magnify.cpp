// hovermodal magnify: the first frame of a clip, moved by an identified mode times a stated factor.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "core/geometry/mesh_warp.h"
#include "drivers/camera/camera_factory.h"
#include "drivers/host/command_line.h"
#include "drivers/storage/clip_writer.h"
#include "drivers/storage/json.h"
#include "drivers/storage/printable.h"
#include "tools/hovermodal/answer.h"
#include "tools/hovermodal/commands.h"
#include "tools/hovermodal/magnify/modal_motion.h"
#include "tools/hovermodal/named_file.h"

namespace tools {
namespace {

constexpr const char* kMagnifyHelp =
    "One mode of a run made visible: the first frame of the clip, moved by the mode's shape times a factor\n"
    "  hovermodal magnify out --clip flight.mp4 --mode 2 --out mode2.mp4\n"
    "  hovermodal magnify out --clip flight.mp4 --mode 2 --factor 50 --out mode2.mp4\n"
    "RUN is the folder that --report wrote (modal.json, displacements.csv, tracks.csv). Every region moves as a whole, "
    "by\n"
    "its component of the shape times the mode's amplitude in the record times the factor; between the regions a mesh\n"
    "is interpolated; regions without a channel, and what is far from all, hold still. A region whose component is\n"
    "below two standard deviations is held still and named: its motion would be magnified noise. Without any region\n"
    "above that, or without standard deviations, nothing is written. The strip below the picture states mode and "
    "factor.";

constexpr double kRate_hz = 25.0;
constexpr int kStripPx = 28;
constexpr double kSwingShare = 0.012;  // of the image's longer side: the largest motion without --factor

struct MagnifyOptions {
  std::string run, clip, out;
  int mode = 1;
  double factor = 0.0;  // 0 = chosen
  double period_s = 2.0, seconds = 6.0;
  int crf = 8;
  bool force = false, plain = false;
  Answer answer;
};

core::Frame first_frame(const MagnifyOptions& options) {
  drivers::CameraOptions source;
  source.source = options.clip;
  const auto camera = drivers::make_camera(source);
  const core::CameraInfo info = camera->info();
  core::Frame frame;
  frame.pixels.resize(static_cast<std::size_t>(info.width_px) * static_cast<std::size_t>(info.height_px));
  camera->start();
  drivers::CaptureStatus status = drivers::CaptureStatus::kTimeout;
  for (int i = 0; i < 30 && status == drivers::CaptureStatus::kTimeout; ++i)
    status = camera->capture(frame, std::chrono::milliseconds(1000));
  const std::string fault = camera->fault();
  camera->stop();
  if (status != drivers::CaptureStatus::kFrame) {
    throw std::runtime_error(
        fmt::format("\"{}\": no frame{}{}", drivers::printable(options.clip), fault.empty() ? "" : ": ", fault));
  }
  return frame;
}

std::vector<core::WarpPart> parts_of(const ModalMotion& motion, double factor) {
  std::vector<core::WarpPart> parts;
  for (const RegionMotion& region : motion.regions) {
    core::WarpPart part{region.left, region.top, region.right, region.bottom, 0.0, 0.0};
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
core::MeshWarp warp_of(const ModalMotion& motion, double& factor) {
  const core::MeshWarp one(motion.width_px, motion.height_px, parts_of(motion, 1.0));
  const double most = core::MeshWarp::kMostStrain / one.strain();
  if (factor <= 0.0) {
    const double swing_px = kSwingShare * std::max(motion.width_px, motion.height_px);
    factor = two_digits(std::min(swing_px / motion.amplitude_px, 0.9 * most));
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

void write_clip(const core::MeshWarp& warp, const core::Frame& frame, const std::string& caption,
                const MagnifyOptions& options) {
  const cv::Mat image(frame.height_px, frame.width_px, CV_8UC1, const_cast<std::uint8_t*>(frame.pixels.data()));
  const auto n_cycle = static_cast<std::size_t>(std::max(8L, std::lround(options.period_s * kRate_hz)));
  std::vector<cv::Mat> cycle;
  for (std::size_t i = 0; i < n_cycle; ++i) {
    const double phase = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n_cycle);
    cv::Mat drawn = warp.draw(image, phase);
    cycle.push_back(options.plain ? drawn : with_strip(drawn, caption));
  }
  drivers::ClipWriter writer(options.out, cycle.front().cols, cycle.front().rows, kRate_hz, options.crf);
  const auto n_frames = static_cast<std::size_t>(std::max(1L, std::lround(options.seconds * kRate_hz)));
  for (std::size_t i = 0; i < n_frames; ++i) writer.write(cycle[i % n_cycle].data);
  writer.finish();
}

std::string magnify_text(const ModalMotion& motion, const MagnifyOptions& options, double factor) {
  std::string text = fmt::format("mode {}: {:.4f}{} Hz\n", options.mode, motion.frequency_hz,
                                 motion.frequency_std_hz ? fmt::format(" +- {:.4f}", *motion.frequency_std_hz) : "");
  text += fmt::format("amplitude {:.4g} px where the shape is 1 (root 2 times the rms), times {:g}: {:.4g} px\n",
                      motion.amplitude_px, factor, factor * motion.amplitude_px);
  text += fmt::format("{:<20} {:>8} {:>8} {:>9} {:>8}\n", "region", "shape", "sigma", "drawn px", "sigma px");
  for (const RegionMotion& region : motion.regions) {
    if (region.is_static) continue;
    const double size = std::sqrt(std::norm(region.shape_u) + std::norm(region.shape_v));
    const double sigma = core::length(region.sigma_u, region.sigma_v), px = factor * motion.amplitude_px;
    text += fmt::format("{:<20} {:8.3f} {:8.3f} {:9.3f} {:8.3f}{}\n", drivers::printable(region.name), size, sigma,
                        region.held.empty() ? px * size : 0.0, px * sigma,
                        region.held.empty() ? "" : "  held still: " + region.held);
  }
  text += fmt::format("{}: {:g} s, one cycle in {:g} s\n", drivers::printable(options.out), options.seconds,
                      options.period_s);
  return text;
}

std::string magnify_json(const ModalMotion& motion, const MagnifyOptions& options, double factor) {
  nlohmann::ordered_json regions = nlohmann::ordered_json::array();
  for (const RegionMotion& region : motion.regions) {
    if (region.is_static) continue;
    const double px = region.held.empty() ? factor * motion.amplitude_px : 0.0;
    regions.push_back({{"name", region.name},
                       {"shape_u", {region.shape_u.real(), region.shape_u.imag()}},
                       {"shape_v", {region.shape_v.real(), region.shape_v.imag()}},
                       {"sigma_u", region.sigma_u},
                       {"sigma_v", region.sigma_v},
                       {"drawn_u_px", {px * region.shape_u.real(), px * region.shape_u.imag()}},
                       {"drawn_v_px", {px * region.shape_v.real(), px * region.shape_v.imag()}},
                       {"held", region.held}});
  }
  const nlohmann::ordered_json out{{"mode", options.mode},
                                   {"frequency_hz", motion.frequency_hz},
                                   {"amplitude_px", motion.amplitude_px},
                                   {"factor", factor},
                                   {"period_s", options.period_s},
                                   {"rate_hz", kRate_hz},
                                   {"out", options.out},
                                   {"regions", regions}};
  return drivers::to_json_text(out).text;
}

void magnify(MagnifyOptions options) {
  require_free(options.out, options.force);
  const ModalMotion motion = modal_motion(options.run, options.mode);
  if (options.clip.empty()) {
    options.clip = (std::filesystem::path(options.run) / "clip.mp4").string();
    if (!std::filesystem::exists(options.clip))
      throw std::invalid_argument("--clip is needed: the video of the run (there is no " + options.clip + ")");
  }
  const core::Frame frame = first_frame(options);
  if (frame.width_px != motion.width_px || frame.height_px != motion.height_px) {
    throw std::invalid_argument(fmt::format("{}: {}x{}, but the run saw {}x{}", options.clip, frame.width_px,
                                            frame.height_px, motion.width_px, motion.height_px));
  }
  double factor = options.factor;
  const core::MeshWarp warp = warp_of(motion, factor);
  write_clip(warp, frame, caption_of(motion, options, factor), options);
  options.answer.document(magnify_json(motion, options, factor));
  options.answer.text("{}", magnify_text(motion, options, factor));
}

}  // namespace

void add_magnify(drivers::Command& app) {
  auto options = std::make_shared<MagnifyOptions>();
  drivers::Command command = app.subcommand("magnify", kMagnifyHelp);
  command.option("run", options->run, "Folder of a run").required().type_name("RUN");
  command.option("--mode", options->mode, "Number of the mode in modal.json, from 1").show_default().type_name("N");
  command.option("--clip", options->clip, "Its video (default: clip.mp4 in the folder)").type_name("FILE");
  command.option("--out", options->out, "Video to write").required().type_name("FILE.mp4");
  command.option("--factor", options->factor, "Factor of the motion (default: chosen and stated)").positive();
  command.option("--period-s", options->period_s, "Duration of one cycle as shown").range(0.4, 60.0).show_default();
  command.option("--seconds", options->seconds, "Duration of the video").range(0.1, 600.0).show_default();
  command.option("--crf", options->crf, "Quality of the video: 0 lossless .. 51").range(0, 51).show_default();
  command.flag("--plain", options->plain, "No strip with mode and factor below the picture");
  add_force_option(command, options->force);
  add_answer_options(command, options->answer, "the result");
  command.on_run([options] { magnify(*options); });
}

}  // namespace tools
