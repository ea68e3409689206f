#include "core/identification/identifier.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "core/identification/correlation.h"
#include "core/identification/era.h"
#include "core/identification/line_evidence.h"
#include "core/identification/uncertainty.h"
#include "core/identification/verdict.h"

namespace core {

namespace {

constexpr int kMaxReferences = 6;
constexpr int kOrders = 15;              // of the stabilisation diagram, two apart
constexpr double kLeastPresence = 0.25;  // poles of fewer orders are the scatter of over-modelling, not worth a verdict
constexpr int kLeastBlockRows = 6;
// Rows of the Hankel matrix, all channels together: 40 block rows of 6 channels. Few channels take more block rows,
// which is what separates close lines.
constexpr int kMostRows = 240;
// The weights are covariance matrices of block_rows * channels: with fewer samples per row than this they fit the noise
// and every singular value comes out near 1.
constexpr double kSamplesPerRow = 16.0;

void copy_stream_facts(const CpsdSums& sums, ModalEstimate& estimate) {
  estimate.n_samples = sums.n_samples;
  estimate.n_segments = sums.n_segments;
  estimate.n_missing = sums.n_missing;
  estimate.rate_hz = sums.rate_hz;
  estimate.duration_s = static_cast<double>(sums.n_samples) / sums.rate_hz;
}

// Every pole of every order, as observed and unfolded; the two lists run in parallel.
struct Poles {
  std::vector<PoleOfOrder> observed;
  std::vector<OrderPole> unfolded;
};

Poles poles_of_orders(const Realisation& realisation, const std::vector<int>& orders, const FoldingConfig& folding) {
  Poles poles;
  for (std::size_t i = 0; i < orders.size(); ++i) {
    for (DiscretePole& pole : poles_of_order(realisation, orders[i])) {
      poles.unfolded.push_back({static_cast<int>(i), unfold(pole.lambda, pole.shape, folding)});
      poles.observed.push_back({orders[i], std::move(pole)});
    }
  }
  return poles;
}

std::vector<PoleCluster> lines_of(const std::vector<OrderPole>& poles, int n_orders) {
  std::vector<PoleCluster> lines = cluster_poles(poles, n_orders);
  join_split_lines(lines, n_orders);
  std::erase_if(lines, [](const PoleCluster& line) { return line.presence < kLeastPresence; });
  return lines;
}

std::vector<int> orders_from(int first, const Realisation& realisation) {
  std::vector<int> orders;
  for (int k = 0; k < kOrders && first + 2 * k <= realisation.a.rows(); ++k) orders.push_back(first + 2 * k);
  return orders;
}

void note_poles(const std::vector<OrderPole>& poles, const std::vector<int>& orders, ModalEstimate& estimate) {
  for (const OrderPole& p : poles) {
    if (estimate.poles.size() == kMaxStabilisationPoles) break;
    estimate.poles.push_back({orders[static_cast<std::size_t>(p.i_order)], p.pole.apparent_hz, frequency_hz(p.pole.s),
                              damping_ratio(p.pole.s), p.pole.mpc, -1});
  }
}

// What the standard deviations of a fit are made of.
struct FitScatter {
  const Realisation& realisation;
  const EraConfig& era;
  const FoldingConfig& folding;
  const std::vector<Correlations>& deviations;
};

// modes[i] belongs to lines[i].
void state_scatter(const FitScatter& fit, const Poles& poles, const std::vector<PoleCluster>& lines,
                   std::vector<Mode>& modes) {
  std::vector<PoleOfOrder> chosen;
  for (const PoleCluster& line : lines) chosen.push_back(poles.observed[line.i_representative]);
  const auto changes = pole_changes(fit.realisation, fit.era, fit.deviations, chosen);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto scatter = mode_scatter(chosen[i], lines[i].representative, fit.folding, changes[i]);
    if (!scatter) continue;
    modes[i].frequency_std_hz = scatter->frequency_hz;
    modes[i].damping_std = scatter->damping_ratio;
    modes[i].shape_std = scatter->shape;
  }
}

// modes[i] belongs to clusters[i]. The poles, which stand in the order of the clusters' members, learn their line.
void list_modes(std::vector<Mode> modes, const std::vector<PoleCluster>& clusters, ModalEstimate& estimate) {
  std::vector<std::size_t> by_frequency(modes.size());
  std::iota(by_frequency.begin(), by_frequency.end(), std::size_t{0});
  std::sort(by_frequency.begin(), by_frequency.end(),
            [&](std::size_t a, std::size_t b) { return modes[a].frequency_hz < modes[b].frequency_hz; });
  int i_line = 0;
  for (const bool structural : {true, false}) {
    for (const std::size_t i : by_frequency) {
      if ((modes[i].verdict == Verdict::kStructural) != structural) continue;
      for (const std::size_t member : clusters[i].members) {
        if (member < estimate.poles.size()) estimate.poles[member].i_line = i_line;
      }
      (structural ? estimate.modes : estimate.rejected).push_back(std::move(modes[i]));
      ++i_line;
    }
  }
}

}  // namespace

