#include "core/closure/structure_level.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "core/closure/closure_loop.h"
#include "core/closure/noise_stream.h"
#include "core/closure/structure_words.h"
#include "core/structure/effects/catalogue.h"

namespace core::closure {

using structure::FrameFit;
using structure::FrameModel;
using structure::FrameModes;
using structure::LeaveOneOut;
using structure::ReferenceMode;
using structure::Starts;

namespace {

constexpr std::size_t kRivalSurrogates = 333;

}  // namespace

StructureLevel::StructureLevel(structure::DeclaredFrame declared, Reference reference, Reference check)
    : declared_(std::move(declared)), reference_(std::move(reference)), check_(std::move(check)) {
  structure::validate(declared_, reference_);
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
  loo_ = leave_one_out(model_, reference_, fit_);
  LevelFit out;
  out.residual_rms = rms_percent(reference_, model_modes());
  double squares = 0.0;
  for (const ReferenceMode& mode : reference_) squares += relative_sigma(mode) * relative_sigma(mode);
  out.noise_floor = 100.0 * std::sqrt(squares / static_cast<double>(reference_.size()));
  out.heldout = loo_.rms_percent;
  const double freedom = static_cast<double>(fit_.n_data - fit_.parameters.size());
  out.structured = freedom > 0.0 && fit_.chi2 > structure::chi2_limit(freedom);
  out.words =
      freedom <= 0.0
          ? "as many parameters as data: no degrees of freedom left to test"
          : "the residual's chi-square is " + number(fit_.chi2) + " with " + number(freedom) +
                " degrees of freedom: " + (out.structured ? "more than noise" : "no more than the stated noise");
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
  if (!std::isfinite(loo.rms_percent)) {
    return number(static_cast<double>(fit.parameters.size())) +
           " parameters cannot be fitted with a mode left out; measure more modes";
  }
  if (std::string words = implausible(model, fit); !words.empty()) return words;
  if (loo.rms_percent > kMaterial * loo_.rms_percent) {
    return loo.rms_percent < loo_.rms_percent ? "does not halve the held-out error"
                                              : "does not lower the held-out error";
  }
  return {};
}

std::vector<CandidateScore> StructureLevel::score() {
  std::vector<CandidateScore> out;
  for (const Effect effect : open()) {
    const FrameModel model = with(effect);
    const FrameFit fit = fit_frame(model, reference_, fit_.parameters, Starts::kAll);
    const LeaveOneOut loo = leave_one_out(model, reference_, fit);
    CandidateScore score;
    score.effect = effect->name();
    score.id = {score.effect};
    score.n_parameters = effect->parameters(declared_).size();
    score.heldout = loo.rms_percent;
    score.score = std::isfinite(loo.chi2) ? loo_.chi2 - loo.chi2 : -std::numeric_limits<double>::infinity();
    score.refusal = refusal(model, fit, loo);
    out.push_back(std::move(score));
  }
  return out;
}

StructureLevel::Reference StructureLevel::surrogate(const FrameModel& model, const FrameFit& fit, double spread,
                                                    std::uint64_t seed) const {
  Reference out = reference_;
  const auto modes = seen_modes(model, fit.parameters, true);
  if (!modes) return out;
  NoiseStream noise(seed);
  for (ReferenceMode& mode : out) {
    const double relative = relative_sigma(mode);
    mode.frequency_hz =
        modes->frequency_hz(mode.number - 1) * std::max(1.0 + spread * relative * noise.gaussian(), 0.1);
    mode.sigma_hz = relative * mode.frequency_hz;
    for (std::size_t i = 0; i < mode.shape.size(); ++i) {
      mode.shape[i] = modes->shapes(static_cast<Eigen::Index>(i), mode.number - 1) +
                      spread * mode.shape_sigma[i] * noise.gaussian();
    }
  }
  return out;
}

double StructureLevel::surrogate_score(std::uint64_t seed) {
  const Reference data = surrogate(model_, fit_, 1.0, seed);
  const FrameFit plain = fit_frame(model_, data, fit_.parameters, Starts::kBest);
  const double before = leave_one_out(model_, data, plain).chi2;
  double best = 0.0;
  for (const Effect effect : open()) {
    const FrameModel model = with(effect);
    const FrameFit fit = fit_frame(model, data, plain.parameters, Starts::kBest);
    const double after = leave_one_out(model, data, fit).chi2;
    if (std::isfinite(before) && std::isfinite(after)) best = std::max(best, before - after);
  }
  return best;
}

void StructureLevel::adopt(std::size_t candidate) { model_ = with(open().at(candidate)); }

void StructureLevel::drop() {
  model_.effects.pop_back();
  fit_.parameters = fit_.parameters.head(model_.n_parameters()).eval();
}

// Birge ratio: a residual larger than the stated noise raises the noise estimate to the residual.
double StructureLevel::spread() const {
  const double freedom = static_cast<double>(fit_.n_data - fit_.parameters.size());
  return freedom > 0.0 ? std::max(std::sqrt(fit_.chi2 / freedom), 1.0) : 1.0;
}

// Tests whether data simulated from the rival favour the adopted model by as much as the reference does (Cox 1961, with
// surrogates).
bool StructureLevel::is_rival(const FrameModel& rival, std::uint64_t seed) const {
  const FrameFit fit = fit_frame(rival, reference_, {}, Starts::kAll);
  const LeaveOneOut loo = leave_one_out(rival, reference_, fit);
  if (!fit.ok || !std::isfinite(loo.chi2) || !implausible(rival, fit).empty()) return false;
  const double difference = loo.chi2 - loo_.chi2;
  if (difference <= 0.0) return true;
  const double noise = spread(), freedom = static_cast<double>(fit.n_data - fit.parameters.size());
  if (freedom > 0.0 && fit.chi2 > noise * noise * structure::chi2_limit(freedom)) return false;
  std::vector<double> differences;
  for (std::size_t i = 0; i < kRivalSurrogates; ++i) {
    const Reference data = surrogate(rival, fit, noise, seed * 1000003ULL + i);
    const FrameFit own = fit_frame(rival, data, fit.parameters, Starts::kBest);
    const FrameFit other = fit_frame(model_, data, fit_.parameters, Starts::kBest);
    const double gap = leave_one_out(rival, data, own).chi2 - leave_one_out(model_, data, other).chi2;
    if (std::isfinite(gap)) differences.push_back(gap);
  }
  return !differences.empty() && difference <= chance_threshold(std::move(differences));
}

std::vector<std::string> StructureLevel::rivals(std::size_t adopted, std::uint64_t seed) {
  std::vector<std::string> out;
  for (const Effect effect : open()) {
    FrameModel rival = model_;
    rival.effects.erase(rival.effects.begin() + static_cast<std::ptrdiff_t>(adopted));
    rival.effects.push_back(effect);
    if (is_rival(rival, seed)) out.emplace_back(effect->name());
  }
  return out;
}

}  // namespace core::closure
