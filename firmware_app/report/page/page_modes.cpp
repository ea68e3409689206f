#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/storage/printable.h"
#include "firmware_app/report/estimate_words.h"
#include "firmware_app/report/page/page_parts.h"
#include "firmware_app/report/plot/verdict_marks.h"

namespace app {
namespace {

HtmlCell frequency_cell(const core::Mode& mode) {
  std::string out = four_digits_text(mode.frequency_hz);
  if (mode.frequency_std_hz) out += " ± " + decimals_text(*mode.frequency_std_hz, 3);
  out += " Hz";
  out += other_frequencies_text(mode);
  if (!is_folded(mode)) return {out, {}};
  return {out, fmt::format("<small>seen at {} Hz</small>", svg_escaped(four_digits_text(mode.apparent_hz)))};
}

std::string damping_of(const core::Mode& mode) {
  std::string out = decimals_text(100.0 * mode.damping_ratio, 2);
  if (mode.damping_std) out += " ± " + decimals_text(100.0 * *mode.damping_std, 2);
  return out + " %";
}

std::string marker_html(const VerdictMark& mark) {
  SvgDocument svg(14.0, 14.0, mark.label, true);
  svg.marker(7.0, 7.0, 4.5, mark.marker, mark.marker_class);
  return "<span class=\"mark\">" + svg.text_of() + "</span>";
}

std::string poles_table(const std::vector<core::Mode>& modes, const char* first_column) {
  HtmlTable table({first_column, "Frequency", "Damping", "In phase (MPC)", "Verdict", "Reason"}, "poles");
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const VerdictMark& mark = mark_of(modes[i].verdict);
    table.add({{std::to_string(i + 1), {}},
               frequency_cell(modes[i]),
               {damping_of(modes[i]), {}},
               {decimals_text(modes[i].mpc, 3), {}},
               {{}, marker_html(mark) + (modes[i].verdict == core::Verdict::kStructural ? "structural" : mark.label)},
               {modes[i].reason, {}}});
  }
  return table.html();
}

// More channels than this are words: as columns they would be wider than the page.
constexpr std::size_t kMaxPeakColumns = 8;
constexpr std::size_t kMaxNamedChannels = 4;

bool is_known_share(const core::SpectralPeak& peak, const core::ModalEstimate& estimate, std::size_t c) {
  return c < peak.share.size() && (c >= estimate.channels.size() || estimate.channels[c].takes_part);
}

std::string strongest_words(const core::SpectralPeak& peak, const PictureInputs& inputs,
                            const core::ModalEstimate& estimate) {
  std::vector<std::size_t> order;
  for (std::size_t c = 0; c < inputs.channels.size(); ++c) {
    if (is_known_share(peak, estimate, c)) order.push_back(c);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return peak.share[a] > peak.share[b]; });
  std::string out;
  for (std::size_t i = 0; i < order.size() && i < kMaxNamedChannels; ++i) {
    out += fmt::format("{}{} {}", i == 0 ? "" : ", ", inputs.channels[order[i]].name,
                       decimals_text(peak.share[order[i]], 2));
  }
  return order.size() > kMaxNamedChannels ? out + ", …" : out;
}

std::string peaks_table(const PictureInputs& inputs, const core::ModalEstimate& estimate) {
  const bool with_columns = inputs.channels.size() <= kMaxPeakColumns;
  std::vector<std::string> columns{"Frequency", "Height"};
  for (const core::ChannelInfo& channel : inputs.channels) {
    if (with_columns) columns.push_back(channel.name);
  }
  if (!with_columns) columns.emplace_back("Largest in");
  HtmlTable table(std::move(columns));
  for (const core::SpectralPeak& peak : estimate.peaks) {
    std::vector<HtmlCell> cells{
        {fmt::format("{} ± {} Hz", four_digits_text(peak.frequency_hz), decimals_text(0.5 * peak.resolution_hz, 3)),
         {}},
        {decimals_text(peak.height, 0), {}}};
    for (std::size_t c = 0; with_columns && c < inputs.channels.size(); ++c)
      cells.push_back({is_known_share(peak, estimate, c) ? decimals_text(peak.share[c], 2) : "–", {}});
    if (!with_columns) cells.push_back({strongest_words(peak, inputs, estimate), {}});
    table.add(std::move(cells));
  }
  return paragraph_html(
             "Height: power over that beside it; then the channels' amplitudes, the largest is 1. Motion of the "
             "camera, "
             "inputs and machines have peaks, too.",
             "note") +
         table.html();
}

// Without a mode the peaks are what the page has to show.
std::string peaks_html(const PictureInputs& inputs, const core::ModalEstimate& estimate) {
  if (estimate.peaks.empty()) return {};
  const std::string title = plural(estimate.peaks.size(), "peak", "peaks") + " of the spectra, without a verdict";
  if (estimate.modes.empty()) return fmt::format("<h3>{}</h3>\n{}", title, peaks_table(inputs, estimate));
  return fmt::format("<details><summary>{}</summary>\n{}</details>\n", title, peaks_table(inputs, estimate));
}

std::string copied_number(double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : ""; }
std::string copied_number(const std::optional<double>& value) { return value ? copied_number(*value) : ""; }

// More components than this make the page too large; they are in modal.json.
constexpr std::size_t kMaxCopiedComponents = 1'000;
std::span<const core::ChannelInfo> copied_channels(const PictureInputs& inputs, const core::ModalEstimate& estimate) {
  if (inputs.channels.size() * estimate.modes.size() > kMaxCopiedComponents) return {};
  return inputs.channels;
}

