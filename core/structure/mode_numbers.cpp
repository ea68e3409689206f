#include "core/structure/mode_numbers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/identification/assignment.h"

namespace core::structure {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kNear = 0.1;  // relative distance of frequencies that may exchange their places
constexpr double kFrequencyWidth = 0.1, kShapeWidth = 0.2;  // differences of ln f and of MAC from 1 that cost 1
constexpr double kUnpaired = 4.0;                           // cost of a reference mode without a partner
constexpr double kMissing = 0.1;  // over kUnpaired: of a mode of the model that was not measured, below one that was
constexpr double kFactorCost = 0.01;  // of equal pairings, the one with the factor next to 1

VectorXd shape_of(const ReferenceMode& mode) {
  return Eigen::Map<const VectorXd>(mode.shape.data(), static_cast<Index>(mode.shape.size()));
}

double cost(const ReferenceMode& mode, const ModelModes& model, Index r, double log_factor) {
  const double off = (std::log(mode.frequency_hz / model.frequency_hz(r)) - log_factor) / kFrequencyWidth;
  if (mode.shape.size() < 2) return off * off;
  const double shape = (1.0 - mac(shape_of(mode), model.shapes.col(r))) / kShapeWidth;
  return std::min(off * off, 2.0 * kUnpaired) * 0.5 + shape * shape;
}

struct Pairing {
  double cost = std::numeric_limits<double>::infinity();
  std::vector<std::size_t> partner;  // Assignment::kNone: none
};

Pairing pair_at(const ModelModes& model, const std::vector<ReferenceMode>& reference, double log_factor) {
  const auto n_modes = static_cast<std::size_t>(model.frequency_hz.size());
  std::vector<double> costs;
  for (const ReferenceMode& mode : reference) {
    for (Index r = 0; r < model.frequency_hz.size(); ++r) costs.push_back(cost(mode, model, r, log_factor) / kUnpaired);
  }
  Assignment assignment(reference.size(), n_modes);
  const auto columns = assignment.solve(costs, reference.size(), n_modes);
  Pairing out{0.0, {columns.begin(), columns.end()}};
  for (std::size_t i = 0; i < reference.size(); ++i)
    out.cost += columns[i] == Assignment::kNone ? 1.0 : costs[i * n_modes + columns[i]];
  std::size_t highest = 0, paired = 0;  // of the model's modes
  for (const std::size_t column : columns) {
    if (column == Assignment::kNone) continue;
    highest = std::max(highest, column + 1);
    ++paired;
  }
  out.cost += kMissing * static_cast<double>(highest - paired);
  return out;
}

}  // namespace

double mac(const VectorXd& a, const VectorXd& b) {
  const double square = a.squaredNorm() * b.squaredNorm(), inner = a.dot(b);
  return square > 0.0 ? inner * inner / square : 0.0;
}

void number_as(const ModelModes& known, ModelModes& modes) {
  if (modes.shapes.rows() < 2) return;
  for (Index r = 0; r + 1 < std::min(modes.shapes.cols(), known.shapes.cols()); ++r) {
    if (modes.frequency_hz(r + 1) > (1.0 + kNear) * modes.frequency_hz(r)) continue;
    const double as_is =
        mac(modes.shapes.col(r), known.shapes.col(r)) + mac(modes.shapes.col(r + 1), known.shapes.col(r + 1));
    const double swapped =
        mac(modes.shapes.col(r), known.shapes.col(r + 1)) + mac(modes.shapes.col(r + 1), known.shapes.col(r));
    if (swapped <= as_is) continue;
    std::swap(modes.frequency_hz(r), modes.frequency_hz(r + 1));
    modes.shapes.col(r).swap(modes.shapes.col(r + 1));
    if (modes.d_frequency_hz.size() > 0) modes.d_frequency_hz.row(r).swap(modes.d_frequency_hz.row(r + 1));
    for (Eigen::MatrixXd& d : modes.d_shapes) d.col(r).swap(d.col(r + 1));
  }
}

std::vector<double> pair_with_model(const DeclaredFrame& declared, std::vector<ReferenceMode>& reference) {
  const ModelModes& model = *declared.numbering;
  std::vector<double> factors{0.0};
  if (!declared.stiffness_over_mass_per_s2) {
    for (const ReferenceMode& mode : reference) {
      for (const double hz : model.frequency_hz) factors.push_back(std::log(mode.frequency_hz / hz));
    }
  }
  Pairing best;
  for (const double factor : factors) {
    Pairing one = pair_at(model, reference, factor);
    if (one.cost + kFactorCost * factor * factor < best.cost) {
      best = std::move(one);
      best.cost += kFactorCost * factor * factor;
    }
  }
  std::vector<double> left;
  std::vector<ReferenceMode> kept;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    if (best.partner[i] == Assignment::kNone) {
      left.push_back(reference[i].frequency_hz);
      continue;
    }
    reference[i].number = static_cast<int>(best.partner[i]) + 1;
    kept.push_back(std::move(reference[i]));
  }
  std::sort(kept.begin(), kept.end(), [](const auto& a, const auto& b) { return a.number < b.number; });
  std::sort(left.begin(), left.end());
  reference = std::move(kept);
  return left;
}

}  // namespace core::structure
