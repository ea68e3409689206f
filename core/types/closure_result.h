#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace core::closure {

// Plain results of residual diagnosis; closure.json holds them. Errors and residuals are in the level's unit.

enum class EffectKind : std::uint8_t { kNamed, kLatent };

// Key of an effect in the catalogue of its level, for programs. Reports show its name.
struct EffectId {
  std::string key;
  friend bool operator==(const EffectId&, const EffectId&) = default;
};

struct ParameterValue {
  std::string name, unit;
  double value = 0.0;
  std::optional<double> sigma;  // empty: unknown, or the parameter was given and not fitted
};

// Result of one candidate on top of the effects adopted so far.
struct CandidateScore {
  std::string effect;
  EffectKind kind = EffectKind::kNamed;
  std::size_t n_parameters = 0;
  double heldout = 0.0;  // error on data excluded from its fit
  double score = 0.0;    // decrease of the held-out squares in units of the noise variance; more is better
  std::string refusal;   // reason why it may not be adopted whatever its score: immaterial, implausible; empty = it may
  EffectId id{};
};

struct ClosureStep {
  std::string effect;
  EffectKind kind = EffectKind::kNamed;
  std::vector<ParameterValue> parameters;  // of the last joint fit
  std::string meaning;                     // implications of the parameters; of a latent effect, its description
  // True: quantities that are free in the model absorb the effect, so that the held-out error stays as it is.
  bool is_absorbed = false;
  double heldout_before = 0.0, heldout_after = 0.0;
  double score = 0.0, threshold = 0.0;
  std::vector<std::string> rivals;     // effects that explain the data as well: the cause is not determined
  std::vector<CandidateScore> others;  // the other candidates of that step, best first
  EffectId id{};
};

struct NotObservable {
  std::string effect;
  std::string reason;   // free quantity that absorbs it
  std::string instead;  // measurement or footage that would make it observable
};

// A mode of the model, or an identified one, with its reference. Empty = unknown. Errors in percent of the reference.
struct ClosureMode {
  int number = 0;  // from 1
  double frequency_hz = 0.0;
  std::optional<double> damping_ratio, reference_hz, error_percent, heldout_error_percent, sigma_percent, mac;
};

struct ClosureResult {
  std::string level, unit;
  double baseline_rms = 0.0;  // residual of the model without effects
  double noise_floor = 0.0;   // expected from noise alone
  double residual_rms = 0.0;  // with all adopted effects
  std::vector<ClosureStep> steps;
  double unexplained_fraction = 0.0;  // of the baseline's mean square above the noise
  std::string unexplained;
  std::vector<ParameterValue> noise;  // of the data, as measured on the last fit; empty: the level does not measure it
  std::string noise_advice;           // how to lower it; may be empty
  std::vector<NotObservable> not_observable;
  std::vector<ClosureMode> modes_before, modes_after;
  std::optional<double> reference_error_before, reference_error_after;  // rms, on held-out data
  std::string reference_unit;                                           // of these
  std::string stop_reason;
  std::vector<CandidateScore> refused;  // the last round's candidates, best first
  std::size_t n_surrogates = 0;         // in all
};

// "readout = 28.9 +- 0.54 ms, ..."; "nothing fitted" without parameters.
[[nodiscard]] std::string parameters_text(const ClosureStep& step);
// "rms per axis 0.0123 px, correlation time 0.12 s; <advice>", without what is 0; empty: not measured.
[[nodiscard]] std::string noise_text(const ClosureResult& result);

}  // namespace core::closure
