#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/geometry/camera_following.h"
#include "core/geometry/camera_model.h"
#include "core/geometry/published_shutter.h"
#include "core/types/frame.h"
#include "core/types/region.h"
#include "drivers/camera/camera_kind.h"

namespace app {

enum class Method : std::uint8_t { kPaper, kHovermodal };
enum class Pace : std::uint8_t { kRealtime, kAsFastAsPossible };

struct PaperConfig {
  core::ShutterVelocity velocity = core::ShutterVelocity::kCamera;  // V_rel of Eq. 8
};

struct CameraConfig {
  drivers::CameraKind driver = drivers::CameraKind::kFile;
  std::string source;  // file: video or image folder; v4l2: a node, empty = the only one attached; stream: an address
  drivers::StreamTransport transport = drivers::StreamTransport::kTcp;  // stream driver only
  double rate_hz = 0.0;                                                 // 0 = the source's own
  std::array<int, 2> size_px{};                                         // devices: width, height; 0 = chosen
  std::string format;                                                   // v4l2: four characters; empty = chosen
  Pace pace = Pace::kAsFastAsPossible;
  double readout_ms = 0.0;         // signed
  double readout_sigma_ms = -1.0;  // of readout_ms; 0 = exact, below 0 = chosen (readout_aware_identifier.h)
  core::ReadoutDirection readout_direction = core::ReadoutDirection::kDown;
  double exposure_ms = 0.0;               // 0 = unknown
  int decoder_mb = drivers::kDecoderMb;   // file and stream
  std::string attitude_file;              // CSV on the frames' clock; empty = none
  std::string attitude_channel;           // LCM channel of attitude_t; empty = none
  std::string aircraft_channel;           // LCM channel of aircraft_t; empty = none
  std::string motors_file;                // CSV of the motors' speeds; empty = none
  double attitude_sigma_deg = 0.1;        // white noise of a sample, per axis
  std::array<double, 3> mount_rpy_deg{};  // of the camera relative to the body whose attitude is given
  double synthetic_duration_s = 30.0;     // synthetic driver only
  std::uint64_t synthetic_seed = 1;
};

struct CalibrationConfig {
  std::string file;                               // Kalibr, OpenCV or ROS YAML; empty = the inline values
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;  // 0 = no calibration: points are not undistorted
  core::LensModel model = core::LensModel::kRadialTangential;
  std::array<double, 8> distortion{};  // radtan: k1 k2 p1 p2 k3 k4 k5 k6; equidistant: k1 k2 k3 k4
};

struct ScaleConfig {
  double known_length_mm = 0.0;  // 0 = unknown: displacements are in px (scale 1, unit px)
  std::array<double, 2> from_px{}, to_px{};
  std::vector<std::array<double, 5>> lengths;  // more known lengths: u1 v1 u2 v2 (px), mm; one scale by least squares
  std::vector<std::array<double, 4>> points;   // points of the structure's plane, for its pose: u v (px), x y (mm)
  double point_sigma_px = 0.5;                 // standard deviation of these pixels, per axis
  double max_obliqueness_deg = 10.0;           // largest angle to the image plane not excluded
  bool adaptive = true;                        // false: the camera is fixed (a tripod)
  core::CameraFollowing following = core::CameraFollowing::kSlow;  // kDistance: only the camera's distance (Eq. 6)
};

struct TrackingConfig {
  int points_per_region = 30;
  double min_distance_px = 8.0;
  double corner_quality = 0.01;  // Harris response relative to the region's strongest
  int window_px = 21;
  int max_iterations = 12;
  double reach_px = 8.0;
  double search_px = 200.0;
  double least_correlation = 0.75;
  double inlier_sigma_px = 0.3;
  int min_points = 3;      // a region with fewer inliers has no sample
  int reseed_after = 250;  // frames; 0 = never
};

struct SpectrumConfig {
  int segment = 512;  // samples
  double overlap = 0.5;
  std::string window = "hann";  // hann | hamming | boxcar
  bool witness = true;          // remove motion coherent with a static region from shapes
  double forget_s = 0.0;        // a segment is weighted by exp(-age / forget_s); 0 = never
};

struct IdentificationConfig {
  int period_hops = 4;                  // hops between estimates; more at the start and at the end
  std::vector<std::string> references;  // channel names; empty = automatic
  int block_rows = 0;                   // 0 = automatic
  int max_order = 0;                    // 0 = automatic
  double max_frequency_hz = 0.0;        // 0 = rate / 2
  double min_mpc = 0.8;
  double max_damping = 0.15;
};

enum class ClosureAdopt : std::uint8_t { kOff, kReport, kAuto };

struct ClosureConfig {
  ClosureAdopt adopt = ClosureAdopt::kReport;
  double window_s = 120.0;  // stretch of newest tracks that is analysed
  int points_per_region = 12;
  double period_s = 60.0;   // stream time between two reports
  double least_px = 0.005;  // smallest effect reported: rms point displacement
  double delay_s = 30.0;    // from the last frame of a report to the first it corrects
  std::string structure;    // file of the declared structure, compared at the end of a run; empty = none
};

struct TelemetryConfig {
  std::string lcm_url = "udpm://239.255.76.67:7667?ttl=0";  // empty = no telemetry
  std::string channel_prefix = "HOVERMODAL";
  std::string stream_id = "hovermodal";
  std::string log_file;   // also write an LCM event log; empty = none
  int tracks_every = 25;  // publish the tracks of every n-th frame; 0 = never
  int displacement_every = 1;
  double max_kbit_s = 0.0;        // over the network; 0 = no limit
  double preview_period_s = 1.0;  // stream time between two preview images; 0 = none
  int preview_px = 320;           // largest long side of a preview image
};

struct ReportConfig {
  std::string directory;  // --report overrides; empty = none
  bool tracks = true;     // write tracks.csv (the largest file)
  int keep = 3;           // earlier reports that stay in the folder, as report.1, report.2, ...
  // For the head of report.html.
  std::string title;               // of the measurement; empty = none
  std::vector<std::string> notes;  // "place: ...", or a sentence
  std::string compare;             // modal.json or truth.json of a former run or a model; empty = none
};

struct RecordConfig {
  std::string directory;  // LCM event logs of the run, to be replayed; empty = none
  int file_mb = 512;      // size at which the next file begins
  int quota_mb = 8192;    // of all records in the directory; the oldest runs are deleted
};

struct StateConfig {
  std::string directory;  // for checkpoints; empty = none
  double period_s = 60.0;
};

struct RtConfig {
  bool required = false;  // refuse to run without the priorities below
  int priority = 0;       // SCHED_FIFO priority of capture, tracking, spectrum; 0 = ordinary
  int capture_cpu = -1, tracking_cpu = -1, spectrum_cpu = -1;  // processor to pin the thread to; -1 = any
  bool lock_memory = false;
  double stall_s = 10.0;      // a longer step is reported and the watchdog not fed
  bool thin_overload = true;  // under overload keep every n-th frame, rather than those that happen to find room
  int frame_slots = 0;        // 0 = chosen: fewer for a lossless source, which waits
  int sample_slots = 256;
};

struct AppConfig {
  Method method = Method::kHovermodal;
  PaperConfig paper;
  CameraConfig camera;
  CalibrationConfig calibration;
  std::vector<core::Region> regions;
  ScaleConfig scale;
  TrackingConfig tracking;
  SpectrumConfig spectrum;
  IdentificationConfig identification;
  ClosureConfig closure;
  TelemetryConfig telemetry;
  ReportConfig report;
  RecordConfig record;
  StateConfig state;
  RtConfig rt;
  std::uint64_t hash = 0;  // FNV-1a of the canonical text of everything above that changes results
};

// "FILE:LINE: section.key: VALUE is refused: allowed RANGE; remedy" (exit code 2).
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Reads `path`, applies `overrides` ("section.key=value", in order), validates. Unknown or duplicate keys, wrong types,
// NaN and values out of range are refused: throws ConfigError naming file, line, key, value and allowed range.
[[nodiscard]] AppConfig load_config(const std::string& path, const std::vector<std::string>& overrides = {});

// The same from text in memory; `name` stands for the file in messages.
[[nodiscard]] AppConfig parse_config(const std::string& text, const std::string& name,
                                     const std::vector<std::string>& overrides = {});

// Every key with unit, default, range and meaning: the text of --help-config.
[[nodiscard]] std::string config_help();

}  // namespace app
