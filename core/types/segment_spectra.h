#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace core {

// Spectra of the newest segments of a Welch estimate, with their phases, in a ring of fixed size: a steady line turns
// by the same angle from segment to segment, a mode's phase wanders. One thread; add() does not allocate.
class SegmentSpectra {
 public:
  struct Segment {
    std::uint64_t start = 0;      // stream position of its first sample
    std::uint64_t n_samples = 0;  // of its window; the last segment of a record may be shorter
    double weight = 1.0;          // in the sums; less than one with forgetting
  };

  SegmentSpectra() = default;
  // n_room = 0: keeps nothing. window_a0: the window is a0 - (1 - a0) cos(2 pi t / n_samples).
  SegmentSpectra(std::size_t n_room, std::size_t n_channels, std::size_t n_bins, double window_a0)
      : n_channels_(n_channels),
        n_bins_(n_bins),
        window_a0_(window_a0),
        segment_(n_room),
        seen_(n_room * n_channels),
        value_(n_room * n_channels * n_bins) {}

  [[nodiscard]] std::size_t n_room() const noexcept { return segment_.size(); }
  [[nodiscard]] std::size_t n_channels() const noexcept { return n_channels_; }
  [[nodiscard]] std::size_t n_bins() const noexcept { return n_bins_; }
  [[nodiscard]] double window_a0() const noexcept { return window_a0_; }
  // Segments since the start; those from first() on are kept.
  [[nodiscard]] std::uint64_t n_added() const noexcept { return n_added_; }
  [[nodiscard]] std::uint64_t first() const noexcept { return n_added_ - std::min<std::uint64_t>(n_added_, n_room()); }

  [[nodiscard]] const Segment& segment(std::uint64_t k) const noexcept { return segment_[place(k)]; }
  // Share of the window that the channel was seen, 0 ... 1.
  [[nodiscard]] float seen(std::uint64_t k, std::size_t channel) const noexcept {
    return seen_[place(k) * n_channels_ + channel];
  }
  // Discrete Fourier transform of the windowed segment, mm; its phase refers to the segment's first sample.
  [[nodiscard]] std::span<const std::complex<float>> value(std::uint64_t k, std::size_t channel) const noexcept {
    return {value_.data() + (place(k) * n_channels_ + channel) * n_bins_, n_bins_};
  }

  void clear() noexcept { n_added_ = 0; }
  void fade(double factor) noexcept {
    for (Segment& segment : segment_) segment.weight *= factor;
  }
  // spectra: channels x bins. seen: share of the window per channel. Overwrites the oldest.
  void add(const Segment& segment, std::span<const float> seen,
           std::span<const std::complex<double>> spectra) noexcept {
    if (n_room() == 0) return;
    const std::size_t at = place(n_added_++);
    segment_[at] = segment;
    std::copy(seen.begin(), seen.end(), seen_.begin() + static_cast<std::ptrdiff_t>(at * n_channels_));
    std::transform(spectra.begin(), spectra.end(),
                   value_.begin() + static_cast<std::ptrdiff_t>(at * n_channels_ * n_bins_),
                   [](const std::complex<double>& z) { return std::complex<float>(z); });
  }

  // The same segments with the channels `keep` alone.
  [[nodiscard]] SegmentSpectra of_channels(const std::vector<std::size_t>& keep) const {
    SegmentSpectra out(n_room(), keep.size(), n_bins_, window_a0_);
    out.n_added_ = n_added_, out.segment_ = segment_;
    for (std::uint64_t k = first(); k < n_added_; ++k) {
      for (std::size_t c = 0; c < keep.size(); ++c) {
        const std::size_t at = out.place(k) * keep.size() + c;
        out.seen_[at] = seen(k, keep[c]);
        const auto from = value(k, keep[c]);
        std::copy(from.begin(), from.end(), out.value_.begin() + static_cast<std::ptrdiff_t>(at * n_bins_));
      }
    }
    return out;
  }

  // State for StateWriter and StateReader; the sizes are those of the constructor.
  template <class Archive, class Self>
  static void describe(Archive& archive, Self& self) noexcept {
    archive.value(self.n_added_);
    archive.array(self.segment_);
    archive.array(self.seen_);
    archive.array(self.value_);
  }
  [[nodiscard]] std::size_t state_bytes() const noexcept {
    return 64 + segment_.size() * sizeof(Segment) + seen_.size() * sizeof(float) +
           value_.size() * sizeof(std::complex<float>);
  }
  // What later steps rely on, after restoring from untrusted bytes.
  [[nodiscard]] bool is_consistent(std::uint64_t most_samples) const noexcept {
    return std::all_of(segment_.begin(), segment_.end(),
                       [&](const Segment& s) { return s.n_samples <= most_samples && std::isfinite(s.weight); }) &&
           std::all_of(seen_.begin(), seen_.end(), [](float share) { return std::isfinite(share); }) &&
           std::all_of(value_.begin(), value_.end(),
                       [](const std::complex<float>& z) { return std::isfinite(z.real()) && std::isfinite(z.imag()); });
  }

 private:
  [[nodiscard]] std::size_t place(std::uint64_t k) const noexcept { return static_cast<std::size_t>(k % n_room()); }

  std::size_t n_channels_ = 0, n_bins_ = 0;
  double window_a0_ = 0.5;
  std::uint64_t n_added_ = 0;
  std::vector<Segment> segment_;
  std::vector<float> seen_;                 // segments x channels
  std::vector<std::complex<float>> value_;  // segments x channels x bins
};

}  // namespace core
