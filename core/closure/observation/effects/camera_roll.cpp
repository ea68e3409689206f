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
  [[nodiscard]] std::string not_in(const PatternGain& found, const ResidualMoments& /*residual*/,
                                   const FitView& fit) const override {
    const RollCourse course = roll_course(fit, found.band);
    if (std::string words = not_of_camera(course, fit); !words.empty()) return words;
    return course.is_vibration() ? "a narrow band above the camera's slow rotation: a vibration" : "";
  }
  [[nodiscard]] Eigen::Vector3d rotation() const override { return {0.0, 0.0, -1.0}; }
};

}  // namespace

std::unique_ptr<ObservationEffect> make_camera_roll() { return std::make_unique<CameraRoll>(); }

}  // namespace core::closure
