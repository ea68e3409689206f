#include <cmath>

#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/effects/rotation_patterns.h"
#include "core/closure/observation/kinds/line_effect.h"

namespace core::closure {
namespace {

constexpr double kLeastRotorReadout_frames = 0.05;

// Camera rotation caused by the rotors.
class RotorLine final : public LineEffect {
 public:
  [[nodiscard]] EffectId id() const override { return {"rotor_line"}; }
  [[nodiscard]] std::string name() const override { return "rotor line"; }
  [[nodiscard]] bool is_steady() const override { return true; }
  // The patterns are complete if the readout gives rows different phases; otherwise their constant parts are left out,
  // because a translation absorbs them.
  [[nodiscard]] Eigen::MatrixXd patterns(const PointGeometry& geometry, double readout_frames) const override {
    return rotation_patterns(geometry, std::abs(readout_frames) >= kLeastRotorReadout_frames);
  }
};

}  // namespace

std::unique_ptr<ObservationEffect> make_rotor_line() { return std::make_unique<RotorLine>(); }

}  // namespace core::closure
