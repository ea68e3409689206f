#pragma once

#include <cstddef>
#include <vector>

#include "core/tracking/klt/klt_tracker.h"

namespace core {

// The image about (u, v), interpolated between pixels by quintic splines. Deterministic; no allocation.
void cut_patch_between(const GrayView& gray, double u, double v, Patch& out) noexcept;

// Renews templates of faint texture from the mean of several images, because the noise of a single image is in its
// gradients too and degrades the steps. Each image is aligned at the position found, its light corrected, so the
// reference position stays. A few points at a time bound the work per frame. Nothing allocates after construction. One
// thread.
class TemplateAverage {
 public:
  // n_at_once: points under way, some 60 us each, a frame.
  explicit TemplateAverage(const KltTracker& tracker, std::size_t n_at_once = 4);

  // An image in which the tracker has found its points.
  void add(const GrayView& gray, const std::vector<KltPoint>& found, KltTracker& tracker) noexcept;
  // Call when the template of a point has been replaced.
  void forget(std::size_t point) noexcept;
  [[nodiscard]] bool is_done() const noexcept { return n_begun_ == faint_.size() && work_.empty(); }

 private:
  struct Work {
    std::size_t point = 0;
    int n = 0;                // images so far
    Deformation deformation;  // their sum
    Patch sum{};
  };
  void add_to(Work& work, const GrayView& gray, const KltPoint& found, const KltTracker& tracker) noexcept;

  std::vector<std::size_t> faint_;  // points, in their order
  std::size_t n_begun_ = 0;         // of them
  std::vector<Work> work_;          // under way
  Patch now_{};
};

}  // namespace core
