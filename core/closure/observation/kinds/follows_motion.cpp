#include "core/closure/observation/kinds/follows_motion.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>
#include <vector>

namespace core::closure {
namespace {

constexpr double kFollows = 0.9;         // of the amplitude's variance explained by motions of the model
constexpr double kFollowsRegions = 0.6;  // by those of single regions, of which there are many

// Of the plane and of the regions on the average, with their rates: with a readout a wrong time shows as a motion's
// velocity. Single regions are no motion of the camera: a rotation moves each of them by its own height. What the
// pattern itself moves the columns by is not counted: a strong roll is most of what regions far from the axis do.
Eigen::MatrixXd common_motions(const PointMotionModel& model, const Eigen::VectorXd& whitened,
                               const Eigen::RowVectorXd& amplitude) {
  const Eigen::MatrixXd own = model.amplitudes() - model.amplitudes_of(whitened) * amplitude;
  const Eigen::Index plane = model.first_plane_row(), rows = std::min<Eigen::Index>(3, model.n_own() - plane);
  Eigen::MatrixXd out(2 * (rows + (plane > 0 ? 1 : 0)), model.amplitudes().cols());
  out.topRows(rows) = own.middleRows(plane, rows);
  out.middleRows(rows, rows) = model.rates().middleRows(plane, rows);
  if (plane > 0) {
    out.row(2 * rows) = own.topRows(plane).colwise().mean();
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

// Of the regions in which the pattern is zero, with their rates.
Eigen::MatrixXd motions_elsewhere(const FitView& fit, const Eigen::VectorXd& pattern) {
  std::vector<char> moves(fit.record.regions.size(), 0);
  for (std::size_t j = 0; j < fit.record.region_of_point.size(); ++j) {
    if (!pattern.segment<2>(2 * static_cast<Eigen::Index>(j)).isZero(0.0)) moves[fit.record.region_of_point[j]] = 1;
  }
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < 2 * moves.size(); ++i) {
    if (moves[i / 2] == 0 && fit.model.row_of_region(i) >= 0) rows.push_back(fit.model.row_of_region(i));
  }
  const auto n = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd out(2 * n, fit.model.amplitudes().cols());
  out.topRows(n) = fit.model.amplitudes()(rows, Eigen::all);
  out.bottomRows(n) = fit.model.rates()(rows, Eigen::all);
  return out;
}

// The part of a whitened pattern outside the model's columns, and its amplitude in units of noise.
struct PatternLeft {
  double norm = 0.0;
  Eigen::RowVectorXd amplitude;
};
PatternLeft left_of(const PointMotionModel& model, const Eigen::VectorXd& whitened) {
  const Eigen::VectorXd g = whitened - model.q_low() * (model.q_low().transpose() * whitened);
  if (!(g.norm() > 0.0)) return {};
  return {g.norm(), g.normalized().transpose() * model.residual()};
}

// Is this share of an amplitude in a band, without its noise, explained by the motions?
bool follows(const FitView& fit, Eigen::RowVectorXd a, RungSet band, Eigen::MatrixXd motions, double share) {
  if (band != kAllRungs) {
    const Eigen::MatrixXd cosines = fit.held_out.rungs().cosines(a.size(), band);
    motions = (motions * cosines).eval();
    a = (a * cosines).eval();
  }
  const double signal = a.squaredNorm() - static_cast<double>(a.size());
  return signal > 0.0 && explained_by(std::move(motions), a) > share * signal;
}

}  // namespace

Objection follows_motion(const FitView& fit, const Eigen::VectorXd& whitened, RungSet band) {
  const PatternLeft left = left_of(fit.model, whitened);
  if (!(left.norm > 0.0)) return {};
  const Eigen::MatrixXd motions = common_motions(fit.model, whitened, left.amplitude / left.norm);
  if (!follows(fit, left.amplitude, band, motions, kFollows)) return {};
  return {"its amplitude only follows the motions already in the model", true};
}

Objection follows_regions(const FitView& fit, const Eigen::VectorXd& whitened, RungSet band) {
  const PatternLeft left = left_of(fit.model, whitened);
  if (!(left.norm > 0.0) || !follows(fit, left.amplitude, band, motions_elsewhere(fit, whitened), kFollowsRegions))
    return {};
  return {"its amplitude only follows the motions of other regions", true};
}

}  // namespace core::closure
