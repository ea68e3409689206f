#include "tools/hovermodal/compare/sensor.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "core/linear/median.h"
#include "drivers/storage/csv.h"
#include "drivers/storage/json.h"
#include "drivers/storage/series_format.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/replay/run_folder.h"
#include "firmware_app/report/earlier_files.h"
#include "firmware_app/report/modal_json.h"
#include "tools/hovermodal/compare/seen_time.h"
#include "tools/hovermodal/identify/series_input.h"

namespace tools {
namespace {

namespace fs = std::filesystem;

// displacements.csv of a folder; a file as it is.
std::string series_of_run(const std::string& run) {
  if (!fs::is_directory(run)) return run;
  const fs::path path = fs::path(run) / "displacements.csv";
  if (!fs::exists(path))
    throw std::invalid_argument(run + ": no displacements.csv in it; name the folder that --report of a run wrote");
  return path.string();
}

LoadedSeries load_channel(const std::string& path, const std::string& channel, const std::optional<double>& rate_hz,
                          const char* option, bool is_quiet) {
  SeriesRequest request;
  request.is_quiet = is_quiet;
  request.rate_hz = rate_hz.value_or(0.0);
  if (!channel.empty()) request.channels = {channel};
  LoadedSeries loaded = load_series(path, request);
  if (loaded.series.channels.size() == 1) return loaded;
  std::string names;
  for (const core::ChannelInfo& one : loaded.series.channels) names += (names.empty() ? "" : ", ") + one.name;
  throw std::invalid_argument(
      fmt::format("{}: several channels; choose one by {}: {}", path, option, drivers::printable(names, 200)));
}

std::optional<double> scale_of(const std::string& path) {
  if (!path.ends_with(".csv")) return std::nullopt;
  const drivers::SeriesFile file = drivers::read_foreign_series(path);
  const int column = file.column("scale_mm_per_px");
  if (column < 0) return std::nullopt;
  std::vector<double> known;
  for (const double one : file.columns[static_cast<std::size_t>(column)]) {
    if (one > 0.0) known.push_back(one);
  }
  if (known.empty()) return std::nullopt;
  return core::median(std::move(known));
}

class SensorRun {
 public:
  explicit SensorRun(const SensorOptions& options) : options_(options), path_(series_of_run(options.run)) {}

  [[nodiscard]] SensorFindings run() {
    load_camera();
    load_sensor();
    choose_units();
    core::SensorComparisonConfig config;
    if (!options_.band.empty()) config.band = core::Band{options_.band[0], options_.band[1]};
    config.clock.most_offset_s = options_.most_offset_s.value_or(0.0);
    config.frames = frames();
    out_.comparison = core::compare_with_sensor(camera_, sensor_, config);
    const std::string& refusal = out_.comparison.refusal;
    if (!refusal.empty())
      throw std::runtime_error(fmt::format("{} and {} cannot be compared: {}", path_, options_.sensor, refusal));
    return std::move(out_);
  }

 private:
  // How the run's video was coded.
  core::VideoFrames frames() {
    const fs::path path = fs::path(options_.run) / "modal.json";
    core::VideoFrames out{1.0 / camera_.rate_hz, core::FramePrediction::kUnknown};
    if (fs::is_directory(options_.run) && fs::exists(path))
      out.prediction = app::read_modal_json(path.string()).losses.times.prediction;
    if (out.prediction == core::FramePrediction::kUnknown)
      out_.remarks.emplace_back(
          "no coded video is known behind the channel: a codec's delay is not part of the sigmas");
    return out;
  }

  void load_camera() {
    LoadedSeries loaded = load_channel(path_, options_.channel, options_.rate_hz, "--channel", options_.is_quiet);
    (void)app::use_measured_times(path_, loaded.series);
    const core::ChannelInfo& channel = loaded.series.channels.front();
    const SeenTime seen = seen_time(options_.run, channel.name);
    const double delay_s = channel.row_delay_s + seen.half_exposure_s + seen.mean_row_shift_s;
    out_.camera_first_s = loaded.first_s + delay_s;
    if (delay_s != 0.0) {
      out_.remarks.push_back(
          fmt::format("{} is seen {:.3f} ms after the time of its row in {}, {:+.3f} ms of it because it "
                      "stands elsewhere than in the first frame on average",
                      channel.name, 1e3 * delay_s, path_, 1e3 * seen.mean_row_shift_s));
    }
    out_.channel = channel.name, out_.run = path_, out_.unit = loaded.series.unit;
    camera_ = {loaded.series.rate_hz, std::move(loaded.series.value.front()), channel.n_integrations};
    if (camera_.n_integrations != 0)
      throw std::invalid_argument(path_ + ": its unit is no displacement's; name the displacements of a run");
    out_.camera_rate_hz = camera_.rate_hz, out_.n_camera = camera_.value.size();
    out_.mm_per_px = options_.mm_per_px ? options_.mm_per_px : scale_of(path_);
    out_.remarks.insert(out_.remarks.end(), loaded.remarks.begin(), loaded.remarks.end());
  }

