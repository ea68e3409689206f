#include "tools/hovermodal/simulate/config.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "drivers/storage/json.h"
#include "firmware_app/config/config.h"

namespace tools {
namespace {

using core::simulation::Scene;
using core::simulation::SceneMotion;

template <class... Args>
void append(std::string& out, fmt::format_string<Args...> format, Args&&... args) {
  fmt::format_to(std::back_inserter(out), format, std::forward<Args>(args)...);
}

// 15 digits, so that 26 is not written as 26.000000000000004 after a unit conversion.
void append_declared(std::string& out, const char* key, const drivers::Declared& declared, double truth) {
  if (const auto value = declared.of(truth)) append(out, "  {}: {:.15g}\n", key, *value);
}

std::string camera_section(const SimulateJob& job, const std::string& source) {
  const auto& camera = job.scene().camera;
  const auto& declare = job.file.declare;
  std::string out;
  append(out, "camera:\n  driver: file\n  source: {}\n", nlohmann::json(source).dump());
  append_declared(out, "rate_hz", declare.rate_hz, camera.rate_hz);
  out += "  pace: as_fast_as_possible\n";
  append_declared(out, "readout_ms", declare.readout_ms, 1e3 * camera.readout_s);
  append(out, "  readout_direction: {}\n", to_string(camera.readout_direction));
  append_declared(out, "exposure_ms", declare.exposure_ms, 1e3 * camera.exposure_s);
  return out;
}

std::string calibration_section(const SimulateJob& job) {
  if (!job.file.declare.focal_length) return {};
  const auto& camera = job.scene().camera;
  std::string out;
  append(out, "calibration:\n  fx: {0}\n  fy: {0}\n  cx: {1}\n  cy: {2}\n", camera.alpha_px, camera.cx_px,
         camera.cy_px);
  if (!job.declares_lens()) return out;
  const auto& k = camera.lens.k;
  if (camera.lens.model == core::simulation::LensParameters::Model::kEquidistant) {
    append(out, "  model: equidistant\n  distortion: [{}, {}, {}, {}]\n", k[0], k[1], k[2], k[3]);
  } else {
    append(out, "  distortion: [{}, {}, {}, {}, {}]\n", k[0], k[1], k[2], k[3], k[4]);
  }
  return out;
}

std::string axis_of(const core::Region& region) {
  if (region.axis_deg == 0.0) return "u";
  return region.axis_deg == 90.0 ? "v" : fmt::format("{}", region.axis_deg);
}

std::string regions_section(const SceneMotion& motion) {
  std::string out = "regions:\n";
  for (const auto& [body, region] : core::simulation::tracking_regions(motion)) {
    const char* role = body == 0 ? "base" : body == core::simulation::kBackgroundBody ? "background" : "structure";
    append(out, "  - name: {}\n    rect: [{}, {}, {}, {}]\n    role: {}\n    axis: {}\n", region.name, region.u_px,
           region.v_px, region.width_px, region.height_px, role, axis_of(region));
  }
  return out;
}

// From the centre of the last plate to that of the ground's: the longest length in the picture.
std::string scale_section(const SceneMotion& motion) {
  const auto& plates = motion.scene().plates;
  const auto& first = plates.front();
  const auto& last = plates.back();
  const auto from = motion.see(motion.scene().n_bodies() - 1, {0.0, 0.0}, 0.0), to = motion.see(0, {0.0, 0.0}, 0.0);
  return fmt::format("scale:\n  known_length_mm: {}\n  from: [{:.2f}, {:.2f}]\n  to: [{:.2f}, {:.2f}]\n",
                     std::hypot(last.x_mm - first.x_mm, last.y_mm - first.y_mm, last.z_mm - first.z_mm), from.u_px,
                     from.v_px, to.u_px, to.v_px);
}

// The default window would reach beyond the plates of a small image.
std::string tracking_section(const Scene& scene) {
  double plate_px = 1e9;
  for (const auto& plate : scene.plates) {
    const double size_mm = std::min(plate.width_mm, plate.height_mm);
    plate_px = std::min(plate_px, size_mm * scene.camera.alpha_px / (plate.z_mm - scene.camera.z_mm));
  }
  const int window_px = std::max(5, static_cast<int>(0.5 * plate_px / 2.0) * 2 + 1);
  if (window_px >= app::TrackingConfig{}.window_px) return {};
  return fmt::format("tracking:\n  window_px: {}\n  min_distance_px: {}\n", window_px, std::max(2, window_px / 3));
}

// A record shorter than the default segment would be refused: at least three segments then fit, overlapping by half.
std::string spectrum_section(const Scene& scene) {
  const double n_frames = std::floor(scene.duration_s * scene.camera.rate_hz);
  if (n_frames >= app::SpectrumConfig{}.segment) return {};
  int segment = 16;
  while (4 * segment <= n_frames) segment *= 2;
  return fmt::format("spectrum:\n  segment: {}\n", segment);
}

}  // namespace

std::string config_text(const SimulateJob& job, const SceneMotion& motion, const std::string& source) {
  std::string out =
      "# Written by `hovermodal simulate`: the declared properties of the simulated camera, and "
      "the regions that a user would mark.\n";
  if (job.depth == Depth::kTracks)
    out += "# No clip was drawn: the source is a file of tracks, for `hovermodal replay`.\n";
  if (job.depth == Depth::kChannels) {
    out += "# No clip was drawn: the source is a file of displacements, for `hovermodal identify`.\n";
  }
  append(out, "method: {}\n", job.method);
  out += camera_section(job, source);
  out += calibration_section(job);
  out += regions_section(motion);
  out += scale_section(motion);
  out += tracking_section(job.scene());
  out += spectrum_section(job.scene());
  return out;
}

void write_config(const std::filesystem::path& folder, const SimulateJob& job, const SceneMotion& motion) {
  const std::string source = std::filesystem::absolute(folder / job.product()).lexically_normal().string();
  drivers::write_file_atomically((folder / "config.yaml").string(), config_text(job, motion, source));
}

}  // namespace tools
