#include "core/closure/observation/gyro_rotation_level.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <utility>

#include "core/closure/observation/residual_rotation.h"
#include "core/geometry/gyro_start.h"
#include "core/types/constants.h"

namespace core::closure {
namespace {

using core::FramePair;
using core::GyroProblem;
using core::GyroSample;
using core::GyroState;
using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kStartRounds = 12, kGyroRounds = 60;
constexpr double kOutlier_sigmas = 5.0, kFocalPerWidth = 0.75;

}  // namespace

const char* GyroRotationLevel::name_of(Effect effect) {
  return effect == Effect::kRotation ? "camera rotation" : "readout time";
}

bool GyroRotationLevel::holds(const std::vector<Effect>& effects, Effect effect) {
  return std::find(effects.begin(), effects.end(), effect) != effects.end();
}

GyroRotationLevel::GyroRotationLevel(std::vector<FramePair> pairs, std::vector<GyroSample> gyro,
                                     const core::GyroReadoutConfig& config)
    : pairs_(std::move(pairs)), gyro_(std::move(gyro)), still_(gyro_), config_(config) {
  core::check_gyro_record(pairs_, gyro_, config_);
  for (GyroSample& sample : still_) sample.rate_rad_s.setZero();
  const std::vector<Effect> all{Effect::kRotation, Effect::kReadout};
  Fitted whole = fit_of(all);
  sigma_px_ = whole.state.sigma_px;
  const GyroProblem problem(pairs_, gyro_, config_);
  const DerotatedFlows flows = problem.flows(whole.state);
  (void)problem.cost(whole.state, flows, true);
  for (std::size_t k = 0; k < flows.size(); ++k) {
    at_rest_.emplace_back();
    for (const DerotatedFlow& flow : flows[k]) {
      const double off = judge(flow, whole.state.shift_px[k], whole.state.model()).across_px;
      at_rest_.back().push_back(std::abs(off) <= kOutlier_sigmas * sigma_px_ ? 1 : 0);
      if (pairs_[k].held_out) n_heldout_ += at_rest_.back().back();
    }
  }
  if (!(n_heldout_ > 0.0))
    throw std::invalid_argument("rotating camera: no held-out frame pair; hold out every fourth");
}

std::vector<GyroRotationLevel::Effect> GyroRotationLevel::open() const {
  std::vector<Effect> out;
  for (const Effect effect : {Effect::kRotation, Effect::kReadout}) {
    if (!holds(adopted_, effect)) out.push_back(effect);
  }
  return out;
}

std::vector<std::string> GyroRotationLevel::candidates() const {
  std::vector<std::string> names;
  for (const Effect effect : open()) names.emplace_back(name_of(effect));
  return names;
}

// Without rotation only translations and the points' sigma are fitted. With rotation and a free readout, the fit starts
// from three readouts and keeps the most likely result.
GyroRotationLevel::Fitted GyroRotationLevel::fit_with(const std::vector<Effect>& effects,
                                                      const std::vector<FramePair>& pairs,
                                                      const std::vector<GyroSample>& gyro, bool brief) const {
  const bool turns = holds(effects, Effect::kRotation);
  const bool reads = turns && holds(effects, Effect::kReadout);
  const double focal_px = config_.focal_px > 0.0 ? config_.focal_px : kFocalPerWidth * config_.width_px;
  Fitted best;
  GyroState start;
  start.p[core::kFocal] = std::log(focal_px);
  start.shift_px.assign(pairs.size(), Vector3d(0.0, 0.0, -1.0));
  if (!turns) {
    for (Index i = 0; i < core::kGyroUnknowns; ++i) best.held.push_back(i);
    best.state = start;
    best.cost = GyroProblem(pairs, still_, config_).minimise(best.held, kStartRounds, best.state);
    return best;
  }
  if (config_.focal_px > 0.0) best.held.push_back(core::kFocal);
  if (!reads) best.held.push_back(core::kReadout);
  const GyroProblem problem(pairs, gyro, config_);
  const core::GyroStart found = core::start_from_turns(pairs, gyro, config_, focal_px);
  start.axes = found.axes;
  const double frame_s = pairs.front().to_s - pairs.front().from_s;
  const std::vector<double> shares = reads && !brief ? std::vector<double>{0.0, -0.6, 0.6} : std::vector<double>{0.0};
  for (const double share : shares) {
    GyroState state = start;
    state.p[core::kReadout] = share * frame_s;
    state.p[core::kOffset] = found.offset_s - 0.5 * share * frame_s;
    const double cost = problem.minimise(best.held, kStartRounds, state);
    if (share == 0.0 || cost < best.cost) best.state = state, best.cost = cost;
  }
  if (!brief) best.cost = problem.minimise(best.held, kGyroRounds, best.state);
  return best;
}

const GyroRotationLevel::Fitted& GyroRotationLevel::fit_of(const std::vector<Effect>& effects) {
  std::optional<Fitted>& known = known_.at(effects.size());
  if (!known) known = fit_with(effects, pairs_, gyro_, false);
  return *known;
}

double GyroRotationLevel::heldout_squares(const Fitted& fitted, const std::vector<Effect>& effects,
                                          const std::vector<FramePair>& pairs,
                                          const std::vector<GyroSample>& gyro) const {
  const GyroProblem problem(pairs, holds(effects, Effect::kRotation) ? gyro : still_, config_);
  GyroState state = fitted.state;
  const DerotatedFlows flows = problem.flows(state);
  (void)problem.cost(state, flows, true);
  double sum = 0.0;
  for (std::size_t k = 0; k < flows.size(); ++k) {
    if (!pairs[k].held_out) continue;
    for (std::size_t j = 0; j < flows[k].size(); ++j) {
      const double off = judge(flows[k][j], state.shift_px[k], state.model()).across_px;
      if (at_rest_[k][j] != 0) sum += off * off;
    }
  }
  return sum;
}

LevelFit GyroRotationLevel::fit() {
  fitted_ = fit_of(adopted_);
  squares_ = heldout_squares(fitted_, adopted_, pairs_, gyro_);
  residual_rotation_deg_ = residual_rotation_deg();
  LevelFit out;
  out.heldout = out.residual_rms = std::sqrt(squares_ / n_heldout_);
  out.noise_floor = sigma_px_;
  out.structured = true;  // surrogates determine what chance can reach
  out.words = "held-out residual is " + std::to_string(out.heldout / sigma_px_) + " of the points' scatter";
  return out;
}

std::vector<CandidateScore> GyroRotationLevel::score() {
  std::vector<CandidateScore> out;
  for (const Effect effect : open()) {
    CandidateScore s;
    s.effect = name_of(effect);
    s.id = {effect == Effect::kRotation ? "camera_rotation" : "readout_time"};
    s.n_parameters = effect == Effect::kRotation ? 7 : 1;
    s.heldout = std::sqrt(squares_ / n_heldout_);
    if (effect == Effect::kReadout && !holds(adopted_, Effect::kRotation)) {
      s.refusal = "acts on rotation, and the model has none";
      out.push_back(std::move(s));
      continue;
    }
    std::vector<Effect> with = adopted_;
    with.push_back(effect);
    const Fitted& fitted = fit_of(with);
    const double squares = heldout_squares(fitted, with, pairs_, gyro_);
    s.heldout = std::sqrt(squares / n_heldout_);
    s.score = (squares_ - squares) / (sigma_px_ * sigma_px_);
    const double frame_s = pairs_.front().to_s - pairs_.front().from_s;
    if (!(s.score > kBar * n_heldout_)) s.refusal = "immaterial";
    if (std::abs(fitted.state.p[core::kReadout]) > 1.1 * frame_s) s.refusal = "longer than a frame";
    out.push_back(std::move(s));
  }
  return out;
}

double GyroRotationLevel::surrogate_score(std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(engine() % n); };
  const bool turns = holds(adopted_, Effect::kRotation);
  std::vector<FramePair> pairs = pairs_;
  std::vector<GyroSample> gyro = gyro_;
  if (turns) {
    for (FramePair& pair : pairs) {
      for (std::size_t i = pair.points.size(); i > 1; --i) {
        core::PointPair &a = pair.points[i - 1], &b = pair.points[below(i)];
        std::swap(a.from_fraction, b.from_fraction);
        std::swap(a.to_fraction, b.to_fraction);
      }
    }
  } else {
    const std::size_t lag = gyro.size() / 10 + below(gyro.size() * 8 / 10);
    for (std::size_t i = 0; i < gyro.size(); ++i) gyro[i].rate_rad_s = gyro_[(i + lag) % gyro.size()].rate_rad_s;
  }
  std::vector<Effect> with = adopted_;
  with.push_back(turns ? Effect::kReadout : Effect::kRotation);
  const double squares = heldout_squares(fit_with(with, pairs, gyro, true), with, pairs, gyro);
  return (squares_ - squares) / (sigma_px_ * sigma_px_);
}

