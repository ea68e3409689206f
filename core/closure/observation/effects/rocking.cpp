#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/effects/rotation_patterns.h"

namespace core::closure {
namespace {

constexpr double kRolls = 0.9;  // of its gain: a roll of the camera that explains so much is as likely

// The whole structure turns in its own plane about its base. Confused with the camera's roll: distinguished from it by
// a background that stands still, or else, where the turn is a resonance, by the base, which a roll would move.
class Rocking final : public RotationEffect {
 public:
  [[nodiscard]] EffectId id() const override { return {"rocking"}; }
  [[nodiscard]] std::string name() const override { return "rocking"; }
  [[nodiscard]] Eigen::VectorXd pattern(const ObservationRecord& record, const PointGeometry& geometry) const override {
    Eigen::VectorXd out = roll_pattern(geometry);
    for (std::size_t j = 0; j < record.region_of_point.size(); ++j) {
      if (!makes_channel(record.regions[record.region_of_point[j]].role))
        out.segment<2>(2 * static_cast<Eigen::Index>(j)).setZero();
    }
    return out;
  }
  [[nodiscard]] std::string not_in(const PatternGain& found, const ResidualMoments& residual,
                                   const FitView& fit) const override {
    if (has_background(fit.record)) {
      const Eigen::VectorXd roll = fit.model.whitened(roll_pattern(fit.model.geometry()));
      const double of_roll = fit.held_out.of_pattern(pattern_beside(fit.model, roll), residual).gain;
      return of_roll > kRolls * found.gain ? "the background turns as well: the camera's roll explains as much" : "";
    }
    const RollCourse course = roll_course(fit, found.band);
    if (course.is_resonance() && course.is_about_base()) return {};
    return "without a background it cannot be distinguished from the camera's roll";
  }
};

}  // namespace

std::unique_ptr<ObservationEffect> make_rocking() { return std::make_unique<Rocking>(); }

}  // namespace core::closure
