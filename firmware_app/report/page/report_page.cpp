#include "firmware_app/report/page/report_page.h"

#include <fmt/format.h>

#include "drivers/storage/text_file.h"
#include "firmware_app/report/page/page_parts.h"
#include "firmware_app/report/plot/spectral_matrix.h"

namespace app {
namespace {

// Forbids the page to fetch anything, whatever a name in the data contains.
constexpr const char* kPolicy =
    "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'";

std::string facts_title(const PictureInputs& inputs) {
  return inputs.facts->title.empty() ? "Modes of vibration" : svg_escaped(inputs.facts->title);
}

std::string head_html(const PictureInputs& inputs) {
  const std::string source = drivers::printable(inputs.facts->source);
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\"/>\n"
      "<meta name=\"color-scheme\" content=\"light dark\"/>\n<title>{}{}{}</title>\n"
      "<style>\n{}{}</style>\n</head>\n",
      kPolicy, facts_title(inputs), source.empty() ? "" : ": ", svg_escaped(source), svg_style(), page_css());
}

// The frame as one element, to which every picture of the page refers.
std::string frame_definition(const PictureInputs& inputs) {
  if (!has_frame(inputs)) return {};
  return fmt::format(
      "<svg class=\"defs\" width=\"0\" height=\"0\" aria-hidden=\"true\"><defs><image id=\"{}\" width=\"{}\" "
      "height=\"{}\" "
      "preserveAspectRatio=\"none\" href=\"data:image/jpeg;base64,{}\"/></defs></svg>\n",
      kFrameId, inputs.first_frame->width_px, inputs.first_frame->height_px, base64(frame_jpeg(*inputs.first_frame)));
}

std::string contents_html() {
  constexpr std::pair<const char*, const char*> kSections[] = {{"modes", "Modes"},
                                                               {"shapes", "Shapes"},
                                                               {"mac", "MAC"},
                                                               {"comparison", "Comparison"},
                                                               {"spectra", "Spectra"},
                                                               {"singular", "Singular values"},
                                                               {"operating", "Deflection"},
                                                               {"folds", "Fold map"},
                                                               {"stabilisation", "Orders"},
                                                               {"convergence", "Convergence"},
                                                               {"displacements", "Motion"},
                                                               {"scale", "Scale"},
                                                               {"quality", "Tracking"},
                                                               {"frame-view", "Frame"},
                                                               {"closure", "Residual"},
                                                               {"losses", "Losses"},
                                                               {"timing", "Timing"}};
  std::string out = "<nav aria-label=\"Sections\">\n";
  for (const auto& [id, name] : kSections) out += fmt::format("<a href=\"#{}\">{}</a>\n", id, name);
  return out + "</nav>\n";
}

}  // namespace

std::string report_html(const PictureInputs& given) {
  const SpectralLines lines = spectral_lines(given.spectrum, given.estimate);
  PictureInputs inputs = given;
  inputs.lines = &lines;
  std::string out = head_html(inputs);
  out += "<body>\n" + frame_definition(inputs);
  out += headline_html(inputs);
  out += contents_html();
  out += "<main>\n";
  out += modes_section(inputs);
  out += shapes_section(inputs);
  out += mac_section(inputs);
  out += comparison_section(inputs);
  out += spectra_section(inputs);
  out += singular_section(inputs);
  out += operating_section(inputs);
  out += fold_section(inputs);
  out += stabilisation_section(inputs);
  out += convergence_section(inputs);
  out += displacements_section(inputs);
  out += scale_section(inputs);
  out += quality_section(inputs);
  out += frame_section(inputs);
  out += closure_section(inputs);
  out += losses_section(inputs);
  out += fmt::format("{}\n{}{}\n", kVariesBegin, timing_section(inputs), kVariesEnd);
  out += "</main>\n<footer><p>Written by hovermodal " HOVERMODAL_VERSION
         ". The numbers of this page are in <code>modal.json</code>, the series in <code>displacements.csv</code>.</p>"
         "</footer>\n";
  out += fmt::format("<script>\n{}</script>\n</body>\n</html>\n", page_js());
  return out;
}

}  // namespace app
