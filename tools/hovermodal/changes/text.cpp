#include <fmt/format.h>

#include <cmath>

#include "drivers/storage/printable.h"
#include "tools/hovermodal/changes/matched_flights.h"
#include "tools/hovermodal/changes/mode_histories.h"

namespace tools {
namespace {

using core::monitoring::Change;
using core::monitoring::ChangeKind;

std::string shown(const std::string& text) { return drivers::printable(text, 200); }

std::string flight_words(const ModeHistories& result, std::size_t flight) {
  const DatedFlight& one = result.flights[flight];
  return fmt::format("flight {} ({})", flight + 1, shown(one.date.empty() ? one.name : one.date));
}

bool has_dates(const ModeHistories& result) { return !result.flights.front().date.empty(); }

// A size and its standard deviation, in `unit` of `scale`.
std::string size_words(const ModeHistories& result, const Change& change, double scale, const char* unit) {
  if (change.kind == ChangeKind::kStep) {
    return fmt::format("step at {}: {:+.3g} +- {:.2g} {}", flight_words(result, change.first_flight),
                       scale * change.size, scale * change.size_std, unit);
  }
  const double span = has_dates(result) ? 365.25 : 1.0;
  return fmt::format("trend: {:+.3g} +- {:.2g} {} a {}", span * scale * change.size, span * scale * change.size_std,
                     unit, has_dates(result) ? "year" : "day");
}

std::string change_words(const ModeHistories& result, const Change& change, double scale, const char* unit) {
  if (!change.is_tested)
    return fmt::format("not tested: fewer than {} flights with a standard deviation", core::monitoring::kLeastFlights);
  if (!change.is_significant) return fmt::format("no change (chance {:.2g})", change.chance);
  const char* other = change.kind == ChangeKind::kStep ? "trend" : "step";
  return fmt::format("{}; chance {:.2g}{}", size_words(result, change, scale, unit), change.chance,
                     change.kind_is_clear ? "" : fmt::format("; a {} explains it as well", other));
}

std::string scatter_words(const Change& change) {
  return change.is_tested && change.scatter > 1.5
             ? fmt::format("; the flights differ by {:.1f} times what they state", change.scatter)
             : "";
}

std::string mode_words(const ModeHistories& result, const ModeHistory& mode, std::size_t number) {
  const Change &f = mode.frequency.change, &z = mode.log_damping.change;
  const std::size_t n = std::max(mode.frequency.values.size(), mode.log_damping.values.size());
  std::string text = fmt::format("mode {}: {}, in {} of {} flights\n", number,
                                 f.is_tested ? fmt::format("{:.4f} Hz", f.mean) : std::string("frequency not tested"),
                                 n, result.flights.size());
  text += fmt::format("  frequency  {}{}\n", change_words(result, f, f.mean != 0.0 ? 100.0 / f.mean : 1.0, "%"),
                      scatter_words(f));
  if (f.per_kelvin_std > 0.0) {
    text += fmt::format("             {:+.4f} +- {:.4f} % per kelvin\n", 100.0 * f.per_kelvin / f.mean,
                        100.0 * f.per_kelvin_std / f.mean);
  }
  text += fmt::format("  damping    {}{}\n", change_words(result, z, 100.0, "%"), scatter_words(z));
  std::size_t n_tested = 0, n_changed = 0;
  for (const ModeHistory::Component& one : mode.shape) {
    n_tested += one.value.change.is_tested ? 1U : 0U;
    if (!one.value.change.is_significant) continue;
    ++n_changed;
    text += fmt::format("  shape      {}: {}\n", shown(one.channel),
                        change_words(result, one.value.change, 1.0, "of the shape"));
  }
  if (n_changed == 0) {
    text += n_tested > 0 ? fmt::format("  shape      no change in {} components\n", n_tested)
                         : std::string("  shape      not tested\n");
  }
  return text;
}

}  // namespace

std::string changes_text(const ModeHistories& result) {
  const DatedFlight &first = result.flights.front(), &last = result.flights.back();
  std::string text =
      fmt::format("{} flights, {} to {}; temperature {}\n", result.flights.size(),
                  shown(first.date.empty() ? first.name : first.date), shown(last.date.empty() ? last.name : last.date),
                  result.knows_temperature ? "removed by regression" : "not known");
  for (const auto& one : result.contradicting) {
    text +=
        fmt::format("{} contradicts the others: {}; it is left out\n", flight_words(result, one.flight), words_of(one));
  }
  for (std::size_t m = 0; m < result.modes.size(); ++m) text += mode_words(result, result.modes[m], m + 1);
  if (result.n_rare > 0) {
    text += fmt::format("{} further mode{} in less than a third of the flights: not tested\n", result.n_rare,
                        result.n_rare == 1 ? "" : "s");
  }
  text += result.is_changed() ? "CHANGED\n" : "no change found\n";
  return text;
}

}  // namespace tools
