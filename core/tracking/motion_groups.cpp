#include "core/tracking/motion_groups.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "core/linear/median.h"
#include "core/tracking/similarity.h"

namespace core {
namespace {

// The static group covers at least this share of the picture; no part of a structure is taken to cover so much.
constexpr double kLeastRestShare = 0.12;
constexpr int kCells = 24;  // cells along the picture's longer side, to measure the share that a group covers

using Series = std::vector<Vector2>;

// Removes the moving mean over half a window on either side.
Series without_slow(const Series& motion, std::size_t half) {
  const std::size_t n = motion.size();
  Series sums(n + 1);
  for (std::size_t t = 0; t < n; ++t) sums[t + 1] = {sums[t].u + motion[t].u, sums[t].v + motion[t].v};
  Series out(n);
  for (std::size_t t = 0; t < n; ++t) {
    const std::size_t reach = std::min({half, t, n - 1 - t});  // symmetric at the ends, too
    const auto count = static_cast<double>(2 * reach + 1);
    const Vector2 &low = sums[t - reach], &high = sums[t + reach + 1];
    out[t] = {motion[t].u - (high.u - low.u) / count, motion[t].v - (high.v - low.v) / count};
  }
  return out;
}

double mean_square_difference(const Series& a, const Series& b) {
  double sum = 0.0;
  for (std::size_t t = 0; t < a.size(); ++t) {
    const double du = a[t].u - b[t].u, dv = a[t].v - b[t].v;
    sum += du * du + dv * dv;
  }
  return a.empty() ? 0.0 : sum / static_cast<double>(a.size());
}

// Points sorted by position, to find neighbours.
class Neighbours {
 public:
  Neighbours(const std::vector<SurveyedPoint>& points, double reach_px) : points_(points), reach_px_(reach_px) {
    for (std::size_t i = 0; i < points.size(); ++i) cells_[cell(points[i].at)].push_back(i);
  }
  template <class Visit>
  void visit(std::size_t i, const Visit& see) const {
    const auto [u, v] = cell(points_[i].at);
    for (int dv = -1; dv <= 1; ++dv) {
      for (int du = -1; du <= 1; ++du) {
        const auto found = cells_.find({u + du, v + dv});
        if (found == cells_.end()) continue;
        for (const std::size_t j : found->second) {
          const Vector2 apart{points_[j].at.u - points_[i].at.u, points_[j].at.v - points_[i].at.v};
          if (j > i && length(apart) <= reach_px_) see(j);
        }
      }
    }
  }

 private:
  [[nodiscard]] std::pair<int, int> cell(const Vector2& at) const {
    return {static_cast<int>(at.u / reach_px_), static_cast<int>(at.v / reach_px_)};
  }
  const std::vector<SurveyedPoint>& points_;
  double reach_px_;
  std::map<std::pair<int, int>, std::vector<std::size_t>> cells_;
};

// Variance of a position, both axes together.
double variance_px2(const SurveyedPoint& point, const MotionGroupConfig& config) {
  const double sigma = std::max(point.sigma_px, config.least_sigma_px);
  return 2.0 * sigma * sigma;
}

class Sets {
 public:
  explicit Sets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[find(a)] = find(b); }

 private:
  std::vector<std::size_t> parent_;
};

// Groups points no farther apart than reach_px that move together. share: tolerance relative to their motion; 0 if no
// static group is known.
std::vector<MotionGroup> joined(const std::vector<SurveyedPoint>& points, const std::vector<Series>& fast,
                                const std::vector<bool>& may, double reach_px, double share,
                                const MotionGroupConfig& config) {
  Sets sets(points.size());
  const Neighbours neighbours(points, reach_px);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!may[i]) continue;
    neighbours.visit(i, [&](std::size_t j) {
      if (!may[j] || sets.find(i) == sets.find(j)) return;
      const double noise =
          config.same_noise * config.same_noise * (variance_px2(points[i], config) + variance_px2(points[j], config));
      const double moved = share * std::min(rms_motion(fast[i]), rms_motion(fast[j]));
      if (mean_square_difference(fast[i], fast[j]) <= std::max(noise, moved * moved)) sets.join(i, j);
    });
  }
  std::map<std::size_t, MotionGroup> groups;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (may[i]) groups[sets.find(i)].members.push_back(i);
  }
  std::vector<MotionGroup> out;
  for (auto& [root, group] : groups) {
    if (group.members.size() > 1) out.push_back(std::move(group));
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const MotionGroup& a, const MotionGroup& b) { return a.members.size() > b.members.size(); });
  return out;
}

