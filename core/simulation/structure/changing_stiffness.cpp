#include "core/simulation/structure/changing_stiffness.h"

#include <algorithm>
#include <cmath>

namespace core::simulation {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int kSubsteps = 4, kBeyond = 8;
constexpr double kLeastStiffness = 0.2;  // share of the unchanged stiffness: it must stay positive

class Equations {
 public:
  Equations(const ChangingInput& input, const ChangeParameters& change)
      : input_(input), change_(change), square_(input.form->w.array().square()) {}

  [[nodiscard]] VectorXd force(double t_s) const {
    VectorXd out(square_.size());
    for (Index r = 0; r < out.size(); ++r) out(r) = input_.force[static_cast<std::size_t>(r)].at(t_s);
    return out;
  }
  [[nodiscard]] VectorXd acceleration(double t_s, const VectorXd& z, const VectorXd& v, const VectorXd& force) const {
    const double share = std::clamp(t_s / input_.duration_s, 0.0, 1.0) - 0.5;
    const double drifted = 1.0 + change_.frequency_drift * share;
    const double x = (input_.roof * z)(0), reference = 2.0 * input_.roof_rms_mm * input_.roof_rms_mm;
    const double soft = reference > 0.0 ? 4.0 / 3.0 * change_.softening * x * x / reference : 0.0;
    const double stiffness = drifted * drifted * std::max(1.0 - soft, kLeastStiffness);
    return force - input_.form->damping * v - (stiffness * square_ * z.array()).matrix();
  }

 private:
  const ChangingInput& input_;
  const ChangeParameters& change_;
  Eigen::ArrayXd square_;
};

}  // namespace

Eigen::MatrixXd integrate_changing(const ChangingInput& input, const ChangeParameters& change) {
  const Equations equations(input, change);
  const auto n = static_cast<Index>(std::ceil(input.duration_s * input.rate_hz)) + kBeyond;
  Eigen::MatrixXd out(n, input.position.size());
  VectorXd z = input.position, v = input.velocity, at_start = equations.force(0.0);
  const double h = 1.0 / (input.rate_hz * kSubsteps);
  for (Index k = 0; k < n; ++k) {
    out.row(k) = z.transpose();
    for (int i = 0; i < kSubsteps; ++i) {
      const double t = static_cast<double>(k) / input.rate_hz + i * h;
      const VectorXd at_middle = equations.force(t + 0.5 * h), at_end = equations.force(t + h);
      const VectorXd a1 = equations.acceleration(t, z, v, at_start);
      const VectorXd v2 = v + 0.5 * h * a1, a2 = equations.acceleration(t + 0.5 * h, z + 0.5 * h * v, v2, at_middle);
      const VectorXd v3 = v + 0.5 * h * a2, a3 = equations.acceleration(t + 0.5 * h, z + 0.5 * h * v2, v3, at_middle);
      const VectorXd v4 = v + h * a3, a4 = equations.acceleration(t + h, z + h * v3, v4, at_end);
      z += h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
      v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
      at_start = at_end;
    }
  }
  return out;
}

}  // namespace core::simulation
