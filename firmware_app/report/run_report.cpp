#include "firmware_app/report/run_report.h"
#include "firmware_app/config/calibration.h"
#include "firmware_app/config/region_axis.h"
#include "firmware_app/config/structure_scale.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <iterator>
#include <string_view>
#include <utility>

#include "drivers/storage/json.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/report/closure_json.h"
#include "firmware_app/report/modal_json.h"

namespace app {
namespace {

using drivers::append_fixed;
using drivers::append_seconds;
using drivers::append_text;

// 1e-4 px and 1e-6 mm lie far below the resolution of any track.
constexpr int kPixelDecimals = 5;
constexpr int kSigmaDecimals = 6;
constexpr int kDisplacementDecimals = 6;
constexpr double kFlush_s = 2.0;

template <class... Args>
void append_line(fmt::memory_buffer& out, fmt::format_string<Args...> format, Args&&... args) {
  fmt::format_to(std::back_inserter(out), format, std::forward<Args>(args)...);
  out.push_back('\n');
}

}  // namespace

RunReport::RunReport(const std::string& directory, const AppConfig& config, const core::CameraInfo& camera,
                     const std::vector<core::ChannelInfo>& channels, const std::vector<std::string>& region_names)
    : folder_(directory, config.report.keep),
      method_(app::to_text(config.method)),
      region_names_(region_names),
      regions_(config.regions),
      history_(camera.rate_hz, channels.size(), region_names.size()),
      n_per_flush_(static_cast<std::uint64_t>(std::clamp(kFlush_s * camera.rate_hz, 1.0, 1e6))) {
  for (const core::ChannelInfo& channel : channels) channel_names_.push_back(channel.name);
  displacements_.emplace(folder_.in_working("displacements.csv"));
  write_displacement_header(config, camera, channels);
  if (!config.report.tracks) return;
  tracks_.emplace(folder_.in_working("tracks.csv"));
  write_track_header(config, camera);
}

void RunReport::write_track_header(const AppConfig& config, const core::CameraInfo& camera) {
  fmt::memory_buffer& out = tracks_->buffer();
  append_line(out, "# hovermodal tracks, version 1");
  append_line(out, "# image_size_px: {} x {}", camera.width_px, camera.height_px);
  append_line(out, "# rate_hz: {}", camera.rate_hz);
  append_line(out, "# readout_ms: {}", static_cast<double>(camera.readout_ns) / 1e6);
  append_line(out, "# readout_direction: {}", to_string(camera.readout_direction));
  append_line(out, "# exposure_ms: {}", static_cast<double>(camera.exposure_ns) / 1e6);
  if (camera.coding_block_px > 0) append_line(out, "# coding_block_px: {}", camera.coding_block_px);
  append_line(out, "# frame_count: {}", camera.frame_count == 0 ? "unknown" : std::to_string(camera.frame_count));
  append_line(out, "# regions: {}", fmt::join(region_names_, ","));
  std::vector<std::string> axes;
  for (const core::Region& region : config.regions) axes.push_back(axis_key_text(region));
  append_line(out, "# axes: {}", fmt::join(axes, ","));
  append_line(out, "frame,t_s,point,region,u_px,v_px,sigma_px");
}

void RunReport::write_displacement_header(const AppConfig& config, const core::CameraInfo& camera,
                                          const std::vector<core::ChannelInfo>& channels) {
  fmt::memory_buffer& out = displacements_->buffer();
  append_line(out, "# hovermodal displacements, version 1");
  append_line(out, "# unit: {}", structure_scale(config, camera_model(config, camera)).known ? "mm" : "px");
  append_line(out, "# rate_hz: {}", camera.rate_hz);
  // A channel is seen this long after t_s.
  for (const core::ChannelInfo& channel : channels)
    append_line(out, "# row_delay_s.{}: {}", channel.name, channel.row_delay_s);
  append_line(out, "frame,t_s,scale_mm_per_px{}{}", channels.empty() ? "" : ",", fmt::join(channel_names_, ","));
}

void RunReport::append_point(fmt::memory_buffer& out, const std::string& prefix, const core::TrackPoint& point) {
  const std::size_t begin = out.size();
  append_text(out, prefix);
  append_text(out, fmt::format_int(point.id).c_str());
  out.push_back(',');
  append_text(out, point.region < region_names_.size() ? std::string_view(region_names_[point.region]) : "unknown");
  out.push_back(',');
  bool finite = append_fixed(out, point.u_px, kPixelDecimals);
  out.push_back(',');
  finite = append_fixed(out, point.v_px, kPixelDecimals) && finite;
  out.push_back(',');
  finite = append_fixed(out, point.sigma_px, kSigmaDecimals) && finite;
  out.push_back('\n');
  if (finite) return;
  out.resize(begin);
  ++n_not_finite_;
}

bool RunReport::add(const core::TrackFrame& frame) noexcept try {
  history_.add(frame);
  folder_.keep_unfinished();
  if (!tracks_) return true;
  if (tracks_->error() != 0) return ++n_items_lost_, false;
  fmt::memory_buffer& out = tracks_->buffer();
  fmt::memory_buffer prefix;
  fmt::format_to(std::back_inserter(prefix), "{},", frame.sequence);
  append_seconds(prefix, frame.t_start_ns);
  prefix.push_back(',');
  const std::string text(prefix.data(), prefix.size());
  for (const core::TrackPoint& point : frame.points) {
    if (point.seen) append_point(out, text, point);
  }
  return tracks_->end_line();
} catch (const std::exception&) {  // out of memory
  ++n_items_lost_;
  return false;
}

bool RunReport::add(const core::DisplacementSample& sample) noexcept try {
  history_.add(sample);
  folder_.keep_unfinished();
  if (displacements_->error() != 0) return ++n_items_lost_, false;
  fmt::memory_buffer& out = displacements_->buffer();
  fmt::format_to(std::back_inserter(out), "{},", sample.sequence);
  append_seconds(out, sample.t_start_ns);
  out.push_back(',');
  if (std::isfinite(sample.scale_mm_per_px) && sample.scale_mm_per_px > 0.0) {
    fmt::format_to(std::back_inserter(out), "{:.9g}", sample.scale_mm_per_px);
  }
  for (std::size_t i = 0; i < channel_names_.size(); ++i) {
    out.push_back(',');
    const bool seen = i < sample.seen.size() && i < sample.value_mm.size() && sample.seen[i] != 0;
    if (seen && !append_fixed(out, sample.value_mm[i], kDisplacementDecimals)) ++n_not_finite_;
  }
  out.push_back('\n');
  if (++n_samples_ % n_per_flush_ != 0) return displacements_->end_line();
  if (tracks_) (void)tracks_->flush();  // its fault shows at the next frame
  return displacements_->flush();
} catch (const std::exception&) {  // out of memory
  ++n_items_lost_;
  return false;
}

void RunReport::finish(const core::ModalEstimate& last, const core::Health& losses,
                       const std::vector<std::string>& corrections, const std::vector<std::string>& caveats,
                       const core::closure::ClosureReport* closure, const Draw& draw) {
  if (history_.n_samples() == 0 && last.n_samples == 0 && folder_.has_report()) return;  // never worse than none
  std::string failures;
  const auto attempt = [&](const auto& write) {
    try {
      write();
      return true;
    } catch (const drivers::FileError& error) {
      failures += fmt::format("{}{}", failures.empty() ? "" : "; ", error.what());
      return false;
    }
  };
  folder_.free_reserve();
  const bool has_result = attempt([&] {
    std::size_t n_not_finite = 0;
    std::vector<std::string> in_force = corrections;
    in_force.insert(in_force.end(), last.amendments.begin(), last.amendments.end());
    const std::string text = modal_json(
        {method_, channel_names_, last, in_force, losses, caveats, regions_, history_.aircraft(), recovered_},
        &n_not_finite);
    n_not_finite_ += n_not_finite;
    drivers::write_file_atomically(folder_.in_working("modal.json"), text);
  });
  if (closure != nullptr && closure->refused.empty())
    attempt([&] { drivers::write_file_atomically(folder_.in_working("closure.json"), closure_json(closure->result)); });
  if (draw) attempt([&] { draw(folder_.working()); });
  attempt([&] { displacements_->commit(); });
  if (tracks_) attempt([&] { tracks_->commit(); });
  if (has_result) attempt([&] { folder_.hand_over(); });
  if (failures.empty()) return;
  throw drivers::FileError(fmt::format(
      "the report is incomplete ({} frames and samples came after the fault): {}. Free space on the disk, "
      "or name another folder{}",
      n_items_lost_, failures, has_result ? "" : fmt::format("; what was written is in {}", folder_.working())));
}

}  // namespace app
