#include "core/spectrum/innovation_gate.h"

#include <algorithm>
#include <cmath>

namespace core {

namespace {

using Channel = InnovationGate::Channel;
constexpr std::size_t kOrder = InnovationGate::kOrder, kNewest = InnovationGate::kHistory - 1;

// Of the scale, below which seven eighths of the innovations lie: eighteen standard deviations of Gaussian ones. The
// vibration of a measured frame that is shaken in bursts reaches a hundred, in all channels together.
constexpr double kFar = 12.0;
constexpr double kQuiet = 2.5;  // another channel's innovation: four standard deviations
// What of both innovations the departure must explain: all but the usual, or all but a share of it.
constexpr double kUnexplained = 3.0, kUnexplainedShare = 0.15;
constexpr std::size_t kLeastOthers = 2;
constexpr std::uint32_t kLeastFollowed = 40, kFirstInnovation = 20, kLeastInnovations = 16;
constexpr double kKept = 1.0 - 1.0 / 128.0;  // of the products, from one sample to the next

bool is_full(const Channel& c) noexcept { return c.n_values == InnovationGate::kHistory; }
bool can_judge(const Channel& c) noexcept {
  return is_full(c) && c.n_followed >= kLeastFollowed && c.n_innovations >= kLeastInnovations;
}

// The one that ends `back` samples before the newest.
double second_difference(const Channel& c, std::size_t back) noexcept {
  const std::size_t i = kNewest - back;
  return c.value[i] - 2.0 * c.value[i - 1] + c.value[i - 2];
}

double innovation(const Channel& c, std::size_t back) noexcept {
  double sum = 0.0;
  for (std::size_t k = 0; k <= kOrder; ++k) sum += c.filter[k] * second_difference(c, back + k);
  return sum;
}

// Seven eighths of the innovations in memory are smaller.
double scale_of(const Channel& c) noexcept {
  std::array<double, InnovationGate::kMemory> sorted = c.innovation;
  const std::ptrdiff_t n = c.n_innovations;
  std::nth_element(sorted.begin(), sorted.begin() + n * 7 / 8, sorted.begin() + n);
  return sorted[static_cast<std::size_t>(n * 7 / 8)];
}

// A departure of one sample by 1 appears in its own innovation as 1, and in the next one as this.
double echo(const Channel& c) noexcept { return c.filter[1] - 2.0; }

// Least squares over both innovations.
double departure(const Channel& c) noexcept { return (c.before + echo(c) * c.newest) / (1.0 + echo(c) * echo(c)); }

bool departs_alone_in_time(const Channel& c) noexcept {
  const double g = echo(c), norm = std::sqrt(1.0 + g * g), scale = scale_of(c);
  const double size = std::abs(departure(c)) * norm, rest = std::abs(c.newest - g * c.before) / norm;
  return scale > 0.0 && size > kFar * scale && rest < std::max(kUnexplained * scale, kUnexplainedShare * size);
}

// From reflection coefficients, which lie within -1 .. 1 whatever the samples were [Levinson 1947].
void fit_filter(Channel& c) noexcept {
  std::array<double, kOrder + 1> a{}, last{};
  a[0] = 1.0;
  for (std::size_t m = 1; m <= kOrder; ++m) {
    const double reflection = c.power[m - 1] > 0.0 ? -c.product[m - 1] / c.power[m - 1] : 0.0;
    last = a;
    for (std::size_t k = 1; k < m; ++k) a[k] += reflection * last[m - k];
    a[m] = reflection;
  }
  c.filter = a;
}

// One step of an adaptive lattice [Burg 1967]: forward and backward errors of every order.
void follow_lattice(Channel& c, double sample) noexcept {
  double forward = sample, backward = sample;
  for (std::size_t m = 0; m < kOrder; ++m) {
    const double delayed = c.backward[m];
    c.backward[m] = backward;
    c.product[m] = kKept * c.product[m] + 2.0 * forward * delayed;
    c.power[m] = kKept * c.power[m] + forward * forward + delayed * delayed;
    const double reflection = c.power[m] > 0.0 ? -c.product[m] / c.power[m] : 0.0;
    backward = delayed + reflection * forward;
    forward += reflection * delayed;
  }
}

void note_innovation(Channel& c) noexcept {
  c.innovation[c.i_next] = std::abs(innovation(c, 1));
  c.i_next = (c.i_next + 1) % InnovationGate::kMemory;
  c.n_innovations = std::min<std::uint32_t>(c.n_innovations + 1, InnovationGate::kMemory);
}

// With the sample before the newest, which has been judged.
void follow(Channel& c) noexcept {
  if (!is_full(c)) return;
  if (c.n_followed >= kFirstInnovation) note_innovation(c);
  follow_lattice(c, second_difference(c, 1));
  c.n_followed = std::min<std::uint32_t>(c.n_followed + 1, InnovationGate::kMemory);
  fit_filter(c);
}

void replace_outlier(Channel& c) noexcept {
  if (c.is_outlier != 0)
    c.value[kNewest - 1] -= departure(c);
  else if (c.was_outlier != 0 && c.n_values > 2)
    c.value[kNewest - 1] = 0.5 * (c.value[kNewest - 2] + c.value[kNewest]);
}

bool is_quiet(double innovation, double scale) noexcept { return std::abs(innovation) <= kQuiet * scale; }

}  // namespace

void InnovationGate::push(std::size_t channel, double value, bool seen, bool was_outlier) noexcept {
  Channel& c = channels_[channel];
  c.is_outlier = 0, c.was_outlier = was_outlier ? 1 : 0;
  if (!seen || !std::isfinite(value)) {
    c.n_values = 0, c.backward = {};
    return;
  }
  std::rotate(c.value.begin(), c.value.begin() + 1, c.value.end());
  c.value.back() = value;
  c.n_values = std::min<std::uint32_t>(c.n_values + 1, kHistory);
  if (!can_judge(c)) return;
  c.before = innovation(c, 1), c.newest = innovation(c, 0);
}

bool InnovationGate::is_alone(std::size_t channel, bool with_before) const noexcept {
  std::size_t n_others = 0;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if (i == channel || !can_judge(channels_[i])) continue;
    const double scale = scale_of(channels_[i]);
    if (!is_quiet(channels_[i].newest, scale) || (with_before && !is_quiet(channels_[i].before, scale))) return false;
    ++n_others;
  }
  return n_others >= kLeastOthers;
}

