#include "core/identification/neighbour_leakage.h"

#include <algorithm>
#include <cmath>

#include "core/identification/stabilisation.h"
#include "core/types/constants.h"

namespace core {

namespace {

using Complex = std::complex<double>;
using Shape = std::vector<Complex>;

constexpr int kPhases = 180;                 // tried over half a turn
constexpr double kLeastLeft = 0.2;           // share of the shape's square
constexpr std::size_t kLeastComponents = 5;  // fewer components are in phase after any fit
constexpr double kReach = 2.0;               // distance of a neighbour, in half-power widths of both poles together
constexpr double kLeastNeighbourMpc = 0.9;

// Squares of a shape's components along the real and the imaginary axis.
struct Parts {
  double in_phase = 0.0, out_of_phase = 0.0;
};

Parts parts_of(const Shape& shape, const Shape& turn) {
  Parts out;
  for (std::size_t c = 0; c < shape.size(); ++c) {
    const Complex z = shape[c] * turn[c];
    out.in_phase += z.real() * z.real(), out.out_of_phase += z.imag() * z.imag();
  }
  return out;
}

double width_hz(const UnfoldedPole& pole) { return std::abs(damping_ratio(pole.s)) * frequency_hz(pole.s); }

// MPC reduced by the two real parameters fitted to the n - 1 components that can be out of phase.
double without_fitted(double mpc, std::size_t n_components) {
  const double n = static_cast<double>(n_components) - 1.0;
  return 1.0 - (1.0 - mpc) * n / (n - 2.0);
}

}  // namespace

NeighbourLeakage::NeighbourLeakage(Shape neighbour, Complex s, const FoldingConfig& config)
    : neighbour_(std::move(neighbour)), turn_(neighbour_.size(), 1.0) {
  for (std::size_t c = 0; c < turn_.size() && c < config.delay_s.size(); ++c)
    turn_[c] = std::exp(-s * config.delay_s[c]);
  for (std::size_t c = 0; c < turn_.size() && c < config.n_integrations.size(); ++c)
    turn_[c] *= std::pow(s, -config.n_integrations[c]);
}

// Least squares of Im(turn (phi - c psi)) over the real and the imaginary part of c.
Complex NeighbourLeakage::coefficient(const Shape& shape) const {
  double aa = 0.0, ab = 0.0, bb = 0.0, ay = 0.0, by = 0.0;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    const Complex psi = neighbour_[i] * turn_[i];
    const double a = psi.imag(), b = psi.real(), y = (shape[i] * turn_[i]).imag();
    aa += a * a, ab += a * b, bb += b * b, ay += a * y, by += b * y;
  }
  const double determinant = aa * bb - ab * ab;
  if (!(determinant > 1e-6 * aa * bb)) return 0.0;
  return {(ay * bb - by * ab) / determinant, (by * aa - ay * ab) / determinant};
}

Shape NeighbourLeakage::without(const Shape& shape) const {
  const Complex c = coefficient(shape);
  Shape out = shape;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] -= c * neighbour_[i];
  return out;
}

std::optional<NeighbourLeakage> NeighbourLeakage::fit(const Shape& shape, const Shape& neighbour, Complex s,
                                                      const FoldingConfig& config) {
  NeighbourLeakage turned(neighbour, s, config);
  const Complex step = std::polar(1.0, -0.5 * kTwoPi / kPhases);
  std::optional<NeighbourLeakage> best;
  double least = HUGE_VAL;
  for (int k = 0; k < kPhases; ++k) {
    const Parts left = parts_of(turned.without(shape), turned.turn_);
    const double ratio = left.in_phase > 0.0 ? left.out_of_phase / left.in_phase : HUGE_VAL;
    if (ratio < least) least = ratio, best = turned;
    for (Complex& turn : turned.turn_) turn *= step;
  }
  if (!best) return best;
  double whole = 0.0, left = 0.0;
  for (const Complex& z : shape) whole += std::norm(z);
  for (const Complex& z : best->without(shape)) left += std::norm(z);
  return left >= kLeastLeft * whole ? best : std::nullopt;
}

namespace {

// The nearest pole whose shape is well defined, or none.
std::optional<std::size_t> neighbour_of(std::size_t own, const std::vector<UnfoldedPole>& poles) {
  std::optional<std::size_t> nearest;
  double least = HUGE_VAL;
  for (std::size_t m = 0; m < poles.size(); ++m) {
    if (m == own || !poles[m].fold_n || poles[m].mpc < std::max(kLeastNeighbourMpc, poles[own].mpc)) continue;
    const double apart = std::abs(poles[m].apparent_hz - poles[own].apparent_hz);
    if (apart < least && apart < kReach * (width_hz(poles[m]) + width_hz(poles[own]))) least = apart, nearest = m;
  }
  return nearest;
}

// Replaces the pole by the best alias order without what leaks from its neighbour, if that explains more.
void unfold_beside(const DiscretePole& pole, const Shape& shape, const UnfoldedPole& neighbour,
                   const Shape& neighbour_shape, const FoldingConfig& config, UnfoldedPole& own,
                   std::optional<NeighbourLeakage>& leak) {
  const UnfoldedPole alone = own;
  const Complex s_apparent = std::log(pole.lambda) * config.rate_hz;
  const int reach = static_cast<int>(std::ceil(config.max_frequency_hz / config.rate_hz)) + 1;
  for (int n = -reach; n <= reach; ++n) {
    if (n == *neighbour.fold_n || std::abs(alone.apparent_hz + n * config.rate_hz) > config.max_frequency_hz) continue;
    const Complex s = s_apparent + Complex(0.0, kTwoPi * n * config.rate_hz);
    auto found = NeighbourLeakage::fit(shape, neighbour_shape, s, config);
    if (!found) continue;
    UnfoldedPole cleaned = unfold(pole.lambda, found->without(shape), config);
    if (cleaned.fold_n != n) continue;
    cleaned.mpc = without_fitted(cleaned.mpc, shape.size());
    if (alone.fold_n != n) cleaned.fold_margin = std::min(*cleaned.fold_margin, cleaned.mpc - alone.mpc);
    if (!(cleaned.mpc > own.mpc)) continue;
    own = std::move(cleaned), leak = std::move(found);
  }
}

}  // namespace

UnfoldedOrder unfold_order(const std::vector<DiscretePole>& poles, const std::vector<Shape>& shape,
                           const FoldingConfig& config) {
  UnfoldedOrder out;
  out.leaks.resize(poles.size());
  for (std::size_t i = 0; i < poles.size(); ++i) out.poles.push_back(unfold(poles[i].lambda, shape[i], config));
  if (folding_observable(config) && config.max_frequency_hz > config.rate_hz / 2.0) {
    const std::vector<UnfoldedPole> alone = out.poles;
    for (std::size_t i = 0; i < poles.size(); ++i) {
      const auto m = neighbour_of(i, alone);
      if (m && shape[i].size() >= kLeastComponents)
        unfold_beside(poles[i], shape[i], alone[*m], shape[*m], config, out.poles[i], out.leaks[i]);
    }
  }
  for (std::size_t i = 0; i < poles.size(); ++i) out.poles[i].emac = poles[i].emac;
  return out;
}

}  // namespace core
