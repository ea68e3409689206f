#include "core/closure/observation/observation_fit.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/closure/observation/block_estimates.h"
#include "core/closure/observation/noise_correlation.h"
#include "core/closure/observation/point_noise.h"
#include "core/closure/observation/rotation_second_order.h"
#include "core/closure/observation/stacked_positions.h"

namespace core::closure {
namespace {

constexpr int kReadoutRounds = 1, kRefinedRounds = 8, kFillRounds = 3, kRotationRounds = 2;
constexpr double kSameNoise = 0.03;
constexpr int kCorrelations = 2;  // times that the correlation of noise is measured
constexpr double kStill = 0.05;   // of its sigma: a constant that has converged

bool is_banded(const EffectInModel& effect) { return effect.band() != kAllRungs; }

double rms(const std::vector<double>& values) {
  double squares = 0.0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

}  // namespace

ObservationFit::ObservationFit(ObservationRecord record)
    : record_(std::move(record)),
      measured_(stacked_positions(record_, missing_)),
      model_(record_),
      held_out_(std::make_unique<HeldOut>(model_, record_.rate_hz)),
      predicted_px_(measured_) {
  sigma_px_ = rms(record_.sigma_px);
  record_.u_px.resize(record_.n_frames(), 0), record_.v_px.resize(record_.n_frames(), 0);  // they are in measured_
}

ObservationFit::Effects ObservationFit::copy_effects() const {
  Effects out;
  for (const auto& effect : effects_) out.push_back(effect->clone());
  return out;
}

void ObservationFit::set_columns() {
  std::vector<Eigen::VectorXd> full, low;
  RungSet band = 0;
  for (const auto& effect : effects_) {
    effect->set_places(record_, model_.geometry());
    if (effect->pattern() == nullptr) continue;
    (is_banded(*effect) ? low : full).push_back(*effect->pattern());
    if (is_banded(*effect)) band |= effect->band();
  }
  model_.set_added(full, low, band);
}

void ObservationFit::set_places(const Eigen::VectorXd& mean_px) {
  model_.set_places(record_, mean_px, magnification(measured_.rowwise().mean()));
  set_columns();
}

Eigen::Index ObservationFit::amplitude_row(std::size_t effect) const {
  Eigen::Index full = model_.n_own(), low = full;
  for (const auto& other : effects_) low += other->pattern() != nullptr && !is_banded(*other) ? 1 : 0;
  for (std::size_t i = 0; i < effect; ++i) {
    if (effects_[i]->pattern() != nullptr) ++(is_banded(*effects_[i]) ? low : full);
  }
  return is_banded(*effects_[effect]) ? low : full;
}

Eigen::RowVectorXd ObservationFit::amplitude(std::size_t effect) const {
  if (effects_.at(effect)->pattern() == nullptr) return {};
  return model_.amplitudes().row(amplitude_row(effect));
}

double ObservationFit::freedom_beside() const {
  double sum = 0.0;
  for (const auto& effect : effects_) sum += effect->freedom();
  return sum;
}

void ObservationFit::fill_missing() {
  const bool has_error = tracker_error_px_.size() > 0;
  for (const auto& [row, frame] : missing_)
    measured_(row, frame) = predicted_px_(row, frame) + (has_error ? tracker_error_px_(row, frame) : 0.0);
}

void ObservationFit::sum_constants() {
  readout_frames_ = record_.readout_frames;
  lens_ = {};
  for (const auto& effect : effects_) readout_frames_ += effect->added_readout_frames(), lens_ += effect->lens();
}

void ObservationFit::undo_optics(const CorrectionView& view, Eigen::MatrixXd& positions) const {
  undo_lens(lens_, record_, positions);
  for (const auto& effect : effects_) effect->correct(CorrectionStage::kPose, view, positions);
}

// Measured positions corrected for the adopted effects.
Eigen::MatrixXd ObservationFit::corrected(bool solved) {
  Eigen::MatrixXd positions = measured_;
  const CorrectionView view{record_, predicted_px_, lens_};
  const auto correct = [&](CorrectionStage stage) {
    for (const auto& effect : effects_) effect->correct(stage, view, positions);
  };
  correct(CorrectionStage::kVibration);
  tracker_error_px_ = positions;
  correct(CorrectionStage::kTracker);
  tracker_error_px_ -= positions;
  if (tracker_error_px_.isZero(0.0)) tracker_error_px_.resize(0, 0);
  undo_optics(view, positions);
  if (solved) remove_second_orders(positions);
  return positions;
}

// How much the adopted lens and pose stretch the image at the points when they are removed; noise is stretched alike.
Eigen::VectorXd ObservationFit::magnification(const Eigen::VectorXd& places_px) const {
  constexpr double kApart_px = 1.0;
  const Eigen::Index n = places_px.size() / 2;
  Eigen::MatrixXd around(places_px.size(), 4);
  for (Eigen::Index j = 0; j < n; ++j) {
    around.middleRows(2 * j, 2).colwise() = places_px.segment<2>(2 * j);
    around.block<2, 2>(2 * j, 0) += kApart_px * Eigen::Matrix2d::Identity();
    around.block<2, 2>(2 * j, 2) -= kApart_px * Eigen::Matrix2d::Identity();
  }
  undo_optics({record_, predicted_px_, lens_}, around);
  Eigen::VectorXd out(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const Eigen::Matrix2d stretch = (around.block<2, 2>(2 * j, 0) - around.block<2, 2>(2 * j, 2)) / (2.0 * kApart_px);
    const double area = std::abs(stretch.determinant());
    out(j) = area > 0.1 && area < 10.0 ? std::sqrt(area) : 1.0;
  }
  return out;
}

// Of the adopted effects, computed from the amplitudes of the previous solution. Rotations of the camera are removed
// together: the second order of two of them holds their product.
void ObservationFit::remove_second_orders(Eigen::MatrixXd& positions) const {
  Eigen::MatrixXd rotations = Eigen::MatrixXd::Zero(3, positions.cols()), rates = rotations;
  double share = 0.0;
  bool any = false;
  for (std::size_t i = 0; i < effects_.size(); ++i) {
    const Eigen::Vector3d rotation = effects_[i]->rotation();
    if (rotation.isZero() || amplitude_row(i) >= model_.amplitudes().rows()) continue;
    const Eigen::Index row = amplitude_row(i);
    rotations += rotation * model_.amplitudes().row(row);
    rates += rotation * model_.rates().row(row);
    share = model_.share_of_column(row);
    any = true;
  }
  if (any) remove_second_order(record_, model_.geometry(), rotations, rates, readout_frames_, share, positions);
  for (std::size_t i = 0; i < effects_.size(); ++i) {
    if (!effects_[i]->has_second_order() || amplitude_row(i) >= model_.amplitudes().rows()) continue;
    const Eigen::Index row = amplitude_row(i);
    effects_[i]->remove_second_order(
        {model_.amplitudes().row(row), model_.rates().row(row), readout_frames_, model_.share_of_column(row)}, record_,
        positions);
  }
}

// One Gauss-Newton step of all constants together.
bool ObservationFit::refine_constants() {
  std::vector<Eigen::MatrixXd> fields;
  for (const auto& effect : effects_) {
    if (effect->n_constants() == 0) continue;
    for (Eigen::MatrixXd& field : effect->derivatives(view())) fields.push_back(std::move(field));
  }
  if (fields.empty()) return false;
  const BlockEstimates estimates(fields, model_.residual());
  const Eigen::VectorXd change = estimates.values();
  if (!change.allFinite()) return false;
  const Eigen::MatrixXd covariance = estimates.covariance();
  Eigen::Index at = 0;
  for (const auto& effect : effects_) {
    const Eigen::Index count = effect->n_constants();
    if (count == 0) continue;
    effect->change_constants(change.segment(at, count), covariance.block(at, at, count, count));
    at += count;
  }
  return (change.array().square() > kStill * kStill * covariance.diagonal().array()).any();
}

CorrelationShares ObservationFit::measured_correlation() const {
  const PointCorrelation& known = model_.correlation();
  const Eigen::MatrixXd& q = model_.q_high();
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(q.rows(), q.rows());
  const auto removal = known.put_back<Eigen::MatrixXd>((identity - q * q.transpose()) * known.removed(identity));
  return noise_correlation(known.put_back(model_.residual()), removal, record_.region_of_point, mean_places_px(),
                           record_.rate_hz, PointMotionModel::kLowBand_hz);
}

bool ObservationFit::hides_noise() const {
  return std::any_of(effects_.begin(), effects_.end(), [](const auto& effect) { return effect->hides_noise(); });
}

// Scores with different correlations cannot be compared: it is measured in the first solution, as if points were
// independent, and once more without it, and then kept. Sigmas are measured again.
bool ObservationFit::measure_noise() {
  if (hides_noise()) return false;
  const Eigen::VectorXd noise =
      point_noise(model_.residual(), model_.q_high(), record_.rate_hz, PointMotionModel::kLowBand_hz);
  const double change = std::abs(std::sqrt(noise.cwiseAbs2().mean()) - 1.0);
  if (n_correlations_ == kCorrelations && change < kSameNoise) return false;
  for (Eigen::Index j = 0; j < noise.size(); ++j) record_.sigma_px[static_cast<std::size_t>(j)] *= noise(j);
  sigma_px_ = rms(record_.sigma_px);
  if (n_correlations_ < kCorrelations) {
    const CorrelationShares shares = measured_correlation();
    model_.set_noise(record_, PointCorrelation(shares, record_.region_of_point, mean_places_px()));
    n_correlations_ = shares.none() ? kCorrelations : n_correlations_ + 1;
  } else {
    model_.set_noise(record_, model_.correlation());
  }
  return true;
}

void ObservationFit::solve() {
  solve_once();
  do {
    if (!measure_noise()) break;
    solve_once();
  } while (n_correlations_ < kCorrelations);
  held_out_ = std::make_unique<HeldOut>(model_, record_.rate_hz);
}

void ObservationFit::solve_once() {
  set_places(measured_.rowwise().mean());
  const auto any = [&](const auto& holds) { return std::any_of(effects_.begin(), effects_.end(), holds); };
  const bool refined = any([](const auto& effect) { return effect->is_refined(); });
  const bool rotates =
      any([](const auto& effect) { return !effect->rotation().isZero() || effect->has_second_order(); });
  int rounds =
      std::max({refined ? kRefinedRounds : 1, rotates ? kRotationRounds : 1, missing_.empty() ? 1 : kFillRounds});
  for (int round = 0; round <= rounds; ++round) {
    sum_constants();
    const Eigen::MatrixXd positions = corrected(round > 0);
    if (refined || rotates) set_places(positions.rowwise().mean());
    model_.set_drift(later_in_readout(record_, predicted_px_));
    model_.solve(positions, readout_frames_, kReadoutRounds);
    predicted_px_ = measured_ - model_.residual_px();
    if (tracker_error_px_.size() > 0) predicted_px_ -= tracker_error_px_;
    if (round == rounds) break;
    fill_missing();
    for (std::size_t i = 0; i < effects_.size(); ++i) effects_[i]->refine(view(), amplitude(i));
    if (!refine_constants() && round >= kFillRounds) rounds = round + 1;
  }
  if (!model_.residual().allFinite()) throw std::runtime_error("observation level: the fit did not stay finite");
}

}  // namespace core::closure
