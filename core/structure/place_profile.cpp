#include "core/structure/place_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace core::structure {
namespace {

constexpr double kOneDegree95 = 3.841;  // chi-square, one degree of freedom, 95 %

}  // namespace

std::vector<PlaceFit> place_profile(const FrameModel& model, const std::vector<ReferenceMode>& reference,
                                    const FrameFit& fit, std::size_t effect, double spread) {
  std::vector<PlaceFit> out;
  const std::vector<EffectParameter> own = model.effects.at(effect)->parameters(*model.declared);
  if (own.empty() || !own.front().is_place || !fit.ok) return out;
  const Eigen::Index at = model.first_of(effect);
  double best = std::numeric_limits<double>::infinity();
  for (const double place : own.front().starts) {
    PlaceFit one;
    one.place = static_cast<std::size_t>(place);
    one.chi2 = std::numeric_limits<double>::infinity();
    for (const double size : own.back().starts) {
      Eigen::VectorXd start = fit.parameters;
      start(at) = place;
      if (place != fit.parameters(at)) start(at + 1) = size;
      const FrameFit there = fit_frame(model, reference, start, Starts::kBest);
      if (!there.ok || there.chi2 >= one.chi2) continue;
      one.chi2 = there.chi2;
      one.meaning = model.effects[effect]->meaning(model.of_effect(effect, there.parameters), *model.declared);
    }
    best = std::min(best, one.chi2);
    out.push_back(std::move(one));
  }
  for (PlaceFit& one : out) one.is_indistinguishable = one.chi2 <= best + spread * spread * kOneDegree95;
  return out;
}

std::vector<Identifiability> identifiability(const FrameModel& model, const FrameFit& fit) {
  std::vector<Identifiability> out;
  const Eigen::VectorXd sigmas = parameter_sigmas(fit);
  Eigen::Index at = model.has_scale() ? 1 : 0;
  for (const std::size_t i : model.with_prior()) {
    const double sigma = at < sigmas.size() ? sigmas(at++) : std::numeric_limits<double>::quiet_NaN();
    out.push_back({model.declared->model->parameters()[i].name, sigma});
  }
  return out;
}

}  // namespace core::structure
