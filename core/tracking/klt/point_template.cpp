#include "core/tracking/klt/point_template.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/linear/median.h"
#include "core/tracking/klt/phase_builder.h"
#include "core/tracking/klt/shifted_windows.h"

namespace core {

namespace {

// Largest share of a patch's variance that counts as noise: the rest of what resembles noise is fine texture.
constexpr double kMostNoiseShare = 0.5;

// Smallest eigenvalue of the response (grey^2 per pixel): below, a patch has texture in one direction only.
constexpr double kLeastEigenvalue = 0.05;

// The template's noise takes at most this share of a response: apparent noise may be fine texture.
constexpr double kMostOfResponse = 0.4;
constexpr double kNoiseInResponse = 0.44;  // response of white noise of variance 1 per pixel (phase_noise.h)

std::size_t index(int i) { return static_cast<std::size_t>(i); }
double area(int radius) { return (2.0 * radius + 1.0) * (2.0 * radius + 1.0); }

// Squares over the window of the differences of an order along both axes, per unit of white noise's variance. They
// cancel for smooth texture; the higher the order, the finer the texture that is not taken for noise.
struct Differences {
  std::array<double, std::size_t{kWindow} * kWindow> squares{};
  std::size_t n = 0;
};
template <std::size_t kTaps>
void take_differences(const Patch& patch, int radius, const std::array<float, kTaps>& taps, Differences& out) {
  const std::size_t n = index(2 * radius + 1), first = index(kPatchRadius - radius) - kTaps / 2;
  using Row = std::array<float, kRow>;
  std::array<Row, kWindow + kTaps - 1> rows{};
  for (std::size_t y = 0; y < n + kTaps - 1; ++y) {
    for (std::size_t k = 0; k < kTaps; ++k)
      for (std::size_t x = 0; x < n; ++x) rows[y][x] += taps[k] * patch[first + y][first + x + k];
  }
  double of_taps = 0.0;
  for (const float tap : taps) of_taps += static_cast<double>(tap * tap);
  out.n = 0;
  for (std::size_t y = 0; y < n; ++y) {
    Row line{};
    for (std::size_t k = 0; k < kTaps; ++k)
      for (std::size_t x = 0; x < n; ++x) line[x] += taps[k] * rows[y + k][x];
    for (std::size_t x = 0; x < n; ++x)
      out.squares[out.n++] = static_cast<double>(line[x] * line[x]) / (of_taps * of_taps);
  }
}
constexpr std::array<float, 3> kSecond{1.0, -2.0, 1.0};  // Immerkaer 1996
constexpr std::array<float, 7> kSixth{1.0, -6.0, 15.0, -20.0, 15.0, -6.0, 1.0};

// Variance of white noise, at most: fine texture counts as noise.
double most_noise(const Patch& patch, int radius) {
  Differences differences;
  take_differences(patch, radius, kSecond, differences);
  double sum = 0.0;
  for (std::size_t i = 0; i < differences.n; ++i) sum += differences.squares[i];
  return sum / static_cast<double>(differences.n);
}
// The same by the median: sharp edges, which cover a part of the window, do not count.
double least_noise(const Patch& patch, int radius) {
  constexpr double kMedianOfSquare = 0.4549;  // of a normal deviate
  Differences differences;
  take_differences(patch, radius, kSixth, differences);
  return median_in_place(std::span(differences.squares.data(), differences.n)) / kMedianOfSquare;
}

// Mean, variance and noise of the window.
void describe(const Patch& patch, PointTemplate& out) {
  double mean = 0.0, square = 0.0;
  for (int pass = 0; pass < 2; ++pass) {
    double sum = 0.0;
    for (int y = kPatchRadius - out.radius; y <= kPatchRadius + out.radius; ++y) {
      for (int x = kPatchRadius - out.radius; x <= kPatchRadius + out.radius; ++x) {
        const double value = static_cast<double>(patch[index(y)][index(x)]) - mean;
        sum += pass == 0 ? value : value * value;
      }
    }
    (pass == 0 ? mean : square) = sum / area(out.radius);
  }
  out.mean = mean, out.variance = square;
  if (out.n_averaged == 1) out.noise = std::min(most_noise(patch, out.radius), kMostNoiseShare * out.variance);
}

// White noise of the template in its window, grey^2.
double own_noise(const Patch& patch, const PointTemplate& described, const PhaseBuilder::Response& response) {
  const double noise = std::min(described.noise, least_noise(patch, described.radius));
  const double own = area(described.radius) * noise / described.n_averaged;
  return std::min(own, kMostOfResponse / kNoiseInResponse * std::min(-response.uu, -response.vv));
}

// Texture in two directions, after the noise has been taken off.
bool is_two_dimensional(const PhaseBuilder::Response& response, double own, int radius) {
  const double uu = -response.uu - kNoiseInResponse * own, vv = -response.vv - kNoiseInResponse * own;
  const double trace = uu + vv, determinant = uu * vv - response.uv * response.vu;
  const double least = 0.5 * (trace - std::sqrt(std::max(0.0, trace * trace - 4.0 * determinant)));
  return least > kLeastEigenvalue * area(radius);
}

// One phase about its middle, as far as the response needs it.
bool look_at_middle(const ShiftedWindows& windows, int radius, PhaseBuilder& builder) {
  WideWindow wide;
  windows.wide(0, 0, wide);
  if (!builder.begin(wide, radius, 0, 0)) return false;
  FloatWindow window;
  for (const int d : {-2, -1, 1, 2}) {
    windows.window(d, 0, window);
    builder.add(d, 0, window);
    windows.window(0, d, window);
    builder.add(0, d, window);
  }
  return true;
}

}  // namespace

bool has_texture(const Patch& patch, int radius) noexcept {
  PointTemplate described;
  described.radius = radius;
  describe(patch, described);
  const ShiftedWindows windows(patch, radius, static_cast<float>(described.mean));
  PhaseBuilder builder;
  if (!look_at_middle(windows, radius, builder)) return false;
  const PhaseBuilder::Response response = builder.response();
  return is_two_dimensional(response, own_noise(patch, described, response), radius);
}

void build_template(const Patch& patch, int radius, int n_averaged, PointTemplate& out) noexcept {
  out.n_averaged = n_averaged;
  out.radius = radius;
  out.is_trackable = false;
  describe(patch, out);
  const ShiftedWindows windows(patch, radius, static_cast<float>(out.mean));
  std::array<std::array<PhaseBuilder, kPhasesPerPixel>, kPhasesPerPixel> builders;
  for (int q = 0; q < kPhasesPerPixel; ++q) {
    for (int p = 0; p < kPhasesPerPixel; ++p) {
      WideWindow wide;
      windows.wide(p * kShiftsPerPhase, q * kShiftsPerPhase, wide);
      if (!builders[index(q)][index(p)].begin(wide, radius, p * kShiftsPerPhase, q * kShiftsPerPhase)) return;
    }
  }
  FloatWindow window;
  for (int v = kFirstShift; v <= kLastShift; ++v) {
    for (int u = kFirstShift; u <= kLastShift; ++u) {
      windows.window(u, v, window);
      for (int q = 0; q < kPhasesPerPixel; ++q) {
        const int node_v = v - q * kShiftsPerPhase;
        if (std::abs(node_v) > kReach) continue;
        for (int p = 0; p < kPhasesPerPixel; ++p) {
          const int node_u = u - p * kShiftsPerPhase;
          if (std::abs(node_u) <= kReach) builders[index(q)][index(p)].add(node_u, node_v, window);
        }
      }
    }
  }
  const PhaseBuilder::Response response = builders[0][0].response();
  const double own = own_noise(patch, out, response);
  if (!is_two_dimensional(response, own, radius)) return;
  out.variance_u = 0.0, out.variance_v = 0.0;
  for (int q = 0; q < kPhasesPerPixel; ++q) {
    for (int p = 0; p < kPhasesPerPixel; ++p) {
      Phase& phase = out.phases[index(q)][index(p)];
      if (!builders[index(q)][index(p)].finish(own, phase)) return;
      constexpr double kShare = 1.0 / (kPhasesPerPixel * kPhasesPerPixel);
      out.variance_u += kShare * phase.variance_u, out.variance_v += kShare * phase.variance_v;
    }
  }
  out.deformed = builders[0][0].deformation_energy();
  out.is_trackable = true;
}

}  // namespace core
