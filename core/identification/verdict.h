#pragma once

#include <string>
#include <vector>

#include "core/identification/base_response.h"
#include "core/identification/line_evidence.h"
#include "core/identification/stabilisation.h"
#include "core/types/displacement.h"
#include "core/types/modal_estimate.h"

namespace core {

// Limits by which a cluster is classified as a mode of the structure.
struct VerdictRules {
  double max_damping = 0.15;
  double max_apparent_hz = 0.0;  // apparent frequencies above: transition band of a preceding filter; 0 = none
  // Shares of the model orders. A pole found in certain_presence of them or more, first in the canonical order or the
  // next one (last_first_i_order), is certain. One found in less than min_presence is no mode. Any other is late: a
  // mode if its frequency is known as well as that of a mode is (chance_poles.h), but with last_first_i_order < 1,
  // where MPC carries no information, no mode.
  double certain_presence = 0.85;
  double min_presence = 0.8;
  int last_first_i_order = 1;
  double max_base_share = 0.1;   // |shape at the base| / largest
  double open_base_share = 0.3;  // up to here a clear response of the structure to its base decides ...
  double least_base_gain = 3.0;  // ... with at least this gain at a local maximum
  double most_base_peak = 1.5;   // ... or a base whose own spectrum has no peak higher than this (BaseResponse) ...
  double least_resonance_sigmas = 3.5;  // ... or a resonance of the response that is this significant ...
  double least_relative_rise = 1.5;     // ... and raises the motion relative to the base by this factor
  double no_base_peak = 0.7;            // up to max_noisy_share a smooth base spectrum decides: below this height ...
  double no_peak_sigmas = 2.0;          // ... and within this many of its sigmas
  double max_noisy_share = 0.6;         // above, the base moves as the structure does
  bool base_is_input = false;           // the base is a measured input: its component is 0 in every shape
  double max_alike_mac = 0.5;           // MAC of the other channels with equal motion ...
  double most_input_coherence = 0.5;    // ... and coherence with the input, without a resonance: a peak of the input
  double least_broad_damping = 0.02;    // a broader pole with ...
  double all_input_coherence = 0.95;    // ... this coherence with the input is a mode only if ...
  double no_gain_rise = 1.1;            // ... the response to it is larger than beside by this factor
  double max_uniform_mac = 0.98;        // MAC with equal motion of all channels, i.e. camera translation
  double max_witness_share = 0.9;       // share of the shape's square that is camera motion according to static regions
  double min_camera_mac = 0.95;         // MAC with a vibrating camera, at a frequency where no mode is expected
  double max_late_damping = 0.001;      // of a steady force, over the longest lags of a segment
  double min_late_share = 0.86;         // ... and at least this share of the correlation must remain there
  double least_fold_margin = 0.3;       // a folded frequency is certain with this lead over the next hypothesis
  double max_published_base_share = 0.3;
  double max_frequency_hz = 0.0;  // modes are not searched for above it; 0 = no limit
  // Record properties needed for a verdict. With too few cycles, or samples per Hankel row, a pole stays a candidate.
  double record_s = 0.0, resolution_hz = 0.0, samples_per_row = 0.0;  // record_s 0 = unknown: not tested
  double least_cycles = 10.0;
  double least_samples_per_row = 8.0;
};

// Returns a cluster as a mode with its verdict and the reason in words.
[[nodiscard]] Mode judge(const PoleCluster& cluster, const BaseResponse& response,
                         const std::vector<ChannelInfo>& channels, const std::vector<int>& orders,
                         const VerdictRules& rules, const SpectralLineEvidence& line = {});

// Found in fewer orders, or later, than a pole that is certain.
[[nodiscard]] bool is_late(const PoleCluster& cluster, const VerdictRules& rules) noexcept;

// The published method classifies poles by frequency and base motion only: every vibration (damping above 0 and up to
// `max_damping`) with little base motion (max_published_base_share) is a mode.
[[nodiscard]] Mode judge_as_published(const PoleCluster& pole, const std::vector<ChannelInfo>& channels,
                                      const VerdictRules& rules);
// Rejects a pole that moves in one channel only, if a part of that channel's record is missing.
void reject_lone_motion(Mode& mode, const std::string& channel, double seen);

// Writes mode numbers by frequency into the reasons, as in Table 1 of the paper.
void number_by_frequency(std::vector<Mode>& modes);

}  // namespace core
