#include "core/identification/model_fit.h"

#include <algorithm>
#include <cmath>

#include "core/identification/given_inputs.h"
#include "core/identification/measured_inputs.h"
#include "core/identification/prewhitening.h"
#include "core/identification/uncertainty.h"
#include "core/types/witness.h"

namespace core {

namespace {

constexpr int kMaxReferences = 6;
constexpr int kLeastBlockRows = 6;
// Limit of the Hankel matrix's rows over all channels: 40 block rows of 6 channels. With few channels there are more
// block rows, which separates close modes.
constexpr int kMostRows = 240;
// ... and where lines are closer than their widths. More rows everywhere also fit more poles to noise.
constexpr int kMostRowsOfClose = 360;
constexpr std::size_t kMostChannelsOfClose = 8;
// The weights are covariance matrices of block_rows * channels rows: with fewer samples per row they fit the noise, and
// every singular value is close to 1.
constexpr double kSamplesPerRow = 16.0;
// A coloured, non-stationary input (an earthquake) gives canonical correlations above one half at any model order,
// without a drop by this ratio (a system in noise: 2.5-3).
constexpr double kLeastOrderGap = 1.3;
constexpr int kUnclearBlockRows = 20;
constexpr double kUnclearThreshold = 0.7;
// With fewer channels the shape of any pole is collinear, and only the strict rule for the first order rejects noise.
constexpr std::size_t kLeastChannelsForMpc = 3;

bool order_is_clear(const Realisation& realisation, int order, int block_rows) {
  if (2 * order <= block_rows) return true;
  // One or two correlations next to the gap may fall on the wrong side of one half.
  const Eigen::VectorXd& s = realisation.singular_values;
  for (Eigen::Index k = std::max(1, order - 2); k <= order + 1 && k < s.size(); ++k) {
    if (s[k - 1] > kLeastOrderGap * s[k]) return true;
  }
  return false;
}

std::vector<int> choose_references(const IdentifierConfig& config, const std::vector<ChannelInfo>& channels) {
  if (!config.references.empty()) return config.references;
  std::vector<int> structure;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (!channels[c].is_base && !channels[c].is_witness) structure.push_back(static_cast<int>(c));
  }
  if (structure.empty()) structure.push_back(0);
  const auto n = static_cast<int>(structure.size());
  if (n <= kMaxReferences) return structure;
  std::vector<int> spread;  // evenly over the channels, both ends included
  spread.reserve(kMaxReferences);
  for (int k = 0; k < kMaxReferences; ++k) {
    spread.push_back(structure[static_cast<std::size_t>(k * (n - 1) / (kMaxReferences - 1))]);
  }
  return spread;
}

int block_rows_of(const CpsdSums& sums, int most_rows, std::size_t n_channels) {
  const double rows = std::min<double>(most_rows, sums.n_remembered() / kSamplesPerRow);
  // The weights contain the window's taper, the Hankel matrix does not: up to an eighth of a segment they agree.
  const int longest = sums.n_fft / 16;
  return std::clamp(static_cast<int>(rows) / static_cast<int>(n_channels), kLeastBlockRows,
                    std::max(kLeastBlockRows, longest));
}

int choose_block_rows(const CpsdSums& sums, const IdentifierConfig& config, std::size_t n_channels) {
  return config.block_rows > 0 ? config.block_rows : block_rows_of(sums, kMostRows, n_channels);
}

EraConfig era_config(const CpsdSums& sums, const IdentifierConfig& config, const std::vector<ChannelInfo>& channels,
                     int n_differences) {
  EraConfig era;
  era.block_rows = choose_block_rows(sums, config, n_resolved(channels));
  era.first_lag = 1 + n_differences;
  era.references = choose_references(config, channels);
  if (!config.as_published) era.inputs = measured_inputs(sums, channels);
  const auto is_input = [&](int c) { return std::find(era.inputs.begin(), era.inputs.end(), c) != era.inputs.end(); };
  if (std::any_of(era.references.begin(), era.references.end(), is_input)) era.inputs.clear();
  era.above_canonical = 2 * (kMostOrders - 1);
  era.with_maps = sums.n_blocks >= kLeastScatterBlocks;
  return era;
}

EraStatus realise_up_to(int max_order, ModelFit& fit) {
  const auto least = std::min(fit.era.references.size(), static_cast<std::size_t>(fit.correlations.n_channels()));
  const int room = static_cast<int>(least) * fit.era.block_rows;
  fit.era.max_order = max_order > 0 ? std::min(max_order, room) : room;
  return realise(fit.correlations, fit.era, fit.realisation);
}

// A short memory keeps the model from fitting the spectrum of the input.
EraStatus realise_with_short_memory(int max_order, ModelFit& fit) {
  fit.era.block_rows = kUnclearBlockRows;
  const EraStatus status = realise_up_to(max_order, fit);
  if (status == EraStatus::kOk) fit.order = canonical_order(fit.realisation, kUnclearThreshold);
  return status;
}

// Fits one order without evaluating its singular values, as the published method does.
EraStatus realise_as_published(int max_order, ModelFit& fit) {
  fit.era.canonical_variates = false;
  fit.era.above_canonical = 0;
  const EraStatus status = realise_up_to(max_order > 0 ? max_order : kPublishedOrder, fit);
  fit.order = static_cast<int>(fit.realisation.a.rows());
  fit.order_is_clear = true;
  return status;
}

EraStatus realise_from_canonical_order(const IdentifierConfig& config, ModelFit& fit) {
  EraStatus status = realise_up_to(config.max_order, fit);
  if (status != EraStatus::kOk) return status;
  fit.order = canonical_order(fit.realisation);
  const bool can_shorten = config.block_rows == 0 && fit.era.block_rows > kUnclearBlockRows;
  fit.order_is_clear = !can_shorten || order_is_clear(fit.realisation, fit.order, fit.era.block_rows);
  return fit.order_is_clear ? status : realise_with_short_memory(config.max_order, fit);
}

}  // namespace

