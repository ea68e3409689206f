#include "core/identification/verdict.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/identification/mac.h"

namespace core {

namespace {

// Slightly negative damping is estimation noise of a nearly undamped mode, not an unstable structure.
constexpr double kLeastDamping = -0.002;
constexpr double kTwinMac = 0.9;
constexpr double kTwinFrequency = 0.06;  // relative
// Two resonances closer than their widths are one to a short record unless their shapes differ: what a third one,
// folded onto them, leaves beside the mode has a mixed shape. The part of it that is not the mode's is then seen with
// row delays of another frequency, and is out of phase; that of a real close mode is in phase.
constexpr double kLeastMixedMpc = 0.9, kLeastRestMpc = 0.7;
// A steady force beside a mode moves the structure in that mode's shape, with next to no damping.
constexpr double kMostHarmonicDamping = 0.001, kMostLineShare = 0.3;  // of the mode's

template <class... Args>
std::string text(const char* format, Args... args) {
  char buffer[200];
  std::snprintf(buffer, sizeof buffer, format, args...);
  return buffer;
}

double base_share(const Mode& mode, const std::vector<ChannelInfo>& channels) {
  double share = 0.0;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (channels[c].is_base) share = std::max(share, std::abs(mode.shape[c]));
  }
  return share;
}

// False if a channel is a velocity or an acceleration, which a camera does not measure.
bool all_displacements(const std::vector<ChannelInfo>& channels) {
  return std::all_of(channels.begin(), channels.end(), [](const ChannelInfo& c) { return c.n_integrations == 0; });
}

// Camera translation moves all channels of one axis alike; a single channel is no evidence.
double uniform_mac(const Mode& mode, const std::vector<ChannelInfo>& channels) {
  if (channels.size() < 2 || !all_displacements(channels)) return 0.0;
  std::vector<std::complex<double>> uniform(channels.size());
  for (std::size_t c = 0; c < channels.size(); ++c) {
    uniform[c] =
        channels[c].direction_u * channels.front().direction_u + channels[c].direction_v * channels.front().direction_v;
  }
  return mac(uniform, mode.shape);
}

void set(Mode& mode, Verdict verdict, std::string reason) {
  mode.verdict = verdict;
  mode.reason = std::move(reason);
}

bool has_resonance(const BaseResponse& response, const VerdictRules& rules) noexcept {
  const bool answers = response.gain >= rules.least_base_gain && response.gain > response.gain_beside;
  return answers || (response.resonance > rules.least_resonance_sigmas * response.resonance_sigma &&
                     response.relative > rules.least_relative_rise * response.relative_without);
}

// An input peak is a peak of the base's own spectrum that the structure follows. Where the base spectrum has none, the
// base component of a weak mode's shape is estimation noise or broadband camera motion.
bool moves_with_base(double base_share, const BaseResponse& response, const VerdictRules& rules) noexcept {
  if (base_share <= rules.max_base_share) return false;
  if (!response.base_is_known)  // the response alone decides
    return base_share > rules.open_base_share || !has_resonance(response, rules);
  if (base_share > rules.max_noisy_share) return true;
  if (base_share <= rules.open_base_share)
    return response.base_peak > rules.most_base_peak && !has_resonance(response, rules);
  return !(response.base_peak < rules.no_base_peak &&
           std::abs(response.base_peak) < rules.no_peak_sigmas * response.base_peak_sigma);
}

std::string base_evidence(const BaseResponse& response) {
  if (!(response.base_peak > 0.0)) return {};
  return text(" (its own spectrum has a peak there, %.2g times the spectrum beside it)", response.base_peak);
}

bool is_too_short(const Mode& mode, const VerdictRules& rules) noexcept {
  if (!(rules.record_s > 0.0)) return false;
  return mode.apparent_hz * rules.record_s < rules.least_cycles || rules.samples_per_row < rules.least_samples_per_row;
}

std::string candidate_reason(const Mode& mode, const VerdictRules& rules) {
  const double cycles = mode.apparent_hz * rules.record_s;
  if (cycles < rules.least_cycles)
    return text("%.1f cycles in the record, a verdict needs %.0f: may be a mode, to %.2g Hz", cycles,
                rules.least_cycles, rules.resolution_hz);
  return text(
      "the record is too short for a verdict (%.1f samples for each equation of the model, %.0f are needed): may "
      "be a mode, to %.2g Hz",
      rules.samples_per_row, rules.least_samples_per_row, rules.resolution_hz);
}

void decide(Mode& mode, const PoleCluster& cluster, const BaseResponse& response,
            const std::vector<ChannelInfo>& channels, const std::vector<int>& orders, const VerdictRules& rules,
            const SpectralLineEvidence& line) {
  const double uniform = uniform_mac(mode, channels);
  const double base = base_share(mode, channels);
  const int first_order = orders[static_cast<std::size_t>(cluster.first_i_order)];
  if (mode.damping_ratio < kLeastDamping || mode.damping_ratio > rules.max_damping) {
    set(mode, Verdict::kNumerical,
        text("damping %.2f %% outside 0 .. %.0f %%", 100.0 * mode.damping_ratio, 100.0 * rules.max_damping));
  } else if (rules.max_apparent_hz > 0.0 && mode.apparent_hz > rules.max_apparent_hz) {
    set(mode, Verdict::kNumerical,
        text("filter edge: above the %.4g Hz passed by the decimation filter", rules.max_apparent_hz));
  } else if (rules.max_frequency_hz > 0.0 && mode.frequency_hz > rules.max_frequency_hz) {
    set(mode, Verdict::kNumerical, text("above the %.4g Hz of max_frequency_hz", rules.max_frequency_hz));
  } else if (line.witness_share > rules.max_witness_share) {
    set(mode, Verdict::kCameraMotion,
        text("a static region moves with it: %.0f %% of the shape is camera motion", 100.0 * line.witness_share));
  } else if (uniform > rules.max_uniform_mac) {
    set(mode, Verdict::kCameraMotion,
        text("all channels move alike (MAC %.3f with a translation of the camera)", uniform));
  } else if (line.camera_mac > rules.min_camera_mac) {
    set(mode, Verdict::kCameraMotion,
        text("vibration of the camera at %.1f Hz: row delays give it this shape (MAC %.3f)", line.camera_hz,
             line.camera_mac));
  } else if (moves_with_base(base, response, rules)) {
    set(mode, Verdict::kInputPeak,
        text("the base moves %.2f of the largest channel: motion of the base or the camera%s", base,
             base_evidence(response).c_str()));
  } else if (line.late_damping_ratio && *line.late_damping_ratio < rules.max_late_damping &&
             line.late_share > rules.min_late_share) {
    set(mode, Verdict::kHarmonic,
        text("a steady force: damping %.3f %%, but its correlation decays as with %.3f %%", 100.0 * mode.damping_ratio,
             100.0 * *line.late_damping_ratio));
  } else if (cluster.presence < rules.min_presence || cluster.first_i_order > rules.last_first_i_order) {
    set(mode, Verdict::kNumerical,
        text("found in %.0f %% of the orders, first at order %d", 100.0 * cluster.presence, first_order));
  } else if (mode.mpc < rules.min_mpc) {
    set(mode, Verdict::kNumerical, text("components not in phase: MPC %.2f < %.2f", mode.mpc, rules.min_mpc));
  } else if (is_too_short(mode, rules)) {
    set(mode, Verdict::kCandidate, candidate_reason(mode, rules));
  } else if (mode.fold_n && (*mode.fold_margin < rules.least_fold_margin || mode.mpc < rules.least_certain_mpc)) {
    set(mode, Verdict::kAmbiguous,
        text("a mode, but its alias order is open: fold margin %.2f, MPC %.2f", *mode.fold_margin, mode.mpc));
  } else if (cluster.representative.fold_open) {
    set(mode, Verdict::kAmbiguous,
        "a mode, but its alias order is open: the row delays of the channels differ too little");
  } else {
    set(mode, Verdict::kStructural,
        text("found in %.0f %% of the orders from order %d on, MPC %.3f", 100.0 * cluster.presence, first_order,
             mode.mpc));
  }
  if (line.witness_moves && mode.verdict == Verdict::kStructural)
    mode.reason += "; a region declared static moves with it: nothing was removed as camera motion";
}

Mode mode_of(const PoleCluster& cluster) {
  Mode mode;
  mode.frequency_hz = cluster.frequency_hz;
  mode.apparent_hz = cluster.apparent_hz;
  mode.damping_ratio = cluster.damping_ratio;
  mode.fold_n = cluster.representative.fold_n;
  mode.fold_margin = cluster.representative.fold_margin;
  mode.shape = cluster.representative.shape;
  mode.mpc = cluster.representative.mpc;
  mode.emac = cluster.representative.emac;
  mode.presence = cluster.presence;
  return mode;
}

}  // namespace

