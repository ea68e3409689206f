#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "firmware_app/report/aircraft_facts.h"
#include "firmware_app/report/estimate_words.h"
#include "firmware_app/report/page/page_parts.h"
#include "firmware_app/report/plot/verdict_marks.h"
#include "firmware_app/report/recording_words.h"
#include "firmware_app/report/run_history.h"

namespace app {
namespace {

std::size_t count_of(const std::vector<core::Mode>& modes, core::Verdict verdict) {
  return static_cast<std::size_t>(
      std::count_if(modes.begin(), modes.end(), [&](const core::Mode& mode) { return mode.verdict == verdict; }));
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
  if (inputs.history != nullptr && !inputs.history->aircraft().empty())
    out += fact_html("Aircraft", aircraft_words(inputs.history->aircraft()));
  if (!facts.caveats.empty()) out += fact_html("Left open", fmt::format("{}", fmt::join(facts.caveats, "; ")));
  return out + "</dl>\n";
}

// A note "place: the old bridge" is a fact with a name; any other is a paragraph.
constexpr std::size_t kMaxFactName = 24;
bool is_fact(const std::string& note) {
  const std::size_t colon = note.find(": ");
  return colon != std::string::npos && colon > 0 && colon <= kMaxFactName && colon + 2 < note.size();
}

std::string notes_html(const RunFacts& facts) {
  std::string named, text;
  for (const std::string& note : facts.notes) {
    if (!is_fact(note)) {
      text += paragraph_html(note, "user-note");
      continue;
    }
    const std::size_t colon = note.find(": ");
    named += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", svg_escaped(note.substr(0, colon)),
                         svg_escaped(note.substr(colon + 2)));
  }
  return (named.empty() ? "" : "<dl class=\"facts stated\">\n" + named + "</dl>\n") + text;
}

}  // namespace

std::string headline_html(const PictureInputs& inputs) {
  const RunFacts& facts = *inputs.facts;
  const core::ModalEstimate& estimate = estimate_of(inputs);
  std::string out =
      fmt::format("<header>\n<h1>{}</h1>\n", facts.title.empty() ? "Modes of vibration" : svg_escaped(facts.title));
  std::string source = facts.title.empty() ? facts.source : "Modes of vibration";
  if (!facts.title.empty() && !facts.source.empty()) source += ", from " + facts.source;
  if (!source.empty()) out += paragraph_html(source, "source");
  out += notes_html(facts);
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

}  // namespace app
