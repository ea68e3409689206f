#include "core/closure/observation/observation_level.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/closure/effects/registry.h"
#include "core/closure/effects/rotor_line.h"
#include "core/closure/observation/point_screening.h"

namespace core::closure {
namespace {

constexpr int kReadoutRounds = 3, kConstantRounds = 8, kFillRounds = 3, kTurnRounds = 2;
constexpr double kStill = 0.05;  // of its sigma: a constant that has arrived

RecordCheck without_fault(const ObservationRecord& record) {
  RecordCheck check = check_record(record);
  if (check.faults.empty()) return check;
  std::string text = "this record cannot be used at the observation level";
  for (const std::string& fault : check.faults) text += "; " + fault;
  throw std::invalid_argument(text);
}

ObservationRecord checked(const ObservationRecord& record, std::vector<std::string>& warnings) {
  RecordCheck check = without_fault(record);
  ObservationRecord usable = select_points(record, check.points);
  warnings = screen_points(usable);
  if (!warnings.empty()) {
    check = without_fault(usable);
    usable = select_points(usable, check.points);
  }
  warnings.insert(warnings.end(), check.warnings.begin(), check.warnings.end());
  return usable;
}

// Rows 2j, 2j+1 = u, v of point j; gaps by straight lines between what was seen.
Eigen::MatrixXd stacked(const ObservationRecord& record, std::vector<std::pair<Eigen::Index, Eigen::Index>>& missing) {
  Eigen::MatrixXd out(2 * record.n_points(), record.n_frames());
  for (Eigen::Index j = 0; j < record.n_points(); ++j) {
    out.row(2 * j) = record.u_px.col(j).transpose();
    out.row(2 * j + 1) = record.v_px.col(j).transpose();
    for (Eigen::Index k = 0; k < out.cols(); ++k) {
      if (std::isnan(out(2 * j, k)) || std::isnan(out(2 * j + 1, k))) out(2 * j, k) = out(2 * j + 1, k) = std::nan("");
    }
  }
  for (Eigen::Index i = 0; i < out.rows(); ++i) {
    Eigen::Index last = -1;
    for (Eigen::Index k = 0; k <= out.cols(); ++k) {
      if (k < out.cols() && std::isnan(out(i, k))) {
        missing.emplace_back(i, k);
        continue;
      }
      for (Eigen::Index gap = last + 1; gap < k; ++gap) {
        const double before = last >= 0 ? out(i, last) : out(i, k), after = k < out.cols() ? out(i, k) : before;
        const double part = last >= 0 ? static_cast<double>(gap - last) / static_cast<double>(k - last) : 0.0;
        out(i, gap) = before + part * (after - before);
      }
      last = k;
    }
  }
  return out;
}

}  // namespace

ObservationLevel::ObservationLevel(const ObservationRecord& record)
    : record_(checked(record, warnings_)),
      registry_(observation_effects()),
      measured_(stacked(record_, missing_)),
      model_(record_),
      predicted_px_(measured_) {
  double squares = 0.0;
  for (const double sigma : record_.sigma_px) squares += sigma * sigma;
  sigma_px_ = std::sqrt(squares / static_cast<double>(record_.sigma_px.size()));
}

void ObservationLevel::forget(const std::string& effect) {
  std::erase_if(registry_, [&](const ObservationEffect& e) { return e.name == effect; });
}

std::vector<ObservationEffect> ObservationLevel::open() const {
  std::vector<ObservationEffect> out;
  for (const ObservationEffect& effect : registry_) {
    const bool taken = std::any_of(adopted_.begin(), adopted_.end(), [&](const Adopted& a) {
      return a.kind == EffectKind::kNamed && a.effect.name == effect.name;
    });
    if (!taken) out.push_back(effect);
  }
  return out;
}

std::size_t ObservationLevel::n_latent() const {
  return static_cast<std::size_t>(
      std::count_if(adopted_.begin(), adopted_.end(), [](const Adopted& a) { return a.kind == EffectKind::kLatent; }));
}

std::vector<std::string> ObservationLevel::candidates() const {
  std::vector<std::string> names;
  for (const ObservationEffect& effect : open()) names.push_back(effect.name);
  if (n_latent() < kMostLatent) names.push_back("latent " + std::to_string(n_latent() + 1));
  return names;
}

void ObservationLevel::set_columns() {
  std::vector<Eigen::VectorXd> full, low;
  for (Adopted& a : adopted_) {
    if (a.effect.field != nullptr) a.field = a.effect.field(model_.geometry());
    if (a.effect.form == ObservationEffect::Form::kField) (a.low_band ? low : full).push_back(a.field);
  }
  model_.set_added(full, low);
  high_.emplace(model_.q_high());
  low_.emplace(model_.q_low());
}

void ObservationLevel::fill_missing() {
  for (const auto& [row, frame] : missing_)
    measured_(row, frame) = predicted_px_(row, frame) + tracker_error_px_(row, frame);
}

std::vector<Eigen::MatrixXd> ObservationLevel::derivatives_of(const ObservationEffect& effect,
                                                              const Eigen::VectorXd& values) const {
  std::vector<Eigen::MatrixXd> out;
  if (effect.form == ObservationEffect::Form::kReadout) {
    out.push_back(model_.left_of(model_.readout_field()));
    return out;
  }
  const CorrectionView view{record_, predicted_px_};
  for (Eigen::Index p = 0; p < values.size(); ++p) {
    Eigen::MatrixXd more = predicted_px_, less = more;  // noise in them would be taken for the effect
    Eigen::VectorXd up = values, down = values;
    up(p) += effect.step, down(p) -= effect.step;
    effect.correct(up, view, more);
    effect.correct(down, view, less);
    Eigen::MatrixXd field = (less - more) / (2.0 * effect.step);
    // The mean places move as well, and the zoom with them.
    for (Eigen::Index j = 0; j < record_.n_points(); ++j)
      field.middleRows(2 * j, 2) -= field.middleRows(2 * j, 2).rowwise().mean().eval() * model_.zoom_of_point(j);
    field.array().colwise() *= model_.weight().array();
    out.push_back(model_.left_of(field));
  }
  return out;
}

// One Gauss-Newton step of all constants together.
bool ObservationLevel::refine_constants() {
  std::vector<Eigen::MatrixXd> fields;
  for (const Adopted& a : adopted_) {
    if (a.values.size() == 0) continue;
    for (Eigen::MatrixXd& field : derivatives_of(a.effect, a.values)) fields.push_back(std::move(field));
  }
  if (fields.empty()) return false;
  const auto n = static_cast<Eigen::Index>(fields.size());
  Eigen::MatrixXd normal(n, n);
  Eigen::VectorXd right(n);
  for (Eigen::Index a = 0; a < n; ++a) {
    const Eigen::MatrixXd& field = fields[static_cast<std::size_t>(a)];
    right(a) = field.cwiseProduct(model_.residual()).sum();
    for (Eigen::Index b = 0; b <= a; ++b)
      normal(a, b) = normal(b, a) = field.cwiseProduct(fields[static_cast<std::size_t>(b)]).sum();
  }
  const Eigen::MatrixXd covariance = normal.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
  const Eigen::VectorXd change = covariance * right;
  if (!change.allFinite()) return false;
  Eigen::Index at = 0;
  for (Adopted& a : adopted_) {
    const Eigen::Index count = a.values.size();
    if (count == 0) continue;
    a.values += change.segment(at, count);
    for (double& value : a.values) value = std::clamp(value, -a.effect.plausible, a.effect.plausible);
    a.covariance = covariance.block(at, at, count, count);
    at += count;
  }
  return (change.array().square() > kStill * kStill * covariance.diagonal().array()).any();
}

// As the points drift over the lines.
Eigen::MatrixXd ObservationLevel::later_in_readout() const {
  Eigen::MatrixXd later(record_.n_points(), record_.n_frames());
  for (Eigen::Index j = 0; j < later.rows(); ++j) {
    for (Eigen::Index k = 0; k < later.cols(); ++k)
      later(j, k) = record_.readout_share(predicted_px_(2 * j, k), predicted_px_(2 * j + 1, k));
    later.row(j).array() -= later.row(j).mean();
  }
  return later;
}

void ObservationLevel::refine_lines() {
  for (Adopted& a : adopted_) {
    if (a.effect.form != ObservationEffect::Form::kLine) continue;
    const LineSearch search(model_, record_.rate_hz, readout_frames_, rotor_fields(model_.geometry(), readout_frames_),
                            record_.n_frames());
    const Eigen::MatrixXd more = search.motion(model_.residual(), a.line, later_in_readout());
    a.line_motion = a.line_motion.size() > 0 ? (a.line_motion + more).eval() : more;
    a.line_hz = search.frequency(a.line_motion, a.line);
  }
}

LevelFit ObservationLevel::fit() {
  model_.set_places(record_, measured_.rowwise().mean(), magnification(measured_.rowwise().mean()));
  set_columns();
  const bool constants = std::any_of(adopted_.begin(), adopted_.end(), [](const Adopted& a) {
    return a.values.size() > 0 || a.effect.form == ObservationEffect::Form::kLine;
  });
  const bool turns =
      std::any_of(adopted_.begin(), adopted_.end(), [](const Adopted& a) { return !a.effect.turn.isZero(); });
  int rounds = std::max({constants ? kConstantRounds : 1, turns ? kTurnRounds : 1, missing_.empty() ? 1 : kFillRounds});
  for (int round = 0; round <= rounds; ++round) {
    readout_frames_ = record_.readout_frames;
    for (const Adopted& a : adopted_) {
      if (a.effect.form == ObservationEffect::Form::kReadout) readout_frames_ += a.values(0);
    }
    const Eigen::MatrixXd positions = corrected(round > 0);
    if (constants || turns) {
      model_.set_places(record_, positions.rowwise().mean(), magnification(measured_.rowwise().mean()));
      set_columns();
    }
    model_.solve(positions, readout_frames_, kReadoutRounds);
    predicted_px_ = measured_ - model_.residual_px() - tracker_error_px_;
    if (round == rounds) break;
    fill_missing();
    refine_lines();
    if (!refine_constants() && round >= kFillRounds) rounds = round + 1;
  }
  derivatives_.clear();
  trials_.clear();
  modes_.reset();
  const Moments moments = moments_of(model_.residual());
  LevelFit fit;
  fit.heldout = sigma_px_ * std::sqrt((heldout_squares(moments) + 2.0 * line_freedom()) / n_values());
  fit.noise_floor = sigma_px_ * std::sqrt((1.0 - low_share()) * high_->noise_variance() +
                                          low_share() * low_->noise_variance() + line_freedom() / n_values());
  fit.residual_rms = fit.heldout;
  const double excess = fit.heldout / fit.noise_floor;
  fit.structured = true;  // what noise can do is told by the surrogates
  fit.words = "held-out residual is " + std::to_string(excess) + " of the floor of the declared noise";
  if (!std::isfinite(fit.heldout)) throw std::runtime_error("observation level: the fit did not stay finite");
  return fit;
}

// Lines are no columns of the model, which does not count them.
double ObservationLevel::line_freedom() const {
  double sum = 0.0;
  for (const Adopted& a : adopted_) sum += a.line.freedom;
  return sum;
}

void ObservationLevel::adopt(std::size_t candidate) {
  const std::vector<ObservationEffect> named = open();
  if (trials_.empty()) (void)score();
  if (candidate >= trials_.size()) throw std::invalid_argument("no candidate " + std::to_string(candidate));
  Adopted a;
  a.low_band = trials_[candidate].low_band;
  if (candidate < named.size()) {
    a.effect = named[candidate];
    if (a.effect.field != nullptr) a.field = a.effect.field(model_.geometry());
    const bool constants =
        a.effect.form == ObservationEffect::Form::kGlobal || a.effect.form == ObservationEffect::Form::kReadout;
    if (constants) a.values = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(a.effect.parameters.size()));
    a.line = trials_[candidate].line;
  } else {
    a.kind = EffectKind::kLatent;
    a.effect.name = "latent " + std::to_string(n_latent() + 1);
    const Moments moments = moments_of(model_.residual());
    a.field = leading_pattern(a.low_band ? moments.low_sum : moments.all_sum).cwiseQuotient(model_.weight());
    a.field *= std::sqrt(static_cast<double>(a.field.size())) / a.field.norm();  // 1 px rms over the points
  }
  adopted_.push_back(std::move(a));
}

void ObservationLevel::drop() {
  if (adopted_.empty()) throw std::invalid_argument("no adopted effect to revert");
  adopted_.pop_back();
}

}  // namespace core::closure
