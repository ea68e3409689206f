#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/types/track.h"
#include "core/types/vector2.h"
#include "drivers/storage/scratch_file.h"

namespace app {

// The places and sigmas that a TrackStore keeps: 1/8192 px about the keyframe's, within 1024 px, and a sigma of 10 bits
// after the point. Points are rounded to them before they are measured, so that a run measured again from a store, or
// from its record, gives the same bits. Any thread.
class TrackLattice {
 public:
  explicit TrackLattice(const core::TrackFrame& keyframe);
  // Points as in the keyframe. Rounding again changes nothing. A point further away is no longer seen.
  void round(core::TrackFrame& frame) const noexcept;

 private:
  friend class TrackStore;
  [[nodiscard]] bool fits(std::size_t i, const core::TrackPoint& point) const noexcept;

  std::vector<core::Vector2> datum_;
};

// All points of a run since its start: 8 bytes a point, 24 a frame; an hour of 64 points at 30 frames a second takes
// 58 MB. Of a longer run the newest frames are kept. One thread.
class TrackStore {
 public:
  // most_frames: of the run, 0 = unknown. folder: where a file holds all but the megabyte in use; empty, or where the
  // file takes no more: memory.
  TrackStore(const core::TrackFrame& keyframe, std::size_t most_bytes, std::uint64_t most_frames,
             const std::string& folder = {});

  // A frame on the lattice, later than those before. Allocates once a megabyte; where there is no more memory, the
  // newest frames that fit are kept.
  void add(const core::TrackFrame& frame, std::uint32_t stride) noexcept;
  [[nodiscard]] std::size_t n_frames() const noexcept;
  // Frame i of those that are kept, into a frame of the keyframe's size. Returns its stride. Where the file cannot be
  // read, no point of it is seen.
  std::uint32_t read(std::size_t i, core::TrackFrame& out) noexcept;

 private:
  struct Head {
    std::uint64_t sequence = 0;
    std::int64_t t_start_ns = 0;
    std::uint32_t stride = 1;
    std::uint32_t gap_before = 0;
  };

  TrackLattice lattice_;
  core::TrackFrame keyframe_;                               // identity and region of each point
  [[nodiscard]] std::byte* slot(std::uint64_t i) noexcept;  // null: it cannot be read back
  void make_room() noexcept;
  [[nodiscard]] bool hold(std::size_t chunk) noexcept;
  void put_away() noexcept;
  [[nodiscard]] std::size_t chunk_bytes(std::size_t chunk) const noexcept;
  [[nodiscard]] std::uint64_t place_in_file(std::size_t chunk) const noexcept {
    return std::uint64_t{chunk} * n_per_chunk_ * frame_bytes_;
  }

  std::size_t frame_bytes_, n_slots_, n_per_chunk_;
  std::vector<std::vector<std::byte>> chunks_;  // made as they are needed; empty: in the file
  std::optional<drivers::ScratchFile> file_;
  std::size_t held_ = 0;     // the chunk in use
  bool is_changed_ = false;  // since it was read from the file
  std::uint64_t n_added_ = 0;
};

}  // namespace app
