#include "core/closure/observation/kinds/follows_motion.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace core::closure {
namespace {

constexpr double kFollows = 0.9;  // of the amplitude's variance explained by motions of the model

// Of the plane and of the regions on the average, with their rates: with a readout a wrong time shows as a motion's
// velocity. Single regions are no motion of the camera: a rotation moves each of them by its own height.
Eigen::MatrixXd common_motions(const PointMotionModel& model) {
  const Eigen::Index plane = model.first_plane_row(), rows = std::min<Eigen::Index>(3, model.n_own() - plane);
  Eigen::MatrixXd out(2 * (rows + (plane > 0 ? 1 : 0)), model.amplitudes().cols());
  out.topRows(rows) = model.amplitudes().middleRows(plane, rows);
  out.middleRows(rows, rows) = model.rates().middleRows(plane, rows);
  if (plane > 0) {
    out.row(2 * rows) = model.amplitudes().topRows(plane).colwise().mean();
    out.row(2 * rows + 1) = model.rates().topRows(plane).colwise().mean();
  }
  return out;
}

// Squares of a that the motions explain, without those that noise gives them.
double explained_by(Eigen::MatrixXd motions, const Eigen::RowVectorXd& a) {
  for (Eigen::Index r = 0; r < motions.rows(); ++r) {
    if (const double norm = motions.row(r).norm(); norm > 0.0) motions.row(r) /= norm;
  }
  Eigen::MatrixXd normal = motions * motions.transpose();
  normal.diagonal().array() += 1e-9;
  const Eigen::VectorXd right = motions * a.transpose();
  return right.dot(normal.ldlt().solve(right)) - static_cast<double>(motions.rows());
}

}  // namespace

Objection follows_motion(const FitView& fit, const Eigen::VectorXd& whitened, RungSet band) {
  const PointMotionModel& model = fit.model;
  const Eigen::VectorXd g = whitened - model.q_low() * (model.q_low().transpose() * whitened);
  if (!(g.norm() > 0.0)) return {};
  Eigen::RowVectorXd a = g.normalized().transpose() * model.residual();
  Eigen::MatrixXd motions = common_motions(model);
  if (band != kAllRungs) {
    const Eigen::MatrixXd cosines = fit.held_out.rungs().cosines(a.size(), band);
    motions = (motions * cosines).eval();
    a = (a * cosines).eval();
  }
  const double signal = a.squaredNorm() - static_cast<double>(a.size());
  if (!(signal > 0.0) || !(explained_by(std::move(motions), a) > kFollows * signal)) return {};
  return {"its amplitude only follows the motions already in the model", true};
}

}  // namespace core::closure
