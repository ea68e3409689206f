#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/closure/observation/effect_in_model.h"
#include "core/closure/observation/fit_view.h"

namespace core::closure {

// The model of the points' positions with its adopted effects, fitted to one record: PointMotionModel, free in every
// frame; patterns as further columns of it; constants by Gauss-Newton steps; lines by themselves; missing samples
// predicted by the model. The points' sigmas are the stated ones for the first solution only; the residual gives the
// noise of each point (point_noise.h), again where an effect that is adopted or reverted changes it.
class ObservationFit {
 public:
  using Effects = std::vector<std::unique_ptr<EffectInModel>>;

  // record: checked, usable points only.
  explicit ObservationFit(ObservationRecord record);

  // All functions below refer to the last solve(), or to the model without effects before it. Throws std::runtime_error
  // if the fit does not stay finite.
  void solve();

  [[nodiscard]] const Effects& effects() const noexcept { return effects_; }  // in the order of adoption
  void add(std::unique_ptr<EffectInModel> effect) { effects_.push_back(std::move(effect)); }
  void remove(std::size_t effect) { effects_.erase(effects_.begin() + static_cast<std::ptrdiff_t>(effect)); }
  [[nodiscard]] Effects copy_effects() const;
  void set_effects(Effects effects) { effects_ = std::move(effects); }

  [[nodiscard]] FitView view() const noexcept {
    return {record_, model_, *held_out_, predicted_px_, readout_frames_, sigma_px_, lens_};
  }
  [[nodiscard]] const ObservationRecord& record() const noexcept { return record_; }
  [[nodiscard]] const PointMotionModel& model() const noexcept { return model_; }
  [[nodiscard]] double readout_frames() const noexcept { return readout_frames_; }
  [[nodiscard]] double sigma_px() const noexcept { return sigma_px_; }  // rms over points, measured
  [[nodiscard]] Eigen::VectorXd mean_places_px() const { return measured_.rowwise().mean(); }
  // Amplitude of an effect's pattern in each frame; empty if it has no pattern.
  [[nodiscard]] Eigen::RowVectorXd amplitude(std::size_t effect) const;
  // Degrees of freedom that effects take from the noise in addition to the model's columns.
  [[nodiscard]] double freedom_beside() const;
  [[nodiscard]] bool hides_noise() const;  // of any adopted effect

 private:
  [[nodiscard]] Eigen::Index amplitude_row(std::size_t effect) const;  // of an effect with a pattern
  void solve_once();
  bool measure_noise();  // false: it is as it was
  [[nodiscard]] CorrelationShares measured_correlation() const;
  void set_columns();
  void set_places(const Eigen::VectorXd& mean_px);
  void fill_missing();
  void sum_constants();  // of all effects: readout time, lens
  // What an adopted lens and pose do to positions in the raw image, undone.
  void undo_optics(const CorrectionView& view, Eigen::MatrixXd& positions) const;
  [[nodiscard]] Eigen::MatrixXd corrected(bool solved);  // solved: with these effects before
  [[nodiscard]] Eigen::VectorXd magnification(const Eigen::VectorXd& places_px) const;
  void remove_second_orders(Eigen::MatrixXd& positions) const;
  bool refine_constants();  // false: no constant changed by more than a twentieth of its sigma

  ObservationRecord record_;                                    // without positions
  std::vector<std::pair<Eigen::Index, Eigen::Index>> missing_;  // row, frame
  Eigen::MatrixXd measured_;  // 2 points x frames, px; missing ones predicted by the model
  PointMotionModel model_;
  std::unique_ptr<HeldOut> held_out_;
  Effects effects_;
  double readout_frames_ = 0.0, sigma_px_ = 0.0;
  LensCoefficients lens_;
  int n_correlations_ = 0;            // measured so far
  Eigen::MatrixXd predicted_px_;      // in the raw image, without the tracker's errors
  Eigen::MatrixXd tracker_error_px_;  // of the adopted effects; empty: none
};

}  // namespace core::closure
