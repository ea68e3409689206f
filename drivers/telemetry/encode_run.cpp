#include "drivers/telemetry/encode_run.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace drivers {
namespace {

// Far above any camera: grids, delays and sizes computed from these stay within their types.
constexpr std::int32_t kMostSide_px = 100'000;
constexpr double kLeastRate_hz = 1e-3, kMostRate_hz = 1e6;
constexpr std::int32_t kMostStride = 1000;

template <class Message>
void put_points(const std::vector<core::TrackPoint>& points, Message& out) {
  out.n_points = static_cast<std::int32_t>(points.size());
  for (const core::TrackPoint& point : points) {
    out.u_px.push_back(point.u_px);
    out.v_px.push_back(point.v_px);
    out.sigma_px.push_back(point.sigma_px);
  }
}

std::optional<core::ReadoutDirection> direction_of(const std::string& word) {
  constexpr std::array kAll = {core::ReadoutDirection::kDown, core::ReadoutDirection::kUp,
                               core::ReadoutDirection::kLeft, core::ReadoutDirection::kRight};
  const auto* found = std::find_if(kAll.begin(), kAll.end(), [&](auto d) { return word == core::to_string(d); });
  return found == kAll.end() ? std::nullopt : std::optional(*found);
}

}  // namespace

hovermodal::run_t to_message(const core::RunHead& head, const StreamIdentity& identity) {
  hovermodal::run_t out{};
  out.stream_id = identity.stream_id;
  out.config_hash = static_cast<std::int64_t>(identity.config_hash);
  out.config = head.config_yaml;
  out.continues = head.continues ? 1 : 0;
  out.width_px = head.camera.width_px;
  out.height_px = head.camera.height_px;
  out.rate_hz = head.camera.rate_hz;
  out.readout_ns = head.camera.readout_ns;
  out.readout_direction = core::to_string(head.camera.readout_direction);
  out.exposure_ns = head.camera.exposure_ns;
  out.frame_count = static_cast<std::int64_t>(head.camera.frame_count);
  out.lossless = head.camera.lossless ? 1 : 0;
  out.camera = head.camera.description;
  out.coding_block_px = head.camera.coding_block_px;
  out.frame_sequence = static_cast<std::int64_t>(head.keyframe.sequence);
  out.stream_time_ns = head.keyframe.t_start_ns;
  put_points(head.keyframe.points, out);
  for (const core::TrackPoint& point : head.keyframe.points) {
    out.id.push_back(static_cast<std::int32_t>(point.id));
    out.region.push_back(static_cast<std::int16_t>(point.region));
  }
  return out;
}

std::vector<hovermodal::run_file_t> to_messages(const core::NamedFile& file) {
  std::vector<hovermodal::run_file_t> out;
  for (std::size_t at = 0; at == 0 || at < file.bytes.size(); at += kFilePieceBytes) {
    const std::size_t n = std::min(kFilePieceBytes, file.bytes.size() - at);
    hovermodal::run_file_t piece{file.key,
                                 file.name,
                                 static_cast<std::int64_t>(file.bytes.size()),
                                 static_cast<std::int64_t>(at),
                                 static_cast<std::int32_t>(n),
                                 {}};
    piece.bytes.assign(file.bytes.begin() + static_cast<std::ptrdiff_t>(at),
                       file.bytes.begin() + static_cast<std::ptrdiff_t>(at + n));
    out.push_back(std::move(piece));
  }
  return out;
}

hovermodal::run_frame_t to_message(const core::TrackFrame& tracks, const core::AttitudeBatch& attitude) {
  hovermodal::run_frame_t out{};
  out.frame_sequence = static_cast<std::int64_t>(tracks.sequence);
  out.stream_time_ns = tracks.t_start_ns;
  out.gap_before = tracks.gap_before ? 1 : 0;
  put_points(tracks.points, out);
  for (const core::TrackPoint& point : tracks.points) out.seen.push_back(point.seen ? 1 : 0);
  out.n_attitudes = static_cast<std::int32_t>(attitude.n);
  out.n_left_out = static_cast<std::int32_t>(attitude.n_left_out);
  for (std::size_t i = 0; i < attitude.n; ++i) {
    const core::AttitudeSample& sample = attitude.samples[i];
    out.attitude_s.push_back(sample.t_s);
    out.attitude_w.push_back(sample.wxyz[0]);
    out.attitude_x.push_back(sample.wxyz[1]);
    out.attitude_y.push_back(sample.wxyz[2]);
    out.attitude_z.push_back(sample.wxyz[3]);
  }
  return out;
}

