#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/effects/rotation_patterns.h"

namespace core::closure {
namespace {

// The whole structure turns in its own plane, as about its base. Observable where something else stands still: the same
// turn of everything that is seen is the camera's roll.
class Rocking final : public RotationEffect {
 public:
  [[nodiscard]] EffectId id() const override { return {"rocking"}; }
  [[nodiscard]] std::string name() const override { return "rocking"; }
  [[nodiscard]] Eigen::VectorXd pattern(const ObservationRecord& record, const PointGeometry& geometry) const override {
    Eigen::VectorXd out = roll_pattern(geometry);
    const bool alone = !has_background(record);
    for (std::size_t j = 0; j < record.region_of_point.size(); ++j) {
      if (alone || !makes_channel(record.regions[record.region_of_point[j]].role))
        out.segment<2>(2 * static_cast<Eigen::Index>(j)).setZero();
    }
    return out;
  }
  [[nodiscard]] std::optional<NotObservable> obstacle(const FitView& fit, bool is_adopted) const override {
    if (is_adopted || has_background(fit.record)) return std::nullopt;
    return NotObservable{name(), "without a background the camera's roll moves all that is seen alike",
                         "declare a background"};
  }
};

}  // namespace

std::unique_ptr<ObservationEffect> make_rocking() { return std::make_unique<Rocking>(); }

}  // namespace core::closure
