#include "core/closure/observation/kinds/course_effect.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "core/closure/observation/gaussian_mean.h"
#include "core/closure/observation/kinds/materiality.h"
#include "core/closure/observation/smooth_share.h"

namespace core::closure {
namespace {

constexpr double kMostSmooth = 0.6;
constexpr double kPhaseSigma_s = 0.3;  // of the Gaussian by which a phase is smoothed

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
  void refine(const FitView& fit, const Eigen::RowVectorXd& /*amplitude*/) override {
    const CourseFit more(courses_, fit.model.residual());
    Eigen::MatrixXd change = more.fitted();
    constants_ = constants_.size() > 0 ? (constants_ + more.constants()).eval() : more.constants();
    const double beside =
        1.0 - static_cast<double>(fit.model.q_high().cols()) / static_cast<double>(fit.model.q_high().rows());
    freedom_ = 0.0;
    for (const std::size_t set : courses_.set_of_point)
      freedom_ += 2.0 * beside * static_cast<double>(courses_.sets[set].rows());
    if (effect_.wanders()) change += follow_phase(fit, fit.model.residual() - change);
    const Eigen::MatrixXd px = fit.model.at_own_instants(fit.model.in_px(change));
    motion_px_ = motion_px_.size() > 0 ? (motion_px_ + px).eval() : px;
  }
  [[nodiscard]] double freedom() const override { return freedom_; }
  [[nodiscard]] bool fills_free_motions() const override { return effect_.has_course_of_its_own(); }

 private:
  // The error of the phase in each frame is what the residual holds of the motion a quarter of a period later, of all
  // points together; it is smoothed, because it wanders slowly. Turns the courses; returns what the motion changes by.
  Eigen::MatrixXd follow_phase(const FitView& fit, const Eigen::MatrixXd& residual) {
    std::vector<Eigen::MatrixXd> later;
    for (const Eigen::MatrixXd& course : courses_.sets) {
      Eigen::MatrixXd& turned = later.emplace_back(course.rows(), course.cols());
      turned << -course.row(1), course.row(0);
    }
    Eigen::MatrixXd motion(residual.rows(), residual.cols());
    for (Eigen::Index row = 0; row < motion.rows(); ++row)
      motion.row(row) = constants_.row(row) * later[courses_.set_of_point[static_cast<std::size_t>(row / 2)]];
    const Eigen::MatrixXd &q = fit.model.q_high(), left = motion - q * (q.transpose() * motion);
    const double sigma_frames = kPhaseSigma_s * fit.record.rate_hz;
    const Eigen::RowVectorXd held = gaussian_mean(left.cwiseProduct(residual).colwise().sum(), sigma_frames),
                             squares = gaussian_mean(left.colwise().squaredNorm(), sigma_frames);
    const Eigen::RowVectorXd angle = held.array() / squares.array().max(1e-300);
    for (std::size_t s = 0; s < later.size(); ++s) {
      const Eigen::ArrayXXd now = courses_.sets[s].array(), turned = later[s].array();
      for (Eigen::Index c = 0; c < now.rows(); ++c)
        courses_.sets[s].row(c) = now.row(c) * angle.array().cos() + turned.row(c) * angle.array().sin();
    }
    freedom_ += static_cast<double>(angle.size()) / (2.0 * std::sqrt(std::numbers::pi) * sigma_frames);
    return motion * angle.asDiagonal();
  }

  const CourseEffect& effect_;
  PointCourses courses_;
  Eigen::MatrixXd constants_;  // in sigmas
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
    return courses ? CourseFit(*courses, fit_.held_out.errors_of(residual.values)).held_out_gain() : 0.0;
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
