#include "core/tracking/klt/phase_builder.h"

#include <algorithm>
#include <cmath>

#include "core/linear/vector_clones.h"
#include "core/tracking/klt/phase_noise.h"
#include "core/tracking/klt/surface_fit.h"

namespace core {

namespace {

constexpr std::array<NoiseOfPhase, kPhasesPerPixel> kNoise{noise_of_phase(0), noise_of_phase(kShiftsPerPhase),
                                                           noise_of_phase(2 * kShiftsPerPhase)};
const NoiseOfPhase& noise_at(int sixths) { return kNoise[static_cast<std::size_t>(sixths / kShiftsPerPhase)]; }

// Sums over a window of factors times grey values of 8 bits fit in 32 bits.
constexpr double kMostFactor = 2.1e9 / (255.0 * kSide * kSide);

constexpr double kLeastSlope = 0.3;  // of a step over a displacement

// Displacements of the nodes, their weights and the fit of values that depend on them.
constexpr std::size_t kAllNodes = std::size_t{kNodes} * kNodes;
using NodeValues = std::array<double, kAllNodes>;
struct NodePlaces {
  NodeValues u{}, v{}, weight{};  // px
};
constexpr NodePlaces node_places() {
  constexpr double kEdgeWeight = 0.25;  // places lie within half of the outermost nodes' distance
  NodePlaces out;
  for (int j = 0, p = 0; j < kNodes; ++j) {
    for (int i = 0; i < kNodes; ++i, ++p) {
      const auto k = static_cast<std::size_t>(p);
      out.u[k] = static_cast<double>(i - kReach) / kShiftsPerPixel;
      out.v[k] = static_cast<double>(j - kReach) / kShiftsPerPixel;
      out.weight[k] = (i == 0 || i + 1 == kNodes ? kEdgeWeight : 1.0) * (j == 0 || j + 1 == kNodes ? kEdgeWeight : 1.0);
    }
  }
  return out;
}
constexpr NodePlaces kPlaces = node_places();
using NodeFit = SurfaceFit<4, kAllNodes>;
constexpr NodeFit fit_over_places() {
  NodeValues u = kPlaces.u, v = kPlaces.v;
  for (std::size_t p = 0; p < kAllNodes; ++p) u[p] *= kPlaceScale, v[p] *= kPlaceScale;
  return {u, v, kPlaces.weight};
}
constexpr NodeFit kOverPlaces = fit_over_places();

// Derivative per pixel at the middle one of five values, from its neighbours and theirs.
constexpr double kOfOne = 8.0 * kShiftsPerPixel / 12.0, kOfTwo = -1.0 * kShiftsPerPixel / 12.0;
double derivative(const std::array<double, kNodes>& f) { return kOfOne * (f[3] - f[1]) + kOfTwo * (f[4] - f[0]); }

// Mean of 1 / slope^2 of a step over the places that are nearest to a phase: beside it a step is shorter than the
// displacement.
double spread_by_slope(const std::array<double, kNodes>& f) {
  constexpr double kUnit = kShiftsPerPixel / 12.0;
  const double above = kUnit * (-f[0] + 6.0 * f[1] - 18.0 * f[2] + 10.0 * f[3] + 3.0 * f[4]);
  const double below = kUnit * (-3.0 * f[0] - 10.0 * f[1] + 18.0 * f[2] - 6.0 * f[3] + f[4]);
  const double middle = derivative(f);
  double sum = 0.0;
  for (const double slope : {middle, middle, above, below}) {
    const double relative = std::max(kLeastSlope, slope);
    sum += 0.25 / (relative * relative);
  }
  return sum;
}

template <class Function>
void for_window(int radius, const Function& function) {
  const auto n = static_cast<std::size_t>(side_of(radius));
  for (std::size_t y = 0; y < n; ++y)
    for (std::size_t x = 0; x < n; ++x) function(y * kRow + x, static_cast<int>(x), static_cast<int>(y));
}

void subtract_mean(FloatWindow& window, int radius, double n_pixels) {
  const auto mean = static_cast<float>(sum_over(window) / n_pixels);
  for_window(radius, [&](std::size_t i, int, int) { window[i] -= mean; });
}

using FloatTaps = std::array<float, 2 * kGradientRadius + 1>;
constexpr FloatTaps to_float(const GradientTaps& taps) {
  FloatTaps out{};
  for (std::size_t k = 0; k < taps.size(); ++k) out[k] = static_cast<float>(taps[k]);
  return out;
}
constexpr FloatTaps kSmooth = to_float(gaussian()), kSlope = to_float(gaussian_slope());

// A wide window filtered along its rows, then across them; kRow columns and kSide rows.
HOVERMODAL_VECTOR_CLONES
void filter(const float* __restrict in, const float* __restrict along, const float* __restrict across,
            float* __restrict out) {
  using Row = std::array<float, kRow>;
  constexpr std::size_t kTaps = 2 * kGradientRadius + 1;
  std::array<Row, kWide> rows{};
  for (std::size_t y = 0; y < kWide; ++y, in += kWideRow) {
    Row sum{};
    for (std::size_t k = 0; k < kTaps; ++k)
      for (std::size_t x = 0; x < kSide; ++x) sum[x] += along[k] * in[x + k];
    rows[y] = sum;
  }
  for (std::size_t y = 0; y < kSide; ++y, out += kRow) {
    Row sum{};
    for (std::size_t k = 0; k < kTaps; ++k)
      for (std::size_t x = 0; x < kRow; ++x) sum[x] += across[k] * rows[y + k][x];
    for (std::size_t x = 0; x < kRow; ++x) out[x] = sum[x];
  }
}

double round_factors(const FloatWindow& from, double scale, Phase::Factors& out) {
  round_scaled(from, static_cast<float>(scale), out);
  std::int32_t sum = 0;
  for (const std::int16_t factor : out) sum += factor;
  return sum;
}

}  // namespace

bool PhaseBuilder::begin(const WideWindow& window, int radius, int phase_u, int phase_v) noexcept {
  radius_ = radius, phase_u_ = phase_u, phase_v_ = phase_v;
  const double side = side_of(radius);
  n_pixels_ = side * side;
  for (FloatWindow* cleared : {&texture_, &smooth_u_, &smooth_v_, &slope_u_, &slope_v_}) cleared->fill(0.0F);
  const auto margin = static_cast<std::size_t>(kWindowRadius - radius);
  FloatWindow filtered_u, filtered_v;
  filter(window[0].data(), kSlope.data(), kSmooth.data(), filtered_u.data());
  filter(window[0].data(), kSmooth.data(), kSlope.data(), filtered_v.data());
  // Share of a column or row that the template's window covers.
  const auto covered = [&](int place, int phase) {
    const double after = static_cast<double>(phase) / kShiftsPerPixel;
    return place == 0 ? 1.0 - after : place == 2 * radius + 1 ? after : 1.0;
  };
  for_window(radius, [&](std::size_t i, int x, int y) {
    const auto share = static_cast<float>(covered(x, phase_u) * covered(y, phase_v));
    const auto u = static_cast<std::size_t>(x) + margin, v = static_cast<std::size_t>(y) + margin;
    texture_[i] = window[v + kGradientRadius][u + kGradientRadius];
    smooth_u_[i] = share * filtered_u[v * kRow + u], smooth_v_[i] = share * filtered_v[v * kRow + u];
  });
  subtract_mean(texture_, radius, n_pixels_);
  square_ = product(texture_, texture_);
  if (!(square_ > 0.0)) return false;
  for (FloatWindow* smooth : {&smooth_u_, &smooth_v_}) {  // the light's gain and offset have no part in a step
    subtract_mean(*smooth, radius, n_pixels_);
    add_scaled(static_cast<float>(-product(*smooth, texture_) / square_), texture_, *smooth);
  }
  return true;
}

void PhaseBuilder::add(int node_u, int node_v, const FloatWindow& window) noexcept {
  const WindowProducts with = products(window, smooth_u_, smooth_v_, texture_);
  nodes_[at(node_u, node_v)] = {with.a, with.b, with.c, with.square - with.sum * with.sum / n_pixels_};
  const auto learn = [&](int node, FloatWindow& slope) {
    if (node == 0) return;
    const double factor = std::abs(node) == 1 ? kOfOne : kOfTwo;
    add_scaled(static_cast<float>(node > 0 ? -factor : factor), window, slope);
  };
  if (node_v == 0) learn(node_u, slope_u_);
  if (node_u == 0) learn(node_v, slope_v_);
}

PhaseBuilder::Response PhaseBuilder::response_of(const Nodes& nodes) noexcept {
  const auto along_u = [&](double Node::*what) {
    return derivative({nodes[at(-2, 0)].*what, nodes[at(-1, 0)].*what, nodes[at(0, 0)].*what, nodes[at(1, 0)].*what,
                       nodes[at(2, 0)].*what});
  };
  const auto along_v = [&](double Node::*what) {
    return derivative({nodes[at(0, -2)].*what, nodes[at(0, -1)].*what, nodes[at(0, 0)].*what, nodes[at(0, 1)].*what,
                       nodes[at(0, 2)].*what});
  };
  return {along_u(&Node::u), along_v(&Node::u), along_u(&Node::v), along_v(&Node::v)};
}

// The template's noise moves with it, the image's does not.
PhaseBuilder::Nodes PhaseBuilder::without_noise(double own) const noexcept {
  const NoiseOfPhase &u = noise_at(phase_u_), &v = noise_at(phase_v_);
  const double n = 2.0 * radius_ + 1.0, of_all = own * n_pixels_ / (n * n);
  Nodes nodes = nodes_;
  for (std::size_t j = 0, p = 0; j < kNodes; ++j) {
    for (std::size_t i = 0; i < kNodes; ++i, ++p) {
      nodes[p].u -= own * u.slope[i] * v.smooth[j];
      nodes[p].v -= own * u.smooth[i] * v.slope[j];
      nodes[p].same -= of_all * u.same[i] * v.same[j];
      nodes[p].square -= of_all * u.square[i] * v.square[j];
    }
  }
  return nodes;
}

bool PhaseBuilder::finish(double own, Phase& out) const noexcept {
  const Nodes nodes = without_noise(own);
  const Response r = response_of(nodes);
  const double determinant = r.uu * r.vv - r.uv * r.vu;
  if (!(determinant > 0.0)) return false;
  const double uu = r.vv / determinant, uv = -r.uv / determinant, vu = -r.vu / determinant, vv = r.uu / determinant;

  NodeValues step_u{}, step_v{}, same{}, aside{};
  const double middle = nodes[at(0, 0)].same;
  for (std::size_t p = 0; p < kAll; ++p) {
    step_u[p] = kPlaceScale * (uu * nodes[p].u + uv * nodes[p].v);
    step_v[p] = kPlaceScale * (vu * nodes[p].u + vv * nodes[p].v);
    same[p] = nodes[p].same;
    aside[p] = nodes[p].square - nodes[p].same * nodes[p].same / middle;
  }
  const NodeFit over_steps(step_u, step_v, kPlaces.weight);
  if (!over_steps.is_determined()) return false;
  out.place_u = over_steps.to(kPlaces.u), out.place_v = over_steps.to(kPlaces.v);
  out.similarity = kOverPlaces.to(same), out.aside = kOverPlaces.to(aside);
  out.square = square_;
  const NoiseOfPhase &noise_u = noise_at(phase_u_), &noise_v = noise_at(phase_v_);
  out.passed_noise = noise_u.square[kReach] * noise_v.square[kReach];

  FloatWindow factors_u, factors_v;
  combine(static_cast<float>(uu), smooth_u_, static_cast<float>(uv), smooth_v_, factors_u);
  combine(static_cast<float>(vu), smooth_u_, static_cast<float>(vv), smooth_v_, factors_v);
  keep_factors(factors_u, factors_v, out);
  std::array<double, kNodes> along_u{}, along_v{};
  for (std::size_t k = 0; k < kNodes; ++k) {
    const int node = static_cast<int>(k) - kReach;
    along_u[k] = step_u[at(node, 0)] / kPlaceScale, along_v[k] = step_v[at(0, node)] / kPlaceScale;
  }
  out.variance_u = product(factors_u, factors_u) * spread_by_slope(along_u);
  out.variance_v = product(factors_v, factors_v) * spread_by_slope(along_v);
  constexpr double kPixel = 1.0 / kShiftsPerPixel;
  keep_pull(factors_u, factors_v, {kPixel * phase_u_, kPixel * phase_v_}, out);
  return true;
}

void PhaseBuilder::keep_factors(const FloatWindow& step_u, const FloatWindow& step_v, Phase& out) const noexcept {
  const double scale = kMostFactor / std::max(largest(step_u), largest(step_v));
  out.px_per_unit = 1.0 / scale;
  out.sum_step_u = round_factors(step_u, scale, out.step_u);
  out.sum_step_v = round_factors(step_v, scale, out.step_v);
  const double texture_scale = kMostFactor / largest(texture_);
  out.grey_per_unit = 1.0 / texture_scale;
  out.sum_texture = round_factors(texture_, texture_scale, out.texture);
}

// Slopes times column and row: decrease of a window's grey values per unit of each element of a deformation about the
// window's first pixel.
std::array<FloatWindow, 4> PhaseBuilder::changes() const noexcept {
  std::array<FloatWindow, 4> out{};
  times_column(slope_u_, out[0]), times_row(slope_u_, out[1]);
  times_column(slope_v_, out[2]), times_row(slope_v_, out[3]);
  return out;
}

// Of a window whose point lies at the phase.
void PhaseBuilder::keep_pull(const FloatWindow& step_u, const FloatWindow& step_v, const Vector2& phase,
                             Phase& out) const noexcept {
  const std::array<FloatWindow, 4> all = changes();
  for (std::size_t k = 0; k < all.size(); ++k) {
    const FloatWindow& slope = k < 2 ? slope_u_ : slope_v_;
    const double from = radius_ + (k % 2 == 0 ? phase.u : phase.v);
    out.pull[k] = {from * product(step_u, slope) - product(step_u, all[k]),
                   from * product(step_v, slope) - product(step_v, all[k])};
  }
}

DeformationEnergy PhaseBuilder::deformation_energy() const noexcept {
  FloatWindow ones;
  ones.fill(0.0F);
  for_window(radius_, [&](std::size_t i, int, int) { ones[i] = 1.0F; });
  std::array<FloatWindow, 4> all = changes();
  for (std::size_t k = 0; k < all.size(); ++k)
    add_scaled(static_cast<float>(-radius_), k < 2 ? slope_u_ : slope_v_, all[k]);
  const std::array<const FloatWindow*, 8> columns{&ones,   &texture_, &slope_u_, &slope_v_,
                                                  &all[0], &all[1],   &all[2],   &all[3]};
  std::array<std::array<double, 8>, 8> gram{};
  for (std::size_t k = 0; k < columns.size(); ++k)
    for (std::size_t l = k; l < columns.size(); ++l) gram[k][l] = product(*columns[k], *columns[l]);
  for (std::size_t pivot = 0; pivot < 4; ++pivot) {  // eliminates offset, gain, shift
    if (!(gram[pivot][pivot] > 0.0)) continue;
    for (std::size_t k = pivot + 1; k < gram.size(); ++k)
      for (std::size_t l = k; l < gram.size(); ++l) gram[k][l] -= gram[pivot][k] * gram[pivot][l] / gram[pivot][pivot];
  }
  DeformationEnergy out{};
  for (std::size_t k = 0, at = 0; k < 4; ++k)
    for (std::size_t l = k; l < 4; ++l) out[at++] = (k == l ? 1.0 : 2.0) * gram[4 + k][4 + l];
  return out;
}

}  // namespace core
