#include "core/closure/structure_level.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "core/closure/closure_loop.h"
#include "core/closure/structure_words.h"
#include "core/structure/effects/catalogue.h"
#include "core/structure/mode_numbers.h"

namespace core::closure {

using structure::FrameFit;
using structure::FrameModel;
using structure::FrameModes;
using structure::LeaveOneOut;
using structure::ReferenceMode;
using structure::Starts;

StructureLevel::StructureLevel(structure::DeclaredFrame declared, Reference reference, Reference check,
                               Reference unpaired)
    : declared_(std::move(declared)), measured_(reference), check_(std::move(check)), reference_(std::move(reference)) {
  structure::validate(declared_, reference_);
  for (const ReferenceMode& mode : reference_) number_.push_back(mode.number);
  for (ReferenceMode& mode : unpaired) measured_.push_back(std::move(mode));
  number_.resize(measured_.size(), 0);
  if (check_.size() == 1) {
    if (check_.front().number < 1 || static_cast<std::size_t>(check_.front().number) > declared_.n_storeys)
      throw std::invalid_argument("a mode of --check is not a mode of the frame");
  } else if (!check_.empty()) {
    structure::validate(declared_, check_);
  }
  model_.declared = &declared_;
}

std::vector<StructureLevel::Effect> StructureLevel::open() const {
  std::vector<Effect> out;
  for (const auto& effect : structure::structural_effects()) {
    const bool adopted = std::find(model_.effects.begin(), model_.effects.end(), effect.get()) != model_.effects.end();
    if (!adopted && !effect->obstacle(declared_)) out.push_back(effect.get());
  }
  return out;
}

std::vector<std::string> StructureLevel::candidates() const {
  std::vector<std::string> out;
  for (const Effect effect : open()) out.emplace_back(effect->name());
  return out;
}

FrameModel StructureLevel::with(Effect effect) const {
  FrameModel model = model_;
  model.effects.push_back(effect);
  return model;
}

LevelFit StructureLevel::fit() {
  fit_ = fit_frame(model_, reference_, fit_.parameters, Starts::kAll);
  if (!fit_.ok)
    throw std::runtime_error("structure: no stiffness gives such frequencies; check storeys and units (Hz)");
  settle_numbers();
  loo_ = leave_one_out(model_, reference_, fit_);
  LevelFit out;
  out.residual_rms = rms_percent(reference_, model_modes());
  double squares = 0.0;
  for (const ReferenceMode& mode : reference_) squares += relative_sigma(mode) * relative_sigma(mode);
  out.noise_floor = 100.0 * std::sqrt(squares / static_cast<double>(reference_.size()));
  out.heldout = loo_.with_shapes_percent;
  if (declared_.model) first_order_ = structure::FirstOrderEffects::about(model_, open(), reference_, fit_);
  const double freedom = fit_.degrees_of_freedom();
  const bool exceeds = freedom > 0.0 && fit_.chi2 > structure::chi2_limit(freedom);
  const bool has_direction = freedom > 0.0 && !exceeds && is_like_an_effect();
  out.structured = exceeds || has_direction;
  out.words = freedom <= 0.0 ? "as many parameters as data: no degrees of freedom left to test"
                             : "the residual's chi-square is " + number(fit_.chi2) + " with " + number(freedom) +
                                   " degrees of freedom: " +
                                   (exceeds         ? "more than noise"
                                    : has_direction ? "no more than noise as a whole, but more along one effect"
                                                    : "no more than the stated noise");
  return out;
}

std::string StructureLevel::implausible(const FrameModel& model, const FrameFit& fit) const {
  const structure::ShearFrame frame = frame_of(model, fit.parameters);
  for (std::size_t i = 0; i < model.effects.size(); ++i) {
    const std::string words = model.effects[i]->implausible(model.of_effect(i, fit.parameters), declared_, frame);
    if (words.empty()) continue;
    return i + 1 == model.effects.size() ? "implausible: " + words
                                         : "makes " + std::string(model.effects[i]->name()) + " implausible: " + words;
  }
  return {};
}

std::string StructureLevel::refusal(const FrameModel& model, const FrameFit& fit, const LeaveOneOut& loo) const {
  if (!fit.ok) return "no parameters of it give a frame";
  if (!std::isfinite(loo.with_shapes_percent)) {
    return number(static_cast<double>(fit.parameters.size())) +
           " parameters cannot be fitted with a mode left out; measure more modes";
  }
  if (std::string words = implausible(model, fit); !words.empty()) return words;
  const double freedom = fit.degrees_of_freedom();
  const bool is_noise = freedom > 0.0 && fit.chi2 <= structure::chi2_limit(freedom);
  if (loo.with_shapes_percent > (is_noise ? 1.0 : kMaterial) * loo_.with_shapes_percent) {
    return loo.with_shapes_percent < loo_.with_shapes_percent ? "does not halve the held-out error"
                                                              : "does not lower the held-out error";
  }
  return {};
}

std::vector<CandidateScore> StructureLevel::score() {
  std::vector<CandidateScore> out;
  const std::vector<Effect> effects = open();
  for (std::size_t i = 0; i < effects.size(); ++i) {
    const Effect effect = effects[i];
    const FrameModel model = with(effect);
    const Reference reference = structure::numbered(measured_, candidate_number_[i]);
    const FrameFit fit = fit_frame(model, reference, fit_.parameters, Starts::kAll);
    const LeaveOneOut loo = leave_one_out(model, reference, fit);
    CandidateScore score;
    score.effect = effect->name();
    score.id = {score.effect};
    score.n_parameters = effect->parameters(declared_).size();
    score.heldout = loo.with_shapes_percent;
    score.score = std::isfinite(loo.chi2) ? loo_.chi2 - loo.chi2 : -std::numeric_limits<double>::infinity();
    score.refusal = refusal(model, fit, loo);
    out.push_back(std::move(score));
  }
  return out;
}

void StructureLevel::adopt(std::size_t candidate) {
  number_ = candidate_number_.at(candidate);
  reference_ = structure::numbered(measured_, number_);
  model_ = with(open().at(candidate));
}

void StructureLevel::drop() {
  model_.effects.pop_back();
  fit_.parameters = fit_.parameters.head(model_.n_parameters()).eval();
}

std::optional<std::size_t> StructureLevel::drop_needless() {
  for (std::size_t i = 0; i + 1 < model_.effects.size(); ++i) {
    FrameModel others = model_;
    others.effects.erase(others.effects.begin() + static_cast<std::ptrdiff_t>(i));
    FrameFit fit = fit_frame(others, reference_, {}, Starts::kAll);
    if (!fit.ok || !implausible(others, fit).empty()) continue;
    const auto n_parameters =
        static_cast<double>(std::max<Eigen::Index>(1, fit_.parameters.size() - fit.parameters.size()));
    if (fit.chi2 - fit_.chi2 > spread() * spread() * structure::chi2_limit(n_parameters)) continue;
    model_ = std::move(others);
    fit_ = std::move(fit);
    return i;
  }
  return std::nullopt;
}

// Birge ratio: a residual larger than the stated noise raises the noise estimate to the residual.
double StructureLevel::spread() const {
  const double freedom = fit_.degrees_of_freedom();
  return freedom > 0.0 ? std::max(std::sqrt(fit_.chi2 / freedom), 1.0) : 1.0;
}

}  // namespace core::closure
