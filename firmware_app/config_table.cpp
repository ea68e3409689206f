#include "firmware_app/config_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace app {
namespace {

using A = AppConfig;
using drivers::YamlNode;
constexpr double kMaxImagePx = 100000.0;

ConfigKey with_default(ConfigKey key, std::string text) {
  key.default_text = std::move(text);
  return key;
}

void add_camera_keys(std::vector<ConfigKey>& keys) {
  using C = CameraConfig;
  keys.push_back(choice_key<CameraDriver>("camera.driver", at(&A::camera, &C::driver),
                                          {{"file", CameraDriver::kFile},
                                           {"synthetic", CameraDriver::kSynthetic},
                                           {"v4l2", CameraDriver::kV4l2},
                                           {"libcamera", CameraDriver::kLibcamera}},
                                          "where frames come from"));
  keys.push_back(with_default(
      text_key("camera.source", at(&A::camera, &C::source), {},
               "file: a video or an image folder; v4l2: a device, e.g. /dev/video0; libcamera: a camera's name"),
      "none; needed by file and v4l2"));
  keys.push_back(with_default(number_key("camera.rate_hz", "Hz", at(&A::camera, &C::rate_hz), {1e-3, 1e6},
                                         "frame rate; set it where a container states a wrong one"),
                              "the source's own"));
  keys.push_back(choice_key<Pace>("camera.pace", at(&A::camera, &C::pace),
                                  {{"realtime", Pace::kRealtime}, {"as_fast_as_possible", Pace::kAsFastAsPossible}},
                                  "file and synthetic: as a live camera would (frames may drop), or lossless"));
  keys.push_back(
      number_key("camera.readout_ms", "ms", at(&A::camera, &C::readout_ms), {-1000, 1000},
                 "rolling shutter: first to last line along readout_direction; 0 = global shutter or unknown"));
  using core::ReadoutDirection;
  keys.push_back(
      choice_key<ReadoutDirection>("camera.readout_direction", at(&A::camera, &C::readout_direction),
                                   {{"down", ReadoutDirection::kDown},
                                    {"up", ReadoutDirection::kUp},
                                    {"left", ReadoutDirection::kLeft},
                                    {"right", ReadoutDirection::kRight}},
                                   "the way the lines are read, in the image as stored; rotation metadata turns it"));
  keys.push_back(number_key("camera.exposure_ms", "ms", at(&A::camera, &C::exposure_ms), {0, 10000},
                            "exposure time; 0 = unknown"));
  keys.push_back(number_key("camera.synthetic.duration_s", "s", at(&A::camera, &C::synthetic_duration_s), {0.1, 21600},
                            "length of the synthetic record"));
  keys.push_back(seed_key("camera.synthetic.seed", at(&A::camera, &C::synthetic_seed),
                          "seed of the synthetic record's motion and noise"));
}

void add_calibration_keys(std::vector<ConfigKey>& keys) {
  using C = CalibrationConfig;
  keys.push_back(with_default(text_key("calibration.file", at(&A::calibration, &C::file), {},
                                       "Kalibr, OpenCV or ROS YAML; instead of the values below"),
                              "none"));
  const std::pair<const char*, double C::*> intrinsics[] = {
      {"fx", &C::fx}, {"fy", &C::fy}, {"cx", &C::cx}, {"cy", &C::cy}};
  for (const auto& [name, member] : intrinsics) {
    const bool is_focal = name[0] == 'f';
    keys.push_back(
        with_default(number_key(std::string("calibration.") + name, "px", at(&A::calibration, member),
                                is_focal ? NumberRange{1, 1e6} : NumberRange{-1e6, 1e6},
                                is_focal ? "focal length; all four of fx fy cx cy, or none" : "principal point"),
                     "none: points are not undistorted"));
  }
  NumberList distortion;
  distortion.ranges.assign(5, NumberRange{-100, 100});
  distortion.n_min = 4;
  distortion.put = [](AppConfig& config, std::size_t, const std::vector<double>& values) {
    config.calibration.distortion = {};
    std::copy(values.begin(), values.end(), config.calibration.distortion.begin());
  };
  distortion.get = [](AppConfig& config, std::size_t) {
    return std::vector<double>(config.calibration.distortion.begin(), config.calibration.distortion.end());
  };
  keys.push_back(numbers_key("calibration.distortion", "", std::move(distortion),
                             "[k1, k2, p1, p2] or [k1, k2, p1, p2, k3], each -100 .. 100",
                             "radial-tangential distortion"));
}

ConfigKey rect_key() {
  NumberList list;
  list.ranges = {{0, kMaxImagePx}, {0, kMaxImagePx}, {1, kMaxImagePx}, {1, kMaxImagePx}};
  list.n_min = 4;
  list.put = [](AppConfig& config, std::size_t i, const std::vector<double>& v) {
    core::Region& region = config.regions[i];
    region.u_px = v[0], region.v_px = v[1], region.width_px = v[2], region.height_px = v[3];
  };
  list.get = [](AppConfig& config, std::size_t i) {
    const core::Region& region = config.regions[i];
    return std::vector<double>{region.u_px, region.v_px, region.width_px, region.height_px};
  };
  return with_default(
      numbers_key("regions[].rect", "px", std::move(list), "[x, y, w, h], x and y 0 .. 100000, w and h 1 .. 100000",
                  "top-left corner and size in the first image"),
      "none; must be given");
}

ConfigKey axis_key() {
  ConfigKey key{"regions[].axis",
                "one of, or number",
                "degrees",
                "u | v | both | -360 .. 360",
                "u",
                "direction of the displacement: u right, v down, both, or an angle from u towards v",
                {},
                {}};
  key.set = [](AppConfig& config, std::size_t i, const YamlNode& node) -> std::optional<std::string> {
    if (auto remedy = refuse_unless_scalar(node)) return remedy;
    const auto angle = node.text == "u" || node.text == "both" ? 0.0
                       : node.text == "v"                      ? 90.0
                                          : (node.quoted ? std::nullopt : drivers::parse_number(node.text));
    if (!angle || *angle < -360.0 || *angle > 360.0) return "write u, v, both, or an angle";
    config.regions[i].axis_deg = *angle;
    config.regions[i].both_axes = node.text == "both";
    return std::nullopt;
  };
  key.canonical = [](AppConfig& config, std::size_t i) {
    return config.regions[i].both_axes ? std::string("both") : fmt::format("{}", config.regions[i].axis_deg);
  };
  return key;
}

void add_region_keys(std::vector<ConfigKey>& keys) {
  using core::RegionRole;
  keys.push_back(with_default(text_key("regions[].name", at(&core::Region::name), {1, 32, true},
                                       "name of the region; also of its channel (with axis both: NAME.u and NAME.v)"),
                              "none; must be given"));
  keys.push_back(rect_key());
  keys.push_back(choice_key<RegionRole>(
      "regions[].role", at(&core::Region::role),
      {{"structure", RegionRole::kStructure}, {"base", RegionRole::kBase}, {"background", RegionRole::kBackground}},
      "base: moves with the ground of the structure; background: does not move"));
  keys.push_back(axis_key());
}

void add_scale_keys(std::vector<ConfigKey>& keys) {
  using C = ScaleConfig;
  keys.push_back(with_default(number_key("scale.known_length_mm", "mm", at(&A::scale, &C::known_length_mm), {1e-6, 1e9},
                                         "true distance between the two points `from` and `to`"),
                              "none: displacements in px"));
  keys.push_back(with_default(pair_key("scale.from", "px", at(&A::scale, &C::from_px), {0, kMaxImagePx},
                                       "one end of the known length in the first image"),
                              "none"));
  keys.push_back(
      with_default(pair_key("scale.to", "px", at(&A::scale, &C::to_px), {0, kMaxImagePx}, "its other end"), "none"));
  keys.push_back(
      switch_key("scale.adaptive", at(&A::scale, &C::adaptive),
                 "follow the distance to the structure in every frame; false: the camera stands on a tripod"));
}

void add_tracking_keys(std::vector<ConfigKey>& keys) {
  using C = TrackingConfig;
  const auto whole = [&](const char* name, const char* unit, int C::*member, NumberRange range, const char* meaning) {
    keys.push_back(whole_key(std::string("tracking.") + name, unit, at(&A::tracking, member), range, meaning));
  };
  const auto number = [&](const char* name, const char* unit, double C::*member, NumberRange range,
                          const char* meaning) {
    keys.push_back(number_key(std::string("tracking.") + name, unit, at(&A::tracking, member), range, meaning));
  };
  whole("points_per_region", "", &C::points_per_region, {1, 1000}, "corners looked for in each region");
  number("min_distance_px", "px", &C::min_distance_px, {1, 1000}, "between two corners");
  number("corner_quality", "", &C::corner_quality, {1e-6, 1},
         "Harris response relative to the region's strongest corner");
  whole("window_px", "px", &C::window_px, {5, 101}, "side of the tracked patch");
  whole("pyramid_levels", "", &C::pyramid_levels, {1, 10},
        "image pyramid: each level doubles the motion that is followed");
  whole("max_iterations", "", &C::max_iterations, {1, 1000}, "of the tracker per level");
  number("epsilon_px", "px", &C::epsilon_px, {1e-6, 1}, "the tracker stops when a step is smaller");
  number("forward_backward_px", "px", &C::forward_backward_px, {1e-3, 100},
         "a point that misses its start by more on the way back is lost");
  number("inlier_sigma_px", "px", &C::inlier_sigma_px, {1e-3, 100},
         "spread of points that agree with their region's motion");
  whole("min_points", "", &C::min_points, {1, 1000}, "a region with fewer agreeing points has no sample in that frame");
}

void add_analysis_keys(std::vector<ConfigKey>& keys) {
  using S = SpectrumConfig;
  keys.push_back(whole_key("spectrum.segment", "samples", at(&A::spectrum, &S::segment), {16, 1048576},
                           "length of a Welch segment; the record must be at least this long"));
  keys.push_back(
      number_key("spectrum.overlap", "", at(&A::spectrum, &S::overlap), {0, 0.95}, "of neighbouring segments"));
  keys.push_back(text_choice_key("spectrum.window", at(&A::spectrum, &S::window), {"hann", "hamming", "boxcar"},
                                 "taper of a segment"));
  using I = IdentificationConfig;
  keys.push_back(
      whole_key("identification.period", "hops", at(&A::identification, &I::period_hops), {1, 1000000},
                "an estimate every so many hops (a hop is segment * (1 - overlap) samples), and one at the end"));
  keys.push_back(texts_key("identification.references", at(&A::identification, &I::references), {1, 40, true},
                           "reference channels of the correlations; [] = automatic"));
  keys.push_back(whole_key("identification.block_rows", "", at(&A::identification, &I::block_rows), {2, 1000, true},
                           "of the Hankel matrix; 0 = automatic"));
  keys.push_back(whole_key("identification.max_order", "", at(&A::identification, &I::max_order), {2, 500, true},
                           "highest model order; 0 = automatic"));
  keys.push_back(number_key("identification.max_frequency_hz", "Hz", at(&A::identification, &I::max_frequency_hz),
                            {1e-6, 1e6, true}, "poles above are not reported; 0 = half the frame rate"));
  keys.push_back(number_key("identification.min_mpc", "", at(&A::identification, &I::min_mpc), {0, 1},
                            "least phase collinearity (MPC) of a structural mode"));
  keys.push_back(number_key("identification.max_damping", "", at(&A::identification, &I::max_damping), {1e-4, 1},
                            "largest damping ratio of a structural mode"));
}

void add_output_keys(std::vector<ConfigKey>& keys) {
  using T = TelemetryConfig;
  keys.push_back(
      text_key("telemetry.lcm_url", at(&A::telemetry, &T::lcm_url), {}, "where LCM messages go; \"\" = no telemetry"));
  keys.push_back(text_key("telemetry.channel_prefix", at(&A::telemetry, &T::channel_prefix), {1, 32, true},
                          "start of every LCM channel's name"));
  keys.push_back(text_key("telemetry.stream_id", at(&A::telemetry, &T::stream_id), {1, 64, true},
                          "names this service in every message"));
  keys.push_back(text_key("telemetry.log_file", at(&A::telemetry, &T::log_file), {},
                          "also write the messages to this LCM log; \"\" = none"));
  keys.push_back(whole_key("telemetry.tracks_every", "frames", at(&A::telemetry, &T::tracks_every), {0, 1000000},
                           "publish every n-th frame's tracks; 0 = never"));
  keys.push_back(whole_key("telemetry.displacement_every", "frames", at(&A::telemetry, &T::displacement_every),
                           {1, 1000000}, "publish every n-th displacement"));
  keys.push_back(text_key("report.directory", at(&A::report, &ReportConfig::directory), {},
                          "folder for modal.json and CSV files; \"\" = none; --report goes before"));
  keys.push_back(
      switch_key("report.tracks", at(&A::report, &ReportConfig::tracks), "also write tracks.csv (the largest file)"));
  using R = RtConfig;
  keys.push_back(switch_key("rt.required", at(&A::rt, &R::required),
                            "refuse to run where priority or memory lock are denied (exit 4)"));
  keys.push_back(whole_key("rt.priority", "", at(&A::rt, &R::priority), {0, 90},
                           "SCHED_FIFO priority of capture, tracking, spectrum; 0 = ordinary threads"));
  keys.push_back(
      switch_key("rt.lock_memory", at(&A::rt, &R::lock_memory), "keep the service's memory from being paged out"));
  keys.push_back(
      whole_key("rt.frame_slots", "", at(&A::rt, &R::frame_slots), {2, 256}, "frames that may wait for tracking"));
  keys.push_back(whole_key("rt.sample_slots", "", at(&A::rt, &R::sample_slots), {2, 65536},
                           "samples that may wait for spectra and records"));
}

std::vector<ConfigKey> build_keys() {
  std::vector<ConfigKey> keys;
  keys.push_back(choice_key<Method>(
      "method", [](AppConfig& config, std::size_t) -> Method& { return config.method; },
      {{"paper", Method::kPaper}, {"hovermodal", Method::kHovermodal}}, "the published chain, or the improved one"));
  add_camera_keys(keys);
  add_calibration_keys(keys);
  add_region_keys(keys);
  add_scale_keys(keys);
  add_tracking_keys(keys);
  add_analysis_keys(keys);
  add_output_keys(keys);
  return keys;
}

bool changes_results(const ConfigKey& key) {
  return !key.path.starts_with("telemetry.") && !key.path.starts_with("report.") && !key.path.starts_with("rt.");
}

}  // namespace

const std::vector<ConfigKey>& config_keys() {
  static const std::vector<ConfigKey> keys = build_keys();
  return keys;
}

const ConfigKey* find_key(const std::string& path) {
  for (const ConfigKey& key : config_keys()) {
    if (key.path == path) return &key;
  }
  return nullptr;
}

bool is_section(const std::string& path) {
  return std::any_of(config_keys().begin(), config_keys().end(),
                     [&](const ConfigKey& key) { return key.path.starts_with(path + "."); });
}

std::string canonical_text(const AppConfig& config) {
  AppConfig copy = config;
  std::string text;
  for (const ConfigKey& key : config_keys()) {
    if (!changes_results(key)) continue;
    const bool per_region = key.path.starts_with("regions[]");
    for (std::size_t i = 0; i < (per_region ? copy.regions.size() : 1); ++i) {
      text += fmt::format("{}{} = {}\n", key.path, per_region ? fmt::format("#{}", i) : "", key.canonical(copy, i));
    }
  }
  return text;
}

std::uint64_t canonical_hash(const AppConfig& config) {
  std::uint64_t hash = 0xcbf29ce484222325U;  // FNV-1a, 64 bit: offset basis and prime
  for (const char c : canonical_text(config)) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return hash;
}

}  // namespace app
