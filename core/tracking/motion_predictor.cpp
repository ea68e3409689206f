#include "core/tracking/motion_predictor.h"

#include <algorithm>

namespace core {

namespace {

constexpr double kErrorsKept = 0.9, kEquationsKept = 0.97;  // share of the past that is kept per frame
constexpr double kRidge_px2 = 0.01;                         // steps below a tenth of a px have little weight
constexpr double kClearlyBetter = 0.5;  // error relative to hold: after a jump all rules fail alike, and hold is used
constexpr double kMostStep_px = 100.0;

}  // namespace

void MotionPredictor::update(const Vector2& position, bool after_gap) noexcept {
  if (after_gap) {
    u_.forget_steps();
    v_.forget_steps();
  }
  u_.update(position.u);
  v_.update(position.v);
}

void MotionPredictor::Axis::update(double x) noexcept {
  const double step = x - last_;
  last_ = x;
  n_seen_ = std::min(n_seen_ + 1, 4);
  if (n_seen_ < 2) {
    steps_ = {};
    predicted_ = {};
    return;
  }
  if (n_seen_ == 4) {
    for (std::size_t r = 0; r < kRules; ++r) {
      const double error = step - predicted_[r];
      mean_square_[r] = kErrorsKept * mean_square_[r] + (1.0 - kErrorsKept) * error * error;
    }
    const auto [a, b] = steps_;
    aa_ = kEquationsKept * aa_ + a * a, ab_ = kEquationsKept * ab_ + a * b, bb_ = kEquationsKept * bb_ + b * b;
    a_ = kEquationsKept * a_ + a * step, b_ = kEquationsKept * b_ + b * step;
  }
  steps_ = {step, steps_[0]};
  predict();
}

void MotionPredictor::Axis::predict() noexcept {
  const double aa = aa_ + kRidge_px2, bb = bb_ + kRidge_px2;
  const double determinant = aa * bb - ab_ * ab_;
  const double first = (bb * a_ - ab_ * b_) / determinant, second = (aa * b_ - ab_ * a_) / determinant;
  predicted_ = {0.0, steps_[0], first * steps_[0] + second * steps_[1]};
}

double MotionPredictor::Axis::step() const noexcept {
  if (n_seen_ < 3) return 0.0;
  const auto best = std::min_element(mean_square_.begin(), mean_square_.end()) - mean_square_.begin();
  if (mean_square_[static_cast<std::size_t>(best)] > kClearlyBetter * mean_square_[kStays]) return 0.0;
  return std::clamp(predicted_[static_cast<std::size_t>(best)], -kMostStep_px, kMostStep_px);
}

}  // namespace core
