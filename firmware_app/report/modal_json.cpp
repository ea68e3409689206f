#include "firmware_app/report/modal_json.h"

#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/identification/real_shape.h"
#include "core/identification/uncertainty.h"
#include "drivers/storage/json.h"
#include "drivers/storage/json_values.h"
#include "firmware_app/config/region_axis.h"
#include "firmware_app/report/aircraft_facts.h"

namespace app {
namespace {

using Json = nlohmann::ordered_json;
using drivers::or_null;

// 0 means "unknown" in these fields.
Json positive_or_null(double value) { return value == 0.0 ? Json(nullptr) : Json(value); }

std::string channel_name(const std::vector<std::string>& names, std::size_t i) {
  return i < names.size() ? names[i] : fmt::format("channel_{}", i);
}

// Components of excluded channels are unknown.
template <class Value>
Json components_json(const ModalReport& report, std::size_t n, Value value) {
  if (n == 0) return nullptr;
  Json out = Json::object();
  const auto& channels = report.estimate.channels;
  for (std::size_t i = 0; i < n; ++i) {
    const bool is_known = i >= channels.size() || channels[i].takes_part;
    out[channel_name(report.channel_names, i)] = is_known ? Json(value(i)) : Json(nullptr);
  }
  return out;
}

Json shape_json(const core::Mode& mode, const ModalReport& report) {
  return components_json(report, mode.shape.size(), [&](std::size_t i) {
    return Json{mode.shape[i].real(), mode.shape[i].imag()};
  });
}

Json real_shape_json(const core::Mode& mode, const ModalReport& report) {
  const std::vector<double> real = core::real_shape(mode.shape);
  return components_json(report, real.size(), [&](std::size_t i) { return real[i]; });
}

Json shape_std_json(const core::Mode& mode, const ModalReport& report) {
  return components_json(report, mode.shape_std.size(), [&](std::size_t i) { return mode.shape_std[i]; });
}

Json history_json(const std::optional<core::ModeHistory>& history) {
  if (!history) return nullptr;
  return {{"id", history->id},
          {"estimates", history->n_estimates},
          {"first_estimate", history->first_number},
          {"first_seen_s", history->first_seen_s},
          {"fold_changes", history->n_fold_changes},
          {"drift_hz_per_s", or_null(history->drift_hz_per_s)},
          {"drift_std_hz_per_s", or_null(history->drift_std_hz_per_s)},
          {"drifts", history->drifts},
          {"more_s", or_null(history->more_s)}};
}

Json interval_json(const std::optional<core::Interval>& interval) {
  if (!interval) return nullptr;
  return {interval->low, interval->high};
}

// The published method gives real shapes: in paper mode both the real and the complex shape are written.
Json mode_json(const core::Mode& mode, const ModalReport& report) {
  const core::ModalEstimate& estimate = report.estimate;
  Json out = Json::object();
  out["frequency_hz"] = mode.frequency_hz;
  out["frequency_std_hz"] = or_null(mode.frequency_std_hz);
  out["apparent_hz"] = mode.apparent_hz;
  out["fold_n"] = or_null(mode.fold_n);
  out["fold_margin"] = or_null(mode.fold_margin);
  out["may_be_hz"] = mode.may_be_hz;
  out["damping_ratio"] = mode.damping_ratio;
  out["damping_std"] = or_null(mode.damping_std);
  out["damping_interval_95"] = interval_json(core::damping_interval_95(mode, estimate.degrees_of_freedom));
  out["shape"] = shape_json(mode, report);
  if (report.method == to_text(Method::kPaper)) out["shape_real"] = real_shape_json(mode, report);
  out["shape_std"] = shape_std_json(mode, report);
  out["mpc"] = mode.mpc;
  out["emac"] = mode.emac;
  out["cmi"] = mode.emac * mode.mpc;
  out["verdict"] = core::to_string(mode.verdict);
  out["reason"] = mode.reason;
  out["history"] = history_json(mode.history);
  return out;
}

Json modes_json(const std::vector<core::Mode>& modes, const ModalReport& report) {
  Json out = Json::array();
  for (const core::Mode& mode : modes) out.push_back(mode_json(mode, report));
  return out;
}

Json channels_json(const ModalReport& report) {
  Json out = Json::array();
  for (std::size_t i = 0; i < report.estimate.channels.size(); ++i) {
    const core::ChannelRecord& channel = report.estimate.channels[i];
    out.push_back({{"name", channel_name(report.channel_names, i)},
                   {"seen", channel.seen},
                   {"outlying", channel.n_outlying},
                   {"takes_part", channel.takes_part},
                   {"reason", channel.reason.empty() ? Json(nullptr) : Json(channel.reason)}});
  }
  return out;
}

Json axes_json(const std::vector<core::Region>& regions) {
  Json out = Json::array();
  for (const core::Region& region : regions) {
    if (!core::makes_channel(region.role)) continue;
    out.push_back({{"region", region.name}, {"axis", axis_words(region)}, {"from", axis_origin(region)}});
  }
  return out;
}

Json peaks_json(const ModalReport& report) {
  Json out = Json::array();
  for (const core::SpectralPeak& peak : report.estimate.peaks) {
    out.push_back(
        {{"frequency_hz", peak.frequency_hz},
         {"resolution_hz", peak.resolution_hz},
         {"height", peak.height},
         {"share", components_json(report, peak.share.size(), [&](std::size_t i) { return peak.share[i]; })}});
  }
  return out;
}

Json value_json(const std::optional<core::ReadoutValue>& value) {
  if (!value) return nullptr;
  return {{"readout_ms", 1e3 * value->readout_s}, {"std_ms", 1e3 * value->std_s}};
}

Json readout_json(const std::optional<core::ReadoutFinding>& readout) {
  if (!readout) return nullptr;
  return {{"declared", value_json(readout->declared)},
          {"from_tracks", value_json(readout->from_tracks)},
          {"from_shapes", value_json(readout->from_shapes)},
          {"used", value_json(readout->used)},
          {"consistent", readout->consistent},
          {"why", readout->why}};
}

Json losses_json(const core::Health& losses) {
  return {{"frames_in", losses.frames_in},           {"frames_processed", losses.frames_processed},
          {"frames_dropped", losses.frames_dropped}, {"frames_missing", losses.frames_missing},
          {"samples_masked", losses.samples_masked}, {"snapshots_skipped", losses.snapshots_skipped}};
}

Json prediction_json(core::FramePrediction prediction) {
  return prediction == core::FramePrediction::kUnknown ? Json(nullptr) : Json(to_text(prediction));
}

Json recording_json(const core::RecordingTimes& times) {
  return {{"rate_hz", times.rate_hz},
          {"times_from", times.from},
          {"stated_hz", positive_or_null(times.stated_hz)},
          {"jitter_ms", 1e3 * times.jitter_s},
          {"worst_jitter_ms", 1e3 * times.worst_s},
          {"frames", times.n_frames},
          {"frames_lost", times.n_lost},
          {"gaps", times.n_gaps},
          {"longest_gap_s", times.longest_gap_s},
          {"frames_repeated", times.n_repeated},
          {"frames_damaged", times.n_damaged},
          {"frames_after_damage", times.n_after_damage},
          {"predicted_from", prediction_json(times.prediction)},
          {"remark", times.remark.empty() ? Json(nullptr) : Json(times.remark)}};
}

}  // namespace

std::string_view to_text(core::FramePrediction prediction) noexcept {
  switch (prediction) {
    case core::FramePrediction::kUnknown:
      return "";
    case core::FramePrediction::kNone:
      return "no frame";
    case core::FramePrediction::kPast:
      return "earlier frames";
    case core::FramePrediction::kBoth:
      return "earlier and later frames";
  }
  return "";
}

core::FramePrediction frame_prediction(std::string_view text) noexcept {
  using enum core::FramePrediction;
  for (const core::FramePrediction one : {kNone, kPast, kBoth}) {
    if (text == to_text(one)) return one;
  }
  return kUnknown;
}

std::string_view to_text(Method method) noexcept { return method == Method::kPaper ? "paper" : "hovermodal"; }

std::string modal_json(const ModalReport& report, std::size_t* n_not_finite) {
  const core::ModalEstimate& estimate = report.estimate;
  Json out = Json::object();
  out["version"] = 1;
  out["method"] = report.method;
  out["rate_hz"] = positive_or_null(estimate.rate_hz);
  out["duration_s"] = estimate.duration_s;
  out["samples"] = estimate.n_samples;
  out["segments"] = estimate.n_segments;
  out["remembered_s"] = estimate.remembered_s;
  out["degrees_of_freedom"] = positive_or_null(estimate.degrees_of_freedom);
  out["resolution_hz"] = positive_or_null(estimate.resolution_hz);
  out["channels"] = channels_json(report);
  if (!report.regions.empty()) out["axes"] = axes_json(report.regions);
  out["modes"] = modes_json(estimate.modes, report);
  out["rejected"] = modes_json(estimate.rejected, report);
  out["peaks"] = peaks_json(report);
  out["readout"] = readout_json(estimate.readout);
  out["corrections"] = report.corrections;
  out["caveats"] = report.caveats;
  if (!report.aircraft.empty()) out["aircraft"] = aircraft_json(report.aircraft);
  if (report.recovered) out["recovered"] = true;
  out["losses"] = losses_json(report.losses);
  if (report.losses.times.known()) out["recording"] = recording_json(report.losses.times);
  drivers::JsonText text = drivers::to_json_text(out);
  if (n_not_finite != nullptr) *n_not_finite = text.n_not_finite;
  return std::move(text.text);
}

}  // namespace app
