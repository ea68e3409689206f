#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "firmware_app/report/page/page_parts.h"

namespace app {
namespace {

struct Counter {
  const char* name;
  std::uint64_t value;
  const char* meaning;
};

std::string counters_table(const std::vector<Counter>& counters) {
  HtmlTable table({"Counter", "Value", "Meaning"}, "counters");
  for (const Counter& counter : counters)
    table.add({{counter.name, {}}, {std::to_string(counter.value), {}}, {counter.meaning, {}}});
  return table.html();
}

std::string milliseconds(std::uint64_t ns) { return decimals_text(static_cast<double>(ns) * 1e-6, 3) + " ms"; }

}  // namespace

std::string losses_section(const PictureInputs& inputs) {
  const std::string title = "Losses";
  const RunFacts& facts = *inputs.facts;
  if (!facts.counted)
    return section_html("losses", title, absent_html("Nothing was counted: the input was a time series."));
  const core::Health& h = facts.health;
  const std::string body = counters_table(
      {{"Frames captured", h.frames_in, "from the camera"},
       {"Frames followed", h.frames_processed, "captured = tracked + dropped"},
       {"Frames dropped", h.frames_dropped, "tracking was behind: its ring was full"},
       {"Frames missing", h.frames_missing, "lost before the service: jumps in the numbers or times of the frames"},
       {"Samples masked", h.samples_masked, "channel samples without a value; the spectra leave them out"},
       {"Points followed", h.points_tracked, "in the last frame, agreeing with their region"},
       {"Points in all", h.points_total, "seeded in the first frame"},
       {"Estimates", h.estimates, "answers of the identification over the run"},
       {"Snapshots skipped", h.snapshots_skipped, "spectra due while the identification was behind"}});
  return section_html("losses", title, body);
}

std::string timing_section(const PictureInputs& inputs) {
  const std::string title = "Timing of this run";
  const core::Health& h = inputs.facts->health;
  if (h.stages.empty()) {
    return section_html("timing", title,
                        absent_html("No stage was timed: the record was worked through in one thread."));
  }
  HtmlTable table({"Stage", "In", "Out", "Dropped", "Mean step", "Worst step", "Queue"});
  for (const core::StageHealth& stage : h.stages) {
    const std::uint64_t n = std::max(stage.n_in, stage.n_out);
    const std::string queue =
        stage.queue_slots == 0 ? "–" : fmt::format("{} of {}", stage.queue_depth, stage.queue_slots);
    table.add({{stage.name, {}},
               {std::to_string(stage.n_in), {}},
               {std::to_string(stage.n_out), {}},
               {std::to_string(stage.n_dropped), {}},
               {n == 0 ? "–" : milliseconds(stage.busy_ns / n), {}},
               {milliseconds(stage.step.max_ns), {}},
               {queue, {}}});
  }
  std::string body =
      paragraph_html("This section alone differs between two runs on the same input.", "note") + table.html();
  body += counters_table({{"Messages sent", h.messages_sent, "telemetry, status records included"},
                          {"Messages failed", h.messages_failed, "not sent: no route, or the log's disk is full"}});
  for (const std::string& warning : h.warnings) body += paragraph_html("Warning: " + warning, "fault");
  return section_html("timing", title, body);
}

}  // namespace app
