#include "core/identification/identifier.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <stdexcept>

#include "core/identification/camera_leakage.h"
#include "core/identification/camera_lines.h"
#include "core/identification/chance_poles.h"
#include "core/identification/combination_lines.h"
#include "core/identification/field_shapes.h"
#include "core/identification/line_evidence.h"
#include "core/identification/line_modes.h"
#include "core/identification/measured_inputs.h"
#include "core/identification/mode_sigmas.h"
#include "core/identification/phase_verdict.h"
#include "core/identification/record_poles.h"
#include "core/identification/similar_modes.h"
#include "core/identification/spectral_peaks.h"
#include "core/identification/steady_lines.h"
#include "core/identification/verdict.h"

namespace core {

namespace {

void copy_stream_facts(const CpsdSums& sums, ModalEstimate& estimate) {
  estimate.n_samples = sums.n_samples;
  estimate.n_segments = sums.n_segments;
  estimate.n_missing = sums.n_missing;
  estimate.rate_hz = sums.rate_hz;
  estimate.duration_s = static_cast<double>(sums.n_samples) / sums.rate_hz;
  estimate.remembered_s = sums.n_remembered() / sums.rate_hz;
  estimate.resolution_hz = resolution_hz(sums);
}

void note_poles(const std::vector<OrderPole>& poles, const std::vector<int>& orders, ModalEstimate& estimate) {
  for (const OrderPole& p : poles) {
    if (estimate.poles.size() == kMaxStabilisationPoles) break;
    estimate.poles.push_back({orders[static_cast<std::size_t>(p.i_order)], p.pole.apparent_hz, frequency_hz(p.pole.s),
                              damping_ratio(p.pole.s), p.pole.mpc, -1});
  }
}

// Realisation of a record and the data from which its poles are classified.
struct Fitted {
  const CpsdSums& sums;
  const std::vector<ChannelRecord>& records;
  const FoldingConfig& folding;
  const CameraLeakage& camera;
  const RecordPoles& poles;
};

VerdictRules verdict_rules(const IdentifierConfig& config, const std::vector<ChannelInfo>& channels,
                           const ModelFit& fit, const CpsdSums& sums) {
  VerdictRules rules;
  rules.max_damping = config.max_damping;
  rules.max_apparent_hz = config.edge_hz;
  rules.last_first_i_order = fit.last_first_i_order;
  rules.base_is_input = std::any_of(fit.era.inputs.begin(), fit.era.inputs.end(),
                                    [&](int input) { return channels[static_cast<std::size_t>(input)].is_base; });
  // After a decimation filter, the edge of the filter is the limit.
  if (!(config.edge_hz > 0.0)) rules.max_frequency_hz = config.max_frequency_hz;
  rules.record_s = sums.n_remembered() / sums.rate_hz;
  rules.resolution_hz = resolution_hz(sums);
  rules.samples_per_row = sums.n_remembered() / (fit.era.block_rows * static_cast<double>(n_resolved(channels)));
  return rules;
}

struct JudgedChannels {
  const std::vector<ChannelInfo>&all, &outputs;
};

std::vector<Mode> judge_lines(const Fitted& fitted, const JudgedChannels& channels, const VerdictRules& rules) {
  std::vector<Mode> modes;
  SpectralLineTest examiner(fitted.sums, fitted.folding);
  for (const PoleCluster& line : fitted.poles.lines) {
    SpectralLineEvidence evidence = examiner.examine(line.representative);
    const DiscretePole& observed = fitted.poles.observed[line.i_representative].pole;
    const CameraLeakage::Finding found = fitted.camera.examine(observed.shape, line.apparent_hz);
    evidence.witness_share = found.share, evidence.witness_moves = found.is_doubtful;
    const BaseResponse response = base_response(fitted.sums, channels.all, line.apparent_hz, line.damping_ratio);
    modes.push_back(judge(line, response, channels.outputs, fitted.poles.orders, rules, evidence));
    modes.back().may_be_hz = other_frequencies(line.representative, fitted.folding, rules.least_fold_margin);
    const int lone = lone_masked_channel(modes.back().shape, fitted.records);
    if (lone < 0) continue;
    const auto c = static_cast<std::size_t>(lone);
    reject_lone_motion(modes.back(), channels.outputs[c].name, fitted.records[c].seen);
  }
  reject_combinations(fitted.sums, channels.all, modes);
  return modes;
}

std::vector<Mode> judge_published_lines(const std::vector<PoleCluster>& lines, const JudgedChannels& channels,
                                        const VerdictRules& rules) {
  std::vector<Mode> modes;
  modes.reserve(lines.size());
  for (const PoleCluster& line : lines) modes.push_back(judge_as_published(line, channels.outputs, rules));
  number_by_frequency(modes);
  return modes;
}

// modes[i] belongs to clusters[i]. Poles are in the order of the clusters' members and receive the index of their line.
// Returns the clusters in the order in which they are listed.
std::vector<std::size_t> list_modes(std::vector<Mode> modes, const std::vector<PoleCluster>& clusters,
                                    ModalEstimate& estimate) {
  std::vector<std::size_t> by_frequency(modes.size());
  std::iota(by_frequency.begin(), by_frequency.end(), std::size_t{0});
  std::sort(by_frequency.begin(), by_frequency.end(),
            [&](std::size_t a, std::size_t b) { return modes[a].frequency_hz < modes[b].frequency_hz; });
  std::vector<std::size_t> listed;
  for (const bool structural : {true, false}) {
    for (const std::size_t i : by_frequency) {
      if ((modes[i].verdict == Verdict::kStructural) != structural) continue;
      for (const std::size_t member : clusters[i].members) {
        if (member < estimate.poles.size()) estimate.poles[member].i_line = static_cast<int>(listed.size());
      }
      (structural ? estimate.modes : estimate.rejected).push_back(std::move(modes[i]));
      listed.push_back(i);
    }
  }
  return listed;
}

}  // namespace

Identifier::Identifier(IdentifierConfig config, std::vector<ChannelInfo> channels)
    : config_(std::move(config)), channels_(std::move(channels)) {
  std::copy_if(channels_.begin(), channels_.end(), std::back_inserter(outputs_),
               [](const ChannelInfo& channel) { return !channel.is_witness; });
  if (outputs_.empty()) throw std::invalid_argument("Identifier: no channel");
  for (const int reference : config_.references) {
    if (reference < 0 || reference >= static_cast<int>(n_outputs())) {
      throw std::invalid_argument("Identifier: reference " + std::to_string(reference) + " is no channel");
    }
  }
}

std::vector<double> Identifier::undone_delay_s() const {
  std::vector<double> delay_s;
  for (const ChannelInfo& channel : outputs_) {
    delay_s.push_back(config_.undo_row_delays ? channel.row_delay_s : 0.0);
  }
  return delay_s;
}

std::vector<ChannelInfo> Identifier::delays_as_undone() const {
  std::vector<ChannelInfo> channels = channels_;
  for (ChannelInfo& channel : channels) {
    if (!config_.undo_row_delays) channel.row_delay_s = 0.0;
  }
  return channels;
}

FoldingConfig Identifier::folding_config(double rate_hz) const {
  FoldingConfig folding{rate_hz, config_.max_frequency_hz, undone_delay_s()};
  for (const ChannelInfo& channel : outputs_) folding.n_integrations.push_back(channel.n_integrations);
  return folding;
}

ModalEstimate Identifier::identify_all(const CpsdSums& sums, const std::vector<ChannelRecord>& records,
                                       FieldShapes* field) const {
  ModalEstimate estimate;
  copy_stream_facts(sums, estimate);
  estimate.peaks = spectral_peaks(sums, channels_);
  estimate.channels = records;
  estimate.channels.resize(n_outputs());  // without witnesses, which come last
  for (SpectralPeak& peak : estimate.peaks) peak.share.resize(n_outputs());
  // Of a full field only the core's lines would be known.
  const bool subtracts = !config_.as_published && field == nullptr;
  std::vector<SteadyLine> lines;
  if (subtracts) lines = find_steady_lines(sums, channels_, measured_inputs(sums, channels_));
  if (lines.empty()) {
    identify_modes(sums, records, field, estimate);
    if (subtracts) identify_shared(sums, records, estimate);
  } else {
    const CpsdSums steadied = without_lines(sums, lines);
    identify_modes(steadied, records, field, estimate);
    identify_shared(steadied, records, estimate);
    for (Mode& line : judge_steady_lines(lines, sums, delays_as_undone(), outputs_, folding_config(sums.rate_hz)))
      estimate.rejected.push_back(std::move(line));
  }
  if (subtracts) reject_vague_modes(estimate);
  if (subtracts) list_camera_lines(sums, delays_as_undone(), folding_config(sums.rate_hz), estimate);
  return estimate;
}

void Identifier::identify_modes(const CpsdSums& sums, const std::vector<ChannelRecord>& records, FieldShapes* field,
                                ModalEstimate& estimate) const {
  const FoldingConfig folding = folding_config(sums.rate_hz);
  const CameraLeakage camera(sums, delays_as_undone());
  RecordPoles poles = find_poles(sums, config_, channels_, folding, camera);
  estimate.status = poles.status;
  if (poles.status != "ok") return;
  if (poles.fit.order_is_clear) {
    estimate.model_order = poles.fit.order;
  } else {
    estimate.status = "order unclear: no gap in the canonical correlations; taken from order " +
                      std::to_string(poles.fit.order) + " on";
  }
  const std::vector<PoleCluster>& lines = poles.lines;
  const JudgedChannels channels{channels_, outputs_};
  const VerdictRules rules = verdict_rules(config_, channels_, poles.fit, sums);
  std::vector<Mode> modes = config_.as_published
                                ? judge_published_lines(lines, channels, rules)
                                : judge_lines({sums, records, folding, camera, poles}, channels, rules);
  const Sigmas sigmas =
      state_sigmas({sums, poles.fit, folding, camera, poles.observed, poles.unfolded, poles.leaks}, lines, modes);
  estimate.degrees_of_freedom = sigmas.degrees_of_freedom;
  std::vector<bool> along(modes.size(), false);
  if (!config_.as_published) {
    std::vector<bool> late(lines.size());
    std::transform(lines.begin(), lines.end(), late.begin(),
                   [&](const PoleCluster& line) { return is_late(line, rules); });
    reject_chance_poles(late, rules.record_s, modes);
    if (field != nullptr) reject_vague_modes(modes);
    reject_out_of_phase(config_.min_mpc, sigmas, modes);
    reject_mixtures(modes);
    reject_twins(modes);
    along = state_along_line(sigmas, modes);
  }
  note_poles(poles.unfolded, poles.orders, estimate);
  const std::vector<std::size_t> listed = list_modes(std::move(modes), lines, estimate);
  if (field != nullptr) {
    std::vector<FieldLine> of_field;
    for (const std::size_t i : listed) {
      const std::size_t pole = lines[i].i_representative;
      of_field.push_back({poles.observed[pole], lines[i].representative, along[i], sigmas.scatter[i].has_value(),
                          poles.leaks[pole].has_value()});
    }
    *field = FieldShapes(sums, std::move(poles.fit), folding, std::move(of_field));
  }
}

}  // namespace core
