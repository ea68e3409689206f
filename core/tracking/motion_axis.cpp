#include "core/tracking/motion_axis.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

#include "core/linear/median.h"
#include "core/spectrum/real_fft.h"

namespace core {
namespace {

using Complex = std::complex<double>;
using Spectrum = std::vector<Complex>;

// Second moments of the motion.
struct Moments {
  double uu = 0.0, uv = 0.0, vv = 0.0;
  void add(const Complex& u, const Complex& v, double share) noexcept {
    uu += share * std::norm(u), uv += share * (u * std::conj(v)).real(), vv += share * std::norm(v);
  }
};

constexpr std::size_t kFewestFrames = 64;

template <class Get>
Spectrum spectrum_of(const std::vector<Vector2>& motion, const Get& get) {
  const auto n = motion.size();
  RealFft fft(next_power_of_two(static_cast<int>(n)));
  std::vector<double> padded(static_cast<std::size_t>(fft.size()), 0.0);
  for (std::size_t t = 0; t < n; ++t) {
    const double window =
        0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (static_cast<double>(t) + 0.5) / static_cast<double>(n));
    padded[t] = window * get(motion[t]);
  }
  Spectrum out(static_cast<std::size_t>(fft.n_bins()));
  fft.forward(padded, out);
  return out;
}

double power(const Spectrum& u, const Spectrum& v, std::size_t k) noexcept { return std::norm(u[k]) + std::norm(v[k]); }

// Median of one side's bins, without the bin's own lobe.
double median_from(const Spectrum& u, const Spectrum& v, std::size_t first, std::size_t end) {
  std::vector<double> values;
  for (std::size_t k = std::max<std::size_t>(1, first); k < std::min(end, u.size()); ++k)
    values.push_back(power(u, v, k));
  return values.empty() ? 0.0 : median(std::move(values));
}

// The higher of both sides: a spectrum that falls has no peak.
double beside(const Spectrum& u, const Spectrum& v, std::size_t k) {
  constexpr std::size_t kLobe = 4, kReach = 14;
  const double below = median_from(u, v, k > kReach ? k - kReach : 1, k > kLobe ? k - kLobe : 1);
  return std::max(below, median_from(u, v, k + kLobe + 1, k + kReach + 1));
}

// Of the bins that stand out, each in units of what lies beside it; all zero where none does.
Moments moments_of_peaks(const std::vector<Vector2>& motion, std::size_t slow_frames) {
  constexpr double kStandsOut = 12.0;  // noise of two axes exceeds this share of its median in one of 10^8 bins
  const Spectrum u = spectrum_of(motion, [](const Vector2& m) { return m.u; });
  const Spectrum v = spectrum_of(motion, [](const Vector2& m) { return m.v; });
  Moments out;
  const std::size_t n_fft = 2 * (u.size() - 1);
  for (std::size_t k = n_fft / std::max<std::size_t>(1, slow_frames) + 1; k < u.size(); ++k) {
    const double level = beside(u, v, k), here = power(u, v, k);
    if (level > 0.0 && here > kStandsOut * level) out.add(u[k], v[k], 1.0 / level);
  }
  return out;
}

Moments moments_of_all(const std::vector<Vector2>& motion) {
  Moments out;
  for (const Vector2& m : motion) out.add(m.u, m.v, 1.0);
  return out;
}

}  // namespace

double vibration_axis_deg(const std::vector<Vector2>& motion, std::size_t slow_frames) {
  constexpr double kNear_deg = 20.0;
  Moments moments;
  if (motion.size() >= kFewestFrames) moments = moments_of_peaks(motion, slow_frames);
  if (!(moments.uu + moments.vv > 0.0)) moments = moments_of_all(motion);
  const double degrees = 0.5 * std::atan2(2.0 * moments.uv, moments.uu - moments.vv) * 180.0 / std::numbers::pi;
  if (std::abs(degrees) <= kNear_deg) return 0.0;
  if (std::abs(std::abs(degrees) - 90.0) <= kNear_deg) return 90.0;
  return std::round(degrees);
}

}  // namespace core
