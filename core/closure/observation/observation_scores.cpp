// How the observation level judges candidates.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "core/closure/effects/registry.h"
#include "core/closure/effects/rotor_line.h"
#include "core/closure/noise_stream.h"
#include "core/closure/observation/observation_level.h"
#include "core/closure/observation/time_filter.h"
#include "core/linear/dense.h"

namespace core::closure {
namespace {

using Form = ObservationEffect::Form;

constexpr double kSignStretch_s = 2.0;

}  // namespace

Eigen::VectorXd leading_pattern(const Eigen::MatrixXd& moments) {
  Eigen::Index start = 0;
  moments.diagonal().maxCoeff(&start);
  Eigen::VectorXd v = moments.col(start);
  for (int step = 0; step < 60 && v.norm() > 0.0; ++step) v = (moments * v.normalized()).eval();
  return v.norm() > 0.0 ? v.normalized().eval() : v;
}

double ObservationLevel::low_share() const {
  return static_cast<double>(model_.cosines().cols()) / static_cast<double>(record_.n_frames());
}

double ObservationLevel::n_values() const {
  return static_cast<double>(high_->n_values()) * static_cast<double>(record_.n_frames());
}

ObservationLevel::Moments ObservationLevel::moments_of(const Eigen::MatrixXd& residual) const {
  Moments m;
  const Eigen::Index n = residual.cols(), rows = residual.rows();
  m.all_sum = m.low_sum = Eigen::MatrixXd::Zero(rows, rows);
  const Eigen::MatrixXd low = low_amplitudes(residual, model_.cosines());
  for (Eigen::Index b = 0; b < kLatentBlocks; ++b) {
    const Eigen::Index from = b * n / kLatentBlocks, to = (b + 1) * n / kLatentBlocks;
    m.all.push_back(gram(residual.middleCols(from, to - from)));
    Eigen::MatrixXd part(rows, 0);
    const Eigen::Index count = (low.cols() - b + kLatentBlocks - 1) / kLatentBlocks;
    part.resize(rows, std::max<Eigen::Index>(count, 0));
    for (Eigen::Index c = 0; c < part.cols(); ++c) part.col(c) = low.col(b + c * kLatentBlocks);
    m.low.emplace_back(gram(part));
    m.all_sum += m.all.back();
    m.low_sum += m.low.back();
  }
  return m;
}

double ObservationLevel::heldout_squares(const Moments& moments) const {
  return high_->squares(moments.all_sum - moments.low_sum) + low_->squares(moments.low_sum);
}

// A pattern with an amplitude per frame, in the band where it does most; gains in noise variances.
ObservationLevel::Trial ObservationLevel::try_field(const Eigen::VectorXd& field, const Moments& moments) const {
  const Eigen::VectorXd w = field.cwiseProduct(model_.weight());
  const auto beside = [&](const Eigen::MatrixXd& q) -> Eigen::VectorXd {
    Eigen::VectorXd g = w - q * (q.transpose() * w);
    return g.norm() > 1e-3 * w.norm() ? g.normalized().eval() : Eigen::VectorXd::Zero(w.size()).eval();
  };
  const Eigen::VectorXd g_low = beside(model_.q_low()), g_high = beside(model_.q_high());
  const Eigen::MatrixXd high = moments.all_sum - moments.low_sum;
  const double gain_low = low_->squares(moments.low_sum) - low_->squares_with(moments.low_sum, g_low);
  const double gain_high = high_->squares(high) - high_->squares_with(high, g_high);
  Trial trial;
  // Both bands only where the upper one, judged on its own, is as good as the bar asks of it.
  trial.low_band = gain_high < kLowBandBar * n_values();
  trial.gain = trial.low_band ? gain_low : gain_low + gain_high;
  return trial;
}

double ObservationLevel::latent_gain(const std::vector<Eigen::MatrixXd>& parts, const Eigen::MatrixXd& sum,
                                     const LeaveOneOut& with) const {
  double gain = 0.0;
  for (const Eigen::MatrixXd& part : parts) {
    const Eigen::VectorXd g = leading_pattern(sum - part);
    gain += with.squares(part) - with.squares_with(part, g);
  }
  return gain;
}

ObservationLevel::Trial ObservationLevel::try_latent(const Moments& moments) const {
  const double full = latent_gain(moments.all, moments.all_sum, *high_);
  const double low = latent_gain(moments.low, moments.low_sum, *low_);
  Trial trial;
  trial.low_band = low >= full;
  trial.gain = std::max(low, full);
  return trial;
}

double ObservationLevel::try_derivatives(const Derivatives& d, const Eigen::MatrixXd& residual) const {
  const auto n = static_cast<Eigen::Index>(d.fields.size());
  std::vector<Eigen::VectorXd> right(static_cast<std::size_t>(kBlocks), Eigen::VectorXd::Zero(n));
  const Eigen::Index frames = residual.cols();
  for (Eigen::Index b = 0; b < kBlocks; ++b) {
    const Eigen::Index from = b * frames / kBlocks, count = (b + 1) * frames / kBlocks - from;
    for (Eigen::Index p = 0; p < n; ++p)
      right[static_cast<std::size_t>(b)](p) = d.fields[static_cast<std::size_t>(p)]
                                                  .middleCols(from, count)
                                                  .cwiseProduct(residual.middleCols(from, count))
                                                  .sum();
  }
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd all = Eigen::VectorXd::Zero(n);
  for (std::size_t b = 0; b < right.size(); ++b) normal += d.normal[b], all += right[b];
  double gain = 0.0;
  for (std::size_t b = 0; b < right.size(); ++b) {
    const Eigen::VectorXd values = (normal - d.normal[b]).ldlt().solve(all - right[b]);
    if (!values.allFinite()) return 0.0;
    gain += 2.0 * values.dot(right[b]) - values.dot(d.normal[b] * values);
  }
  return gain;
}

void ObservationLevel::prepare_candidates() {
  if (!derivatives_.empty()) return;
  for (const ObservationEffect& effect : open()) {
    Derivatives d;
    if (effect.form == Form::kGlobal || effect.form == Form::kReadout)
      d.fields = derivatives_of(effect, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(effect.parameters.size())));
    const auto n = static_cast<Eigen::Index>(d.fields.size());
    const Eigen::Index frames = record_.n_frames();
    for (Eigen::Index b = 0; b < kBlocks && n > 0; ++b) {
      const Eigen::Index from = b * frames / kBlocks, count = (b + 1) * frames / kBlocks - from;
      Eigen::MatrixXd normal(n, n);
      for (Eigen::Index p = 0; p < n; ++p) {
        for (Eigen::Index q = 0; q <= p; ++q)
          normal(p, q) = normal(q, p) = d.fields[static_cast<std::size_t>(p)]
                                            .middleCols(from, count)
                                            .cwiseProduct(d.fields[static_cast<std::size_t>(q)].middleCols(from, count))
                                            .sum();
      }
      d.normal.push_back(std::move(normal));
    }
    derivatives_.push_back(std::move(d));
  }
}

