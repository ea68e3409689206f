// hovermodal identify: the service's spectra and identification on any time series.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "drivers/storage/csv.h"
#include "drivers/storage/json.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/analysis.h"
#include "firmware_app/report/modal_json.h"
#include "firmware_app/report/page/report_page.h"
#include "tools/hovermodal/commands.h"
#include "tools/hovermodal/modes_text.h"

namespace tools {

namespace {

struct IdentifyOptions {
  std::string series;
  double rate_hz = 0.0;
  std::vector<std::string> channels;  // empty = all but the time
  std::vector<std::string> bases;
  app::SpectrumConfig spectrum;
  core::IdentifierConfig identifier;
  std::string report;
};

bool is_time(const std::string& name) {
  return name == "t_s" || name == "time" || name == "frame" || name == "scale_mm_per_px";
}

// Times, where the file has them, must agree with the rate: one source of truth.
double rate_of(const drivers::SeriesFile& file, const IdentifyOptions& options) {
  const int column = file.column("t_s");
  if (column < 0) {
    if (options.rate_hz > 0.0) return options.rate_hz;
    throw std::invalid_argument(options.series + ": no column t_s: say --rate HZ");
  }
  const std::vector<double>& t = file.columns[static_cast<std::size_t>(column)];
  if (t.size() < 2) throw std::invalid_argument(options.series + ": fewer than two samples");
  const double measured_hz = static_cast<double>(t.size() - 1) / (t.back() - t.front());
  if (options.rate_hz > 0.0 && std::abs(measured_hz / options.rate_hz - 1.0) > 0.01) {
    throw std::invalid_argument(fmt::format("--rate {:g} disagrees with {}'s column t_s, {:.6g} Hz", options.rate_hz,
                                            options.series, measured_hz));
  }
  return options.rate_hz > 0.0 ? options.rate_hz : measured_hz;
}

app::ChannelSeries load(const IdentifyOptions& options) {
  const drivers::SeriesFile file = drivers::read_series_csv(options.series);
  app::ChannelSeries series;
  if (const auto unit = file.comments.find("unit"); unit != file.comments.end()) series.unit = unit->second;
  series.rate_hz = rate_of(file, options);
  std::vector<std::string> names = options.channels;
  if (names.empty())
    std::copy_if(file.names.begin(), file.names.end(), std::back_inserter(names),
                 [](const auto& n) { return !is_time(n); });
  for (const std::string& name : names) {
    const int column = file.column(name);
    if (column < 0) throw std::invalid_argument(options.series + ": no column '" + name + "'");
    core::ChannelInfo channel;
    channel.region = static_cast<std::uint16_t>(series.channels.size());
    channel.name = name;
    // A run's displacements.csv tells when each channel is seen after the time stamp.
    const auto delay = file.comments.find("row_delay_s." + name);
    if (delay != file.comments.end()) channel.row_delay_s = drivers::parse_number(delay->second).value_or(0.0);
    channel.is_base = std::find(options.bases.begin(), options.bases.end(), name) != options.bases.end();
    series.channels.push_back(channel);
    series.value.push_back(file.columns[static_cast<std::size_t>(column)]);
  }
  return series;
}

void run(const IdentifyOptions& options) {
  const app::ChannelSeries series = load(options);
  if (!options.report.empty()) std::filesystem::create_directories(options.report);
  const std::string source = std::filesystem::path(options.series).filename().string();
  const core::ModalEstimate estimate =
      app::identify_series(series, options.spectrum, options.identifier, options.report, source);
  fmt::print("{}", modes_text(estimate, series.channels));
  if (options.report.empty()) return;
  app::ModalReport report;
  report.method = "hovermodal";
  for (const core::ChannelInfo& channel : series.channels) report.channel_names.push_back(channel.name);
  report.estimate = estimate;
  drivers::write_file_atomically(options.report + "/modal.json", app::modal_json(report));
  fmt::print("open {}/{}\n", options.report, app::kReportName);
}

}  // namespace

void add_identify(CLI::App& app) {
  auto options = std::make_shared<IdentifyOptions>();
  CLI::App* command =
      app.add_subcommand("identify",
                         "Modes of any time series: displacements.csv of a run, simulated truth, accelerometers\n"
                         "  hovermodal identify --series out/displacements.csv --base base");
  command->add_option("--series", options->series, "CSV with one line of names; a column t_s gives the rate")
      ->required()
      ->type_name("FILE");
  command->add_option("--rate", options->rate_hz, "Samples per second, when there is no column t_s")->type_name("HZ");
  command->add_option("--channels", options->channels, "Columns to use (default: all but times)")->type_name("NAME");
  command->add_option("--base", options->bases, "Columns that are the structure's base")->type_name("NAME");
  command->add_option("--segment", options->spectrum.segment, "Samples per Welch segment")->capture_default_str();
  command->add_option("--block-rows", options->identifier.block_rows, "Block rows of the Hankel matrix, 0 = automatic")
      ->capture_default_str();
  command
      ->add_option("--differences", options->identifier.n_differences, "Prewhitening differences (0 for accelerations)")
      ->capture_default_str();
  command
      ->add_option(
          "--max-frequency", options->identifier.max_frequency_hz,
          "Highest true frequency, Hz: above half the rate it is unfolded by the row delays (0 = half the rate)")
      ->capture_default_str();
  command->add_option("--report", options->report, "Folder for modal.json and report.html")->type_name("DIR");
  command->callback([options] { run(*options); });
}

}  // namespace tools
