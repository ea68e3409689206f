#include <fmt/format.h>

#include <string>

#include "core/types/closure_result.h"
#include "firmware_app/report/page/page_parts.h"

namespace app {
namespace {

using core::closure::ClosureReport;
using core::closure::ClosureStep;

constexpr const char* kTitle = "What the model lacks";

// One effect in sentences: a table of them would be wider than the page.
std::string step_html(const ClosureStep& step, const std::string& unit) {
  std::string words = core::closure::parameters_text(step);
  if (!step.meaning.empty()) words += "; " + step.meaning;
  for (std::size_t at = 0; (at = words.find("+-", at)) != std::string::npos;) words.replace(at, 2, "±");
  std::string out = paragraph_html(fmt::format("{}: {}.", step.effect, words), "effect");
  if (step.is_absorbed) {
    out += paragraph_html(fmt::format(
        "It leaves no residual: motions that the model leaves free in every frame hold it, and the error on points and "
        "frames kept out of the fit stays {:.4f} {}. Its score is {:.4g}; {:.3g} are asked for.",
        step.heldout_after, unit, step.score, step.threshold));
  } else {
    out += paragraph_html(fmt::format(
        "With it the error on points and frames kept out of its fit falls from {:.4f} to {:.4f} {}. Its score "
        "is {:.4g}; chance alone reaches {:.3g}.",
        step.heldout_before, step.heldout_after, unit, step.score, step.threshold));
  }
  std::string rivals;
  for (const std::string& rival : step.rivals) rivals += (rivals.empty() ? "" : ", ") + rival;
  if (!rivals.empty()) {
    out += paragraph_html(step.effect + " cannot be distinguished from: " + rivals + "; the cause is one of these.",
                          "note");
  }
  return "<li>" + out + "</li>\n";
}

std::string steps_html(const core::closure::ClosureResult& result) {
  std::string out = paragraph_html(fmt::format("{} found:", plural(result.steps.size(), "effect was", "effects were")));
  out += "<ol class=\"effects\">\n";
  for (const ClosureStep& step : result.steps) out += step_html(step, result.unit);
  return out + "</ol>\n";
}

std::string found_html(const ClosureReport& report) {
  const core::closure::ClosureResult& result = report.result;
  std::string out = paragraph_html(
      fmt::format("Frames {} to {}: the points deviate by {:.4f} {} rms from the positions predicted by the "
                  "model of camera, lens and tracker; noise alone would leave {:.4f}.",
                  report.first_sequence, report.last_sequence, result.baseline_rms, result.unit, result.noise_floor));
  if (const std::string noise = noise_text(result); !noise.empty())
    out += paragraph_html(fmt::format("Noise of the points: {}.", noise));
  if (result.steps.empty()) return out + paragraph_html("No effect is missing: " + result.stop_reason + ".");
  out += steps_html(result);
  out +=
      paragraph_html(fmt::format("With these effects modelled, {:.4f} {} remain.", result.residual_rms, result.unit));
  for (const std::string& effect : report.in_force) out += paragraph_html("Corrected during the run: " + effect + ".");
  if (report.in_force.size() < result.steps.size()) {
    out += paragraph_html(
        "Effects that were not corrected are still in the results: declare them, or remove their "
        "cause, and run again.");
  }
  return out;
}

}  // namespace

std::string closure_section(const PictureInputs& inputs) {
  if (inputs.closure == nullptr) {
    return section_html(
        "closure", kTitle,
        absent_html("No diagnosis was made: closure.adopt is off, or this was not a run of the service."));
  }
  if (!inputs.closure->refused.empty()) {
    return section_html("closure", kTitle,
                        absent_html("The tracks allow no diagnosis: " + inputs.closure->refused + "."));
  }
  return section_html("closure", kTitle, found_html(*inputs.closure));
}

}  // namespace app
