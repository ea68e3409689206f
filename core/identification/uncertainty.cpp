#include "core/identification/uncertainty.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/identification/given_inputs.h"
#include "core/identification/hankel_changes.h"
#include "core/linear/dense.h"

namespace core {

namespace {

using Complex = std::complex<double>;
using Eigen::Index;

// Eigenvector psi of one pole of a realisation A, and the sensitivity of pole and psi to a
// change of A. With any b and c that are not orthogonal to the left and the right
// eigenvector, [A - lambda I, b; c^H, 0] is regular, and one factorisation of it serves all:
// c^H psi = 1; z, nu of a right-hand side r solve (A - lambda I) z + b nu = r, c^H z = 0. So
// (A - lambda I) dpsi = psi dlambda - dA psi has a solution where dlambda = -nu(-dA psi) /
// nu(psi).
class PoleResponse {
 public:
  PoleResponse(const Realisation& realisation, const PoleOfOrder& given) {
    const Index n = std::min<Index>(given.order, realisation.a.rows());
    const Eigen::Map<const Eigen::VectorXcd> shape(given.pole.shape.data(), realisation.c.rows());
    const Eigen::VectorXcd unit = realisation.scale.cast<Complex>().cwiseInverse().cwiseAbs2().cwiseProduct(shape);
    const Eigen::VectorXcd c = realisation.c.leftCols(n).transpose() * unit;
    Eigen::MatrixXcd bordered(n + 1, n + 1);
    bordered.topLeftCorner(n, n) = realisation.a.topLeftCorner(n, n).cast<Complex>();
    bordered.diagonal().array() -= given.pole.lambda;
    bordered.col(n).setOnes();
    bordered.row(n).head(n) = c.adjoint() / c.norm();
    bordered(n, n) = 0.0;
    lu_.compute(bordered);
    const Eigen::VectorXcd null = lu_.solve(Eigen::VectorXcd::Unit(n + 1, n));
    psi = null.head(n);
    const Eigen::VectorXcd own = realisation.c.leftCols(n) * psi;
    Index m = 0;
    const double largest = own.cwiseAbs().maxCoeff(&m);
    by_psi_ = solve(psi);
    found = null.allFinite() && by_psi_.allFinite() && largest > 0.0 && std::abs(by_psi_[n]) > 0.0 &&
            std::abs(null[n]) < 1e-9 * psi.norm();
    if (found) factor = shape[m] / own[m];
  }

  // Solution [dpsi; dlambda] for a change dA psi.
  [[nodiscard]] Eigen::VectorXcd to(const Eigen::VectorXcd& change) const {
    const Index n = psi.size();
    const Eigen::VectorXcd z = solve(-change);
    const Complex dlambda = -z[n] / by_psi_[n];
    Eigen::VectorXcd out(n + 1);
    out << z.head(n) + dlambda * by_psi_.head(n), dlambda;
    return out;
  }

  bool found = false;
  Eigen::VectorXcd psi;
  Complex factor;  // stated shape = factor * C psi

 private:
  [[nodiscard]] Eigen::VectorXcd solve(const Eigen::VectorXcd& right) const {
    Eigen::VectorXcd bordered(right.size() + 1);
    bordered << right, 0.0;
    return lu_.solve(bordered);
  }

  Eigen::PartialPivLU<Eigen::MatrixXcd> lu_;
  Eigen::VectorXcd by_psi_;
};

class PoleChanges {
 public:
  PoleChanges(const Realisation& realisation, const EraConfig& config, const std::vector<PoleOfOrder>& poles)
      : realisation_(realisation),
        config_(config),
        outputs_(given_inputs(config, static_cast<int>(realisation.scale.size())).future.channels) {
    directions_ = Eigen::MatrixXd::Zero(realisation.right_map.rows(), 2 * static_cast<Index>(poles.size()));
    for (std::size_t p = 0; p < poles.size(); ++p) {
      poles_.emplace_back(realisation, poles[p]);
      lambda_.push_back(poles[p].pole.lambda);
      if (!poles_[p].found) continue;
      const Eigen::VectorXcd r = realisation.right_map.leftCols(poles_[p].psi.size()) * poles_[p].psi;
      directions_.col(2 * static_cast<Index>(p)) = r.real();
      directions_.col(2 * static_cast<Index>(p) + 1) = r.imag();
    }
  }

