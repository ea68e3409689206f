#include <algorithm>
#include <cmath>

#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/kinds/course_effect.h"

namespace core::closure {
namespace {

// Tracking error of templates that do not follow the scale of the image: zoom times a constant of each point, which
// depends on its texture. Observable wherever the camera's distance changes; confused with the part of a lens or of an
// oblique view that zoom moves, which follow the camera's translation as well.
class TemplateZoom final : public CourseEffect {
 public:
  [[nodiscard]] EffectId id() const override { return {"template_zoom"}; }
  [[nodiscard]] std::string name() const override { return "template zoom"; }
  [[nodiscard]] std::optional<NotObservable> obstacle(const FitView& /*fit*/, bool /*is_adopted*/) const override {
    return std::nullopt;
  }
  [[nodiscard]] bool has_course_of_its_own() const override { return false; }
  [[nodiscard]] std::optional<PointCourses> courses(const FitView& fit,
                                                    const TestedResidual& /*residual*/) const override {
    PointCourses out;
    std::vector<Eigen::Index> row_of_set;
    for (Eigen::Index j = 0; j < fit.record.n_points(); ++j) {
      const Eigen::Index row = fit.model.zoom_row_of(j);
      if (row < 0) return std::nullopt;
      const auto known = std::find(row_of_set.begin(), row_of_set.end(), row);
      out.set_of_point.push_back(static_cast<std::size_t>(known - row_of_set.begin()));
      if (known != row_of_set.end()) continue;
      const Eigen::RowVectorXd zoom = fit.model.amplitudes().row(row);
      out.sets.emplace_back(zoom.array() - zoom.mean());
      row_of_set.push_back(row);
    }
    return out;
  }
  [[nodiscard]] std::vector<ParameterValue> parameters(const FitView& fit, const Eigen::MatrixXd& motion_px,
                                                       const PointCourses& courses) const override {
    double squares = 0.0, noise = 0.0;
    for (Eigen::Index row = 0; row < motion_px.rows(); ++row) {
      const Eigen::MatrixXd& zoom = courses.sets[courses.set_of_point[static_cast<std::size_t>(row / 2)]];
      const double course = zoom.squaredNorm();
      squares += std::pow(motion_px.row(row).dot(zoom.row(0)) / course, 2);
      noise += std::pow(fit.record.sigma_px[static_cast<std::size_t>(row / 2)], 2) / course;
    }
    const auto n = static_cast<double>(motion_px.rows());
    const double rms = std::sqrt(std::max(squares - noise, 0.0) / n);
    return {{"rms of the points, per unit of zoom", "px", rms, std::sqrt(noise) / n}};
  }
};

}  // namespace

std::unique_ptr<ObservationEffect> make_template_zoom() { return std::make_unique<TemplateZoom>(); }

}  // namespace core::closure
