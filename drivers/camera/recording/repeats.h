#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace drivers {

struct PacketScan;

// A rate conversion: of `of` consecutive frames, `shown` are new, evenly spaced; the others repeat the one before.
// Frame k of the file shows picture floor((k shown + phase) / of) of the original recording.
struct Cadence {
  int shown = 1, of = 1, phase = 0;
  [[nodiscard]] std::uint64_t picture(std::uint64_t frame) const noexcept {
    return (frame * static_cast<std::uint64_t>(shown) + static_cast<std::uint64_t>(phase)) /
           static_cast<std::uint64_t>(of);
  }
  [[nodiscard]] bool repeats(std::uint64_t frame) const noexcept {
    return frame > 0 && picture(frame) == picture(frame - 1);
  }
};

// The cadence of changes[k], from frame k - 1 to frame k; changes[0] is not used. around[k], where given: the change
// from frame k - 2 to frame k + 1, which distinguishes a repeat from noiseless motion that reverses. Empty: no regular
// repeats.
[[nodiscard]] std::optional<Cadence> find_cadence(std::span<const double> changes, std::span<const double> around = {});

// The cadence of a video, from its first frames. They are decoded separately from the run, only if the packet sizes
// show that some frames contain almost nothing new, and no more than necessary: 90 frames, seldom 180.
[[nodiscard]] std::optional<Cadence> find_cadence(const std::string& path, const PacketScan& scan, int decoder_mb);

}  // namespace drivers
