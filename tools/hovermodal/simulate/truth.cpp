#include "tools/hovermodal/simulate/truth.h"

#include <array>
#include <bit>
#include <complex>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <utility>

#include "drivers/storage/json.h"
#include "tools/hovermodal/simulate/effects.h"

namespace tools {
namespace {

using core::simulation::Scene;
using core::simulation::SceneMotion;
using Json = nlohmann::ordered_json;

constexpr int kRendererVersion = 3;  // increase when the same scene gives other pixels, tracks or channels

// In free vibration the ground does not move, so absolute and relative shapes are equal and the base's component is
// 0.
Json modes_json(const Scene& scene) {
  Json modes = Json::array();
  for (const core::simulation::TrueMode& mode : core::simulation::modes_of(scene.structure)) {
    if (mode.frequency_hz > 2.0 * scene.excitation.band_high_hz) break;  // far above the excited band
    Json shape{{scene.plates[0].name, 0.0}};
    for (std::size_t i = 1; i < scene.plates.size(); ++i) {
      const std::complex<double> value = mode.displacement(static_cast<Eigen::Index>(i) - 1);
      shape[scene.plates[i].name] =
          std::abs(value.imag()) < 1e-9 ? Json(value.real()) : Json::array({value.real(), value.imag()});
    }
    modes.push_back(
        {{"frequency_hz", mode.frequency_hz}, {"damping_ratio", mode.damping_ratio}, {"shape", std::move(shape)}});
  }
  return modes;
}

Json rms_json(const SceneMotion& motion) {
  Json absolute;
  for (int body = 0; body < motion.scene().n_bodies(); ++body) {
    absolute[motion.scene().plates[static_cast<std::size_t>(body)].name] = motion.structure().rms_mm(body);
  }
  Json out{{"roof_relative_mm", motion.structure().roof_relative_rms_mm()},
           {"absolute_mm", std::move(absolute)},
           {"base_acceleration_mm_s2", motion.structure().base_acceleration_rms_mm_s2()}};
  constexpr std::array<const char*, 7> kNames{"camera_x_mm",    "camera_y_mm",     "camera_z_mm", "camera_pitch_rad",
                                              "camera_yaw_rad", "camera_roll_rad", "zoom"};
  const auto camera = motion.camera().rms();
  for (std::size_t i = 0; i < camera.size(); ++i) out[kNames[i]] = camera[i];
  return out;
}

// Declarations in config.yaml, key by key; null = not declared.
Json declared_json(const SimulateJob& job) {
  const auto& camera = job.scene().camera;
  const auto& declare = job.file.declare;
  const auto value = [](const drivers::Declared& declared, double truth) {
    const auto told = declared.of(truth);
    return told ? Json(*told) : Json();
  };
  return {{"readout_ms", value(declare.readout_ms, 1e3 * camera.readout_s)},
          {"exposure_ms", value(declare.exposure_ms, 1e3 * camera.exposure_s)},
          {"rate_hz", value(declare.rate_hz, camera.rate_hz)},
          {"lens", job.declares_lens()},
          {"focal_length", declare.focal_length},
          {"timestamps", job.scene().timing.stamps_tell}};
}

// FNV-1a of the data, because the scene contains only the names of the flight's files.
std::uint64_t hash_of(const core::simulation::RecordedMotion& flight) {
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  for (const auto* axis :
       {&flight.x_mm, &flight.y_mm, &flight.z_mm, &flight.pitch_rad, &flight.yaw_rad, &flight.roll_rad}) {
    for (const double value : *axis) hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x100000001B3ULL;
  }
  return hash;
}

}  // namespace

std::string parameter_line(const SimulateJob& job) {
  Json line{{"renderer", kRendererVersion}, {"product", job.product()}, {"scene", drivers::scene_json(job.file)}};
  if (job.depth == Depth::kPixels && job.crf) line["crf"] = *job.crf;
  if (job.scene().flight) line["flight"] = hash_of(*job.scene().flight);
  return line.dump();
}

bool already_made(const std::filesystem::path& folder, const SimulateJob& job) {
  std::error_code error;
  const auto size = std::filesystem::file_size(folder / job.product(), error);
  if (error || !std::filesystem::exists(folder / "truth_displacements.csv", error)) return false;
  try {
    const Json truth = drivers::read_json_file((folder / "truth.json").string());
    return truth.value("parameters", "") == parameter_line(job) &&
           truth.value("product_bytes", std::uintmax_t{0}) == size;
  } catch (const std::exception&) {
    return false;  // absent, or from another program: written again
  }
}

void write_truth(const std::filesystem::path& folder, const SimulateJob& job, const SceneMotion& motion) {
  const Json scene = drivers::scene_json(job.file);
  const Json truth{{"version", 1},
                   {"product", job.product()},
                   {"product_bytes", std::filesystem::file_size(folder / job.product())},
                   {"rate_hz", job.scene().camera.rate_hz},
                   {"duration_s", job.scene().duration_s},
                   {"frames", job.scene().n_frames()},
                   {"modes", modes_json(job.scene())},
                   {"rms", rms_json(motion)},
                   {"declared", declared_json(job)},
                   {"effects", effects_json(job, scene)},
                   {"scene", scene},
                   {"parameters", parameter_line(job)}};
  drivers::write_file_atomically((folder / "truth.json").string(), drivers::to_json_text(truth).text);
}

}  // namespace tools
