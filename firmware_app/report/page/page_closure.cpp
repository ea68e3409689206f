#include <fmt/format.h>

#include <string>

#include "core/types/closure_result.h"
#include "firmware_app/report/page/page_parts.h"

namespace app {
namespace {

using core::closure::ClosureReport;
using core::closure::ClosureStep;

constexpr const char* kTitle = "What the model lacks";

std::string steps_table(const core::closure::ClosureResult& result) {
  HtmlTable table({"Effect", "Numbers", "Held-out error", "Score", "Chance"});
  for (const ClosureStep& step : result.steps) {
    const std::string words = core::closure::parameters_text(step) + (step.meaning.empty() ? "" : "; " + step.meaning);
    table.add({{step.effect, {}},
               {words, {}},
               {fmt::format("{:.4f} → {:.4f} {}", step.heldout_before, step.heldout_after, result.unit), {}},
               {fmt::format("{:.4g}", step.score), {}},
               {fmt::format("{:.3g}", step.threshold), {}}});
  }
  return table.html();
}

std::string found_html(const ClosureReport& report) {
  const core::closure::ClosureResult& result = report.result;
  std::string out = paragraph_html(
      fmt::format("Frames {} to {}: the points deviate by {:.4f} {} rms from the positions predicted by the "
                  "model of camera, lens and tracker; noise alone would leave {:.4f}.",
                  report.first_sequence, report.last_sequence, result.baseline_rms, result.unit, result.noise_floor));
  if (result.steps.empty()) return out + paragraph_html("No effect is missing: " + result.stop_reason + ".");
  out += steps_table(result);
  for (const ClosureStep& step : result.steps) {
    std::string rivals;
    for (const std::string& rival : step.rivals) rivals += (rivals.empty() ? "" : ", ") + rival;
    if (!rivals.empty())
      out += paragraph_html(step.effect + " cannot be distinguished from: " + rivals + "; the cause is one of these.",
                            "note");
  }
  out +=
      paragraph_html(fmt::format("With these effects modelled, {:.4f} {} remain.", result.residual_rms, result.unit));
  for (const std::string& effect : report.in_force) out += paragraph_html("Corrected during the run: " + effect + ".");
  if (report.in_force.size() < result.steps.size())
    out += paragraph_html(
        "Effects that were not corrected are still in the results: declare them, or remove their "
        "cause, and run again.");
  return out;
}

}  // namespace

std::string closure_section(const PictureInputs& inputs) {
  if (inputs.closure == nullptr)
    return section_html(
        "closure", kTitle,
        absent_html("No diagnosis was made: closure.adopt is off, or this was not a run of the service."));
  if (!inputs.closure->refused.empty())
    return section_html("closure", kTitle,
                        absent_html("The tracks allow no diagnosis: " + inputs.closure->refused + "."));
  return section_html("closure", kTitle, found_html(*inputs.closure));
}

}  // namespace app
