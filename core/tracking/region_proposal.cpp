#include "core/tracking/region_proposal.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/tracking/motion_axis.h"
#include "core/tracking/moving_parts.h"
#include "core/tracking/rest_rectangle.h"

namespace core {
namespace {

using Members = std::vector<std::size_t>;

struct Survey {
  const std::vector<SurveyedPoint>& points;
  const std::vector<std::vector<Vector2>>& motion;
  const RegionProposalConfig& config;
  double longest_px;
  std::size_t slow_frames;
};

Box box_of(const Survey& survey, const Members& members) {
  Box box{std::numeric_limits<double>::max(), std::numeric_limits<double>::max(), 0.0, 0.0};
  for (const std::size_t i : members) {
    const Vector2& at = survey.points[i].at;
    box = {std::min(box.left, at.u), std::min(box.top, at.v), std::max(box.right, at.u), std::max(box.bottom, at.v)};
  }
  return box;
}

std::vector<Vector2> mean_motion(const Survey& survey, const Members& members) {
  std::vector<Vector2> mean(survey.motion.front().size());
  const double share = 1.0 / static_cast<double>(members.size());
  for (const std::size_t i : members) {
    for (std::size_t t = 0; t < mean.size(); ++t) {
      mean[t].u += share * survey.motion[i][t].u;
      mean[t].v += share * survey.motion[i][t].v;
    }
  }
  return mean;
}

// Standard deviation per axis of the mean of the members.
double mean_noise_px(const Survey& survey, const Members& members) {
  double sum = 0.0;
  for (const std::size_t i : members) {
    const double sigma = std::max(survey.points[i].sigma_px, survey.config.groups.least_sigma_px);
    sum += sigma * sigma;
  }
  return std::sqrt(sum) / static_cast<double>(members.size());
}

// Divides a part that bends or is long across its longer side, until each piece moves as one.
void divide(const Survey& survey, const Members& members, std::vector<Members>& out) {
  const Box box = box_of(survey, members);
  const bool is_wide = box.width() >= box.height();
  const double middle = is_wide ? 0.5 * (box.left + box.right) : 0.5 * (box.top + box.bottom);
  Members low, high;
  for (const std::size_t i : members)
    ((is_wide ? survey.points[i].at.u : survey.points[i].at.v) < middle ? low : high).push_back(i);
  const bool can = std::min(low.size(), high.size()) >= survey.config.min_points &&
                   std::max(box.width(), box.height()) >= 2.0 * survey.config.min_side_px;
  if (can) {
    const auto a = mean_motion(survey, low), b = mean_motion(survey, high);
    std::vector<Vector2> difference(a.size());
    for (std::size_t t = 0; t < a.size(); ++t) difference[t] = {a[t].u - b[t].u, a[t].v - b[t].v};
    const double noise = std::numbers::sqrt2 * std::hypot(mean_noise_px(survey, low), mean_noise_px(survey, high));
    const double bends = rms_motion(difference);
    const bool moves_apart = bends > 4.0 * noise && bends > survey.config.groups.same_share * rms_motion(a);
    if (moves_apart || std::max(box.width(), box.height()) > survey.longest_px) {
      divide(survey, low, out);
      divide(survey, high, out);
      return;
    }
  }
  out.push_back(members);
}

Region region_of(const Box& box) {
  Region region;
  region.u_px = std::floor(box.left);
  region.v_px = std::floor(box.top);
  region.width_px = std::ceil(box.right) - region.u_px;
  region.height_px = std::ceil(box.bottom) - region.v_px;
  return region;
}

// Shrinks the box until at most a twentieth of its points are not members: each time at the side that costs fewest
// members.
Box without_strangers(const Survey& survey, const Members& members, const std::vector<bool>& is_own) {
  Box box = box_of(survey, members);
  constexpr double kStep_px = 2.0;
  const auto count = [&](const Box& b, bool own) {
    return static_cast<double>(std::count_if(survey.points.begin(), survey.points.end(), [&](const SurveyedPoint& p) {
      return b.holds(p.at) && is_own[static_cast<std::size_t>(&p - survey.points.data())] == own;
    }));
  };
  while (count(box, false) > 0.05 * count(box, true) && box.width() > kStep_px && box.height() > kStep_px) {
    Box best = box;
    double best_score = -std::numeric_limits<double>::max();
    for (int side = 0; side < 4; ++side) {
      Box smaller = box;
      (side == 0   ? smaller.left
       : side == 1 ? smaller.top
       : side == 2 ? smaller.right
                   : smaller.bottom) += side < 2 ? kStep_px : -kStep_px;
      const double score =
          (count(box, false) - count(smaller, false)) - 0.5 * (count(box, true) - count(smaller, true));
      if (score > best_score) best_score = score, best = smaller;
    }
    box = best;
  }
  return box;
}

std::optional<ProposedRegion> propose_one(const Survey& survey, const Members& members) {
  std::vector<bool> is_own(survey.points.size(), false);
  for (const std::size_t i : members) is_own[i] = true;
  const Box box = without_strangers(survey, members, is_own);
  Members inside;
  for (const std::size_t i : members) {
    if (box.holds(survey.points[i].at)) inside.push_back(i);
  }
  if (inside.size() < survey.config.min_points) return std::nullopt;
  const auto motion = mean_motion(survey, inside);
  ProposedRegion out;
  out.region = region_of(box);
  out.region.axis_deg = vibration_axis_deg(motion, survey.slow_frames);
  out.n_points = inside.size();
  out.motion_px = rms_motion(motion);
  out.noise_px = mean_noise_px(survey, inside);
  const bool is_large = std::min(out.region.width_px, out.region.height_px) >= survey.config.min_side_px;
  return is_large ? std::optional(out) : std::nullopt;
}

bool overlap(const Region& a, const Region& b) {
  return a.u_px < b.u_px + b.width_px && b.u_px < a.u_px + a.width_px && a.v_px < b.v_px + b.height_px &&
         b.v_px < a.v_px + a.height_px;
}

void name_regions(std::vector<ProposedRegion>& regions) {
  std::vector<ProposedRegion*> order;
  for (ProposedRegion& one : regions) order.push_back(&one);
  const bool upright = is_upright(regions);
  std::sort(order.begin(), order.end(), [&](const ProposedRegion* a, const ProposedRegion* b) {
    return upright ? a->region.v_px > b->region.v_px : a->region.u_px < b->region.u_px;
  });
  for (std::size_t i = 0; i < order.size(); ++i) order[i]->region.name = "part" + std::to_string(i + 1);
}

// Selects regions one by one without overlap, by shared motion, ratio of motion to noise, and dissimilarity to those
// already selected.
std::vector<ProposedRegion> chosen(std::vector<MovingPart> all, std::size_t max_regions) {
  rate_parts(all);
  std::stable_sort(all.begin(), all.end(),
                   [](const MovingPart& a, const MovingPart& b) { return a.proposed.noise_px < b.proposed.noise_px; });
  std::vector<double> novelty(all.size(), 1.0);
  std::vector<bool> is_open(all.size(), true);
  std::vector<ProposedRegion> out;
  while (out.size() < max_regions) {
    std::size_t best = all.size();
    double best_score = 0.0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double score = all[i].merit * novelty[i];
      if (is_open[i] && score > best_score) best = i, best_score = score;
    }
    if (best == all.size()) break;
    out.push_back(all[best].proposed);
    for (std::size_t i = 0; i < all.size(); ++i) {
      is_open[i] = is_open[i] && !overlap(all[i].proposed.region, out.back().region);
      novelty[i] = std::min(novelty[i], unlike(all[i], all[best]));
    }
  }
  return out;
}

std::optional<ProposedRegion> propose_rest(const Survey& survey, const MotionGroups& groups,
                                           const std::vector<ProposedRegion>& taken, int width_px, int height_px) {
  std::vector<bool> rests(survey.points.size(), false);
  for (const MotionGroup& group : groups.groups) {
    for (const std::size_t i : group.members) rests[i] = rests[i] || group.is_at_rest;
  }
  std::vector<Region> forbidden;
  for (const ProposedRegion& one : taken) forbidden.push_back(one.region);
  const auto box = rest_rectangle(survey.points, rests, forbidden, width_px, height_px);
  if (!box) return std::nullopt;
  Members inside;
  for (std::size_t i = 0; i < survey.points.size(); ++i) {
    if (rests[i] && box->holds(survey.points[i].at)) inside.push_back(i);
  }
  if (inside.size() < survey.config.min_points) return std::nullopt;
  ProposedRegion out;
  out.region = region_of(*box);
  out.region.name = "rest";
  out.region.role = RegionRole::kBackground;
  out.n_points = inside.size();
  out.motion_px = rms_motion(mean_motion(survey, inside));
  out.noise_px = mean_noise_px(survey, inside);
  return out;
}

std::string remark_on(const RegionProposal& proposal, const MotionGroups& groups) {
  if (proposal.n_points == 0)
    return "no corner could be tracked through the frames: too dark, blurred, or moving too fast";
  if (proposal.regions.empty() && groups.has_rest)
    return "nothing moves: the motion is below the resolution of the tracker in these frames; use a "
           "part of the clip in which the structure moves";
  if (proposal.regions.empty())
    return "no group of points moves together: too little texture, or too few points in view";
  if (!groups.has_rest)
    return "no static region is in view: parts are distinguished by their own motion alone, which "
           "includes the camera's";
  return {};
}

}  // namespace

