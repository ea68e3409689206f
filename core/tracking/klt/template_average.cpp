#include "core/tracking/klt/template_average.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace core {

namespace {

constexpr double kFaint = 2.0;  // gradient over noise below which averaging helps
constexpr int kImages = 16;     // images per average
constexpr int kMargin = 12;     // of the prefilter: the averaged values become the template
constexpr int kTaps = kSplineTaps + 2 * kMargin;
constexpr int kTapsBefore = kSplineBefore + kMargin;

// Filter from samples to the spline's value at a fraction: prefilter and weights combined.
std::array<double, kTaps> taps_at(double fraction) noexcept {
  constexpr auto kWidePrefilter = spline_prefilter<kMargin>();
  return joined(kWidePrefilter, spline_weights(fraction));
}

double mean_of_window(const Patch& patch, int radius) noexcept {
  double sum = 0.0;
  for (int y = kPatchRadius - radius; y <= kPatchRadius + radius; ++y)
    for (int x = kPatchRadius - radius; x <= kPatchRadius + radius; ++x)
      sum += patch[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
  return sum / ((2.0 * radius + 1.0) * (2.0 * radius + 1.0));
}

}  // namespace

void cut_patch_between(const GrayView& gray, double u, double v, Patch& out) noexcept {
  const int cell_u = static_cast<int>(std::floor(u)), cell_v = static_cast<int>(std::floor(v));
  const auto across = taps_at(u - cell_u), down = taps_at(v - cell_v);
  constexpr int kRows = kPatch + kTaps - 1;
  std::array<std::array<double, kPatch>, kRows> rows;
  std::array<double, kRows> line;
  for (int y = 0; y < kRows; ++y) {
    const std::uint8_t* from = gray.row(mirrored(cell_v - kPatchRadius - kTapsBefore + y, gray.height));
    for (int x = 0; x < kRows; ++x)
      line[static_cast<std::size_t>(x)] = from[mirrored(cell_u - kPatchRadius - kTapsBefore + x, gray.width)];
    for (std::size_t x = 0; x < kPatch; ++x) {
      double sum = 0.0;
      for (std::size_t k = 0; k < kTaps; ++k) sum += across[k] * line[x + k];
      rows[static_cast<std::size_t>(y)][x] = sum;
    }
  }
  for (std::size_t y = 0; y < kPatch; ++y) {
    out[y].fill(0.0);
    for (std::size_t k = 0; k < kTaps; ++k)
      for (std::size_t x = 0; x < kPatch; ++x) out[y][x] += down[k] * rows[y + k][x];
  }
}

TemplateAverage::TemplateAverage(const KltTracker& tracker, std::size_t n_at_once) {
  for (std::size_t i = 0; i < tracker.n_points(); ++i) {
    const PointTemplate& pattern = tracker.point_template(i);
    const double n_pixels = (2.0 * pattern.radius + 1.0) * (2.0 * pattern.radius + 1.0);
    if (pattern.is_trackable && kFaint * kFaint * n_pixels * place_variance(pattern) > 1.0) faint_.push_back(i);
  }
  work_.reserve(std::min(n_at_once, faint_.size()));
}

void TemplateAverage::add(const GrayView& gray, const std::vector<KltPoint>& found, KltTracker& tracker) noexcept {
  while (work_.size() < work_.capacity() && n_begun_ < faint_.size()) {
    Work& work = work_.emplace_back();
    work.point = faint_[n_begun_++];
  }
  for (Work& work : work_) {
    if (!found[work.point].seen) continue;
    add_to(work, gray, found[work.point], tracker);
    if (work.n < kImages) continue;
    for (auto& row : work.sum)
      for (double& value : row) value /= work.n;
    tracker.replace_template(work.point, work.sum, work.n, (1.0 / work.n) * work.deformation);
  }
  std::erase_if(work_, [](const Work& work) { return work.n >= kImages; });
}

void TemplateAverage::forget(std::size_t point) noexcept {
  std::erase_if(work_, [&](const Work& work) { return work.point == point; });
  const auto waiting = faint_.begin() + static_cast<std::ptrdiff_t>(n_begun_);
  faint_.erase(std::remove(waiting, faint_.end(), point), faint_.end());
}

void TemplateAverage::add_to(Work& work, const GrayView& gray, const KltPoint& found,
                             const KltTracker& tracker) noexcept {
  const PointTemplate& pattern = tracker.point_template(work.point);
  const Vector2 middle = tracker.middle_of(work.point, found.position);
  if (!(found.gain > 0.0)) return;
  cut_patch_between(gray, middle.u, middle.v, now_);
  const double mean = mean_of_window(now_, pattern.radius);
  for (std::size_t y = 0; y < kPatch; ++y)
    for (std::size_t x = 0; x < kPatch; ++x) work.sum[y][x] += (now_[y][x] - mean) / found.gain + pattern.mean;
  work.deformation = work.deformation + tracker.deformation(work.point);
  ++work.n;
}

}  // namespace core
