#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/effects/rotation_patterns.h"

namespace core::closure {
namespace {

// Camera rotation about the vertical image axis: its quadratic part.
class CameraYaw final : public RotationEffect {
 public:
  [[nodiscard]] EffectId id() const override { return {"camera_yaw"}; }
  [[nodiscard]] std::string name() const override { return "camera yaw"; }
  [[nodiscard]] Eigen::VectorXd pattern(const ObservationRecord& /*record*/,
                                        const PointGeometry& geometry) const override {
    return yaw_pattern(geometry);
  }
  [[nodiscard]] Eigen::Vector3d rotation() const override { return {0.0, -1.0, 0.0}; }
};

}  // namespace

std::unique_ptr<ObservationEffect> make_camera_yaw() { return std::make_unique<CameraYaw>(); }

}  // namespace core::closure
