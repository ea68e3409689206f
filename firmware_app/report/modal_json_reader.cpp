#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>

#include "drivers/storage/json.h"
#include "drivers/storage/printable.h"
#include "firmware_app/config/region_axis.h"
#include "firmware_app/report/aircraft_facts.h"
#include "firmware_app/report/json_fields.h"
#include "firmware_app/report/modal_json.h"

namespace app {
namespace {

using Json = nlohmann::ordered_json;

class ModalReader : JsonFields {
 public:
  explicit ModalReader(const std::string& path) : JsonFields(path) {}

  [[nodiscard]] ModalReport read() {
    const Json root = drivers::read_json_file(path());
    if (!root.is_object() || !root.contains("modes")) refuse("modes", "is missing; is this a modal.json?");
    if (count(root, "version") != 1) refuse("version", "is not 1; read it with the program that wrote it");
    report_.method = text(root, "method");
    core::ModalEstimate& estimate = report_.estimate;
    estimate.rate_hz = optional_number(root, "rate_hz").value_or(0.0);
    estimate.duration_s = optional_number(root, "duration_s").value_or(0.0);
    estimate.n_samples = count(root, "samples");
    estimate.n_segments = count(root, "segments");
    estimate.degrees_of_freedom = optional_number(root, "degrees_of_freedom").value_or(0.0);
    estimate.final = true;
    estimate.resolution_hz = optional_number(root, "resolution_hz").value_or(0.0);
    read_channels(root);
    read_axes(root);
    estimate.modes = modes(root, "modes");
    estimate.rejected = modes(root, "rejected");
    read_peaks(root);
    if (const Json* readout = find(root, "readout")) estimate.readout = readout_of(*readout);
    report_.corrections = texts(root, "corrections");
    report_.caveats = texts(root, "caveats");
    if (const Json* aircraft = find(root, "aircraft")) report_.aircraft = aircraft_of(*aircraft, *this);
    const Json* recovered = find(root, "recovered");
    report_.recovered = recovered != nullptr && recovered->is_boolean() && recovered->get<bool>();
    if (const Json* losses = find(root, "losses")) read_losses(*losses);
    if (const Json* recording = find(root, "recording")) read_recording(*recording);
    return std::move(report_);
  }

 private:
  void read_axes(const Json& root) {
    const Json* list = find(root, "axes");
    if (list == nullptr) return;
    for (const Json& item : *list)
      report_.regions.push_back(region_with_axis(text(item, "region"), text(item, "axis"), text(item, "from")));
  }

  [[nodiscard]] std::vector<core::Mode> modes(const Json& root, const char* key) {
    std::vector<core::Mode> out;
    const Json* list = find(root, key);
    if (list == nullptr) return out;
    if (!list->is_array()) refuse(key, "is no list");
    for (const Json& item : *list) out.push_back(mode(item, fmt::format("{}[{}]", key, out.size())));
    return out;
  }

  [[nodiscard]] core::Mode mode(const Json& item, const std::string& name) {
    core::Mode out;
    const auto frequency = optional_number(item, "frequency_hz");
    if (!frequency) refuse(name + ".frequency_hz", "is missing");
    out.frequency_hz = *frequency;
    out.frequency_std_hz = optional_number(item, "frequency_std_hz");
    out.apparent_hz = optional_number(item, "apparent_hz").value_or(out.frequency_hz);
    if (const Json* fold = find(item, "fold_n")) {
      const double n = finite(*fold, name + ".fold_n");
      if (std::abs(n) > 1e6 || n != std::floor(n)) refuse(name + ".fold_n", "is no small whole number");
      out.fold_n = static_cast<int>(n);
    }
    out.fold_margin = optional_number(item, "fold_margin");
    if (const Json* others = find(item, "may_be_hz")) {
      if (!others->is_array()) refuse(name + ".may_be_hz", "is no list");
      for (const Json& hz : *others) out.may_be_hz.push_back(finite(hz, name + ".may_be_hz"));
    }
    out.damping_ratio = optional_number(item, "damping_ratio").value_or(0.0);
    out.damping_std = optional_number(item, "damping_std");
    out.mpc = optional_number(item, "mpc").value_or(0.0);
    out.emac = optional_number(item, "emac").value_or(0.0);
    out.reason = text(item, "reason");
    out.verdict = verdict(text(item, "verdict"), name);
    read_shape(item, name, out);
    if (const Json* history = find(item, "history")) out.history = history_of(*history, name + ".history");
    return out;
  }