// The table as text with tabs, which spreadsheets take from the clipboard; unknown values are empty.
std::string copied_text(const PictureInputs& inputs, const core::ModalEstimate& estimate) {
  std::string out = "mode\tfrequency_hz\tsigma_hz\tdamping_percent\tsigma_percent\tmpc\tapparent_hz";
  for (const core::ChannelInfo& channel : copied_channels(inputs, estimate))
    out += fmt::format("\t{0} re\t{0} im\t{0} sigma", drivers::printable(channel.name));
  for (std::size_t i = 0; i < estimate.modes.size(); ++i) {
    const core::Mode& mode = estimate.modes[i];
    const auto percent = [](const std::optional<double>& value) {
      return value ? std::optional<double>(100.0 * *value) : std::nullopt;
    };
    out +=
        fmt::format("\n{}\t{}\t{}\t{}\t{}\t{}\t{}", i + 1, copied_number(mode.frequency_hz),
                    copied_number(mode.frequency_std_hz), copied_number(100.0 * mode.damping_ratio),
                    copied_number(percent(mode.damping_std)), copied_number(mode.mpc), copied_number(mode.apparent_hz));
    for (std::size_t c = 0; c < copied_channels(inputs, estimate).size(); ++c) {
      const bool known = c < mode.shape.size();
      out += fmt::format("\t{}\t{}\t{}", known ? copied_number(mode.shape[c].real()) : "",
                         known ? copied_number(mode.shape[c].imag()) : "",
                         c < mode.shape_std.size() ? copied_number(mode.shape_std[c]) : "");
    }
  }
  return out + "\n";
}

// Lines and tabs are markup here, not text: svg_escaped() is for one line.
std::string escaped_lines(const std::string& text) {
  std::string out, piece;
  for (const char c : text) {
    if (c != '\t' && c != '\n') {
      piece += c;
      continue;
    }
    out += svg_escaped(piece) + c;
    piece.clear();
  }
  return out + svg_escaped(piece);
}

std::string copy_html(const PictureInputs& inputs, const core::ModalEstimate& estimate) {
  return fmt::format(
      "<details><summary>The table to copy, {}</summary>\n<p class=\"controls\" hidden=\"hidden\">"
      "<button type=\"button\" id=\"copy\">Copy</button><span id=\"copied\" role=\"status\"></span></p>\n"
      "<pre id=\"modes-text\" tabindex=\"0\" aria-label=\"Modes, separated by tabs\">{}</pre></details>\n",
      copied_channels(inputs, estimate).empty() ? "with ±; the shapes are in modal.json" : "with shapes and ±",
      escaped_lines(copied_text(inputs, estimate)));
}

std::string mac_table(const std::vector<core::Mode>& modes, std::size_t n) {
  std::vector<std::string> columns{"Mode"};
  for (std::size_t j = 0; j < n; ++j) columns.push_back(std::to_string(j + 1));
  HtmlTable table(std::move(columns));
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<HtmlCell> cells{{fmt::format("{}: {} Hz", i + 1, four_digits_text(modes[i].frequency_hz)), {}}};
    for (std::size_t j = 0; j < n; ++j) cells.push_back({decimals_text(mac_of(modes[i], modes[j]), 4), {}});
    table.add(std::move(cells));
  }
  return table.html();
}

}  // namespace

std::string modes_section(const PictureInputs& inputs) {
  const core::ModalEstimate& estimate = estimate_of(inputs);
  std::string body =
      estimate.modes.empty() ? absent_html(modes_sentence(estimate)) : poles_table(estimate.modes, "Mode");
  const bool any_sigma = std::any_of(estimate.modes.begin(), estimate.modes.end(),
                                     [](const core::Mode& mode) { return mode.frequency_std_hz.has_value(); });
  if (!estimate.modes.empty() && !any_sigma)
    body += paragraph_html("No ± is shown: standard deviations need a record of two segments or more.", "note");
  if (!estimate.rejected.empty()) {
    body += fmt::format("<details><summary>{}, with reasons</summary>\n{}</details>\n",
                        plural(estimate.rejected.size(), "rejected pole", "rejected poles"),
                        poles_table(estimate.rejected, "Pole"));
  }
  if (!estimate.modes.empty()) body += copy_html(inputs, estimate);
  body += peaks_html(inputs, estimate);
  return section_html("modes", "Modes", body);
}

std::string mac_section(const PictureInputs& inputs) {
  const std::string title = "MAC matrix";
  if (mac_svg(inputs, kWideFormat).empty())
    return section_html("mac", title, absent_html("Shapes are compared where two modes or more are found."));
  const std::vector<core::Mode>& modes = inputs.estimate->modes;
  const std::size_t n = std::min(modes.size(), kMaxMacModes);
  std::string caption =
      "Modal assurance criterion of every pair of modes: 1 for one shape, 0 for shapes that share nothing. A large "
      "value "
      "beside the diagonal says that the channels do not distinguish the two, or that one mode was found twice.";
  if (modes.size() > n) caption += fmt::format(" The first {} of {} modes.", n, modes.size());
  return section_html(
      "mac", title,
      figure_html(mac_svg(inputs, kWideFormat), mac_svg(inputs, kNarrowFormat), {}, svg_escaped(caption)) +
          fmt::format("<details><summary>The numbers</summary>\n{}</details>\n", mac_table(modes, n)));
}

}  // namespace app
