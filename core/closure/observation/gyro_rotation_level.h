#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/closure/closure_level.h"
#include "core/geometry/gyro_problem.h"

namespace core::closure {

// Observation level of a camera that rotates and carries a gyro: the model predicts the points of one frame in the
// next. Without effects the model is a global shutter that does not rotate: all motion is a camera translation, free in
// each frame pair, and the residual is the distance of points from their epipolar lines. Effects, fitted by
// core/geometry/gyro_problem.h: the camera rotates as the gyro measures (axes, clock offset and bias are fitted); rows
// are read one after the other. Whole frame pairs are held out: they are excluded from the fit; only their own camera
// translation is estimated.
// Score: decrease of the held-out squares over the variance of a point, summed over the points within five standard
// deviations in the model with all effects; other points are taken to move by themselves.
// Surrogates: the gyro record, rotated circularly in time; readout fractions permuted among the points of a pair.
class GyroRotationLevel final : public ClosureLevel {
 public:
  static constexpr double kBar = 0.003;  // smallest score per held-out point, as for constants of the record

  // Throws the exceptions of core::fit_gyro_readout().
  GyroRotationLevel(std::vector<core::FramePair> pairs, std::vector<core::GyroSample> gyro,
                    const core::GyroReadoutConfig& config);

  [[nodiscard]] std::string name() const override { return "observation"; }
  [[nodiscard]] std::string unit() const override { return "px"; }
  [[nodiscard]] std::vector<NotObservable> not_observable() const override;
  [[nodiscard]] std::vector<std::string> candidates() const override;
  LevelFit fit() override;
  [[nodiscard]] std::vector<CandidateScore> score() override;
  [[nodiscard]] double surrogate_score(std::uint64_t seed) override;
  void adopt(std::size_t candidate) override;
  void drop() override;
  [[nodiscard]] std::vector<ParameterValue> parameters(std::size_t adopted) const override;
  [[nodiscard]] std::vector<std::string> rivals(std::size_t, std::uint64_t) override { return {}; }
  [[nodiscard]] std::vector<ClosureMode> modes() const override { return {}; }
  // Degrees rms per frame pair and axis: image rotation that the model leaves in the held-out pairs, estimated from the
  // image alone and weighted by information; the mean is removed, because a steady translation biases it.
  [[nodiscard]] std::optional<double> reference_error() const override { return residual_rotation_deg_; }
  [[nodiscard]] std::string reference_unit() const override { return "deg a frame"; }
  [[nodiscard]] std::string describe_residual() const override;

 private:
  enum class Effect : std::uint8_t { kRotation, kReadout };
  struct Fitted {
    core::GyroState state;
    double cost = 0.0;
    std::vector<Eigen::Index> held;
  };
  [[nodiscard]] std::vector<Effect> open() const;
  [[nodiscard]] static const char* name_of(Effect effect);
  [[nodiscard]] static bool holds(const std::vector<Effect>& effects, Effect effect);
  // brief: one start and few iterations.
  [[nodiscard]] Fitted fit_with(const std::vector<Effect>& effects, const std::vector<core::FramePair>& pairs,
                                const std::vector<core::GyroSample>& gyro, bool brief) const;
  [[nodiscard]] const Fitted& fit_of(const std::vector<Effect>& effects);  // on the record, fitted once per set
  [[nodiscard]] double heldout_squares(const Fitted& fitted, const std::vector<Effect>& effects,
                                       const std::vector<core::FramePair>& pairs,
                                       const std::vector<core::GyroSample>& gyro) const;
  [[nodiscard]] core::GyroProblem problem(const std::vector<Effect>& effects) const;
  [[nodiscard]] double residual_rotation_deg() const;

  std::vector<core::FramePair> pairs_;
  std::vector<core::GyroSample> gyro_, still_;  // still_: gyro samples without rotation
  core::GyroReadoutConfig config_;
  double sigma_px_ = 0.0;                   // of a point, in the model with all effects
  std::vector<std::vector<char>> at_rest_;  // per pair and point
  double n_heldout_ = 0.0;                  // number of static points in held-out pairs
  std::vector<Effect> adopted_;
  std::array<std::optional<Fitted>, 3> known_;  // by number of effects: readout is tested only after rotation
  Fitted fitted_;
  double squares_ = 0.0, residual_rotation_deg_ = 0.0;
};

}  // namespace core::closure