  [[nodiscard]] core::ModeHistory history_of(const Json& item, const std::string& name) const {
    const auto small = [&](const char* key) {
      const std::uint64_t value = count(item, key);
      if (value > UINT32_MAX) refuse(name + "." + key, "is no small whole number");
      return static_cast<std::uint32_t>(value);
    };
    core::ModeHistory out;
    out.id = small("id");
    if (out.id == 0) refuse(name + ".id", "is missing");
    out.n_estimates = small("estimates");
    out.first_number = count(item, "first_estimate");
    out.first_seen_s = optional_number(item, "first_seen_s").value_or(0.0);
    out.n_fold_changes = small("fold_changes");
    out.drift_hz_per_s = optional_number(item, "drift_hz_per_s");
    out.drift_std_hz_per_s = optional_number(item, "drift_std_hz_per_s");
    const Json* drifts = find(item, "drifts");
    if (drifts != nullptr && !drifts->is_boolean()) refuse(name + ".drifts", "is neither true nor false");
    out.drifts = drifts != nullptr && drifts->get<bool>();
    out.more_s = optional_number(item, "more_s");
    return out;
  }

  [[nodiscard]] core::ReadoutFinding readout_of(const Json& item) const {
    const auto value = [&](const char* key) -> std::optional<core::ReadoutValue> {
      const Json* found = find(item, key);
      if (found == nullptr) return {};
      return core::ReadoutValue{optional_number(*found, "readout_ms").value_or(0.0) / 1e3,
                                optional_number(*found, "std_ms").value_or(0.0) / 1e3};
    };
    const Json* consistent = find(item, "consistent");
    core::ReadoutFinding out;
    out.declared = value("declared").value_or(core::ReadoutValue{});
    out.used = value("used").value_or(core::ReadoutValue{});
    out.from_tracks = value("from_tracks");
    out.from_shapes = value("from_shapes");
    out.consistent = consistent == nullptr || !consistent->is_boolean() || consistent->get<bool>();
    out.why = text(item, "why");
    return out;
  }

  [[nodiscard]] core::Verdict verdict(const std::string& name_of_verdict, const std::string& name) const {
    using core::Verdict;
    if (name_of_verdict.empty()) return Verdict::kStructural;  // a truth.json, which has no verdicts
    for (const Verdict verdict : {Verdict::kStructural, Verdict::kCameraMotion, Verdict::kInputPeak, Verdict::kHarmonic,
                                  Verdict::kAmbiguous, Verdict::kNumerical, Verdict::kCandidate}) {
      if (name_of_verdict == core::to_string(verdict)) return verdict;
    }
    refuse(name + ".verdict", fmt::format("`{}` is unknown", drivers::printable(name_of_verdict)));
  }

  // The first shape defines the channels; every other shape must have the same.
  void read_shape(const Json& item, const std::string& name, core::Mode& out) {
    const Json* shape = find(item, "shape");
    if (shape == nullptr) return;
    if (!shape->is_object() || shape->empty()) refuse(name + ".shape", "is no map of channels");
    if (report_.channel_names.empty()) {
      for (const auto& [channel, value] : shape->items()) report_.channel_names.push_back(channel);
    }
    if (shape->size() != report_.channel_names.size())
      refuse(name + ".shape", "has other channels than the modes before");
    const Json* shape_std = find(item, "shape_std");
    for (std::size_t i = 0; i < report_.channel_names.size(); ++i) {
      const std::string& channel = report_.channel_names[i];
      const Json* value = find(*shape, channel.c_str());
      const auto& records = report_.estimate.channels;
      if (value == nullptr && i < records.size() && !records[i].takes_part) {  // unknown
        out.shape.emplace_back(0.0);
        if (shape_std != nullptr) out.shape_std.push_back(0.0);
        continue;
      }
      out.shape.push_back(component(value, fmt::format("{}.shape.{}", name, drivers::printable(channel))));
      if (shape_std == nullptr) continue;
      const auto channel_std = optional_number(*shape_std, channel.c_str());
      if (!channel_std) refuse(fmt::format("{}.shape_std.{}", name, drivers::printable(channel)), "is missing");
      out.shape_std.push_back(*channel_std);
    }
  }

