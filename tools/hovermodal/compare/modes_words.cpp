#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "drivers/storage/json.h"
#include "drivers/storage/json_values.h"
#include "tools/hovermodal/compare/modes.h"

namespace tools {
namespace {

std::string compared_row(const ComparedMode& mode) {
  if (!mode.error_percent) {
    return fmt::format("{:4} {:>10} {:>10}\n", mode.number,
                       mode.found_hz    ? fmt::format("{:.4f}", *mode.found_hz)
                       : mode.is_folded ? "folded"
                                        : "not found",
                       mode.reference_hz ? fmt::format("{:.4f}", *mode.reference_hz) : "not found");
  }
  std::string text = fmt::format("{:4} {:10.4f} {:10.4f} {:+8.3f} {:8.3f} {:8.3f}", mode.number, *mode.found_hz,
                                 *mode.reference_hz, *mode.error_percent, *mode.mac_percent, *mode.real_mac_percent);
  if (mode.true_hz)
    text += fmt::format("  {:8.3f} {:+8.3f} {:7.2f}", *mode.true_hz, *mode.true_error_percent, *mode.true_error_sigmas);
  if (mode.paper) {
    text += fmt::format("   {:14.3f} {:8.3f} {:8.2f} {:6.2f}", mode.paper->drone_hz, mode.paper->accelerometer_hz,
                        mode.paper->error_percent, mode.paper->mac_percent);
  }
  return text + "\n";
}

}  // namespace

std::string compared_text(const std::vector<ComparedMode>& modes, bool with_truth, bool with_paper) {
  std::string text =
      fmt::format("{:>4} {:>10} {:>10} {:>8} {:>8} {:>8}", "mode", "found Hz", "ref. Hz", "error %", "MAC %", "real %");
  if (with_truth) text += fmt::format("  {:>8} {:>8} {:>7}", "true Hz", "error %", "sigmas");
  if (with_paper) text += fmt::format("   {:>33}", "paper: drone Hz  ref. Hz  error %  MAC %");
  text += "\n";
  for (const ComparedMode& mode : modes) text += compared_row(mode);
  return text;
}

std::string compared_json(const std::vector<ComparedMode>& modes) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ComparedMode& mode : modes) {
    list.push_back({{"mode", mode.number},
                    {"found_hz", drivers::or_null(mode.found_hz)},
                    {"reference_hz", drivers::or_null(mode.reference_hz)},
                    {"folded", mode.is_folded},
                    {"error_percent", drivers::or_null(mode.error_percent)},
                    {"mac_percent", drivers::or_null(mode.mac_percent)},
                    {"real_mac_percent", drivers::or_null(mode.real_mac_percent)},
                    {"true_hz", drivers::or_null(mode.true_hz)},
                    {"true_error_percent", drivers::or_null(mode.true_error_percent)},
                    {"true_error_sigmas", drivers::or_null(mode.true_error_sigmas)}});
    if (mode.paper) {
      list.back()["paper"] = {{"drone_hz", mode.paper->drone_hz},
                              {"accelerometer_hz", mode.paper->accelerometer_hz},
                              {"error_percent", mode.paper->error_percent},
                              {"mac_percent", mode.paper->mac_percent}};
    }
  }
  return drivers::to_json_text({{"version", 1}, {"modes", list}}).text;
}

}  // namespace tools
