#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/effects/rotation_patterns.h"

namespace core::closure {
namespace {

// Rotation about the optical axis.
class CameraRoll final : public RotationEffect {
 public:
  [[nodiscard]] EffectId id() const override { return {"camera_roll"}; }
  [[nodiscard]] std::string name() const override { return "camera roll"; }
  [[nodiscard]] Eigen::VectorXd pattern(const ObservationRecord& /*record*/,
                                        const PointGeometry& geometry) const override {
    return roll_pattern(geometry);
  }
  // A narrow band well above the drift, and nothing that stands still: the structure may rock as well.
  [[nodiscard]] std::string not_in(RungSet band, const FitView& fit) const override {
    const Rungs& rungs = fit.held_out.rungs();
    constexpr double kAboveDrift_hz = 1.0, kNarrow_hz = 2.5;
    if (has_background(fit.record) || band == kAllRungs || rungs.lowest_hz(band) < kAboveDrift_hz) return {};
    if (rungs.width_hz(band) > kNarrow_hz) return {};
    return "a resonance, and without a background the structure's rocking cannot be told from the camera's roll";
  }
  [[nodiscard]] Eigen::Vector3d rotation() const override { return {0.0, 0.0, -1.0}; }
};

}  // namespace

std::unique_ptr<ObservationEffect> make_camera_roll() { return std::make_unique<CameraRoll>(); }

}  // namespace core::closure