void GyroRotationLevel::adopt(std::size_t candidate) {
  const std::vector<Effect> all = open();
  if (candidate >= all.size()) throw std::invalid_argument("no candidate " + std::to_string(candidate));
  adopted_.push_back(all[candidate]);
}

void GyroRotationLevel::drop() {
  if (adopted_.empty()) throw std::invalid_argument("no adopted effect to revert");
  adopted_.pop_back();
}

core::GyroProblem GyroRotationLevel::problem(const std::vector<Effect>& effects) const {
  return {pairs_, holds(effects, Effect::kRotation) ? gyro_ : still_, config_};
}

std::vector<ParameterValue> GyroRotationLevel::parameters(std::size_t adopted) const {
  const core::GyroMatrix errors = problem(adopted_).covariance(fitted_.state, fitted_.held);
  const auto value = [&](const char* name, const char* unit, Index i, double per_unit) {
    ParameterValue p{name, unit, per_unit * fitted_.state.p[i], {}};
    if (errors(i, i) > 0.0) p.sigma = per_unit * std::sqrt(errors(i, i));
    return p;
  };
  if (adopted_.at(adopted) == Effect::kReadout) return {value("readout", "ms", core::kReadout, 1e3)};
  return {value("clock offset", "ms", core::kOffset, 1e3), value("gyro bias x", "deg/s", core::kBias, kDegPerRad),
          value("gyro bias y", "deg/s", core::kBias + 1, kDegPerRad),
          value("gyro bias z", "deg/s", core::kBias + 2, kDegPerRad)};
}

