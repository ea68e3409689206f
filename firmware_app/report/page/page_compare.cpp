#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "drivers/storage/printable.h"
#include "firmware_app/report/mode_match.h"
#include "firmware_app/report/page/page_parts.h"

namespace app {
namespace {

constexpr const char* kComparisonTitle = "Compared with";

// This run in the form of a result that was read.
ModalReport result_of(const PictureInputs& inputs) {
  ModalReport out;
  for (const core::ChannelInfo& channel : inputs.channels) out.channel_names.push_back(channel.name);
  out.estimate = estimate_of(inputs);
  return out;
}

std::string with_sigma(double value, const std::optional<double>& sigma, int n_decimals, const char* unit) {
  const std::string deviation = sigma ? " ± " + decimals_text(*sigma, n_decimals) : std::string();
  return decimals_text(value, n_decimals) + deviation + unit;
}

std::string damping_words(const core::Mode& mode) {
  return with_sigma(100.0 * mode.damping_ratio,
                    mode.damping_std ? std::optional<double>(100.0 * *mode.damping_std) : std::nullopt, 2, " %");
}

// The difference in units of its standard deviation: of both, or of the one that is known.
std::string sigmas_words(const core::Mode& mode, const core::Mode& former) {
  const double own = mode.frequency_std_hz.value_or(0.0), other = former.frequency_std_hz.value_or(0.0);
  const double sigma = std::hypot(own, other);
  return sigma > 0.0 ? decimals_text((mode.frequency_hz - former.frequency_hz) / sigma, 1) + " σ" : "–";
}

std::vector<HtmlCell> matched_row(std::size_t number, const core::Mode& mode, const ModeMatch& match) {
  std::vector<HtmlCell> cells{{std::to_string(number), {}},
                              {with_sigma(mode.frequency_hz, mode.frequency_std_hz, 3, " Hz"), {}}};
  if (match.mode == nullptr) {
    for (const char* text : {"none within 10 %", "–", "–"}) cells.push_back({text, {}});
    cells.push_back({damping_words(mode), {}});
    for (const char* text : {"–", "–"}) cells.push_back({text, {}});
    return cells;
  }
  const core::Mode& former = *match.mode;
  cells.push_back({with_sigma(former.frequency_hz, former.frequency_std_hz, 3, " Hz"), {}});
  cells.push_back({decimals_text(100.0 * (mode.frequency_hz / former.frequency_hz - 1.0), 2) + " %", {}});
  cells.push_back({sigmas_words(mode, former), {}});
  cells.push_back({damping_words(mode), {}});
  cells.push_back({damping_words(former), {}});
  cells.push_back({decimals_text(match.mac, 4), {}});
  return cells;
}

// The file and its folder: a whole path tells about a computer, not about a run.
std::string short_name(const std::string& path) {
  const std::filesystem::path whole(path);
  return (whole.parent_path().filename() / whole.filename()).string();
}

std::string only_there(const ModalReport& former, const std::vector<const core::Mode*>& matched) {
  std::string out;
  for (const core::Mode& mode : former.estimate.modes) {
    if (std::find(matched.begin(), matched.end(), &mode) != matched.end()) continue;
    out += (out.empty() ? "" : ", ") + four_digits_text(mode.frequency_hz) + " Hz";
  }
  return out;
}

}  // namespace

std::string comparison_section(const PictureInputs& inputs) {
  if (!inputs.former_fault.empty()) {
    return section_html("comparison", "Comparison",
                        absent_html("The former result cannot be read: " + inputs.former_fault));
  }
  if (inputs.former == nullptr) {
    return section_html("comparison", "Comparison",
                        absent_html("No former run or model was given: report.compare names a modal.json."));
  }
  const ModalReport own = result_of(inputs);
  const std::vector<std::string> names = common_channels(own, *inputs.former);
  HtmlTable table({"Mode", "This run", "There", "Difference", "in sigmas", "Damping here", "Damping there", "MAC"});
  std::vector<const core::Mode*> matched;
  for (std::size_t i = 0; i < own.estimate.modes.size(); ++i) {
    const core::Mode& mode = own.estimate.modes[i];
    const ModeMatch match = find_mode(*inputs.former, mode, names, shape_for(own, mode, names));
    matched.push_back(match.mode);
    table.add(matched_row(i + 1, mode, match));
  }
  std::string body =
      paragraph_html(fmt::format("{}, by {} of the same name.", drivers::printable(short_name(inputs.former_name)),
                                 plural(names.size(), "channel", "channels")));
  body += own.estimate.modes.empty() ? absent_html("This run found no mode to compare.") : table.html();
  if (const std::string rest = only_there(*inputs.former, matched); !rest.empty())
    body += paragraph_html("Only there: " + rest + ".");
  body +=
      paragraph_html("σ: standard deviation of the difference, from the ± of both, or of the one that has it.", "note");
  return section_html("comparison", std::string(kComparisonTitle) + " a former result", body);
}

}  // namespace app
