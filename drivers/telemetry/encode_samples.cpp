#include <algorithm>

#include "drivers/telemetry/encode.h"

namespace drivers {
namespace {

// One-sided density of channel i: every bin except DC and Nyquist includes its negative counterpart.
std::vector<float> density(const core::CpsdSums& sums, int i_channel) {
  const double norm = sums.rate_hz * sums.window_power * sums.weight.sum;
  const auto n_bins = static_cast<std::size_t>(sums.n_bins());
  std::vector<float> psd(n_bins, kUnknown);
  if (!(norm > 0.0)) return psd;
  const auto n_pairs = static_cast<std::size_t>(sums.n_pairs());
  const auto pair = static_cast<std::size_t>(core::CpsdSums::pair_index(i_channel, i_channel, sums.n_channels));
  for (std::size_t k = 0; k < n_bins; ++k) {
    const bool is_single = k == 0 || (sums.n_fft % 2 == 0 && k + 1 == n_bins);
    psd[k] = static_cast<float>(sums.data_sum[k * n_pairs + pair].real() * (is_single ? 1.0 : 2.0) / norm);
  }
  return psd;
}

}  // namespace

std::vector<hovermodal::spectrum_t> to_messages(const core::CpsdSums& sums,
                                                const std::vector<core::ChannelInfo>& channels,
                                                const StreamIdentity& identity) {
  std::vector<hovermodal::spectrum_t> out;
  if (sums.n_channels < 1 || sums.n_fft < 2) return out;
  const auto n_values = static_cast<std::size_t>(sums.n_bins()) * static_cast<std::size_t>(sums.n_pairs());
  if (sums.data_sum.size() != n_values) return out;
  const double stream_s = sums.rate_hz > 0.0 ? static_cast<double>(sums.n_samples) / sums.rate_hz : 0.0;
  for (int i = 0; i < sums.n_channels; ++i) {
    auto message = begin_message<hovermodal::spectrum_t>(identity, static_cast<std::int64_t>(stream_s * 1e9));
    message.channel_index = to_int16(static_cast<std::uint64_t>(i));
    message.n_channels = to_int16(static_cast<std::uint64_t>(sums.n_channels));
    const auto i_channel = static_cast<std::size_t>(i);
    if (i_channel < channels.size()) message.channel_name = clipped(channels[i_channel].name, kMaxNameBytes);
    message.n_samples = static_cast<std::int64_t>(sums.n_samples);
    message.n_segments = static_cast<std::int64_t>(sums.n_segments);
    message.n_missing = static_cast<std::int64_t>(sums.n_missing);
    message.rate_hz = sums.rate_hz;
    message.n_fft = sums.n_fft;
    message.n_bins = sums.n_bins();
    message.psd_mm2_per_hz = density(sums, i);
    out.push_back(std::move(message));
  }
  return out;
}

hovermodal::displacement_t to_message(const core::DisplacementSample& sample, const StreamIdentity& identity) {
  auto out = begin_message<hovermodal::displacement_t>(identity, sample.t_start_ns);
  out.frame_sequence = static_cast<std::int64_t>(sample.sequence);
  out.gap_before = sample.gap_before ? 1 : 0;
  out.scale_mm_per_px = sample.scale_mm_per_px;
  const std::size_t n = std::min({sample.value_mm.size(), sample.sigma_mm.size(), sample.seen.size(),
                                  sample.n_points.size(), std::size_t{INT16_MAX}});
  out.n_channels = static_cast<std::int16_t>(n);
  for (std::size_t i = 0; i < n; ++i) {
    const bool seen = sample.seen[i] != 0;
    out.value_mm.push_back(seen ? static_cast<float>(sample.value_mm[i]) : kUnknown);
    out.sigma_mm.push_back(seen ? static_cast<float>(sample.sigma_mm[i]) : kUnknown);
    out.seen.push_back(seen ? 1 : 0);
    out.n_points.push_back(to_int16(sample.n_points[i]));
  }
  return out;
}

hovermodal::tracks_t to_message(const core::TrackFrame& tracks, const StreamIdentity& identity) {
  auto out = begin_message<hovermodal::tracks_t>(identity, tracks.t_start_ns);
  out.frame_sequence = static_cast<std::int64_t>(tracks.sequence);
  out.gap_before = tracks.gap_before ? 1 : 0;
  out.n_points = static_cast<std::int32_t>(tracks.points.size());
  for (const auto& point : tracks.points) {
    out.u_px.push_back(point.seen ? static_cast<float>(point.u_px) : kUnknown);
    out.v_px.push_back(point.seen ? static_cast<float>(point.v_px) : kUnknown);
    out.sigma_px.push_back(point.seen ? static_cast<float>(point.sigma_px) : kUnknown);
    out.id.push_back(static_cast<std::int32_t>(point.id));
    out.region.push_back(to_int16(point.region));
    out.seen.push_back(point.seen ? 1 : 0);
    out.inlier.push_back(point.inlier ? 1 : 0);
  }
  return out;
}

}  // namespace drivers