void InnovationGate::settle() noexcept {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    Channel& c = channels_[i];
    if (!can_judge(c)) continue;
    c.is_outlier = c.was_outlier != 0 || (departs_alone_in_time(c) && is_alone(i, true)) ? 1 : 0;
  }
  for (Channel& c : channels_) {
    replace_outlier(c);
    follow(c);
  }
}

bool InnovationGate::is_doubtful(std::size_t channel) const noexcept {
  const Channel& c = channels_[channel];
  if (!can_judge(c)) return false;
  const double scale = scale_of(c);
  return scale > 0.0 && std::abs(c.newest) > kFar * scale && is_alone(channel, false);
}

void InnovationGate::restart() noexcept { std::fill(channels_.begin(), channels_.end(), Channel{}); }

bool InnovationGate::is_consistent() const noexcept {
  const auto finite = [](const auto& values) {
    return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
  };
  return std::all_of(channels_.begin(), channels_.end(), [&](const Channel& c) {
    return c.n_values <= kHistory && c.n_innovations <= kMemory && c.i_next < kMemory && std::isfinite(c.before) &&
           std::isfinite(c.newest) && finite(c.value) && finite(c.product) && finite(c.power) && finite(c.backward) &&
           finite(c.filter) && finite(c.innovation);
  });
}

}  // namespace core