namespace {

// Finds the channel with the least power, for the message.
std::string still_channel(const CpsdSums& sums, const std::vector<ChannelInfo>& channels) {
  std::size_t still = 0;
  double least = HUGE_VAL;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const auto pair =
        static_cast<std::size_t>(CpsdSums::pair_index(static_cast<int>(c), static_cast<int>(c), sums.n_channels));
    double power = 0.0;
    for (std::size_t at = pair; at < sums.data_sum.size(); at += static_cast<std::size_t>(sums.n_pairs()))
      power += sums.data_sum[at].real();
    if (power < least) least = power, still = c;
  }
  return channels.empty() ? "" : ": " + channels[still].name;
}

}  // namespace

std::string fit_model(const CpsdSums& sums, const IdentifierConfig& config, const std::vector<ChannelInfo>& channels,
                      ModelFit& out) {
  out.n_differences = config.as_published         ? 0
                      : config.n_differences >= 0 ? config.n_differences
                                                  : choose_differences(sums, config.max_frequency_hz);
  out.era = era_config(sums, config, channels, out.n_differences);
  const CorrelationStatus status =
      compute_correlations(sums, furthest_lag(out.era), out.n_differences, out.correlations, {}, config.least_power);
  if (status == CorrelationStatus::kNoPower) return to_string(status) + still_channel(sums, channels);
  if (status != CorrelationStatus::kOk) return to_string(status);
  const EraStatus era_status =
      config.as_published ? realise_as_published(config.max_order, out) : realise_from_canonical_order(config, out);
  if (era_status != EraStatus::kOk) {
    return "the correlations carry no system: nothing moves, or the segment is too short";
  }
  out.last_first_i_order = channels.size() - out.era.inputs.size() < kLeastChannelsForMpc ? 0 : 1;
  if (out.order == 0) out.last_first_i_order = -1;
  out.order = std::max(2, out.order);
  return "ok";
}

std::size_t n_resolved(const std::vector<ChannelInfo>& channels) {
  return channels.size() - static_cast<std::size_t>(std::count_if(channels.begin(), channels.end(), witnesses_turn));
}

int longer_block_rows(const CpsdSums& sums, const IdentifierConfig& config, const ModelFit& fit,
                      const std::vector<ChannelInfo>& channels) {
  const std::size_t n_channels = n_resolved(channels);
  if (config.block_rows > 0 || n_channels > kMostChannelsOfClose) return 0;
  const int longer = block_rows_of(sums, kMostRowsOfClose, n_channels);
  return longer > fit.era.block_rows ? longer : 0;
}

}  // namespace core