  // [re, im], or one number for a real component (truth.json).
  [[nodiscard]] std::complex<double> component(const Json* value, const std::string& name) const {
    if (value != nullptr && value->is_number()) return finite(*value, name);
    if (value == nullptr || !value->is_array() || value->size() != 2) refuse(name, "is neither [re, im] nor a number");
    return {finite((*value)[0], name), finite((*value)[1], name)};
  }

  [[nodiscard]] bool truth(const Json& object, const char* key, bool otherwise) const {
    const Json* value = find(object, key);
    if (value == nullptr) return otherwise;
    if (!value->is_boolean()) refuse(key, "is neither true nor false");
    return value->get<bool>();
  }

  // The channels listed in the file name those of all shapes.
  void read_channels(const Json& root) {
    const Json* list = find(root, "channels");
    if (list == nullptr) return;
    if (!list->is_array()) refuse("channels", "is no list");
    for (const Json& item : *list) {
      report_.channel_names.push_back(text(item, "name"));
      core::ChannelRecord& record = report_.estimate.channels.emplace_back();
      record.seen = optional_number(item, "seen").value_or(1.0);
      record.n_outlying = count(item, "outlying");
      record.takes_part = truth(item, "takes_part", true);
      record.reason = text(item, "reason");
    }
  }

  void read_peaks(const Json& root) {
    const Json* list = find(root, "peaks");
    if (list == nullptr) return;
    if (!list->is_array()) refuse("peaks", "is no list");
    for (const Json& item : *list) {
      core::SpectralPeak& peak = report_.estimate.peaks.emplace_back();
      peak.frequency_hz = optional_number(item, "frequency_hz").value_or(0.0);
      peak.resolution_hz = optional_number(item, "resolution_hz").value_or(0.0);
      peak.height = optional_number(item, "height").value_or(0.0);
      const Json* share = find(item, "share");
      for (const std::string& channel : report_.channel_names)
        peak.share.push_back(share == nullptr ? 0.0 : optional_number(*share, channel.c_str()).value_or(0.0));
    }
  }

  void read_losses(const Json& losses) {
    core::Health& out = report_.losses;
    out.frames_in = count(losses, "frames_in");
    out.frames_processed = count(losses, "frames_processed");
    out.frames_dropped = count(losses, "frames_dropped");
    out.frames_missing = count(losses, "frames_missing");
    out.samples_masked = count(losses, "samples_masked");
    out.snapshots_skipped = count(losses, "snapshots_skipped");
  }

  void read_recording(const Json& recording) {
    core::RecordingTimes& out = report_.losses.times;
    out.rate_hz = optional_number(recording, "rate_hz").value_or(0.0);
    out.from = text(recording, "times_from");
    out.stated_hz = optional_number(recording, "stated_hz").value_or(0.0);
    out.jitter_s = 1e-3 * optional_number(recording, "jitter_ms").value_or(0.0);
    out.worst_s = 1e-3 * optional_number(recording, "worst_jitter_ms").value_or(0.0);
    out.n_frames = count(recording, "frames");
    out.n_lost = count(recording, "frames_lost");
    out.n_gaps = count(recording, "gaps");
    out.longest_gap_s = optional_number(recording, "longest_gap_s").value_or(0.0);
    out.n_repeated = count(recording, "frames_repeated");
    out.n_damaged = count(recording, "frames_damaged");
    out.n_after_damage = count(recording, "frames_after_damage");
    out.prediction = frame_prediction(find(recording, "predicted_from") ? text(recording, "predicted_from") : "");
    if (find(recording, "remark") != nullptr) out.remark = text(recording, "remark");
  }

  ModalReport report_;
};

}  // namespace

ModalReport read_modal_json(const std::string& path) { return ModalReader(path).read(); }

}  // namespace app