double GyroRotationLevel::residual_rotation_deg() const {
  const GyroProblem problem = this->problem(adopted_);
  GyroState state = fitted_.state;
  state.sigma_px = sigma_px_;
  const DerotatedFlows flows = problem.flows(state);
  (void)problem.cost(state, flows, true);
  std::vector<ResidualRotation> rotations;
  Matrix3d information = Matrix3d::Zero();
  Vector3d weighted = Vector3d::Zero();
  for (std::size_t k = 0; k < flows.size(); ++k) {
    if (!pairs_[k].held_out) continue;
    std::vector<DerotatedFlow> at_rest;
    for (std::size_t j = 0; j < flows[k].size(); ++j) {
      if (at_rest_[k][j] != 0) at_rest.push_back(flows[k][j]);
    }
    rotations.push_back(residual_rotation(std::move(at_rest), state.model(), state.shift_px[k]));
    information += rotations.back().information;
    weighted += rotations.back().information * rotations.back().rotation;
  }
  const Vector3d mean = information.ldlt().solve(weighted);
  double squares = 0.0;
  for (const ResidualRotation& one : rotations)
    squares += (one.rotation - mean).dot(one.information * (one.rotation - mean));
  return kDegPerRad * std::sqrt(squares / (information.trace() / 3.0));
}

std::string GyroRotationLevel::describe_residual() const {
  return "the image rotates " + std::to_string(residual_rotation_deg_) + " deg rms a frame beyond the model";
}

std::vector<NotObservable> GyroRotationLevel::not_observable() const {
  return {
      {"translation of the camera", "it is free in every frame pair", "declare known lengths, or measure positions"},
      {"lens, focal length", "they are used as declared",
       "calibrate the camera, or estimate the focal length (hovermodal readout)"}};
}

}  // namespace core::closure
