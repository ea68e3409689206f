// hovermodal readout: a camera turned by hand beside a gyro gives its readout time.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>

#include "core/geometry/gyro_readout.h"
#include "drivers/storage/calibration_file.h"
#include "drivers/storage/csv_lines.h"
#include "drivers/storage/json.h"
#include "drivers/storage/text_file.h"
#include "tools/hovermodal/commands.h"
#include "tools/hovermodal/readout/clip_motion.h"
#include "tools/hovermodal/readout/residual_svg.h"

namespace tools {
namespace {

struct Options {
  std::string clip, stamps, gyro, calibration, picture;
  std::vector<std::array<double, 4>> ignored;
  double time_unit_s = 1.0, focal_px = 0.0, most_offset_s = 0.1;
  int first_stamp = 0, hold_out_every = 4;
  core::ReadoutDirection direction = core::ReadoutDirection::kDown;
};

// Numbers of a file, one row a line; a first line of words is skipped.
std::vector<std::vector<double>> read_rows(const std::string& path, std::size_t n_columns) {
  drivers::CsvLines lines(path);
  std::vector<std::vector<double>> rows;
  std::vector<std::string_view> cells;
  std::string_view line;
  for (bool first = true; lines.next(line); first = false) {
    if (line.empty() || line.front() == '#') continue;
    drivers::split_cells(line, cells);
    std::vector<double> row;
    for (const std::string_view cell : cells) {
      if (const auto number = drivers::parse_number(cell)) row.push_back(*number);
    }
    if (row.size() == n_columns) {
      rows.push_back(std::move(row));
    } else if (!first) {
      lines.fail(fmt::format("{} numbers expected, separated by commas", n_columns));
    }
  }
  return rows;
}

std::vector<core::GyroSample> read_gyro(const Options& options) {
  std::vector<core::GyroSample> gyro;
  for (const std::vector<double>& row : read_rows(options.gyro, 4)) {
    gyro.push_back({row[3] * options.time_unit_s, {row[0], row[1], row[2]}});
  }
  return gyro;
}

std::vector<double> read_stamps(const Options& options) {
  std::vector<double> stamps;
  for (const std::vector<double>& row : read_rows(options.stamps, 1)) stamps.push_back(row[0] * options.time_unit_s);
  if (static_cast<std::size_t>(options.first_stamp) >= stamps.size())
    throw std::invalid_argument(fmt::format("readout: --first-stamp {}; {} holds {} stamps", options.first_stamp,
                                            options.stamps, stamps.size()));
  stamps.erase(stamps.begin(), stamps.begin() + options.first_stamp);
  return stamps;
}

core::CameraModel camera_model(const Options& options) {
  if (options.calibration.empty()) return {};
  return drivers::read_calibration(options.calibration).camera;
}

void print(const Options& options, const ClipMotion& clip, const core::GyroReadout& found) {
  const bool rows =
      options.direction == core::ReadoutDirection::kDown || options.direction == core::ReadoutDirection::kUp;
  const int lines = rows ? clip.height_px : clip.width_px;
  std::size_t n_points = 0, n_held = 0;
  for (const core::FramePair& pair : clip.pairs) {
    n_points += pair.points.size();
    n_held += pair.held_out ? 1 : 0;
  }
  const auto deg = 180.0 / std::numbers::pi;
  fmt::print("readout_ms\t{:.3f}\t{:.3f}\n", 1e3 * found.readout.readout_s, 1e3 * found.readout.std_s);
  fmt::print("row_delay_us\t{:.3f}\t{:.3f}\n", 1e6 * found.readout.readout_s / lines,
             1e6 * found.readout.std_s / lines);
  for (const core::ReadoutValue& half : found.halves)
    fmt::print("half_readout_ms\t{:.3f}\t{:.3f}\n", 1e3 * half.readout_s, 1e3 * half.std_s);
  fmt::print("focal_px\t{:.1f}\t{:.1f}\n", found.focal_px, found.focal_std_px);
  fmt::print("clock_offset_ms\t{:.3f}\t{:.3f}\n", 1e3 * found.offset_s, 1e3 * found.offset_std_s);
  fmt::print("gyro_bias_deg_s\t{:.3f}\t{:.3f}\t{:.3f}\n", deg * found.bias_rad_s.x(), deg * found.bias_rad_s.y(),
             deg * found.bias_rad_s.z());
  fmt::print("point_sigma_px\t{:.3f}\n", found.sigma_px);
  fmt::print("held_out_rms_px\t{:.3f}\t{:.3f}\n", found.rms_without_px, found.rms_with_px);
  fmt::print("# {} frame pairs, {} of them held out, {} points; value, standard deviation\n", clip.pairs.size(), n_held,
             n_points);
  fmt::print(
      "# held_out_rms_px: points' distance from where the gyro and a shift of the camera put their epipolar lines, "
      "with a\n"
      "#   readout of 0 and with that found; all else is fitted in both. In hovermodald: camera.readout_ms,\n"
      "#   camera.readout_sigma_ms\n");
}

void run(const Options& options) {
  const core::CameraModel camera = camera_model(options);
  const ClipMotion clip = track_clip(options.clip, read_stamps(options), camera, options.direction,
                                     options.hold_out_every, options.ignored);
  core::GyroReadoutConfig config;
  config.focal_px = camera.calibrated() ? 0.5 * (camera.fx + camera.fy) : options.focal_px;
  config.cx_px = camera.calibrated() ? camera.cx : 0.5 * (clip.width_px - 1);
  config.cy_px = camera.calibrated() ? camera.cy : 0.5 * (clip.height_px - 1);
  config.width_px = clip.width_px;
  config.most_offset_s = options.most_offset_s;
  const core::GyroReadout found = core::fit_gyro_readout(clip.pairs, read_gyro(options), config);
  print(options, clip, found);
  if (!options.picture.empty()) drivers::write_file_atomically(options.picture, residual_svg(clip, found));
}

}  // namespace

void add_readout(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("readout",
                         "Readout time of a camera that is shaken beside a gyro (a phone: shake it about "
                         "all axes for ten seconds; it may be carried or driven forward)\n"
                         "  hovermodal readout --clip frames --stamps framestamp.txt --gyro gyro.txt");
  command->add_option("--clip", options->clip, "Video or folder of images")->required()->type_name("PATH");
  command->add_option("--stamps", options->stamps, "Start of exposure of every frame's first line, one a line")
      ->required()
      ->type_name("FILE");
  command->add_option("--gyro", options->gyro, "wx,wy,wz,t a line: rad/s and the stamps' clock")
      ->required()
      ->type_name("FILE");
  command->add_option("--time-unit-s", options->time_unit_s, "Seconds in a unit of both files' times")
      ->check(CLI::Range(1e-9, 1.0))
      ->capture_default_str();
  command->add_option("--first-stamp", options->first_stamp, "Line of the clip's first frame, counted from 0")
      ->check(CLI::Range(0, 100000000))
      ->capture_default_str();
  command->add_option("--calibration", options->calibration, "Kalibr, OpenCV or ROS YAML: points are undistorted")
      ->type_name("FILE");
  command->add_option("--focal-px", options->focal_px, "Focal length; 0 = estimated")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  command->add_option("--most-offset-s", options->most_offset_s, "The two clocks differ by less than this")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  command
      ->add_option("--hold-out-every", options->hold_out_every, "Every so many frame pairs one is kept out of the fit")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  const std::map<std::string, core::ReadoutDirection> directions{{"down", core::ReadoutDirection::kDown},
                                                                 {"up", core::ReadoutDirection::kUp},
                                                                 {"left", core::ReadoutDirection::kLeft},
                                                                 {"right", core::ReadoutDirection::kRight}};
  command->add_option("--readout-direction", options->direction, "The way lines are read in the picture")
      ->transform(CLI::CheckedTransformer(directions))
      ->type_name("down|up|left|right");
  command
      ->add_option(
          "--ignore", options->ignored,
          "left,top,width,height (px) of what moves with the camera (a dashboard, a landing leg); may be repeated")
      ->delimiter(',')
      ->type_name("RECT");
  command->add_option("--picture", options->picture, "SVG of the residual per frame")->type_name("FILE");
  command->callback([options] { run(*options); });
}

}  // namespace tools
