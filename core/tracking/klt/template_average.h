#pragma once

#include <cstddef>
#include <vector>

#include "core/tracking/klt/klt_tracker.h"

namespace core {

// The image about (u, v), interpolated between pixels. Deterministic; no allocation.
void cut_patch_between(const GrayView& gray, double u, double v, Patch& out) noexcept;

// Renews templates of faint texture from the mean of several images, because the noise of a single image also affects
// the gradients and degrades the steps. Each image is aligned at the position found and corrected for brightness, so
// the reference position stays. A few points at a time bound the work per frame. Does not allocate after construction.
class TemplateAverage {
 public:
  // n_at_once: points being averaged at the same time, some 60 us each per frame.
  explicit TemplateAverage(const KltTracker& tracker, std::size_t n_at_once = 4);

  // Adds an image in which the tracker has found its points.
  void add(const GrayView& gray, const std::vector<KltPoint>& found, KltTracker& tracker) noexcept;
  // Call when the template of a point has been replaced.
  void forget(std::size_t point) noexcept;
  [[nodiscard]] bool is_done() const noexcept { return n_begun_ == faint_.size() && work_.empty(); }

 private:
  struct Work {
    std::size_t point = 0;
    int n = 0;                // images so far
    Deformation deformation;  // sum over these images
    Patch sum{};
  };
  static void replace(const Work& work, const GrayView& gray, const KltPoint& found, KltTracker& tracker) noexcept;
  void add_to(Work& work, const GrayView& gray, const KltPoint& found, const KltTracker& tracker) noexcept;

  std::vector<std::size_t> faint_;  // indices of faint points, in order
  std::size_t n_begun_ = 0;         // number of points of faint_ begun so far
  std::vector<Work> work_;          // points being averaged
  Patch now_{};
};

}  // namespace core
