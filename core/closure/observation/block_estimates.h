#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/closure/observation/compact_field.h"
#include "core/closure/observation/leave_one_point_out.h"

namespace core::closure {

// Constants of a record by least squares: what multiplies each of these fields in a residual (2 points x frames, in
// sigmas), from the whole record and from blocks of its time.
class BlockEstimates {
 public:
  static constexpr Eigen::Index kBlocks = 10;

  BlockEstimates(std::span<const Eigen::MatrixXd> fields, const Eigen::MatrixXd& residual);
  // Of the errors of points left out, which are computed block by block.
  BlockEstimates(std::span<const CompactField* const> fields, const LeftOutErrors& errors);

  [[nodiscard]] Eigen::VectorXd values() const;
  // The larger, parameter by parameter, of two: that of white noise of unit variance, and that of the values without
  // one block each (jackknife over blocks, Quenouille 1956), which holds what the noise is not: correlated in time, or
  // an error of the model that comes and goes.
  [[nodiscard]] Eigen::MatrixXd covariance() const;
  // Drop of the squares of each block, in noise variances, where the values come from the other blocks; summed.
  [[nodiscard]] double held_out_gain() const;
  // How far the values lie from zero, in sigmas: along themselves, the sigma as in covariance().
  [[nodiscard]] double sigmas_from_zero() const;

 private:
  template <typename Field, typename Residual>
  void add_blocks(std::span<const Field* const> fields, const Residual& residual);
  [[nodiscard]] Eigen::MatrixXd without_each() const;  // constants x blocks

  std::vector<Eigen::MatrixXd> normal_;
  std::vector<Eigen::VectorXd> right_;
  Eigen::MatrixXd normal_sum_;
  Eigen::VectorXd right_sum_;
};

}  // namespace core::closure
