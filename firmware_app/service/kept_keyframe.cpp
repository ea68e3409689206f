#include "firmware_app/service/kept_keyframe.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "drivers/storage/checkpoint_file.h"
#include "firmware_app/chain/state/byte_archive.h"

namespace app {

namespace {

template <class Archive, class Hash, class Image, class Points>
void describe(Archive& archive, Hash& config_hash, Image& image, Points& tracks) {
  archive.value(config_hash);
  archive.value(image.sequence);
  archive.value(image.t_start_ns);
  archive.value(image.width_px);
  archive.value(image.height_px);
  archive.list(image.pixels);
  archive.list(tracks.points);
}

// A bool was written, but the byte read may have any value, and reading that as a bool is undefined.
void make_bool(bool& flag) {
  std::uint8_t byte = 0;
  std::memcpy(&byte, &flag, 1);
  flag = byte != 0;
}

// All points in the image, grouped by region, no undeclared region.
bool makes_sense(const core::TrackFrame& tracks, const core::CameraInfo& camera, std::size_t n_regions) {
  std::uint16_t region = 0;
  return !tracks.points.empty() && std::all_of(tracks.points.begin(), tracks.points.end(), [&](const auto& p) {
    const bool in_order = p.region == region || p.region == region + 1;
    region = p.region;
    return in_order && p.region < n_regions && p.u_px >= 0.0 && p.u_px < camera.width_px && p.v_px >= 0.0 &&
           p.v_px < camera.height_px;
  }) && static_cast<std::size_t>(region) + 1 == n_regions;
}

}  // namespace

std::string write_keyframe(const std::string& path, std::uint64_t config_hash, const core::Frame& image,
                           const core::TrackFrame& points) {
  ByteWriter out;
  out.bytes.reserve(image.pixels.size() + 64 * points.points.size() + 256);
  describe(out, config_hash, image, points);
  return drivers::write_checkpoint(path, out.bytes);
}

KeyframeRead read_keyframe(const std::string& path, std::uint64_t config_hash, const core::CameraInfo& camera,
                           std::size_t n_regions) {
  const auto n_pixels = static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
  constexpr std::uint64_t kBeside = 16U << 20U;  // points
  const drivers::CheckpointRead read = drivers::read_checkpoint(path, n_pixels + kBeside);
  if (!read.exists) return {};
  if (!read.refused.empty()) return {{}, "the keyframe in " + path + ": " + read.refused};
  KeptKeyframe kept;
  std::uint64_t hash = 0;
  try {
    ByteReader in(read.bytes);
    describe(in, hash, kept.image, kept.points);
    for (core::TrackPoint& point : kept.points.points) make_bool(point.seen), make_bool(point.inlier);
  } catch (const std::runtime_error& e) {
    return {{}, "the keyframe in " + path + ": " + e.what()};
  }
  if (hash != config_hash) return {{}, "the keyframe's configuration was different"};
  if (kept.image.width_px != camera.width_px || kept.image.height_px != camera.height_px ||
      kept.image.pixels.size() != n_pixels)
    return {{}, "the keyframe's image has a different size"};
  if (!makes_sense(kept.points, camera, n_regions)) return {{}, "the keyframe's points do not belong to the regions"};
  return {std::move(kept), {}};
}

}  // namespace app
