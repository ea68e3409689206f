#include "firmware_app/chain/track_store.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace app {

namespace {

constexpr double kPerPixel = 8192.0;
constexpr double kFarthest_px = 1023.0;
constexpr std::size_t kPointBytes = 8, kChunkBytes = std::size_t{1} << 20U;

// A float without its sign and without 13 of its 23 bits after the point; the exponent begins at 2^-32. 0: not seen.
constexpr std::uint32_t kDroppedBits = 13, kFirstExponent = (127U - 32U) << 10U, kLargestCode = 0xFFFFU;
constexpr double kLeastSigma_px = 1e-9;

std::uint16_t sigma_code(double sigma_px) noexcept {
  const auto value = static_cast<float>(std::max(sigma_px, kLeastSigma_px));  // NaN: the least
  const std::uint32_t rounded = (std::bit_cast<std::uint32_t>(value) + (1U << (kDroppedBits - 1U))) >> kDroppedBits;
  return static_cast<std::uint16_t>(std::clamp(rounded, kFirstExponent + 1U, kFirstExponent + kLargestCode) -
                                    kFirstExponent);
}
double sigma_of(std::uint16_t code) noexcept {
  return static_cast<double>(std::bit_cast<float>((code + kFirstExponent) << kDroppedBits));
}

std::int32_t steps(double px) noexcept { return static_cast<std::int32_t>(std::lround(px * kPerPixel)); }
double from_steps(std::int32_t n) noexcept { return n / kPerPixel; }

void put24(std::byte* at, std::int32_t value) noexcept {
  for (unsigned k = 0; k < 3; ++k) at[k] = static_cast<std::byte>(static_cast<std::uint32_t>(value) >> (8U * k));
}
std::int32_t get24(const std::byte* at) noexcept {
  std::uint32_t value = 0;
  for (unsigned k = 0; k < 3; ++k) value |= std::to_integer<std::uint32_t>(at[k]) << (8U * (k + 1U));
  return static_cast<std::int32_t>(value) >> 8;
}

}  // namespace

TrackLattice::TrackLattice(const core::TrackFrame& keyframe) {
  for (const core::TrackPoint& point : keyframe.points) datum_.push_back({point.u_px, point.v_px});
}

bool TrackLattice::fits(std::size_t i, const core::TrackPoint& point) const noexcept {
  return i < datum_.size() && point.seen && std::abs(point.u_px - datum_[i].u) < kFarthest_px &&
         std::abs(point.v_px - datum_[i].v) < kFarthest_px;
}

void TrackLattice::round(core::TrackFrame& frame) const noexcept {
  for (std::size_t i = 0; i < frame.points.size(); ++i) {
    core::TrackPoint& point = frame.points[i];
    point.seen = fits(i, point);
    if (!point.seen) continue;
    point.u_px = datum_[i].u + from_steps(steps(point.u_px - datum_[i].u));
    point.v_px = datum_[i].v + from_steps(steps(point.v_px - datum_[i].v));
    point.sigma_px = sigma_of(sigma_code(point.sigma_px));
  }
}

TrackStore::TrackStore(const core::TrackFrame& keyframe, std::size_t most_bytes, std::uint64_t most_frames,
                       const std::string& folder)
    : lattice_(keyframe),
      keyframe_(keyframe),
      frame_bytes_(sizeof(Head) + kPointBytes * keyframe.points.size()),
      n_slots_(std::max<std::size_t>(1, most_bytes / frame_bytes_)),
      n_per_chunk_(std::max<std::size_t>(1, kChunkBytes / frame_bytes_)),
      file_(drivers::ScratchFile::in(folder)) {
  if (most_frames > 0) n_slots_ = static_cast<std::size_t>(std::min<std::uint64_t>(n_slots_, most_frames));
}

std::byte* TrackStore::slot(std::uint64_t i) noexcept {
  const auto k = static_cast<std::size_t>(i % n_slots_);
  return hold(k / n_per_chunk_) ? chunks_[held_].data() + k % n_per_chunk_ * frame_bytes_ : nullptr;
}

