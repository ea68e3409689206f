#include "core/closure/observation/observation_level.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/closure/observation/block_estimates.h"
#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/kinds/materiality.h"
#include "core/closure/observation/observation_report.h"
#include "core/closure/observation/point_screening.h"
#include "core/closure/observation/region_modes.h"
#include "core/closure/observation/remainder.h"

namespace core::closure {
namespace {

RecordCheck without_fault(const ObservationRecord& record) {
  RecordCheck check = check_record(record);
  if (check.faults.empty()) return check;
  std::string text = "this record cannot be used at the observation level";
  for (const std::string& fault : check.faults) text += "; " + fault;
  throw std::invalid_argument(text);
}

ObservationRecord checked(ObservationRecord record, std::vector<std::string>& warnings) {
  RecordCheck check = without_fault(record);
  ObservationRecord usable = select_points(std::move(record), check.points);
  warnings = screen_points(usable);
  if (!warnings.empty()) {
    check = without_fault(usable);
    usable = select_points(std::move(usable), check.points);
  }
  warnings.insert(warnings.end(), check.warnings.begin(), check.warnings.end());
  return usable;
}

constexpr double kSameSigmas = 3.0, kSameShare = 0.3;  // two constants are equal within either limit

template <class Effect>
std::vector<const Effect*> all_of(const EffectList<Effect>& effects) {
  std::vector<const Effect*> out;
  for (const auto& effect : effects) out.push_back(effect.get());
  return out;
}

}  // namespace

ObservationLevel::ObservationLevel(ObservationRecord record)
    : fit_(checked(std::move(record), warnings_)),
      catalogue_(all_of(observation_effects())),
      absorbed_(all_of(absorbed_effects())),
      scores_(fit_, catalogue_) {}

void ObservationLevel::forget(const std::string& effect) {
  std::erase_if(catalogue_, [&](const ObservationEffect* e) { return e->name() == effect; });
  std::erase_if(absorbed_, [&](const AbsorbedEffect* e) { return e->name() == effect; });
}

LevelFit ObservationLevel::fit() {
  scores_.begin();  // the former candidates' fields are not kept while the model is solved
  fit_.solve();
  modes_.reset();
  found_.reset();
  return scores_.quality();
}

void ObservationLevel::drop() {
  if (fit_.effects().empty()) throw std::invalid_argument("no adopted effect to revert");
  fit_.remove(fit_.effects().size() - 1);
}

bool ObservationLevel::is_zero(std::size_t adopted) const {
  constexpr double kSigmas = 3.0;
  if (fit_.effects()[adopted]->n_constants() == 0) return false;
  const std::vector<ParameterValue> values = parameters(adopted);
  return std::all_of(values.begin(), values.end(),
                     [](const ParameterValue& p) { return p.sigma && std::abs(p.value) < kSigmas * *p.sigma; });
}

bool ObservationLevel::is_idle(std::size_t adopted) {
  if (fit_.effects()[adopted]->kind() != EffectKind::kLatent) return false;
  const double with = scores_.quality().heldout;
  ObservationFit::Effects kept = fit_.copy_effects();
  fit_.remove(adopted);
  const double without = fit().heldout;
  fit_.set_effects(std::move(kept));
  (void)fit();
  return without * without < (1.0 + kGlobalBar) * with * with;
}

std::optional<std::size_t> ObservationLevel::drop_needless() {
  for (std::size_t i = 0; i + 1 < fit_.effects().size(); ++i) {
    if (!is_zero(i) && !is_idle(i)) continue;
    fit_.remove(i);
    return i;
  }
  return std::nullopt;
}

std::vector<NotObservable> ObservationLevel::not_observable() const {
  std::vector<NotObservable> out = core::closure::not_observable(fit_, catalogue_);
  if (fit_.view().model.first_background_row() >= 0) return out;
  for (const AbsorbedEffect* effect : absorbed_) out.push_back(effect->without_background());
  return out;
}

double ObservationLevel::size_of(std::size_t adopted) const {
  return fit_.effects().at(adopted)->moves_px(fit_.view());
}

std::vector<ParameterValue> ObservationLevel::parameters(std::size_t adopted) const {
  return effect_parameters(fit_, adopted);
}

std::string ObservationLevel::meaning(std::size_t adopted) const { return effect_meaning(fit_, adopted, catalogue_); }

std::vector<std::string> ObservationLevel::rivals(std::size_t adopted, std::uint64_t /*seed*/) {
  if (fit_.effects().at(adopted)->kind() == EffectKind::kLatent) return {};
  ObservationFit::Effects kept = fit_.copy_effects();
  const EffectId own = kept[adopted]->id();
  fit_.remove(adopted);
  (void)fit();
  std::vector<std::string> out = scores_.as_good_as(own);
  fit_.set_effects(std::move(kept));
  (void)fit();
  return out;
}

// A camera that turns and shifts in one band moves structure and background in a ratio that one frame does not show: of
// the background's own motion there nothing can be said.
bool ObservationLevel::camera_vibrates_at(double hz) const {
  for (const auto& effect : fit_.effects()) {
    const Eigen::MatrixXd motion = effect->pattern() == nullptr ? effect->motion_px({}) : Eigen::MatrixXd();
    if (motion.size() == 0) continue;
    const BandHz band = band_of(motion, fit_.view().record.rate_hz, effect->leaves().beside_hz);
    if (hz >= band.low && hz <= band.high) return true;
  }
  return false;
}

std::vector<ObservationLevel::Found> ObservationLevel::find_absorbed() const {
  std::vector<Found> out;
  const auto& adopted = fit_.effects();
  if (std::any_of(adopted.begin(), adopted.end(), [](const auto& effect) { return effect->fills_free_motions(); }))
    return out;
  const FitView fit = fit_.view();
  const std::optional<FreeMotions> motions = free_motions(fit);
  if (!motions) return out;
  for (const AbsorbedEffect* effect : absorbed_) {
    std::optional<AbsorbedFinding> found = effect->find(fit, *motions);
    if (found && !(found->hz && camera_vibrates_at(*found->hz))) out.push_back({effect, std::move(*found)});
  }
  return out;
}

const std::vector<ObservationLevel::Found>& ObservationLevel::found() const {
  return found_ ? *found_ : found_.emplace(find_absorbed());
}

// Its constants are those that fit what the model takes wrongly.
bool ObservationLevel::is_pretended(std::size_t adopted, const Eigen::MatrixXd& left) const {
  const EffectInModel& effect = *fit_.effects()[adopted];
  if (effect.n_constants() == 0 || left.size() == 0) return false;
  const Eigen::VectorXd instead = BlockEstimates(effect.derivatives(fit_.view()), left).values();
  const std::vector<ParameterValue> values = parameters(adopted);
  for (Eigen::Index i = 0; i < instead.size(); ++i) {
    const ParameterValue& value = values.at(static_cast<std::size_t>(i));
    const double within = std::max(kSameSigmas * value.sigma.value_or(0.0), kSameShare * std::abs(instead(i)));
    if (!(std::abs(value.value - instead(i)) <= within)) return false;
  }
  return true;
}

std::optional<std::size_t> ObservationLevel::drop_pretended() {
  for (const Found& found : this->found()) {
    for (std::size_t i = 0; i < fit_.effects().size(); ++i) {
      if (!is_pretended(i, found.finding.left)) continue;
      fit_.remove(i);
      return i;
    }
  }
  return std::nullopt;
}

std::vector<ClosureStep> ObservationLevel::absorbed() const {
  std::vector<ClosureStep> out;
  for (const auto& [effect, finding] : found()) {
    ClosureStep& step = out.emplace_back();
    step.id = effect->id(), step.effect = effect->name();
    step.parameters = finding.parameters, step.meaning = finding.meaning;
    step.score = finding.score, step.threshold = finding.threshold;
  }
  return out;
}

std::string ObservationLevel::describe_residual() const { return core::closure::describe_residual(fit_); }

ClosureLevel::Noise ObservationLevel::noise() const { return describe_noise(fit_); }

std::vector<std::string> ObservationLevel::channel_names() const {
  std::vector<std::string> names;
  for (const core::ChannelInfo& channel : region_channels(fit_.view()).info) names.push_back(channel.name);
  return names;
}

const core::ModalEstimate& ObservationLevel::estimate() const {
  return modes_ ? *modes_ : modes_.emplace(region_modes(fit_.view()));
}

std::vector<ClosureMode> ObservationLevel::modes() const { return compared_modes(estimate().modes, reference_); }

std::optional<double> ObservationLevel::reference_error() const { return rms_error_percent(modes()); }

}  // namespace core::closure
