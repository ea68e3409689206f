#include "core/closure/observation/kinds/constant_effect.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/closure/observation/kinds/materiality.h"

namespace core::closure {
namespace {

constexpr Eigen::Index kBlocks = 10;

// Attenuation of a wave over the image by the model's position uncertainty: exp(-(2 pi waves sigma)^2 / 2).
double blur(const FitView& fit, double waves_per_px) {
  const Eigen::MatrixXd& q = fit.model.q_high();
  const double share = static_cast<double>(q.cols()) / static_cast<double>(q.rows());
  const double phase = 2.0 * std::numbers::pi * waves_per_px * fit.sigma_px * std::sqrt(share);
  return std::exp(-0.5 * phase * phase);
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
    std::vector<ParameterValue> out;
    for (Eigen::Index p = 0; p < values_.size(); ++p) {
      const ConstantEffect::Parameter& constant = constants[static_cast<std::size_t>(p)];
      const double factor = 1.0 / blur(fit, constant.waves_per_px);
      ParameterValue value{constant.name, effect_.unit(), values_(p) * factor, std::nullopt};
      if (covariance_.size() > 0) value.sigma = std::sqrt(covariance_(p, p)) * std::abs(factor);
      out.push_back(std::move(value));
    }
    return out;
  }
  [[nodiscard]] Eigen::Index n_constants() const override { return values_.size(); }
  [[nodiscard]] std::vector<Eigen::MatrixXd> derivatives(const FitView& fit) const override {
    return effect_.derivatives(values_, fit);
  }
  void change_constants(const Eigen::VectorXd& change, const Eigen::MatrixXd& covariance) override {
    values_ += change;
    for (double& value : values_) value = std::clamp(value, -effect_.most(), effect_.most());
    covariance_ = covariance;
  }
  [[nodiscard]] double added_readout_frames() const override { return effect_.added_readout_frames(values_); }
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
  ConstantCandidate(const ConstantEffect& effect, const FitView& fit)
      : effect_(effect),
        fields_(effect.derivatives(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(effect.n_parameters())), fit)) {
    const auto n = static_cast<Eigen::Index>(fields_.size());
    for (Eigen::Index b = 0; b < kBlocks && n > 0; ++b) {
      Eigen::MatrixXd normal(n, n);
      for (Eigen::Index p = 0; p < n; ++p) {
        for (Eigen::Index q = 0; q <= p; ++q) normal(p, q) = normal(q, p) = product(p, field(q), b);
      }
      normal_.push_back(std::move(normal));
    }
  }
  [[nodiscard]] double gain(const TestedResidual& residual) const override;
  double find(const TestedResidual& residual) override { return gain(residual); }
  [[nodiscard]] double material_share() const override { return kGlobalBar; }
  [[nodiscard]] std::unique_ptr<EffectInModel> adopted() const override {
    return std::make_unique<ConstantsInModel>(effect_);
  }

 private:
  [[nodiscard]] const Eigen::MatrixXd& field(Eigen::Index p) const { return fields_[static_cast<std::size_t>(p)]; }
  // Inner product of a derivative and another field over one block of time.
  [[nodiscard]] double product(Eigen::Index p, const Eigen::MatrixXd& other, Eigen::Index block) const {
    const Eigen::Index frames = other.cols();
    const Eigen::Index from = block * frames / kBlocks, count = (block + 1) * frames / kBlocks - from;
    return field(p).middleCols(from, count).cwiseProduct(other.middleCols(from, count)).sum();
  }

  const ConstantEffect& effect_;
  std::vector<Eigen::MatrixXd> fields_;
  std::vector<Eigen::MatrixXd> normal_;  // per block
};

double ConstantCandidate::gain(const TestedResidual& residual) const {
  const auto n = static_cast<Eigen::Index>(fields_.size());
  std::vector<Eigen::VectorXd> right(static_cast<std::size_t>(kBlocks), Eigen::VectorXd::Zero(n));
  for (Eigen::Index b = 0; b < kBlocks; ++b) {
    for (Eigen::Index p = 0; p < n; ++p) right[static_cast<std::size_t>(b)](p) = product(p, residual.values, b);
  }
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd all = Eigen::VectorXd::Zero(n);
  for (std::size_t b = 0; b < right.size(); ++b) normal += normal_[b], all += right[b];
  double gain = 0.0;
  for (std::size_t b = 0; b < right.size(); ++b) {
    const Eigen::VectorXd values = (normal - normal_[b]).ldlt().solve(all - right[b]);
    if (!values.allFinite()) return 0.0;
    gain += 2.0 * values.dot(right[b]) - values.dot(normal_[b] * values);
  }
  return gain;
}

}  // namespace

std::unique_ptr<EffectCandidate> ConstantEffect::candidate(const FitView& fit) const {
  return std::make_unique<ConstantCandidate>(*this, fit);
}

std::vector<Eigen::MatrixXd> PositionEffect::derivatives(const Eigen::VectorXd& values, const FitView& fit) const {
  std::vector<Eigen::MatrixXd> out;
  const CorrectionView view = fit.correction();
  for (Eigen::Index p = 0; p < values.size(); ++p) {
    Eigen::MatrixXd more = fit.predicted_px, less = more;  // measured positions would add noise to the derivative
    Eigen::VectorXd up = values, down = values;
    up(p) += step(), down(p) -= step();
    remove(up, view, more);
    remove(down, view, less);
    Eigen::MatrixXd field = (less - more) / (2.0 * step());
    // The effect also shifts the mean positions, and the zoom scales this shift.
    for (Eigen::Index j = 0; j < fit.record.n_points(); ++j)
      field.middleRows(2 * j, 2) -= field.middleRows(2 * j, 2).rowwise().mean().eval() * fit.model.zoom_of_point(j);
    field.array().colwise() *= fit.model.weight().array();
    out.push_back(fit.model.left_at_common_instants(std::move(field)));
  }
  return out;
}

}  // namespace core::closure
