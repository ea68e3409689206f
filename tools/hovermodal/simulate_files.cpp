#include "tools/hovermodal/simulate_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "drivers/storage/csv_writer.h"
#include "drivers/storage/json.h"
#include "firmware_app/config.h"
#include "tools/hovermodal/simulate_progress.h"

namespace tools {
namespace {

using core::simulation::Scene;
using core::simulation::SceneMotion;
using Json = nlohmann::ordered_json;

constexpr int kRendererVersion = 1;  // raise when the same scene gives other pixels or tracks

Json texture_json(const core::simulation::TextureParameters& texture) {
  return {{"pitch_mm", texture.pitch_mm}, {"mean", texture.mean}, {"contrast_rms", texture.contrast_rms}};
}

Json plates_json(const Scene& scene) {
  Json plates = Json::array();
  for (const auto& plate : scene.plates) {
    plates.push_back({{"name", plate.name},
                      {"centre_mm", {plate.x_mm, plate.y_mm, plate.z_mm}},
                      {"size_mm", {plate.width_mm, plate.height_mm}},
                      {"texture", texture_json(plate.texture)}});
  }
  return plates;
}

Json scene_json(const Scene& scene) {
  const auto& camera = scene.camera;
  const auto& hover = scene.hover;
  return {{"seed", scene.seed},
          {"duration_s", scene.duration_s},
          {"camera",
           {{"width_px", camera.width_px},
            {"height_px", camera.height_px},
            {"alpha_px", camera.alpha_px},
            {"cx_px", camera.cx_px},
            {"cy_px", camera.cy_px},
            {"rate_hz", camera.rate_hz},
            {"readout_ms", 1e3 * camera.readout_s},
            {"readout_direction", "down"},
            {"exposure_ms", 1e3 * camera.exposure_s},
            {"noise_sigma", camera.noise_sigma}}},
          {"excitation",
           {{"band_low_hz", scene.excitation.band_low_hz},
            {"band_high_hz", scene.excitation.band_high_hz},
            {"rms_mm", scene.excitation.rms_mm}}},
          {"plates", plates_json(scene)},
          {"background", {{"depth_mm", scene.background.depth_mm}, {"texture", texture_json(scene.background.texture)}}},
          {"hover",
           {{"x_rms_mm", hover.x_rms_mm},
            {"y_rms_mm", hover.y_rms_mm},
            {"z_rms_mm", hover.z_rms_mm},
            {"corner_hz", hover.corner_hz},
            {"order", hover.order},
            {"limit_hz", hover.limit_hz}}}};
}

// In free vibration the table stands still, so absolute and relative shapes are the same and the base's component is 0.
Json modes_json(const Scene& scene) {
  Json modes = Json::array();
  for (const core::simulation::TrueMode& mode : core::simulation::modes_of(scene.structure)) {
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
  const auto hover = motion.camera().rms();
  return {{"roof_relative_mm", motion.structure().roof_relative_rms_mm()},
          {"absolute_mm", std::move(absolute)},
          {"base_acceleration_mm_s2", motion.structure().base_acceleration_rms_mm_s2()},
          {"hover_x_mm", hover[0]},
          {"hover_y_mm", hover[1]},
          {"hover_z_mm", hover[2]},
          {"hover_pitch_rad", hover[3]},
          {"hover_yaw_rad", hover[4]},
          {"hover_roll_rad", hover[5]}};
}

std::string path_in(const std::filesystem::path& folder, const char* name) { return (folder / name).string(); }

template <class... Args>
void append(fmt::memory_buffer& out, fmt::format_string<Args...> format, Args&&... args) {
  fmt::format_to(std::back_inserter(out), format, std::forward<Args>(args)...);
}

void end_line(drivers::CsvWriter& csv) {
  csv.buffer().push_back('\n');
  if (!csv.end_line()) csv.commit();  // throws with the reason
}

// The same comment lines as the tracks.csv of a run.
void write_track_header(drivers::CsvWriter& csv, const SimulateJob& job,
                        const std::vector<core::simulation::SceneRegion>& regions) {
  const auto& camera = job.scene.camera;
  std::string names;
  for (const auto& region : regions) names += (names.empty() ? "" : ",") + region.region.name;
  append(csv.buffer(), "# hovermodal tracks, version 1\n# image_size_px: {} x {}\n# rate_hz: {}\n", camera.width_px,
         camera.height_px, camera.rate_hz);
  append(csv.buffer(), "# readout_ms: {}\n# readout_direction: down\n# exposure_ms: {}\n", 1e3 * camera.readout_s,
         1e3 * camera.exposure_s);
  append(csv.buffer(), "# frame_count: {}\n# regions: {}\nframe,t_s,point,region,u_px,v_px,sigma_px",
         job.scene.n_frames(), names);
  end_line(csv);
}

}  // namespace

std::string parameter_line(const SimulateJob& job) {
  Json line{{"renderer", kRendererVersion}, {"product", job.product()}, {"scene", scene_json(job.scene)}};
  if (job.tracks_only) {
    line["tracks"] = {{"points_per_region", job.scene.tracks.points_per_region},
                      {"noise_px", job.scene.tracks.noise_px},
                      {"loss_probability", job.scene.tracks.loss_probability}};
  } else {
    line["crf"] = job.crf;
  }
  return line.dump();
}

bool already_made(const std::filesystem::path& folder, const SimulateJob& job) {
  std::error_code error;
  const auto size = std::filesystem::file_size(folder / job.product(), error);
  if (error || !std::filesystem::exists(folder / "truth_displacements.csv", error)) return false;
  try {
    const Json truth = drivers::read_json_file(path_in(folder, "truth.json"));
    return truth.value("parameters", "") == parameter_line(job) &&
           truth.value("product_bytes", std::uintmax_t{0}) == size;
  } catch (const std::exception&) {
    return false;  // absent, or not ours: made anew
  }
}

void write_truth(const std::filesystem::path& folder, const SimulateJob& job, const SceneMotion& motion) {
  const Json truth{{"version", 1},
                   {"product", job.product()},
                   {"product_bytes", std::filesystem::file_size(folder / job.product())},
                   {"rate_hz", job.scene.camera.rate_hz},
                   {"duration_s", job.scene.duration_s},
                   {"frames", job.scene.n_frames()},
                   {"modes", modes_json(job.scene)},
                   {"rms", rms_json(motion)},
                   {"scene", scene_json(job.scene)},
                   {"parameters", parameter_line(job)}};
  drivers::write_file_atomically(path_in(folder, "truth.json"), drivers::to_json_text(truth).text);
}

void write_true_displacements(const std::filesystem::path& folder, const SceneMotion& motion) {
  const Scene& scene = motion.scene();
  drivers::CsvWriter csv(path_in(folder, "truth_displacements.csv"));
  append(csv.buffer(), "# true absolute displacement in mm at frame / rate + exposure / 2\nt_s");
  for (const auto& plate : scene.plates) append(csv.buffer(), ",{}", plate.name);
  end_line(csv);
  for (std::uint64_t frame = 0; frame < scene.n_frames(); ++frame) {
    const double t_s = static_cast<double>(frame) / scene.camera.rate_hz + 0.5 * scene.camera.exposure_s;
    append(csv.buffer(), "{:.9g}", t_s);
    for (int body = 0; body < scene.n_bodies(); ++body) {
      append(csv.buffer(), ",{:.9g}", motion.structure().displacement_mm(body, t_s));
    }
    end_line(csv);
  }
  csv.commit();
}

void write_tracks(const std::filesystem::path& folder, const SimulateJob& job) {
  const core::simulation::TrackGenerator generator(job.scene);
  drivers::CsvWriter csv(path_in(folder, "tracks.csv"));
  write_track_header(csv, job, generator.regions());
  core::TrackFrame frame;
  Progress progress("simulate", job.scene.n_frames());
  auto timing = generator.timing();
  for (core::simulation::DeliveredFrame delivered; timing.next(delivered);) {
    generator.generate(delivered, frame);
    for (const core::TrackPoint& point : frame.points) {
      if (!point.seen) continue;
      fmt::memory_buffer& out = csv.buffer();
      append(out, "{},", frame.sequence);
      drivers::append_seconds(out, frame.t_start_ns);
      append(out, ",{},{},", point.id, generator.regions()[point.region].region.name);
      drivers::append_fixed(out, point.u_px, 5);
      out.push_back(',');
      drivers::append_fixed(out, point.v_px, 5);
      out.push_back(',');
      drivers::append_fixed(out, point.sigma_px, 5);
      end_line(csv);
    }
    progress.update(delivered.number + 1);
  }
  csv.commit();
}

void write_config(const std::filesystem::path& folder, const SimulateJob& job, const SceneMotion& motion,
                  const std::string& method) {
  const auto& camera = job.scene.camera;
  fmt::memory_buffer out;
  append(out,
         "# Written by `hovermodal simulate`: the simulated camera and what a user would mark in the first frame.\n");
  if (job.tracks_only) append(out, "# No clip was drawn: the source is a file of tracks, for `hovermodal identify`.\n");
  const std::string source = std::filesystem::absolute(folder / job.product()).lexically_normal().string();
  append(out, "method: {}\ncamera:\n  driver: file\n  source: {}\n", method, Json(source).dump());
  append(out, "  rate_hz: {}\n  pace: as_fast_as_possible\n", camera.rate_hz);
  append(out, "  readout_ms: {}\n  readout_direction: down\n  exposure_ms: {}\n", 1e3 * camera.readout_s,
         1e3 * camera.exposure_s);
  append(out, "calibration:\n  fx: {0}\n  fy: {0}\n  cx: {1}\n  cy: {2}\nregions:\n", camera.alpha_px, camera.cx_px,
         camera.cy_px);
  for (const auto& [body, region] : core::simulation::tracking_regions(motion)) {
    const char* role = body == 0 ? "base" : body == core::simulation::kBackgroundBody ? "background" : "structure";
    append(out, "  - name: {}\n    rect: [{}, {}, {}, {}]\n    role: {}\n    axis: u\n", region.name, region.u_px,
           region.v_px, region.width_px, region.height_px, role);
  }
  // The height from the base plate's centre to the roof's: the longest length in the picture.
  const auto& plates = job.scene.plates;
  const auto from = motion.see(job.scene.n_bodies() - 1, {0.0, 0.0}, 0.0), to = motion.see(0, {0.0, 0.0}, 0.0);
  append(out, "scale:\n  known_length_mm: {}\n  from: [{:.2f}, {:.2f}]\n  to: [{:.2f}, {:.2f}]\n",
         std::hypot(plates.back().x_mm - plates[0].x_mm, plates.back().y_mm - plates[0].y_mm), from.u_px, from.v_px,
         to.u_px, to.v_px);
  // The default window would reach beyond the plates of a small image.
  const double plate_px = plates[0].height_mm * camera.alpha_px / plates[0].z_mm;
  const int window_px = std::max(5, static_cast<int>(0.5 * plate_px / 2.0) * 2 + 1);
  if (window_px < app::TrackingConfig{}.window_px) {
    append(out, "tracking:\n  window_px: {}\n  min_distance_px: {}\n", window_px, std::max(2, window_px / 3));
  }
  drivers::write_file_atomically(path_in(folder, "config.yaml"), fmt::to_string(out));
}

}  // namespace tools