  void load_sensor() {
    LoadedSeries loaded = load_channel(options_.sensor, options_.sensor_channel, options_.sensor_rate_hz,
                                       "--sensor-channel", options_.is_quiet);
    const core::ChannelInfo& channel = loaded.series.channels.front();
    out_.sensor_channel = channel.name, out_.sensor = options_.sensor;
    out_.sensor_first_s = loaded.first_s;
    sensor_ = {loaded.series.rate_hz, std::move(loaded.series.value.front()), channel.n_integrations};
    sensor_unit_ = options_.unit.empty() ? loaded.series.unit : options_.unit;
    const auto motion = drivers::motion_unit(sensor_unit_);
    if (!motion && !options_.unit.empty()) {
      throw std::invalid_argument(
          fmt::format("--sensor-unit {}: unknown; for example mm, m/s, mm/s, m/s^2, g", options_.unit));
    }
    if (motion) sensor_.n_integrations = motion->n_integrations;
    if (options_.quantity == "d") sensor_.n_integrations = 0;
    if (options_.quantity == "v") sensor_.n_integrations = 1;
    if (options_.quantity == "a") sensor_.n_integrations = 2;
    if (!motion && options_.quantity.empty()) {
      throw std::invalid_argument(
          fmt::format("{}: the unit of {} is not known; set --sensor-unit (mm, m/s, m/s^2, g), or --quantity alone, "
                      "which compares all but the amplitude",
                      options_.sensor, channel.name));
    }
    out_.sensor_rate_hz = sensor_.rate_hz, out_.n_sensor = sensor_.value.size();
    out_.n_integrations = sensor_.n_integrations;
    // The options that replace a unit of the file are checked above.
    for (const std::string& remark : loaded.remarks) {
      if (remark.find("no unit known") == std::string::npos) out_.remarks.push_back(remark);
    }
  }

  // Both in mm, where both are lengths; otherwise the channel's own unit, and the amplitude is not compared.
  void choose_units() {
    const auto camera = drivers::motion_unit(out_.unit), sensor = drivers::motion_unit(sensor_unit_);
    const bool comparable = camera && camera->to_si > 0.0 && sensor && sensor->to_si > 0.0 &&
                            sensor->n_integrations == sensor_.n_integrations;
    out_.is_scaled = !comparable;
    if (!comparable) {
      out_.remarks.push_back(
          fmt::format("channel in {}, sensor in {}: the amplitude is not compared, the sensor is scaled to the channel",
                      out_.unit, sensor_unit_.empty() ? "an unknown unit" : sensor_unit_));
      return;
    }
    for (double& value : camera_.value) value *= 1e3 * camera->to_si;
    for (double& value : sensor_.value) value *= 1e3 * sensor->to_si;
    out_.unit = "mm";
  }

  const SensorOptions& options_;
  std::string path_, sensor_unit_;
  core::ComparedRecord camera_, sensor_;
  SensorFindings out_;
};

}  // namespace

void compare_sensor(const SensorOptions& options, const Answer& answer) {
  if (options.run.empty())
    throw std::invalid_argument("--sensor needs --run: the folder of a run, or a table with its displacement");
  if (!options.band.empty() && options.band.size() != 2)
    throw std::invalid_argument("--band takes two frequencies: --band 3 14");
  const SensorFindings findings = SensorRun(options).run();
  answer.document(sensor_json(findings));
  answer.text("{}", sensor_text(findings));
  if (options.report.empty()) return;
  fs::create_directories(options.report);
  app::keep_earlier(options.report, "sensor", {"sensor.json", "sensor.svg"});
  drivers::write_file_atomically(options.report + "/sensor.json", sensor_json(findings));
  drivers::write_file_atomically(options.report + "/sensor.svg", sensor_svg(findings));
  answer.text("open {}/sensor.svg\n", options.report);
}

}  // namespace tools
