#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/types/role_names.h"
#include "firmware_app/config/config_sections.h"
#include "firmware_app/config/region_axis.h"

namespace app {
namespace {

using A = AppConfig;
using drivers::YamlNode;

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
                  "top-left corner and size of the region in the first image"),
      "none; must be given");
}

ConfigKey axis_key() {
  ConfigKey key{"regions[].axis",
                "one of, or number",
                "degrees",
                "auto | u | v | both | -360 .. 360",
                "auto",
                "image direction in which the displacement of the region is measured: u right, v down, both "
                "(two channels, NAME.u and NAME.v), an angle from u towards v, or auto: found from the structure's "
                "motion in the first seconds, and stated",
                {},
                {}};
  key.set = [](AppConfig& config, std::size_t i, const YamlNode& node) -> std::optional<std::string> {
    if (auto remedy = refuse_unless_scalar(node)) return remedy;
    const bool is_number = drivers::parse_number(node.text).has_value();
    if ((node.quoted && is_number) || !put_axis(node.text, config.regions[i]))
      return "write auto, u, v, both, or an angle";
    return std::nullopt;
  };
  key.canonical = [](AppConfig& config, std::size_t i) { return axis_key_text(config.regions[i]); };
  return key;
}

void add_device_keys(std::vector<ConfigKey>& keys) {
  NumberList size;
  size.ranges = {{32, kMaxImagePx}, {32, kMaxImagePx}};
  size.n_min = 2;
  size.put = [](AppConfig& config, std::size_t, const std::vector<double>& v) {
    config.camera.size_px = {static_cast<int>(v[0]), static_cast<int>(v[1])};
  };
  size.get = [](AppConfig& config, std::size_t) {
    return std::vector<double>(config.camera.size_px.begin(), config.camera.size_px.end());
  };
  keys.push_back(
      with_default(numbers_key("camera.size", "px", std::move(size), "[w, h], 32 .. 100000",
                               "v4l2 and libcamera: image size (`hovermodal inspect cameras` lists the sizes)"),
                   "the largest up to 1920 x 1080 that is available at rate_hz"));
  keys.push_back(with_default(text_key("camera.format", at(&A::camera, &CameraConfig::format), {0, 4, true},
                                       "v4l2: pixel format, e.g. GREY, YUYV, MJPG"),
                              "the format with the lowest conversion cost"));
}

void add_attitude_keys(std::vector<ConfigKey>& keys) {
  using C = CameraConfig;
  keys.push_back(
      with_default(text_key("camera.attitude_file", at(&A::camera, &C::attitude_file), {},
                            "CSV file with the attitude of the aircraft or gimbal on the frames' clock: t_s, and "
                            "roll_deg, pitch_deg, yaw_deg or qw, qx, qy, qz; measures the camera's rotation where no "
                            "static region is in view (needs a calibration, and not scale.only: true)"),
                   "none"));
  keys.push_back(
      with_default(text_key("camera.attitude_channel", at(&A::camera, &C::attitude_channel), {0, 63, true},
                            "the attitude, received live: LCM channel of attitude_t messages, at telemetry.lcm_url"),
                   "none"));
  keys.push_back(
      with_default(text_key("camera.aircraft_channel", at(&A::camera, &C::aircraft_channel), {0, 63, true},
                            "motor speeds, position and wind, received live: LCM channel of aircraft_t messages, at "
                            "telemetry.lcm_url (sent by `hovermodal mavlink`); the report states them"),
                   "none"));
  keys.push_back(
      with_default(text_key("camera.motors_file", at(&A::camera, &C::motors_file), {},
                            "CSV file with the speeds of the aircraft's motors (t_s, motor, hz; written by `hovermodal "
                            "mavlink --motors`): poles and rotor lines at a multiple of a motor's rate name it"),
                   "none"));
  keys.push_back(
      number_key("camera.attitude_sigma_deg", "deg", at(&A::camera, &C::attitude_sigma_deg), {1e-4, 45},
                 "standard deviation of the white noise of one attitude sample about each axis, without slow "
                 "drift"));
  NumberList mount;
  mount.ranges.assign(3, NumberRange{-360, 360});
  mount.n_min = 3;
  mount.put = [](AppConfig& config, std::size_t, const std::vector<double>& v) {
    std::copy(v.begin(), v.end(), config.camera.mount_rpy_deg.begin());
  };
  mount.get = [](AppConfig& config, std::size_t) {
    return std::vector<double>(config.camera.mount_rpy_deg.begin(), config.camera.mount_rpy_deg.end());
  };
  keys.push_back(numbers_key("camera.mount_rpy_deg", "deg", std::move(mount), "[roll, pitch, yaw], -360 .. 360",
                             "orientation of the camera relative to the body whose attitude is given: [0, 0, 0] looks "
                             "ahead, top up; [0, -90, 0] looks down; [0, 0, 90] looks to the right"));
}

}  // namespace

