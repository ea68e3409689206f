// hovermodal compare: one result compared with another, and both with the truth.
#include <memory>
#include <stdexcept>

#include "drivers/host/command_line.h"
#include "firmware_app/report/modal_json.h"
#include "tools/hovermodal/answer.h"
#include "tools/hovermodal/commands.h"
#include "tools/hovermodal/compare/modes.h"
#include "tools/hovermodal/compare/sensor.h"

namespace tools {

namespace {

struct CompareOptions {
  std::string result, reference, truth;
  bool paper = false;
  Answer answer;
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

void run_compare(CompareOptions options) {
  options.sensor.is_quiet = options.answer.quiet;
  if (!options.sensor.sensor.empty()) {
    if (!options.result.empty() || !options.reference.empty() || !options.truth.empty())
      throw std::invalid_argument("--sensor compares displacements and --result modes; ask for one of them");
    return compare_sensor(options.sensor, options.answer);
  }
  if (options.result.empty() || options.reference.empty()) {
    throw std::invalid_argument(
        "--result and --reference are needed, or --sensor and --run; compare --help explains both");
  }
  const app::ModalReport result = app::read_modal_json(options.result);
  const app::ModalReport reference = app::read_modal_json(options.reference);
  app::ModalReport truth;
  if (!options.truth.empty()) truth = app::read_modal_json(options.truth);
  const bool with_truth = !options.truth.empty();
  const auto modes = compare_modes(result, reference, with_truth ? &truth : nullptr, options.paper);
  options.answer.document(compared_json(modes));
  options.answer.text("{}", compared_text(modes, with_truth, options.paper));
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
  add_answer_options(command, options->answer, "the comparison (with --sensor: sensor.json)");
  add_sensor_options(command, options->sensor);
  command.on_run([options] { run_compare(*options); });
}

}  // namespace tools
