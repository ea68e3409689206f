#include <cmath>

#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/effects/rotation_patterns.h"
#include "core/closure/observation/kinds/line_effect.h"

namespace core::closure {
namespace {

constexpr double kLeastVibrationReadout_frames = 0.05;

// Camera rotation in a frequency band, e.g. gimbal resonance or airframe vibration. At alias order 0 only roll is
// observable: the constant parts of pitch and yaw are translations, which are free in each frame.
class CameraVibration final : public LineEffect {
 public:
  [[nodiscard]] EffectId id() const override { return {"camera_vibration"}; }
  [[nodiscard]] std::string name() const override { return "camera vibration"; }
  [[nodiscard]] bool is_steady() const override { return false; }
  // The patterns are complete if the readout gives rows different phases; otherwise their constant parts are left out,
  // because a translation absorbs them.
  [[nodiscard]] Eigen::MatrixXd patterns(const PointGeometry& geometry, double readout_frames) const override {
    return rotation_patterns(geometry, std::abs(readout_frames) >= kLeastVibrationReadout_frames);
  }
};

}  // namespace

std::unique_ptr<ObservationEffect> make_camera_vibration() { return std::make_unique<CameraVibration>(); }

}  // namespace core::closure
