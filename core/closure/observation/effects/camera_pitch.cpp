#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/effects/rotation_patterns.h"

namespace core::closure {
namespace {

// Camera rotation about the horizontal image axis: its quadratic part.
class CameraPitch final : public RotationEffect {
 public:
  [[nodiscard]] EffectId id() const override { return {"camera_pitch"}; }
  [[nodiscard]] std::string name() const override { return "camera pitch"; }
  [[nodiscard]] Eigen::VectorXd pattern(const ObservationRecord& /*record*/,
                                        const PointGeometry& geometry) const override {
    return pitch_pattern(geometry);
  }
  [[nodiscard]] Eigen::Vector3d rotation() const override { return {-1.0, 0.0, 0.0}; }
};

}  // namespace

std::unique_ptr<ObservationEffect> make_camera_pitch() { return std::make_unique<CameraPitch>(); }

}  // namespace core::closure
