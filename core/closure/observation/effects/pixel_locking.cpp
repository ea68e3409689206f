#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/kinds/constant_effect.h"

namespace core::closure {
namespace {

// Tracking error periodic in the sub-pixel phase, two harmonics, equal along both axes. The phase is computed from the
// predicted position, because the measured one contains the error.
class PixelLocking final : public PositionEffect, private InFlightCorrection {
 public:
  [[nodiscard]] EffectId id() const override { return {"pixel_locking"}; }
  [[nodiscard]] std::string name() const override { return "pixel locking"; }
  [[nodiscard]] std::vector<Parameter> constants() const override {
    return {{"sin", 1.0}, {"cos", 1.0}, {"sin 2", 2.0}, {"cos 2", 2.0}};
  }
  [[nodiscard]] std::string unit() const override { return "px"; }
  [[nodiscard]] double most() const override { return 1.0; }
  [[nodiscard]] double step() const override { return 1e-2; }
  [[nodiscard]] CorrectionStage stage() const override { return CorrectionStage::kTracker; }
  void remove(const Eigen::VectorXd& values, const CorrectionView& view, Eigen::MatrixXd& positions) const override {
    for (Eigen::Index k = 0; k < positions.cols(); ++k) {
      for (Eigen::Index i = 0; i < positions.rows(); ++i) {
        const double phase = 2.0 * std::numbers::pi * view.predicted_px(i, k);
        const double sine = std::sin(phase), cosine = std::cos(phase);
        positions(i, k) -= values(0) * sine + values(1) * cosine + values(2) * 2.0 * sine * cosine +
                           values(3) * (cosine - sine) * (cosine + sine);
      }
    }
  }

  [[nodiscard]] const InFlightCorrection* in_flight() const override { return this; }

 private:
  void add_to(RunCorrection& correction, const std::vector<ParameterValue>& parameters,
              const CameraModel& /*camera*/) const override {
    const std::size_t n = std::min(parameters.size(), correction.places.locking_px.size());
    for (std::size_t i = 0; i < n; ++i) correction.places.locking_px[i] = parameters[i].value;
  }
};

}  // namespace

std::unique_ptr<ObservationEffect> make_pixel_locking() { return std::make_unique<PixelLocking>(); }

}  // namespace core::closure