std::size_t TrackStore::chunk_bytes(std::size_t chunk) const noexcept {
  return std::min(n_per_chunk_, n_slots_ - chunk * n_per_chunk_) * frame_bytes_;
}

// What the file does not take stays in memory.
void TrackStore::put_away() noexcept {
  if (!file_ || held_ >= chunks_.size()) return;
  if (is_changed_ && !file_->write(place_in_file(held_), chunks_[held_])) return;
  std::vector<std::byte>().swap(chunks_[held_]);
}

bool TrackStore::hold(std::size_t chunk) noexcept {
  if (chunk != held_) {
    put_away();
    held_ = chunk, is_changed_ = true;
  }
  if (!chunks_[chunk].empty()) return true;
  try {
    std::vector<std::byte> bytes(chunk_bytes(chunk));
    if (!file_ || !file_->read(place_in_file(chunk), bytes)) return false;
    chunks_[chunk].swap(bytes);
    is_changed_ = false;
  } catch (...) {  // no memory
    return false;
  }
  return true;
}

// For the next frame; without memory the slots that there are become all.
void TrackStore::make_room() noexcept {
  const std::size_t n_made = chunks_.size() * n_per_chunk_;
  if (n_slots_ == 0 || n_added_ % n_slots_ < n_made) return;
  try {
    chunks_.emplace_back(chunk_bytes(chunks_.size()));
  } catch (...) {  // no memory
    n_slots_ = n_made;
  }
}

std::size_t TrackStore::n_frames() const noexcept {
  return static_cast<std::size_t>(std::min<std::uint64_t>(n_added_, n_slots_));
}

void TrackStore::add(const core::TrackFrame& frame, std::uint32_t stride) noexcept {
  make_room();
  if (n_slots_ == 0) return;
  std::byte* at = slot(n_added_);
  if (at == nullptr) return;
  ++n_added_, is_changed_ = true;
  const Head head{frame.sequence, frame.t_start_ns, stride, frame.gap_before ? 1U : 0U};
  std::memcpy(at, &head, sizeof head);
  at += sizeof head;
  for (std::size_t i = 0; i < keyframe_.points.size(); ++i, at += kPointBytes) {
    const bool is_seen = i < frame.points.size() && lattice_.fits(i, frame.points[i]);
    const core::TrackPoint point = is_seen ? frame.points[i] : core::TrackPoint{};
    const core::Vector2 datum = is_seen ? lattice_.datum_[i] : core::Vector2{};
    put24(at, steps(point.u_px - datum.u));
    put24(at + 3, steps(point.v_px - datum.v));
    const std::uint16_t code = is_seen ? sigma_code(point.sigma_px) : std::uint16_t{0};
    std::memcpy(at + 6, &code, sizeof code);
  }
}

std::uint32_t TrackStore::read(std::size_t i, core::TrackFrame& out) noexcept {
  const std::byte* at = slot(n_added_ - n_frames() + i);
  if (at == nullptr) {
    for (core::TrackPoint& point : out.points) point.seen = point.inlier = false;
    return 1;
  }
  Head head;
  std::memcpy(&head, at, sizeof head);
  at += sizeof head;
  out.sequence = head.sequence, out.t_start_ns = head.t_start_ns, out.gap_before = head.gap_before != 0;
  for (std::size_t k = 0; k < out.points.size() && k < keyframe_.points.size(); ++k, at += kPointBytes) {
    std::uint16_t code = 0;
    std::memcpy(&code, at + 6, sizeof code);
    core::TrackPoint point = keyframe_.points[k];
    point.seen = code != 0, point.inlier = false;
    point.sigma_px = point.seen ? sigma_of(code) : 0.0;
    constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
    point.u_px = point.seen ? lattice_.datum_[k].u + from_steps(get24(at)) : kNowhere;
    point.v_px = point.seen ? lattice_.datum_[k].v + from_steps(get24(at + 3)) : kNowhere;
    out.points[k] = point;
  }
  return head.stride;
}

}  // namespace app
