// loop.html: residual diagnosis over all levels, on one page.
#include <fmt/format.h>

#include "firmware_app/report/loop_report.h"
#include "firmware_app/report/page/html_text.h"
#include "firmware_app/report/page/page_parts.h"
#include "firmware_app/report/plot/svg_document.h"
#include "firmware_app/report/structure_section.h"

namespace app {
namespace {

using core::closure::LoopLevel;
using core::closure::LoopMode;
using core::closure::LoopResult;

const char* compared_text(const LoopResult& result) {
  return result.has_reference ? "frequency less the reference, %" : "second half of the record less the first, %";
}

std::string number_text(const std::optional<double>& value, fmt::format_string<const double&> format) {
  return value ? fmt::format(format, *value) : "-";
}

std::string levels_html(const LoopResult& result) {
  HtmlTable table({"level", "residual before", "after", "found", "what was done", "left"}, "words");
  for (const LoopLevel& level : result.levels) {
    if (!level.skipped.empty()) {
      table.add({{level.level, {}}, {"-", {}}, {"-", {}}, {"not done: " + level.skipped, {}}, {"-", {}}, {"-", {}}});
      continue;
    }
    std::string found, done;
    for (const LoopLevel::Finding& finding : level.findings) {
      const char* separator = found.empty() ? "" : "; ";
      found += separator + finding.effect;
      done += separator + (finding.repair.empty() ? "no repair applies to the record" : finding.repair);
    }
    table.add({{level.level, {}},
               {number_text(level.residual_before, "{:.4g}") + " " + level.unit, {}},
               {number_text(level.residual_after, "{:.4g}") + " " + level.unit, {}},
               {found.empty() ? "nothing" : found, {}},
               {done.empty() ? "-" : done, {}},
               {level.left.empty() ? "-" : level.left, {}}});
  }
  return table.html();
}

std::string estimate_html(const std::optional<LoopMode::Estimate>& one) {
  if (!one) return "not found";
  const std::string sigma = one->frequency_std_hz ? fmt::format(" ± {:.4f}", *one->frequency_std_hz) : "";
  return fmt::format("{:.4f}{} Hz, {:.2f} %", one->frequency_hz, sigma, 100.0 * one->damping_ratio);
}

std::string modes_html(const LoopResult& result) {
  HtmlTable table({"mode", "reference Hz", "before: frequency, damping", "after: frequency, damping",
                   std::string(compared_text(result)) + ", before", "after"},
                  "words");
  for (std::size_t i = 0; i < result.modes.size(); ++i) {
    const LoopMode& mode = result.modes[i];
    table.add({{std::to_string(i + 1), {}},
               {number_text(mode.reference_hz, "{:.4f}"), {}},
               {estimate_html(mode.before), {}},
               {estimate_html(mode.after), {}},
               {number_text(result.compared(mode.before), "{:+.3f}"), {}},
               {number_text(result.compared(mode.after), "{:+.3f}"), {}}});
  }
  return result.modes.empty() ? absent_html("No mode was identified.") : table.html();
}

// The numbers of modes_html() as a picture; empty if there are none.
std::string picture_html(const LoopResult& result) {
  core::closure::ClosureResult drawn;
  for (std::size_t i = 0; i < result.modes.size(); ++i) {
    for (const bool after : {false, true}) {
      const auto& one = after ? result.modes[i].after : result.modes[i].before;
      if (!one) continue;
      core::closure::ClosureMode mode;
      mode.number = static_cast<int>(i) + 1;
      mode.frequency_hz = one->frequency_hz;
      mode.error_percent = result.compared(one);
      if (one->frequency_std_hz) mode.sigma_percent = 100.0 * *one->frequency_std_hz / one->frequency_hz;
      (after ? drawn.modes_after : drawn.modes_before).push_back(mode);
    }
  }
  drawn.baseline_rms = result.error_before.value_or(0.0), drawn.residual_rms = result.error_after.value_or(0.0);
  return modes_figure_html(drawn, compared_text(result));
}

}  // namespace

std::string loop_page(const LoopResult& result) {
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\"/>\n"
      "<meta name=\"color-scheme\" content=\"light dark\"/>\n<title>Residual diagnosis over all levels</title>\n"
      "<style>\n{}{}</style>\n</head>\n<body>\n<main>\n",
      svg_style(), page_css());
  out += section_html("levels", "Levels: residual before and after, what was found and done", levels_html(result));
  std::string modes = modes_html(result);
  if (result.error_before && result.error_after) {
    modes += paragraph_html(fmt::format("rms over the modes found both times, {}: {:.3f} before, {:.3f} after.",
                                        compared_text(result), *result.error_before, *result.error_after));
  }
  modes += picture_html(result);
  out += section_html("modes", "Modes before any repair and after the last", modes);
  out += structure_section(result);
  for (const std::string& remark : result.remarks) out += paragraph_html(remark);
  return out + "</main>\n<footer><p>Written by hovermodal " HOVERMODAL_VERSION
               ". The numbers of this page are in <code>loop.json</code>.</p></footer>\n</body>\n</html>\n";
}

}  // namespace app
