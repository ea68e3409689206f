// Samples that the gates reject: masked in the segment being gathered.
#include "core/spectrum/welch_cpsd.h"

namespace core {

// Before the newest sample is counted as filled: the one before it is the last that is.
void WelchCpsd::gate(std::size_t channel, double value, bool valid) noexcept {
  if (!config_.gate_outliers) return;
  const bool is_outlier = gate_.push(channel, value, valid);
  innovation_gate_.push(channel, value, valid, is_outlier);
  if (is_outlier) mask_outlier(channel);
}

// Once all channels of the newest sample are there.
void WelchCpsd::gate_by_prediction() noexcept {
  if (!config_.gate_outliers) return;
  innovation_gate_.settle();
  for (std::size_t c = 0; c < is_aside_.size(); ++c) {
    if (innovation_gate_.found(c)) mask_outlier(c);
  }
}

void WelchCpsd::mask_outlier(std::size_t channel) noexcept {
  ++sums_.n_outlying[channel];
  if (channel < n_counted()) ++sums_.n_missing;
  if (n_filled_ > 0) mask(channel, n_filled_ - 1);
}

bool WelchCpsd::is_doubtful(std::size_t channel) const noexcept {
  return config_.gate_outliers && (gate_.is_doubtful(channel) || innovation_gate_.is_doubtful(channel));
}

void WelchCpsd::mask(std::size_t channel, int at) noexcept {
  const std::size_t sample = channel * static_cast<std::size_t>(config_.segment) + static_cast<std::size_t>(at);
  value_[sample] = 0.0, seen_[sample] = 0;
}

void WelchCpsd::set_doubtful_aside() noexcept {
  for (std::size_t c = 0; c < is_aside_.size(); ++c) {
    is_aside_[c] = is_doubtful(c) ? 1 : 0;
    if (is_aside_[c] == 0) continue;
    const auto segment = static_cast<std::size_t>(config_.segment);
    aside_[c] = value_[c * segment + static_cast<std::size_t>(n_filled_ - 1)];
    mask(c, n_filled_ - 1);
  }
}

void WelchCpsd::restore_doubtful() noexcept {
  for (std::size_t c = 0; c < is_aside_.size(); ++c) {
    if (is_aside_[c] == 0) continue;
    const auto segment = static_cast<std::size_t>(config_.segment);
    const std::size_t at = c * segment + static_cast<std::size_t>(config_.segment - 1);
    value_[at] = aside_[c], seen_[at] = 1;
  }
}

}  // namespace core
