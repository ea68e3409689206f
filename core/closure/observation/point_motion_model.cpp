#include "core/closure/observation/point_motion_model.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/closure/observation/product.h"
#include "core/linear/dense.h"

namespace core::closure {
namespace {

constexpr double kLeastNorm = 1e-3;  // smallest norm of a column outside the previous ones; columns below are dropped

// QR factor of columns in their order: orthonormal basis, indices of the independent columns, R of X = Q R.
struct Factor {
  std::vector<Eigen::Index> kept;
  Eigen::MatrixXd q, r;
};

Factor factorise_columns(const Eigen::MatrixXd& x) {
  Factor factor;
  factor.q.resize(x.rows(), 0);
  for (Eigen::Index c = 0; c < x.cols(); ++c) {
    Eigen::VectorXd v = x.col(c);
    const double norm = v.norm();
    for (int twice = 0; twice < 2; ++twice) v -= factor.q * (factor.q.transpose() * v);
    if (!(v.norm() > kLeastNorm * norm)) continue;
    factor.q.conservativeResize(Eigen::NoChange, factor.q.cols() + 1);
    factor.q.col(factor.q.cols() - 1) = v.normalized();
    factor.kept.push_back(c);
  }
  Eigen::MatrixXd kept(x.rows(), factor.q.cols());
  for (Eigen::Index i = 0; i < kept.cols(); ++i) kept.col(i) = x.col(factor.kept[static_cast<std::size_t>(i)]);
  factor.r = factor.q.transpose() * kept;  // upper triangular
  return factor;
}

}  // namespace

PointMotionModel::PointMotionModel(const ObservationRecord& record)
    : rate_hz_(record.rate_hz),
      rungs_(record.rate_hz),
      band_(rungs_.up_to(kLowBand_hz)),
      shift_(record.n_frames()),
      geometry_(point_geometry(record)),
      weight_(2 * record.n_points()),
      n_frames_(record.n_frames()),
      region_row_(2 * record.regions.size(), -1) {
  for (Eigen::Index j = 0; j < record.n_points(); ++j)
    weight_.segment<2>(2 * j).setConstant(1.0 / record.sigma_px[static_cast<std::size_t>(j)]);
  sigma_px_ = weight_.cwiseInverse();
  add_region_columns(record);
  n_region_ = static_cast<Eigen::Index>(own_.size());
  add_plane_columns(record);
  n_own_ = static_cast<Eigen::Index>(own_.size());
  factorise();
}

void PointMotionModel::set_noise(const ObservationRecord& record, PointCorrelation correlation) {
  correlation_ = std::move(correlation);
  for (Eigen::Index j = 0; j < record.n_points(); ++j)
    sigma_px_.segment<2>(2 * j).setConstant(record.sigma_px[static_cast<std::size_t>(j)]);
}

void PointMotionModel::set_places(const ObservationRecord& record, const Eigen::VectorXd& places_px,
                                  const Eigen::VectorXd& magnification) {
  for (Eigen::Index j = 0; j < geometry_.x.size(); ++j) {
    geometry_.x(j) = (places_px(2 * j) - record.cx_px) / record.alpha_px;
    geometry_.y(j) = (places_px(2 * j + 1) - record.cy_px) / record.alpha_px;
    weight_.segment<2>(2 * j) = (magnification(j) * sigma_px_.segment<2>(2 * j)).cwiseInverse();
  }
  own_.clear(), full_.clear(), low_.clear();
  add_region_columns(record);
  add_plane_columns(record);
  factorise();
}

void PointMotionModel::set_added(const std::vector<Eigen::VectorXd>& full, const std::vector<Eigen::VectorXd>& low,
                                 RungSet band) {
  const RungSet wanted = band == 0 ? rungs_.up_to(kLowBand_hz) : band;
  if (low.empty()) cosines_.resize(0, 0);
  if (!low.empty() && (wanted != band_ || cosines_.size() == 0)) cosines_ = rungs_.cosines(n_frames_, wanted);
  band_ = wanted;
  full_ = full;
  low_ = low;
  factorise();
}

void PointMotionModel::factorise() {
  const auto n_full = n_own_ + static_cast<Eigen::Index>(full_.size());
  x_px_.resize(weight_.size(), n_full + static_cast<Eigen::Index>(low_.size()));
  Eigen::Index at = 0;
  for (const auto* list : {&own_, &full_, &low_}) {
    for (const Eigen::VectorXd& field : *list) x_px_.col(at++) = field;
  }
  x_ = whitened(x_px_);
  place_in_readout();
  Factor factor = factorise_columns(x_);
  kept_ = std::move(factor.kept);
  const auto below = [&](Eigen::Index limit) {
    return std::count_if(kept_.begin(), kept_.end(), [&](Eigen::Index c) { return c < limit; });
  };
  own_rank_ = below(n_own_);
  const Eigen::Index n_high = below(n_full), n_extra = factor.q.cols() - n_high;
  q_low_ = std::move(factor.q);
  q_high_ = q_low_.leftCols(n_high);
  extra_ = q_low_.rightCols(n_extra);
  const auto high = factor.r.topLeftCorner(n_high, n_high).triangularView<Eigen::Upper>();
  solve_high_ = high.solve(q_high_.transpose());
  solve_extra_ = factor.r.bottomRightCorner(n_extra, n_extra).triangularView<Eigen::Upper>().solve(extra_.transpose());
  give_back_ = high.solve(factor.r.topRightCorner(n_high, n_extra));
}

void PointMotionModel::place_in_readout() {
  share_.resize(x_.cols());
  for (Eigen::Index c = 0; c < x_.cols(); ++c) {
    double sum = 0.0, weights = 0.0;
    for (Eigen::Index j = 0; j < geometry_.x.size(); ++j) {
      const double w = x_px_.col(c).segment<2>(2 * j).squaredNorm() > 0.0 ? weight_(2 * j) * weight_(2 * j) : 0.0;
      sum += w * geometry_.share(j), weights += w;
    }
    share_(c) = weights > 0.0 ? sum / weights : 0.0;
  }
}

// Writes rows of the independent columns, beginning with the first-th of them, to their places among all columns.
void PointMotionModel::place_rows(const Eigen::MatrixXd& rows, Eigen::Index first, Eigen::MatrixXd& all) const {
  for (Eigen::Index i = 0; i < rows.rows(); ++i) all.row(kept_[static_cast<std::size_t>(first + i)]) = rows.row(i);
}

Eigen::MatrixXd PointMotionModel::amplitudes_of(const Eigen::MatrixXd& whitened) const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(x_.cols(), whitened.cols());
  place_rows(product(solve_high_, whitened), 0, out);
  return out;
}

