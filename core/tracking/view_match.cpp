#include "core/tracking/view_match.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <vector>

#include "core/linear/median.h"

namespace core {

namespace {

using Complex = std::complex<double>;
constexpr double kMostViewMagnification = 0.05, kMostApart_px = 1.0, kLeastShare = 0.5;

Complex place(const TrackPoint& point) { return {point.u_px, point.v_px}; }

// now = turn * keyframe + shift, by least squares over all seen points.
struct Similarity {
  Complex turn{1.0, 0.0}, shift;

  Similarity(const TrackFrame& keyframe, const TrackFrame& now) {
    Complex from, to;
    double n = 0.0;
    for (std::size_t i = 0; i < now.points.size(); ++i) {
      if (now.points[i].seen) from += place(keyframe.points[i]), to += place(now.points[i]), n += 1.0;
    }
    if (n == 0.0) return;
    from /= n, to /= n;
    Complex product;
    double squares = 0.0;
    for (std::size_t i = 0; i < now.points.size(); ++i) {
      if (!now.points[i].seen) continue;
      const Complex k = place(keyframe.points[i]) - from;
      product += (place(now.points[i]) - to) * std::conj(k);
      squares += std::norm(k);
    }
    if (squares > 0.0) turn = product / squares;
    shift = to - turn * from;
  }
};

// Counts the region's points [begin, end) with the same deviation from the similarity, as the structure moves.
std::size_t count_agreeing(const TrackFrame& keyframe, TrackFrame& now, const Similarity& common, std::size_t begin,
                           std::size_t end) {
  const auto off = [&](std::size_t i) {
    return place(now.points[i]) - common.turn * place(keyframe.points[i]) - common.shift;
  };
  std::vector<double> u, v;
  for (std::size_t i = begin; i < end; ++i) {
    if (now.points[i].seen) u.push_back(off(i).real()), v.push_back(off(i).imag());
  }
  if (u.empty()) return 0;
  const Complex middle(median(u), median(v));
  std::size_t n = 0;
  for (std::size_t i = begin; i < end; ++i) {
    now.points[i].inlier = now.points[i].seen && std::abs(off(i) - middle) <= kMostApart_px;
    n += now.points[i].inlier ? 1U : 0U;
  }
  return n;
}

}  // namespace

std::string why_other_view(const TrackFrame& keyframe, TrackFrame& now, int min_points) {
  const Similarity common(keyframe, now);
  char text[160];
  for (std::size_t begin = 0, end = 0; begin < now.points.size(); begin = end) {
    while (end < now.points.size() && now.points[end].region == now.points[begin].region) ++end;
    const std::size_t n_agreeing = count_agreeing(keyframe, now, common, begin, end);
    const double wanted = std::max(static_cast<double>(min_points), kLeastShare * static_cast<double>(end - begin));
    if (static_cast<double>(n_agreeing) >= wanted) continue;
    std::snprintf(text, sizeof text, "only %zu of the %zu points of region %d are found again: another view",
                  n_agreeing, end - begin, static_cast<int>(now.points[begin].region));
    return text;
  }
  if (std::abs(std::abs(common.turn) - 1.0) <= kMostViewMagnification) return {};
  std::snprintf(text, sizeof text, "the view is %.3f times as large", std::abs(common.turn));
  return text;
}

}  // namespace core