Mode judge(const PoleCluster& cluster, const BaseResponse& response, const std::vector<ChannelInfo>& channels,
           const std::vector<int>& orders, const VerdictRules& rules, const SpectralLineEvidence& line) {
  Mode mode = mode_of(cluster);
  decide(mode, cluster, response, channels, orders, rules, line);
  return mode;
}

Mode judge_as_published(const PoleCluster& pole, const std::vector<ChannelInfo>& channels, const VerdictRules& rules) {
  Mode mode = mode_of(pole);
  const double base = base_share(mode, channels);
  if (!(mode.damping_ratio > 0.0) || mode.damping_ratio > rules.max_damping) {
    set(mode, Verdict::kNumerical,
        text("damping %.2f %% outside 0 .. %.0f %%", 100.0 * mode.damping_ratio, 100.0 * rules.max_damping));
  } else if (base > rules.max_published_base_share) {
    set(mode, Verdict::kInputPeak,
        text("the base moves %.2f of the largest channel: motion of the base or the camera", base));
  } else {
    set(mode, Verdict::kStructural, text("the base moves %.2f of the largest channel", base));
  }
  return mode;
}

void reject_lone_motion(Mode& mode, const std::string& channel, double seen) {
  if (mode.verdict != Verdict::kStructural && mode.verdict != Verdict::kAmbiguous &&
      mode.verdict != Verdict::kCandidate)
    return;
  set(mode, Verdict::kNumerical,
      text("only %.60s moves, and %.0f %% of its record is missing", channel.c_str(), 100.0 * (1.0 - seen)));
}

