#include "core/closure/observation/kinds/constant_effect.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/closure/observation/block_estimates.h"
#include "core/closure/observation/kinds/materiality.h"

namespace core::closure {
namespace {

constexpr double kLeastSigmas = 3.0;

// Attenuation of a wave over the image by the uncertainty of the model's positions: exp(-(2 pi waves sigma)^2 / 2), in
// the weighted mean of the points. A point of weight w has the variance h / w there; the sum of h is the rank.
double blur(const FitView& fit, double waves_per_px) {
  const double variance_px2 = static_cast<double>(fit.model.q_high().cols()) / fit.model.weight().squaredNorm();
  return std::exp(-0.5 * std::pow(2.0 * std::numbers::pi * waves_per_px, 2) * variance_px2);
}

class ConstantsInModel final : public EffectInModel {
 public:
  explicit ConstantsInModel(const ConstantEffect& effect)
      : EffectInModel(effect.id(), effect.name()),
        effect_(effect),
        values_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(effect.n_parameters()))) {}
  [[nodiscard]] std::unique_ptr<EffectInModel> clone() const override {
    return std::make_unique<ConstantsInModel>(*this);
  }
  [[nodiscard]] std::vector<ParameterValue> parameters(const FitView& fit,
                                                       const Eigen::RowVectorXd& /*amplitude*/) const override {
    const std::vector<ConstantEffect::Parameter> constants = effect_.constants();
    const Eigen::VectorXd left_out = effect_.left_out(values_, fit);
    std::vector<ParameterValue> out;
    for (Eigen::Index p = 0; p < values_.size(); ++p) {
      const ConstantEffect::Parameter& constant = constants[static_cast<std::size_t>(p)];
      const double factor = 1.0 / blur(fit, constant.waves_per_px);
      ParameterValue value{constant.name, effect_.unit(), values_(p) * factor, std::nullopt};
      if (covariance_.size() > 0)
        value.sigma = std::hypot(std::sqrt(covariance_(p, p)), left_out(p)) * std::abs(factor);
      out.push_back(std::move(value));
    }
    return out;
  }
  [[nodiscard]] Eigen::Index n_constants() const override { return values_.size(); }
  [[nodiscard]] std::vector<Eigen::MatrixXd> derivatives(const FitView& fit) const override {
    return effect_.derivatives(values_, fit);
  }
  [[nodiscard]] double moves_px(const FitView& fit) const override { return effect_.moves_px(values_, fit); }
  void change_constants(const Eigen::VectorXd& change, const Eigen::MatrixXd& covariance) override {
    values_ += change;
    for (double& value : values_) value = std::clamp(value, -effect_.most(), effect_.most());
    covariance_ = covariance;
  }
  [[nodiscard]] double added_readout_frames() const override { return effect_.added_readout_frames(values_); }
  [[nodiscard]] LensCoefficients lens() const override { return effect_.lens(values_); }
  void correct(CorrectionStage stage, const CorrectionView& view, Eigen::MatrixXd& positions) const override {
    effect_.correct(stage, values_, view, positions);
  }

 private:
  const ConstantEffect& effect_;
  Eigen::VectorXd values_;
  Eigen::MatrixXd covariance_;
};

class ConstantCandidate final : public EffectCandidate {
 public:
  ConstantCandidate(const ConstantEffect& effect, const FitView& fit) : effect_(effect), fit_(fit) {
    std::vector<Eigen::MatrixXd> fields =
        effect.derivatives(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(effect.n_parameters())), fit);
    sigmas_ = BlockEstimates(fields, fit.model.residual()).sigmas_from_zero();
    for (Eigen::MatrixXd& field : fields) {
      error_fields_.emplace_back(fit.held_out.errors(field));
      field.resize(0, 0);
    }
    for (const CompactField& field : error_fields_) fields_.push_back(&field);
  }
  // In squares of points left out, as the scores of patterns.
  [[nodiscard]] double gain(const TestedResidual& residual) const override {
    return BlockEstimates(fields_, fit_.held_out.errors_of(residual.values)).held_out_gain();
  }
  double find(const TestedResidual& residual) override { return gain(residual); }
  [[nodiscard]] double material_share() const override { return kGlobalBar; }
  [[nodiscard]] std::span<const CompactField* const> constant_fields() const override { return fields_; }
  [[nodiscard]] Objection objection(const TestedResidual& /*residual*/) const override {
    if (sigmas_ > kLeastSigmas) return {};
    return {"within three of its own standard deviations of zero", true};
  }
  [[nodiscard]] std::unique_ptr<EffectInModel> adopted() const override {
    return std::make_unique<ConstantsInModel>(effect_);
  }

 private:
  const ConstantEffect& effect_;
  const FitView fit_;
  double sigmas_ = 0.0;                      // from zero, of the fit's own residual
  std::vector<CompactField> error_fields_;   // errors of points left out of the derivatives
  std::vector<const CompactField*> fields_;  // these
};

}  // namespace

std::unique_ptr<EffectCandidate> ConstantEffect::candidate(const FitView& fit) const {
  return std::make_unique<ConstantCandidate>(*this, fit);
}

// Measured positions would add their noise.
Eigen::MatrixXd PositionEffect::predicted_without(const Eigen::VectorXd& values, const CorrectionView& view,
                                                  const FitView& fit) const {
  Eigen::MatrixXd positions = fit.predicted_px;
  remove(values, view, positions);
  return positions;
}

std::vector<Eigen::MatrixXd> PositionEffect::derivatives(const Eigen::VectorXd& values, const FitView& fit) const {
  std::vector<Eigen::MatrixXd> out;
  const CorrectionView view = beside(values, fit.correction());
  const auto stepped = [&](Eigen::Index p, double step) {
    Eigen::VectorXd changed = values;
    changed(p) += step;
    return changed;
  };
  for (Eigen::Index p = 0; p < values.size(); ++p) {
    Eigen::MatrixXd field = predicted_without(stepped(p, -step()), view, fit);
    field -= predicted_without(stepped(p, step()), view, fit);
    field /= 2.0 * step();
    // The effect also shifts the mean positions, and the zoom scales this shift.
    for (Eigen::Index j = 0; j < fit.record.n_points(); ++j)
      field.middleRows(2 * j, 2) -= field.middleRows(2 * j, 2).rowwise().mean().eval() * fit.model.zoom_of_point(j);
    out.push_back(fit.model.left_at_common_instants(std::move(field)));
  }
  return out;
}

double rms_about_means(Eigen::MatrixXd series) {
  series.colwise() -= series.rowwise().mean().eval();
  return std::sqrt(series.cwiseAbs2().mean());
}

double PositionEffect::moves_px(const Eigen::VectorXd& values, const FitView& fit) const {
  return rms_about_means(fit.predicted_px - predicted_without(values, beside(values, fit.correction()), fit));
}

}  // namespace core::closure
