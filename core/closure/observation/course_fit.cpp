#include "core/closure/observation/course_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

#include "core/closure/observation/block_estimates.h"

namespace core::closure {
namespace {

constexpr Eigen::Index kBlocks = BlockEstimates::kBlocks;

Eigen::MatrixXd solved(const Eigen::MatrixXd& normal, const Eigen::MatrixXd& right) {
  return normal.ldlt().solve(right.transpose()).transpose();
}

}  // namespace

CourseFit::CourseFit(const PointCourses& courses, const Eigen::MatrixXd& residual) : courses_(courses) {
  add_blocks(residual);
}

CourseFit::CourseFit(const PointCourses& courses, const LeftOutErrors& errors) : courses_(courses) {
  add_blocks(errors);
}

void CourseFit::begin(Eigen::Index n_rows, Eigen::Index n_frames) {
  n_rows_ = n_rows, n_frames_ = n_frames;
  sets_.resize(courses_.sets.size());
  for (Eigen::Index row = 0; row < n_rows_; ++row)
    sets_[courses_.set_of_point[static_cast<std::size_t>(row / 2)]].rows.push_back(row);
  for (std::size_t s = 0; s < sets_.size(); ++s) {
    const Eigen::Index n_courses = courses_.sets[s].rows();
    sets_[s].normal_sum = Eigen::MatrixXd::Zero(n_courses, n_courses);
    sets_[s].right_sum = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(sets_[s].rows.size()), n_courses);
  }
}

template <typename Residual>
void CourseFit::add_blocks(const Residual& residual) {
  begin(residual.rows(), residual.cols());
  for (Eigen::Index block = 0; block < kBlocks; ++block) {
    const Eigen::Index from = block * n_frames_ / kBlocks, count = (block + 1) * n_frames_ / kBlocks - from;
    const auto of_block = residual.middleCols(from, count);
    for (std::size_t s = 0; s < sets_.size(); ++s) {
      OfSet& set = sets_[s];
      const Eigen::MatrixXd here = courses_.sets[s].middleCols(from, count);
      set.normal.emplace_back(here * here.transpose());
      Eigen::MatrixXd right(set.right_sum.rows(), here.rows());
      for (Eigen::Index i = 0; i < right.rows(); ++i)
        right.row(i) = of_block.row(set.rows[static_cast<std::size_t>(i)]) * here.transpose();
      set.normal_sum += set.normal.back(), set.right_sum += right;
      set.right.push_back(std::move(right));
    }
  }
  is_usable_ = std::all_of(sets_.begin(), sets_.end(), [](const OfSet& set) {
    return set.normal_sum.ldlt().isPositive() && (set.normal_sum.diagonal().array() > 0.0).all();
  });
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
