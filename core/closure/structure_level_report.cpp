// StructureLevel: description of the last fit.
#include <cmath>
#include <sstream>

#include "core/closure/structure_level.h"
#include "core/closure/structure_words.h"
#include "core/structure/effects/catalogue.h"

namespace core::closure {

using structure::FrameModes;
using structure::ReferenceMode;

namespace {

double mac(const std::vector<double>& a, const Eigen::VectorXd& b) {
  const Eigen::Map<const Eigen::VectorXd> x(a.data(), static_cast<Eigen::Index>(a.size()));
  const double inner = x.dot(b);
  return inner * inner / (x.squaredNorm() * b.squaredNorm());
}

}  // namespace

std::vector<ParameterValue> StructureLevel::parameters(std::size_t adopted) const {
  Eigen::Index at = model_.n_scale();
  for (std::size_t i = 0; i < adopted; ++i)
    at += static_cast<Eigen::Index>(model_.effects[i]->parameters(declared_).size());
  const Eigen::VectorXd sigmas = spread() * parameter_sigmas(fit_);
  std::vector<ParameterValue> out;
  for (const structure::EffectParameter& p : model_.effects.at(adopted)->parameters(declared_)) {
    ParameterValue value{p.name, p.unit, fit_.parameters(at), std::nullopt};
    if (std::isfinite(sigmas(at))) value.sigma = sigmas(at);
    out.push_back(std::move(value));
    ++at;
  }
  return out;
}

FrameModes StructureLevel::model_modes() const {
  return seen_modes(model_, fit_.parameters, true).value_or(FrameModes{});
}

std::vector<ClosureMode> StructureLevel::modes() const {
  const FrameModes model = model_modes();
  std::vector<ClosureMode> out;
  for (Eigen::Index r = 0; r < model.frequency_hz.size(); ++r) {
    ClosureMode mode;
    mode.number = static_cast<int>(r) + 1;
    mode.frequency_hz = model.frequency_hz(r);
    for (std::size_t i = 0; i < reference_.size(); ++i) {
      const ReferenceMode& seen = reference_[i];
      if (seen.number != mode.number) continue;
      mode.reference_hz = seen.frequency_hz;
      mode.error_percent = 100.0 * (mode.frequency_hz / seen.frequency_hz - 1.0);
      if (!loo_.relative_error.empty()) mode.heldout_error_percent = 100.0 * loo_.relative_error[i];
      mode.sigma_percent = 100.0 * relative_sigma(seen);
      if (!seen.shape.empty()) mode.mac = mac(seen.shape, model.shapes.col(r));
    }
    out.push_back(std::move(mode));
  }
  return out;
}

std::optional<double> StructureLevel::reference_error() const {
  if (!check_.empty()) return rms_percent(check_, model_modes());
  if (std::isfinite(loo_.rms_percent)) return loo_.rms_percent;
  return std::nullopt;
}

std::string StructureLevel::describe_residual() const {
  const ClosureMode* worst = nullptr;
  const std::vector<ClosureMode> all = modes();
  double first = 0.0, last = 0.0;
  bool any = false;
  for (const ClosureMode& mode : all) {
    if (!mode.error_percent) continue;
    if (worst == nullptr || std::abs(*mode.error_percent) > std::abs(*worst->error_percent)) worst = &mode;
    if (!any) first = *mode.error_percent;
    last = *mode.error_percent;
    any = true;
  }
  if (worst == nullptr) return "no mode has a reference";
  return "errors from " + number(first) + " % (lowest mode) to " + number(last) + " % (highest), largest " +
         number(*worst->error_percent) + " % in mode " + std::to_string(worst->number) +
         ": named by no effect of the catalogue";
}

std::string StructureLevel::meaning(std::size_t adopted) const {
  return model_.effects.at(adopted)->meaning(model_.of_effect(adopted, fit_.parameters), declared_);
}

std::vector<NotObservable> StructureLevel::not_observable() const {
  std::vector<NotObservable> out;
  for (const auto& effect : structure::structural_effects()) {
    if (const auto obstacle = effect->obstacle(declared_))
      out.push_back({std::string(effect->name()), obstacle->reason, obstacle->instead});
  }
  return out;
}

}  // namespace core::closure
