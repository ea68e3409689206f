// FrameModel: from its parameters to modes.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/structure/frame_fit.h"
#include "core/structure/mode_numbers.h"

namespace core::structure {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

// Modes of another kind than a shear frame, numbered as declared.
std::optional<FrameModes> modes_of_kind(const FrameModel& model, const VectorXd& parameters) {
  const DeclaredFrame& declared = *model.declared;
  auto found = declared.model->modes(values_of(model, parameters), declared.n_storeys, {});
  if (!found || found->frequency_hz.size() < static_cast<Index>(declared.n_storeys)) return std::nullopt;
  if (declared.numbering) number_as(*declared.numbering, *found);
  FrameModes out{std::move(found->frequency_hz), std::move(found->shapes)};
  if (model.has_scale()) out.frequency_hz *= std::exp(0.5 * parameters(0));
  for (Index r = 0; r < out.shapes.cols(); ++r) {
    const double largest = out.shapes.rows() > 0 ? out.shapes.col(r).cwiseAbs().maxCoeff() : 0.0;
    if (!(largest > 0.0)) continue;
    Index row = 0;
    out.shapes.col(r).cwiseAbs().maxCoeff(&row);
    out.shapes.col(r) /= double{out.shapes(row, r)};
  }
  return out;
}

}  // namespace

std::vector<std::size_t> FrameModel::with_prior() const {
  std::vector<std::size_t> out;
  if (!declared->model) return out;
  const auto& all = declared->model->parameters();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].prior_sigma > 0.0) out.push_back(i);
  }
  return out;
}

Index FrameModel::n_scale() const { return (has_scale() ? 1 : 0) + static_cast<Index>(with_prior().size()); }

Index FrameModel::first_of(std::size_t i_effect) const {
  Index at = n_scale();
  for (std::size_t i = 0; i < i_effect; ++i) at += static_cast<Index>(effects[i]->parameters(*declared).size());
  return at;
}

VectorXd FrameModel::limits_at(const VectorXd& parameters) const {
  VectorXd out = VectorXd::Constant(n_parameters(), std::numeric_limits<double>::infinity());
  if (!declared->model) return out;
  Index at = n_scale();
  for (const StructuralEffect* effect : effects) {
    for (const EffectParameter& p : effect->parameters(*declared)) {
      const double size = std::abs(parameters(at) - p.neutral);
      if (!p.is_place && size > 0.0 && std::isfinite(size)) out(at) = size;
      ++at;
    }
  }
  return out;
}

VectorXd FrameModel::neutral() const {
  VectorXd out = VectorXd::Zero(n_parameters());
  Index at = n_scale();
  for (const StructuralEffect* effect : effects) {
    for (const EffectParameter& p : effect->parameters(*declared)) out(at++) = p.neutral;
  }
  return out;
}

std::vector<double> FrameModel::of_effect(std::size_t i_effect, const VectorXd& parameters) const {
  const Index at = first_of(i_effect);
  const auto n = effects[i_effect]->parameters(*declared).size();
  return {parameters.data() + at, parameters.data() + at + n};
}

ShearFrame uniform_frame(const DeclaredFrame& declared, double stiffness_over_mass_per_s2) {
  ShearFrame frame;
  frame.mass = declared.mass.empty() ? std::vector<double>(declared.n_storeys, 1.0) : declared.mass;
  frame.stiffness_per_s2 =
      declared.stiffness_ratio.empty() ? std::vector<double>(declared.n_storeys, 1.0) : declared.stiffness_ratio;
  for (double& k : frame.stiffness_per_s2) k *= stiffness_over_mass_per_s2;
  return frame;
}

ShearFrame frame_of(const FrameModel& model, const VectorXd& parameters) {
  if (model.declared->model) return {};
  const double scale =
      model.has_scale() ? std::exp(parameters(0)) : model.declared->stiffness_over_mass_per_s2.value_or(1.0);
  ShearFrame frame = uniform_frame(*model.declared, scale);
  for (std::size_t i = 0; i < model.effects.size(); ++i)
    model.effects[i]->apply(model.of_effect(i, parameters), *model.declared, frame);
  return frame;
}

VectorXd values_of(const FrameModel& model, const VectorXd& parameters) {
  const StructuralModel& kind = *model.declared->model;
  VectorXd values = declared_values(kind);
  Index at = model.has_scale() ? 1 : 0;
  for (const std::size_t i : model.with_prior())
    values(static_cast<Index>(i)) += kind.parameters()[i].prior_sigma * parameters(at++);
  for (std::size_t i = 0; i < model.effects.size(); ++i)
    model.effects[i]->apply(model.of_effect(i, parameters), *model.declared, values);
  return values;
}

std::optional<FrameModes> seen_modes(const FrameModel& model, const VectorXd& parameters, bool with_shapes) {
  auto modes =
      model.declared->model ? modes_of_kind(model, parameters) : frame_modes(frame_of(model, parameters), with_shapes);
  if (!modes) return modes;
  for (std::size_t i = 0; i < model.effects.size(); ++i) {
    const std::vector<double> own = model.of_effect(i, parameters);
    for (double& hz : modes->frequency_hz) hz = model.effects[i]->seen_hz(hz, own, *model.declared);
  }
  return modes;
}

}  // namespace core::structure