void add_camera_keys(std::vector<ConfigKey>& keys) {
  using C = CameraConfig;
  keys.push_back(
      named_key("camera.driver", at(&A::camera, &C::driver), drivers::kCameraKindNames, "source of the frames"));
  keys.push_back(with_default(
      text_key(
          "camera.source", at(&A::camera, &C::source), {},
          "file: a video or an image folder; v4l2: a device, e.g. /dev/video0; libcamera: a camera's name; stream: "
          "rtsp://HOST/PATH, udp://:PORT or tcp://HOST:PORT (MPEG-TS), or an .sdp file"),
      "none; needed by file and stream; v4l2 and libcamera: the only camera attached"));
  keys.push_back(named_key("camera.transport", at(&A::camera, &C::transport), drivers::kStreamTransportNames,
                           "stream, of rtsp addresses: tcp sends lost packets again; udp does not, and delays less"));
  keys.push_back(with_default(number_key("camera.rate_hz", "Hz", at(&A::camera, &C::rate_hz), {1e-3, 1e6},
                                         "frame rate; set it if the video container states a wrong one"),
                              "the source's own; a device: its highest"));
  keys.push_back(
      choice_key<Pace>("camera.pace", at(&A::camera, &C::pace),
                       {{"realtime", Pace::kRealtime}, {"as_fast_as_possible", Pace::kAsFastAsPossible}},
                       "file and synthetic: realtime delivers frames like a live camera (frames may be dropped); "
                       "as_fast_as_possible is lossless"));
  keys.push_back(number_key("camera.readout_ms", "ms", at(&A::camera, &C::readout_ms), {-1000, 1000},
                            "rolling shutter: time from the first to the last line along readout_direction; 0 = global "
                            "shutter or unknown"));
  keys.push_back(with_default(
      number_key("camera.readout_sigma_ms", "ms", at(&A::camera, &C::readout_sigma_ms), {-1, 1000},
                 "standard deviation of readout_ms, which is combined with the readout time estimated from "
                 "the tracks; 0 = exact, -1 = automatic"),
      "-1: 1 ms, or half a frame where readout_ms is 0"));
  using core::ReadoutDirection;
  keys.push_back(choice_key<ReadoutDirection>(
      "camera.readout_direction", at(&A::camera, &C::readout_direction),
      {{"down", ReadoutDirection::kDown},
       {"up", ReadoutDirection::kUp},
       {"left", ReadoutDirection::kLeft},
       {"right", ReadoutDirection::kRight}},
      "direction in which the lines are read, in the image as stored; rotation metadata of the "
      "video rotates it"));
  keys.push_back(number_key("camera.exposure_ms", "ms", at(&A::camera, &C::exposure_ms), {0, 10000},
                            "exposure time; 0 = unknown; devices: automatic exposure, then locked"));
  keys.push_back(whole_key(
      "camera.decoder_mb", "MB", at(&A::camera, &C::decoder_mb), {drivers::kLeastDecoderMb, drivers::kMostDecoderMb},
      "file and stream: memory for decoding; a video that needs more is refused. 4K fits; raise it "
      "for 8K, and for 5K of 10 bits"));
  add_device_keys(keys);
  add_attitude_keys(keys);
  keys.push_back(number_key("camera.synthetic.duration_s", "s", at(&A::camera, &C::synthetic_duration_s), {0.1, 21600},
                            "duration of the synthetic record"));
  keys.push_back(seed_key("camera.synthetic.seed", at(&A::camera, &C::synthetic_seed),
                          "seed of the random motion and noise of the synthetic record"));
}

void add_calibration_keys(std::vector<ConfigKey>& keys) {
  using C = CalibrationConfig;
  keys.push_back(
      with_default(text_key("calibration.file", at(&A::calibration, &C::file), {},
                            "calibration file of Kalibr, OpenCV or ROS (YAML), in place of the values below"),
                   "none"));
  const std::array<std::pair<const char*, double C::*>, 4> intrinsics{
      {{"fx", &C::fx}, {"fy", &C::fy}, {"cx", &C::cx}, {"cy", &C::cy}}};
  for (const auto& [name, member] : intrinsics) {
    const bool is_focal = name[0] == 'f';
    keys.push_back(
        with_default(number_key(std::string("calibration.") + name, "px", at(&A::calibration, member),
                                is_focal ? NumberRange{1, 1e6} : NumberRange{-1e6, 1e6},
                                is_focal ? "focal length; all four of fx fy cx cy, or none" : "principal point"),
                     "none: points are not undistorted"));
  }
  keys.push_back(choice_key<core::LensModel>(
      "calibration.model", at(&A::calibration, &C::model),
      {{"radtan", core::LensModel::kRadialTangential}, {"equidistant", core::LensModel::kEquidistant}},
      "distortion model of `distortion` below: radtan (radial-tangential) or equidistant (fisheye "
      "lenses)"));
  NumberList distortion;
  distortion.ranges.assign(8, NumberRange{-1e5, 1e5});
  distortion.n_min = 4;
  distortion.put = [](AppConfig& config, std::size_t, const std::vector<double>& values) {
    config.calibration.distortion = {};
    std::copy(values.begin(), values.end(), config.calibration.distortion.begin());
  };
  distortion.get = [](AppConfig& config, std::size_t) {
    return std::vector<double>(config.calibration.distortion.begin(), config.calibration.distortion.end());
  };
  keys.push_back(numbers_key("calibration.distortion", "", std::move(distortion),
                             "[k1, k2, p1, p2], and k3, and k4 k5 k6 (rational); equidistant: [k1, k2, k3, k4]",
                             "distortion coefficients in the order of OpenCV"));
}

void add_region_keys(std::vector<ConfigKey>& keys) {
  keys.push_back(
      with_default(text_key("regions[].name", at(&core::Region::name), {1, 32, true},
                            "name of the region and of its channel (with axis both: channels NAME.u and NAME.v)"),
                   "none; must be given"));
  keys.push_back(rect_key());
  keys.push_back(
      named_key("regions[].role", at(&core::Region::role), core::kRoleNames,
                "structure: a part whose modes are measured; base: moves with the ground under the structure "
                "(measured input); background: static, elsewhere; ground: static, in the structure's plane"));
  keys.push_back(axis_key());
  add_region_length_key(keys);
  keys.push_back(number_key("regions[].depth_m", "m", at(&core::Region::depth_m), {0, 1e6},
                            "background only: distance of the region along the optical axis; 0 = unknown, treated as "
                            "infinitely far"));
}

}  // namespace app
