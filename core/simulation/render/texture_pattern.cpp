#include "core/simulation/render/texture_pattern.h"

#include <algorithm>
#include <cmath>

#include "core/simulation/random_stream.h"

namespace core::simulation {
namespace {

double fraction(double x) noexcept { return x - std::floor(x); }

// A fixed number in [0, 1) of a place.
double drawn(std::uint64_t seed, double i, double j) noexcept {
  const auto key = static_cast<std::uint64_t>(static_cast<std::int64_t>(i)) * 0x9E3779B97F4A7C15ULL +
                   static_cast<std::uint64_t>(static_cast<std::int64_t>(j));
  return static_cast<double>(mix64(mix64(key) ^ seed) >> 11U) * 0x1p-53;
}

// A window: shares of the wall's field from its middle, and of the storey from its top.
constexpr double kHalfWindow = 0.31, kWindowTop = 0.16, kWindowBottom = 0.72, kFrame = 0.035;

// Glass that mirrors the sky: brighter towards its top; some behind a blind.
double glass(double down, double draw) noexcept {
  const double mirrored = 35.0 * (1.0 - down) * draw;
  const double blind = draw < 0.3 ? 0.2 + 1.5 * draw : 0.0;
  return down < blind ? 20.0 : -85.0 + mirrored;
}

PatternPoint window(double from_middle, double v, double draw) noexcept {
  const double side = kHalfWindow - std::abs(from_middle), top = v - kWindowTop, bottom = kWindowBottom - v;
  if (std::min({side, top, bottom}) < kFrame || std::abs(from_middle) < 0.5 * kFrame) return {55.0, 0.4};
  return {glass(top / (kWindowBottom - kWindowTop), draw), 0.5};
}

// The house of the town that stands at x, in half views: its height above the horizon and how dark it is.
struct House {
  double height, grey;
};
constexpr double kHouseWidth = 0.17, kHorizon = 0.3;
House house_at(std::uint64_t seed, double column) noexcept {
  return {0.06 + 0.42 * drawn(seed, column, 1.0) * drawn(seed, column, 2.0), -25.0 - 40.0 * drawn(seed, column, 3.0)};
}

PatternPoint town(std::uint64_t seed, double x, double up, double column, const House& house) noexcept {
  constexpr double kField = 0.042;
  const double u = fraction(x / kField), v = fraction(up / kField);
  const bool is_window = u > 0.3 && u < 0.75 && v > 0.3 && v < 0.75 && up + kField < house.height;
  const double lit = drawn(seed + 1, std::floor(x / kField), std::floor(up / kField) + 100.0 * column);
  return {house.grey + (is_window ? (lit < 0.3 ? 55.0 : -30.0) : 0.0), 0.6};
}

PatternPoint ground(double x, double below) noexcept {
  constexpr double kRoadFrom = 0.2, kRoadTo = 0.42, kLineWidth = 0.012;
  if (below < kRoadFrom || below > kRoadTo) return {-45.0 + 30.0 * below, 1.5};
  const bool is_line = std::abs(below - 0.5 * (kRoadFrom + kRoadTo)) < kLineWidth && fraction(x / 0.2) < 0.5;
  return {is_line ? 75.0 : -60.0, 0.7};
}

}  // namespace

TexturePattern facade_pattern(double width_mm, double height_mm, std::uint64_t seed, std::uint64_t storey) {
  const double n_fields = std::max(1.0, std::round(width_mm / (0.55 * height_mm)));
  return [=](double x_mm, double y_mm) -> PatternPoint {
    const double field = (x_mm / width_mm + 0.5) * n_fields, v = y_mm / height_mm + 0.5;
    const double from_middle = fraction(field) - 0.5;
    if (v > 0.9) return {30.0, 1.0};
    if (v < 0.03) return {-45.0, 1.0};
    const bool is_window = std::abs(from_middle) < kHalfWindow && v > kWindowTop && v < kWindowBottom;
    if (is_window) return window(from_middle, v, drawn(seed, std::floor(field), static_cast<double>(storey)));
    const bool is_sill = std::abs(from_middle) < kHalfWindow + 0.04 && v >= kWindowBottom && v < kWindowBottom + 0.04;
    return {is_sill ? 35.0 : 0.0, 1.0};
  };
}

TexturePattern landscape_pattern(double half_view_mm, std::uint64_t seed) {
  return [=](double x_mm, double y_mm) -> PatternPoint {
    const double x = x_mm / half_view_mm, up = kHorizon - y_mm / half_view_mm;
    if (up < 0.0) return ground(x, -up);
    const double column = std::floor(x / kHouseWidth);
    const House house = house_at(seed, column);
    if (up < house.height) return town(seed, x, up, column, house);
    return {85.0 - 35.0 * std::min(up, 1.3), 0.35};
  };
}

}  // namespace core::simulation
