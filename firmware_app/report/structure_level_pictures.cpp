#include "firmware_app/report/structure_level_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "core/structure/mode_numbers.h"
#include "core/structure/place_profile.h"
#include "firmware_app/report/structure_pictures.h"

namespace app {
namespace {

using core::closure::StructureLevel;
using core::structure::DeclaredFrame;
using core::structure::FrameModel;
using core::structure::FrameModes;
using core::structure::ReferenceMode;
using Reference = std::vector<ReferenceMode>;

// The model's shape at the scale that fits the measured one best.
std::vector<double> scaled(const FrameModes& modes, const ReferenceMode& mode) {
  double along = 0.0, square = 0.0;
  for (std::size_t i = 0; i < mode.shape.size(); ++i) {
    const double weight = 1.0 / (mode.shape_sigma[i] * mode.shape_sigma[i]);
    const double component = modes.shapes(static_cast<Eigen::Index>(i), mode.number - 1);
    along += weight * component * mode.shape[i], square += weight * component * component;
  }
  std::vector<double> out;
  for (std::size_t i = 0; i < mode.shape.size(); ++i)
    out.push_back(modes.shapes(static_cast<Eigen::Index>(i), mode.number - 1) * (square > 0.0 ? along / square : 0.0));
  return out;
}

double mac_of(const FrameModes& modes, const ReferenceMode& mode) {
  return core::structure::mac(
      Eigen::Map<const Eigen::VectorXd>(mode.shape.data(), static_cast<Eigen::Index>(mode.shape.size())),
      modes.shapes.col(mode.number - 1).head(static_cast<Eigen::Index>(mode.shape.size())));
}

std::vector<ShapeComparison> comparisons(const StructureLevel& level, const DeclaredFrame& declared) {
  const Reference& reference = level.reference();
  std::vector<ShapeComparison> out;
  const FrameModel plain{&declared, {}};
  const auto fit = fit_frame(plain, reference, {}, core::structure::Starts::kAll);
  const auto before = fit.ok ? seen_modes(plain, fit.parameters, true) : std::nullopt;
  const FrameModes after = level.model_modes();
  if (!before || after.frequency_hz.size() == 0) return out;
  for (const ReferenceMode& mode : reference) {
    if (mode.shape.empty()) continue;
    ShapeComparison one;
    one.number = mode.number, one.measured_hz = mode.frequency_hz;
    one.before_hz = before->frequency_hz(mode.number - 1), one.after_hz = after.frequency_hz(mode.number - 1);
    one.measured = mode.shape, one.sigma = mode.shape_sigma;
    one.before = scaled(*before, mode), one.after = scaled(after, mode);
    one.mac_before = mac_of(*before, mode), one.mac_after = mac_of(after, mode);
    out.push_back(std::move(one));
  }
  return out;
}

std::vector<std::string> channel_names(const DeclaredFrame& declared) {
  std::vector<std::string> out = declared.floors;
  if (out.empty() && declared.model) {
    for (const auto& sight : declared.model->sights()) out.push_back(sight.channel);
  }
  return out;
}

std::vector<SoughtPlace> places(const StructureLevel& level, std::size_t i_effect) {
  std::vector<SoughtPlace> out;
  const auto profile = place_profile(level.model(), level.reference(), level.fitted(), i_effect, level.spread());
  if (profile.empty()) return out;
  const auto best =
      std::min_element(profile.begin(), profile.end(), [](const auto& a, const auto& b) { return a.chi2 < b.chi2; });
  for (const auto& place : profile)
    out.push_back({place.meaning.empty() ? fmt::format("place {}", place.place) : place.meaning,
                   place.chi2 - best->chi2, place.place == best->place, place.is_indistinguishable});
  return out;
}

// The model's drawing with the parameters that the adopted effects change.
std::vector<DrawnPart> drawn_parts(const StructureLevel& level, const core::closure::ClosureResult& result) {
  std::vector<DrawnPart> out;
  const FrameModel& model = level.model();
  if (!model.declared->model) return out;
  std::map<std::size_t, std::string> found;
  std::set<std::size_t> alike;
  for (std::size_t i = 0; i < model.effects.size() && i < result.steps.size(); ++i) {
    std::vector<double> own = model.of_effect(i, level.fitted().parameters);
    const auto parameter = model.effects[i]->model_parameter(own, *model.declared);
    if (!parameter) continue;
    found[*parameter] = result.steps[i].effect + ": " + result.steps[i].meaning;
    for (const auto& place : place_profile(model, level.reference(), level.fitted(), i, level.spread())) {
      own.front() = static_cast<double>(place.place);
      const auto other = model.effects[i]->model_parameter(own, *model.declared);
      if (place.is_indistinguishable && other) alike.insert(*other);
    }
  }
  const auto drawing = model.declared->model->drawing();
  bool is_marked = false;
  for (const core::structure::DrawnItem& item : drawing) {
    DrawnPart part{item.from_m.x(), item.from_m.y(), item.to_m.x(), item.to_m.y(), false, {}, false};
    const core::structure::Role role =
        item.parameter ? model.declared->model->parameters()[*item.parameter].role : core::structure::Role::kOther;
    part.is_member = !item.is_node() && (!item.parameter || role == core::structure::Role::kPartStiffness);
    if (item.parameter && found.contains(*item.parameter)) part.found = found[*item.parameter], is_marked = true;
    part.is_indistinguishable = item.parameter && alike.contains(*item.parameter);
    out.push_back(std::move(part));
  }
  // What acts on the whole is no place on it.
  return is_marked ? out : std::vector<DrawnPart>{};
}

std::vector<SeenPlace> seen_places(const DeclaredFrame& declared) {
  std::vector<SeenPlace> out;
  for (const auto& sight : declared.model->sights()) out.push_back({sight.at_m.x(), sight.at_m.z()});
  return out;
}

std::vector<FittedParameter> parameters(const StructureLevel& level, const core::closure::ClosureResult& result) {
  std::vector<FittedParameter> out;
  const FrameModel& model = level.model();
  if (model.declared->model) {
    const auto posterior = identifiability(model, level.fitted());
    const Eigen::VectorXd values = values_of(model, level.fitted().parameters);
    const std::vector<std::size_t> with_prior = model.with_prior();
    for (std::size_t k = 0; k < with_prior.size(); ++k) {
      const auto& p = model.declared->model->parameters()[with_prior[k]];
      FittedParameter one{p.name, p.unit, values(static_cast<Eigen::Index>(with_prior[k])), {}, p.value, p.prior_sigma};
      const double sigma = posterior[k].sigma_over_prior * p.prior_sigma;
      if (std::isfinite(sigma)) one.sigma = sigma;
      out.push_back(std::move(one));
    }
  }
  for (const auto& step : result.steps) {
    for (const auto& p : step.parameters) {
      if (p.name != "place") out.push_back({step.effect + ": " + p.name, p.unit, p.value, p.sigma, {}, {}});
    }
  }
  return out;
}

}  // namespace

std::vector<StructurePicture> structure_level_pictures(const StructureLevel& level,
                                                       const core::closure::ClosureResult& result,
                                                       const DeclaredFrame& declared) {
  std::vector<StructurePicture> out;
  const auto add = [&](std::string name, std::string title, std::string svg) {
    if (!svg.empty()) out.push_back({std::move(name), std::move(title), std::move(svg)});
  };
  add("structure_shapes", "Measured and computed shapes",
      structure_shapes_svg(comparisons(level, declared), channel_names(declared)));
  add("structure_posterior", "Fitted parameters and their standard deviations",
      structure_posterior_svg(parameters(level, result)));
  if (declared.model)
    add("structure_drawing", "The structure, and where what was found acts",
        structure_drawing_svg(drawn_parts(level, result), seen_places(declared)));
  for (std::size_t i = 0; i < result.steps.size(); ++i) {
    const std::string effect = result.steps[i].effect + " " + result.steps[i].meaning;
    add(fmt::format("structure_place_{}", i + 1), "Places of " + effect,
        structure_places_svg(effect, places(level, i)));
  }
  return out;
}

}  // namespace app
