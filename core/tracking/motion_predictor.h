#pragma once

#include <array>

#include "core/types/vector2.h"

namespace core {

// Predicts the step of a region to the next frame: per axis it uses the rule with the smallest error so far, among
// hold, constant velocity and an autoregression of the steps (order two represents a sinusoid). Constant velocity is
// worse than hold for motion above a sixth of the frame rate. Fixed memory; does not allocate.
class MotionPredictor {
 public:
  // position: in this frame, px. after_gap: frames are missing before it, so that the step is not used.
  void update(const Vector2& position, bool after_gap) noexcept;
  void forget() noexcept { *this = MotionPredictor(); }
  [[nodiscard]] Vector2 step() const noexcept { return {u_.step(), v_.step()}; }

 private:
  class Axis {
   public:
    void update(double x) noexcept;
    void forget_steps() noexcept { n_seen_ = 0; }
    [[nodiscard]] double step() const noexcept;

   private:
    enum Rule { kStays, kGoesOn, kAutoregression, kRules };
    void predict() noexcept;

    double last_ = 0.0;
    std::array<double, 2> steps_{};                              // newest first
    std::array<double, kRules> predicted_{};                     // predictions of the next step
    std::array<double, kRules> mean_square_{};                   // of the rules' errors
    double aa_ = 0.0, ab_ = 0.0, bb_ = 0.0, a_ = 0.0, b_ = 0.0;  // normal equations of the autoregression
    int n_seen_ = 0;                                             // consecutive positions, at most 4
  };
  Axis u_, v_;
};

}  // namespace core