ObservationLevel::Trial ObservationLevel::trial(std::size_t i, const Eigen::MatrixXd& residual,
                                                const Moments& moments) const {
  const ObservationEffect effect = open()[i];
  if (effect.form == Form::kField) return try_field(effect.field(model_.geometry()), moments);
  Trial out;
  if (effect.form == Form::kLine) {
    const LineSearch search(model_, record_.rate_hz, readout_frames_, rotor_fields(model_.geometry(), readout_frames_),
                            record_.n_frames());
    out.line = search.find(residual);
    out.gain = out.line.gain;
  } else {
    out.gain = try_derivatives(derivatives_[i], residual);
  }
  return out;
}

// Does the amplitude only repeat the model's own motions? Then a lens or readout error is behind it, not a rotation.
std::string ObservationLevel::follows_motion(const ObservationEffect& effect, bool low_band) const {
  const Eigen::VectorXd w = effect.field(model_.geometry()).cwiseProduct(model_.weight());
  const Eigen::VectorXd g = w - model_.q_low() * (model_.q_low().transpose() * w);
  if (!(g.norm() > 0.0)) return {};
  Eigen::RowVectorXd a = g.normalized().transpose() * model_.residual();
  // Single regions are no motion of the camera: a turn moves each of them by its own height.
  const Eigen::Index plane = model_.first_plane_row(), rows = std::min<Eigen::Index>(3, model_.n_own() - plane);
  Eigen::MatrixXd motions(2 * (rows + (plane > 0 ? 1 : 0)), record_.n_frames());
  // Their rates too: with a readout a wrong time shows as a motion's velocity.
  motions.topRows(rows) = model_.amplitudes().middleRows(plane, rows);
  motions.middleRows(rows, rows) = model_.rates().middleRows(plane, rows);
  if (plane > 0) {
    motions.row(2 * rows) = model_.amplitudes().topRows(plane).colwise().mean();
    motions.row(2 * rows + 1) = model_.rates().topRows(plane).colwise().mean();
  }
  double noise = static_cast<double>(a.size());
  if (low_band) {
    motions = (motions * model_.cosines()).eval();
    a = (a * model_.cosines()).eval();
    noise = static_cast<double>(a.size());
  }
  for (Eigen::Index r = 0; r < motions.rows(); ++r) {
    if (const double norm = motions.row(r).norm(); norm > 0.0) motions.row(r) /= norm;
  }
  Eigen::MatrixXd normal = motions * motions.transpose();
  normal.diagonal().array() += 1e-9;
  const Eigen::VectorXd right = motions * a.transpose();
  const double explained = right.dot(normal.ldlt().solve(right)) - static_cast<double>(motions.rows());
  const double signal = a.squaredNorm() - noise;
  if (signal > 0.0 && explained > 0.9 * signal) return "its amplitude only follows the motions already in the model";
  return {};
}

