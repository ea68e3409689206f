// What the observation level says of its fit.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/closure/effects/registry.h"
#include "core/closure/observation/latent_words.h"
#include "core/closure/observation/observation_level.h"

namespace core::closure {
namespace {

using Form = ObservationEffect::Form;

double rms(const Eigen::RowVectorXd& a) {
  return a.size() > 0 ? std::sqrt((a.array() - a.mean()).square().mean()) : 0.0;
}

}  // namespace

std::vector<NotObservable> ObservationLevel::not_observable() const {
  std::vector<NotObservable> out = never_observable();
  if (model_.readout_field().norm() <= 1e-9 * std::sqrt(n_values()))
    out.push_back(
        {"readout time", "no motion across the lines of the sensor", "film an object that moves over more rows"});
  for (const ObservationEffect& effect : open()) {
    if (effect.form != Form::kField) continue;
    const Eigen::VectorXd w = effect.field(model_.geometry()).cwiseProduct(model_.weight());
    const double left = (w - model_.q_high() * (model_.q_high().transpose() * w)).norm();
    if (left <= 1e-3 * w.norm())
      out.push_back(
          {effect.name, "the free motions of the regions span its pattern", "declare larger regions or a background"});
  }
  if (readout_frames_ == 0.0)
    out.push_back({"true frequency of a rotor line",
                   "without a known readout time, frequencies that differ by the frame rate cannot be "
                   "distinguished",
                   "declare the readout time"});
  return out;
}

// What is left of a wave over the image where places have the model's own uncertainty: exp(-(2 pi waves sigma)^2 / 2).
double ObservationLevel::blur(double waves_per_px) const {
  const double share = static_cast<double>(model_.q_high().cols()) / static_cast<double>(model_.q_high().rows());
  const double phase = 2.0 * std::numbers::pi * waves_per_px * sigma_px_ * std::sqrt(share);
  return std::exp(-0.5 * phase * phase);
}

std::vector<ParameterValue> ObservationLevel::parameters(std::size_t adopted) const {
  const Adopted& a = adopted_.at(adopted);
  std::vector<ParameterValue> out;
  if (a.effect.form == Form::kLine) {
    out.push_back(
        {"frequency", "Hz", std::abs(a.line_hz.apparent_hz + a.line.fold * record_.rate_hz), a.line_hz.sigma_hz});
    out.push_back({"apparent frequency", "Hz", a.line_hz.apparent_hz, a.line_hz.sigma_hz});
    out.push_back({"gain over the next alias order", "", a.line.gain - a.line.next_gain, std::nullopt});
    return out;
  }
  if (a.effect.form != Form::kField) {
    for (Eigen::Index p = 0; p < a.values.size(); ++p) {
      const auto i = static_cast<std::size_t>(p);
      const double waves = i < a.effect.waves_per_px.size() ? a.effect.waves_per_px[i] : 0.0;
      const double factor = a.effect.per_unit / blur(waves);
      ParameterValue value{a.effect.parameters[i], a.effect.unit, a.values(p) * factor, std::nullopt};
      if (a.covariance.size() > 0) value.sigma = std::sqrt(a.covariance(p, p)) * std::abs(factor);
      out.push_back(std::move(value));
    }
    return out;
  }
  const Eigen::RowVectorXd amplitude = model_.amplitudes().row(amplitude_row(adopted));
  const Eigen::VectorXd w = a.field.cwiseProduct(model_.weight());
  const Eigen::MatrixXd& q = a.low_band ? model_.q_low() : model_.q_high();
  const auto own = q.leftCols(model_.own_rank());
  const Eigen::VectorXd others = w - own * (own.transpose() * w);
  const double share = a.low_band ? low_share() : 1.0;
  const double noise = others.norm() > 0.0 ? std::sqrt(share) / others.norm() : 0.0;  // per frame
  const double value = std::sqrt(std::max(std::pow(rms(amplitude), 2) - noise * noise, 0.0));
  const double sigma = noise / std::sqrt(share * static_cast<double>(record_.n_frames()));
  const bool latent = a.kind == EffectKind::kLatent;
  out.push_back({"rms", latent ? "px" : a.effect.unit, value * a.effect.per_unit, sigma * a.effect.per_unit});
  if (!latent)
    out.push_back({"band", "Hz", a.low_band ? FrameModel::kLowBand_hz : 0.5 * record_.rate_hz, std::nullopt});
  return out;
}

std::string ObservationLevel::meaning(std::size_t adopted) const {
  const Adopted& a = adopted_.at(adopted);
  if (a.kind != EffectKind::kLatent) return {};
  const Eigen::MatrixXd& amplitudes = model_.amplitudes();
  std::vector<KnownSignal> known;
  const Channels all = channels();
  for (std::size_t c = 0; c < all.rows.size(); ++c)
    known.push_back({"the motion of " + all.info[c].name, amplitudes.row(all.rows[c])});
  const Eigen::Index plane = model_.first_plane_row();
  const char* names[] = {"the camera's translation along u", "the camera's translation along v",
                         "the camera's distance"};
  for (Eigen::Index i = 0; i < 3 && plane + i < model_.n_own(); ++i)
    known.push_back({names[i], amplitudes.row(plane + i)});
  const std::size_t n_plain = known.size();
  for (std::size_t i = 0; i < n_plain; ++i) {
    const Eigen::RowVectorXd s = known[i].series.array() - known[i].series.mean();
    known.push_back({"the square of " + known[i].name, s.cwiseAbs2()});
  }
  for (std::size_t i = 0; i < adopted_.size(); ++i) {
    if (i != adopted && adopted_[i].field.size() > 0)
      known.push_back({adopted_[i].effect.name, amplitudes.row(amplitude_row(i))});
  }
  return latent_words(a.field, amplitudes.row(amplitude_row(adopted)), record_, model_.geometry(), known);
}

std::vector<std::string> ObservationLevel::rivals(std::size_t adopted, std::uint64_t) {
  const std::vector<Adopted> kept = adopted_;
  std::vector<std::string> out;
  if (kept.at(adopted).kind == EffectKind::kLatent) return out;
  const std::string own = kept[adopted].effect.name;
  adopted_.erase(adopted_.begin() + static_cast<std::ptrdiff_t>(adopted));
  (void)fit();
  const std::vector<CandidateScore> scores = score();
  double of_own = std::numeric_limits<double>::infinity();
  for (const CandidateScore& s : scores) {
    if (s.effect == own) of_own = s.score;
  }
  for (const CandidateScore& s : scores) {
    if (s.effect != own && s.kind == EffectKind::kNamed && s.score >= kRival * of_own &&
        s.refusal.find("follows") == std::string::npos)
      out.push_back(s.effect);
  }
  adopted_ = kept;
  (void)fit();
  return out;
}

std::string ObservationLevel::describe_residual() const {
  const Moments moments = moments_of(model_.residual());
  const Eigen::VectorXd pattern = leading_pattern(moments.all_sum);
  const double along_v = Eigen::Map<const Eigen::MatrixXd>(pattern.data(), 2, pattern.size() / 2).row(1).squaredNorm();
  std::vector<double> share(record_.regions.size(), 0.0);
  for (Eigen::Index j = 0; j < record_.n_points(); ++j)
    share[record_.region_of_point[static_cast<std::size_t>(j)]] += pattern.segment<2>(2 * j).squaredNorm();
  const auto most = static_cast<std::size_t>(std::max_element(share.begin(), share.end()) - share.begin());
  const double slow = moments.low_sum.trace() / std::max(moments.all_sum.trace(), 1e-300);
  return "leading pattern: " + std::to_string(std::lround(100.0 * share[most])) + " % in region " +
         record_.regions[most].name + ", " + std::to_string(std::lround(100.0 * along_v)) + " % along v; " +
         std::to_string(std::lround(100.0 * slow)) + " % of the residual below " +
         std::to_string(FrameModel::kLowBand_hz).substr(0, 3) + " Hz";
}

}  // namespace core::closure
