#pragma once

#include <string>
#include <vector>

#include "core/identification/base_response.h"
#include "core/identification/line_evidence.h"
#include "core/identification/stabilisation.h"
#include "core/types/displacement.h"
#include "core/types/modal_estimate.h"

namespace core {

// What a cluster is measured against before it may be called a mode of the structure.
struct VerdictRules {
  double min_mpc = 0.8;
  double max_damping = 0.15;
  double max_apparent_hz = 0.0;     // above it stands the edge of the filter that came before; 0 = no filter
  double min_presence = 0.85;       // of the orders
  int last_first_i_order = 1;       // present from the canonical order or the next one on
  double max_base_share = 0.1;      // |shape at the base| / largest
  double open_base_share = 0.3;     // up to here a clear answer of the structure to its base decides
  double least_base_gain = 3.0;     // ... of at least this gain, and a local maximum
  double max_uniform_mac = 0.98;    // MAC with all channels moving alike: the camera's own translation
  double max_witness_share = 0.9;   // of the shape's square that is the camera's by what rests
  double min_camera_mac = 0.95;     // with a shaking camera, at a frequency where no mode is expected
  double max_late_damping = 0.001;  // of a steady force, over the longest lags that a segment has
  double min_late_share = 0.86;     // ... and so much of the correlation must be left there: it goes on
  double least_certain_mpc = 0.85;  // a folded frequency is certain from here on ...
  double least_fold_margin = 0.3;   // ... and with this lead over the next hypothesis
  double max_published_base_share = 0.3;
  double max_frequency_hz = 0.0;  // above it nobody looks for modes; 0 = no limit
  // Of the record: what a verdict needs. Fewer cycles, or samples per row of the Hankel matrix, leave a candidate.
  double record_s = 0.0, resolution_hz = 0.0, samples_per_row = 0.0;  // record_s 0 = unknown: not tested
  double least_cycles = 10.0;
  double least_samples_per_row = 8.0;
};

// A cluster as a mode with its verdict and the reason in words.
[[nodiscard]] Mode judge(const PoleCluster& cluster, const BaseResponse& response,
                         const std::vector<ChannelInfo>& channels, const std::vector<int>& orders,
                         const VerdictRules& rules, const SpectralLineEvidence& line = {});

// The published chain knows poles by frequency and by their motion at the base, no more: every vibration (damping above
// 0 and up to `max_damping`) that the base takes little part in (max_published_base_share) is a mode.
[[nodiscard]] Mode judge_as_published(const PoleCluster& pole, const std::vector<ChannelInfo>& channels,
                                      const VerdictRules& rules);
// A pole that moves in one channel only, of which a part of the record is missing, is no mode of the structure.
void reject_lone_motion(Mode& mode, const std::string& channel, double seen);

// Their numbers by frequency, as the paper's Table 1 has them, into their reasons.
void number_by_frequency(std::vector<Mode>& modes);

// Of two structural modes closer than their half-power widths, with MAC > 0.7, the one that is less in phase is a
// mixture with the other if its MPC is below 0.9: it becomes numerical, and its reason says so.
void reject_mixtures(std::vector<Mode>& modes);

// Of two structural modes with MAC > 0.9 within 6 % one that has less than 0.1 % of damping, and less than a third of
// the other's, is a steady force beside it (harmonic). Else the one found in fewer orders is a twin (often an amplitude
// dependence of the same mode): it becomes numerical, and its reason says so.
void reject_twins(std::vector<Mode>& modes);

}  // namespace core
