#include "core/closure/response/channel_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/closure/noise_stream.h"
#include "core/closure/response/channel_jitter.h"
#include "core/closure/response/effects/catalogue.h"
#include "core/closure/response/jackknife.h"
#include "core/closure/structure_words.h"

namespace core::closure {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kRowsPerRegressor = 6;

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument("response: " + what); }

bool moves(const MatrixXd& value, Index c) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double v : value.col(c)) {
    if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  }
  return high > low;
}

}  // namespace

ChannelModel::ChannelModel(ChannelRecord record, InputUse use) : record_(std::move(record)), use_(use) {
  if (!(record_.rate_hz > 0.0)) refuse("a rate above 0");
  if (record_.value.cols() < 1) refuse("no channel but the input");
  if (record_.input.rows() != record_.value.rows()) record_.input.resize(record_.value.rows(), 0);
  for (Index c = 0; c < record_.value.cols(); ++c) {
    if (!moves(record_.value, c)) refuse("channel " + std::to_string(c + 1) + " does not move; leave it out");
  }
  const Index width = 1 + kOrder * record_.value.cols() + (kOrder + 1) * record_.input.cols();
  Index seen = 0;
  for (Index k = 0; k < record_.n_samples(); ++k) seen += record_.value.row(k).allFinite() ? 1 : 0;
  if (seen < kRowsPerRegressor * width)
    refuse(std::to_string(seen) + " samples are too few for " + std::to_string(record_.value.cols()) + " channels; " +
           std::to_string(kRowsPerRegressor * width) + " are needed, or fewer channels");
}

std::vector<std::string> ChannelModel::effects() const {
  std::vector<std::string> out;
  for (const auto& effect : channel_effects()) {
    if (record_.times_known && effect->is_of_the_clock()) continue;
    if (!effect->adds_input() || (use_ == InputUse::kUnknown && record_.input.cols() > 0))
      out.push_back(effect->name());
  }
  return out;
}

std::vector<NotObservable> ChannelModel::not_observable() const {
  std::vector<NotObservable> out{
      {"clock_rate", "a wrong rate scales every frequency alike", "film a clock, and give --clock"},
      {"codec_period", "a codec adds spectral lines at f_s/GOP and its multiples, like a machine",
       "record uncompressed for a minute, or change the GOP: the line moves with it"},
      {"harmonic",
       "a steady force cannot be distinguished from a lightly damped mode within two minutes "
       "(identify evaluates its decay)",
       "switch the machine off, or record until the width of the mode is resolved"},
      {"folded_mode",
       "without row delays the alias order has no effect on the channels (identify tests it where "
       "delays are known)",
       "film through a rolling shutter of known readout, or at a second rate"},
      {"integrator_bias", "a record does not determine the time step of the simulation that generated it",
       "give the step in --structure (dt_s)"}};
  for (const auto& effect : channel_effects()) {
    if (record_.times_known && effect->is_of_the_clock())
      out.push_back({effect->name(), "the frames' times are known: gaps and repeats are in the record as such",
                     "nothing: compare the times with another clock where they are doubted"});
  }
  if (record_.input.cols() == 0)
    out.push_back({"input_colour",
                   "the input was not measured: its peaks differ from modes only in the motion of the base",
                   "measure the base, and give --input"});
  return out;
}

double ChannelModel::material_share(const std::string& effect) const {
  return channel_effect(effect).adds_input() ? kInputMaterial : 0.0;
}

ChannelModel::Key ChannelModel::key_of(const std::vector<std::string>& effects) const {
  Key out;
  for (const std::string& name : effects) {
    const ChannelEffect& effect = channel_effect(name);
    if (effect.corrects() || effect.adds_input()) out.push_back(name);
  }
  return out;
}

const ChannelModel::Prepared& ChannelModel::prepared(const Key& key) const {
  if (const auto found = prepared_.find(key); found != prepared_.end()) return *found->second;
  auto out = std::make_unique<Prepared>();
  const bool with_input = use_ == InputUse::kKnown || std::any_of(key.begin(), key.end(), [](const std::string& name) {
                            return channel_effect(name).adds_input();
                          });
  out->record = record_;
  if (!with_input) out->record.input.resize(record_.n_samples(), 0);
  const auto fit_again = [&out] {
    out->relative = relative_to_input(out->record);
    out->predictor = fit_predictor(out->relative, kOrder, out->scaled);
  };
  fit_again();
  for (const std::string& name : key) {
    const ChannelEffect& effect = channel_effect(name);
    if (!effect.corrects()) continue;
    out->done.emplace_back();
    if (!out->predictor.ok) continue;
    out->done.back() = effect.corrected({out->record, out->relative, out->scaled, out->predictor});
    out->record = std::move(out->done.back().record);
    fit_again();
  }
  if (out->predictor.ok) {
    out->derivative = frequency_derivative(out->predictor, record_.rate_hz);
    // In the channels' units: the scale factors differ once samples are removed.
    out->log_det =
        out->predictor.whitener.diagonal().array().log().sum() - out->predictor.deviation.array().log().sum();
  }
  return *prepared_.emplace(key, std::move(out)).first->second;
}