// Computes the amplitudes of all columns; the remainder is residual_.
void PointMotionModel::fit_columns(const Eigen::MatrixXd& z) {
  common_ = Eigen::MatrixXd::Zero(x_.cols(), z.cols());
  Eigen::MatrixXd high = product(solve_high_, z);
  if (extra_.cols() > 0) {
    const Eigen::MatrixXd extra = solve_extra_ * z * cosines_ * cosines_.transpose();
    high -= give_back_ * extra;
    place_rows(extra, high.rows(), common_);
  }
  place_rows(high, 0, common_);
  residual_ = z;
  add_product(residual_, -1.0, x_, common_);
}

// z: series at the common instants.
void PointMotionModel::fit_common(const Eigen::MatrixXd& z) {
  fit_columns(z);
  aliased_.reset();
  if (readout_frames_ == 0.0) return;
  aliased_.emplace(shift_, AliasedMotion::Columns{*this, x_px_, n_own_, n_region_, share_}, rate_hz_, readout_frames_);
  const Eigen::MatrixXd folded = aliased_->folded(common_, residual_);
  if (folded.size() > 0) fit_columns(z - folded);
  const Eigen::MatrixXd inverse = solve_high_ * solve_high_.transpose();
  Eigen::VectorXd noise = Eigen::VectorXd::Zero(n_own_);
  for (Eigen::Index i = 0; i < own_rank_; ++i) noise(kept_[static_cast<std::size_t>(i)]) = inverse(i, i);
  aliased_->learn_tail(common_, noise, residual_);
}

// Coefficients of orthonormal columns have independent noise of unit variance; amplitudes do not.
void PointMotionModel::estimate_rates() {
  const Eigen::Index n_high = q_high_.cols();
  Eigen::MatrixXd kept(x_.rows(), q_low_.cols()), amplitude(q_low_.cols(), common_.cols());
  for (Eigen::Index i = 0; i < kept.cols(); ++i) {
    const Eigen::Index c = kept_[static_cast<std::size_t>(i)];
    kept.col(i) = x_.col(c), amplitude.row(i) = common_.row(c);
  }
  const Eigen::MatrixXd r = product(q_low_.transpose(), kept);  // upper triangular
  Eigen::MatrixXd rate = shift_.signal_rates(product(r, amplitude), 1.0);
  const auto high = r.topLeftCorner(n_high, n_high).triangularView<Eigen::Upper>();
  const Eigen::Index n_extra = r.cols() - n_high;
  if (n_extra > 0) {
    rate.bottomRows(n_extra) =
        r.bottomRightCorner(n_extra, n_extra).triangularView<Eigen::Upper>().solve(rate.bottomRows(n_extra)).eval();
    rate.topRows(n_high) -= r.topRightCorner(n_high, n_extra) * rate.bottomRows(n_extra);
  }
  rate.topRows(n_high) = high.solve(rate.topRows(n_high)).eval();
  rate_common_ = Eigen::MatrixXd::Zero(x_.cols(), common_.cols());
  place_rows(rate, 0, rate_common_);
}

