#include "core/spectrum/outlier_gate.h"

#include <algorithm>
#include <cmath>

namespace core {

namespace {

using Channel = OutlierGate::Channel;

// The scale exceeds seven eighths of the departures in memory: the peaks of a vibration are 1.4 times the scale, and a
// few outliers in memory hardly change it.
constexpr std::uint32_t kScaleShare = 8;
constexpr double kFar = 16.0;
constexpr std::uint32_t kLeastDepartures = 16;
// Share of the outlier's departure within which the next sample must return to the extrapolation of the earlier ones.
constexpr double kReturned = 0.25;
// The line through two samples, extrapolated by two steps, errs by three second differences, i.e. six departures, and
// by more where the vibration is momentarily larger than usual.
constexpr double kExtrapolation = 9.0;
// The neighbours of an outlier differ by less than this share of the departure, or by less than this multiple of the
// usual difference in memory.
constexpr double kApart = 0.55, kUsualStep = 2.0;
// In samples. A departure so soon after another large departure (not an outlier) is taken as motion.
constexpr std::uint32_t kMotion = 16;
// ... and so is one so soon after an outlier: the channel vibrates.
constexpr std::uint32_t kSuccession = 4;

bool can_judge(const Channel& channel) noexcept { return channel.n_departures >= kLeastDepartures; }

// True if at least an eighth of the memory reaches `size`.
bool reaches(const std::array<double, OutlierGate::kMemory>& memory, std::uint32_t n_known, double size) noexcept {
  const std::uint32_t wanted = n_known / kScaleShare;
  std::uint32_t n = 0;
  for (std::uint32_t i = 0; i < n_known && n < wanted; ++i) n += memory[i] >= size ? 1U : 0U;
  return n >= wanted;
}
bool is_usual(const Channel& channel, double size) noexcept {
  return reaches(channel.departure, channel.n_departures, size);
}
bool is_usual_step(const Channel& channel, double step) noexcept {
  return reaches(channel.step, channel.n_departures, step / kUsualStep);
}

// A channel that hardly moves (quantised, static) has no scale: none of its samples is an outlier.
bool has_scale(const Channel& channel) noexcept { return is_usual(channel, 1e-300); }

bool is_far(const Channel& channel, double departure) noexcept {
  return !is_usual(channel, std::abs(departure) / kFar) && has_scale(channel);
}

void note(Channel& channel, double departure, double step) noexcept {
  channel.departure[channel.i_next] = std::abs(departure);
  channel.step[channel.i_next] = std::abs(step);
  channel.i_next = (channel.i_next + 1) % OutlierGate::kMemory;
  channel.n_departures = std::min<std::uint32_t>(channel.n_departures + 1, OutlierGate::kMemory);
}

void replace_newest(Channel& channel, double departure) noexcept {
  if (channel.n_departures == 0) return;
  channel.departure[(channel.i_next + OutlierGate::kMemory - 1) % OutlierGate::kMemory] = std::abs(departure);
}

void append(Channel& channel, double value) noexcept {
  if (channel.n_last < channel.last.size()) {
    channel.last[channel.n_last++] = value;
    return;
  }
  std::rotate(channel.last.begin(), channel.last.begin() + 1, channel.last.end());
  channel.last.back() = value;
}

bool is_motion(const Channel& c) noexcept { return c.n_since_far <= kMotion || c.n_since_outlier <= kSuccession; }

// True if `value`, the sample after a large departure, lies where the two samples before it lead to.
bool is_back(const Channel& c, double value, double departure) noexcept {
  const double step = std::abs(value - c.last[1]), size = std::abs(departure);
  if (step > kApart * size && !is_usual_step(c, step)) return false;
  const double away = std::abs(value - (c.last[1] + 2.0 * (c.last[1] - c.last[0])));
  return away <= kReturned * size || is_usual(c, away / kExtrapolation);
}

// The sample before an outlier departs far only because of it: it counts as motion only after the next was classified.
void note_motion(Channel& c, bool departs_far, bool is_outlier) noexcept {
  c.n_since_far = std::min<std::uint32_t>(c.n_since_far + 1, OutlierGate::kMemory);
  if (c.is_last_far != 0 && !is_outlier) c.n_since_far = 0;
  c.is_last_far = departs_far && !is_outlier ? 1 : 0;
  c.n_since_outlier = is_outlier ? 0 : std::min<std::uint32_t>(c.n_since_outlier + 1, OutlierGate::kMemory);
}

// Departure of the newest sample from the line through the two before it, in units of departures between neighbours.
double departure_from_past(const Channel& channel) noexcept {
  return 0.5 * (channel.last[2] - 2.0 * channel.last[1] + channel.last[0]);
}

}  // namespace

bool OutlierGate::is_doubtful(std::size_t channel) const noexcept {
  const Channel& c = channels_[channel];
  return c.n_last == c.last.size() && can_judge(c) && is_far(c, departure_from_past(c));
}

bool OutlierGate::push(std::size_t channel, double value, bool seen) noexcept {
  Channel& c = channels_[channel];
  if (!seen || !std::isfinite(value)) {
    // No later sample can confirm a sample before a gap.
    const bool is_outlier = is_doubtful(channel) && !is_motion(c);
    c.n_last = 0;
    return is_outlier;
  }
  bool is_outlier = false;
  if (c.n_last >= 2) {
    double& middle = c.last[c.n_last - 1];
    const double before = c.last[c.n_last - 2], step = value - before;
    const double line = 0.5 * (before + value), departure = middle - line;
    const bool departs_far = c.n_last == c.last.size() && can_judge(c) && is_far(c, departure);
    if (departs_far) is_outlier = !is_motion(c) && is_back(c, value, departure);
    note_motion(c, departs_far, is_outlier);
    if (is_outlier) {
      middle = line;
      replace_newest(c, c.last[1] - 0.5 * (c.last[0] + line));  // relative to the replaced outlier before
    }
    note(c, departure, step);
  }
  append(c, value);
  return is_outlier;
}

void OutlierGate::restart() noexcept { std::fill(channels_.begin(), channels_.end(), Channel{}); }

bool OutlierGate::is_consistent() const noexcept {
  return std::all_of(channels_.begin(), channels_.end(), [](const Channel& c) {
    const auto finite = [](double x) { return std::isfinite(x); };
    return c.n_last <= c.last.size() && c.n_departures <= kMemory && c.i_next < kMemory &&
           std::all_of(c.last.begin(), c.last.end(), finite) &&
           std::all_of(c.departure.begin(), c.departure.end(), finite) &&
           std::all_of(c.step.begin(), c.step.end(), finite);
  });
}

}  // namespace core
