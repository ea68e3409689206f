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
constexpr int kRounds = 3;
constexpr double kLeastFirstMpc = 0.7, kLeastNeighbourMpc = 0.9;  // of a neighbour in the first round, and later

double width_hz(const UnfoldedPole& pole) { return std::abs(damping_ratio(pole.s)) * frequency_hz(pole.s); }

// MPC reduced by the two real parameters fitted to the n - 1 components that can be out of phase.
double without_fitted(double mpc, std::size_t n_components) {
  const double n = static_cast<double>(n_components) - 1.0;
  return 1.0 - (1.0 - mpc) * n / (n - 2.0);
}

}  // namespace

NeighbourLeakage::NeighbourLeakage(Shape neighbour, Complex s, const FoldingConfig& config)
    : neighbour_(std::move(neighbour)), turn_(neighbour_.size(), 1.0) {
  for (std::size_t c = 0; c < turn_.size(); ++c) turn_[c] = as_displacement(1.0, s, c, config);
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

// Square of what is out of phase over that of what is in phase, without the neighbour's part. Does not allocate: it is
// computed for every phase.
double NeighbourLeakage::out_of_phase(const Shape& shape) const {
  const Complex c = coefficient(shape);
  double in_phase = 0.0, out_of_phase = 0.0;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    const Complex z = (shape[i] - c * neighbour_[i]) * turn_[i];
    in_phase += z.real() * z.real(), out_of_phase += z.imag() * z.imag();
  }
  return in_phase > 0.0 ? out_of_phase / in_phase : HUGE_VAL;
}

std::optional<NeighbourLeakage> NeighbourLeakage::fit(const Shape& shape, const Shape& neighbour, Complex s,
                                                      const FoldingConfig& config) {
  NeighbourLeakage out(neighbour, s, config);
  const Complex step = std::polar(1.0, -0.5 * kTwoPi / kPhases);
  Shape best_turn;
  double least = HUGE_VAL;
  for (int k = 0; k < kPhases; ++k) {
    const double ratio = out.out_of_phase(shape);
    if (ratio < least) least = ratio, best_turn = out.turn_;
    for (Complex& turn : out.turn_) turn *= step;
  }
  if (best_turn.empty()) return std::nullopt;
  out.turn_ = std::move(best_turn);
  double whole = 0.0, left = 0.0;
  for (const Complex& z : shape) whole += std::norm(z);
  for (const Complex& z : out.without(shape)) left += std::norm(z);
  return left >= kLeastLeft * whole ? std::optional(std::move(out)) : std::nullopt;
}

namespace {

// The poles of an order while they are freed from each other. Neighbours are taken as far as they are free already.
class Unmixing {
 public:
  Unmixing(const std::vector<DiscretePole>& poles, const std::vector<Shape>& shape, const FoldingConfig& config)
      : observed_(poles), shape_(shape), config_(config), free_shape_(shape), leaks_(poles.size()) {
    for (std::size_t i = 0; i < poles.size(); ++i) alone_.push_back(unfold(poles[i].lambda, shape[i], config));
    poles_ = alone_;
  }

  // In the first round a pole is freed from a neighbour with the better defined shape, later from any.
  void run() {
    if (!folding_observable(config_) || !(config_.max_frequency_hz > config_.rate_hz / 2.0)) return;
    for (int round = 0; round < kRounds; ++round) {
      for (std::size_t i = 0; i < poles_.size(); ++i) {
        if (shape_[i].size() < kLeastComponents) continue;
        const double least = round == 0 ? std::max(kLeastFirstMpc, poles_[i].mpc) : kLeastNeighbourMpc;
        if (const auto m = neighbour_of(i, least)) free_from(i, *m);
      }
    }
  }

  [[nodiscard]] UnfoldedOrder result() && {
    for (std::size_t i = 0; i < poles_.size(); ++i) poles_[i].emac = observed_[i].emac;
    return {std::move(poles_), std::move(leaks_)};
  }

 private:
  [[nodiscard]] std::optional<std::size_t> neighbour_of(std::size_t own, double least_mpc) const {
    std::optional<std::size_t> nearest;
    double least = HUGE_VAL;
    for (std::size_t m = 0; m < poles_.size(); ++m) {
      if (m == own || !poles_[m].fold_n || poles_[m].mpc < least_mpc) continue;
      const double apart = std::abs(poles_[m].apparent_hz - poles_[own].apparent_hz);
      if (apart < least && apart < kReach * (width_hz(poles_[m]) + width_hz(poles_[own]))) least = apart, nearest = m;
    }
    return nearest;
  }

  // Takes the best alias order without what leaks from the neighbour, if that explains more than the whole shape.
  void free_from(std::size_t i, std::size_t m) {
    const UnfoldedPole& alone = alone_[i];
    const Complex s_apparent = std::log(observed_[i].lambda) * config_.rate_hz;
    const int n_neighbour = *poles_[m].fold_n;
    double best = alone.mpc;
    for (const int n : alias_orders(alone.apparent_hz, config_.rate_hz, config_.max_frequency_hz)) {
      if (n == n_neighbour) continue;
      const Complex s = s_apparent + Complex(0.0, kTwoPi * n * config_.rate_hz);
      const auto found = NeighbourLeakage::fit(shape_[i], free_shape_[m], s, config_);
      if (!found) continue;
      const Shape left = found->without(shape_[i]);
      UnfoldedPole pole = unfold(observed_[i].lambda, left, config_);
      if (pole.fold_n != n) continue;
      pole.mpc = without_fitted(pole.mpc, left.size());
      if (alone.fold_n != n) pole.fold_margin = std::min(*pole.fold_margin, pole.mpc - alone.mpc);
      if (!(pole.mpc > best)) continue;
      best = pole.mpc;
      poles_[i] = std::move(pole), leaks_[i] = found, free_shape_[i] = left;
    }
  }

  const std::vector<DiscretePole>& observed_;
  const std::vector<Shape>& shape_;
  const FoldingConfig& config_;
  std::vector<UnfoldedPole> alone_, poles_;
  std::vector<Shape> free_shape_;
  std::vector<std::optional<NeighbourLeakage>> leaks_;
};

}  // namespace

UnfoldedOrder unfold_order(const std::vector<DiscretePole>& poles, const std::vector<Shape>& shape,
                           const FoldingConfig& config) {
  Unmixing unmixing(poles, shape, config);
  unmixing.run();
  return std::move(unmixing).result();
}

}  // namespace core
