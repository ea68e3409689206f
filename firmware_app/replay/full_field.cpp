#include "firmware_app/replay/full_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>

namespace app {

namespace {

constexpr std::size_t kCoreChannels = 12, kMostReferences = 6;
constexpr std::size_t kTogether = 8;     // further channels whose spectra are formed at once, beside the references
constexpr double kLeastComplete = 0.98;  // share of the samples that a channel of the core should have
constexpr double kLeastSeen = 0.3;       // with less a channel does not take part (core/identification/participation.h)

// First differences; 0 where a sample is missing.
std::vector<double> differences(const std::vector<double>& value) {
  std::vector<double> out(value.size(), 0.0);
  for (std::size_t t = 1; t < value.size(); ++t) {
    const double step = value[t] - value[t - 1];
    if (std::isfinite(step)) out[t] = step;
  }
  return out;
}

double seen_share(const std::vector<double>& value) {
  const auto seen = std::count_if(value.begin(), value.end(), [](double v) { return std::isfinite(v); });
  return value.empty() ? 0.0 : static_cast<double>(seen) / static_cast<double>(value.size());
}

double inner(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t t = 0; t < a.size(); ++t) sum += a[t] * b[t];
  return sum;
}

// Gram-Schmidt over channels: what is left of each channel's power beside the chosen ones.
class Pivoting {
 public:
  explicit Pivoting(const ChannelSeries& series) : series_(series) {
    for (const auto& value : series.value) {
      const std::vector<double> steps = differences(value);
      left_.push_back(inner(steps, steps));
      is_complete_.push_back(seen_share(value) >= kLeastComplete);
    }
  }

  void choose(std::size_t c) {
    if (left_[c] < 0.0) return;  // chosen before
    std::vector<double> own = differences(series_.value[c]);
    for (const auto& axis : axes_) {
      const double part = inner(axis, own);
      for (std::size_t t = 0; t < own.size(); ++t) own[t] -= part * axis[t];
    }
    left_[c] = -1.0;
    chosen_.push_back(c);
    const double size = std::sqrt(inner(own, own));
    if (!(size > 0.0)) return;
    for (double& step : own) step /= size;
    for (std::size_t k = 0; k < left_.size(); ++k) {
      if (left_[k] < 0.0) continue;
      const double part = inner(own, differences(series_.value[k]));
      left_[k] = std::max(0.0, left_[k] - part * part);
    }
    axes_.push_back(std::move(own));
  }
  // False if none is left.
  bool choose_largest() {
    std::size_t best = left_.size();
    const auto better = [&](std::size_t a, std::size_t b) {
      return is_complete_[a] != is_complete_[b] ? is_complete_[a] : left_[a] > left_[b];
    };
    for (std::size_t c = 0; c < left_.size(); ++c) {
      if (left_[c] >= 0.0 && (best == left_.size() || better(c, best))) best = c;
    }
    if (best == left_.size()) return false;
    choose(best);
    return true;
  }
  [[nodiscard]] const std::vector<std::size_t>& chosen() const noexcept { return chosen_; }

 private:
  const ChannelSeries& series_;
  std::vector<double> left_;
  std::vector<bool> is_complete_;
  std::vector<std::vector<double>> axes_;
  std::vector<std::size_t> chosen_;
};

// The lists of a mode, over all channels.
class WideMode {
 public:
  WideMode(core::Mode& mode, const FieldCore& core, std::size_t n_channels) : mode_(mode) {
    std::vector<std::complex<double>> shape(n_channels);
    std::vector<double> std(mode.shape_std.empty() ? 0 : n_channels);
    for (std::size_t i = 0; i < core.channels.size(); ++i) {
      shape[core.channels[i]] = mode.shape[i];
      if (!std.empty()) std[core.channels[i]] = mode.shape_std[i];
    }
    mode.shape = std::move(shape), mode.shape_std = std::move(std);
  }
  void take(const core::FieldShapes::Components& found, const std::vector<std::size_t>& channels) {
    for (std::size_t i = 0; found.is_known && i < channels.size(); ++i) {
      mode_.shape[channels[i]] = found.shape[i];
      if (!mode_.shape_std.empty() && !found.std.empty()) mode_.shape_std[channels[i]] = found.std[i];
    }
    is_known_ = is_known_ && found.is_known;
  }
  // The largest component of all channels becomes 1. Its sigma, relative to the core's largest, adds to those of the
  // others.
  void finish() {
    if (!is_known_) mode_.reason += "; its shape is known in the channels identified only";
    std::size_t one = 0;
    for (std::size_t c = 0; c < mode_.shape.size(); ++c) {
      if (std::norm(mode_.shape[c]) > std::norm(mode_.shape[one])) one = c;
    }
    const std::complex<double> largest = mode_.shape[one];
    if (largest == 0.0) return;
    for (auto& component : mode_.shape) component /= largest;
    if (mode_.shape_std.empty()) return;
    const double of_largest = mode_.shape_std[one];
    for (std::size_t c = 0; c < mode_.shape.size(); ++c) {
      const double sigma = std::hypot(mode_.shape_std[c], std::abs(mode_.shape[c]) * of_largest);
      mode_.shape_std[c] = c == one ? 0.0 : sigma / std::abs(largest);
    }
  }