void number_by_frequency(std::vector<Mode>& modes) {
  std::vector<Mode*> structural;
  for (Mode& mode : modes) {
    if (mode.verdict == Verdict::kStructural) structural.push_back(&mode);
  }
  std::sort(structural.begin(), structural.end(),
            [](const Mode* a, const Mode* b) { return a->frequency_hz < b->frequency_hz; });
  for (std::size_t i = 0; i < structural.size(); ++i) {
    structural[i]->reason = text("number %d by frequency; %s; no further test (as published)", static_cast<int>(i) + 1,
                                 structural[i]->reason.c_str());
  }
}

namespace {

bool is_line_beside(const Mode& line, const Mode& mode) noexcept {
  return line.damping_ratio < kMostHarmonicDamping && line.damping_ratio < kMostLineShare * mode.damping_ratio;
}

// Apart by less than the half-power widths of both together.
bool is_unresolved(const Mode& a, const Mode& b) noexcept {
  return std::abs(a.frequency_hz - b.frequency_hz) <
         std::abs(a.damping_ratio) * a.frequency_hz + std::abs(b.damping_ratio) * b.frequency_hz;
}

// MPC of what remains of a shape without its projection on another one.
double rest_mpc(const Mode& mixture, const Mode& mode) {
  std::complex<double> inner = 0.0;
  double norm = 0.0;
  for (std::size_t c = 0; c < mode.shape.size(); ++c) {
    inner += std::conj(mode.shape[c]) * mixture.shape[c];
    norm += std::norm(mode.shape[c]);
  }
  std::vector<std::complex<double>> rest = mixture.shape;
  for (std::size_t c = 0; c < rest.size(); ++c) rest[c] -= inner / norm * mode.shape[c];
  return mpc(rest);
}

// Nothing but noise remains of twins: there the whole shape decides.
bool is_mixture_beside(const Mode& mixture, const Mode& mode) {
  if (!(mixture.mpc < mode.mpc) || !is_unresolved(mixture, mode)) return false;
  const double alike = mac(mixture.shape, mode.shape);
  return alike > kTwinMac ? mixture.mpc < kLeastMixedMpc : rest_mpc(mixture, mode) < kLeastRestMpc;
}

}  // namespace

void reject_mixtures(std::vector<Mode>& modes) {
  for (Mode& mixture : modes) {
    for (const Mode& mode : modes) {
      if (mixture.verdict != Verdict::kStructural || mode.verdict != Verdict::kStructural) continue;
      if (!is_mixture_beside(mixture, mode)) continue;
      set(mixture, Verdict::kNumerical,
          text("not resolved from %.4f Hz: closer than their widths (MAC %.2f), and what its shape "
               "has beside that mode's is not in phase (MPC %.2f)",
               mode.frequency_hz, mac(mixture.shape, mode.shape), rest_mpc(mixture, mode)));
    }
  }
}

void reject_twins(std::vector<Mode>& modes) {
  for (Mode& a : modes) {
    for (Mode& b : modes) {
      if (&a == &b || a.verdict != Verdict::kStructural || b.verdict != Verdict::kStructural) continue;
      const bool near =
          std::abs(a.frequency_hz - b.frequency_hz) < kTwinFrequency * std::max(a.frequency_hz, b.frequency_hz);
      if (!near || mac(a.shape, b.shape) <= kTwinMac) continue;
      if (is_line_beside(a, b)) {
        set(a, Verdict::kHarmonic,
            text("a steady force: the shape of %.4f Hz beside it, with %.3f %% of damping", b.frequency_hz,
                 100.0 * a.damping_ratio));
        continue;
      }
      if (is_line_beside(b, a)) continue;  // handled in a later iteration
      Mode& weaker = a.presence < b.presence || (a.presence == b.presence && a.mpc < b.mpc) ? a : b;
      const Mode& stronger = &weaker == &a ? b : a;
      set(weaker, Verdict::kNumerical,
          text("twin of %.4f Hz with the same shape (amplitude dependent?)", stronger.frequency_hz));
    }
  }
}

}  // namespace core
