#include "tools/validate/closure_tracks_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/closure/closure_loop.h"
#include "core/closure/observation/observation_level.h"

namespace tools {
namespace {

std::vector<core::Mode> true_modes(const core::simulation::Scene& scene) {
  std::vector<core::Mode> out;
  for (const auto& mode : core::simulation::modes_of(scene.structure)) {
    if (mode.frequency_hz < 0.5 * scene.camera.rate_hz) out.emplace_back().frequency_hz = mode.frequency_hz;
  }
  return out;
}

}  // namespace

double TracksOutcome::heldout_after() const {
  return result.steps.empty() ? result.baseline_rms : result.steps.back().heldout_after;
}

std::string TracksOutcome::names() const {
  std::vector<std::string> all;
  for (const auto& step : result.steps) all.push_back(step.effect);
  std::sort(all.begin(), all.end());
  std::string text;
  for (const std::string& name : all) text += (text.empty() ? "" : " + ") + name;
  return text.empty() ? "nothing" : text;
}

std::string TracksOutcome::parameters() const {
  std::string text;
  for (const auto& step : result.steps) {
    for (const auto& p : step.parameters)
      text += fmt::format("{}{} {:.6g} ({:.2g}) {}", text.empty() ? "" : "; ", p.name, p.value, p.sigma.value_or(0.0),
                          p.unit);
  }
  return text;
}

std::string TracksOutcome::refused() const {
  std::string text;
  for (const auto& s : result.refused)
    text += fmt::format("[{} {:.4f}{}{}]", s.effect, s.score / values, s.refusal.empty() ? "" : " ", s.refusal);
  return text;
}

LargestRefused largest_refused(const TracksOutcome& outcome) {
  LargestRefused out;
  for (const auto& s : outcome.result.refused) {
    const double share = s.score / outcome.values;
    if (s.kind == core::closure::EffectKind::kLatent)
      out.latent = share;
    else if (share > out.named)
      out.named = share, out.name = s.effect;
  }
  return out;
}

TracksOutcome close_tracks_record(const core::closure::ObservationRecord& record, const core::simulation::Scene& scene,
                                  std::uint64_t seed, const std::string& without) {
  const auto start = std::chrono::steady_clock::now();
  core::closure::ObservationLevel level(record);
  if (!without.empty()) level.forget(without);
  level.set_reference(true_modes(scene));
  core::closure::ClosureOptions options;
  options.n_surrogates = core::closure::ObservationLevel::kSurrogates;
  options.seed = seed;
  TracksOutcome out;
  out.result = close_loop(level, options);
  out.values = 2.0 * static_cast<double>(record.n_points() * record.n_frames());
  for (const core::closure::ClosureStep& step : out.result.steps) {
    if (!step.meaning.empty()) out.words += "{" + step.meaning + "}";
  }
  out.words += "{" + out.result.stop_reason + "}";
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

double plain_modal_error(const core::closure::ObservationRecord& record, const core::simulation::Scene& scene) {
  core::closure::ObservationLevel level(record);
  level.set_reference(true_modes(scene));
  (void)level.fit();
  return level.reference_error().value_or(std::nan(""));
}

std::uint64_t seed_of(const ClosureTracksOptions& options, std::uint64_t index) noexcept {
  return index + static_cast<std::uint64_t>(options.first_seed) - 1;
}

RecordSetup setup_for(const ClosureTracksOptions& options) {
  RecordSetup setup;
  if (options.duration_s > 0.0) setup.duration_s = options.duration_s;
  return setup;
}

}  // namespace tools