Identifier::Identifier(IdentifierConfig config, std::vector<ChannelInfo> channels)
    : config_(std::move(config)), channels_(std::move(channels)) {
  if (channels_.empty()) throw std::invalid_argument("Identifier: no channel");
  for (const int reference : config_.references) {
    if (reference < 0 || reference >= static_cast<int>(channels_.size())) {
      throw std::invalid_argument("Identifier: reference " + std::to_string(reference) + " is no channel");
    }
  }
}

std::vector<int> Identifier::choose_references() const {
  if (!config_.references.empty()) return config_.references;
  std::vector<int> structure;
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    if (!channels_[c].is_base) structure.push_back(static_cast<int>(c));
  }
  if (structure.empty()) structure.push_back(0);
  const auto n = static_cast<int>(structure.size());
  if (n <= kMaxReferences) return structure;
  std::vector<int> spread;  // evenly over the channels, both ends included
  for (int k = 0; k < kMaxReferences; ++k) {
    spread.push_back(structure[static_cast<std::size_t>(k * (n - 1) / (kMaxReferences - 1))]);
  }
  return spread;
}

int Identifier::choose_block_rows(const CpsdSums& sums) const noexcept {
  if (config_.block_rows > 0) return config_.block_rows;
  const double rows = std::min<double>(kMostRows, static_cast<double>(sums.n_samples) / kSamplesPerRow);
  // The weights keep the window's taper, the Hankel matrix does not: up to an eighth of a segment they agree.
  const int longest = sums.n_fft / 16;
  return std::clamp(static_cast<int>(rows) / static_cast<int>(channels_.size()), kLeastBlockRows,
                    std::max(kLeastBlockRows, longest));
}

EraConfig Identifier::era_config(const CpsdSums& sums) const {
  EraConfig era;
  era.block_rows = choose_block_rows(sums);
  era.first_lag = 1 + config_.n_differences;
  era.references = choose_references();
  const int room =
      std::min(static_cast<int>(era.references.size()), static_cast<int>(channels_.size())) * era.block_rows;
  era.max_order = config_.max_order > 0 ? std::min(config_.max_order, room) : room;
  era.above_canonical = 2 * (kOrders - 1);
  era.with_maps = sums.n_blocks >= kScatterBlocks;
  return era;
}

FoldingConfig Identifier::folding_config(double rate_hz) const {
  FoldingConfig folding{rate_hz, config_.max_frequency_hz, {}};
  for (const ChannelInfo& channel : channels_) {
    folding.delay_s.push_back(config_.undo_row_delays ? channel.row_delay_s : 0.0);
  }
  return folding;
}

ModalEstimate Identifier::identify(const CpsdSums& sums) const {
  ModalEstimate estimate;
  copy_stream_facts(sums, estimate);
  const EraConfig era = era_config(sums);
  Correlations correlations;
  const CorrelationStatus status =
      compute_correlations(sums, 2 * era.block_rows + era.first_lag, config_.n_differences, correlations);
  if (status != CorrelationStatus::kOk) {
    estimate.status = to_string(status);
    return estimate;
  }
  Realisation realisation;
  if (realise(correlations, era, realisation) != EraStatus::kOk) {
    estimate.status = "the correlations carry no system: nothing moves, or the segment is too short";
    return estimate;
  }
  estimate.model_order = std::max(2, canonical_order(realisation));
  const std::vector<int> orders = orders_from(estimate.model_order, realisation);
  const FoldingConfig folding = folding_config(sums.rate_hz);
  const Poles poles = poles_of_orders(realisation, orders, folding);
  const std::vector<PoleCluster> lines = lines_of(poles.unfolded, static_cast<int>(orders.size()));

  VerdictRules rules;
  rules.min_mpc = config_.min_mpc;
  rules.max_damping = config_.max_damping;
  std::vector<Mode> modes;
  LineExaminer examiner(sums, folding);
  for (const PoleCluster& line : lines) {
    modes.push_back(judge(line, base_response(sums, channels_, line.apparent_hz), channels_, orders, rules,
                          examiner.examine(line.representative)));
  }
  if (sums.n_blocks >= kScatterBlocks) {
    const auto deviations = block_deviations(sums, config_.n_differences, correlations, kScatterBlocks);
    state_scatter({realisation, era, folding, deviations}, poles, lines, modes);
    estimate.n_blocks = kScatterBlocks;
  }
  reject_twins(modes);
  note_poles(poles.unfolded, orders, estimate);
  list_modes(std::move(modes), lines, estimate);
  estimate.status = "ok";
  return estimate;
}

}  // namespace core