  // [pole][block]: changes of each pole caused by each block.
  [[nodiscard]] std::vector<std::vector<PoleChange>> of(const BlockDeviations& deviations) const {
    const Index ny = static_cast<Index>(outputs_.size()), rows = realisation_.left_map.cols();
    // One block row more than H0 has, because H1 is the same matrix without its first.
    const Eigen::MatrixXd moved = hankel_changes(realisation_, config_, deviations, directions_).outputs;
    const Eigen::MatrixXd by_h0 = left_times(moved.topRows(rows)), by_h1 = left_times(moved.bottomRows(rows));
    std::vector<std::vector<PoleChange>> changes(poles_.size());
    const auto column = [](const Eigen::MatrixXd& m, Index re, Index n) {
      Eigen::VectorXcd out(n);
      out.real() = m.col(re).head(n);
      out.imag() = m.col(re + 1).head(n);
      return out;
    };
    for (std::size_t p = 0; p < poles_.size(); ++p) {
      if (!poles_[p].found) continue;
      const Index n = poles_[p].psi.size();
      for (Index block = 0; block < deviations.n_blocks; ++block) {
        const Index c = 2 * (block * static_cast<Index>(poles_.size()) + static_cast<Index>(p));
        changes[p].push_back(change(p, {column(by_h0, c, n), column(by_h1, c, n), column(moved, c, ny)}));
      }
    }
    return changes;
  }

 private:
  [[nodiscard]] Eigen::MatrixXd left_times(const Eigen::Ref<const Eigen::MatrixXd>& moved) const {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(realisation_.left_map.rows(), moved.cols());
    add_product(out, 1.0, realisation_.left_map, moved);
    return out;
  }

  // Changes caused by one block along one pole's direction: left_map dH0, left_map dH1, and the first block row of dH0.
  struct Moved {
    Eigen::VectorXcd by_h0, by_h1, top;
  };

  [[nodiscard]] PoleChange change(std::size_t p, const Moved& by) const {
    const PoleResponse& pole = poles_[p];
    const Index n = pole.psi.size();
    const Eigen::VectorXcd moved = pole.to(by.by_h1 - lambda_[p] * by.by_h0);
    Eigen::VectorXcd top = Eigen::VectorXcd::Zero(realisation_.scale.size());
    for (std::size_t i = 0; i < outputs_.size(); ++i) {
      top[outputs_[i]] = realisation_.scale[outputs_[i]] * by.top[static_cast<Index>(i)];
    }
    const Eigen::VectorXcd shape = pole.factor * (top + realisation_.c.leftCols(n) * moved.head(n));
    return {moved[n], {shape.begin(), shape.end()}, moved.head(n)};
  }

  const Realisation& realisation_;
  const EraConfig& config_;
  std::vector<int> outputs_;  // all channels but the inputs
  std::vector<PoleResponse> poles_;
  std::vector<Complex> lambda_;
  Eigen::MatrixXd directions_;  // right_map psi of every pole: real and imaginary parts
};

}  // namespace

std::vector<std::vector<PoleChange>> pole_changes(const Realisation& realisation, const EraConfig& config,
                                                  const BlockDeviations& deviations,
                                                  const std::vector<PoleOfOrder>& poles) {
  if (poles.empty() || deviations.n_blocks == 0) return std::vector<std::vector<PoleChange>>(poles.size());
  return PoleChanges(realisation, config, poles).of(deviations);
}

PoleVector pole_vector(const Realisation& realisation, const PoleOfOrder& pole) {
  PoleResponse response(realisation, pole);
  return response.found ? PoleVector{std::move(response.psi), response.factor} : PoleVector{};
}

double student_95(double degrees_of_freedom) noexcept {
  constexpr std::array<double, 30> kQuantile{12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228,
                                             2.201,  2.179, 2.160, 2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086,
                                             2.080,  2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042};
  constexpr double kNormal = 1.960;
  if (!(degrees_of_freedom > 1.0)) return kQuantile.front();
  const double whole = std::floor(degrees_of_freedom);
  if (whole >= static_cast<double>(kQuantile.size())) {
    return kNormal + (kQuantile.back() - kNormal) * static_cast<double>(kQuantile.size()) / degrees_of_freedom;
  }
  const auto at = static_cast<std::size_t>(whole);
  const double share = (1.0 / whole - 1.0 / degrees_of_freedom) / (1.0 / whole - 1.0 / (whole + 1.0));
  return kQuantile[at - 1] + share * (kQuantile[at] - kQuantile[at - 1]);
}

std::optional<Interval> damping_interval_95(const Mode& mode, double degrees_of_freedom) noexcept {
  if (!mode.damping_std || !(mode.damping_ratio > 0.0) || !(degrees_of_freedom > 0.0)) return std::nullopt;
  const double factor = std::exp(student_95(degrees_of_freedom) * *mode.damping_std / mode.damping_ratio);
  if (!std::isfinite(factor) || !(factor > 0.0)) return std::nullopt;
  return Interval{mode.damping_ratio / factor, mode.damping_ratio * factor};
}

}  // namespace core
