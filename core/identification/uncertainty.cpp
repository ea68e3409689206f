#include "core/identification/uncertainty.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

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
      : realisation_(realisation), config_(config) {
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
    const Index ny = realisation_.scale.size(), rows = realisation_.left_map.cols();
    const Eigen::MatrixXd moved = hankel_times_directions(deviations);
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
  // dH right_map psi. Rows: one block row more than H0 has, because H1 is the same matrix without its first. Columns:
  // (block of the record, pole, real or imaginary part). A block row of the Hankel matrix is a sequence of lags.
  [[nodiscard]] Eigen::MatrixXd hankel_times_directions(const BlockDeviations& deviations) const {
    const Index ny = realisation_.scale.size(), nr = static_cast<Index>(config_.references.size());
    const Index height = deviations.value.rows(), width = config_.block_rows * nr, n_columns = directions_.cols();
    Eigen::MatrixXd of_unit_variance = deviations.value;
    for (Index r = 0; r < height; ++r) of_unit_variance.row(r) /= realisation_.scale[r % ny];
    for (Index c = 0; c < of_unit_variance.cols(); ++c) {
      of_unit_variance.col(c) /= realisation_.scale[config_.references[static_cast<std::size_t>(c % nr)]];
    }
    Eigen::MatrixXd out((config_.block_rows + 1) * ny, deviations.n_blocks * n_columns), y(height, n_columns);
    for (Index a = 0; a <= config_.block_rows; ++a) {
      y.setZero();
      add_product(y, 1.0, of_unit_variance.middleCols(a * nr, width), directions_);
      for (Index block = 0; block < deviations.n_blocks; ++block) {
        out.block(a * ny, block * n_columns, ny, n_columns) = y.middleRows(block * ny, ny);
      }
    }
    return out;
  }

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
    const Eigen::VectorXcd top = realisation_.scale.cast<Complex>().cwiseProduct(by.top);
    const Eigen::VectorXcd shape = pole.factor * (top + realisation_.c.leftCols(n) * moved.head(n));
    return {moved[n], {shape.begin(), shape.end()}};
  }

  const Realisation& realisation_;
  const EraConfig& config_;
  std::vector<PoleResponse> poles_;
  std::vector<Complex> lambda_;
  Eigen::MatrixXd directions_;  // right_map psi of every pole: real and imaginary parts
};

// Change of the continuous pole and of the stated shape caused by one block.
struct StatedChange {
  Complex s;
  std::vector<double> shape;
};

StatedChange stated_change(const PoleOfOrder& pole, const FoldingConfig& folding, int fold_n,
                           const PoleChange& change) {
  const Complex s =
      std::log(pole.pole.lambda) * folding.rate_hz + Complex(0.0, 2.0 * std::numbers::pi * fold_n * folding.rate_hz);
  StatedChange out{change.lambda / pole.pole.lambda * folding.rate_hz, {}};
  const std::size_t n = pole.pole.shape.size();
  std::vector<Complex> x(n), dx(n);
  std::size_t m = 0;
  for (std::size_t c = 0; c < n; ++c) {
    const double delay_s = c < folding.delay_s.size() ? folding.delay_s[c] : 0.0;
    const int n_integrations = c < folding.n_integrations.size() ? folding.n_integrations[c] : 0;
    const Complex undone = std::exp(-s * delay_s) / std::pow(s, n_integrations);
    x[c] = pole.pole.shape[c] * undone;
    dx[c] =
        (change.shape[c] - (delay_s + static_cast<double>(n_integrations) / s) * out.s * pole.pole.shape[c]) * undone;
    if (std::norm(x[c]) > std::norm(x[m])) m = c;
  }
  for (std::size_t c = 0; c < n; ++c) out.shape.push_back(((dx[c] - x[c] / x[m] * dx[m]) / x[m]).real());
  if (s.imag() < 0.0) out.s = std::conj(out.s);  // the real parts of a shape equal those of its conjugate
  return out;
}

}  // namespace

std::vector<std::vector<PoleChange>> pole_changes(const Realisation& realisation, const EraConfig& config,
                                                  const BlockDeviations& deviations,
                                                  const std::vector<PoleOfOrder>& poles) {
  if (poles.empty() || deviations.n_blocks == 0) return std::vector<std::vector<PoleChange>>(poles.size());
  return PoleChanges(realisation, config, poles).of(deviations);
}

std::optional<ModeScatter> mode_scatter(const PoleOfOrder& pole, const UnfoldedPole& unfolded,
                                        const FoldingConfig& folding, const std::vector<PoleChange>& changes) {
  if (changes.size() < kLeastScatterBlocks) return std::nullopt;
  const double size = std::abs(unfolded.s), zeta = -unfolded.s.real() / size;
  ModeScatter sum;
  sum.shape.assign(pole.pole.shape.size(), 0.0);
  for (const PoleChange& change : changes) {
    const StatedChange moved = stated_change(pole, folding, unfolded.fold_n.value_or(0), change);
    const double d_size = (std::conj(unfolded.s) * moved.s).real() / size;
    const double d_zeta = -(moved.s.real() + zeta * d_size) / size;
    sum.frequency_hz += d_size * d_size;
    sum.damping_ratio += d_zeta * d_zeta;
    for (std::size_t c = 0; c < sum.shape.size(); ++c) sum.shape[c] += moved.shape[c] * moved.shape[c];
  }
  const auto k = static_cast<double>(changes.size());
  const auto root = [k](double squares) { return std::sqrt(squares * k / (k - 1.0)); };
  ModeScatter out{root(sum.frequency_hz) / (2.0 * std::numbers::pi), root(sum.damping_ratio), {}};
  bool finite = std::isfinite(out.frequency_hz) && std::isfinite(out.damping_ratio);
  for (const double squares : sum.shape) {
    out.shape.push_back(root(squares));
    finite = finite && std::isfinite(out.shape.back());
  }
  return finite ? std::optional(std::move(out)) : std::nullopt;
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
