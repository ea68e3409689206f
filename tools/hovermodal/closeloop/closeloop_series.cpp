// hovermodal closeloop --record series.csv: attributes the residual of a response to the effect that its model lacks.
#include "tools/hovermodal/closeloop/closeloop_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/closure/closure_loop.h"
#include "core/closure/response/clock_model.h"
#include "core/closure/response/free_decay_model.h"
#include "drivers/host/command_line.h"
#include "drivers/storage/csv.h"
#include "drivers/storage/text_file.h"
#include "tools/hovermodal/closeloop/series_loop.h"
#include "tools/hovermodal/closeloop/series_modes.h"

namespace tools {
namespace {

using core::closure::ClockModel;
using core::closure::ClosureResult;

constexpr std::size_t kMostOfDecays = 32;  // they take long to fit

class SeriesCloser {
 public:
  SeriesCloser(const LoopRequest& request, const SeriesLoop& options)
      : request_(request), options_(options), loaded_(load_series(request.records.front(), options.request)) {}

  void run() {
    if (!options_.clock.empty()) close_clock();
    if (options_.free_decay) close_decays();
    if (!options_.free_decay && options_.clock.empty()) close_channels(request_, options_, loaded_.series);
  }

 private:
  // Diagnosis of the clock; the record's times are then those that it estimates.
  void close_clock() {
    const drivers::SeriesFile file = drivers::read_foreign_series(options_.clock);
    const int frames = file.column("frame"), sigmas = file.column("sigma_s");
    int readings = file.column("reading_s");
    for (std::size_t c = 0; readings < 0 && c < file.names.size(); ++c) {
      if (static_cast<int>(c) != frames && file.names[c].find("read") != std::string::npos)
        readings = static_cast<int>(c);
    }
    if (frames < 0 || readings < 0)
      throw drivers::FileError(options_.clock + ": needs columns frame and reading_s (seconds shown by the clock)");
    core::closure::ClockReadings clock;
    clock.frame = file.columns[static_cast<std::size_t>(frames)];
    clock.reading_s = file.columns[static_cast<std::size_t>(readings)];
    clock.sigma_s = 1e-3 * options_.clock_sigma_ms;
    if (sigmas >= 0 && clock.sigma_s <= 0.0) clock.sigma_s = file.columns[static_cast<std::size_t>(sigmas)].front();
    const ClockModel model(clock, {loaded_.series.rate_hz});
    request_.answer.note("{} readings of the clock, {} more were misread; declared {:g} Hz\n", model.n_readings(),
                         model.n_misread(), loaded_.series.rate_hz);
    std::vector<std::string> adopted;
    ClosureResult result = close_response(request_, model, request_.n_surrogates, &adopted);
    const app::ChannelSeries declared = loaded_.series;
    apply(model, adopted);
    if (!options_.free_decay) {
      add_modes(result, declared, loaded_.series, options_.max_frequency_hz, request_.reference);
    }
    show_response(request_, result, options_.free_decay ? "closure_clock.json" : "closure.json");
  }

  // Frames at their true times: the mean rate, and empty cells where frames were lost.
  void apply(const ClockModel& model, const std::vector<std::string>& adopted) {
    if (adopted.empty()) return;
    app::ChannelSeries& series = loaded_.series;
    const std::size_t n = series.value.front().size();
    const std::vector<double> times = model.frame_times_s(adopted, n);
    std::vector<double> steps;
    for (std::size_t k = 1; k < n; ++k) steps.push_back(times[k] - times[k - 1]);
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    series.rate_hz = 1.0 / *middle;
    const auto n_cells = static_cast<std::size_t>(std::llround(times.back() * series.rate_hz)) + 1;
    for (std::vector<double>& value : series.value) {
      std::vector<double> placed(n_cells, std::numeric_limits<double>::quiet_NaN());
      for (std::size_t k = 0; k < n; ++k) {
        const auto cell = std::llround(times[k] * series.rate_hz);
        if (cell >= 0 && static_cast<std::size_t>(cell) < n_cells) placed[static_cast<std::size_t>(cell)] = value[k];
      }
      value = std::move(placed);
    }
  }

  void close_decays() {
    std::vector<std::string> names;
    std::vector<std::vector<double>> values;
    for (std::size_t c = 0; c < loaded_.series.channels.size(); ++c) {
      if (loaded_.series.channels[c].is_base) continue;
      names.push_back(loaded_.series.channels[c].name);
      values.push_back(loaded_.series.value[c]);
    }
    if (names.empty()) throw std::invalid_argument(request_.records.front() + ": no channel but the base");
    core::closure::ReleaseSearch search;
    search.length_s = options_.decay_s;
    const core::closure::FreeDecayModel model(
        core::closure::find_free_decays(values, loaded_.series.rate_hz, names, loaded_.series.unit, search));
    request_.answer.note("{} releases at {:.4f} Hz, {} samples or fewer each\n", model.decays().release.size(),
                         model.decays().rate_hz, model.decays().release.front().rows());
    show_response(request_, close_response(request_, model, kMostOfDecays), "closure.json");
  }

  const LoopRequest& request_;
  const SeriesLoop& options_;
  LoadedSeries loaded_;
};

}  // namespace

void add_series_options(drivers::Command& command, SeriesLoop& options) {
  SeriesRequest& request = options.request;
  command.option("--rate-hz,--rate", request.rate_hz, "Of --record SERIES: samples per second as declared")
      .type_name("HZ");
  command.option("--channels", request.channels, "Of --record SERIES: columns to use, by name or number from 1")
      .type_name("NAME");
  command.option("--base", request.bases, "Of --record SERIES: columns that are the structure's base")
      .type_name("NAME");
  command.option("--input", request.input, "Of --record SERIES: column of the measured input (ground, table)")
      .type_name("NAME");
  command.option("--quantity", request.quantities, "For --record SERIES: d, v or a, as for identify")
      .separator(',')
      .type_name("d|v|a");
  command.option("--max-frequency", options.max_frequency_hz, "Of --record SERIES: highest frequency of modes, Hz")
      .not_negative();
  command
      .option("--clock", options.clock,
              "A clock filmed in the frames of --record: columns frame, reading_s, optionally sigma_s")
      .type_name("FILE.csv");
  command.option("--clock-sigma-ms", options.clock_sigma_ms, "Scatter of a reading, where it is known").not_negative();
  command.flag("--free-decay", options.free_decay,
               "The record shows a structure that is pulled and released, three times or more");
  command.option("--input-record", options.input_record, "Of several --record: name of the one at the base")
      .type_name("NAME");
  command.flag("--input-unknown", options.input_unknown,
               "Begin as if the measured --input were white noise: is its colour an effect that the model lacks?");
  command.flag("--average-rate", options.average_rate,
               "The rate is that of samples over duration (a container's average), not a sensor's: lost samples that "
               "are put in raise it");
  command.option("--decay-s", options.decay_s, "Length of a decay, at most").positive().show_default();
}

void close_series(const LoopRequest& request, const SeriesLoop& options) {
  if (request.records.size() > 1) return close_loggers(request, options);
  SeriesCloser(request, options).run();
}

}  // namespace tools
