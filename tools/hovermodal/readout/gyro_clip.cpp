#include "tools/hovermodal/readout/gyro_clip.h"
#include "tools/hovermodal/clip_source.h"

#include <fmt/format.h>

#include <functional>
#include <span>
#include <stdexcept>
#include <utility>

#include "drivers/host/command_line.h"
#include "drivers/storage/calibration_file.h"
#include "drivers/storage/csv_lines.h"
#include "drivers/storage/limits.h"
#include "drivers/storage/text_file.h"

namespace tools {
namespace {

// Calls take(numbers) for each row of a file, one per line; a first line of text is skipped.
void for_each_row(const std::string& path, std::size_t n_columns,
                  const std::function<void(std::span<const double>)>& take) {
  drivers::CsvLines lines(path);
  lines.require_lines(drivers::Limits::kGyroRows, "give those of the clip only");
  std::vector<std::string_view> cells;
  std::vector<double> row;
  std::string_view line;
  for (bool first = true; lines.next(line); first = false) {
    if (line.empty() || line.front() == '#') continue;
    drivers::split_cells(line, cells);
    row.clear();
    for (const std::string_view cell : cells) {
      if (const auto number = drivers::parse_number(cell)) row.push_back(*number);
    }
    if (row.size() != n_columns) {
      if (!first) lines.fail(fmt::format("{} numbers expected, separated by commas", n_columns));
      continue;
    }
    take(row);
  }
}

std::vector<core::GyroSample> read_gyro(const GyroClipOptions& options) {
  std::vector<core::GyroSample> gyro;
  for_each_row(options.gyro, 4, [&](std::span<const double> row) {
    gyro.push_back({row[3] * options.time_unit_s, {row[0], row[1], row[2]}});
  });
  return gyro;
}

std::vector<double> read_stamps(const GyroClipOptions& options) {
  std::vector<double> stamps;
  for_each_row(options.stamps, 1, [&](std::span<const double> row) { stamps.push_back(row[0] * options.time_unit_s); });
  if (static_cast<std::size_t>(options.first_stamp) >= stamps.size()) {
    throw std::invalid_argument(fmt::format("readout: --first-stamp {}; {} holds {} stamps", options.first_stamp,
                                            options.stamps, stamps.size()));
  }
  stamps.erase(stamps.begin(), stamps.begin() + options.first_stamp);
  return stamps;
}

// The commonest reasons why a gyro does not cover the frames, with the options that mend them.
void require_cover(const GyroClip& clip, std::size_t n_stamps, const GyroClipOptions& options) {
  if (clip.gyro.empty() || clip.motion.pairs.empty()) return;  // reported where they are fitted
  const double beyond_s = clip.config.beyond_s();
  const double from_s = clip.motion.pairs.front().from_s - beyond_s, to_s = clip.motion.pairs.back().to_s + beyond_s;
  const double first_s = clip.gyro.front().t_s, last_s = clip.gyro.back().t_s;
  if (first_s <= from_s && last_s >= to_s) return;
  const std::string more = n_stamps > clip.motion.n_frames
                               ? fmt::format(" (the clip has {} frames, {} has {} stamps from there on)",
                                             clip.motion.n_frames, options.stamps, n_stamps)
                               : std::string();
  throw std::invalid_argument(fmt::format(
      "readout: {} covers {:.3f} .. {:.3f} s; needed are {:.3f} .. {:.3f} s, the frames by {} and {:.3g} s on either "
      "side: "
      "if the clip begins later than its stamps, --first-stamp is the line of its first frame{}; if the unit of the "
      "times is another one, --time-unit-s states it; a smaller --most-offset-s needs less on either side",
      options.gyro, first_s, last_s, from_s, to_s, options.stamps, beyond_s, more));
}

core::CameraModel camera_model(const GyroClipOptions& options) {
  if (options.calibration.empty()) return {};
  return drivers::read_calibration(options.calibration).camera;
}

}  // namespace

GyroClip read_gyro_clip(const GyroClipOptions& options, bool is_quiet) {
  const core::CameraModel camera = camera_model(options);
  const std::vector<double> stamps_s = read_stamps(options);
  GyroClip out;
  out.motion = track_clip({options.clip, options.decoder_mb}, stamps_s, camera, options.direction,
                          options.hold_out_every, options.ignored, is_quiet);
  out.gyro = read_gyro(options);
  out.config.focal_px = camera.calibrated() ? 0.5 * (camera.fx + camera.fy) : options.focal_px;
  out.config.cx_px = camera.calibrated() ? camera.cx : 0.5 * (out.motion.width_px - 1);
  out.config.cy_px = camera.calibrated() ? camera.cy : 0.5 * (out.motion.height_px - 1);
  out.config.width_px = out.motion.width_px;
  out.config.most_offset_s = options.most_offset_s;
  require_cover(out, stamps_s.size(), options);
  return out;
}

void add_gyro_clip_options(drivers::Command& command, GyroClipOptions& options, bool required) {
  command.option("--clip", options.clip, "Video or folder of images").required(required).type_name("PATH");
  add_decoder_option(command, options.decoder_mb);
  command.option("--stamps", options.stamps, "Start of exposure of the first line of every frame, one per line")
      .required(required)
      .type_name("FILE");
  command.option("--gyro", options.gyro, "wx,wy,wz,t per line: rad/s, and time on the stamps' clock")
      .required(required)
      .type_name("FILE");
  command.option("--time-unit-s", options.time_unit_s, "Time unit of both files, in seconds")
      .range(1e-9, 1.0)
      .show_default();
  command.option("--first-stamp", options.first_stamp, "Line of the clip's first frame, counted from 0")
      .range(0, 100000000)
      .show_default();
  command.option("--calibration", options.calibration, "Kalibr, OpenCV or ROS YAML: points are undistorted")
      .type_name("FILE");
  command.option("--focal-px", options.focal_px, "Focal length; 0 = estimated").range(0.0, 1e6).show_default();
  command.option("--most-offset-s", options.most_offset_s, "Largest offset between the two clocks")
      .range(0.0, 10.0)
      .show_default();
  command.option("--hold-out-every", options.hold_out_every, "One of this many frame pairs is held out of the fit")
      .range(2, 1000)
      .show_default();
  command.option("--readout-direction", options.direction, "Direction in which lines are read in the image");
  command
      .option("--ignore", options.ignored,
              "left,top,width,height (px) of an object that moves with the camera (a dashboard, a landing "
              "leg); may be repeated")
      .separator(',')
      .type_name("RECT");
}

}  // namespace tools
