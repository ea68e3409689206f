#include "core/closure/observation/rotation_second_order.h"

#include <Eigen/Geometry>

namespace core::closure {

void remove_second_order(const ObservationRecord& record, const PointGeometry& mean, const Eigen::MatrixXd& rotations,
                         const Eigen::MatrixXd& rates, double readout_frames, double mean_share,
                         Eigen::MatrixXd& positions) {
  const double alpha = record.alpha_px;
  for (Eigen::Index k = 0; k < positions.cols(); ++k) {
    for (Eigen::Index j = 0; j < mean.x.size(); ++j) {
      const Eigen::Vector3d w =
          rotations.col(k) + readout_frames * (mean.share(j) - mean_share) * Eigen::Vector3d(rates.col(k));
      const Eigen::Vector3d ray((positions(2 * j, k) - record.cx_px) / alpha,
                                (positions(2 * j + 1, k) - record.cy_px) / alpha, 1.0);
      const Eigen::Vector3d back = ray - w.cross(ray) + 0.5 * w.cross(w.cross(ray));
      const double x = mean.x(j), y = mean.y(j);
      positions(2 * j, k) =
          record.cx_px + alpha * (back.x() / back.z() + w.y() * (1.0 + x * x) - w.z() * y - w.x() * x * y);
      positions(2 * j + 1, k) =
          record.cy_px + alpha * (back.y() / back.z() + w.z() * x - w.x() * (1.0 + y * y) + w.y() * x * y);
    }
  }
}

}  // namespace core::closure