MatrixXd ChannelModel::without_course(const Prepared& prepared, const VectorXd& course, const MatrixXd& innovation) {
  const ChannelPredictor& predictor = prepared.predictor;
  constexpr Index kParts = ChannelPredictor::kParts;
  MatrixXd out = innovation;
  if (prepared.derivative.size() == 0 || course.size() != innovation.rows()) return out;
  MatrixXd direction = MatrixXd::Zero(innovation.rows(), innovation.cols());
  VectorXd along = VectorXd::Zero(kParts), size = VectorXd::Zero(kParts);
  VectorXd history(predictor.order * predictor.n_channels);
  for (Index k = predictor.order; k < innovation.rows(); ++k) {
    if (predictor.usable[static_cast<std::size_t>(k)] == 0) continue;
    for (Index i = 0; i < predictor.order; ++i)
      history.segment(i * predictor.n_channels, predictor.n_channels) =
          prepared.scaled.value.row(k - 1 - i).transpose();
    direction.row(k) = course(k) * (prepared.derivative * history).transpose();
    if (predictor.plain[static_cast<std::size_t>(k)] == 0) continue;
    const VectorXd g = predictor.whitener * direction.row(k).transpose();
    const VectorXd e = predictor.whitener * innovation.row(k).transpose();
    along(predictor.part_of(k)) += g.dot(e);
    size(predictor.part_of(k)) += g.squaredNorm();
  }
  if (!(size.sum() > 0.0)) return out;
  for (Index k = 0; k < innovation.rows(); ++k) {
    const Index part = predictor.part_of(k);
    const double left = size.sum() - size(part);
    if (left > 0.0) out.row(k) -= (along.sum() - along(part)) / left * direction.row(k);
  }
  return out;
}

const CourseFit& ChannelModel::fitted_course(const Prepared& prepared, const std::string& effect,
                                             const VectorXd& course) {
  if (const auto found = prepared.course_fit.find(effect); found != prepared.course_fit.end()) return found->second;
  return prepared.course_fit.emplace(effect, fit_course(prepared.relative, kOrder, course)).first->second;
}

ResponseFit ChannelModel::fit(const std::vector<std::string>& effects) const {
  ResponseFit out;
  const Prepared& here = prepared(key_of(effects));
  const Prepared& plain = prepared({});
  const ChannelPredictor& predictor = here.predictor;
  const auto n_channels = static_cast<double>(record_.value.cols());
  if (!predictor.ok) {
    out.heldout_rms = out.residual_rms = std::numeric_limits<double>::infinity();
    out.parameters.resize(effects.size());
    out.implausible.resize(effects.size());
    out.words = "cannot be predicted";
    return out;
  }
  MatrixXd innovation = predictor.innovation;
  bool jitters = false;
  std::size_t place = 0;
  for (const std::string& name : effects) {
    const ChannelEffect& effect = channel_effect(name);
    double value = 0.0;
    std::vector<std::vector<ParameterValue>> others;
    if (effect.corrects()) value = here.done[place].count;
    if (effect.adds_input()) value = predictable_share_of_input();
    if (effect.has_course()) {
      const VectorXd course = effect.course({here.record, here.relative, here.scaled, predictor});
      innovation = without_course(here, course, innovation);
      if (!made_up_) {
        const CourseFit& course_fit = fitted_course(here, name, course);
        value = course_fit.change;
        for (const double change : course_fit.without) others.push_back({effect.describe(change)});
      }
    }
    jitters = jitters || effect.jitters();
    out.parameters.push_back({effect.describe(value)});
    add_jackknife_sigmas(out.parameters.back(), others);
    if (effect.corrects()) out.parameters.back().front().sigma = here.done[place++].sigma;
    out.implausible.push_back(effect.jitters() ? "" : effect.immaterial(value));
    ++out.n_parameters;
  }
  const MatrixXd whitened = innovation * predictor.whitener.transpose();
  VectorXd squares = whitened.rowwise().squaredNorm();
  if (jitters) {
    const JitterFit jitter = fit_jitter(here.scaled, predictor, whitened);
    squares = jitter.squares;
    for (std::size_t e = 0; e < effects.size(); ++e) {
      const ChannelEffect& effect = channel_effect(effects[e]);
      if (!effect.jitters()) continue;
      out.parameters[e] = {effect.describe(jitter.sigma_s)};
      std::vector<std::vector<ParameterValue>> without;
      for (const double sigma_s : jitter.sigma_without_s) without.push_back({effect.describe(sigma_s)});
      add_jackknife_sigmas(out.parameters[e], without);
      out.implausible[e] = effect.immaterial(jitter.sigma_s);
    }
  }
  // Likelihoods with different covariances: squares in units of the first fit, by the ratio of the determinants.
  const double unit = std::exp(2.0 * (plain.log_det - here.log_det) / n_channels);
  const double expected = n_channels * static_cast<double>(record_.n_samples()) / ChannelPredictor::kParts;
  out.fold_squares.assign(ChannelPredictor::kParts, unit * expected);
  for (Index k = 0; k < squares.size(); ++k) {
    if (predictor.usable[static_cast<std::size_t>(k)] != 0)
      out.fold_squares[static_cast<std::size_t>(predictor.part_of(k))] += unit * (squares(k) - n_channels);
  }
  const double n = n_channels * static_cast<double>(record_.n_samples());
  out.heldout_rms = std::sqrt(std::max(out.heldout_squares(), 0.0) / n);
  out.residual_rms = out.heldout_rms;
  out.noise_variance = 1.0;
  out.noise_floor = std::sqrt(unit);
  out.words = "these effects appear in no test of whiteness";
  out.left = "innovations " + number(out.heldout_rms) +
             " of those of the model without effects, as expected of a linear structure under white forces";
  return out;
}

