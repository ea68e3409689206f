#include "firmware_app/chain/state/setup_sums.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/identification/inverse_variance.h"
#include "core/spectrum/welch_cpsd.h"
#include "firmware_app/chain/state/byte_archive.h"
#include "firmware_app/chain/state/channel_archive.h"

namespace app {

namespace {

const auto kBlocks = static_cast<std::size_t>(core::WelchConfig{}.n_blocks);
constexpr double kSamePower = 1e-5;            // rounding in a tracks.csv changes less; another flight more
constexpr std::uint32_t kLayout = 0x33767368;  // first four bytes

template <class Archive, class Sums>
void describe_totals(Archive& archive, Sums& sums) {
  archive.value(sums.n_channels);
  archive.value(sums.n_fft);
  archive.value(sums.rate_hz);
  archive.value(sums.n_segments);
  archive.value(sums.weight);
  archive.value(sums.n_samples);
  archive.value(sums.n_missing);
  archive.list(sums.n_outlying);
  archive.value(sums.window_power);
  archive.list(sums.data_sum);
  archive.list(sums.mask_sum);
}

template <class Archive, class Block>
void describe_block(Archive& archive, Block& block) {
  archive.value(block.n_segments);
  archive.value(block.weight);
  archive.list(block.data_sum);
  archive.list(block.mask_sum);
}

template <class Archive, class Config>
void describe_identifier(Archive& archive, Config& identifier) {
  archive.list(identifier.references);
  archive.value(identifier.block_rows);
  archive.value(identifier.max_order);
  archive.value(identifier.max_frequency_hz);
  archive.value(identifier.min_mpc);
  archive.value(identifier.max_damping);
  archive.value(identifier.n_differences);
  archive.value(identifier.edge_hz);
  archive.value(identifier.least_power);
  archive.value(identifier.undo_row_delays);
  archive.value(identifier.as_published);
}

template <class Archive, class Basis>
void describe_basis(Archive& archive, Basis& basis) {
  describe_identifier(archive, basis.identifier);
  archive.list(basis.row_share);
  archive.value(basis.rate_hz);
  archive.value(basis.declared);
}

bool same_identification(const core::IdentifierConfig& a, const core::IdentifierConfig& b) {
  const auto bytes = [](const core::IdentifierConfig& config) {
    ByteWriter out;
    describe_identifier(out, config);
    return std::move(out.bytes);
  };
  return bytes(a) == bytes(b);
}

// Checks everything that identification and comparison rely on.
bool is_consistent(const SetupSums& view) {
  const core::CpsdSums& sums = view.record.sums;
  if (sums.n_channels < 1 || sums.n_fft < 2 || !(sums.rate_hz > 0.0)) return false;
  const auto channels = static_cast<std::size_t>(sums.n_channels);
  if (view.record.channels.size() != channels || view.basis.row_share.size() != channels) return false;
  if (!sums.n_outlying.empty() && sums.n_outlying.size() != channels) return false;
  const std::size_t size = channels * (channels + 1) / 2 * static_cast<std::size_t>(sums.n_bins());
  const auto fits = [size](const auto& part) { return part.data_sum.size() == size && part.mask_sum.size() == size; };
  return fits(sums) && std::all_of(sums.blocks.begin(), sums.blocks.end(), fits);
}

}  // namespace

std::vector<std::uint8_t> to_bytes(const SetupSums& sums) {
  ByteWriter out;
  out.value(kLayout);
  out.list(to_bytes(sums.view));
  out.value(static_cast<std::uint64_t>(sums.record.channels.size()));
  for (const core::ChannelInfo& channel : sums.record.channels) {
    describe_channel(out, channel);
    out.value(channel.is_witness);
  }
  describe_basis(out, sums.basis);
  out.value(sums.from_tracks);
  describe_totals(out, sums.record.sums);
  out.value(static_cast<std::uint64_t>(sums.record.sums.n_blocks));
  for (std::size_t b = 0; b < sums.record.sums.n_blocks; ++b) describe_block(out, sums.record.sums.blocks[b]);
  return std::move(out.bytes);
}

SetupSums setup_sums_of(std::span<const std::uint8_t> bytes) {
  ByteReader in(bytes);
  SetupSums sums;
  std::uint32_t layout = 0;
  in.value(layout);
  if (layout != kLayout) throw std::runtime_error("they are not spectral sums of this version");
  std::vector<std::uint8_t> view;
  in.list(view);
  sums.view = run_state_of(view);
  sums.record.channels.resize(in.count());
  for (core::ChannelInfo& channel : sums.record.channels) {
    describe_channel(in, channel);
    in.value(channel.is_witness);
  }
  describe_basis(in, sums.basis);
  in.value(sums.from_tracks);
  describe_totals(in, sums.record.sums);
  sums.record.sums.blocks.resize(in.count());
  sums.record.sums.n_blocks = sums.record.sums.blocks.size();
  for (core::CpsdBlock& block : sums.record.sums.blocks) describe_block(in, block);
  if (!is_consistent(sums)) throw std::runtime_error("their sizes contradict each other");
  return sums;
}

SetupSums without_sums(const SetupSums& sums) {
  SetupSums out{sums.view, {{}, sums.record.channels}, sums.basis, sums.from_tracks};
  out.record.sums.copy_totals(sums.record.sums, 0);
  out.record.sums.n_channels = sums.record.sums.n_channels;
  return out;
}

std::string why_other_view(const SetupSums& a, const SetupSums& b) {
  RunState view = b.view;  // row delays are compared separately: sums can be converted to other row delays
  for (std::size_t c = 0; c < std::min(view.channels.size(), a.view.channels.size()); ++c)
    view.channels[c].row_delay_s = a.view.channels[c].row_delay_s;
  if (std::string reason = why_foreign(a.view, view); !reason.empty()) return reason;
  const double most_s = core::most_delay_undone_s(a.record.sums.rate_hz);
  if (std::string reason = core::why_not_addable(a.record, b.record, most_s); !reason.empty()) return reason;
  return same_identification(a.basis.identifier, b.basis.identifier) ? ""
                                                                     : "its modes were to be identified in another way";
}

SumsFingerprint fingerprint(const core::CpsdSums& sums) {
  SumsFingerprint print{sums.n_samples, std::vector<double>(static_cast<std::size_t>(sums.n_channels), 0.0)};
  for (int k = 0; k < sums.n_bins(); ++k) {
    for (int c = 0; c < sums.n_channels; ++c) {
      const int at = k * sums.n_pairs() + core::CpsdSums::pair_index(c, c, sums.n_channels);
      print.power[static_cast<std::size_t>(c)] += sums.data_sum[static_cast<std::size_t>(at)].real();
    }
  }
  return print;
}

bool same_samples(const SumsFingerprint& a, const SumsFingerprint& b) {
  return a.n_samples == b.n_samples && a.n_samples > 0 &&
         std::equal(a.power.begin(), a.power.end(), b.power.begin(), b.power.end(),
                    [](double p, double q) { return std::abs(p - q) <= kSamePower * std::max(p, q); });
}

ViewTotal::ViewTotal(std::uint64_t n_segments_of_all) : sum_(n_segments_of_all, kBlocks) {}

void ViewTotal::add(const SetupSums& sums) {
  if (from_tracks_.empty()) {
    first_ = without_sums(sums);
  } else if (const std::string reason = why_other_view(first_, without_sums(sums)); !reason.empty()) {
    throw std::invalid_argument("runs cannot be added: " + reason);
  }
  sum_.add(sums.record);
  from_tracks_.push_back(sums.from_tracks);
}

core::ModalEstimate ViewTotal::identify() const {
  std::vector<core::Measured> measured;
  for (const core::ReadoutEstimate& one : from_tracks_) {
    if (one.observable && one.std_frames > 0.0)
      measured.push_back({one.frames, one.std_frames, static_cast<double>(one.n_degrees)});
  }
  core::ReadoutEstimate together;
  if (!measured.empty()) {
    const core::WeightedMean mean = core::inverse_variance_mean(measured);
    together.observable = true;
    together.frames = mean.value, together.std_frames = mean.std;
  }
  core::ModalEstimate estimate =
      ReadoutAwareIdentifier(first_.basis, sum_.total().channels).identify(sum_.total().sums, together);
  estimate.final = true;
  return estimate;
}

}  // namespace app
