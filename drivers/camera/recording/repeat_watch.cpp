#include "drivers/camera/recording/repeat_watch.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <utility>

namespace drivers {

namespace {

constexpr std::size_t kEveryRow = 8;
constexpr std::size_t kKept = 4;  // frames: a suspected repeat, two before it, one after
constexpr std::size_t kRemembered = 63, kFewest = 8;
constexpr double kOfLeast = 0.4;  // of the smallest change among the last frames
constexpr double kNoise = 0.05;   // gray levels
constexpr double kAround = 0.7;   // of the median change: noise alone makes any two frames differ by about this share
// Around the turning point of a smooth motion the outer frames differ three times as much as the inner two.
constexpr double kOfTurning = 4.0;

void take_rows(const core::Frame& frame, std::vector<std::uint8_t>& rows) {
  const auto width = static_cast<std::size_t>(frame.width_px);
  rows.clear();
  for (std::size_t at = 0; at + width <= frame.pixels.size(); at += kEveryRow * width) {
    const auto row = frame.pixels.begin() + static_cast<std::ptrdiff_t>(at);
    rows.insert(rows.end(), row, row + static_cast<std::ptrdiff_t>(width));
  }
}

}  // namespace

void FrameChange::push(const core::Frame& frame) {
  std::vector<std::uint8_t> rows;
  if (rows_.size() == kKept) {  // memory of the oldest frame is reused
    rows = std::move(rows_.back());
    rows_.pop_back();
  }
  take_rows(frame, rows);
  rows_.push_front(std::move(rows));
}

std::optional<double> FrameChange::between(std::size_t older, std::size_t newer) const {
  if (older >= rows_.size() || newer >= rows_.size()) return {};
  const std::vector<std::uint8_t>&a = rows_[older], &b = rows_[newer];
  if (a.empty() || a.size() != b.size()) return {};
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += static_cast<std::uint64_t>(std::abs(static_cast<int>(a[i]) - static_cast<int>(b[i])));
  }
  return static_cast<double>(sum) / static_cast<double>(a.size());
}

bool RepeatWatch::is_suspect(double change) const {
  if (accepted_.size() < kFewest) return false;
  const double least = *std::min_element(accepted_.begin(), accepted_.end());
  return least > kNoise && change < kOfLeast * least;
}

double RepeatWatch::median_change() const {
  std::array<double, kRemembered> sorted{};
  const auto end = std::copy(accepted_.begin(), accepted_.end(), sorted.begin());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(accepted_.size() / 2);
  std::nth_element(sorted.begin(), middle, end);
  return *middle;
}

void RepeatWatch::accept(double change) {
  accepted_.push_back(change);
  if (accepted_.size() > kRemembered) accepted_.pop_front();
  last_repeated_ = false;
}

RepeatWatch::Finding RepeatWatch::push(double change) {
  if (!is_suspect(change)) return accept(change), Finding::kNew;
  if (last_repeated_) return Finding::kRepeat;
  suspect_change_ = change;
  return Finding::kSuspect;
}

bool RepeatWatch::settle(std::optional<double> next_change, std::optional<double> around) {
  const bool stays = next_change && is_suspect(*next_change);
  const bool differs_around = around && *around >= std::max(kAround * median_change(), kOfTurning * suspect_change_);
  if (!stays && !differs_around) return accept(suspect_change_), false;
  last_repeated_ = true;
  return true;
}

RepeatFilter::Ready RepeatFilter::push(core::Frame& frame, bool is_known_repeat) {
  if (is_known_repeat) return ++n_repeated_, Ready{};
  Ready ready;
  change_.push(frame);
  const std::optional<double> change = change_.between(1, 0);
  if (holds_) {
    holds_ = false;
    ready.held = !watch_.settle(change, change_.between(3, 0));
    if (!ready.held) ++n_repeated_;
  }
  const RepeatWatch::Finding finding = change ? watch_.push(*change) : RepeatWatch::Finding::kNew;
  ready.current = finding == RepeatWatch::Finding::kNew;
  if (finding == RepeatWatch::Finding::kRepeat) ++n_repeated_;
  if (finding == RepeatWatch::Finding::kSuspect) {
    held_.pixels.resize(frame.pixels.size());
    exchange(frame);
    holds_ = true;
  }
  return ready;
}

void RepeatFilter::exchange(core::Frame& frame) noexcept { std::swap(frame, held_); }

bool RepeatFilter::end(core::Frame& frame) {
  if (!holds_) return false;
  holds_ = false;
  if (watch_.settle({}, {})) return false;
  exchange(frame);
  return true;
}

}  // namespace drivers
