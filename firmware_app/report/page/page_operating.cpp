#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "firmware_app/report/page/page_parts.h"
#include "firmware_app/report/plot/spectral_matrix.h"

namespace app {
namespace {

constexpr std::size_t kMaxPicks = 12;
constexpr const char* kOperatingTitle = "Operating deflection shape";

// Where the page begins: at the first mode, else at the highest peak, else where most moves.
std::size_t first_line(const SpectralLines& lines, const core::ModalEstimate& estimate) {
  if (!estimate.modes.empty() && std::isfinite(estimate.modes.front().apparent_hz))
    return lines.nearest(estimate.modes.front().apparent_hz);
  const auto highest = std::max_element(estimate.peaks.begin(), estimate.peaks.end(),
                                        [](const auto& a, const auto& b) { return a.height < b.height; });
  if (highest != estimate.peaks.end()) return lines.nearest(highest->frequency_hz);
  const auto most = std::max_element(
      lines.lines.begin(), lines.lines.end(),
      [](const SpectralLine& a, const SpectralLine& b) { return a.singular.front() < b.singular.front(); });
  return static_cast<std::size_t>(most - lines.lines.begin());
}

// Frequencies that have a button: the modes, where the camera saw them, else the peaks.
std::vector<double> picks_of(const core::ModalEstimate& estimate) {
  std::vector<double> out;
  for (const core::Mode& mode : estimate.modes) out.push_back(mode.apparent_hz);
  if (out.empty()) {
    for (const core::SpectralPeak& peak : estimate.peaks) out.push_back(peak.frequency_hz);
  }
  std::erase_if(out, [](double hz) { return !std::isfinite(hz); });
  out.resize(std::min(out.size(), kMaxPicks));
  return out;
}

// Every line for the script: frequencies and shares as text, components as signed bytes of 1/127.
std::string data_attributes(const SpectralLines& lines) {
  std::string hz, share, bytes;
  for (const SpectralLine& line : lines.lines) {
    hz += fmt::format("{}{:.5g}", hz.empty() ? "" : " ", line.frequency_hz);
    share += fmt::format("{}{:.0f}", share.empty() ? "" : " ", 100.0 * line.share);
    for (const std::complex<double>& value : line.shape) {
      for (const double part : {value.real(), value.imag()})
        bytes += static_cast<char>(static_cast<signed char>(std::lround(127.0 * std::clamp(part, -1.0, 1.0))));
    }
  }
  return fmt::format("data-hz=\"{}\" data-share=\"{}\" data-shapes=\"{}\"", hz, share, base64(bytes));
}

std::string controls_html(const SpectralLines& lines, std::size_t first, const core::ModalEstimate& estimate) {
  std::string out = fmt::format(
      "<div class=\"controls\" hidden=\"hidden\"><label>Frequency <input type=\"range\" id=\"line\" min=\"0\" "
      "max=\"{}\" step=\"1\" value=\"{}\"/></label>\n",
      lines.lines.size() - 1, first);
  for (const double hz : picks_of(estimate)) {
    out += fmt::format("<button type=\"button\" class=\"pick\" data-line-at=\"{}\">{} Hz</button>\n", lines.nearest(hz),
                       four_digits_text(hz));
  }
  return out + "</div>\n";
}

std::string words_of(const SpectralLine& line) {
  return fmt::format("At {:.5g} Hz this shape holds {:.0f} % of the motion.", line.frequency_hz, 100.0 * line.share);
}

std::string shape_table(const PictureInputs& inputs, const SpectralLine& line) {
  HtmlTable table({"Channel", "Amplitude", "Phase"}, "deflection");
  for (std::size_t c = 0; c < inputs.channels.size(); ++c) {
    const std::complex<double> value = c < line.shape.size() ? line.shape[c] : 0.0;
    table.add({{inputs.channels[c].name, {}},
               {decimals_text(std::abs(value), 2), {}},
               {fmt::format("{}°", std::lround(std::arg(value) * 180.0 / std::numbers::pi)), {}}});
  }
  return table.html();
}

}  // namespace

std::string operating_section(const PictureInputs& inputs) {
  if (inputs.lines == nullptr || inputs.lines->lines.empty() || inputs.channels.empty()) {
    return section_html("operating", kOperatingTitle,
                        inputs.facts->merged
                            ? merged_html("shape at a frequency")
                            : absent_html("There is no spectrum from which the shape at a frequency could be taken."));
  }
  const SpectralLines& lines = *inputs.lines;
  const core::ModalEstimate& estimate = estimate_of(inputs);
  const std::size_t first = first_line(lines, estimate);
  core::Mode shape;
  shape.shape = lines.lines[first].shape;
  const std::string picture = moving_svg(inputs, shape);
  std::string body = paragraph_html(
      "How the structure moved at one frequency, whether that is a mode or not: the first singular vector of the "
      "spectral matrix. Resonances, inputs and the camera are in it together.");
  if (!picture.empty() && estimate.modes.empty()) body += motion_controls();
  body += controls_html(lines, first, estimate);
  body += fmt::format("<p id=\"line-words\" role=\"status\">{}</p>\n", svg_escaped(words_of(lines.lines[first])));
  body += "<div class=\"beside\">\n";
  if (!picture.empty()) body += "<div class=\"card\">" + picture + "</div>\n";
  body += shape_table(inputs, lines.lines[first]) + "</div>\n";
  body += paragraph_html("Amplitude: the largest is 1. Phase: against the channel with the largest amplitude.", "note");
  return section_html("operating", kOperatingTitle,
                      fmt::format("<div id=\"deflection\" {}>\n{}</div>\n", data_attributes(lines), body));
}

}  // namespace app
