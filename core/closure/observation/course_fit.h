#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/closure/observation/leave_one_point_out.h"

namespace core::closure {

// Courses in time that are known, for each point one of some sets.
struct PointCourses {
  std::vector<Eigen::MatrixXd> sets;      // each courses x frames, without their means over time
  std::vector<std::size_t> set_of_point;  // one for each point
  double hz = 0.0;                        // of a line
};

// What a residual (2 points x frames, in sigmas) holds of the courses: in each row constants of its own, by least
// squares, from the whole record and from blocks of its time.
class CourseFit {
 public:
  CourseFit(const PointCourses& courses, const Eigen::MatrixXd& residual);
  // Of the errors of points left out, which are computed block by block.
  CourseFit(const PointCourses& courses, const LeftOutErrors& errors);

  [[nodiscard]] bool is_usable() const noexcept { return is_usable_; }  // the courses of each set are independent
  // Drop of the squares of each of ten blocks, in noise variances, where the constants come from the other nine;
  // summed.
  [[nodiscard]] double held_out_gain() const;
  // In sigmas, 2 points x the largest number of courses.
  [[nodiscard]] Eigen::MatrixXd constants() const;
  // Constants times courses, 2 points x frames in sigmas.
  [[nodiscard]] Eigen::MatrixXd fitted() const;

 private:
  struct OfSet {
    std::vector<Eigen::Index> rows;
    std::vector<Eigen::MatrixXd> normal, right;  // of each block: courses x courses, rows x courses
    Eigen::MatrixXd normal_sum, right_sum;
  };

  void begin(Eigen::Index n_rows, Eigen::Index n_frames);
  template <typename Residual>
  void add_blocks(const Residual& residual);

  const PointCourses& courses_;
  Eigen::Index n_rows_ = 0, n_frames_ = 0;
  std::vector<OfSet> sets_;
  bool is_usable_ = true;
};

}  // namespace core::closure
