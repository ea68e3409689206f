#include "core/closure/observation/kinds/course_effect.h"

#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "core/closure/observation/kinds/materiality.h"
#include "core/closure/observation/smooth_share.h"

namespace core::closure {
namespace {

constexpr double kMostSmooth = 0.6;

class CoursesInModel final : public EffectInModel {
 public:
  CoursesInModel(const CourseEffect& effect, PointCourses courses)
      : EffectInModel(effect.id(), effect.name()), effect_(effect), courses_(std::move(courses)) {}
  [[nodiscard]] std::unique_ptr<EffectInModel> clone() const override {
    return std::make_unique<CoursesInModel>(*this);
  }
  [[nodiscard]] std::vector<ParameterValue> parameters(const FitView& fit,
                                                       const Eigen::RowVectorXd& /*amplitude*/) const override {
    return effect_.parameters(fit, motion_px_, courses_);
  }
  void correct(CorrectionStage stage, const CorrectionView& /*view*/, Eigen::MatrixXd& positions) const override {
    if (stage == CorrectionStage::kTracker && motion_px_.size() > 0) positions -= motion_px_;
  }
  [[nodiscard]] Eigen::MatrixXd motion_px(const Eigen::RowVectorXd& /*amplitude*/) const override { return motion_px_; }
  [[nodiscard]] bool is_refined() const override { return true; }
  void refine(const FitView& fit) override {
    const CourseFit more(courses_, fit.model.residual());
    const Eigen::MatrixXd px = fit.model.at_own_instants(fit.model.in_px(more.fitted()));
    motion_px_ = motion_px_.size() > 0 ? (motion_px_ + px).eval() : px;
    freedom_ = 0.0;
    const double beside =
        1.0 - static_cast<double>(fit.model.q_high().cols()) / static_cast<double>(fit.model.q_high().rows());
    for (const std::size_t set : courses_.set_of_point)
      freedom_ += 2.0 * beside * static_cast<double>(courses_.sets[set].rows());
  }
  [[nodiscard]] double freedom() const override { return freedom_; }
  [[nodiscard]] bool fills_free_motions() const override { return effect_.has_course_of_its_own(); }

 private:
  const CourseEffect& effect_;
  PointCourses courses_;
  Eigen::MatrixXd motion_px_;
  double freedom_ = 0.0;
};

class CourseCandidate final : public EffectCandidate {
 public:
  CourseCandidate(const CourseEffect& effect, const FitView& fit) : effect_(effect), fit_(fit) {}
  [[nodiscard]] double gain(const TestedResidual& residual) const override {
    return gain_of(effect_.courses(fit_, residual), residual);
  }
  double find(const TestedResidual& residual) override {
    found_ = effect_.courses(fit_, residual);
    smooth_ = found_ ? smooth_share_of(CourseFit(*found_, residual.values)) : 0.0;
    return gain_of(found_, residual);
  }
  [[nodiscard]] Objection objection(const TestedResidual& /*residual*/) const override {
    if (smooth_ < kMostSmooth) return {};
    return {"a smooth field over the image is " + std::to_string(std::lround(100.0 * smooth_)) +
                " % of it: motion or optics, not an error of each point",
            true};
  }
  [[nodiscard]] double material_share() const override { return kFullBandBar; }
  [[nodiscard]] std::unique_ptr<EffectInModel> adopted() const override {
    return std::make_unique<CoursesInModel>(effect_, found_.value_or(PointCourses{}));
  }

 private:
  // Of points left out, as those of patterns.
  [[nodiscard]] double gain_of(const std::optional<PointCourses>& courses, const TestedResidual& residual) const {
    return courses ? CourseFit(*courses, fit_.held_out.errors(residual.values)).held_out_gain() : 0.0;
  }

  // Of the squares of the constants, explained by a field over the image.
  [[nodiscard]] double smooth_share_of(const CourseFit& of) const {
    const Eigen::MatrixXd px = fit_.model.in_px(of.constants());
    double smooth = 0.0;
    for (Eigen::Index c = 0; c < px.cols(); ++c)
      smooth += smooth_share(px.col(c), fit_.model.geometry(), true) * px.col(c).squaredNorm();
    return px.squaredNorm() > 0.0 ? smooth / px.squaredNorm() : 1.0;
  }

  const CourseEffect& effect_;
  const FitView fit_;
  std::optional<PointCourses> found_;
  double smooth_ = 0.0;
};

}  // namespace

std::unique_ptr<EffectCandidate> CourseEffect::candidate(const FitView& fit) const {
  return std::make_unique<CourseCandidate>(*this, fit);
}

}  // namespace core::closure