bool is_upright(const std::vector<ProposedRegion>& regions) {
  double u_low = std::numeric_limits<double>::max(), v_low = u_low, u_high = 0.0, v_high = 0.0;
  for (const ProposedRegion& one : regions) {
    const double u = one.region.u_px + 0.5 * one.region.width_px, v = one.region.v_px + 0.5 * one.region.height_px;
    u_low = std::min(u_low, u), u_high = std::max(u_high, u);
    v_low = std::min(v_low, v), v_high = std::max(v_high, v);
  }
  return v_high - v_low > u_high - u_low;
}

RegionProposal propose_regions(const std::vector<SurveyedPoint>& points, double rate_hz, int width_px, int height_px,
                               const RegionProposalConfig& config) {
  RegionProposal out;
  out.n_points = points.size();
  const MotionGroups groups = group_by_motion(points, rate_hz, width_px, height_px, config.groups);
  const Survey survey{points, groups.fast_motion, config,
                      config.longest_share * static_cast<double>(std::max(width_px, height_px)),
                      static_cast<std::size_t>(std::max(1.0, config.groups.slow_s * rate_hz))};
  std::vector<MovingPart> all;
  for (const MotionGroup& group : groups.groups) {
    if (group.is_at_rest || group.members.size() < config.min_points) continue;
    for (const std::size_t i : group.members) out.lowest_moving_v_px = std::max(out.lowest_moving_v_px, points[i].at.v);
    std::vector<Members> pieces;
    divide(survey, group.members, pieces);
    for (const Members& piece : pieces) {
      const auto one = propose_one(survey, piece);
      if (one && one->motion_px > config.least_motion * std::numbers::sqrt2 * one->noise_px)
        all.push_back({*one, mean_motion(survey, piece), 0.0});
    }
  }
  out.regions = chosen(std::move(all), config.max_regions);
  name_regions(out.regions);
  if (groups.has_rest) out.rest = propose_rest(survey, groups, out.regions, width_px, height_px);
  out.remark = remark_on(out, groups);
  return out;
}

}  // namespace core
