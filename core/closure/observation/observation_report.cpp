#include "core/closure/observation/observation_report.h"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/latent_words.h"
#include "core/closure/observation/region_modes.h"
#include "core/closure/observation/track_noise.h"

namespace core::closure {
namespace {

// Motions of the fit, and their squares, that are correlated with a latent effect's amplitude.
std::vector<KnownSignal> motions_of(const FitView& fit) {
  const Eigen::MatrixXd& amplitudes = fit.model.amplitudes();
  std::vector<KnownSignal> out;
  const RegionChannels channels = region_channels(fit);
  for (std::size_t c = 0; c < channels.rows.size(); ++c)
    out.push_back({"the motion of " + channels.info[c].name, amplitudes.row(channels.rows[c])});
  const Eigen::Index plane = fit.model.first_plane_row();
  constexpr std::array kNames{"the camera's translation along u", "the camera's translation along v",
                              "the camera's distance"};
  for (Eigen::Index i = 0; i < 3 && plane + i < fit.model.n_own(); ++i)
    out.push_back({kNames[static_cast<std::size_t>(i)], amplitudes.row(plane + i)});
  const std::size_t n_plain = out.size();
  for (std::size_t i = 0; i < n_plain; ++i) {
    const Eigen::RowVectorXd s = out[i].series.array() - out[i].series.mean();
    out.push_back({"the square of " + out[i].name, s.cwiseAbs2()});
  }
  return out;
}

// The part of whitened patterns outside the model's own columns.
Eigen::MatrixXd beside_own(const FitView& fit, const Eigen::MatrixXd& patterns_px) {
  const Eigen::MatrixXd w = fit.model.whitened(patterns_px);
  const auto own = fit.model.q_high().leftCols(fit.model.own_rank());
  return w - own * (own.transpose() * w);
}

// How much of a pattern's squares the effect's patterns hold.
double share_held(const Eigen::VectorXd& left, const Eigen::MatrixXd& shapes) {
  if (shapes.cols() == 0 || !(shapes.norm() > 0.0)) return 0.0;
  const Eigen::VectorXd missed = left - shapes * shapes.colPivHouseholderQr().solve(left);
  return 1.0 - missed.squaredNorm() / std::max(left.squaredNorm(), 1e-300);
}

std::string nearest_words(const Eigen::VectorXd& pattern_px, const FitView& fit,
                          const std::vector<const ObservationEffect*>& catalogue) {
  constexpr double kTold = 0.2;
  constexpr std::size_t kMost = 2;
  const Eigen::VectorXd left = beside_own(fit, pattern_px);
  std::vector<std::pair<double, std::string>> near;
  for (const ObservationEffect* effect : catalogue) {
    const double share = share_held(left, beside_own(fit, effect->shapes(fit)));
    if (share > kTold) near.emplace_back(share, effect->name());
  }
  std::sort(near.rbegin(), near.rend());
  std::string words;
  for (std::size_t i = 0; i < std::min(near.size(), kMost); ++i) {
    words += (i == 0 ? "; nearest: " : ", ") + near[i].second + " (" +
             std::to_string(std::lround(100.0 * near[i].first)) + " % of it)";
  }
  return words;
}

}  // namespace

std::vector<NotObservable> not_observable(const ObservationFit& fit,
                                          const std::vector<const ObservationEffect*>& catalogue) {
  std::vector<NotObservable> out = never_observable();
  for (const ObservationEffect* effect : catalogue) {
    const bool is_adopted = std::any_of(fit.effects().begin(), fit.effects().end(),
                                        [&](const auto& adopted) { return adopted->id() == effect->id(); });
    if (std::optional<NotObservable> obstacle = effect->obstacle(fit.view(), is_adopted))
      out.push_back(std::move(*obstacle));
  }
  return out;
}

std::vector<ParameterValue> effect_parameters(const ObservationFit& fit, std::size_t effect) {
  return fit.effects().at(effect)->parameters(fit.view(), fit.amplitude(effect));
}

std::string effect_meaning(const ObservationFit& fit, std::size_t effect,
                           const std::vector<const ObservationEffect*>& catalogue) {
  const EffectInModel& latent = *fit.effects().at(effect);
  if (latent.kind() != EffectKind::kLatent) return {};
  std::vector<KnownSignal> known = motions_of(fit.view());
  for (std::size_t i = 0; i < fit.effects().size(); ++i) {
    if (i != effect && fit.effects()[i]->pattern() != nullptr)
      known.push_back({fit.effects()[i]->name(), fit.amplitude(i)});
  }
  return latent_words(*latent.pattern(), fit.amplitude(effect), fit.record(), fit.model().geometry(), known) +
         nearest_words(*latent.pattern(), fit.view(), catalogue);
}

std::string describe_residual(const ObservationFit& fit) {
  const ObservationRecord& record = fit.record();
  const ResidualMoments moments = residual_moments(fit.model().residual(), record.rate_hz);
  const Eigen::VectorXd pattern = leading_pattern(moments.all_sum);
  const double along_v = Eigen::Map<const Eigen::MatrixXd>(pattern.data(), 2, pattern.size() / 2).row(1).squaredNorm();
  std::vector<double> share(record.regions.size(), 0.0);
  for (Eigen::Index j = 0; j < record.n_points(); ++j)
    share[record.region_of_point[static_cast<std::size_t>(j)]] += pattern.segment<2>(2 * j).squaredNorm();
  const auto most = static_cast<std::size_t>(std::max_element(share.begin(), share.end()) - share.begin());
  const HeldOut& held_out = fit.view().held_out;
  const RungSet below = held_out.rungs().up_to(PointMotionModel::kLowBand_hz);
  const double slow = held_out.sum_over(below, moments).trace() / std::max(moments.all_sum.trace(), 1e-300);
  return "leading pattern: " + std::to_string(std::lround(100.0 * share[most])) + " % in region " +
         record.regions[most].name + ", " + std::to_string(std::lround(100.0 * along_v)) + " % along v; " +
         std::to_string(std::lround(100.0 * slow)) + " % of the residual below " +
         std::to_string(PointMotionModel::kLowBand_hz).substr(0, 3) + " Hz";
}

ClosureLevel::Noise describe_noise(const ObservationFit& fit) {
  constexpr double kCodec = 0.1;  // share of the noise; overlapping windows alone correlate less outside of each other
  const CorrelationShares& shares = fit.model().correlation().shares();
  const TrackNoise in_time = track_noise(fit.model().residual(), fit.record().rate_hz);
  const double of_region = std::max(shares.region_u, shares.region_v);
  ClosureLevel::Noise out;
  out.values = {{"rms per axis", "px", fit.sigma_px(), {}},
                {"correlation time", "s", in_time.correlation_s, {}},
                {"common to overlapping windows", "%", 100.0 * shares.window, {}},
                {"common to neighbours within 40 px", "%", 100.0 * shares.neighbourhood, {}},
                {"common to whole regions", "%", 100.0 * of_region, {}}};
  if (in_time.period_frames > 0) {
    out.values.push_back({"period of a codec", "frames", static_cast<double>(in_time.period_frames), {}});
    out.values.push_back({"change at its first frame over the others", "1", in_time.period_change, {}});
  }
  if (in_time.period_frames > 0 || shares.neighbourhood + of_region > kCodec) {
    out.advice =
        "errors of a video codec: record at a higher bit rate or with intra frames only, without noise reduction";
  }
  return out;
}

}  // namespace core::closure
