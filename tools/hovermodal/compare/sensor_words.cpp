#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "drivers/storage/json.h"
#include "drivers/storage/json_values.h"
#include "tools/hovermodal/compare/sensor.h"

namespace tools {
namespace {

constexpr const char* kQuantities[] = {"displacement", "velocity", "acceleration"};

double shown_rmse(const SensorFindings& findings) {
  return findings.is_scaled ? findings.comparison.rmse_scaled : findings.comparison.rmse;
}

// In pixels, where the scale is known or the channel is in px itself.
std::optional<double> rmse_px(const SensorFindings& findings) {
  if (findings.unit == "px") return shown_rmse(findings);
  if (findings.unit != "mm" || !findings.mm_per_px || !(*findings.mm_per_px > 0.0)) return std::nullopt;
  return shown_rmse(findings) / *findings.mm_per_px;
}

std::string rmse_words(const SensorFindings& findings) {
  const auto px = rmse_px(findings);
  std::string text = fmt::format("{:.4g} {}", shown_rmse(findings), findings.unit);
  if (px && findings.unit != "px") text += fmt::format(", {:.4g} px at {:.4g} mm/px", *px, *findings.mm_per_px);
  if (!findings.is_scaled)
    text += fmt::format("; {:.4g} mm with the amplitude corrected", findings.comparison.rmse_scaled);
  return text;
}

std::string amplitude_words(const SensorFindings& findings) {
  const core::ClockAlignment& alignment = findings.comparison.alignment;
  const double ratio = std::abs(alignment.ratio);
  if (findings.is_scaled)
    return fmt::format("{:.5g} ± {:.2g} of the channel's unit per sensor unit; its bias is not known", ratio,
                       alignment.ratio_std);
  return fmt::format("camera / sensor {:.5f} ± {:.5f}: bias {:+.3f} ± {:.3f} %", ratio, alignment.ratio_std,
                     100.0 * (ratio - 1.0), 100.0 * alignment.ratio_std);
}

}  // namespace

std::string sensor_text(const SensorFindings& findings) {
  const core::SensorComparison& found = findings.comparison;
  const core::ClockRelation& clock = found.alignment.clock;
  std::string text = fmt::format("channel      {} of {}: {} samples at {:g} Hz\n", findings.channel, findings.run,
                                 findings.n_camera, findings.camera_rate_hz);
  text += fmt::format("sensor       {} of {}: {} samples at {:g} Hz, {}\n", findings.sensor_channel, findings.sensor,
                      findings.n_sensor, findings.sensor_rate_hz, kQuantities[findings.n_integrations]);
  text += fmt::format("band         {:.4g} ... {:.4g} Hz, {}\n", found.band.low_hz, found.band.high_hz,
                      found.band_is_chosen
                          ? "chosen: from the lowest to the highest frequency at which half of the power is common"
                          : "as given");
  text += fmt::format(
      "clocks       sensor = camera {:+.6f} ± {:.6f} s at {:.2f} s of the camera, rate {:+.2f} ± {:.2f} ppm\n",
      findings.offset_s(), clock.offset_std_s, findings.middle_s(), 1e6 * clock.rate, 1e6 * clock.rate_std);
  text += fmt::format("compared     {} samples, {:.2f} ... {:.2f} s; the sensor's rms is {:.4g} {}\n", found.n_samples,
                      found.t_s.front() + findings.camera_first_s, found.t_s.back() + findings.camera_first_s,
                      found.sensor_rms, findings.is_scaled ? "of its unit" : "mm");
  text += "RMSE         " + rmse_words(findings) + "\n";
  text += fmt::format("correlation  {:.5f}\n", found.correlation);
  text += fmt::format("coherence    {:.5f}, mean over the band, weighted by power, {} segments\n", found.coherence,
                      found.n_averages);
  text += "amplitude    " + amplitude_words(findings) + "\n";
  if (found.alignment.frame_share_std > 0.0)
    text += fmt::format("video codec  adds {:+.4f} ± {:.4f} of the motion between frames; this is part of the sigmas\n",
                        found.alignment.frame_share, found.alignment.frame_share_std);
  if (found.alignment.ratio < 0.0) text += "note: channel and sensor have opposite signs; the sensor's was changed\n";
  if (found.alignment.rival)
    text += fmt::format(
        "note: an offset of {:+.4f} s is almost as likely (log-likelihood {:.1f} below); --max-offset narrows the "
        "search\n",
        found.alignment.rival->offset_s + findings.sensor_first_s - findings.camera_first_s,
        found.alignment.rival->evidence);
  for (const std::string& remark : findings.remarks) text += "note: " + remark + "\n";
  return text;
}

std::string sensor_json(const SensorFindings& findings) {
  const core::SensorComparison& found = findings.comparison;
  const core::ClockAlignment& alignment = found.alignment;
  nlohmann::ordered_json json = {{"version", 1},
                                 {"channel", findings.channel},
                                 {"sensor", findings.sensor_channel},
                                 {"sensor_quantity", kQuantities[findings.n_integrations]},
                                 {"unit", findings.unit},
                                 {"amplitude_is_compared", !findings.is_scaled},
                                 {"band_hz", {found.band.low_hz, found.band.high_hz}},
                                 {"band_is_chosen", found.band_is_chosen},
                                 {"offset_s", findings.offset_s()},
                                 {"offset_std_s", alignment.clock.offset_std_s},
                                 {"offset_at_camera_s", findings.middle_s()},
                                 {"rate_ppm", 1e6 * alignment.clock.rate},
                                 {"rate_std_ppm", 1e6 * alignment.clock.rate_std},
                                 {"samples", found.n_samples},
                                 {"from_s", found.t_s.front() + findings.camera_first_s},
                                 {"to_s", found.t_s.back() + findings.camera_first_s},
                                 {"rmse", shown_rmse(findings)},
                                 {"rmse_px", drivers::or_null(rmse_px(findings))},
                                 {"rmse_amplitude_corrected", found.rmse_scaled},
                                 {"sensor_rms", found.sensor_rms},
                                 {"correlation", found.correlation},
                                 {"coherence", found.coherence},
                                 {"amplitude_ratio", std::abs(alignment.ratio)},
                                 {"amplitude_ratio_std", alignment.ratio_std},
                                 {"opposite_signs", alignment.ratio < 0.0}};
  json["frame_share"] = nullptr, json["frame_share_std"] = nullptr;  // a table that is no run is of no video
  if (alignment.frame_share_std > 0.0)
    json["frame_share"] = alignment.frame_share, json["frame_share_std"] = alignment.frame_share_std;
  json["rival_offset_s"] = nullptr;
  if (alignment.rival)
    json["rival_offset_s"] = alignment.rival->offset_s + findings.sensor_first_s - findings.camera_first_s;
  json["notes"] = findings.remarks;
  return drivers::to_json_text(json).text;
}

}  // namespace tools
