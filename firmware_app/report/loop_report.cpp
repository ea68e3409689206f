#include "firmware_app/report/loop_report.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "drivers/storage/json.h"
#include "drivers/storage/json_values.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/report/closure_json.h"

namespace app {
namespace {

using core::closure::LoopLevel;
using core::closure::LoopMode;
using core::closure::LoopResult;
using Json = nlohmann::ordered_json;
using drivers::or_null;

std::string cell(const std::optional<double>& value, fmt::format_string<const double&> format) {
  return value ? fmt::format(format, *value) : "-";
}

std::string estimate_text(const std::optional<LoopMode::Estimate>& one) {
  if (!one) return fmt::format("{:>28}", "not found");
  std::string frequency = fmt::format("{:.4f}", one->frequency_hz);
  if (one->frequency_std_hz) frequency += fmt::format(" +- {:.4f}", *one->frequency_std_hz);
  return fmt::format("{:>20}  {:>5.2f}", frequency, 100.0 * one->damping_ratio);
}

std::string comparison(const LoopResult& result) {
  return result.has_reference ? "error against the reference, %" : "second half of the record less the first, %";
}

Json estimate_json(const std::optional<LoopMode::Estimate>& one) {
  if (!one) return nullptr;
  return {{"frequency_hz", one->frequency_hz},
          {"frequency_std_hz", or_null(one->frequency_std_hz)},
          {"damping_ratio", one->damping_ratio},
          {"damping_std", or_null(one->damping_std)},
          {"error_percent", or_null(one->error_percent)},
          {"halves_percent", or_null(one->halves_percent)}};
}

Json level_json(const LoopLevel& level) {
  Json findings = Json::array();
  for (const LoopLevel::Finding& finding : level.findings)
    findings.push_back({{"effect", finding.effect}, {"repair", finding.repair}});
  Json out{{"level", level.level},
           {"skipped", level.skipped},
           {"residual_before", or_null(level.residual_before)},
           {"residual_after", or_null(level.residual_after)},
           {"unit", level.unit},
           {"findings", findings},
           {"left", level.left}};
  out["closure"] = level.result ? Json::parse(closure_json(*level.result)) : Json(nullptr);
  return out;
}

}  // namespace

std::string loop_text(const LoopResult& result) {
  std::string out = fmt::format("{:<18}{:>12}{:>12}  {}\n", "level", "before", "after", "found, and what was done");
  for (const LoopLevel& level : result.levels) {
    if (!level.skipped.empty()) {
      out += fmt::format("{:<18}{:>12}{:>12}  not done: {}\n", level.level, "-", "-", level.skipped);
      continue;
    }
    out +=
        fmt::format("{:<18}{:>12}{:>12}  {} rms{}\n", level.level, cell(level.residual_before, "{:.4g}"),
                    cell(level.residual_after, "{:.4g}"), level.unit, level.findings.empty() ? "; nothing found" : "");
    for (const LoopLevel::Finding& finding : level.findings)
      out += fmt::format("{:44}{} -> {}\n", "", finding.effect,
                         finding.repair.empty() ? "no repair applies to the record" : finding.repair);
    if (!level.left.empty()) out += fmt::format("{:44}left: {}\n", "", level.left);
  }
  out += fmt::format("\n{:<6}{:>12}{:>28}{:>28}   {}: before, after\n", "mode", "reference", "before: Hz, damping %",
                     "after: Hz, damping %", comparison(result));
  for (std::size_t i = 0; i < result.modes.size(); ++i) {
    const LoopMode& mode = result.modes[i];
    out += fmt::format("{:<6}{:>12}{:>28}{:>28}   {:>8} {:>8}\n", i + 1, cell(mode.reference_hz, "{:.4f}"),
                       estimate_text(mode.before), estimate_text(mode.after),
                       cell(result.compared(mode.before), "{:+.3f}"), cell(result.compared(mode.after), "{:+.3f}"));
  }
  if (result.modes.empty()) out += "no mode was identified\n";
  if (result.error_before && result.error_after)
    out += fmt::format("rms over the modes found both times, {}: {:.3f} -> {:.3f}\n", comparison(result),
                       *result.error_before, *result.error_after);
  for (const std::string& remark : result.remarks) out += remark + "\n";
  return out;
}

std::string loop_json(const LoopResult& result) {
  Json out;
  out["version"] = 1;
  out["levels"] = Json::array();
  for (const LoopLevel& level : result.levels) out["levels"].push_back(level_json(level));
  out["modes"] = Json::array();
  for (const LoopMode& mode : result.modes)
    out["modes"].push_back({{"reference_hz", or_null(mode.reference_hz)},
                            {"before", estimate_json(mode.before)},
                            {"after", estimate_json(mode.after)}});
  out["compared_with"] = result.has_reference ? "reference" : "halves";
  out["error_percent_before"] = or_null(result.error_before);
  out["error_percent_after"] = or_null(result.error_after);
  out["remarks"] = result.remarks;
  return drivers::to_json_text(out).text;
}

void write_loop_report(const std::string& directory, const LoopResult& result) {
  const std::filesystem::path folder = directory;
  drivers::write_file_atomically((folder / "loop.json").string(), loop_json(result));
  drivers::write_file_atomically((folder / "loop.html").string(), loop_page(result));
}

}  // namespace app
