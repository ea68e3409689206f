#include <cmath>

#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/effects/rotation_patterns.h"
#include "core/closure/observation/kinds/line_effect.h"

namespace core::closure {
namespace {

constexpr double kLeastReadout_frames = 0.2;

// Rotation of the camera by its rotors.
class RotorLine final : public LineEffect {
 public:
  [[nodiscard]] EffectId id() const override { return {"rotor_line"}; }
  [[nodiscard]] std::string name() const override { return "rotor line"; }
  // Complete if the readout gives rows different phases; otherwise without their constant parts, which a translation
  // absorbs.
  [[nodiscard]] Eigen::MatrixXd patterns(const PointGeometry& geometry, double readout_frames) const override {
    Eigen::MatrixXd out(2 * geometry.x.size(), 3);
    out.col(0) = roll_pattern(geometry);
    out.col(1) = pitch_pattern(geometry);
    out.col(2) = yaw_pattern(geometry);
    if (std::abs(readout_frames) < kLeastReadout_frames) return out;
    for (Eigen::Index j = 0; j < geometry.x.size(); ++j) {
      out(2 * j + 1, 1) += geometry.alpha_px;
      out(2 * j, 2) -= geometry.alpha_px;
    }
    return out;
  }
};

}  // namespace

std::unique_ptr<ObservationEffect> make_rotor_line() { return std::make_unique<RotorLine>(); }

}  // namespace core::closure
