#include "core/identification/folding.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/identification/mac.h"

namespace core {

namespace {

using Complex = std::complex<double>;

// With a smaller delay span, as a share of a frame, the phases of the hypotheses differ by less than 18 degrees.
constexpr double kLeastDelaySpanFrames = 0.05;

struct Hypothesis {
  int n = 0;
  Complex s;
  std::vector<Complex> shape;
  double mpc = 0.0;
};

Hypothesis evaluate(Complex s_apparent, int n, const std::vector<Complex>& shape, const FoldingConfig& config) {
  Hypothesis h{n, s_apparent + Complex(0.0, 2.0 * std::numbers::pi * n * config.rate_hz), shape, 0.0};
  for (std::size_t c = 0; c < h.shape.size(); ++c) h.shape[c] = as_displacement(h.shape[c], h.s, c, config);
  if (h.s.imag() < 0.0) {  // the other member of the conjugate pair: positive frequency, conjugate shape
    h.s = std::conj(h.s);
    for (Complex& z : h.shape) z = std::conj(z);
  }
  h.mpc = mpc(h.shape);
  return h;
}

}  // namespace

std::vector<int> alias_orders(double apparent_hz, double rate_hz, double limit_hz) {
  std::vector<int> out;
  const int reach = static_cast<int>(std::ceil(limit_hz / rate_hz)) + 1;
  for (int n = -reach; n <= reach; ++n) {
    if (!(std::abs(apparent_hz + n * rate_hz) > limit_hz)) out.push_back(n);
  }
  return out;
}

Complex as_displacement(Complex component, Complex s, std::size_t channel, const FoldingConfig& config) {
  if (channel < config.delay_s.size()) component *= std::exp(-s * config.delay_s[channel]);
  for (int k = 0; channel < config.n_integrations.size() && k < config.n_integrations[channel]; ++k) component /= s;
  return component;
}

bool folding_observable(const FoldingConfig& config) noexcept {
  if (config.delay_s.size() < 3) return false;
  const auto [low, high] = std::minmax_element(config.delay_s.begin(), config.delay_s.end());
  return (*high - *low) * config.rate_hz >= kLeastDelaySpanFrames;
}

void normalise_shape(std::vector<Complex>& shape) noexcept {
  Complex largest = 0.0;
  for (const Complex& z : shape) {
    if (std::norm(z) > std::norm(largest)) largest = z;
  }
  if (std::norm(largest) == 0.0) return;
  for (Complex& z : shape) z = z == largest ? Complex(1.0, 0.0) : z / largest;
}

std::vector<Complex> observed_shape(const UnfoldedPole& pole, const FoldingConfig& config) {
  const bool conjugate = pole.apparent_hz + pole.fold_n.value_or(0) * config.rate_hz < 0.0;
  std::vector<Complex> shape = pole.shape;
  for (std::size_t c = 0; c < shape.size() && c < config.delay_s.size(); ++c) {
    shape[c] *= std::exp(pole.s * config.delay_s[c]);
    if (conjugate) shape[c] = std::conj(shape[c]);
  }
  return shape;
}

std::vector<double> other_frequencies(const UnfoldedPole& pole, const FoldingConfig& config, double least_margin) {
  std::vector<double> out;
  const double rate_hz = config.rate_hz;
  if (config.max_frequency_hz > 0.0 && config.max_frequency_hz <= 0.5 * rate_hz) return out;
  const double limit_hz = config.max_frequency_hz > 0.0 ? config.max_frequency_hz : kOthersUpTo * rate_hz;
  const std::vector<Complex> observed = observed_shape(pole, config);
  const Complex s_apparent(pole.s.real(), 2.0 * std::numbers::pi * pole.apparent_hz);
  const bool observable = folding_observable(config);
  for (const int n : alias_orders(pole.apparent_hz, rate_hz, limit_hz)) {
    if (n == pole.fold_n.value_or(0)) continue;
    if (observable && pole.mpc - evaluate(s_apparent, n, observed, config).mpc >= least_margin) continue;
    out.push_back(std::abs(pole.apparent_hz + n * rate_hz));
  }
  std::sort(out.begin(), out.end());
  if (out.size() > kMostOthers) out.resize(kMostOthers);
  return out;
}

UnfoldedPole unfold(Complex lambda, const std::vector<Complex>& shape, const FoldingConfig& config) {
  const Complex s_apparent = std::log(lambda) * config.rate_hz;
  UnfoldedPole out;
  out.apparent_hz = s_apparent.imag() / (2.0 * std::numbers::pi);
  Hypothesis best = evaluate(s_apparent, 0, shape, config);
  Hypothesis rival{0, {}, {}, -1.0};  // second-best hypothesis
  if (config.max_frequency_hz > config.rate_hz / 2.0) {
    for (const int n : alias_orders(out.apparent_hz, config.rate_hz, config.max_frequency_hz)) {
      if (n == 0) continue;
      Hypothesis other = evaluate(s_apparent, n, shape, config);
      if (other.mpc > best.mpc && folding_observable(config)) std::swap(best, other);
      if (other.mpc > rival.mpc) rival = std::move(other);
    }
  }
  if (rival.mpc >= 0.0 && folding_observable(config)) {
    out.fold_n = best.n;
    out.fold_margin = best.mpc - rival.mpc;
  } else if (rival.mpc >= 0.0) {
    out.fold_open = true;
    best.mpc = std::max(best.mpc, rival.mpc);
  }
  out.s = best.s;
  out.mpc = best.mpc;
  out.shape = std::move(best.shape);
  normalise_shape(out.shape);
  return out;
}

}  // namespace core
