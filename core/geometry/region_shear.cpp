#include "core/geometry/region_shear.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace core {

namespace {

constexpr double kLeastShearSigmaPx = 0.003, kMostSigmaPx = 100.0;
constexpr double kMostMotion_px = 1e5;
constexpr double kLeastOwnShare = 1e-4;   // smallest share of a column that the previous columns do not explain
constexpr double kLeastPivotShare = 0.1;  // smallest pivot relative to the keyframe's: below, too few points are seen
constexpr std::size_t kLeastShearPoints = 4;  // a region has six unknowns; four points give eight coordinates

}  // namespace

RegionShear::RegionShear(const Config& config, const TrackFrame& keyframe)
    : camera_(config.camera),
      places_(config.places),
      corrects_places_(config.places.corrects()),
      regions_(config.n_regions) {
  place_columns(config, keyframe);
  for (RegionFit& region : regions_) centre_columns(region);
  judge_regions(config.least_extent_px / config.readout.extent_px());
  fields_.assign(kAxes * regions_.size() + 2, 0.0);
  make_information();
}

void RegionShear::place_columns(const Config& config, const TrackFrame& keyframe) {
  const double width_px = std::max(1, config.readout.width_px);
  const Vector2 centre = camera_.calibrated() ? Vector2{camera_.cx, camera_.cy}
                                              : Vector2{0.5 * (width_px - 1.0), 0.5 * (config.readout.height_px - 1.0)};
  double sum = 0.0, n_known = 0.0;
  for (const TrackPoint& seen : keyframe.points) {
    if (seen.region >= regions_.size()) throw std::invalid_argument("RegionShear: a point of no region");
    Point point;
    point.keyframe = places_.corrected_keyframe(camera_.undistort({seen.u_px, seen.v_px}));
    point.region = seen.region;
    const double sigma_px = std::min(kMostSigmaPx, std::max(kLeastShearSigmaPx, seen.sigma_px));  // NaN: lower bound
    point.weight = 1.0 / (sigma_px * sigma_px);
    const double x = point.keyframe.u - centre.u, y = point.keyframe.v - centre.v;
    const double fraction = config.readout.fraction(seen.u_px, seen.v_px);
    point.column = {{{1.0, 0.0, y, x, fraction, 0.0, x * y / width_px, x * x / width_px},
                     {0.0, 1.0, -x, y, 0.0, fraction, y * y / width_px, x * y / width_px}}};
    const bool known = seen.seen && std::isfinite(x) && std::isfinite(y) && std::isfinite(fraction);
    if (known) {
      regions_[seen.region].points.push_back(points_.size());
      sum += point.weight;
      ++n_known;
    }
    points_.push_back(point);
  }
  for (Point& point : points_) point.weight *= n_known / sum;
}

// Subtracts the weighted means, so that the region's mean motion is uncorrelated with the other unknowns, and scales.
void RegionShear::centre_columns(RegionFit& region) {
  double weight = 0.0;
  std::array<std::array<double, kAll>, kAxes> mean{};
  for (const std::size_t j : region.points) {
    weight += points_[j].weight;
    for (std::size_t a = 0; a < kAxes; ++a) {
      for (std::size_t c = 2; c < kAll; ++c) mean[a][c] += points_[j].weight * points_[j].column[a][c];
    }
  }
  if (!(weight > 0.0)) return;
  region.mean_fraction = mean[0][kShear] / weight;
  double squares = 0.0;
  for (const std::size_t j : region.points) {
    for (std::size_t a = 0; a < kAxes; ++a) {
      for (std::size_t c = 2; c < kAll; ++c) points_[j].column[a][c] -= mean[a][c] / weight;
    }
    squares += points_[j].weight * points_[j].column[0][kShear] * points_[j].column[0][kShear];
  }
  region.fraction_scale = squares > 0.0 ? std::sqrt(squares / weight) : 1.0;
  for (const std::size_t j : region.points) {
    points_[j].column[0][kShear] /= region.fraction_scale;
    points_[j].column[1][kShear + 1] /= region.fraction_scale;
    add_point(points_[j], {}, region.normal);
  }
}

void RegionShear::add_point(const Point& point, Vector2 motion, Normal& normal) const noexcept {
  for (std::size_t a = 0; a < kAxes; ++a) {
    const std::array<double, kAll>& column = point.column[a];
    const double value = a == 0 ? motion.u : motion.v;
    for (std::size_t r = 0; r < kAll; ++r) {
      const double weighted = point.weight * column[r];
      for (std::size_t c = r; c < kAll; ++c) normal[r][c] += weighted * column[c];
      normal[r][kAll] += weighted * value;
    }
  }
}

