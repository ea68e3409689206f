#include "core/identification/verdict.h"

#include <algorithm>
#include <cmath>

#include "core/identification/mac.h"
#include "core/identification/verdict_words.h"

namespace core {

namespace {

// Slightly negative damping is estimation noise of a nearly undamped mode, not an unstable structure.
constexpr double kLeastDamping = -0.002;

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

bool has_resonance(const BaseResponse& response, const VerdictRules& rules) noexcept {
  const bool answers = response.gain >= rules.least_base_gain && response.gain > response.gain_beside;
  return answers || (response.resonance > rules.least_resonance_sigmas * response.resonance_sigma &&
                     response.relative > rules.least_relative_rise * response.relative_without);
}

// Known to be without a peak there.
bool base_is_smooth(const BaseResponse& response, const VerdictRules& rules) noexcept {
  return response.base_is_known && response.base_peak < rules.no_base_peak &&
         std::abs(response.base_peak) < rules.no_peak_sigmas * response.base_peak_sigma;
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
  return !base_is_smooth(response, rules);
}

// MAC of the other channels with equal motion: a peak of the input below the first mode, or camera motion, moves them
// so.
double alike_mac(const Mode& mode, const std::vector<ChannelInfo>& channels) {
  std::vector<std::complex<double>> equal, own;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (channels[c].is_base) continue;
    equal.emplace_back(channels[c].direction_u * channels.front().direction_u +
                       channels[c].direction_v * channels.front().direction_v);
    own.push_back(mode.shape[c]);
  }
  return own.size() > 1 ? mac(equal, own) : 0.0;
}

// What a measured input explains is taken out of the identification, except for the part that its own noise hides: a
// peak of the input that the channels follow alike, coherent with it, without a resonance of the response.
bool follows_input(const Mode& mode, const BaseResponse& response, const std::vector<ChannelInfo>& channels,
                   const VerdictRules& rules) {
  return rules.base_is_input && alike_mac(mode, channels) > rules.max_alike_mac &&
         response.coherence > rules.most_input_coherence && !has_resonance(response, rules) &&
         !base_is_smooth(response, rules);
}

// What imperfect regression on the input leaves of a broad peak: the base explains all motion there, and the response
// to it has no maximum.
bool is_left_of_input(const Mode& mode, const BaseResponse& response, const VerdictRules& rules) noexcept {
  return rules.base_is_input && mode.damping_ratio > rules.least_broad_damping &&
         response.coherence > rules.all_input_coherence && response.gain <= rules.no_gain_rise * response.gain_beside;
}

std::string base_evidence(const BaseResponse& response) {
  if (!(response.base_peak > 0.0)) return {};
  return in_words(" (its own spectrum has a peak there, %.2g times the spectrum beside it)", response.base_peak);
}

bool is_too_short(const Mode& mode, const VerdictRules& rules) noexcept {
  if (!(rules.record_s > 0.0)) return false;
  return mode.apparent_hz * rules.record_s < rules.least_cycles || rules.samples_per_row < rules.least_samples_per_row;
}

std::string candidate_reason(const Mode& mode, const VerdictRules& rules) {
  const double cycles = mode.apparent_hz * rules.record_s;
  if (cycles < rules.least_cycles) {
    return in_words("%.1f cycles in the record, a verdict needs %.0f: may be a mode, to %.2g Hz", cycles,
                    rules.least_cycles, rules.resolution_hz);
  }
  return in_words(
      "the record is too short for a verdict (%.1f samples for each equation of the model, %.0f are needed): may "
      "be a mode, to %.2g Hz",
      rules.samples_per_row, rules.least_samples_per_row, rules.resolution_hz);
}

// Which limit of damping or frequency the pole passes, in words; empty: none.
std::string limit_passed(const Mode& mode, const VerdictRules& rules) {
  if (mode.damping_ratio < kLeastDamping || mode.damping_ratio > rules.max_damping)
    return in_words("damping %.2f %% outside 0 .. %.0f %%", 100.0 * mode.damping_ratio, 100.0 * rules.max_damping);
  if (rules.max_apparent_hz > 0.0 && mode.apparent_hz > rules.max_apparent_hz)
    return in_words("filter edge: above the %.4g Hz passed by the decimation filter", rules.max_apparent_hz);
  if (rules.max_frequency_hz > 0.0 && mode.frequency_hz > rules.max_frequency_hz)
    return in_words("above the %.4g Hz of max_frequency_hz", rules.max_frequency_hz);
  return {};
}

void decide(Mode& mode, const PoleCluster& cluster, const BaseResponse& response,
            const std::vector<ChannelInfo>& channels, const std::vector<int>& orders, const VerdictRules& rules,
            const SpectralLineEvidence& line) {
  const double uniform = uniform_mac(mode, channels);
  const double base = base_share(mode, channels);
  const int first_order = orders[static_cast<std::size_t>(cluster.first_i_order)];
  if (std::string outside = limit_passed(mode, rules); !outside.empty()) {
    set(mode, Verdict::kNumerical, std::move(outside));
  } else if (line.witness_share > rules.max_witness_share) {
    set(mode, Verdict::kCameraMotion,
        in_words("a static region moves with it: %.0f %% of the shape is camera motion", 100.0 * line.witness_share));
  } else if (uniform > rules.max_uniform_mac) {
    set(mode, Verdict::kCameraMotion,
        in_words("all channels move alike (MAC %.3f with a translation of the camera)", uniform));
  } else if (line.camera_mac > rules.min_camera_mac) {
    set(mode, Verdict::kCameraMotion,
        in_words("vibration of the camera at %.1f Hz: row delays give it this shape (MAC %.3f)", line.camera_hz,
                 line.camera_mac));
  } else if (moves_with_base(base, response, rules)) {
    set(mode, Verdict::kInputPeak,
        in_words("the base moves %.2f of the largest channel: motion of the base or the camera%s", base,
                 base_evidence(response).c_str()));
  } else if (follows_input(mode, response, channels, rules)) {
    set(mode, Verdict::kInputPeak,
        in_words("all channels follow the base alike (coherence %.2f), and their response to it has no peak",
                 response.coherence));
  } else if (is_left_of_input(mode, response, rules)) {
    set(mode, Verdict::kInputPeak,
        in_words("the base explains the motion (coherence %.2f), and the response to it has no peak",
                 response.coherence));
  } else if (line.steady_segments > 0) {
    set(mode, Verdict::kHarmonic,
        in_words("a steady line: its phase advances evenly over %d segments (coherence %.2f); the modes are identified "
                 "without it",
                 static_cast<int>(line.steady_segments), line.steady_coherence));
  } else if (line.late_damping_ratio && *line.late_damping_ratio < rules.max_late_damping &&
             line.late_share > rules.min_late_share) {
    set(mode, Verdict::kHarmonic,
        in_words("a steady force: damping %.3f %%, but its correlation decays as with %.3f %%",
                 100.0 * mode.damping_ratio, 100.0 * *line.late_damping_ratio));
  } else if (is_late(cluster, rules) && (rules.last_first_i_order < 1 || cluster.presence < rules.min_presence)) {
    set(mode, Verdict::kNumerical,
        in_words("found in %.0f %% of the orders, first at order %d", 100.0 * cluster.presence, first_order));
  } else if (is_too_short(mode, rules)) {
    set(mode, Verdict::kCandidate, candidate_reason(mode, rules));
  } else if (mode.fold_n && *mode.fold_margin < rules.least_fold_margin) {
    set(mode, Verdict::kAmbiguous,
        in_words("a mode, but its alias order is open: fold margin %.2f, MPC %.2f", *mode.fold_margin, mode.mpc));
  } else if (cluster.representative.fold_open) {
    set(mode, Verdict::kAmbiguous,
        "a mode, but its alias order is open: the row delays of the channels differ too little");
  } else {
    set(mode, Verdict::kStructural,
        in_words("found in %.0f %% of the orders from order %d on, MPC %.3f", 100.0 * cluster.presence, first_order,
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

bool is_late(const PoleCluster& cluster, const VerdictRules& rules) noexcept {
  return cluster.presence < rules.certain_presence || cluster.first_i_order > rules.last_first_i_order;
}

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
        in_words("damping %.2f %% outside 0 .. %.0f %%", 100.0 * mode.damping_ratio, 100.0 * rules.max_damping));
  } else if (base > rules.max_published_base_share) {
    set(mode, Verdict::kInputPeak,
        in_words("the base moves %.2f of the largest channel: motion of the base or the camera", base));
  } else {
    set(mode, Verdict::kStructural, in_words("the base moves %.2f of the largest channel", base));
  }
  return mode;
}

void reject_lone_motion(Mode& mode, const std::string& channel, double seen) {
  if (mode.verdict != Verdict::kStructural && mode.verdict != Verdict::kAmbiguous &&
      mode.verdict != Verdict::kCandidate)
    return;
  set(mode, Verdict::kNumerical,
      in_words("only %.60s moves, and %.0f %% of its record is missing", channel.c_str(), 100.0 * (1.0 - seen)));
}

void number_by_frequency(std::vector<Mode>& modes) {
  std::vector<Mode*> structural;
  for (Mode& mode : modes) {
    if (mode.verdict == Verdict::kStructural) structural.push_back(&mode);
  }
  std::sort(structural.begin(), structural.end(),
            [](const Mode* a, const Mode* b) { return a->frequency_hz < b->frequency_hz; });
  for (std::size_t i = 0; i < structural.size(); ++i) {
    structural[i]->reason = in_words("number %d by frequency; %s; no further test (as published)",
                                     static_cast<int>(i) + 1, structural[i]->reason.c_str());
  }
}

}  // namespace core
