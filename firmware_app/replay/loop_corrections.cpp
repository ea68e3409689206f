#include "firmware_app/replay/loop_corrections.h"

#include <algorithm>
#include <vector>

#include "core/closure/observation/adoption.h"

namespace app {
namespace {

using core::closure::Adoption;
using core::closure::ClosureReport;
using core::closure::ClosureResult;

// In flight, an effect is adopted after two agreeing reports; a whole record needs no second report.
Adoption adoption_of(const ClosureResult& result) {
  ClosureReport report;
  report.result = result;
  Adoption out;
  (void)out.update(report, 0);
  (void)out.update(report, 0);
  return out;
}

}  // namespace

bool is_corrected(const core::closure::ClosureStep& step) {
  ClosureResult alone;
  alone.steps = {step};
  return !adoption_of(alone).in_force().empty();
}

CorrectionSet corrections_of(const ClosureResult& result, const core::CameraModel& camera) {
  const Adoption adoption = adoption_of(result);
  CorrectionSet out;
  const core::closure::RunCorrection correction = adoption.correction(camera);
  out.places = correction.places;
  out.places.in_keyframe = out.places.lens.calibrated();
  out.added_readout_frames = correction.added_readout.value;
  out.readout_sigma_frames = correction.added_readout.sigma.value_or(0.0);
  out.words = adoption.words();
  return out;
}

namespace {

std::size_t n_kept(std::size_t n_points, int points_per_region) {
  return std::min(n_points, static_cast<std::size_t>(std::max(points_per_region, 1)));
}

}  // namespace

std::size_t n_thinned(const drivers::TracksFile& file, int points_per_region) {
  std::vector<std::size_t> in_region(file.region_names.size(), 0);
  for (const core::TrackPoint& point : file.first.points) ++in_region[point.region];
  std::size_t sum = 0;
  for (const std::size_t n : in_region) sum += n_kept(n, points_per_region);
  return sum;
}

TracksRecord thinned(TracksRecord record, int points_per_region) {
  core::closure::ObservationRecord& all = record.record;
  std::vector<std::vector<Eigen::Index>> of_region(all.regions.size());
  for (std::size_t j = 0; j < all.region_of_point.size(); ++j)
    of_region[all.region_of_point[j]].push_back(static_cast<Eigen::Index>(j));
  std::vector<Eigen::Index> kept;
  for (const auto& own : of_region) {
    const std::size_t n = n_kept(own.size(), points_per_region);
    for (std::size_t i = 0; i < n; ++i) kept.push_back(own[i * own.size() / n]);
  }
  std::sort(kept.begin(), kept.end());
  if (kept.size() != all.region_of_point.size()) all = core::closure::select_points(all, kept);
  return record;
}

}  // namespace app
