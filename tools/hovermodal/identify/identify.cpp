// hovermodal identify: the service's spectra and identification on any time series.
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "drivers/host/command_line.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/replay/analysis.h"
#include "tools/hovermodal/answer.h"
#include "tools/hovermodal/commands.h"
#include "tools/hovermodal/identify/series_input.h"
#include "tools/hovermodal/identify/series_output.h"
#include "tools/hovermodal/modes_text.h"

namespace tools {

namespace {

struct IdentifyOptions {
  std::vector<std::string> files;
  SeriesRequest request;
  std::vector<std::string> references;
  int segment = 0;
  int n_differences = -1;  // -1 = automatic
  core::IdentifierConfig identifier;
  bool merge = false, keep_all = false;
  Answer answer;
  app::PageHead head;
  std::string report;
};

constexpr const char* kHelp =
    "Modes of any time series: displacements of a run, accelerometers, lasers, tracks of other programs\n"
    "  hovermodal identify --series out/displacements.csv --base base\n"
    "      a run of the service: rate, units and row delays are in the file\n"
    "  hovermodal identify --series frame.csv --rate-hz 256 --quantity v,v,v,a,a --channels 1 2 3 4 5 --max-frequency "
    "12\n"
    "      lasers beside accelerometers; decimated to just above 12 Hz; the columns by number\n"
    "  hovermodal identify --series table.csv --quantity a --input ground --max-frequency 22 --report out\n"
    "      a measured ground: its own peaks are distinguished from modes, and the response to it is listed\n"
    "  hovermodal identify --series a.csv b.csv c.csv --rate-hz 256 --reference ref_x ref_y --merge --report out\n"
    "      set-ups with moved sensors, joined by the two that stayed\n"
    "  hovermodal identify --series rig.uff --base floor    # or a MAT file: series are its longest arrays\n"
    "  hovermodal identify --series field.mat --rate-hz 30 --json\n"
    "      hundreds of channels: the modes from twelve of them, which are stated, the shapes of all\n"
    "A file: one row per sample; names on the first line, or none; comma, semicolon, tab or blanks between cells;\n"
    "empty cells are missing samples; a column t_s (seconds) or frame shows gaps; # lines are comments.\n"
    "Or a universal file with time responses (data set 58), or a MAT file of version 5 (`rate_hz` or `fs`, `unit`).";

SeriesFindings identify_file(const IdentifyOptions& options, const std::string& path, const std::string& report) {
  LoadedSeries loaded = load_series(path, options.request);
  SeriesFindings findings;
  findings.name = std::filesystem::path(path).stem().string();
  app::SeriesOptions series;
  series.spectrum.segment = options.segment;
  series.identifier = options.identifier;
  series.identifier.n_differences = options.n_differences;
  for (const std::string& reference : options.references) {
    const int channel = channel_index(loaded, reference, path);
    findings.references.push_back(loaded.series.channels[static_cast<std::size_t>(channel)].name);
    // With several set-ups they join the shapes; each single set-up uses all its channels.
    if (!options.merge) series.identifier.references.push_back(channel);
  }
  series.mask_faults = !options.keep_all;
  series.report_directory = report;
  series.source = std::filesystem::path(path).filename().string();
  series.head = options.head;
  const auto start = std::chrono::steady_clock::now();
  if (!options.answer.quiet) {
    series.progress = [&](double share) {
      const double so_far_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      fmt::print(stderr, "{}: spectra {:.0f} %, {:.0f} s left\n", path, 100.0 * share,
                 so_far_s * (1.0 - share) / share);
    };
  }
  if (!report.empty()) std::filesystem::create_directories(report);
  try {
    findings.result = app::identify_series(loaded.series, series);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(path + ": " + error.what());
  }
  findings.result.remarks.insert(findings.result.remarks.begin(), loaded.remarks.begin(), loaded.remarks.end());
  return findings;
}

// DIR for one file, DIR/NAME for each of several.
std::string report_of(const IdentifyOptions& options, std::size_t i) {
  if (options.report.empty() || options.files.size() == 1) return options.report;
  const auto stem = [&](std::size_t k) { return std::filesystem::path(options.files[k]).stem().string(); };
  std::size_t n_before = 0;
  for (std::size_t k = 0; k < i; ++k) n_before += stem(k) == stem(i) ? 1U : 0U;
  return options.report + "/" + stem(i) + (n_before > 0 ? fmt::format("_{}", n_before + 1) : "");
}

void check(const IdentifyOptions& options) {
  if (options.request.rate_hz < 0.0) throw std::invalid_argument("--rate-hz must be positive");
  if (options.segment != 0 && options.segment < 16)
    throw std::invalid_argument(fmt::format("--segment {}: at least 16 samples, or 0 = automatic", options.segment));
  if (options.answer.json && options.files.size() > 1 && !options.merge)
    throw std::invalid_argument("--json prints one result: give one file, or --merge");
  if (options.merge && options.files.size() < 2) throw std::invalid_argument("--merge joins two files or more");
  if (options.merge && options.references.empty())
    throw std::invalid_argument("--merge needs --reference: the channels that stayed where they were in every file");
}

// What one result leaves: its files, and its text on the standard output.
void hand_out(const IdentifyOptions& options, const app::SeriesResult& result, const std::string& page) {
  options.answer.document(modes_json(result.estimate, result.channels));
  options.answer.text("{}", findings_text(result));
  if (!page.empty()) options.answer.text("open {}\n", page);
}

void run(IdentifyOptions options) {
  check(options);
  options.request.is_quiet = options.answer.quiet;
  std::vector<SeriesFindings> all;
  for (std::size_t i = 0; i < options.files.size(); ++i) {
    const std::string report = report_of(options, i);
    all.push_back(identify_file(options, options.files[i], report));
    if (options.files.size() > 1) options.answer.text("{}{}\n", i == 0 ? "" : "\n", options.files[i]);
    const std::string page = report.empty() ? std::string() : write_findings(all.back().result, report);
    if (!options.answer.json || !options.merge) hand_out(options, all.back().result, page);
  }
  if (!options.merge) return;
  const app::SeriesResult merged = merge_findings(all);
  options.answer.text("\n{} set-ups merged\n", all.size());
  hand_out(options, merged,
           options.report.empty() ? std::string() : write_merged(merged, options.head, options.report));
}

void add_data_options(drivers::Command& command, IdentifyOptions& options) {
  SeriesRequest& request = options.request;
  command.option("--series", options.files, "Tables of samples").required().type_name("FILE...");
  command.option("--rate-hz,--rate", request.rate_hz, "Samples per second, where the file has no times")
      .type_name("HZ");
  command
      .option("--quantity", request.quantities,
              "d displacement, v velocity, a acceleration: one for all channels, or one for each (default: by the "
              "units in names and comments)")
      .separator(',')
      .type_name("d|v|a");
  command.flag("--no-header", request.no_header,
               "The first line contains numbers, not names (also detected automatically)");
  command.option("--channels", request.channels, "Columns to use, by name or number from 1 (default: all but times)")
      .type_name("NAME");
  command.option("--base", request.bases, "Columns that are the structure's base").type_name("NAME");
  command
      .option("--input", request.input,
              "Column of the measured input (ground, shaking table): poles in which it moves are input "
              "peaks, and the peaks of the response to it are listed")
      .type_name("NAME");
  command.option("--delays-ms", request.delays_ms, "Delay of each channel relative to the time of its row")
      .separator(',')
      .type_name("MS");
}

void add_method_options(drivers::Command& command, IdentifyOptions& options) {
  command.option("--reference", options.references, "Reference channels; those that all files of --merge share")
      .type_name("NAME");
  command
      .option("--max-frequency", options.identifier.max_frequency_hz,
              "Highest true frequency, Hz: if far below half the rate the record is decimated; if above "
              "it, alias orders are determined from row delays (0 = half the rate, or as far as anything moves)")
      .not_negative()
      .show_default();
  command.option("--segment", options.segment, "Samples of a Welch segment, after decimation; 0 = automatic")
      .show_default();
  command.option("--block-rows", options.identifier.block_rows, "Block rows of the Hankel matrix, 0 = automatic")
      .show_default();
  command
      .option("--differences", options.n_differences,
              "Prewhitening differences (default: 1 where there are displacements, else 0)")
      .range(0, 4);
  command.flag("--keep-all", options.keep_all,
               "Use every number: fill values, stuck stretches and single outliers are not masked");
  command.flag("--merge", options.merge, "The files are set-ups of one structure, joined by --reference");
  command.option("--report", options.report, "Folder for modal.json and report.html (several files: one folder each)")
      .type_name("DIR");
  command.option("--title", options.head.title, "Title of report.html").type_name("TEXT");
  command
      .option("--note", options.head.notes,
              "Line for its head: \"place: ...\" is a fact, the rest a text; may be repeated")
      .type_name("TEXT")
      .repeated();
  command
      .option("--compare", options.head.compare,
              "modal.json of a former run, with which report.html compares the modes")
      .type_name("FILE");
  add_answer_options(command, options.answer, "modal.json (with --merge: of the merged modes)");
}

}  // namespace

void add_identify(drivers::Command& app) {
  auto options = std::make_shared<IdentifyOptions>();
  drivers::Command command = app.subcommand("identify", kHelp);
  add_data_options(command, *options);
  add_method_options(command, *options);
  command.on_run([options] { run(*options); });
}

}  // namespace tools
