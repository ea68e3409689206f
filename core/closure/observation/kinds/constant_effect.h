#pragma once

#include "core/closure/observation/effect.h"

namespace core::closure {

// A few constants of the whole record. Scored on one of ten blocks of time, fitted on the other nine
// (block_estimates.h).
class ConstantEffect : public ObservationEffect {
 public:
  struct Parameter {
    std::string name;
    double waves_per_px = 0.0;  // of the image wave that it multiplies: position uncertainty attenuates it
  };
  [[nodiscard]] virtual std::vector<Parameter> constants() const = 0;
  [[nodiscard]] virtual std::string unit() const { return {}; }
  [[nodiscard]] virtual double most() const = 0;  // largest plausible magnitude of a value
  // Derivative of the prediction by each constant at these values, outside the model's columns (2 points x frames,
  // sigmas).
  [[nodiscard]] virtual std::vector<Eigen::MatrixXd> derivatives(const Eigen::VectorXd& values,
                                                                 const FitView& fit) const = 0;
  // What these values move the points by, each about its mean place: rms per axis.
  [[nodiscard]] virtual double moves_px(const Eigen::VectorXd& values, const FitView& fit) const = 0;
  // Standard deviations of the constants by terms of the same cause that the record hardly shows and that are left out.
  [[nodiscard]] virtual Eigen::VectorXd left_out(const Eigen::VectorXd& values, const FitView& /*fit*/) const {
    return Eigen::VectorXd::Zero(values.size());
  }
  [[nodiscard]] virtual double added_readout_frames(const Eigen::VectorXd& /*values*/) const { return 0.0; }
  [[nodiscard]] virtual LensCoefficients lens(const Eigen::VectorXd& /*values*/) const { return {}; }
  virtual void correct(CorrectionStage /*stage*/, const Eigen::VectorXd& /*values*/, const CorrectionView& /*view*/,
                       Eigen::MatrixXd& /*positions*/) const {}

  [[nodiscard]] std::size_t n_parameters() const final { return constants().size(); }
  [[nodiscard]] std::optional<NotObservable> obstacle(const FitView& /*fit*/, bool /*is_adopted*/) const override {
    return std::nullopt;
  }
  [[nodiscard]] std::unique_ptr<EffectCandidate> candidate(const FitView& fit) const final;
};

// Constants that displace the points: derivatives follow from the removal of the effect from positions.
class PositionEffect : public ConstantEffect {
 public:
  [[nodiscard]] virtual CorrectionStage stage() const = 0;
  [[nodiscard]] virtual double step() const = 0;  // of the derivatives: small relative to what is observable
  virtual void remove(const Eigen::VectorXd& values, const CorrectionView& view, Eigen::MatrixXd& positions) const = 0;

  [[nodiscard]] std::vector<Eigen::MatrixXd> derivatives(const Eigen::VectorXd& values, const FitView& fit) const final;
  [[nodiscard]] double moves_px(const Eigen::VectorXd& values, const FitView& fit) const final;
  void correct(CorrectionStage at, const Eigen::VectorXd& values, const CorrectionView& view,
               Eigen::MatrixXd& positions) const override {
    if (at == stage()) remove(values, view, positions);
  }

 protected:
  // The view as it is without these values of the effect itself.
  [[nodiscard]] virtual CorrectionView beside(const Eigen::VectorXd& /*values*/, CorrectionView view) const {
    return view;
  }

 private:
  [[nodiscard]] Eigen::MatrixXd predicted_without(const Eigen::VectorXd& values, const CorrectionView& view,
                                                  const FitView& fit) const;
};

// Of all rows of a matrix, each about its own mean.
[[nodiscard]] double rms_about_means(Eigen::MatrixXd series);

}  // namespace core::closure