// Share of the picture's cells in which the group has a point.
double covered_share(const MotionGroup& group, const std::vector<SurveyedPoint>& points, int width_px, int height_px) {
  const double cell_px = static_cast<double>(std::max(width_px, height_px)) / kCells;
  std::map<std::pair<int, int>, int> cells;
  for (const std::size_t i : group.members)
    ++cells[{static_cast<int>(points[i].at.u / cell_px), static_cast<int>(points[i].at.v / cell_px)}];
  const double all = std::ceil(width_px / cell_px) * std::ceil(height_px / cell_px);
  return static_cast<double>(cells.size()) / all;
}

// Removes the similarity given by the group's motion from the motion of all points, frame by frame.
void take_out_camera(const MotionGroup& rest, const std::vector<SurveyedPoint>& points, std::vector<Series>& fast) {
  const std::size_t n_frames = fast.front().size();
  const auto all = [](std::size_t) { return true; };
  for (std::size_t t = 0; t < n_frames; ++t) {
    const auto from = [&](std::size_t k) { return points[rest.members[k]].at; };
    const auto to = [&](std::size_t k) {
      const std::size_t i = rest.members[k];
      return Vector2{points[i].at.u + fast[i][t].u, points[i].at.v + fast[i][t].v};
    };
    const SimilarityMoments m = similarity_moments(0, rest.members.size(), all, from, to);
    const double along = m.spread > 0.0 ? m.along / m.spread : 1.0, across = m.spread > 0.0 ? m.across / m.spread : 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double u = points[i].at.u - m.mean_k.u, v = points[i].at.v - m.mean_k.v;
      fast[i][t].u -= m.mean_p.u + along * u - across * v - points[i].at.u;
      fast[i][t].v -= m.mean_p.v + across * u + along * v - points[i].at.v;
    }
  }
}

// Frees all motion from the camera's, as the group shows it. A structure stands on something: where its motion fades
// out towards what rests, neighbours join it to the group, so members that move are left out, twice. Returns what a
// member moves by then beyond its own noise, px^2, the median: what is left of the camera's motion. Its noise says
// nothing about points of better texture.
double free_from_camera(MotionGroup rest, const std::vector<SurveyedPoint>& points, std::vector<Series>& fast,
                        const MotionGroupConfig& config) {
  constexpr int kRounds = 3;
  double left_px2 = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    take_out_camera(rest, points, fast);
    std::vector<double> moved, beyond_noise;
    for (const std::size_t i : rest.members) {
      moved.push_back(rms_motion(fast[i]));
      beyond_noise.push_back(moved.back() * moved.back() - variance_px2(points[i], config));
    }
    const double still = median(moved);
    left_px2 = std::max(0.0, median(beyond_noise));
    std::vector<std::size_t> kept;
    for (const std::size_t i : rest.members) {
      if (rms_motion(fast[i]) <= 2.5 * still) kept.push_back(i);
    }
    rest.members = std::move(kept);
  }
  return left_px2;
}

}  // namespace

double rms_motion(const std::vector<Vector2>& motion) {
  double sum = 0.0;
  for (const Vector2& step : motion) sum += step.u * step.u + step.v * step.v;
  return motion.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(motion.size()));
}

MotionGroups group_by_motion(const std::vector<SurveyedPoint>& points, double rate_hz, int width_px, int height_px,
                             const MotionGroupConfig& config) {
  MotionGroups out;
  if (points.empty()) return out;
  const auto half = static_cast<std::size_t>(std::max(2.0, std::round(0.5 * config.slow_s * rate_hz)));
  for (const SurveyedPoint& point : points) out.fast_motion.push_back(without_slow(point.motion, half));
  std::vector<bool> may(points.size(), true);
  // With noise as the only tolerance, moving parts split into pieces; static points stay together.
  const double rest_px = std::max(config.neighbour_px, config.rest_reach * std::max(width_px, height_px));
  out.groups = joined(points, out.fast_motion, may, rest_px, 0.0, config);
  const auto covers_more = [&](const MotionGroup& a, const MotionGroup& b) {
    return covered_share(a, points, width_px, height_px) < covered_share(b, points, width_px, height_px);
  };
  const auto widest = std::max_element(out.groups.begin(), out.groups.end(), covers_more);
  out.has_rest = widest != out.groups.end() && covered_share(*widest, points, width_px, height_px) >= kLeastRestShare;
  if (!out.has_rest) {
    // Parts lie closer together than static texture may.
    out.groups = joined(points, out.fast_motion, may, config.neighbour_px, 0.0, config);
    return out;
  }
  const double left_px2 = free_from_camera(*widest, points, out.fast_motion, config);
  MotionGroup rest;
  rest.is_at_rest = true;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double moved = rms_motion(out.fast_motion[i]);
    may[i] = moved > config.moves_by * std::sqrt(left_px2 + variance_px2(points[i], config));
    if (!may[i]) rest.members.push_back(i);
  }
  out.groups = joined(points, out.fast_motion, may, config.neighbour_px, config.same_share, config);
  out.groups.push_back(std::move(rest));
  return out;
}

}  // namespace core
