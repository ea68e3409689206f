#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/types/closure_result.h"
#include "tools/hovermodal/closeloop/words.h"

namespace tools {
namespace {

using core::closure::CandidateScore;
using core::closure::ClosureMode;
using core::closure::ClosureResult;
using core::closure::ClosureStep;
using core::closure::parameters_text;

std::string others_text(const std::vector<CandidateScore>& others, const std::string& unit) {
  std::string out;
  for (const CandidateScore& other : others)
    out += fmt::format("      {:<20}{:9.3g} {}  {}\n", other.effect, other.heldout, unit,
                       other.refusal.empty() ? "less than the adopted one" : other.refusal);
  return out;
}

std::string step_text(const ClosureStep& step, std::size_t i, const std::string& unit) {
  std::string out = fmt::format("step {}: {}{}\n", i + 1, step.effect,
                                step.kind == core::closure::EffectKind::kLatent ? " (latent)" : "");
  if (step.is_absorbed) {
    out += fmt::format(
        "    in the model's free motions: the held-out error stays {:.3g} {}; score {:.4g}, threshold {:.3g}\n",
        step.heldout_after, unit, step.score, step.threshold);
  } else {
    out += fmt::format("    held-out error {:.3g} -> {:.3g} {}; score {:.4g}, chance threshold {:.3g}\n",
                       step.heldout_before, step.heldout_after, unit, step.score, step.threshold);
  }
  out += fmt::format("    {}{}\n", parameters_text(step), step.meaning.empty() ? "" : "; " + step.meaning);
  if (!step.rivals.empty())
    out +=
        fmt::format("    cannot be distinguished from: {}; the cause is one of these\n", fmt::join(step.rivals, ", "));
  if (!step.others.empty()) out += "    also tried:\n" + others_text(step.others, unit);
  return out;
}

std::string cell(const std::optional<double>& value, const char* format, int width) {
  return value ? fmt::format(fmt::runtime(format), *value) : fmt::format("{:>{}}", "-", width);
}

std::string modes_text(const ClosureResult& result) {
  const bool with_mac = std::any_of(result.modes_before.begin(), result.modes_before.end(),
                                    [](const ClosureMode& m) { return m.mac.has_value(); });
  std::string out = fmt::format("mode  reference Hz    before %     after %  held out %{}\n",
                                with_mac ? "   MAC before     after" : "");
  for (std::size_t i = 0; i < result.modes_after.size() && i < result.modes_before.size(); ++i) {
    const ClosureMode &before = result.modes_before[i], &after = result.modes_after[i];
    out += fmt::format("{:4}  {}  {}  {}  {}", after.number,
                       after.reference_hz ? fmt::format("{:12.4f}", *after.reference_hz)
                                          : fmt::format("({:10.4f})", after.frequency_hz),
                       cell(before.error_percent, "{:+10.3f}", 10), cell(after.error_percent, "{:+10.3f}", 10),
                       cell(after.heldout_error_percent, "{:+10.3f}", 10));
    if (with_mac) out += fmt::format("   {}  {}", cell(before.mac, "{:10.5f}", 10), cell(after.mac, "{:8.5f}", 8));
    out += '\n';
  }
  return out;
}

}  // namespace

std::string closure_text(const ClosureResult& result) {
  const std::string& unit = result.unit;
  std::string out = fmt::format("level {}: residual {:.3g} {} rms without effects, stated noise {:.3g} {}\n",
                                result.level, result.baseline_rms, unit, result.noise_floor, unit);
  for (std::size_t i = 0; i < result.steps.size(); ++i) out += step_text(result.steps[i], i, unit);
  if (result.steps.empty()) out += "no effect adopted\n";
  if (!result.refused.empty()) out += "not adopted (held-out error, why):\n" + others_text(result.refused, unit);
  out += fmt::format("stopped: {}\n", result.stop_reason);
  out += fmt::format("residual {:.3g} -> {:.3g} {} rms; unexplained {:.0f} %: {}\n", result.baseline_rms,
                     result.residual_rms, unit, 100.0 * result.unexplained_fraction, result.unexplained);
  if (const std::string noise = noise_text(result); !noise.empty())
    out += fmt::format("noise of the data: {}\n", noise);
  if (result.reference_error_before && result.reference_error_after)
    out += fmt::format("error on data excluded from the fit {:.3g} -> {:.3g} {}\n", *result.reference_error_before,
                       *result.reference_error_after, result.reference_unit);
  out += modes_text(result);
  for (const auto& effect : result.not_observable)
    out += fmt::format("not observable here: {}: {}; {}\n", effect.effect, effect.reason, effect.instead);
  return out;
}

}  // namespace tools
