#include "core/closure/observation/block_estimates.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

namespace core::closure {

BlockEstimates::BlockEstimates(std::span<const Eigen::MatrixXd> fields, const Eigen::MatrixXd& residual) {
  std::vector<const Eigen::MatrixXd*> pointers;
  pointers.reserve(fields.size());
  for (const Eigen::MatrixXd& field : fields) pointers.push_back(&field);
  add_blocks<Eigen::MatrixXd>(pointers, residual);
}

BlockEstimates::BlockEstimates(std::span<const CompactField* const> fields, const LeftOutErrors& errors) {
  add_blocks(fields, errors);
}

template <typename Field, typename Residual>
void BlockEstimates::add_blocks(std::span<const Field* const> fields, const Residual& residual) {
  const auto n = static_cast<Eigen::Index>(fields.size());
  normal_sum_ = Eigen::MatrixXd::Zero(n, n);
  right_sum_ = Eigen::VectorXd::Zero(n);
  for (Eigen::Index block = 0; block < kBlocks; ++block) {
    const Eigen::Index from = block * residual.cols() / kBlocks, to = (block + 1) * residual.cols() / kBlocks;
    const auto of_block = [&](const auto& series) { return series.middleCols(from, to - from); };
    const auto of_residual = of_block(residual);
    Eigen::MatrixXd normal(n, n);
    Eigen::VectorXd right(n);
    for (Eigen::Index p = 0; p < n; ++p) {
      const auto field = of_block(*fields[static_cast<std::size_t>(p)]);
      right(p) = field.cwiseProduct(of_residual).sum();
      for (Eigen::Index q = 0; q <= p; ++q)
        normal(p, q) = normal(q, p) = field.cwiseProduct(of_block(*fields[static_cast<std::size_t>(q)])).sum();
    }
    normal_sum_ += normal, right_sum_ += right;
    normal_.push_back(std::move(normal)), right_.push_back(std::move(right));
  }
}

Eigen::VectorXd BlockEstimates::values() const { return normal_sum_.ldlt().solve(right_sum_); }

Eigen::MatrixXd BlockEstimates::without_each() const {
  Eigen::MatrixXd out(right_sum_.size(), kBlocks);
  for (std::size_t b = 0; b < normal_.size(); ++b)
    out.col(static_cast<Eigen::Index>(b)) = (normal_sum_ - normal_[b]).ldlt().solve(right_sum_ - right_[b]);
  return out;
}

Eigen::MatrixXd BlockEstimates::covariance() const {
  const Eigen::Index n = right_sum_.size();
  Eigen::MatrixXd white = normal_sum_.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
  Eigen::MatrixXd off = without_each();
  off.colwise() -= off.rowwise().mean().eval();
  const Eigen::VectorXd blocks = (kBlocks - 1.0) / kBlocks * off.cwiseAbs2().rowwise().sum();
  const Eigen::VectorXd larger = (blocks.array() / white.diagonal().array()).max(1.0).sqrt();
  return larger.asDiagonal() * white * larger.asDiagonal();
}

double BlockEstimates::held_out_gain() const {
  const Eigen::MatrixXd values = without_each();
  if (!values.allFinite()) return 0.0;
  double gain = 0.0;
  for (std::size_t b = 0; b < normal_.size(); ++b) {
    const Eigen::VectorXd v = values.col(static_cast<Eigen::Index>(b));
    gain += 2.0 * v.dot(right_[b]) - v.dot(normal_[b] * v);
  }
  return gain;
}

double BlockEstimates::sigmas_from_zero() const {
  const Eigen::VectorXd all = values();
  const double size = std::sqrt(all.dot(normal_sum_ * all));
  if (!(size > 0.0)) return 0.0;
  Eigen::RowVectorXd along = (normal_sum_ * all).transpose() * without_each() / size;
  along.array() -= along.mean();
  const double blocks = (kBlocks - 1.0) / kBlocks * along.squaredNorm();
  return size / std::sqrt(std::max(blocks, 1.0));
}

}  // namespace core::closure
