#include <vector>

#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/effects/rotation_patterns.h"
#include "core/closure/observation/kinds/family_effect.h"

namespace core::closure {
namespace {

// Regions turn about the upright axis, each by its own share: one side comes nearer, the other goes away. Observable by
// the perspective of wide regions; confused with the camera's yaw, which turns all regions and the background alike.
class Torsion final : public FamilyEffect {
 public:
  [[nodiscard]] EffectId id() const override { return {"torsion"}; }
  [[nodiscard]] std::string name() const override { return "torsion"; }
  // Of each region of the structure.
  [[nodiscard]] Eigen::MatrixXd fields(const ObservationRecord& record, const PointGeometry& geometry) const override {
    const Eigen::VectorXd turn = yaw_pattern(geometry);
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(turn.size(), static_cast<Eigen::Index>(record.regions.size()));
    for (std::size_t j = 0; j < record.region_of_point.size(); ++j) {
      const std::size_t region = record.region_of_point[j];
      if (!makes_channel(record.regions[region].role)) continue;
      const auto row = 2 * static_cast<Eigen::Index>(j);
      all.block<2, 1>(row, static_cast<Eigen::Index>(region)) = turn.segment<2>(row);
    }
    std::vector<Eigen::Index> used;
    for (Eigen::Index c = 0; c < all.cols(); ++c) {
      if (!all.col(c).isZero(0.0)) used.push_back(c);
    }
    return all(Eigen::all, used);
  }
  [[nodiscard]] NotObservable when_absent() const override {
    return {name(), "no region of the structure is seen", "declare the floors"};
  }
};

}  // namespace

std::unique_ptr<ObservationEffect> make_torsion() { return std::make_unique<Torsion>(); }

}  // namespace core::closure