 private:
  core::Mode& mode_;
  bool is_known_ = true;
};

}  // namespace

FieldCore choose_core(const ChannelSeries& series, const std::vector<int>& references) {
  Pivoting pivoting(series);
  for (std::size_t c = 0; c < series.channels.size(); ++c) {
    if (series.channels[c].is_base) pivoting.choose(c);
  }
  for (const int c : references) pivoting.choose(static_cast<std::size_t>(c));
  while (pivoting.chosen().size() < kCoreChannels && pivoting.choose_largest()) {
  }
  FieldCore out;
  out.channels = pivoting.chosen();
  std::sort(out.channels.begin(), out.channels.end());
  for (const std::size_t c : pivoting.chosen()) {
    const bool is_enough = references.empty() && out.references.size() == kMostReferences;
    const bool is_asked_for =
        references.empty() || std::find(references.begin(), references.end(), static_cast<int>(c)) != references.end();
    if (series.channels[c].is_base || is_enough || !is_asked_for) continue;
    const auto at = std::lower_bound(out.channels.begin(), out.channels.end(), c);
    out.references.push_back(static_cast<int>(at - out.channels.begin()));
  }
  std::sort(out.references.begin(), out.references.end());
  return out;
}

ChannelSeries channels_of(const ChannelSeries& series, const std::vector<std::size_t>& channels) {
  ChannelSeries out;
  out.rate_hz = series.rate_hz, out.unit = series.unit;
  for (const std::size_t c : channels) {
    out.channels.push_back(series.channels[c]);
    out.value.push_back(series.value[c]);
  }
  return out;
}

void add_field(const ChannelSeries& series, const FieldCore& core, const core::FieldShapes& field,
               const std::vector<double>& delay_s, const SumsOf& sums_of, core::ModalEstimate& estimate) {
  const std::size_t n = series.channels.size();
  std::vector<WideMode> modes;
  for (auto* list : {&estimate.modes, &estimate.rejected}) {
    for (core::Mode& mode : *list) modes.emplace_back(mode, core, n);
  }
  std::vector<core::ChannelRecord> records(n);
  for (std::size_t c = 0; c < n; ++c) {
    records[c].seen = seen_share(series.value[c]);
    if (records[c].seen >= kLeastSeen) continue;
    records[c].takes_part = false;
    records[c].reason = fmt::format("seen in {:.0f} % of the record only", 100.0 * records[c].seen);
  }
  for (std::size_t i = 0; i < core.channels.size(); ++i) records[core.channels[i]] = estimate.channels[i];
  estimate.channels = std::move(records);
  for (core::SpectralPeak& peak : estimate.peaks) {
    std::vector<double> share(n, 0.0);
    for (std::size_t i = 0; i < core.channels.size(); ++i) share[core.channels[i]] = peak.share[i];
    peak.share = std::move(share);
  }

  std::vector<std::size_t> further;
  for (std::size_t c = 0; c < n; ++c) {
    const bool in_core = std::binary_search(core.channels.begin(), core.channels.end(), c);
    if (!in_core && estimate.channels[c].takes_part) further.push_back(c);
  }
  for (std::size_t first = 0; first < further.size(); first += kTogether) {
    const std::vector<std::size_t> some(
        further.begin() + static_cast<std::ptrdiff_t>(first),
        further.begin() + static_cast<std::ptrdiff_t>(std::min(further.size(), first + kTogether)));
    std::vector<std::size_t> all;
    for (const int reference : field.references()) all.push_back(core.channels[static_cast<std::size_t>(reference)]);
    all.insert(all.end(), some.begin(), some.end());
    std::vector<core::ChannelInfo> infos;
    std::vector<double> delays_s;
    for (const std::size_t c : some) infos.push_back(series.channels[c]), delays_s.push_back(delay_s[c]);
    const auto found = field.of(sums_of(channels_of(series, all)), infos, delays_s);
    for (std::size_t line = 0; line < modes.size(); ++line) modes[line].take(found[line], some);
  }
  for (WideMode& mode : modes) mode.finish();
}

}  // namespace app
