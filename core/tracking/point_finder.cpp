#include "core/tracking/point_finder.h"

#include <algorithm>
#include <cmath>

#include "core/linear/median.h"

namespace core {

namespace {

constexpr double kNoticeable_px = 1.0;  // a search with a smaller shift would repeat the predicted one
constexpr double kAgreeing_px = 3.0;    // distance from the median of the region's points
constexpr double kUnusual = 5.0;        // limit in multiples of the usual residual: beyond, a similar edge was found
constexpr double kDisturbed = 1.5;      // the same, relative to the region's other points in this frame
constexpr double kUnmodelled = 0.5;     // share of the deformation's effect that is second order, not modelled
constexpr double kLearning = 0.05;      // learning rate of the usual residual, per frame
constexpr std::size_t kAhead = 4;       // points whose pixels and template are fetched while one is compared
constexpr int kSearchesPerFrame = 3;    // searches of whole regions: about a millisecond each

// Residual not explained by the template, in px: sigma_px without the effect of a lower brightness gain.
double strangeness(const KltPoint& point) noexcept { return point.sigma_px * point.gain; }

KltTracker tracker_at(const KltConfig& config, const GrayView& image, const std::vector<Vector2>& keyframe) {
  KltTracker tracker(config);
  tracker.set_keyframe(image, keyframe);
  return tracker;
}

}  // namespace

PointFinder::PointFinder(const PointFinderConfig& config, const GrayView& image, const std::vector<Vector2>& keyframe,
                         const std::vector<std::uint16_t>& region_of_point, std::size_t n_regions)
    : config_(config),
      klt_(tracker_at(config.klt, image, keyframe)),
      templates_(klt_),
      reseeder_(klt_, keyframe, region_of_point, config.reseed_after, config.min_points),
      deformation_(keyframe, region_of_point, n_regions),
      keyframe_(keyframe) {
  std::size_t first = 0, most = 0;
  for (std::size_t r = 0; r < n_regions; ++r) {
    std::size_t end = first;
    while (end < keyframe.size() && region_of_point[end] == r) ++end;
    const auto begin = keyframe.begin();
    regions_.push_back(
        {first, end - first,
         RegionSearch(image, {begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(end)},
                      config.search_px)});
    most = std::max(most, end - first);
    first = end;
  }
  found_.resize(keyframe.size());
  usual_.resize(keyframe.size());
  best_.resize(most);
  scratch_u_.reserve(most);
  scratch_v_.reserve(most);
}

void PointFinder::find(const GrayView& gray, const RegionFollower& expected) noexcept {
  const std::size_t n = regions_.size(), begin = next_search_;
  Vector2 surprise;  // largest prediction error of the regions found
  for (std::size_t r = 0; r < n; ++r) {
    look(gray, regions_[r], expected, {});
    const Look first = judge(regions_[r]);
    if (!is_good(regions_[r], first)) continue;
    look_for_rest(gray, regions_[r], first);
    const Vector2 motion = expected.expected_motion(r), off{first.motion.u - motion.u, first.motion.v - motion.v};
    if (length(off) > length(surprise)) surprise = off;
  }
  int n_searches = kSearchesPerFrame;
  Vector2 other_motion;  // of the region found last
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t r = (begin + k) % n;
    const Region& region = regions_[r];
    Look best = judge(region);
    if (region.n == 0 || is_good(region, best)) continue;
    const Vector2 motion = expected.expected_motion(r);
    const auto to = [&](const Vector2& where) { return Vector2{where.u - motion.u, where.v - motion.v}; };
    bool is_found = false;
    for (const Vector2& shift : {surprise, to(expected.last_motion(r)), to(other_motion)})
      is_found = is_found || improves(gray, region, expected, shift, best);
    if (!is_found && n_searches > 0) {
      --n_searches;
      next_search_ = r + 1;
      const RegionSearch::Found place = regions_[r].search.find(gray, motion);
      is_found = place.is_clear && improves(gray, region, expected, to(place.motion), best);
    }
    if (!is_found) continue;
    look_for_rest(gray, region, best);
    surprise = to(best.motion), other_motion = best.motion;
  }
  correct_for_deformation();
  for (const Region& region : regions_) leave_out_disturbed(region);
  const int renewed = reseeder_.judge(gray, found_, klt_, templates_);
  if (renewed >= 0) usual_[static_cast<std::size_t>(renewed)] = 0.0;
  templates_.add(gray, found_, klt_);
}

void PointFinder::correct_for_deformation() noexcept {
  deformation_.update(found_);
  for (std::size_t r = 0; r < regions_.size(); ++r)
    for (std::size_t i = regions_[r].first; i < regions_[r].first + regions_[r].n; ++i)
      klt_.set_deformation(i, deformation_.of(r), found_[i]);
}

