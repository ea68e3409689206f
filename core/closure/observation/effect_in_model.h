#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/closure/observation/fit_view.h"
#include "core/types/closure_result.h"

namespace core::closure {

// Order in which adopted effects are removed from the measured positions.
enum class CorrectionStage : std::uint8_t {
  kVibration,  // motion of the camera
  kTracker,    // a tracking error: the points are elsewhere than measured
  kLens,       // the image is bent; the coefficients of all effects are undone in one
  kPose,       // the camera does not look along the plane's normal
};

// The course of an adopted pattern in the last solution.
struct PatternCourse {
  Eigen::RowVectorXd amplitude, rate;  // in each frame, at the time of the mean row; its change per frame
  double readout_frames = 0.0;
  double mean_share = 0.0;  // readout fraction of the mean row
};

// What an adopted effect may leave of itself because its form is not exact: so much of its rms, so far beside its band.
struct Leaves {
  double share = 0.05;
  double beside_hz = 0.3;
};

// An adopted effect: its state and its contribution to the model. A subclass overrides the functions of its kind: a
// pattern, constants, or a motion that it estimates itself.
class EffectInModel {
 public:
  EffectInModel(EffectId id, std::string name) : id_(std::move(id)), name_(std::move(name)) {}
  EffectInModel& operator=(const EffectInModel&) = delete;
  virtual ~EffectInModel() = default;
  [[nodiscard]] virtual std::unique_ptr<EffectInModel> clone() const = 0;

  [[nodiscard]] const EffectId& id() const noexcept { return id_; }
  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] virtual EffectKind kind() const { return EffectKind::kNamed; }
  // After a fit. amplitude: of its pattern in each frame; empty for effects without a pattern.
  [[nodiscard]] virtual std::vector<ParameterValue> parameters(const FitView& fit,
                                                               const Eigen::RowVectorXd& amplitude) const = 0;

  // A pattern over the points with an amplitude per frame: px per unit, 2 points long; nullptr: none.
  [[nodiscard]] virtual const Eigen::VectorXd* pattern() const { return nullptr; }
  [[nodiscard]] virtual RungSet band() const { return kAllRungs; }  // in which its amplitude exists
  // Of the points, as the fit changes them.
  virtual void set_places(const ObservationRecord& /*record*/, const PointGeometry& /*geometry*/) {}
  // Of the camera per unit of the amplitude, where the pattern is the first order of a rotation; else zero.
  [[nodiscard]] virtual Eigen::Vector3d rotation() const { return Eigen::Vector3d::Zero(); }
  // Where the pattern is the first order of another motion: removes the difference from undistorted positions
  // (2 points x frames, px), so that the pattern is exact.
  [[nodiscard]] virtual bool has_second_order() const { return false; }
  virtual void remove_second_order(const PatternCourse& /*course*/, const ObservationRecord& /*record*/,
                                   Eigen::MatrixXd& /*positions*/) const {}
  [[nodiscard]] virtual Leaves leaves() const { return {}; }
  // What the effect moves the points by, 2 points x frames in px; amplitude: as for parameters(). Empty: constants.
  [[nodiscard]] virtual Eigen::MatrixXd motion_px(const Eigen::RowVectorXd& amplitude) const {
    return pattern() != nullptr && amplitude.size() > 0 ? (*pattern() * amplitude).eval() : Eigen::MatrixXd();
  }

  // Constants of the record, refined by joint Gauss-Newton steps of all effects. derivatives(): of the prediction,
  // after removal of the model's columns, 2 points x frames in sigmas.
  [[nodiscard]] virtual Eigen::Index n_constants() const { return 0; }
  [[nodiscard]] virtual std::vector<Eigen::MatrixXd> derivatives(const FitView& /*fit*/) const { return {}; }
  // What its constants move the points by, each about its mean place: rms per axis.
  [[nodiscard]] virtual double moves_px(const FitView& /*fit*/) const { return 0.0; }
  virtual void change_constants(const Eigen::VectorXd& /*change*/, const Eigen::MatrixXd& /*covariance*/) {}
  [[nodiscard]] virtual double added_readout_frames() const { return 0.0; }
  [[nodiscard]] virtual LensCoefficients lens() const { return {}; }

  // Removes the effect from positions (2 points x frames, px), if it belongs to this stage.
  virtual void correct(CorrectionStage /*stage*/, const CorrectionView& /*view*/,
                       Eigen::MatrixXd& /*positions*/) const {}

  // True if the effect estimates a motion, a form or constants itself, refined between two solutions of the model.
  [[nodiscard]] virtual bool is_refined() const { return n_constants() > 0; }
  virtual void refine(const FitView& /*fit*/, const Eigen::RowVectorXd& /*amplitude*/) {}  // amplitude: as above
  [[nodiscard]] virtual double freedom() const { return 0.0; }  // taken in addition to the model's columns
  // Takes so much of the noise from the residual that the noise cannot be measured again.
  [[nodiscard]] virtual bool hides_noise() const { return false; }
  // It moves each point by itself: what the points have in common of it remains in the model's free motions, of which
  // nothing else can then be said.
  [[nodiscard]] virtual bool fills_free_motions() const { return hides_noise(); }

 protected:
  EffectInModel(const EffectInModel&) = default;

 private:
  EffectId id_;
  std::string name_;
};

}  // namespace core::closure
