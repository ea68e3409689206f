#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace drivers {

struct PacketScan;

// A rate conversion: of `of` frames in a row `shown` are new, at even places, the others repeat the one before. Frame
// k of the file shows picture floor((k shown + phase) / of) of the recording before it was converted.
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
// from frame k - 2 to frame k + 1, which tells a repeat from a noiseless motion that turns back. Empty: no regular
// repeats.
[[nodiscard]] std::optional<Cadence> find_cadence(std::span<const double> changes, std::span<const double> around = {});

// The cadence of a video, from its first frames. They are decoded apart from the run only where the sizes of the packets
// show that some frames hold next to nothing new, and no further than the answer needs: 90 frames, seldom 180.
[[nodiscard]] std::optional<Cadence> find_cadence(const std::string& path, const PacketScan& scan);

}  // namespace drivers
