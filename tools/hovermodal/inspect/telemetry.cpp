#include "tools/hovermodal/inspect/telemetry.h"

#include <fmt/format.h>

#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>

#include "drivers/camera/recording/clip_telemetry.h"
#include "drivers/camera/recording/frame_source.h"
#include "drivers/host/command_line.h"

namespace tools {

namespace {

struct Options {
  std::string file, attitude;
};

void write_attitude(const drivers::ClipTelemetry& telemetry, const Options& options) {
  if (telemetry.attitude.size() < 2)
    throw std::runtime_error(fmt::format("{}: no attitude in {}", options.file, telemetry.from));
  std::ofstream out(options.attitude, std::ios::binary);
  out << fmt::format("# attitude by the {} of {}\nt_s,qw,qx,qy,qz\n", telemetry.attitude_from, telemetry.from);
  for (const core::AttitudeSample& one : telemetry.attitude) {
    const auto& q = one.wxyz;
    out << fmt::format("{:.6f},{:.9f},{:.9f},{:.9f},{:.9f}\n", one.t_s, q[0], q[1], q[2], q[3]);
  }
  out.close();
  if (!out) throw std::runtime_error(fmt::format("{}: cannot be written", options.attitude));
  fmt::print("{}: {} attitudes; use it with camera.attitude_file\n", options.attitude, telemetry.attitude.size());
}

void print(const Options& options) {
  drivers::silence_media_libraries();
  const drivers::ClipTelemetry telemetry = drivers::read_telemetry(options.file);
  fmt::print("{}: {}\n", options.file, telemetry.from);
  for (const std::string& words : drivers::telemetry_words(telemetry)) fmt::print("  {}\n", words);
  if (!telemetry.readout_s.empty())
    fmt::print("  to use it: camera: {{readout_ms: {:.3f}}}\n", 1e3 * telemetry.readout_s.front().value);
  if (!options.attitude.empty()) write_attitude(telemetry, options);
}

}  // namespace

void add_inspect_telemetry(drivers::Command& inspect) {
  drivers::Command telemetry = inspect.subcommand(
      "telemetry", "List what the camera wrote beside or in a clip: times of frames, exposure, zoom, attitude");
  const auto options = std::make_shared<Options>();
  telemetry.option("FILE", options->file, "Video (its .SRT or GPMF is found), .SRT, or GPMF bytes (.raw)").required();
  telemetry.option("--attitude", options->attitude, "Write the attitude to this CSV, for camera.attitude_file");
  telemetry.on_run([options] { print(*options); });
}

}  // namespace tools