std::string ObservationLevel::refusal(const ObservationEffect& effect, const Trial& trial, double latent,
                                      double excess) const {
  const bool field = effect.form == Form::kField;
  const double bar = field ? (trial.low_band ? kLowBandBar : kFullBandBar) : kGlobalBar;
  if (!(trial.gain > bar * n_values())) return "immaterial";
  if (trial.gain < kOfLatent * latent && latent > kLowBandBar * n_values())
    return "a projection of another effect: the best learned pattern explains more";
  if (trial.gain < kOfExcess * excess) return "explains less than a tenth of the structured part";
  if (effect.form == Form::kLine) {
    const LineSearch search(model_, record_.rate_hz, readout_frames_, rotor_fields(model_.geometry(), readout_frames_),
                            record_.n_frames());
    if (trial.gain < kOfLatent * search.pattern_gain(model_.residual(), trial.line))
      return "a projection of another effect: in its band the best learned pattern explains more";
  }
  return field ? follows_motion(effect, trial.low_band) : std::string{};
}

std::vector<CandidateScore> ObservationLevel::score() {
  prepare_candidates();
  const Eigen::MatrixXd& residual = model_.residual();
  const Moments moments = moments_of(residual);
  const std::vector<ObservationEffect> named = open();
  const double squares = heldout_squares(moments) + 2.0 * line_freedom();
  const double floor =
      n_values() * ((1.0 - low_share()) * high_->noise_variance() + low_share() * low_->noise_variance()) +
      line_freedom();
  const Trial latent = try_latent(moments);
  trials_.clear();
  std::vector<CandidateScore> out;
  bool any = false;
  for (std::size_t i = 0; i < named.size(); ++i) {
    trials_.push_back(trial(i, residual, moments));
    CandidateScore s;
    s.effect = named[i].name;
    s.n_parameters = named[i].parameters.size();
    s.score = trials_.back().gain;
    s.heldout = sigma_px_ * std::sqrt(std::max(squares - s.score, 0.0) / n_values());
    s.refusal = refusal(named[i], trials_.back(), latent.gain, squares - floor);
    any = any || s.refusal.empty();
    out.push_back(std::move(s));
  }
  if (n_latent() < kMostLatent) {
    trials_.push_back(latent);
    CandidateScore s;
    s.effect = "latent " + std::to_string(n_latent() + 1);
    s.kind = EffectKind::kLatent;
    s.n_parameters = 1;
    s.score = latent.gain;
    s.heldout = sigma_px_ * std::sqrt(std::max(squares - s.score, 0.0) / n_values());
    if (!(s.score > kFullBandBar * n_values())) s.refusal = "immaterial";
    if (any) s.refusal = "a named effect explains it";
    out.push_back(std::move(s));
  }
  return out;
}

double ObservationLevel::surrogate_score(std::uint64_t seed) {
  prepare_candidates();
  const Eigen::MatrixXd& residual = model_.residual();
  std::mt19937_64 engine(seed);
  const Eigen::Index n = residual.cols();
  Eigen::MatrixXd shifted(residual.rows(), n);
  for (Eigen::Index j = 0; j < residual.rows() / 2; ++j) {
    const auto lag = static_cast<Eigen::Index>(engine() % static_cast<std::uint64_t>(n));
    shifted.middleRows(2 * j, 2).leftCols(n - lag) = residual.middleRows(2 * j, 2).rightCols(n - lag);
    shifted.middleRows(2 * j, 2).rightCols(lag) = residual.middleRows(2 * j, 2).leftCols(lag);
  }
  // A shift alone leaves what is a steady sine in all points coherent: signs by the stretch break it.
  const auto stretch = std::max<Eigen::Index>(8, static_cast<Eigen::Index>(kSignStretch_s * record_.rate_hz));
  for (Eigen::Index j = 0; j < residual.rows() / 2; ++j) {
    for (Eigen::Index from = 0; from < n; from += stretch) {
      if (engine() % 2 == 0) shifted.block(2 * j, from, 2, std::min(stretch, n - from)) *= -1.0;
    }
  }
  Eigen::MatrixXd left = model_.left_of(shifted);
  const double norm = left.norm();
  if (norm > 0.0) left *= residual.norm() / norm;
  const Moments moments = moments_of(left);
  double best = try_latent(moments).gain;
  for (std::size_t i = 0; i < open().size(); ++i) best = std::max(best, trial(i, left, moments).gain);
  return best;
}

}  // namespace core::closure
