#include <fmt/format.h>

#include <string>
#include <vector>

#include "core/identification/common_drift.h"
#include "firmware_app/report/page/page_parts.h"

namespace app {
namespace {

std::string minutes_text(double seconds) { return decimals_text(seconds / 60.0, 1) + " min"; }

constexpr double kPercentPerMinute = 6000.0;

// Whether the structure as a whole changed during the run.
std::string drift_sentence(const core::ModalEstimate& estimate) {
  const auto drift = core::common_drift(estimate);
  if (!drift) return "Common drift of the frequencies cannot be determined yet: fewer than two modes have a trend.";
  return fmt::format("All {} modes together {}: {} ± {} % a minute.", drift->n_modes,
                     drift->drifts ? "drift" : "show no drift beyond what the record allows",
                     decimals_text(kPercentPerMinute * drift->share_per_s, 3),
                     decimals_text(kPercentPerMinute * drift->std_per_s, 3));
}

// The history of each mode as a table for readers.
std::string followed_table(const PictureInputs& inputs) {
  HtmlTable table({"Mode", "Frequency", "Found in", "Since", "Trend", "Still wanted"});
  for (std::size_t i = 0; i < inputs.estimate->modes.size(); ++i) {
    const core::Mode& mode = inputs.estimate->modes[i];
    if (!mode.history) continue;
    const core::ModeHistory& history = *mode.history;
    const double per_minute = kPercentPerMinute / mode.frequency_hz;
    std::string trend = "–";
    if (history.drift_hz_per_s && history.drift_std_hz_per_s) {
      trend = fmt::format("{} ± {} %/min", decimals_text(per_minute * *history.drift_hz_per_s, 3),
                          decimals_text(per_minute * *history.drift_std_hz_per_s, 3));
      if (history.drifts) trend += ", drifts";
    }
    if (history.n_fold_changes > 0) trend += fmt::format(", alias order changed {} times", history.n_fold_changes);
    table.add({{std::to_string(i + 1), {}},
               {four_digits_text(mode.frequency_hz) + " Hz", {}},
               {fmt::format("{} estimates", history.n_estimates), {}},
               {decimals_text(history.first_seen_s, 0) + " s", {}},
               {trend, {}},
               {!history.more_s         ? "–"
                : *history.more_s > 0.0 ? minutes_text(*history.more_s)
                                        : "reached",
                {}}});
  }
  return table.html();
}

}  // namespace

std::string convergence_section(const PictureInputs& inputs) {
  const std::string title = "Convergence";
  const std::string frequency = frequency_convergence_svg(inputs, kWideFormat);
  if (frequency.empty()) {
    return section_html(
        "convergence", title,
        absent_html("There is no history over the estimates: the run made fewer than three, or they found no "
                    "mode twice."));
  }
  std::string body = paragraph_html(drift_sentence(*inputs.estimate)) + followed_table(inputs);
  body += paragraph_html("Still wanted: how much longer a record makes the damping good to 10 %.", "note");
  body += "<h3>Frequency</h3>\n" +
          figure_html(frequency, frequency_convergence_svg(inputs, kNarrowFormat), {},
                      "Frequency of every mode in percent of the last estimate's, over the duration of the record. "
                      "A mode that does not change stays between the grey lines 19 times out of 20: they allow for "
                      "the difference between an estimate and a later one that shares its data.");
  body += "<h3>Damping</h3>\n" + figure_html(damping_convergence_svg(inputs, kWideFormat),
                                             damping_convergence_svg(inputs, kNarrowFormat), {},
                                             "The same for damping, which converges much more slowly.");
  return section_html("convergence", title, body);
}

}  // namespace app
