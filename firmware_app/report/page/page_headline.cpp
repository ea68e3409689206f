#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "firmware_app/report/estimate_words.h"
#include "firmware_app/report/page/page_parts.h"
#include "firmware_app/report/plot/verdict_marks.h"
#include "firmware_app/report/recording_words.h"

namespace app {
namespace {

std::string plural(std::size_t n, const char* one, const char* many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

std::size_t count_of(const std::vector<core::Mode>& modes, core::Verdict verdict) {
  return static_cast<std::size_t>(
      std::count_if(modes.begin(), modes.end(), [&](const core::Mode& mode) { return mode.verdict == verdict; }));
}

std::string modes_sentence(const core::ModalEstimate& estimate) {
  if (estimate.modes.empty()) {
    const std::string why =
        estimate.status == "ok" || estimate.status.empty() ? "no peak passed every test" : estimate.status;
    return fmt::format("No mode of the structure was found: {}.", why);
  }
  const std::vector<core::Mode>& modes = estimate.modes;
  std::string out =
      plural(modes.size(), "mode of the structure was found, at ", "modes of the structure were found, from ");
  out += four_digits_text(modes.front().frequency_hz);
  if (modes.size() > 1) out += " to " + four_digits_text(modes.back().frequency_hz);
  out += " Hz.";
  const auto n_folded = static_cast<std::size_t>(std::count_if(modes.begin(), modes.end(), is_folded));
  if (n_folded > 0) {
    out += fmt::format(
        " {} faster than the camera can follow directly and {} placed by the delays of the image's rows.",
        n_folded == 1 ? "One of them is" : fmt::format("{} of them are", n_folded), n_folded == 1 ? "was" : "were");
  }
  const double cycles = modes.front().frequency_hz * estimate.duration_s;
  if (std::isfinite(cycles)) out += fmt::format(" The slowest was watched through {:.0f} cycles.", std::floor(cycles));
  return out;
}

std::string rejected_sentence(const core::ModalEstimate& estimate) {
  if (estimate.rejected.empty()) return {};
  std::vector<std::string> parts;
  for (const VerdictMark& mark : verdict_marks()) {
    const std::size_t n = count_of(estimate.rejected, mark.verdict);
    if (n > 0) parts.push_back(plural(n, mark.label, mark.plural));
  }
  return fmt::format("{} set aside ({}).", plural(estimate.rejected.size(), "other pole was", "other poles were"),
                     fmt::join(parts, ", "));
}

std::string losses_sentence(const RunFacts& facts) {
  const core::Health& h = facts.health;
  if (!facts.counted || h.frames_in == 0) return {};
  const std::uint64_t lost = h.frames_dropped + h.frames_missing;
  if (lost == 0) return fmt::format("None of the {} frames was lost.", h.frames_in);
  return fmt::format(
      "{} of {} frames were lost ({} %); the spectra leave them out.", lost, h.frames_in + h.frames_missing,
      decimals_text(100.0 * static_cast<double>(lost) / static_cast<double>(h.frames_in + h.frames_missing), 2));
}

bool has_fault(const RunFacts& facts) { return facts.health.state.starts_with("fault"); }

std::string fact_html(const char* name, const std::string& value) {
  return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", name, svg_escaped(value.empty() ? "–" : value));
}

std::string readout_text(const core::ReadoutFinding& readout) {
  const auto value = [](const core::ReadoutValue& v) {
    return decimals_text(1e3 * v.readout_s, 2) + (v.std_s > 0.0 ? " ± " + decimals_text(1e3 * v.std_s, 2) : "") + " ms";
  };
  std::string out = value(readout.used) + ", " + readout.why + " (declared " + value(readout.declared);
  if (readout.from_tracks) out += "; tracks " + value(*readout.from_tracks);
  if (readout.from_shapes) out += "; shapes " + value(*readout.from_shapes);
  return out + ")";
}

std::string facts_html(const PictureInputs& inputs, const core::ModalEstimate& estimate) {
  const RunFacts& facts = *inputs.facts;
  std::string out = "<dl class=\"facts\">\n";
  out += fact_html("Status", has_fault(facts) ? facts.health.state : "finished");
  out += fact_html("Duration", decimals_text(estimate.duration_s, 1) + " s");
  out += fact_html("Rate", estimate.rate_hz > 0.0 ? four_digits_text(estimate.rate_hz) + " Hz" : "unknown");
  out += fact_html("Samples",
                   fmt::format("{} in {}", estimate.n_samples, plural(estimate.n_segments, "segment", "segments")));
  out += fact_html("Method", facts.method == "paper" ? "paper (Yoon et al. 2017)" : facts.method);
  out += fact_html("Channels", std::to_string(inputs.channels.size()));
  out += fact_html("Corrections",
                   facts.corrections.empty() ? "none" : fmt::format("{}", fmt::join(facts.corrections, "; ")));
  if (estimate.readout) out += fact_html("Readout time", readout_text(*estimate.readout));
  if (!facts.caveats.empty()) out += fact_html("Left open", fmt::format("{}", fmt::join(facts.caveats, "; ")));
  return out + "</dl>\n";
}

const core::ModalEstimate& estimate_of(const PictureInputs& inputs) {
  static const core::ModalEstimate kNone;
  return inputs.estimate == nullptr ? kNone : *inputs.estimate;
}

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
  HtmlTable table({first_column, "Frequency", "Damping", "In phase (MPC)", "Verdict", "Reason"});
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

std::string peaks_html(const PictureInputs& inputs, const core::ModalEstimate& estimate) {
  if (estimate.peaks.empty()) return {};
  std::vector<std::string> columns{"Frequency", "Height"};
  for (const core::ChannelInfo& channel : inputs.channels) columns.push_back(channel.name);
  HtmlTable table(std::move(columns));
  for (const core::SpectralPeak& peak : estimate.peaks) {
    std::vector<HtmlCell> cells{
        {fmt::format("{} ± {} Hz", four_digits_text(peak.frequency_hz), decimals_text(0.5 * peak.resolution_hz, 3)),
         {}},
        {decimals_text(peak.height, 0), {}}};
    for (std::size_t c = 0; c < inputs.channels.size(); ++c) {
      const bool known = c < peak.share.size() && (c >= estimate.channels.size() || estimate.channels[c].takes_part);
      cells.push_back({known ? decimals_text(peak.share[c], 2) : "–", {}});
    }
    table.add(std::move(cells));
  }
  return fmt::format(
      "<details><summary>{} of the spectra, without a verdict</summary>\n{}{}</details>\n",
      plural(estimate.peaks.size(), "peak", "peaks"),
      paragraph_html("Height: power over that beside it; then each channel's amplitude, the largest is 1. "
                     "Motion of the camera, inputs and machines have peaks, too.",
                     "note"),
      table.html());
}

}  // namespace

std::string headline_html(const PictureInputs& inputs) {
  const RunFacts& facts = *inputs.facts;
  const core::ModalEstimate& estimate = estimate_of(inputs);
  std::string out = "<header>\n<h1>Modes of vibration</h1>\n";
  if (!facts.source.empty()) out += paragraph_html(facts.source, "source");
  if (has_fault(facts))
    out += paragraph_html(facts.health.state + ". The results below are those known by then.", "fault");
  std::string words = modes_sentence(estimate);
  for (const std::string& sentence :
       {rejected_sentence(estimate), losses_sentence(facts), recording_words(facts.health.times)}) {
    if (!sentence.empty()) words += " " + sentence;
  }
  for (const std::string& sentence : estimate_words(estimate, inputs.channels)) words += " " + sentence;
  out += paragraph_html(words, "verdict");
  return out + facts_html(inputs, estimate) + "</header>\n";
}

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
  body += peaks_html(inputs, estimate);
  return section_html("modes", "Modes", body);
}

}  // namespace app
