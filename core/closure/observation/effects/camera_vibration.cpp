#include <cmath>

#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/effects/rotation_patterns.h"
#include "core/closure/observation/kinds/line_effect.h"

namespace core::closure {
namespace {

constexpr double kLeastReadout_frames = 0.2;

// Rotation of the camera in a band: a gimbal that rings, an airframe that shakes. Seen at an alias order of 0 by its
// roll alone: the constant parts of pitch and yaw are translations, free in each frame.
class CameraVibration final : public LineEffect {
 public:
  [[nodiscard]] EffectId id() const override { return {"camera_vibration"}; }
  [[nodiscard]] std::string name() const override { return "camera vibration"; }
  [[nodiscard]] bool is_steady() const override { return false; }
  // Complete if the readout gives rows different phases; otherwise without their constant parts, which a translation
  // absorbs.
  [[nodiscard]] Eigen::MatrixXd patterns(const PointGeometry& geometry, double readout_frames) const override {
    return rotation_patterns(geometry, std::abs(readout_frames) >= kLeastReadout_frames);
  }
};

}  // namespace

std::unique_ptr<ObservationEffect> make_camera_vibration() { return std::make_unique<CameraVibration>(); }

}  // namespace core::closure
