// hovermodal compare: one result compared with another, and both with the truth.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "core/identification/real_shape.h"
#include "drivers/host/command_line.h"
#include "firmware_app/report/modal_json.h"
#include "firmware_app/report/mode_match.h"
#include "tools/hovermodal/commands.h"
#include "tools/hovermodal/compare/sensor.h"

namespace tools {

namespace {

using app::common_channels;
using app::shape_for;
using Shape = std::vector<std::complex<double>>;

// Table 1 of Yoon, Hoskere, Park & Spencer 2017: accelerometers (their reference) and camera on the drone.
struct PaperMode {
  double accelerometer_hz, drone_hz, mac_percent, error_percent;
};
constexpr std::array<PaperMode, 3> kPaperTable1{
    {{1.632, 1.649, 99.99, 1.04}, {5.054, 5.043, 99.86, 0.22}, {8.175, 8.170, 99.67, 0.06}}};

// Least possible scatter for a record of this length: sqrt(zeta / (2 pi f T)), relative.
double scatter(const core::Mode& mode, double duration_s) {
  const double waves = 2.0 * std::numbers::pi * mode.frequency_hz * duration_s;
  return mode.damping_ratio > 0.0 && waves > 0.0 ? std::sqrt(mode.damping_ratio / waves) : 0.0;
}

std::string truth_columns(const app::ModalReport& truth, const core::Mode& found, double duration_s) {
  for (const core::Mode& mode : truth.estimate.modes) {
    if (std::abs(mode.frequency_hz / found.frequency_hz - 1.0) > 0.1) continue;
    const double error = found.frequency_hz / mode.frequency_hz - 1.0;
    return fmt::format("  {:8.3f} {:+8.3f} {:7.2f}", mode.frequency_hz, 100.0 * error,
                       error / scatter(mode, duration_s));
  }
  return {};
}

void print_header(bool with_truth, bool with_paper) {
  fmt::print("{:>4} {:>10} {:>10} {:>8} {:>8} {:>8}", "mode", "found Hz", "ref. Hz", "error %", "MAC %", "real %");
  if (with_truth) fmt::print("  {:>8} {:>8} {:>7}", "true Hz", "error %", "sigmas");
  if (with_paper) fmt::print("   {:>33}", "paper: drone Hz  ref. Hz  error %  MAC %");
  fmt::print("\n");
}

// Modes are numbered by the truth if given, else by the reference.
void print_table(const app::ModalReport& result, const app::ModalReport& reference, const app::ModalReport* truth,
                 bool with_paper) {
  const std::vector<std::string> names = common_channels(result, reference);
  print_header(truth != nullptr, with_paper);
  std::size_t number = 0;
  for (const core::Mode& numbered : (truth != nullptr ? *truth : reference).estimate.modes) {
    const PaperMode* paper = with_paper && number < kPaperTable1.size() ? &kPaperTable1[number] : nullptr;
    ++number;
    const Shape true_shape =
        truth != nullptr ? shape_for(*truth, numbered, names) : shape_for(reference, numbered, names);
    const core::Mode* wanted =
        truth != nullptr ? app::find_mode(reference, numbered, names, true_shape).mode : &numbered;
    const app::ModeMatch match = wanted != nullptr
                                     ? app::find_mode(result, *wanted, names, shape_for(reference, *wanted, names))
                                     : app::find_mode(result, numbered, names, true_shape);
    if (match.mode == nullptr || wanted == nullptr) {
      const bool folded = numbered.frequency_hz > reference.estimate.rate_hz / 2.0;
      fmt::print(
          "{:4} {:>10} {:>10}\n", number,
          match.mode == nullptr ? (folded ? "folded" : "not found") : fmt::format("{:.4f}", match.mode->frequency_hz),
          wanted == nullptr ? "not found" : fmt::format("{:.4f}", wanted->frequency_hz));
      continue;
    }
    fmt::print("{:4} {:10.4f} {:10.4f} {:+8.3f} {:8.3f} {:8.3f}", number, match.mode->frequency_hz,
               wanted->frequency_hz, 100.0 * (match.mode->frequency_hz / wanted->frequency_hz - 1.0), 100.0 * match.mac,
               100.0 * core::real_mac(shape_for(result, *match.mode, names), shape_for(reference, *wanted, names)));
    if (truth != nullptr) fmt::print("{}", truth_columns(*truth, *match.mode, result.estimate.duration_s));
    if (paper != nullptr) {
      fmt::print("   {:14.3f} {:8.3f} {:8.2f} {:6.2f}", paper->drone_hz, paper->accelerometer_hz, paper->error_percent,
                 paper->mac_percent);
    }
    fmt::print("\n");
  }
}

}  // namespace

namespace {

struct CompareOptions {
  std::string result, reference, truth;
  bool paper = false;
  SensorOptions sensor;
};

constexpr const char* kCompareHelp =
    "Frequencies and shapes of one modal.json against another, or against a simulation's truth.json: MAC of the\n"
    "complex shapes, and of them taken as real ones. Or displacements of a run against a contact sensor\n"
    "  hovermodal compare --result out/modal.json --reference out/truth.json\n"
    "  hovermodal compare --sensor laser.csv --run out --channel roof --band 3 14 --report proof\n"
    "      a laser or LVDT on the roof: clocks aligned, RMSE in mm and px, correlation, coherence, bias of the "
    "amplitude\n"
    "  hovermodal compare --sensor accelerometer.lvm --sensor-channel 2 --sensor-unit g --run out --channel roof\n"
    "      an accelerometer, integrated within the band; without --band, that of the common motion is chosen and "
    "stated\n"
    "The sensor's file is a table of numbers, a universal file or a MAT file, as for `identify`; its clock may differ "
    "in\n"
    "offset and rate. Both records are reduced to one band and compared at the camera's instants.";

void add_sensor_options(drivers::Command& command, SensorOptions& options) {
  constexpr const char* kGroup = "Against a contact sensor";
  command.option("--sensor", options.sensor, "Record of the sensor").type_name("FILE").group(kGroup);
  command.option("--run", options.run, "Folder of the run, or a table with the channel").type_name("RUN").group(kGroup);
  command.option("--channel", options.channel, "Channel of the run").type_name("NAME").group(kGroup);
  command.option("--sensor-channel", options.sensor_channel, "Column of the sensor, by name or number from 1")
      .type_name("NAME")
      .group(kGroup);
  command.option("--sensor-unit", options.unit, "Its unit, where the file does not state it: mm, m/s, m/s^2, g, ...")
      .type_name("UNIT")
      .group(kGroup);
  command.option("--quantity", options.quantity, "d displacement, v velocity, a acceleration (default: by the unit)")
      .one_of({"d", "v", "a"})
      .group(kGroup);
  command
      .option("--sensor-rate-hz,--sensor-rate", options.sensor_rate_hz,
              "Samples per second of the sensor, where its file has no times")
      .type_name("HZ")
      .group(kGroup);
  command.option("--rate-hz,--rate", options.rate_hz, "Samples per second of the channel, where its file has no times")
      .type_name("HZ")
      .group(kGroup);
  command.option("--band", options.band, "Band that is compared (default: chosen by coherence)")
      .type_name("LOW HIGH")
      .group(kGroup);
  command
      .option("--max-offset", options.most_offset_s,
              "Largest offset of the clocks' zeros that is searched (default: any)")
      .positive()
      .type_name("S")
      .group(kGroup);
  command.option("--mm-per-px", options.mm_per_px, "Scale, where the run does not state it")
      .positive()
      .type_name("MM")
      .group(kGroup);
  command.option("--report", options.report, "Folder for sensor.json and sensor.svg").type_name("DIR").group(kGroup);
}

void run_compare(const CompareOptions& options) {
  if (!options.sensor.sensor.empty()) {
    if (!options.result.empty() || !options.reference.empty() || !options.truth.empty())
      throw std::invalid_argument("--sensor compares displacements and --result modes; ask for one of them");
    return compare_sensor(options.sensor);
  }
  if (options.result.empty() || options.reference.empty())
    throw std::invalid_argument(
        "--result and --reference are needed, or --sensor and --run; compare --help explains both");
  const app::ModalReport result = app::read_modal_json(options.result);
  const app::ModalReport reference = app::read_modal_json(options.reference);
  app::ModalReport truth;
  if (!options.truth.empty()) truth = app::read_modal_json(options.truth);
  print_table(result, reference, options.truth.empty() ? nullptr : &truth, options.paper);
}

}  // namespace

void add_compare(drivers::Command& app) {
  auto options = std::make_shared<CompareOptions>();
  drivers::Command command = app.subcommand("compare", kCompareHelp);
  command.option("--result", options->result, "modal.json to compare").type_name("FILE");
  command.option("--reference", options->reference, "modal.json or truth.json to compare it with").type_name("FILE");
  command.option("--truth", options->truth, "truth.json: adds the error in units of the smallest possible scatter")
      .type_name("FILE");
  command.flag("--paper", options->paper, "Adds Table 1 of Yoon et al. 2017 beside it");
  add_sensor_options(command, options->sensor);
  command.on_run([options] { run_compare(*options); });
}

}  // namespace tools
