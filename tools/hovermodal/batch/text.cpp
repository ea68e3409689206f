#include <fmt/format.h>

#include <algorithm>

#include "drivers/storage/printable.h"
#include "tools/hovermodal/batch/combine.h"

namespace tools {

namespace {

std::string with_sigma(const core::WeightedMean& mean, double unit, int decimals) {
  if (mean.n == 0) return fmt::format("{:>20}", "-");
  const std::string sigma = mean.std > 0.0 ? fmt::format("+- {:.{}f}", unit * mean.std, decimals + 1) : "+- ?";
  return fmt::format("{:>9.{}f} {:<11}", unit * mean.value, decimals, sigma);
}

std::string scatter_text(const core::WeightedMean& flights) {
  return flights.scatter ? fmt::format("{:.1f}", *flights.scatter) : "-";
}

std::string row(std::string_view number, const BatchMode& mode, std::size_t n_flights) {
  const bool is_settled = mode.frequency_hz.n > 0;
  return fmt::format("{:>4} {} {} {:>5} of {:<5} {:>6} {:>6}\n", number,
                     with_sigma(is_settled ? mode.frequency_hz : mode.flights_frequency_hz, 1.0, 4),
                     with_sigma(is_settled ? mode.damping_ratio : mode.flights_damping_ratio, 100.0, 2),
                     mode.flights.size(), n_flights, scatter_text(mode.flights_frequency_hz),
                     scatter_text(mode.flights_damping_ratio));
}

// Names of files and messages about them, which others chose.
std::string shown(const std::string& text) { return drivers::printable(text, 500); }

}  // namespace

std::string batch_text(const BatchResult& result) {
  const auto n_done = static_cast<std::size_t>(
      std::count_if(result.flights.begin(), result.flights.end(), [](const auto& f) { return f.failure.empty(); }));
  std::string text = fmt::format("{} of {} flights, {} view{}\n", n_done, result.flights.size(), result.views.size(),
                                 result.views.size() == 1 ? "" : "s");
  for (std::size_t v = 1; v < result.views.size(); ++v) {
    text += fmt::format("view {} (from {}) is another than view 1: {}\n", v + 1,
                        shown(result.flights[result.views[v].flights.front()].name), shown(result.views[v].why));
  }
  text += fmt::format("{:>4} {:^21} {:^21} {:^14} {:>6} {:>6}\n", "mode", "frequency, Hz", "damping, %", "in flights",
                      "scatter", "f, damp.");
  for (std::size_t m = 0; m < result.modes.size(); ++m) text += row(fmt::format("{}", m + 1), result.modes[m], n_done);
  if (!result.unsettled.empty()) text += "in single flights only, not in the sums of their view:\n";
  for (const BatchMode& mode : result.unsettled) text += row("-", mode, n_done);
  text += "scatter: of the flights about their mean, over what they state; about 1 where nothing changed\n";
  for (const FlightResult& flight : result.flights) {
    if (!flight.contradiction.empty())
      text += fmt::format("left out: {} contradicts the others: {}\n", shown(flight.name), flight.contradiction);
    if (!flight.failure.empty()) text += fmt::format("failed: {}: {}\n", shown(flight.name), shown(flight.failure));
  }
  return text;
}

}  // namespace tools
