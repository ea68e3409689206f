#include "core/tracking/klt/template_average.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/tracking/klt/fractional_shift.h"

namespace core {

namespace {

constexpr double kFaint = 6.0;  // gradient over noise below which averaging helps
constexpr int kImages = 16;     // images per average
double mean_of_window(const Patch& patch, int radius) noexcept {
  double sum = 0.0;
  for (int y = kPatchRadius - radius; y <= kPatchRadius + radius; ++y)
    for (int x = kPatchRadius - radius; x <= kPatchRadius + radius; ++x)
      sum += static_cast<double>(patch[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)]);
  return sum / ((2.0 * radius + 1.0) * (2.0 * radius + 1.0));
}

}  // namespace

void cut_patch_between(const GrayView& gray, double u, double v, Patch& out) noexcept {
  const int cell_u = static_cast<int>(std::floor(u)), cell_v = static_cast<int>(std::floor(v));
  const FractionalShift across = fractional_shift(cell_u - u), down = fractional_shift(cell_v - v);
  constexpr int kRows = kPatch + kShiftTaps - 1;
  std::array<std::array<float, kPatch>, kRows> rows;
  std::array<float, kRows> line;
  for (int y = 0; y < kRows; ++y) {
    const std::uint8_t* from = gray.row(mirrored(cell_v - kPatchRadius + down.first + y, gray.height));
    for (int x = 0; x < kRows; ++x)
      line[static_cast<std::size_t>(x)] = from[mirrored(cell_u - kPatchRadius + across.first + x, gray.width)];
    auto& row = rows[static_cast<std::size_t>(y)];
    row.fill(0.0F);
    for (std::size_t k = 0; k < kShiftTaps; ++k)
      for (std::size_t x = 0; x < kPatch; ++x) row[x] += static_cast<float>(across.taps[k]) * line[x + k];
  }
  for (std::size_t y = 0; y < kPatch; ++y) {
    out[y].fill(0.0F);
    for (std::size_t k = 0; k < kShiftTaps; ++k)
      for (std::size_t x = 0; x < kPatch; ++x) out[y][x] += static_cast<float>(down.taps[k]) * rows[y + k][x];
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
      for (float& value : row) value /= static_cast<float>(work.n);
    replace(work, gray, found[work.point], tracker);
  }
  std::erase_if(work_, [](const Work& work) { return work.n >= kImages; });
}

// The noise of the first template has displaced the point by a constant, which stays: without it, its track would step.
void TemplateAverage::replace(const Work& work, const GrayView& gray, const KltPoint& found,
                              KltTracker& tracker) noexcept {
  tracker.replace_template(work.point, work.sum, work.n, (1.0 / work.n) * work.deformation);
  const KltPoint again = tracker.find(gray, work.point, found.position);
  if (!again.seen) return;
  tracker.shift_datum(work.point, {again.position.u - found.position.u, again.position.v - found.position.v});
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
  const auto mean = static_cast<float>(mean_of_window(now_, pattern.radius)), old = static_cast<float>(pattern.mean);
  const auto darker = static_cast<float>(1.0 / found.gain);
  for (std::size_t y = 0; y < kPatch; ++y)
    for (std::size_t x = 0; x < kPatch; ++x) work.sum[y][x] += darker * (now_[y][x] - mean) + old;
  work.deformation = work.deformation + tracker.deformation(work.point);
  ++work.n;
}

}  // namespace core