hovermodal::run_recording_t to_message(const core::RecordingTimes& times) {
  const auto count = [](std::uint64_t n) { return static_cast<std::int64_t>(n); };
  hovermodal::run_recording_t out{};
  out.times_from = times.from;
  out.rate_hz = times.rate_hz;
  out.stated_hz = times.stated_hz;
  out.jitter_s = times.jitter_s;
  out.worst_s = times.worst_s;
  out.n_frames = count(times.n_frames);
  out.n_lost = count(times.n_lost);
  out.n_gaps = count(times.n_gaps);
  out.longest_gap_s = times.longest_gap_s;
  out.n_repeated = count(times.n_repeated);
  out.n_damaged = count(times.n_damaged);
  out.n_after_damage = count(times.n_after_damage);
  out.remark = times.remark;
  out.prediction = static_cast<std::int8_t>(times.prediction);
  return out;
}

std::optional<core::RecordingTimes> from_message(const hovermodal::run_recording_t& message) {
  const auto all = [](auto holds, auto... values) { return (holds(values) && ...); };
  const bool can_be = !message.times_from.empty() &&
                      all([](double v) { return std::isfinite(v) && v >= 0.0; }, message.rate_hz, message.stated_hz,
                          message.jitter_s, message.worst_s, message.longest_gap_s) &&
                      all([](std::int64_t n) { return n >= 0; }, message.n_frames, message.n_lost, message.n_gaps,
                          message.n_repeated, message.n_damaged, message.n_after_damage) &&
                      message.prediction >= 0 &&
                      message.prediction <= static_cast<std::int8_t>(core::FramePrediction::kBoth);
  if (!can_be) return std::nullopt;
  const auto count = [](std::int64_t n) { return static_cast<std::uint64_t>(n); };
  return core::RecordingTimes{message.times_from,       message.rate_hz,
                              message.stated_hz,        message.jitter_s,
                              message.worst_s,          count(message.n_frames),
                              count(message.n_lost),    count(message.n_gaps),
                              message.longest_gap_s,    count(message.n_repeated),
                              count(message.n_damaged), count(message.n_after_damage),
                              message.remark,           static_cast<core::FramePrediction>(message.prediction)};
}

std::optional<core::RunHead> from_message(const hovermodal::run_t& message) {
  const auto direction = direction_of(message.readout_direction);
  const auto is_side = [](std::int32_t px) { return px > 0 && px <= kMostSide_px; };
  const bool has_rate = message.rate_hz >= kLeastRate_hz && message.rate_hz <= kMostRate_hz;
  if (!direction || !is_side(message.width_px) || !is_side(message.height_px) || !has_rate || message.n_points < 1)
    return std::nullopt;
  core::RunHead head;
  head.config_yaml = message.config;
  head.continues = message.continues != 0;
  head.camera = {message.width_px,
                 message.height_px,
                 message.rate_hz,
                 message.readout_ns,
                 *direction,
                 message.exposure_ns,
                 static_cast<std::uint64_t>(std::max<std::int64_t>(0, message.frame_count)),
                 message.lossless != 0,
                 message.camera,
                 std::clamp(message.coding_block_px, 0, kMostSide_px)};
  head.keyframe.sequence = static_cast<std::uint64_t>(message.frame_sequence);
  head.keyframe.t_start_ns = message.stream_time_ns;
  for (std::size_t i = 0; i < message.u_px.size(); ++i) {
    if (message.region[i] < 0) return std::nullopt;
    head.keyframe.points.push_back({message.u_px[i], message.v_px[i], message.sigma_px[i],
                                    static_cast<std::uint32_t>(message.id[i]),
                                    static_cast<std::uint16_t>(message.region[i]), true, true});
  }
  return head;
}

bool take_frame(const hovermodal::run_frame_t& message, core::RecordedFrame& out) {
  std::vector<core::TrackPoint>& points = out.tracks.points;
  if (message.u_px.size() != points.size()) return false;
  out.tracks.sequence = static_cast<std::uint64_t>(message.frame_sequence);
  out.tracks.t_start_ns = message.stream_time_ns;
  out.tracks.gap_before = message.gap_before != 0;
  out.stride = 1;
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].u_px = message.u_px[i];
    points[i].v_px = message.v_px[i];
    points[i].sigma_px = message.sigma_px[i];
    points[i].seen = message.seen[i] != 0 && std::isfinite(message.u_px[i]) && std::isfinite(message.v_px[i]);
  }
  out.attitude.clear();
  out.attitude.n_left_out = static_cast<std::uint32_t>(std::max(0, message.n_left_out));
  for (std::size_t i = 0; i < message.attitude_s.size(); ++i) {
    out.attitude.add({message.attitude_s[i],
                      {message.attitude_w[i], message.attitude_x[i], message.attitude_y[i], message.attitude_z[i]}});
  }
  return true;
}

bool take_frame(const hovermodal::run_thinned_frame_t& message, core::RecordedFrame& out) {
  if (message.stride < 2 || message.stride > kMostStride || !take_frame(message.frame, out)) return false;
  out.stride = static_cast<std::uint32_t>(message.stride);
  return true;
}

}  // namespace drivers
