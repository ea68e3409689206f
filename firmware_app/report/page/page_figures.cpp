#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include "firmware_app/report/page/page_parts.h"
#include "firmware_app/report/plot/spectral_matrix.h"
#include "firmware_app/report/plot/verdict_marks.h"
#include "firmware_app/report/run_history.h"

namespace app {
namespace {

constexpr std::size_t kMaxCards = 12;
constexpr std::size_t kMaxCardRegions = 260;  // of all cards together: many channels make few cards

using Picture = std::string (*)(const PictureInputs&, const PictureFormat&);

std::string figure(const PictureInputs& inputs, Picture picture, const std::string& above, std::string_view caption) {
  return figure_html(picture(inputs, kWideFormat), picture(inputs, kNarrowFormat), above, svg_escaped(caption));
}

std::string curves_legend(const PictureInputs& inputs) {
  std::string out = "<div class=\"legend\" role=\"group\" aria-label=\"Curves\">\n";
  const std::vector<LegendEntry> channels = spectra_legend(inputs);
  for (std::size_t i = 0; i < channels.size(); ++i) out += key_html(i, channels[i].label, channels[i].css_class);
  if (const std::string cross = cross_label(inputs); !cross.empty()) out += key_html(channels.size(), cross, "cross");
  return out + "</div>\n";
}

bool has_verdict(const core::ModalEstimate& estimate, core::Verdict verdict) {
  for (const auto* list : {&estimate.modes, &estimate.rejected}) {
    for (const core::Mode& mode : *list) {
      if (mode.verdict == verdict) return true;
    }
  }
  return false;
}

// Meaning of the markers; only of those that occur.
std::string marks_legend(const PictureInputs& inputs, const std::string& more = {}) {
  if (inputs.estimate == nullptr) return {};
  std::string out = "<ul class=\"marks\">\n";
  for (const VerdictMark& mark : verdict_marks()) {
    if (!has_verdict(*inputs.estimate, mark.verdict)) continue;
    SvgDocument svg(14.0, 14.0, mark.label, true);
    svg.marker(7.0, 7.0, 4.0, mark.marker, mark.marker_class);
    out +=
        fmt::format("<li><span class=\"mark\">{}</span><b>{}</b> {}</li>\n", svg.text_of(), mark.label, mark.meaning);
  }
  return out + more + "</ul>\n";
}

std::string heading_of(const core::Mode& mode, std::size_t i) {
  std::string details =
      fmt::format("damping {} %, MPC {}", decimals_text(100.0 * mode.damping_ratio, 2), decimals_text(mode.mpc, 3));
  return fmt::format("<h3>Mode {}: {}</h3>\n<p class=\"note\">{}</p>\n", i + 1, svg_escaped(frequency_text(mode, true)),
                     svg_escaped(details));
}

}  // namespace

std::string key_html(std::size_t i_curve, const std::string& label, const std::string& css_class) {
  return fmt::format(
      "<button type=\"button\" class=\"key\" aria-pressed=\"true\" data-k=\"{}\"><svg class=\"hm\" width=\"30\" "
      "height=\"10\" aria-hidden=\"true\"><path class=\"{}\" d=\"M1 5h28\"/></svg>{}</button>\n",
      i_curve, css_class, svg_escaped(label));
}

std::string motion_controls() {
  return "<div class=\"controls motion\" hidden=\"hidden\"><button type=\"button\" id=\"play\">Play</button>\n"
         "<label>Amplitude <input type=\"range\" id=\"amplitude\" min=\"0\" max=\"2\" step=\"0.1\" "
         "value=\"1\"/></label></div>\n";
}

std::string shapes_section(const PictureInputs& inputs) {
  if (inputs.estimate == nullptr || inputs.estimate->modes.empty())
    return section_html("shapes", "Mode shapes", absent_html("There are no shapes to draw: no mode was found."));
  const std::vector<core::Mode>& modes = inputs.estimate->modes;
  const bool in_image = !inputs.regions.empty();
  const std::size_t n_cards =
      std::min({modes.size(), kMaxCards,
                std::max<std::size_t>(3, kMaxCardRegions / std::max<std::size_t>(1, inputs.channels.size()))});
  std::string cards;
  for (std::size_t i = 0; i < n_cards; ++i) {
    const std::string svg = mode_svg(inputs, modes[i]);
    cards += fmt::format("<div class=\"card\">\n{}{}</div>\n", heading_of(modes[i], i),
                         svg.empty() ? absent_html("The shape of this mode is not known.") : svg);
  }
  const std::string words =
      in_image
          ? fmt::format(
                "Each region at one extreme of its motion, greatly exaggerated, {}; beside it the components "
                "along the structure, the largest set to 1. Squares are the base.",
                has_frame(inputs) ? "on the first frame" : "at its place in the image")
          : "Components of the channels, the largest set to 1. The input was a time series: there is no picture of the "
            "structure.";
  std::string body = paragraph_html(words);
  if (in_image) body += motion_controls();
  const bool any_std =
      std::any_of(modes.begin(), modes.end(), [](const auto& mode) { return !mode.shape_std.empty(); });
  body += "<div class=\"cards\">\n" + cards + "</div>\n";
  body += paragraph_html(any_std ? "Bars: one standard deviation to both sides."
                                 : "No bars: standard deviations need a record of two segments or more.",
                         "note");
  const auto has_both = [](const core::Region& region) { return region.both_axes; };
  if (std::any_of(inputs.regions.begin(), inputs.regions.end(), has_both)) {
    body +=
        paragraph_html("Regions with two axes: solid is the motion along u (right), dashed along v (down).", "note");
  }
  if (modes.size() > n_cards)
    body += paragraph_html(fmt::format("{} more modes are in the table above only.", modes.size() - n_cards), "note");
  return section_html("shapes", "Mode shapes", body);
}

std::string spectra_section(const PictureInputs& inputs) {
  if (spectra_svg(inputs, kWideFormat).empty()) {
    return section_html("spectra", "Spectra",
                        inputs.facts->merged
                            ? merged_html("spectrum")
                            : absent_html("There is no spectrum: the record ended before its first segment was full."));
  }
  const std::string cross = cross_label(inputs);
  std::string caption = fmt::format("Power spectral density of every channel ({})", spectra_remark(inputs));
  if (!cross.empty())
    caption += fmt::format(", and {}, the cross-spectrum of the two channels that share most power", cross);
  caption += ". Dashed lines: modes, where the camera saw them. Markers along the upper edge: rejected poles.";
  return section_html("spectra", "Spectra",
                      figure(inputs, spectra_svg, curves_legend(inputs), caption) + marks_legend(inputs));
}

std::string singular_section(const PictureInputs& inputs) {
  const std::string title = "Singular values";
  if (singular_values_svg(inputs, kWideFormat).empty()) {
    return section_html(
        "singular", title,
        inputs.facts->merged
            ? merged_html("singular values")
            : absent_html("There are no singular values: no spectrum, or more channels than are decomposed."));
  }
  constexpr const char* kOrdinals[] = {"first", "second", "third", "fourth"};
  static_assert(std::size(kOrdinals) == kMaxSingular);
  std::string keys = "<div class=\"legend\" role=\"group\" aria-label=\"Singular values\">\n";
  for (std::size_t k = 0; k < inputs.lines->n_singular; ++k) keys += key_html(k, kOrdinals[k], line_class(k));
  return section_html(
      "singular", title,
      figure(inputs, singular_values_svg, keys + "</div>\n",
             fmt::format("The largest singular values of the spectral matrix of {}, over frequency. Where the first "
                         "stands far above the second, one shape moves; where two are high, two modes lie close "
                         "together. Motion of the camera is in them, too.",
                         plural(inputs.lines->channels.size(), "channel", "channels"))));
}

std::string fold_section(const PictureInputs& inputs) {
  const std::string title = "Fold map";
  if (fold_map_svg(inputs, kWideFormat).empty())
    return section_html("folds", title, absent_html("There is no fold map: the frame rate is not known."));
  const double half = inputs.estimate->rate_hz / 2.0;
  const double searched = std::max(half, inputs.max_frequency_hz);
  std::string words = fmt::format(
      "A camera at {} Hz shows a vibration above {} Hz (the Nyquist frequency) at a lower "
      "frequency, its alias. The zigzag gives both: read the possible true frequencies of a mode "
      "straight up from its apparent frequency.",
      four_digits_text(inputs.estimate->rate_hz), four_digits_text(half));
  words +=
      searched > half * 1.0001
          ? fmt::format(" True frequencies up to {} Hz (solid) were considered; rings are the candidates not chosen.",
                        four_digits_text(searched))
          : fmt::format(
                " This run searched up to {} Hz (solid): a faster mode would appear at a wrong frequency "
                "here. If one is possible, set identification.max_frequency_hz above it.",
                four_digits_text(half));
  return section_html("folds", title, figure(inputs, fold_map_svg, {}, words));
}

std::string stabilisation_section(const PictureInputs& inputs) {
  const std::string title = "Stabilisation diagram";
  if (stabilisation_svg(inputs, kWideFormat).empty()) {
    return section_html(
        "stabilisation", title,
        absent_html("There are no poles to show: no system was identified in the record, or its poles were not "
                    "kept."));
  }
  const std::string loose =
      "<li><span class=\"mark\"><svg class=\"hm\" viewBox=\"0 0 14 14\"><circle class=\"m7\" cx=\"7\" cy=\"7\" "
      "r=\"2\"/></svg></span><b>loose</b> A pole of too few orders to be listed.</li>\n";
  return section_html(
      "stabilisation", title,
      figure(inputs, stabilisation_svg, {},
             "Every pole of every model order, at its apparent frequency. A mode stands in one column "
             "over all orders; poles that come and go are numerical. Behind: the summed spectrum of all "
             "channels, not to scale.") +
          marks_legend(inputs, loose));
}

std::string displacements_section(const PictureInputs& inputs) {
  const std::string title = "Displacement over time";
  if (displacements_svg(inputs, kWideFormat).empty()) {
    return section_html("displacements", title,
                        absent_html("There is no time history: fewer than two samples were measured."));
  }
  return section_html(
      "displacements", title,
      figure(inputs, displacements_svg, {},
             fmt::format("Displacement of every channel relative to the first frame, in {}. All panels span the same "
                         "range, each about its own middle; gaps are missing samples. The slow drift comes from the "
                         "hovering camera and is removed before identification.",
                         inputs.unit)));
}

std::string scale_section(const PictureInputs& inputs) {
  const std::string title = "Scale over time";
  if (scale_svg(inputs, kWideFormat).empty()) {
    return section_html("scale", title,
                        absent_html(inputs.facts->counted
                                        ? "The scale did not vary: it was held fixed, or the camera kept its distance."
                                        : "There is no scale: the input was a time series."));
  }
  return section_html("scale", title,
                      figure(inputs, scale_svg, {},
                             "How much of the structure one pixel covers (" + scale_range_text(inputs) +
                                 "): it follows the camera's distance, and every displacement is corrected by it."));
}

std::string quality_section(const PictureInputs& inputs) {
  const std::string title = "Track quality";
  if (points_seen_svg(inputs, kWideFormat).empty()) {
    return section_html("quality", title,
                        absent_html("There are no tracks: the input was a time series, or no frame was tracked."));
  }
  return section_html("quality", title,
                      "<h3>Points seen</h3>\n" +
                          figure(inputs, points_seen_svg, {},
                                 "Share of every region's points that were found again in a frame, lowest and highest "
                                 "of every stretch of time.") +
                          "<h3>Standard deviation of a point</h3>\n" +
                          figure(inputs, point_sigma_svg, {},
                                 "What the tracker itself expects of a point's error per axis, root mean square over "
                                 "the region's points."));
}

std::string frame_section(const PictureInputs& inputs) {
  const std::string title = "What was watched";
  if (frame_svg(inputs, kWideFormat).empty()) {
    return section_html("frame-view", title,
                        absent_html("There is no picture: the input was a time series, not frames."));
  }
  const std::string legend =
      "<ul class=\"marks roles\">\n<li><i class=\"swatch structure\"></i><b>structure</b> solid</li>\n<li><i "
      "class=\"swatch "
      "base\"></i><b>base</b> dashed</li>\n<li><i class=\"swatch background\"></i><b>background</b> "
      "dotted</li>\n</ul>\n";
  return section_html(
      "frame-view", title,
      figure(inputs, frame_svg, {},
             has_frame(inputs) ? "The first frame, with the regions and the points that were followed."
                               : "The regions and points in the image; the frame itself was not at hand.") +
          legend);
}

}  // namespace app
