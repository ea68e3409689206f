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

double cost(const ReferenceMode& mode, double model_hz, const Eigen::MatrixXd& shapes, Index r, double log_factor) {
  const double off = (std::log(mode.frequency_hz / model_hz) - log_factor) / kFrequencyWidth;
  if (mode.shape.size() < 2) return off * off;
  const double shape = (1.0 - mac(shape_of(mode), shapes.col(r))) / kShapeWidth;
  return std::min(off * off, 2.0 * kUnpaired) * 0.5 + shape * shape;
}

Pairing pair_at(const VectorXd& hz, const Eigen::MatrixXd& shapes, const std::vector<ReferenceMode>& reference,
                double log_factor) {
  const auto n_modes = static_cast<std::size_t>(hz.size());
  std::vector<double> costs;
  for (const ReferenceMode& mode : reference) {
    for (Index r = 0; r < hz.size(); ++r) costs.push_back(cost(mode, hz(r), shapes, r, log_factor) / kUnpaired);
  }
  Assignment assignment(reference.size(), n_modes);
  const auto columns = assignment.solve(costs, reference.size(), n_modes);
  Pairing out;
  std::size_t highest = 0, paired = 0;  // of the model's modes
  for (std::size_t i = 0; i < reference.size(); ++i) {
    out.number.push_back(columns[i] == Assignment::kNone ? 0 : static_cast<int>(columns[i]) + 1);
    if (columns[i] == Assignment::kNone) {
      out.cost += 1.0;
      continue;
    }
    const double own = costs[i * n_modes + columns[i]];
    out.cost += own, out.worst = std::max(out.worst, kUnpaired * own);
    highest = std::max(highest, columns[i] + 1);
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

Pairing pair_modes(const VectorXd& hz, const Eigen::MatrixXd& shapes, bool any_factor,
                   const std::vector<ReferenceMode>& reference) {
  std::vector<double> factors{0.0};
  if (any_factor) {
    for (const ReferenceMode& mode : reference) {
      for (const double own : hz) factors.push_back(std::log(mode.frequency_hz / own));
    }
  }
  Pairing best;
  best.cost = std::numeric_limits<double>::infinity();
  for (const double factor : factors) {
    Pairing one = pair_at(hz, shapes, reference, factor);
    one.cost += kFactorCost * factor * factor;
    if (one.cost < best.cost) best = std::move(one);
  }
  return best;
}

std::vector<ReferenceMode> numbered(std::vector<ReferenceMode> reference, const std::vector<int>& number) {
  std::vector<ReferenceMode> out;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    if (number[i] == 0) continue;
    out.push_back(std::move(reference[i]));
    out.back().number = number[i];
  }
  return out;
}

std::vector<ReferenceMode> pair_with_model(const DeclaredFrame& declared, std::vector<ReferenceMode>& reference) {
  const ModelModes& model = *declared.numbering;
  const Pairing best = pair_modes(model.frequency_hz, model.shapes, !declared.stiffness_over_mass_per_s2, reference);
  std::vector<ReferenceMode> left;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    if (best.number[i] == 0) left.push_back(reference[i]);
  }
  reference = numbered(std::move(reference), best.number);
  return left;
}

}  // namespace core::structure
