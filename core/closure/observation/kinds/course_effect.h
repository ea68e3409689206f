#pragma once

#include <optional>
#include <vector>

#include "core/closure/observation/course_fit.h"
#include "core/closure/observation/effect.h"

namespace core::closure {

// An error of each point, of its own size and direction, that follows courses in time which are known or belong to a
// narrow family: constants of the record, two for each point and course. Scored on one of ten blocks of time, fitted on
// the other nine (course_fit.h).
class CourseEffect : public ObservationEffect {
 public:
  // Of the residual under test; empty: the record has none.
  [[nodiscard]] virtual std::optional<PointCourses> courses(const FitView& fit,
                                                            const TestedResidual& residual) const = 0;
  // Of the adopted effect: its motion, 2 points x frames in px, and the courses last fitted.
  [[nodiscard]] virtual std::vector<ParameterValue> parameters(const FitView& fit, const Eigen::MatrixXd& motion_px,
                                                               const PointCourses& courses) const = 0;

  // Cosine and sine of a phase that is known but for a slow wander, which is refined with the constants.
  [[nodiscard]] virtual bool wanders() const { return false; }
  // False: the courses are motions of the model itself.
  [[nodiscard]] virtual bool has_course_of_its_own() const { return true; }

  [[nodiscard]] std::size_t n_parameters() const override { return 2; }
  [[nodiscard]] std::unique_ptr<EffectCandidate> candidate(const FitView& fit) const final;
};

}  // namespace core::closure
