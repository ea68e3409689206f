#include "tools/validate/identification_match.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "core/identification/mac.h"

namespace tools {
namespace {

using core::Mode;
using core::simulation::TrueMode;
constexpr std::string_view kDigits = "0123456789";
constexpr double kNear = 0.02, kNearApparent = 0.03;  // relative

// The unused pole nearest to a frequency, none beyond `limit` (relative).
template <class Frequency>
const Mode* nearest(std::vector<const Mode*>& poles, double wanted_hz, double limit, Frequency frequency) {
  auto best = poles.end();
  double least = limit * wanted_hz;
  for (auto it = poles.begin(); it != poles.end(); ++it) {
    const double off = std::abs(frequency(**it) - wanted_hz);
    if (off < least) least = off, best = it;
  }
  if (best == poles.end()) return nullptr;
  const Mode* found = *best;
  poles.erase(best);
  return found;
}

}  // namespace

std::vector<std::complex<double>> true_shape(const TrueMode& mode, const std::vector<core::ChannelInfo>& channels) {
  std::vector<std::complex<double>> shape;
  for (const core::ChannelInfo& channel : channels) {
    shape.push_back(channel.is_base
                        ? 0.0
                        : mode.displacement[std::stoi(channel.name.substr(channel.name.find_first_of(kDigits))) - 1]);
  }
  return shape;
}

double shape_mac(const TrueMode& truth, const Mode& mode, const std::vector<core::ChannelInfo>& channels) {
  return core::mac(true_shape(truth, channels), mode.shape);
}

double apparent_hz(double frequency_hz, double rate_hz) noexcept {
  return std::abs(frequency_hz - rate_hz * std::round(frequency_hz / rate_hz));
}

Match match_modes(const core::ModalEstimate& estimate, const std::vector<TrueMode>& truth,
                  const std::vector<core::ChannelInfo>& channels) {
  std::vector<const Mode*> structural, ambiguous;
  for (const Mode& mode : estimate.modes) structural.push_back(&mode);
  for (const Mode& mode : estimate.rejected) {
    if (mode.verdict == core::Verdict::kAmbiguous) ambiguous.push_back(&mode);
  }
  Match match;
  match.modes.resize(truth.size());
  const auto take = [&](Found::As as, std::vector<const Mode*>& from, bool apparent) {
    for (std::size_t r = 0; r < truth.size(); ++r) {
      if (match.modes[r].as != Found::As::kAbsent) continue;
      const double f = truth[r].frequency_hz;
      const Mode* mode = apparent ? nearest(from, apparent_hz(f, estimate.rate_hz), kNearApparent,
                                            [](const Mode& m) { return m.apparent_hz; })
                                  : nearest(from, f, kNear, [](const Mode& m) { return m.frequency_hz; });
      if (mode != nullptr) match.modes[r] = {as, *mode, shape_mac(truth[r], *mode, channels)};
    }
  };
  take(Found::As::kRight, structural, false);
  take(Found::As::kWrongFold, structural, true);
  take(Found::As::kAmbiguous, ambiguous, true);
  match.n_false = static_cast<int>(structural.size());
  return match;
}

Statistics statistics(std::vector<double> values) {
  Statistics s;
  s.n = values.size();
  if (values.empty()) {
    const double nan = std::nan("");
    return {0, nan, nan, nan, nan, nan, nan};
  }
  const double n = static_cast<double>(s.n);
  double squares = 0.0;
  for (const double v : values) {
    s.mean += v / n;
    squares += v * v;
    if (std::abs(v) > std::abs(s.worst)) s.worst = v;
  }
  s.rms = std::sqrt(squares / n);
  double spread = 0.0;
  for (const double v : values) spread += (v - s.mean) * (v - s.mean);
  s.standard_deviation = s.n > 1 ? std::sqrt(spread / (n - 1.0)) : 0.0;
  s.standard_error = s.standard_deviation / std::sqrt(n);
  std::sort(values.begin(), values.end());
  s.median = 0.5 * (values[(s.n - 1) / 2] + values[s.n / 2]);
  return s;
}

}  // namespace tools
