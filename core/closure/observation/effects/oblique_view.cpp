#include <Eigen/Geometry>

#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/kinds/constant_effect.h"
#include "core/types/constants.h"

namespace core::closure {
namespace {

// The camera does not look along the normal of the structure's plane: turned back by these angles, its image is that of
// a camera that does, and all motions of the model hold in it exactly. Observable where the camera or the structure
// moves, by the perspective of that motion; confused with tangential distortion, whose field agrees with it to first
// order along one axis.
class ObliqueView final : public PositionEffect {
 public:
  [[nodiscard]] EffectId id() const override { return {"oblique_view"}; }
  [[nodiscard]] std::string name() const override { return "oblique view"; }
  [[nodiscard]] std::vector<Parameter> constants() const override { return {{"pitch"}, {"yaw"}}; }
  [[nodiscard]] std::string unit() const override { return "deg"; }
  [[nodiscard]] double most() const override { return 50.0; }
  [[nodiscard]] double step() const override { return 0.1; }
  [[nodiscard]] CorrectionStage stage() const override { return CorrectionStage::kPose; }
  void remove(const Eigen::VectorXd& values, const CorrectionView& view, Eigen::MatrixXd& positions) const override {
    const ObservationRecord& record = view.record;
    const Eigen::Matrix3d back = (Eigen::AngleAxisd(values(0) / kDegPerRad, Eigen::Vector3d::UnitX()) *
                                  Eigen::AngleAxisd(values(1) / kDegPerRad, Eigen::Vector3d::UnitY()))
                                     .toRotationMatrix();
    const Eigen::Vector2d centre(record.cx_px, record.cy_px);
    for (Eigen::Index k = 0; k < positions.cols(); ++k) {
      for (Eigen::Index j = 0; j < positions.rows() / 2; ++j) {
        auto at = positions.block<2, 1>(2 * j, k);
        at = centre + record.alpha_px * (back * ((at - centre) / record.alpha_px).homogeneous()).hnormalized();
      }
    }
  }
};

}  // namespace

std::unique_ptr<ObservationEffect> make_oblique_view() { return std::make_unique<ObliqueView>(); }

}  // namespace core::closure
