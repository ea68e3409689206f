#include <algorithm>
#include <cmath>

#include "tools/hovermodal/ground/json_parts.h"

namespace tools {
namespace {

using drivers::StreamMonitor;
using nlohmann::json;

constexpr std::size_t kMostPlacesOfRegions = 256;

template <class Values>
json numbers(const Values& values, std::size_t most, int digits) {
  json out = json::array();
  for (std::size_t i = 0; i < std::min(values.size(), most); ++i)
    out.push_back(rounded(static_cast<double>(values[i]), digits));
  return out;
}

const char* verdict_name(std::int8_t verdict) {
  using Mode = hovermodal::mode_t;
  switch (verdict) {
    case Mode::STRUCTURAL:
      return "structural";
    case Mode::CAMERA_MOTION:
      return "camera motion";
    case Mode::INPUT_PEAK:
      return "input peak";
    case Mode::HARMONIC:
      return "harmonic";
    case Mode::AMBIGUOUS:
      return "ambiguous";
    case Mode::CANDIDATE:
      return "candidate";
    default:
      return "numerical";
  }
}

json mode_json(const hovermodal::mode_t& m) {
  const auto of = [](float value, int digits = 4) { return rounded(static_cast<double>(value), digits); };
  json out{{"verdict", verdict_name(m.verdict)},
           {"structural", m.is_structural != 0},
           {"hz", rounded(m.frequency_hz, 7)},
           {"hz_std", of(m.frequency_std_hz, 3)},
           {"apparent_hz", rounded(m.apparent_hz, 7)},
           {"fold", m.fold_n == hovermodal::mode_t::FOLD_UNKNOWN ? json(nullptr) : json(m.fold_n)},
           {"damping", of(m.damping_ratio)},
           {"damping_std", of(m.damping_std, 3)},
           {"mpc", of(m.mpc, 3)},
           {"presence", of(m.presence, 3)},
           {"reason", m.reason},
           {"id", m.track_id}};
  out["re"] = numbers(m.shape_re, kMostShownChannels, 3), out["im"] = numbers(m.shape_im, kMostShownChannels, 3);
  if (m.track_id == 0) return out;
  out["n_estimates"] = m.n_estimates;
  out["more_s"] = of(m.more_s);
  out["drifts"] = m.drifts != 0;
  out["drift_hz_per_min"] = rounded(static_cast<double>(m.drift_hz_per_s) * 60.0, 3);
  return out;
}

// Several bins are pooled by their maximum, so that a narrow peak remains; as log10, two decimals.
json pooled_log10(const std::vector<float>& psd, std::size_t n_pooled) {
  json out = json::array();
  for (std::size_t k = 0; k < psd.size(); k += n_pooled) {
    double largest = 0.0;
    for (std::size_t i = k; i < std::min(k + n_pooled, psd.size()); ++i)
      largest = std::max(largest, static_cast<double>(psd[i]));
    out.push_back(largest > 0.0 && std::isfinite(largest) ? json(std::round(100.0 * std::log10(largest)) / 100.0)
                                                          : json(nullptr));
  }
  return out;
}

}  // namespace

json modes_json(const StreamMonitor& monitor) {
  const auto& e = *monitor.estimate();
  json out{{"number", e.number},         {"n_samples", e.n_samples},      {"n_segments", e.n_segments},
           {"n_missing", e.n_missing},   {"rate_hz", rounded(e.rate_hz)}, {"duration_s", rounded(e.duration_s, 7)},
           {"order", e.model_order},     {"final", e.is_final != 0},      {"status", e.status},
           {"n_rejected", e.n_rejected}, {"amendments", e.amendments},    {"channels", json::array()},
           {"modes", json::array()}};
  for (std::size_t i = 0; i < std::min(e.channel_names.size(), kMostShownChannels); ++i)
    out["channels"].push_back(e.channel_names[i]);
  for (const auto* mode : monitor.modes()) {
    if (out["modes"].size() >= kMostShownModes) break;
    out["modes"].push_back(mode_json(*mode));
  }
  return out;
}

json spectra_json(const StreamMonitor& monitor) {
  json out{{"channels", json::array()}};
  std::size_t n_pooled = 1;
  for (const auto& spectrum : monitor.spectra()) {
    if (!spectrum || out["channels"].size() >= kMostShownChannels) continue;
    if (out["channels"].empty()) {
      n_pooled = (spectrum->psd_mm2_per_hz.size() + kMostShownBins - 1) / kMostShownBins;
      n_pooled = std::max(n_pooled, std::size_t{1});
      const double step_hz = spectrum->n_fft > 0 ? spectrum->rate_hz / spectrum->n_fft : 0.0;
      out["step_hz"] = rounded(step_hz * static_cast<double>(n_pooled), 9);
      out["first_hz"] = rounded(step_hz * 0.5 * static_cast<double>(n_pooled - 1), 9);
      out["n_segments"] = spectrum->n_segments;
      out["rate_hz"] = rounded(spectrum->rate_hz);
    }
    out["channels"].push_back(
        {{"name", spectrum->channel_name}, {"log10", pooled_log10(spectrum->psd_mm2_per_hz, n_pooled)}});
  }
  return out;
}

json preview_json(const StreamMonitor& monitor) {
  const auto& p = *monitor.preview();
  json out{{"n", p.sequence},
           {"frame", p.frame_sequence},
           {"t_s", rounded(static_cast<double>(p.stream_time_ns) * 1e-9, 9)},
           {"image", {p.image_width_px, p.image_height_px}},
           {"size", {p.width_px, p.height_px}},
           {"scale", rounded(static_cast<double>(p.scale))},
           {"has_jpeg", p.n_jpeg > 0},
           {"regions", json::array()}};
  for (std::size_t r = 0; r < std::min(p.region_u_px.size(), kMostPlacesOfRegions); ++r) {
    const auto at = [r](const std::vector<float>& values) { return rounded(static_cast<double>(values[r]), 5); };
    out["regions"].push_back(
        {{"rect", {at(p.region_u_px), at(p.region_v_px), at(p.region_width_px), at(p.region_height_px)}},
         {"role", p.region_role[r]},
         {"moved", p.region_moved[r] != 0}});
  }
  const std::size_t step = p.u_px.size() / (kMostShownPoints + 1) + 1;
  json u = json::array(), v = json::array(), region = json::array(), inlier = json::array();
  for (std::size_t i = 0; i < p.u_px.size(); i += step) {
    u.push_back(rounded(static_cast<double>(p.u_px[i])));
    v.push_back(rounded(static_cast<double>(p.v_px[i])));
    region.push_back(p.region[i]);
    inlier.push_back(p.inlier[i] != 0 ? 1 : 0);
  }
  out["points"] = {
      {"u", std::move(u)}, {"v", std::move(v)}, {"region", std::move(region)}, {"inlier", std::move(inlier)}};
  return out;
}

json traces_json(const StreamMonitor& monitor, std::uint64_t first) {
  const auto& times = monitor.history_ns();
  const std::uint64_t oldest = monitor.n_samples() - times.size();
  const double rate_hz = monitor.health() ? monitor.health()->rate_hz : 0.0;
  const bool is_fast = rate_hz > kShownRate_hz && rate_hz < 1e6;
  const auto stride = is_fast ? static_cast<std::uint64_t>(std::ceil(rate_hz / kShownRate_hz)) : std::uint64_t{1};
  std::uint64_t begin = std::max(first, oldest);
  begin = (begin + stride - 1) / stride * stride;
  const std::size_t n_channels = std::min(monitor.n_channels(), kMostShownChannels);
  json out{{"first", begin},       {"next", monitor.n_samples()}, {"stride", stride},
           {"t_s", json::array()}, {"channels", json::array()},   {"mm", json::array()}};
  for (std::uint64_t n = begin; n < monitor.n_samples(); n += stride) {
    out["t_s"].push_back(rounded(static_cast<double>(times[n - oldest]) * 1e-9, 9));
  }
  for (std::size_t c = 0; c < n_channels; ++c) {
    const auto& values = monitor.history_mm(c);
    json mm = json::array();
    for (std::uint64_t n = begin; n < monitor.n_samples(); n += stride) {
      mm.push_back(rounded(static_cast<double>(values[n - oldest]), 4));
    }
    out["channels"].push_back(monitor.channel_name(c));
    out["mm"].push_back(std::move(mm));
  }
  return out;
}

}  // namespace tools