// Share of the input's variance that is predictable from its own past.
double ChannelModel::predictable_share_of_input() const {
  ChannelRecord own{record_.rate_hz, record_.input.leftCols(std::min<Index>(1, record_.input.cols())),
                    MatrixXd(record_.n_samples(), 0)};
  if (own.value.cols() == 0 || !moves(own.value, 0)) return 0.0;
  ChannelRecord scaled;
  const ChannelPredictor predictor = fit_predictor(own, 2 * kOrder, scaled);
  if (!predictor.ok) return 0.0;
  double squares = 0.0, all = 0.0;
  for (Index k = 0; k < scaled.n_samples(); ++k) {
    if (predictor.usable[static_cast<std::size_t>(k)] == 0) continue;
    squares += predictor.innovation.row(k).squaredNorm();
    all += scaled.value.row(k).squaredNorm();
  }
  return all > 0.0 ? std::max(1.0 - squares / all, 0.0) : 0.0;
}

std::unique_ptr<ResponseModel> ChannelModel::surrogate(const std::vector<std::string>& effects,
                                                       std::uint64_t seed) const {
  constexpr double kWild = 1e3;  // in standard deviations; an unstable simulation is restarted at zero
  const Prepared& here = prepared(key_of(effects));
  const ChannelPredictor& predictor = here.predictor;
  NoiseStream noise(seed);
  ChannelRecord made = record_;
  const Index p = predictor.order, n = std::min(record_.n_samples(), here.scaled.n_samples());
  made.value = here.scaled.value.topRows(n);
  made.input = record_.input.topRows(n);
  made.input_alike = false;  // its channels are already relative
  if (!predictor.ok) return std::make_unique<ChannelModel>(record_, use_);
  for (Index k = 0; k < n; ++k) {
    if (!made.value.row(k).allFinite()) made.value.row(k).setZero();
  }
  const MatrixXd shape = predictor.whitener.triangularView<Eigen::Lower>().solve(
      MatrixXd::Identity(predictor.n_channels, predictor.n_channels));
  MatrixXd history(p, predictor.n_channels), input(p + 1, predictor.n_inputs);
  VectorXd draw(predictor.n_channels);
  for (Index k = p; k < n; ++k) {
    for (Index i = 0; i < p; ++i) history.row(i) = made.value.row(k - 1 - i);
    for (Index i = 0; i <= p && predictor.n_inputs > 0; ++i) {
      input.row(i) = here.scaled.input.row(k - i);
      if (!input.row(i).allFinite()) input.row(i).setZero();
    }
    for (double& d : draw) d = noise.gaussian();
    const VectorXd next = predict(predictor, history, input) + shape * draw;
    made.value.row(k) = next.cwiseMax(-kWild).cwiseMin(kWild).transpose();
  }
  auto out = std::make_unique<ChannelModel>(std::move(made), use_);
  out->made_up_ = true;
  return out;
}

}  // namespace core::closure
