#include "core/simulation/structure/structure_damping.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <string>

#include "core/simulation/structure/modal_form.h"
#include "core/simulation/structure/structure_check.h"

namespace core::simulation {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

MatrixXd matrix_of(const StructureModel& model, const ModalDamping& damping) {
  if (damping.ratio.empty()) refuse_structure("no damping ratio; give one for all modes, or one for each");
  for (const double ratio : damping.ratio) {
    require_structure(ratio >= 1e-5 && ratio <= 0.9, "damping ratio", ratio, "give 0.00001 to 0.9");
  }
  const ModalForm form = modal_form(model.mass, MatrixXd::Zero(model.mass.rows(), model.mass.cols()), model.stiffness);
  Eigen::VectorXd rate(form.w.size());
  for (Index r = 0; r < rate.size(); ++r) {
    rate(r) = 2.0 * form.w(r) * damping.ratio[std::min(static_cast<std::size_t>(r), damping.ratio.size() - 1)];
  }
  const MatrixXd left = model.mass * form.shapes;
  return left * rate.asDiagonal() * left.transpose();
}

MatrixXd matrix_of(const StructureModel& model, const RayleighDamping& damping) {
  require_structure(damping.alpha_1_s >= 0.0 && damping.alpha_1_s <= 1e4, "Rayleigh alpha (1/s)", damping.alpha_1_s,
                    "give 0 to 10000");
  require_structure(damping.beta_s >= 0.0 && damping.beta_s <= 10.0, "Rayleigh beta (s)", damping.beta_s,
                    "give 0 to 10");
  return damping.alpha_1_s * model.mass + damping.beta_s * model.stiffness;
}

MatrixXd matrix_of(const StructureModel& model, const Dashpots& damping) {
  if (damping.n_s_per_m.size() != static_cast<std::size_t>(model.n_bodies())) {
    refuse_structure("number of dashpots is " + std::to_string(damping.n_s_per_m.size()) + "; give " +
                     std::to_string(model.n_bodies()) + ", one below each body");
  }
  MatrixXd matrix = MatrixXd::Zero(model.mass.rows(), model.mass.cols());
  for (Index i = 0; i < model.displacement.rows(); ++i) {
    const double c = damping.n_s_per_m[static_cast<std::size_t>(i)];
    require_structure(std::isfinite(c) && c >= 0.0, "dashpot below body " + std::to_string(i + 1) + " (N s/m)", c,
                      "give 0 or more");
    Eigen::VectorXd stretch = model.displacement.row(i).transpose();
    if (i > 0) stretch -= model.displacement.row(i - 1).transpose();
    matrix += c * stretch * stretch.transpose();
  }
  return matrix;
}

}  // namespace

void set_damping(StructureModel& model, const Damping& damping) {
  const MatrixXd matrix = std::visit([&](const auto& kind) { return matrix_of(model, kind); }, damping);
  model.damping = 0.5 * (matrix + matrix.transpose());
}

}  // namespace core::simulation
