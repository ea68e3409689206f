#include "core/geometry/gyro_readout.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/geometry/gyro_problem.h"
#include "core/geometry/gyro_start.h"

namespace core {

namespace {

using Eigen::Index;
using Eigen::Vector3d;

constexpr std::size_t kLeastPairs = 8, kLeastPoints = 8;
constexpr int kGyroReadoutRounds = 80, kStartRounds = 12;
constexpr double kOutlier_sigmas = 5.0;
constexpr double kFocalPerWidth = 0.75;  // initial value

// Distances from the epipolar lines, per pair.
std::vector<std::vector<double>> distances(const GyroProblem& problem, GyroState state) {
  const DerotatedFlows flows = problem.flows(state);
  (void)problem.cost(state, flows, true);
  std::vector<std::vector<double>> all(flows.size());
  for (std::size_t k = 0; k < flows.size(); ++k) {
    for (const DerotatedFlow& flow : flows[k]) {
      all[k].push_back(judge(flow, state.shift_px[k], state.model()).across_px);
    }
  }
  return all;
}

void compare(const GyroProblem& problem, const GyroState& without, const GyroState& with, GyroReadout& out) {
  const auto before = distances(problem, without), after = distances(problem, with);
  double sum_before = 0.0, sum_after = 0.0, count = 0.0;
  for (std::size_t k = 0; k < before.size(); ++k) {
    double b = 0.0, a = 0.0, n = 0.0;
    for (std::size_t j = 0; j < before[k].size(); ++j) {
      if (std::min(std::abs(before[k][j]), std::abs(after[k][j])) > kOutlier_sigmas * with.sigma_px) continue;
      b += before[k][j] * before[k][j], a += after[k][j] * after[k][j], n += 1.0;
    }
    out.pair_rms_without_px.push_back(std::sqrt(b / std::max(1.0, n)));
    out.pair_rms_with_px.push_back(std::sqrt(a / std::max(1.0, n)));
    if (problem.pairs()[k].held_out) sum_before += b, sum_after += a, count += n;
  }
  out.rms_without_px = std::sqrt(sum_before / std::max(1.0, count));
  out.rms_with_px = std::sqrt(sum_after / std::max(1.0, count));
}

// Infinite if the data do not determine it.
double deviation(const GyroMatrix& errors, Index i) {
  return errors(i, i) > 0.0 ? std::sqrt(errors(i, i)) : std::numeric_limits<double>::infinity();
}

// Estimate from the first or the second half of the fitted pairs alone.
ReadoutValue of_half(std::vector<FramePair> pairs, bool second, const std::vector<GyroSample>& gyro,
                     const GyroReadoutConfig& config, const std::vector<Index>& held, GyroState state) {
  const double middle_s = 0.5 * (pairs.front().from_s + pairs.back().to_s);
  for (FramePair& pair : pairs) pair.held_out = pair.held_out || (pair.from_s > middle_s) != second;
  const GyroProblem problem(pairs, gyro, config);
  (void)problem.minimise(held, kGyroReadoutRounds, state);
  const GyroMatrix errors = problem.covariance(state, held);
  return {state.p[kReadout], deviation(errors, kReadout)};
}

}  // namespace

void check_gyro_record(const std::vector<FramePair>& pairs, const std::vector<GyroSample>& gyro,
                       const GyroReadoutConfig& config) {
  const auto fitted = std::count_if(pairs.begin(), pairs.end(), [](const FramePair& p) { return !p.held_out; });
  if (static_cast<std::size_t>(fitted) < kLeastPairs)
    throw std::invalid_argument("gyro readout: " + std::to_string(fitted) + " frame pairs to fit; give at least " +
                                std::to_string(kLeastPairs));
  double from_s = std::numeric_limits<double>::infinity(), to_s = -from_s;
  for (const FramePair& pair : pairs) {
    if (pair.points.size() < kLeastPoints) throw std::invalid_argument("gyro readout: a frame pair with few points");
    from_s = std::min(from_s, pair.from_s);
    to_s = std::max(to_s, pair.to_s);
  }
  const double beyond_s = config.beyond_s();
  if (gyro.size() < 16 || gyro.front().t_s > from_s - beyond_s || gyro.back().t_s < to_s + beyond_s)
    throw std::invalid_argument("gyro readout: the gyro record does not cover the frames and " +
                                std::to_string(beyond_s) + " s on either side: are both in the same unit and clock?");
  for (std::size_t i = 1; i < gyro.size(); ++i) {
    if (!(gyro[i].t_s > gyro[i - 1].t_s) || !gyro[i].rate_rad_s.allFinite())
      throw std::invalid_argument("gyro readout: gyro sample " + std::to_string(i) +
                                  ": time does not increase, or a rate is not a number");
  }
}

GyroReadout fit_gyro_readout(const std::vector<FramePair>& pairs, const std::vector<GyroSample>& gyro,
                             const GyroReadoutConfig& config) {
  check_gyro_record(pairs, gyro, config);
  const GyroProblem problem(pairs, gyro, config);
  std::vector<Index> held;
  if (config.focal_px > 0.0) held.push_back(kFocal);
  std::vector<Index> held_without = held;
  held_without.push_back(kReadout);
  const double focal_px = config.focal_px > 0.0 ? config.focal_px : kFocalPerWidth * config.width_px;
  const GyroStart start = start_from_turns(pairs, gyro, config, focal_px);
  const double frame_s = pairs.front().to_s - pairs.front().from_s;
  GyroState with, without;
  double least = std::numeric_limits<double>::infinity();
  for (const double share : {0.0, -0.6, 0.6}) {
    GyroState state;
    state.axes = start.axes;
    state.p[kReadout] = share * frame_s;
    state.p[kOffset] = start.offset_s - 0.5 * share * frame_s;
    state.p[kFocal] = std::log(focal_px);
    state.shift_px.assign(pairs.size(), Vector3d(0.0, 0.0, -1.0));
    const double reached = problem.minimise(held, kStartRounds, state);
    if (reached < least) least = reached, with = state;
    if (share == 0.0) without = state;
  }
  (void)problem.minimise(held, kGyroReadoutRounds, with);
  without.p[kOffset] += 0.5 * without.p[kReadout];
  without.p[kReadout] = 0.0;
  (void)problem.minimise(held_without, kGyroReadoutRounds, without);
  const GyroMatrix errors = problem.covariance(with, held);

  GyroReadout out;
  const auto std_of = [&](Index i) { return deviation(errors, i); };
  out.readout = {with.p[kReadout], std_of(kReadout)};
  out.offset_s = with.p[kOffset];
  out.offset_std_s = std_of(kOffset);
  out.focal_px = std::exp(with.p[kFocal]);
  out.focal_std_px = config.focal_px > 0.0 ? 0.0 : out.focal_px * std_of(kFocal);
  out.bias_rad_s = with.p.segment<3>(kBias);
  out.axes = with.axes.toRotationMatrix();
  out.sigma_px = with.sigma_px;
  out.halves = {of_half(pairs, false, gyro, config, held, with), of_half(pairs, true, gyro, config, held, with)};
  compare(problem, without, with, out);
  return out;
}

}  // namespace core
