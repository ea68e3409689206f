#include "core/identification/uncertainty.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "core/linear/dense.h"

namespace core {

namespace {

using Complex = std::complex<double>;
using Eigen::Index;

// The eigenvectors of one order's realisation.
struct OrderVectors {
  Eigen::VectorXcd lambda;
  Eigen::MatrixXcd right, left;  // columns psi, rows of its inverse
  bool valid = false;
};

OrderVectors vectors_of(const Realisation& realisation, int order) {
  OrderVectors out;
  const Index n = std::min<Index>(order, realisation.a.rows());
  const Eigen::EigenSolver<Eigen::MatrixXd> eigen(realisation.a.topLeftCorner(n, n));
  if (eigen.info() != Eigen::Success) return out;
  out.lambda = eigen.eigenvalues();
  out.right = eigen.eigenvectors();
  const Eigen::PartialPivLU<Eigen::MatrixXcd> lu(out.right);
  out.left = lu.inverse();
  out.valid = out.left.allFinite();
  return out;
}

struct Pole {
  const OrderVectors* vectors = nullptr;  // null: not found again
  Index k = 0;                            // its column
  Complex factor;                         // shape as given = factor * C psi
};

class PoleChanges {
 public:
  PoleChanges(const Realisation& realisation, const EraConfig& config, const std::vector<PoleOfOrder>& poles)
      : realisation_(realisation), config_(config) {
    for (const PoleOfOrder& each : poles) {
      auto [at, added] = orders_.try_emplace(each.order);
      if (added) at->second = vectors_of(realisation, each.order);
      poles_.push_back(locate(at->second, each.pole));
    }
    directions_.resize(realisation.right_map.rows(), 2 * static_cast<Index>(poles.size()));
    directions_.setZero();
    for (std::size_t p = 0; p < poles_.size(); ++p) {
      if (poles_[p].vectors == nullptr) continue;
      const OrderVectors& v = *poles_[p].vectors;
      const Eigen::VectorXcd r = realisation.right_map.leftCols(v.lambda.size()) * v.right.col(poles_[p].k);
      directions_.col(2 * static_cast<Index>(p)) = r.real();
      directions_.col(2 * static_cast<Index>(p) + 1) = r.imag();
    }
  }

  // [pole][block]: what each block does to each of the poles.
  [[nodiscard]] std::vector<std::vector<PoleChange>> of(const BlockDeviations& deviations) const {
    const Index ny = realisation_.scale.size(), rows = realisation_.left_map.cols();
    const Eigen::MatrixXd y = hankel_times_directions(deviations);
    std::vector<std::vector<PoleChange>> changes(poles_.size());
    Eigen::VectorXcd moved(rows + ny);
    for (std::size_t p = 0; p < poles_.size(); ++p) {
      if (poles_[p].vectors == nullptr) continue;
      const Index c = 2 * static_cast<Index>(p);
      for (Index block = 0; block < deviations.n_blocks; ++block) {
        for (Index a = 0; a <= config_.block_rows; ++a) {
          const Index from = (a * deviations.n_blocks + block) * ny;
          moved.segment(a * ny, ny).real() = y.col(c).segment(from, ny);
          moved.segment(a * ny, ny).imag() = y.col(c + 1).segment(from, ny);
        }
        changes[p].push_back(change(poles_[p], moved.head(rows), moved.segment(ny, rows), ny));
      }
    }
    return changes;
  }

 private:
  // Rows (block row, block of the record, channel). A block row of the Hankel matrix is a run of lags; one block row
  // more than H0 has, for H1 is the same matrix without its first.
  [[nodiscard]] Eigen::MatrixXd hankel_times_directions(const BlockDeviations& deviations) const {
    const Index ny = realisation_.scale.size(), nr = static_cast<Index>(config_.references.size());
    const Index height = deviations.value.rows(), width = config_.block_rows * nr;
    Eigen::MatrixXd of_unit_variance = deviations.value;
    for (Index r = 0; r < height; ++r) of_unit_variance.row(r) /= realisation_.scale[r % ny];
    for (Index c = 0; c < of_unit_variance.cols(); ++c) {
      of_unit_variance.col(c) /= realisation_.scale[config_.references[static_cast<std::size_t>(c % nr)]];
    }
    Eigen::MatrixXd y = Eigen::MatrixXd::Zero((config_.block_rows + 1) * height, directions_.cols());
    for (Index a = 0; a <= config_.block_rows; ++a) {
      add_product(y.middleRows(a * height, height), 1.0, of_unit_variance.middleCols(a * nr, width), directions_);
    }
    return y;
  }

  [[nodiscard]] Pole locate(const OrderVectors& vectors, const DiscretePole& given) const {
    if (!vectors.valid) return {};
    Index k = 0;
    const double off = (vectors.lambda.array() - given.lambda).abs().minCoeff(&k);
    if (!(off < 1e-9 * std::max(1.0, std::abs(given.lambda)))) return {};
    const Eigen::VectorXcd own = realisation_.c.leftCols(vectors.lambda.size()) * vectors.right.col(k);
    Index m = 0;
    if (!(own.cwiseAbs().maxCoeff(&m) > 0.0)) return {};
    return {&vectors, k, given.shape[static_cast<std::size_t>(m)] / own[m]};
  }

  [[nodiscard]] PoleChange change(const Pole& pole, const Eigen::VectorXcd& h0, const Eigen::VectorXcd& h1,
                                  Index ny) const {
    const OrderVectors& v = *pole.vectors;
    const Index n = v.lambda.size();
    const Complex lambda = v.lambda[pole.k];
    const Eigen::VectorXcd moved = v.left * (realisation_.left_map.topRows(n) * (h1 - lambda * h0));
    Eigen::VectorXcd mixing = Eigen::VectorXcd::Zero(n);
    for (Index j = 0; j < n; ++j) {
      if (j != pole.k) mixing[j] = moved[j] / (lambda - v.lambda[j]);
    }
    const Eigen::VectorXcd top = realisation_.scale.cast<Complex>().cwiseProduct(h0.head(ny));
    const Eigen::VectorXcd shape = pole.factor * (top + realisation_.c.leftCols(n) * (v.right * mixing));
    return {moved[pole.k], {shape.begin(), shape.end()}};
  }

  const Realisation& realisation_;
  const EraConfig& config_;
  std::map<int, OrderVectors> orders_;
  std::vector<Pole> poles_;
  Eigen::MatrixXd directions_;  // right_map psi of every pole: real and imaginary part
};

// One block's change of the continuous pole and of the shape as it is stated.
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
  if (s.imag() < 0.0) out.s = std::conj(out.s);  // the real parts of a shape are those of its conjugate
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
  if (changes.size() < kScatterBlocks) return std::nullopt;
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

double student_95(std::size_t degrees_of_freedom) noexcept {
  constexpr std::array<double, 30> kQuantile{12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228,
                                             2.201,  2.179, 2.160, 2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086,
                                             2.080,  2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042};
  if (degrees_of_freedom == 0) return kQuantile.front();
  return degrees_of_freedom <= kQuantile.size() ? kQuantile[degrees_of_freedom - 1] : 1.96;
}

}  // namespace core
