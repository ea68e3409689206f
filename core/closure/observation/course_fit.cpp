#include "core/closure/observation/course_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "core/closure/observation/block_estimates.h"

namespace core::closure {
namespace {

constexpr Eigen::Index kBlocks = BlockEstimates::kBlocks;

Eigen::MatrixXd solved(const Eigen::MatrixXd& normal, const Eigen::MatrixXd& right) {
  return normal.ldlt().solve(right.transpose()).transpose();
}

}  // namespace

CourseFit::CourseFit(const PointCourses& courses, const Eigen::MatrixXd& residual)
    : courses_(courses), n_rows_(residual.rows()), n_frames_(residual.cols()), sets_(courses.sets.size()) {
  for (Eigen::Index row = 0; row < n_rows_; ++row)
    sets_[courses.set_of_point[static_cast<std::size_t>(row / 2)]].rows.push_back(row);
  for (std::size_t s = 0; s < sets_.size(); ++s) {
    OfSet& set = sets_[s];
    const Eigen::MatrixXd& of = courses.sets[s];
    const auto n_of_rows = static_cast<Eigen::Index>(set.rows.size());
    set.normal_sum = Eigen::MatrixXd::Zero(of.rows(), of.rows());
    set.right_sum = Eigen::MatrixXd::Zero(n_of_rows, of.rows());
    for (Eigen::Index block = 0; block < kBlocks; ++block) {
      const Eigen::Index from = block * n_frames_ / kBlocks, count = (block + 1) * n_frames_ / kBlocks - from;
      const Eigen::MatrixXd here = of.middleCols(from, count);
      set.normal.emplace_back(here * here.transpose());
      Eigen::MatrixXd right(n_of_rows, of.rows());
      for (Eigen::Index i = 0; i < n_of_rows; ++i)
        right.row(i) = residual.row(set.rows[static_cast<std::size_t>(i)]).segment(from, count) * here.transpose();
      set.normal_sum += set.normal.back(), set.right_sum += right;
      set.right.push_back(std::move(right));
    }
    is_usable_ = is_usable_ && set.normal_sum.ldlt().isPositive() && (set.normal_sum.diagonal().array() > 0.0).all();
  }
}

double CourseFit::held_out_gain() const {
  if (!is_usable_) return 0.0;
  double gain = 0.0;
  for (const OfSet& set : sets_) {
    for (std::size_t b = 0; b < set.normal.size(); ++b) {
      const Eigen::MatrixXd v = solved(set.normal_sum - set.normal[b], set.right_sum - set.right[b]);
      if (!v.allFinite()) return 0.0;
      gain += 2.0 * v.cwiseProduct(set.right[b]).sum() - (v * set.normal[b]).cwiseProduct(v).sum();
    }
  }
  return gain;
}

Eigen::MatrixXd CourseFit::constants() const {
  Eigen::Index most = 0;
  for (const Eigen::MatrixXd& set : courses_.sets) most = std::max(most, set.rows());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(n_rows_, most);
  if (!is_usable_) return out;
  for (const OfSet& set : sets_) {
    const Eigen::MatrixXd values = solved(set.normal_sum, set.right_sum);
    for (std::size_t i = 0; i < set.rows.size(); ++i)
      out.row(set.rows[i]).head(values.cols()) = values.row(static_cast<Eigen::Index>(i));
  }
  return out;
}

Eigen::MatrixXd CourseFit::fitted() const {
  const Eigen::MatrixXd values = constants();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(n_rows_, n_frames_);
  for (Eigen::Index row = 0; row < n_rows_; ++row) {
    const Eigen::MatrixXd& course = courses_.sets[courses_.set_of_point[static_cast<std::size_t>(row / 2)]];
    out.row(row) = values.row(row).head(course.rows()) * course;
  }
  return out;
}

}  // namespace core::closure
