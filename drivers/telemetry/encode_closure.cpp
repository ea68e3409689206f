#include "core/types/closure_result.h"
#include "drivers/telemetry/encode.h"

namespace drivers {
namespace {

constexpr std::size_t kMaxEffectBytes = 40, kMaxNumbersBytes = 80, kMaxMeaningBytes = 100;

hovermodal::closure_step_t to_message(const core::closure::ClosureStep& step) {
  hovermodal::closure_step_t out{};
  out.effect = clipped(step.effect, kMaxEffectBytes);
  out.is_latent = step.kind == core::closure::EffectKind::kLatent ? 1 : 0;
  out.heldout_before = step.heldout_before;
  out.heldout_after = step.heldout_after;
  out.score = step.score;
  out.threshold = step.threshold;
  out.numbers = clipped(core::closure::parameters_text(step), kMaxNumbersBytes);
  out.meaning = clipped(step.meaning, kMaxMeaningBytes);
  return out;
}

}  // namespace

hovermodal::closure_report_t to_message(const core::closure::ClosureReport& report, const StreamIdentity& identity) {
  auto out = begin_message<hovermodal::closure_report_t>(identity, report.t_stream_ns);
  const core::closure::ClosureResult& result = report.result;
  out.number = static_cast<std::int64_t>(report.number);
  out.first_frame = static_cast<std::int64_t>(report.first_sequence);
  out.last_frame = static_cast<std::int64_t>(report.last_sequence);
  out.duration_s = report.duration_s;
  out.is_final = report.final ? 1 : 0;
  out.took_s = report.took_s;
  out.refused = clipped(report.refused, kMaxReasonBytes);
  out.level = clipped(result.level, kMaxEffectBytes);
  out.unit = clipped(result.unit, kMaxEffectBytes);
  out.residual_before = result.baseline_rms;
  out.residual_after = result.residual_rms;
  out.noise_floor = result.noise_floor;
  out.unexplained = result.unexplained_fraction;
  out.left = clipped(result.unexplained, kMaxReasonBytes);
  out.stop_reason = clipped(result.stop_reason, kMaxReasonBytes);
  constexpr auto kWordsBytes = static_cast<int>(kMaxModalPartBytes) / 2;  // the rest is for the steps
  for (const std::string& words : report.changes) {
    if (out.getEncodedSize() > kWordsBytes) break;
    out.changes.push_back(clipped(words, kMaxReasonBytes));
    out.n_changes = to_int16(out.changes.size());
  }
  for (const std::string& words : report.in_force) {
    if (out.getEncodedSize() > kWordsBytes) break;
    out.in_force.push_back(clipped(words, kMaxMeaningBytes));
    out.n_in_force = to_int16(out.in_force.size());
  }
  out.n_adopted = to_int16(result.steps.size());
  for (const core::closure::ClosureStep& step : result.steps) {
    out.steps.push_back(to_message(step));
    out.n_steps = to_int16(out.steps.size());
    if (out.getEncodedSize() <= kMaxModalPartBytes) continue;
    out.steps.pop_back();
    out.n_steps = to_int16(out.steps.size());
    break;
  }
  return out;
}

}  // namespace drivers
