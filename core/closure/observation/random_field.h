#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/closure/observation/fit_view.h"
#include "core/closure/observation/leave_one_point_out.h"

namespace core::closure {

// A displacement of the image that is random in space and time: Gaussian, both axes alike and independent, covariance
// rms^2 exp(-d / length) between points d apart.
struct FieldSize {
  double length_px = 0.0;
  std::vector<double> variance_px2;  // in each rung of the spectrum, of the whole record; 0: no more than noise there
  double gain = 0.0;                 // decrease of the held-out squares in noise variances
  double rms_sigma_px = 0.0;         // of rms_px()
  double length_factor_sigma = 0.0;  // standard deviation of the length's logarithm
  [[nodiscard]] double rms_px() const;
};

// Such a field beside the motions of a fitted model. Its size is estimated by restricted maximum likelihood (Patterson
// and Thompson 1971) from the residual's second moments, rung by rung, its length on a grid of octaves. Points are left
// out one at a time in closed form (universal kriging, Dubrule 1983). Valid as long as the fit.
class RandomField {
 public:
  static constexpr double kShortest_px = 30.0;  // below, it is the noise of neighbours
  static constexpr std::size_t kOctaves = 6;

  explicit RandomField(const FitView& fit);

  // moments: of a residual of the fit.
  [[nodiscard]] FieldSize size(const ResidualMoments& moments) const;
  // Number of directions among which its squares are divided (participation ratio): 1 for a single pattern.
  [[nodiscard]] double n_patterns(const FieldSize& size, const ResidualMoments& moments) const;
  // Best linear prediction at the points in each frame: 2 points x frames in sigmas, from series in sigmas.
  [[nodiscard]] Eigen::MatrixXd predicted(const FieldSize& size, const Eigen::MatrixXd& series) const;
  [[nodiscard]] double freedom(const FieldSize& size) const;  // that predicted() takes from the noise

 private:
  // Directions beside the model's columns in which the field of one length has independent components.
  struct Components {
    Eigen::MatrixXd direction;  // rows x components, orthonormal
    Eigen::VectorXd variance;   // of a field of 1 px rms, in noise variances
  };
  struct OfLength {
    double length_px = 0.0;
    Components above;
    std::optional<Components> within;  // the band of the model's added columns; empty: it has none
  };
  struct Estimate {
    double variance = 0.0, deviance = 0.0, information = 0.0;
  };

  // Whitened, of a field of 1 px rms.
  [[nodiscard]] Eigen::MatrixXd covariance(double length_px) const;
  [[nodiscard]] static Estimate estimate(const Eigen::VectorXd& own, const Eigen::VectorXd& squares, double n);
  [[nodiscard]] const Components& components(const OfLength& of, std::size_t rung) const;
  [[nodiscard]] bool is_within(std::size_t rung) const noexcept { return within_ && holds(fit_.model.band(), rung); }
  // Variance of the field within a rung, of its own frames only.
  [[nodiscard]] double variance_in(std::size_t rung, const FieldSize& size) const;
  [[nodiscard]] double share_of(std::size_t rung) const;  // of the record's frames
  [[nodiscard]] const OfLength& of(const FieldSize& size) const;
  [[nodiscard]] std::size_t best_length(const ResidualMoments& moments, FieldSize& size) const;

  FitView fit_;
  LeaveOnePointOut above_;
  std::optional<LeaveOnePointOut> within_;
  std::vector<OfLength> lengths_;
};

}  // namespace core::closure