namespace {

// Gaussian elimination of the first `n` unknowns of a symmetric system stored as upper half and right-hand side; the
// remainder becomes the reduced system. Eliminated rows keep the values needed for back-substitution.
template <class Normal>
void eliminate(Normal& normal, std::size_t n) noexcept {
  const std::size_t all = normal.size();
  for (std::size_t p = 0; p < n; ++p) {
    if (!(normal[p][p] > 0.0)) continue;
    for (std::size_t r = p + 1; r < all; ++r) {
      const double factor = normal[p][r] / normal[p][p];
      for (std::size_t c = r; c <= all; ++c) normal[r][c] -= factor * normal[p][c];
    }
  }
}

// Back-substitution of unknowns p < n; x contains those from n on.
template <class Normal, class Vector>
void back_substitute(const Normal& normal, std::size_t n, Vector& x) noexcept {
  const std::size_t all = normal.size();
  for (std::size_t p = n; p-- > 0;) {
    double value = normal[p][all];
    for (std::size_t c = p + 1; c < all; ++c) value -= normal[p][c] * x[c];
    x[p] = value / normal[p][p];
  }
}

struct Turn {
  double pitch = 0.0, yaw = 0.0;
};

Turn solve_turn(double pp, double py, double yy, double p, double y) noexcept {
  const double determinant = pp * yy - py * py;
  if (!(determinant > 0.0)) return {};
  return {(yy * p - py * y) / determinant, (pp * y - py * p) / determinant};
}

}  // namespace

// A region is usable if its own six unknowns can be distinguished.
void RegionShear::judge_regions(double least_fraction) {
  for (RegionFit& region : regions_) {
    Normal reduced = region.normal;
    eliminate(reduced, kOwn);
    region.usable = region.points.size() >= kLeastShearPoints;
    for (std::size_t p = 0; p < kOwn; ++p) {
      region.pivot[p] = reduced[p][p];
      region.usable = region.usable && reduced[p][p] > kLeastOwnShare * region.normal[p][p];
    }
    double lowest = 0.0, highest = 0.0;  // relative to the mean
    for (const std::size_t j : region.points) {
      const double fraction = points_[j].column[0][kShear] * region.fraction_scale;
      lowest = std::min(lowest, fraction), highest = std::max(highest, fraction);
    }
    region.tells = region.usable && highest - lowest >= least_fraction;
  }
}

std::size_t RegionShear::n_usable() const noexcept {
  return static_cast<std::size_t>(
      std::count_if(regions_.begin(), regions_.end(), [](const RegionFit& region) { return region.tells; }));
}

RegionShear::Sample RegionShear::sample_prototype() const {
  Sample sample;
  sample.carrier_px.assign(kAxes * regions_.size(), 0.0);
  sample.shear_px.assign(kAxes * regions_.size(), 0.0);
  sample.seen.assign(regions_.size(), 0);
  return sample;
}

// Builds the region's normal equations of this frame and eliminates its own unknowns. False: it is not seen.
bool RegionShear::accumulate(const TrackFrame& tracks, RegionFit& region) noexcept {
  region.normal = {};
  std::size_t n_seen = 0;
  for (const std::size_t j : region.points) {
    if (j >= tracks.points.size()) continue;
    const TrackPoint& point = tracks.points[j];
    if (!point.seen || !point.inlier || point.region != points_[j].region) continue;
    Vector2 place = camera_.undistort({point.u_px, point.v_px});
    if (corrects_places_) place = places_.corrected(place);
    const Vector2 motion{place.u - points_[j].keyframe.u, place.v - points_[j].keyframe.v};
    if (!(std::abs(motion.u) < kMostMotion_px && std::abs(motion.v) < kMostMotion_px)) continue;
    add_point(points_[j], motion, region.normal);
    ++n_seen;
  }
  if (n_seen < kLeastShearPoints) return false;
  eliminate(region.normal, kOwn);
  for (std::size_t p = 0; p < kOwn; ++p) {
    if (!(region.normal[p][p] > kLeastPivotShare * region.pivot[p])) return false;
  }
  return true;
}

void RegionShear::fit(const TrackFrame& tracks, Sample& out) noexcept {
  double pp = 1.0 / (kMostTurn * kMostTurn), py = 0.0, yy = pp, p = 0.0, y = 0.0;
  for (std::size_t r = 0; r < regions_.size(); ++r) {
    RegionFit& region = regions_[r];
    out.seen[r] = region.usable && accumulate(tracks, region) ? 1 : 0;
    if (out.seen[r] == 0) continue;
    pp += region.normal[6][6];
    py += region.normal[6][7];
    yy += region.normal[7][7];
    p += region.normal[6][kAll];
    y += region.normal[7][kAll];
  }
  const Turn turn = solve_turn(pp, py, yy, p, y);
  for (std::size_t r = 0; r < regions_.size(); ++r) {
    std::array<double, kAll> unknown{};
    unknown[6] = turn.pitch;
    unknown[7] = turn.yaw;
    if (out.seen[r] != 0) back_substitute(regions_[r].normal, kOwn, unknown);
    // The distance between rows scales with the region's growth since the keyframe.
    const double grown = std::clamp(1.0 + unknown[kTurn + 1], 0.5, 2.0);
    for (std::size_t a = 0; a < kAxes; ++a) {
      out.carrier_px[kAxes * r + a] = unknown[a];
      out.shear_px[kAxes * r + a] = unknown[kShear + a] / regions_[r].fraction_scale / grown;
      fields_[kAxes * r + a] = unknown[kTurn + a];
    }
  }
  fields_[fields_.size() - 2] = turn.pitch;
  fields_[fields_.size() - 1] = turn.yaw;
  for (std::size_t c = 0; c < out.carrier_px.size(); ++c) {
    for (std::size_t f = 0; f < fields_.size(); ++f) {
      out.carrier_px[c] += carrier_(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(f)) * fields_[f];
    }
  }
}

}  // namespace core
