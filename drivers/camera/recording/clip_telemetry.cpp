#include "drivers/camera/recording/clip_telemetry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <utility>

#include "drivers/camera/recording/container.h"
#include "drivers/storage/limits.h"
#include "drivers/storage/text_file.h"

namespace drivers {

namespace fs = std::filesystem;

namespace {

constexpr const char* kGpmfTag = "gpmd";
constexpr std::size_t kMostPackets = 100'000;  // a day at one packet per second

ClipTelemetry troubled(std::string from, std::string trouble) {
  ClipTelemetry out;
  out.from = std::move(from), out.trouble = std::move(trouble);
  return out;
}

// Skips packets that cannot be read and keeps the first reason.
std::vector<TimedPayload> read_payloads(const std::string& video, std::string& trouble) {
  Container container(video, kGpmfTag);
  std::vector<TimedPayload> out;
  if (!container.has_stream()) return out;
  const AvHandle<AVPacket> packet(av_packet_alloc());
  if (!packet) throw std::bad_alloc();
  std::size_t n_bytes = 0;
  while (out.size() < kMostPackets && container.next(*packet)) {
    n_bytes += static_cast<std::size_t>(packet->size);
    if (n_bytes > Limits::kRawTelemetryBytes) {
      if (trouble.empty())
        trouble = fmt::format("more than {} bytes; the rest is left out", Limits::kRawTelemetryBytes);
      break;
    }
    const std::int64_t tick = packet->pts != AV_NOPTS_VALUE ? packet->pts : packet->dts;
    if (tick == AV_NOPTS_VALUE) continue;
    try {
      out.push_back({static_cast<double>(tick) * container.tick_s(),
                     static_cast<double>(std::max<std::int64_t>(packet->duration, 0)) * container.tick_s(),
                     parse_gpmf({packet->data, static_cast<std::size_t>(packet->size)})});
    } catch (const std::runtime_error& error) {
      if (trouble.empty()) trouble = fmt::format("packet {}: {}", out.size(), error.what());
    }
  }
  return out;
}

// The payloads of a raw file follow one another; only their own clock states their times.
ClipTelemetry of_raw_gpmf(const std::string& file) {
  const std::string bytes = read_text_file(file, Limits::kRawTelemetryBytes);
  TimedPayload whole;
  try {
    whole.payload = parse_gpmf({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("{}: {}", file, error.what()));
  }
  return telemetry_of(std::vector<TimedPayload>{whole});
}

ClipTelemetry of_video(const std::string& video) {
  std::string trouble;
  const std::vector<TimedPayload> payloads = read_payloads(video, trouble);
  if (payloads.empty()) return trouble.empty() ? ClipTelemetry{} : troubled("GPMF", trouble);
  ClipTelemetry out = telemetry_of(payloads);
  out.trouble = trouble;
  return out;
}

std::string extension_of(const std::string& file) {
  std::string extension = fs::path(file).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return extension;
}

std::string seconds(double exposure_s) {
  return exposure_s < 0.5 ? fmt::format("1/{:.4g} s", 1.0 / exposure_s) : fmt::format("{:.3g} s", exposure_s);
}

struct Range {
  TimedValue least, most;
  double first_change_s = -1.0;  // -1: none
};

Range range_of(const std::vector<TimedValue>& values, double relative) {
  Range range{values.front(), values.front(), -1.0};
  for (const TimedValue& one : values) {
    if (one.value < range.least.value) range.least = one;
    if (one.value > range.most.value) range.most = one;
    if (range.first_change_s < 0.0 && std::abs(one.value / values.front().value - 1.0) > relative)
      range.first_change_s = one.t_s;
  }
  return range;
}

void add_range(std::vector<std::string>& words, const char* what, const std::vector<TimedValue>& values,
               double relative, std::string (*text)(double)) {
  if (values.empty()) return;
  const Range range = range_of(values, relative);
  words.push_back(range.first_change_s < 0.0
                      ? fmt::format("{} {}", what, text(values.front().value))
                      : fmt::format("{} changes: {} to {}, first at {:.2f} s", what, text(range.least.value),
                                    text(range.most.value), range.first_change_s));
}

std::string plain(double value) { return fmt::format("{:.4g}", value); }
std::string milliseconds(double value) { return fmt::format("{:.3g} ms", 1e3 * value); }

}  // namespace

ClipTelemetry find_telemetry(const std::string& video, bool may_hold_gpmf) {
  if (fs::is_directory(video)) return {};
  if (const std::string srt = find_srt(video); !srt.empty()) {
    const std::string name = fs::path(srt).filename().string();
    try {
      return telemetry_of(read_srt(srt), name);
    } catch (const std::runtime_error& error) {
      return troubled(name, error.what());
    }
  }
  if (!may_hold_gpmf) return {};
  try {
    return of_video(video);
  } catch (const std::runtime_error& error) {
    return troubled("GPMF", error.what());
  }
}

ClipTelemetry read_telemetry(const std::string& file) {
  const std::string extension = extension_of(file);
  if (extension == ".srt") return telemetry_of(read_srt(file), fs::path(file).filename().string());
  if (extension == ".raw" || extension == ".gpmf") return of_raw_gpmf(file);
  ClipTelemetry out = find_telemetry(file);
  if (!out.found())
    throw std::runtime_error(fmt::format("{}: no telemetry: no .SRT file beside it, no GPMF stream in it", file));
  if (!out.trouble.empty() && out.clock_s.empty() && out.exposure_s.empty() && out.attitude.empty())
    throw std::runtime_error(fmt::format("{}: {}: {}", file, out.from, out.trouble));
  return out;
}

std::vector<std::string> telemetry_words(const ClipTelemetry& telemetry) {
  std::vector<std::string> words;
  if (telemetry.frame_rate_hz > 0.0) {
    words.push_back(fmt::format("{} by the camera's clock: {:.3f} frames/s, {:.2g} ms rms about it",
                                telemetry.times_ns.empty() ? "rate" : "times of frames", telemetry.frame_rate_hz,
                                1e3 * telemetry.frame_jitter_s));
  } else if (!telemetry.clock_s.empty()) {
    words.push_back(fmt::format("{} times by the camera's clock, not of every frame", telemetry.clock_s.size()));
  }
  constexpr double kChanges = 0.02, kZooms = 1e-3, kReadout = 0.05;
  add_range(words, "exposure", telemetry.exposure_s, kChanges, &seconds);
  add_range(words, "focal length", telemetry.focal_length, kZooms, &plain);
  add_range(words, "digital zoom", telemetry.zoom, kZooms, &plain);
  add_range(words, "readout time", telemetry.readout_s, kReadout, &milliseconds);
  if (telemetry.attitude.size() > 1) {
    const double span_s = telemetry.attitude.back().t_s - telemetry.attitude.front().t_s;
    words.push_back(fmt::format("attitude by the {}, {} at {:.4g} Hz", telemetry.attitude_from,
                                telemetry.attitude.size(),
                                static_cast<double>(telemetry.attitude.size() - 1) / std::max(span_s, 1e-9)));
  }
  if (!telemetry.trouble.empty()) words.push_back("not readable: " + telemetry.trouble);
  if (words.empty()) words.emplace_back("no time, exposure, focal length or attitude in it: nothing is taken from it");
  return words;
}

void refuse_zoom(const std::string& video, const ClipTelemetry& telemetry) {
  constexpr double kFollowed = 0.05;
  for (const auto& [what, values] :
       {std::pair{"focal length", &telemetry.focal_length}, {"digital zoom", &telemetry.zoom}}) {
    if (values->empty()) continue;
    const Range range = range_of(*values, 1e-3);
    if (range.most.value <= (1.0 + kFollowed) * range.least.value) continue;
    throw std::runtime_error(fmt::format(
        "{}: the {} changes from {:.4g} to {:.4g} ({}), first at {:.2f} s: points cannot be followed through a zoom of "
        "more than {:.0f} %; cut the clip before it (ffmpeg -i IN -t {:.1f} -c copy OUT.mp4) or behind it, or film "
        "without zoom",
        video, what, range.least.value, range.most.value, telemetry.from, range.first_change_s, 100.0 * kFollowed,
        range.first_change_s));
  }
}

}  // namespace drivers