// The edge of a shadow, a rope or a bird passes over a few points of a region and displaces them for a while; their
// residuals are then larger than those of the others. An effect common to all points (blur, noise of a darker image)
// does not exclude any.
void PointFinder::leave_out_disturbed(const Region& region) noexcept {
  const auto is_known = [&](std::size_t i) { return found_[i].seen && usual_[i] > 0.0; };
  scratch_u_.clear();
  for (std::size_t i = region.first; i < region.first + region.n; ++i)
    if (is_known(i)) scratch_u_.push_back(strangeness(found_[i]) / usual_[i]);
  if (scratch_u_.empty()) return;
  const double common = std::max(1.0, median_in_place(scratch_u_));
  for (std::size_t i = region.first; i < region.first + region.n; ++i)
    if (is_known(i) && strangeness(found_[i]) > length(kDisturbed * common * usual_[i],
                                                       kUnmodelled * found_[i].deformed_px * found_[i].gain))
      found_[i].seen = false, found_[i].loss = PointLoss::kUnlike;
}

void PointFinder::look(const GrayView& gray, const Region& region, const RegionFollower& expected,
                       const Vector2& shift) noexcept {
  const std::size_t end = region.first + region.n;
  const auto place = [&](std::size_t i) {
    const Vector2& at = expected.expected(i);
    return Vector2{at.u + shift.u, at.v + shift.v};
  };
  for (std::size_t i = region.first; i < end; ++i) {
    if (i + kAhead < found_.size()) klt_.prefetch(gray, i + kAhead, place(i + kAhead));
    found_[i] = klt_.find(gray, i, place(i));
  }
}

// Searches at the shifted place and keeps the better result of a region. True: the result is good.
bool PointFinder::improves(const GrayView& gray, const Region& region, const RegionFollower& expected,
                           const Vector2& shift, Look& best) noexcept {
  if (length(shift) < kNoticeable_px) return false;
  const auto first = found_.begin() + static_cast<std::ptrdiff_t>(region.first);
  const auto end = first + static_cast<std::ptrdiff_t>(region.n);
  std::copy(first, end, best_.begin());
  look(gray, region, expected, shift);
  const Look here = judge(region);
  if (here.is_better_than(best))
    best = here;
  else
    std::copy(best_.begin(), best_.begin() + static_cast<std::ptrdiff_t>(region.n), first);
  return is_good(region, best);
}

Vector2 PointFinder::median_motion(const Region& region) noexcept {
  scratch_u_.clear();
  scratch_v_.clear();
  for (std::size_t i = region.first; i < region.first + region.n; ++i) {
    if (!found_[i].seen) continue;
    scratch_u_.push_back(found_[i].position.u - keyframe_[i].u);
    scratch_v_.push_back(found_[i].position.v - keyframe_[i].v);
  }
  if (scratch_u_.empty()) return {};
  return {median_in_place(scratch_u_), median_in_place(scratch_v_)};
}

PointFinder::Look PointFinder::judge(const Region& region) noexcept {
  Look look;
  look.motion = median_motion(region);
  for (std::size_t i = region.first; i < region.first + region.n; ++i) {
    const KltPoint& point = found_[i];
    if (!point.seen || std::abs(point.position.u - keyframe_[i].u - look.motion.u) > kAgreeing_px ||
        std::abs(point.position.v - keyframe_[i].v - look.motion.v) > kAgreeing_px)
      continue;
    ++look.n_agreeing;
    look.n_convincing += usual_[i] == 0.0 || strangeness(point) < kUnusual * usual_[i] ? 1 : 0;
  }
  return look;
}

// A third of the points suffices, because the others may be hidden.
bool PointFinder::is_good(const Region& region, const Look& look) const noexcept {
  return look.n_agreeing >= config_.min_points && 3 * look.n_agreeing >= static_cast<int>(region.n) &&
         2 * look.n_convincing > look.n_agreeing;
}

// Searches points that disagree with the others once more, at the position given by the others' motion.
void PointFinder::look_for_rest(const GrayView& gray, const Region& region, const Look& look) noexcept {
  for (std::size_t i = region.first; i < region.first + region.n; ++i) {
    const Vector2 place{keyframe_[i].u + look.motion.u, keyframe_[i].v + look.motion.v};
    const auto off = [&](const KltPoint& point) {
      return length(point.position.u - place.u, point.position.v - place.v);
    };
    if (found_[i].seen && off(found_[i]) < 2.0 * kAgreeing_px) continue;
    if (!found_[i].seen && off(found_[i]) < kNoticeable_px) continue;
    const KltPoint again = klt_.find(gray, i, place);
    if (again.seen) found_[i] = again;
  }
}

void PointFinder::learn(const TrackFrame& judged) noexcept {
  for (std::size_t i = 0; i < usual_.size() && i < judged.points.size(); ++i) {
    if (!judged.points[i].inlier || !(found_[i].sigma_px > 0.0)) continue;
    double& usual = usual_[i];
    const double now = strangeness(found_[i]);
    usual = usual == 0.0 ? now : usual + kLearning * (now - usual);
  }
  reseeder_.learn(judged);
  deformation_.learn(judged);
}

}  // namespace core
