#include "core/closure/observation/block_estimates.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace core::closure {
namespace {

template <typename A, typename B>
double product(const A& a, const B& b, Eigen::Index block) {
  const Eigen::Index from = block * a.cols() / BlockEstimates::kBlocks;
  const Eigen::Index count = (block + 1) * a.cols() / BlockEstimates::kBlocks - from;
  return a.middleCols(from, count).cwiseProduct(b.middleCols(from, count)).sum();
}

template <typename Field>
std::vector<const Field*> pointers_to(std::span<const Field> fields) {
  std::vector<const Field*> out;
  for (const Field& field : fields) out.push_back(&field);
  return out;
}

}  // namespace

BlockEstimates::BlockEstimates(std::span<const Eigen::MatrixXd> fields, const Eigen::MatrixXd& residual) {
  add_blocks<Eigen::MatrixXd>(pointers_to(fields), residual);
}

BlockEstimates::BlockEstimates(std::span<const CompactField> fields, const Eigen::MatrixXd& residual) {
  add_blocks<CompactField>(pointers_to(fields), residual);
}

BlockEstimates::BlockEstimates(std::span<const CompactField* const> fields, const Eigen::MatrixXd& residual) {
  add_blocks(fields, residual);
}

template <typename Field>
void BlockEstimates::add_blocks(std::span<const Field* const> fields, const Eigen::MatrixXd& residual) {
  const auto n = static_cast<Eigen::Index>(fields.size());
  normal_sum_ = Eigen::MatrixXd::Zero(n, n);
  right_sum_ = Eigen::VectorXd::Zero(n);
  for (Eigen::Index block = 0; block < kBlocks; ++block) {
    Eigen::MatrixXd normal(n, n);
    Eigen::VectorXd right(n);
    for (Eigen::Index p = 0; p < n; ++p) {
      const Field& field = *fields[static_cast<std::size_t>(p)];
      right(p) = product(field, residual, block);
      for (Eigen::Index q = 0; q <= p; ++q)
        normal(p, q) = normal(q, p) = product(field, *fields[static_cast<std::size_t>(q)], block);
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
