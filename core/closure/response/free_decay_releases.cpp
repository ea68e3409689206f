#include "core/closure/response/free_decay_releases.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace core::closure {
namespace {

using Values = std::vector<double>;

constexpr std::size_t kFewestReleases = 3, kFewestSamples = 12, kQuietSteps = 5, kToCross = 6;
constexpr std::size_t kQuietWindow = 16;

double median_of_seen(const Values& values) {
  Values seen;
  std::copy_if(values.begin(), values.end(), std::back_inserter(seen), [](double v) { return std::isfinite(v); });
  if (seen.empty()) return 0.0;
  const auto middle = seen.begin() + static_cast<std::ptrdiff_t>(seen.size() / 2);
  std::nth_element(seen.begin(), middle, seen.end());
  return *middle;
}

std::size_t largest_channel(const std::vector<Values>& value, const Values& rest) {
  std::size_t best = 0;
  double most = -1.0;
  for (std::size_t c = 0; c < value.size(); ++c) {
    double squares = 0.0;
    for (const double v : value[c]) squares += std::isfinite(v) ? (v - rest[c]) * (v - rest[c]) : 0.0;
    if (squares > most) most = squares, best = c;
  }
  return best;
}

bool all_seen(const std::vector<Values>& value, std::size_t k) {
  return std::all_of(value.begin(), value.end(), [&](const Values& v) { return std::isfinite(v[k]); });
}

// Samples at which the largest channel first exceeds its equilibrium after a sudden step out of a quiet phase.
std::vector<std::size_t> starts_of(const Values& y, double rest, const ReleaseSearch& search) {
  Values step(y.size(), 0.0);
  for (std::size_t k = 1; k < y.size(); ++k) step[k] = std::isfinite(y[k] - y[k - 1]) ? std::abs(y[k] - y[k - 1]) : 0.0;
  const double largest = *std::max_element(step.begin(), step.end());
  std::vector<std::size_t> out;
  for (std::size_t k = kQuietSteps + 1; k < y.size(); ++k) {
    const auto here = step.begin() + static_cast<std::ptrdiff_t>(k);
    const double before = *std::max_element(here - static_cast<std::ptrdiff_t>(kQuietSteps), here);
    if (step[k] < search.quiet * largest || before >= search.quiet * largest) continue;
    const double pulled = y[k - 1] - rest;
    double sudden = step[k];
    std::size_t crossed = 0;
    for (std::size_t j = k; j < std::min(k + kToCross, y.size()) && crossed == 0; ++j) {
      sudden = std::max(sudden, step[j]);
      if ((y[j] - rest) * pulled < 0.0) crossed = j;
    }
    if (crossed > 0 && sudden >= search.sudden * largest) out.push_back(crossed);
  }
  return out;
}

// rms about a line in the quietest window, over all channels.
double quiet_rms(const std::vector<Values>& value) {
  double best = std::numeric_limits<double>::infinity();
  const std::size_t n = value.front().size();
  const double middle = 0.5 * (kQuietWindow - 1);
  for (std::size_t k = 0; k + kQuietWindow <= n; k += kQuietWindow / 2) {
    double squares = 0.0;
    for (const Values& v : value) {
      double sum = 0.0, slope = 0.0, weight = 0.0;
      for (std::size_t i = 0; i < kQuietWindow; ++i) {
        const double t = static_cast<double>(i) - middle;
        sum += v[k + i], slope += t * v[k + i], weight += t * t;
      }
      for (std::size_t i = 0; i < kQuietWindow; ++i) {
        const double t = static_cast<double>(i) - middle;
        squares += std::pow(v[k + i] - sum / kQuietWindow - slope / weight * t, 2);
      }
    }
    const double rms = std::sqrt(squares / static_cast<double>(value.size() * (kQuietWindow - 2)));
    if (rms > 0.0 && rms < best) best = rms;
  }
  return std::isfinite(best) ? best : 0.0;
}

}  // namespace

FreeDecays find_free_decays(const std::vector<Values>& value, double rate_hz, const std::vector<std::string>& channels,
                            const std::string& unit, const ReleaseSearch& search) {
  if (!(rate_hz > 0.0) || value.empty() || channels.size() != value.size())
    throw std::invalid_argument("free decays: a rate, and a name for each channel");
  const std::size_t n = value.front().size();
  for (const Values& v : value) {
    if (v.size() != n) throw std::invalid_argument("free decays: channels of one length");
  }
  FreeDecays out{rate_hz, channels, unit, {}, {}, 0.0};
  Values rest;
  for (const Values& v : value) rest.push_back(median_of_seen(v));
  const std::size_t largest = largest_channel(value, rest);
  const auto most = static_cast<std::size_t>(std::max(search.length_s * rate_hz, 0.0)) + 1;
  const std::vector<std::size_t> starts = starts_of(value[largest], rest[largest], search);
  for (std::size_t r = 0; r < starts.size(); ++r) {
    const std::size_t next = r + 1 < starts.size() ? starts[r + 1] - kToCross : n;
    std::size_t length = 0;
    while (length < most && starts[r] + length < std::min(next, n) && all_seen(value, starts[r] + length)) ++length;
    if (length < kFewestSamples) continue;
    Eigen::MatrixXd decay(static_cast<Eigen::Index>(length), static_cast<Eigen::Index>(value.size()));
    for (std::size_t c = 0; c < value.size(); ++c) {
      for (std::size_t k = 0; k < length; ++k)
        decay(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(c)) = value[c][starts[r] + k] - rest[c];
    }
    out.release.push_back(std::move(decay));
    out.start.push_back(starts[r]);
  }
  if (out.release.size() < kFewestReleases)
    throw std::invalid_argument(
        "free decays: " + std::to_string(out.release.size()) +
        " releases found; three or more are needed, each after a moment without motion, so that one "
        "can be left out");
  out.noise_rms = quiet_rms(value);
  return out;
}

}  // namespace core::closure
