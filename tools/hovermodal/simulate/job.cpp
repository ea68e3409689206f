#include "tools/hovermodal/simulate/job.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include "drivers/storage/text_file.h"

namespace tools {
namespace {

using Lens = core::simulation::LensParameters;

std::pair<int, int> parse_size(const std::string& text) {
  static const std::map<std::string, std::pair<int, int>> kNamed{
      {"2160p", {3840, 2160}}, {"1440p", {2560, 1440}}, {"1080p", {1920, 1080}}, {"720p", {1280, 720}},
      {"540p", {960, 540}},    {"360p", {640, 360}},    {"270p", {480, 270}}};
  if (const auto named = kNamed.find(text); named != kNamed.end()) return named->second;
  const std::size_t cross = text.find('x');
  const auto width = drivers::parse_whole(std::string_view(text).substr(0, cross));
  const auto height =
      cross == std::string::npos ? std::nullopt : drivers::parse_whole(std::string_view(text).substr(cross + 1));
  if (!width || !height || *width < 320 || *height < 180 || *width > 8192 || *height > 8192 || *width % 2 != 0 ||
      *height % 2 != 0) {
    throw std::invalid_argument(
        fmt::format("--size {}: give 2160p, 1440p, 1080p, 720p, 540p, 360p, 270p or WIDTHxHEIGHT, both even, "
                    "320x180 to 8192x8192",
                    drivers::printable(text)));
  }
  return {static_cast<int>(*width), static_cast<int>(*height)};
}

void require_possible(const SimulateJob& job) {
  const auto& camera = job.scene().camera;
  if (job.depth == Depth::kPixels && (camera.width_px % 2 != 0 || camera.height_px % 2 != 0)) {
    throw std::invalid_argument(
        fmt::format("camera: {} x {} px cannot be encoded: give an even width and height, or "
                    "--tracks-only",
                    camera.width_px, camera.height_px));
  }
  const auto& declare = job.file.declare;
  if (camera.lens.model != Lens::Model::kNone && declare.lens && !declare.focal_length) {
    throw std::invalid_argument(
        "declare.lens: the lens cannot be declared without the focal length: give declare: {lens: "
        "false}, or focal_length: true");
  }
}

}  // namespace

const char* SimulateJob::product() const noexcept {
  switch (depth) {
    case Depth::kChannels:
      return "displacements.csv";
    case Depth::kTracks:
      return "tracks.csv";
    case Depth::kPixels:
      break;
  }
  return crf ? "clip.mp4" : "clip.y4m";
}

core::CameraInfo SimulateJob::declared_camera() const {
  const auto& camera = scene().camera;
  core::CameraInfo info = scene().camera_info();
  info.readout_ns = std::llround(1e6 * file.declare.readout_ms.of(1e3 * camera.readout_s).value_or(0.0));
  info.exposure_ns = std::llround(1e6 * file.declare.exposure_ms.of(1e3 * camera.exposure_s).value_or(0.0));
  // Without a declaration, the rate is the source's own.
  info.rate_hz = file.declare.rate_hz.of(camera.rate_hz).value_or(camera.rate_hz);
  return info;
}

bool SimulateJob::declares_lens() const noexcept {
  return file.declare.lens && scene().camera.lens.model != Lens::Model::kNone;
}

SimulateJob make_job(const SimulateOptions& options) {
  if (options.tracks_only && options.channels_only) {
    throw std::invalid_argument("--tracks-only and --channels-only: give one of them");
  }
  if (!options.scene_path.empty() && options.preset) {
    throw std::invalid_argument("--preset: write `preset: " + *options.preset + "` into the scene file instead");
  }
  drivers::SceneOverrides overrides;
  overrides.preset = options.preset;
  overrides.seed = options.seed;
  overrides.duration_s = options.duration_s;
  if (options.size) std::tie(overrides.width_px, overrides.height_px) = parse_size(*options.size);
  SimulateJob job;
  job.file = options.scene_path.empty() ? drivers::preset_scene(overrides)
                                        : drivers::read_scene_file(options.scene_path, overrides);
  auto& tracks = job.file.scene.tracks;
  tracks.noise_px = options.track_noise_px.value_or(tracks.noise_px);
  tracks.loss_probability = options.track_loss.value_or(tracks.loss_probability);
  tracks.points_per_region = options.points.value_or(tracks.points_per_region);
  core::simulation::validate(job.file.scene);
  job.depth = options.channels_only ? Depth::kChannels : options.tracks_only ? Depth::kTracks : Depth::kPixels;
  job.crf = options.raw ? std::nullopt : std::optional(options.crf);
  job.method = options.method;
  require_possible(job);
  return job;
}

}  // namespace tools