// Time of the points' rows after the common instant, in frames.
Eigen::VectorXd PointMotionModel::row_instants() const {
  Eigen::VectorXd out(weight_.size());
  for (Eigen::Index i = 0; i < out.size(); ++i) out(i) = readout_frames_ * (geometry_.share(i / 2) - kCommonShare);
  return out;
}

Eigen::VectorXd PointMotionModel::column_instants() const {
  return readout_frames_ * (share_.array() - kCommonShare).matrix();
}

// Velocities of the points' predicted positions at the instants of their own rows, px per frame.
Eigen::MatrixXd PointMotionModel::velocities() const {
  Eigen::MatrixXd out = product(x_px_, rate_common_);
  shift_.advance(out, row_instants());
  return out;
}

Eigen::MatrixXd PointMotionModel::at_common_instants(Eigen::MatrixXd series) const {
  shift_.advance(series, -row_instants());
  return series;
}

Eigen::MatrixXd PointMotionModel::at_own_instants(Eigen::MatrixXd series) const {
  shift_.advance(series, row_instants());
  return series;
}

void PointMotionModel::solve(const Eigen::MatrixXd& positions, double readout_frames, int rounds) {
  readout_frames_ = readout_frames;
  const Eigen::MatrixXd z = positions.colwise() - positions.rowwise().mean();
  fit_common(whitened(at_common_instants(z)));
  estimate_rates();
  for (int round = 0; round < rounds && readout_frames != 0.0 && later_.size() > 0; ++round) {
    Eigen::MatrixXd left = velocities();
    for (Eigen::Index i = 0; i < left.rows(); ++i)
      left.row(i) = z.row(i) - readout_frames * later_.row(i / 2).cwiseProduct(left.row(i));
    left.colwise() -= left.rowwise().mean().eval();
    fit_common(whitened(at_common_instants(std::move(left))));
    estimate_rates();
  }
  if (aliased_) aliased_->weigh(residual_);
  residual_.colwise() -= residual_.rowwise().mean().eval();
  amplitude_ = common_, rate_ = rate_common_;
  shift_.advance(amplitude_, column_instants());
  shift_.advance(rate_, column_instants());
}

Eigen::MatrixXd PointMotionModel::residual_px() const {
  const Eigen::MatrixXd out = at_own_instants(correlation_.put_back(residual_));
  return (out.array().colwise() * sigma_px_.array()).matrix();
}

Eigen::RowVectorXd PointMotionModel::zoom_of_point(Eigen::Index point) const {
  const Eigen::Index row = zoom_row_of(point);
  return row < 0 ? Eigen::RowVectorXd::Zero(amplitude_.cols()).eval() : amplitude_.row(row).eval();
}

double PointMotionModel::sigma_of_column(Eigen::Index column) const {
  const auto at = std::find(kept_.begin(), kept_.end(), column) - kept_.begin();
  if (at >= solve_high_.rows()) return std::numeric_limits<double>::infinity();
  Eigen::RowVectorXd taken = solve_high_.row(at);
  if (extra_.cols() > 0) taken -= give_back_.row(at) * solve_extra_;
  return taken.norm();
}

Eigen::MatrixXd PointMotionModel::translation_of_point(Eigen::Index point) const {
  const Eigen::Index zoom = zoom_row_of(point);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(2, common_.cols());
  for (Eigen::Index c = 0; c < n_own_; ++c) {
    const Eigen::Vector2d field = x_px_.col(c).segment<2>(2 * point);
    if (c != zoom && !field.isZero()) out += field * common_.row(c);
  }
  return out;
}

Eigen::MatrixXd PointMotionModel::readout_field() const {
  Eigen::MatrixXd out = velocities();
  for (Eigen::Index i = 0; i < out.rows(); ++i) {
    Eigen::RowVectorXd share = Eigen::RowVectorXd::Constant(out.cols(), geometry_.share(i / 2) - kCommonShare);
    if (later_.size() > 0) share += later_.row(i / 2);
    out.row(i).array() *= share.array();
  }
  return out;
}

Eigen::MatrixXd PointMotionModel::left_at_common_instants(Eigen::MatrixXd series) const {
  Eigen::MatrixXd left = left_of(whitened(at_common_instants(std::move(series))));
  if (aliased_) aliased_->weigh(left);
  return left;
}

Eigen::MatrixXcd PointMotionModel::left_at(double hz, const Eigen::MatrixXcd& fields) const {
  Eigen::MatrixXcd left = fields - q_high_ * (q_high_.transpose() * fields);
  if (aliased_) aliased_->weigh_at(2.0 * hz / rate_hz_, left);
  return left;
}

Eigen::MatrixXd PointMotionModel::left_of(const Eigen::MatrixXd& values) const {
  Eigen::MatrixXd left = values;
  add_product(left, -1.0, q_high_, product(q_high_.transpose(), values));
  if (extra_.cols() > 0) left -= extra_ * (extra_.transpose() * values * cosines_ * cosines_.transpose());
  left.colwise() -= left.rowwise().mean().eval();
  return left;
}

}  // namespace core::closure
