#include "tools/hovermodal/inspect/telemetry.h"

#include <fmt/format.h>

#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "drivers/camera/recording/clip_telemetry.h"
#include "drivers/camera/recording/frame_source.h"
#include "drivers/host/command_line.h"
#include "drivers/storage/json.h"
#include "tools/hovermodal/answer.h"

namespace tools {

namespace {

struct Options {
  std::string file, attitude;
  Answer answer;
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
  options.answer.note("{}: {} attitudes; use it with camera.attitude_file\n", options.attitude,
                      telemetry.attitude.size());
}

void print(const Options& options) {
  drivers::silence_media_libraries();
  const drivers::ClipTelemetry telemetry = drivers::read_telemetry(options.file);
  const std::vector<std::string> told = drivers::telemetry_words(telemetry);
  nlohmann::ordered_json json{
      {"file", options.file}, {"from", telemetry.from}, {"words", told}, {"readout_ms", nullptr}};
  if (!telemetry.readout_s.empty()) json["readout_ms"] = 1e3 * telemetry.readout_s.front().value;
  json["attitudes"] = telemetry.attitude.size();
  options.answer.document(drivers::to_json_text(json).text);
  options.answer.text("{}: {}\n", options.file, telemetry.from);
  for (const std::string& words : told) options.answer.text("  {}\n", words);
  if (!telemetry.readout_s.empty())
    options.answer.text("  to use it: camera: {{readout_ms: {:.3f}}}\n", 1e3 * telemetry.readout_s.front().value);
  if (!options.attitude.empty()) write_attitude(telemetry, options);
}

}  // namespace

void add_inspect_telemetry(drivers::Command& inspect) {
  drivers::Command telemetry = inspect.subcommand(
      "telemetry", "List what the camera wrote beside or in a clip: times of frames, exposure, zoom, attitude");
  const auto options = std::make_shared<Options>();
  telemetry.option("FILE", options->file, "Video (its .SRT or GPMF is found), .SRT, or GPMF bytes (.raw)").required();
  telemetry.option("--attitude", options->attitude, "Write the attitude to this CSV, for camera.attitude_file");
  add_answer_options(telemetry, options->answer, "what was found");
  telemetry.on_run([options] { print(*options); });
}

}  // namespace tools
